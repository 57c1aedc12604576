#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# bare_root.sh BUILD: the Debian packages on a bare Debian 12. Makes them, debootstraps a root of nothing but Debian's
# minimal system, installs planemap there as a user does, runs it, builds the examples on it, and says how large it is.
# Packages that a robot has no use for (compilers, Java, windows) must not come with it.
# Needs root and Debian's mirror.
set -euo pipefail

build="$(cd "$1" && pwd)"
work="$(mktemp -d)"
root="$work/root"
trap 'umount -q "$root/proc" || true; rm -rf --one-file-system -- "$work"' EXIT
fail() {
    echo "FAILED: $*" >&2
    exit 1
}

(cd "$work" && cpack --config "$build/CPackConfig.cmake" -B "$work/packages" >"$work/cpack.log") || fail "cpack: $(tail -n 5 "$work/cpack.log")"
ls -l "$work"/packages/*.deb
mirror="$(sed -nE 's/^(deb|URIs:) *([^ ]*debian\/?)( .*)?$/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -n 1 || true)"
debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}" >"$work/debootstrap.log" 2>&1 ||
    fail "debootstrap: $(tail -n 3 "$work/debootstrap.log")"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
cp -r /etc/apt/. "$root/etc/apt/"
mount -t proc proc "$root/proc"
cp "$work"/packages/planemap_*.deb "$work"/packages/planemap-dev_*.deb "$root/tmp/"

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }
inside apt-get -qq update
before="$(du -sm --one-file-system "$root/usr" | cut -f1)"
inside dpkg-query -W -f '${Package}\n' | sort >"$work/packages_before"
inside bash -c 'apt-get -qq install -y --no-install-recommends /tmp/planemap_*.deb' >"$work/apt.log" 2>&1 || fail "apt: $(tail -n 5 "$work/apt.log")"
after="$(du -sm --one-file-system "$root/usr" | cut -f1)"
echo "planemap: $(inside dpkg-query -W -f '${Installed-Size}' planemap) kB installed, with what it needs $((after - before)) MB"
# A robot needs no compiler, no Java and no windows. What comes all the same, and why: libx11-6, libx11-data and
# libx11-xcb1 of opencv_core, which links libGL, whose libGLX has them.
unwanted='^(g\+\+|gcc|cpp|clang|cmake|make|binutils)(-[0-9.]+)?$|-dev$|-(jre|jdk)(-|$)|^lib(gtk|qt[0-9]|vtk|x11|wayland)'
excepted='libx11-6|libx11-data|libx11-xcb1'
brought="$(inside dpkg-query -W -f '${Package}\n' | sort | comm -13 "$work/packages_before" - |
    { grep -E -- "$unwanted" || true; } | { grep -vxE -- "$excepted" || true; } | paste -sd' ')"
[[ -z "$brought" ]] || fail "it brings $brought"
inside planemap-run 'sim:office?frames=20&width=320&height=240' --output /tmp/office --quiet >"$work/report.txt" || fail "planemap-run"
grep -q OctoMap "$work/report.txt" || fail "no report"
inside planemap-evaluate /tmp/office/groundtruth.txt /tmp/office/trajectory.txt >/dev/null || fail "planemap-evaluate"
for program in $(cd "$root/usr/bin" && ls -d planemap-*); do
    inside "$program" --help >/dev/null || fail "$program --help"
done
said="$(inside planemap-spy 2>&1 || true)"
grep -q 'apt-get install' <<<"$said" || fail "planemap-spy without Java says: $said"
inside bash -c 'apt-get -qq install -y liblcm-bin' >>"$work/apt.log" 2>&1 || fail "liblcm-bin"
inside timeout 120 planemap-launch 'sim:office?frames=10&width=320&height=240' --lcm-url 'udpm://239.255.76.67:7691?ttl=0' \
    --output /tmp/live --log /tmp/live.lcmlog || fail "planemap-launch"
[[ -s "$root/tmp/live/plane_map.lcmlog" && -s "$root/tmp/live.lcmlog" ]] || fail "planemap-launch left no map or no log"

# What others build on it: the other package, with the compiler of the same Debian, and the examples that it brings.
before="$(du -sm --one-file-system "$root/usr" | cut -f1)"
inside bash -c 'apt-get -qq install -y --no-install-recommends /tmp/planemap-dev_*.deb' >>"$work/apt.log" 2>&1 ||
    fail "planemap-dev: $(tail -n 5 "$work/apt.log")"
after="$(du -sm --one-file-system "$root/usr" | cut -f1)"
echo "planemap-dev: $(inside dpkg-query -W -f '${Installed-Size}' planemap-dev) kB installed, with what it needs $((after - before)) MB more"
inside bash -c 'apt-get -qq install -y --no-install-recommends g++ cmake make' >>"$work/apt.log" 2>&1 || fail "a compiler: $(tail -n 5 "$work/apt.log")"
inside bash -ec 'cmake -S /usr/share/doc/planemap-dev/examples -B /tmp/examples && cmake --build /tmp/examples' >"$work/examples.log" 2>&1 ||
    fail "the examples: $(tail -n 20 "$work/examples.log")"
inside bash -ec 'cd /tmp
    examples/01_map_a_folder "sim:office?frames=30&width=320&height=240" map.lcmlog
    examples/03_ask_a_map map.lcmlog
    examples/02_listen_to_the_map "file:///tmp/map.lcmlog?speed=0" 1' >"$work/examples.txt" 2>&1 || fail "the examples say: $(cat "$work/examples.txt")"
grep -q 'nearest: plane' "$work/examples.txt" && grep -q '^map .* planes$' "$work/examples.txt" ||
    fail "the examples say: $(cat "$work/examples.txt")"
echo "a bare Debian 12 runs planemap, and builds on it"
