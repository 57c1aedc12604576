#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# install_test.sh BUILD SOURCE: `cmake --install` gives what another project needs and what a robot runs. The examples are
# built against the installed package and run where neither the build nor the source folder can be seen.
set -euo pipefail

build="$1" source="$2"
work="$(mktemp -d)"
trap 'rm -rf -- "$work"' EXIT
fail() {
    echo "FAILED: $*" >&2
    exit 1
}

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log" || fail "cmake --install: $(tail -n 3 "$work/install.log")"
is_installed() { [[ -e "$work/prefix/$1" ]] || fail "$1 is not installed"; }
for program in "$build"/bin/planemap-*; do is_installed "bin/$(basename "$program")"; done
for file in systemd procman; do
    diff -r "$source/tools/$file" "$work/prefix/share/planemap/$file" || fail "share/planemap/$file is not tools/$file"
done
for file in bin/planemap-spy lib/planemap/libPlanemapVirtualCamera.so.0 share/planemap/lcmtypes/planemap_plane_map_t.lcm \
    include/planemap/lcmtypes/planemap/plane_map_t.hpp include/planemap/map/queries.hpp share/doc/planemap/README.md \
    share/doc/planemap/CHANGELOG.md share/doc/planemap/LICENSE share/doc/planemap/docs/formats.md; do
    is_installed "$file"
done
if grep -q '^PLANEMAP_JAVA:.*=ON$' "$build/CMakeCache.txt"; then
    for jar in lcmtypes_planemap planemap_spy; do is_installed "share/java/$jar.jar"; done
fi
cp -r "$source/examples" "$work/examples"
mkdir "$work/core_alone"
cat >"$work/core_alone/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(core_alone LANGUAGES CXX)
find_package(planemap REQUIRED COMPONENTS core)
add_executable(core_alone main.cpp)
target_link_libraries(core_alone planemap::core)
CMAKE
cat >"$work/core_alone/main.cpp" <<'CPP'
#include <core/geometry/pose.hpp>

int main() {
    return planemap::rotation_angle(planemap::Pose::Identity()) == 0 ? 0 : 1;
}
CPP

cat >"$work/inside.sh" <<'INSIDE'
set -euo pipefail
cd "$1"
cmake -S examples -B build -G Ninja -DCMAKE_PREFIX_PATH="$1/prefix" >configure.log || { tail -n 20 configure.log; exit 1; }
cmake --build build >build.log || { tail -n 40 build.log; exit 1; }

# Who asks for core need not have what the others link: packages that are switched off would be an error here, and a
# library that was looked for by hand would be in the cache.
cmake -S core_alone -B core_build -G Ninja -DCMAKE_PREFIX_PATH="$1/prefix" -DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_Ceres=ON -DCMAKE_DISABLE_FIND_PACKAGE_octomap=ON -DCMAKE_DISABLE_FIND_PACKAGE_spdlog=ON \
    >configure.log || { tail -n 20 configure.log; exit 1; }
if grep -E '^(PCL_|OpenNI2|freenect|lcm__|turbojpeg).*=' core_build/CMakeCache.txt; then echo "core looks for these"; exit 1; fi
cmake --build core_build >build.log || { tail -n 40 build.log; exit 1; }
core_build/core_alone

build/01_map_a_folder 'sim:office?frames=30&width=320&height=240' map.lcmlog
build/03_ask_a_map map.lcmlog >answers.txt
grep -q 'nearest: plane' answers.txt && grep -q ' deg' answers.txt || { echo "03: $(cat answers.txt)"; exit 1; }
# An LCM log is a bus, too: what it holds is heard.
build/02_listen_to_the_map "file://$1/map.lcmlog?speed=0" 1 >heard.txt
grep -q '^map .* planes$' heard.txt || { echo "02: $(cat heard.txt)"; exit 1; }
if build/03_ask_a_map no_such.lcmlog 2>error.txt; then echo "03 takes a file that is not there"; exit 1; fi
grep -q no_such.lcmlog error.txt

# The virtual camera's driver is found where it was installed.
prefix/bin/planemap-virtual-camera sim:office -- planemap-sensor --list | grep -q VIRTUAL0001 || {
    echo "planemap-virtual-camera shows no camera"
    exit 1
}

# The installed programs run and say the same version.
version="$(prefix/bin/planemap-run --version)"
for program in prefix/bin/planemap-*; do
    [[ "$("$program" --version)" == "$(basename "$program") ${version##* }" ]] || {
        echo "$program --version: $("$program" --version)"
        exit 1
    }
done
INSIDE
if unshare -m true 2>/dev/null; then
    mkdir "$work/nothing"
    unshare -m bash -c 'mount --bind "$1" "$2" && mount --bind "$1" "$3" && cd / && exec bash "$4" "$5"' bash \
        "$work/nothing" "$build" "$source" "$work/inside.sh" "$work" || fail "see above"
else
    echo "no mount namespaces here: the build folder stays visible"
    bash "$work/inside.sh" "$work" || fail "see above"
fi
echo "installed: $(du -sh --apparent-size "$work/prefix/bin" | cut -f1) of programs"
