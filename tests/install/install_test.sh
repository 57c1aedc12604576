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
for file in bin/planemap-run bin/planemap-launch bin/planemap-spy bin/planemap-viewer bin/planemap-export bin/planemap-measure bin/planemap-log bin/planemap-convert share/java/planemap_spy.jar \
    bin/planemap-virtual-camera lib/planemap/libPlanemapVirtualCamera.so.0 share/planemap/lcmtypes/planemap_plane_map_t.lcm \
    include/planemap/lcmtypes/planemap/plane_map_t.hpp include/planemap/map/queries.hpp; do
    [[ -e "$work/prefix/$file" ]] || fail "$file is not installed"
done
cp -r "$source/examples" "$work/examples"

cat >"$work/inside.sh" <<'INSIDE'
set -euo pipefail
cd "$1"
cmake -S examples -B build -G Ninja -DCMAKE_PREFIX_PATH="$1/prefix" >configure.log || { tail -n 20 configure.log; exit 1; }
cmake --build build >build.log || { tail -n 40 build.log; exit 1; }

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
    case "$program" in
        *-spy) "$program" --help >/dev/null ;;
        *-bench-*) "$program" --help >/dev/null ;;
        *) [[ "$("$program" --version | grep -o '[0-9.]*$')" == "$(grep -o '[0-9.]*$' <<<"$version")" ]] || {
            echo "$program --version: $("$program" --version)"
            exit 1
        } ;;
    esac
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
