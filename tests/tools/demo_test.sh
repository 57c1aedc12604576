#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# demo_test.sh: tools/demo and tools/install in a tree of their own, with a cmake, an apt-get and a planemap-run that
# only write down how they were called.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

fail() {
    echo "demo_test: $*" >&2
    exit 1
}
expect() { grep -qE -- "$2" "$1" || fail "no '$2' in: $(cat "$1")"; }
expect_not() { ! grep -qE -- "$2" "$1" || fail "'$2' in: $(cat "$1")"; }

mkdir -p "$work/tools" "$work/path"
cp "$root/tools/demo" "$root/tools/install" "$root/tools/progress.sh" "$work/tools"
echo "dpkg   # is there" >"$work/tools/packages.txt"

cat >"$work/path/cmake" <<END
#!/usr/bin/env bash
echo "\$*" >>"$work/cmake.calls"
[[ ! -e "$work/broken" ]] || { printf '[1/2 0.1] one\nFAILED: two.o\ntwo.cpp:1: error: no\n'; exit 1; }
if [[ "\$1" == -S ]]; then
    mkdir -p "$work/build/bin"
    touch "$work/build/CMakeCache.txt"
else
    for i in {1..200}; do echo "[\$i/200 \$i.5] compiling"; done
    printf '#!/bin/sh\necho mapped "\$@"\n' >"$work/build/bin/planemap-run"
    chmod +x "$work/build/bin/planemap-run"
fi
END
cat >"$work/path/apt-get" <<END
#!/usr/bin/env bash
echo "\$*" >>"$work/apt.calls"
for i in {1..2500}; do echo "apt's word \$i"; done
if [[ "\$*" == *--print-uris* ]]; then exit; fi
if { true >&3; } 2>/dev/null; then for i in {0..99}; do echo "pmstatus:x:\$i.0:Unpacking x" >&3; done; fi
[[ ! -e "$work/broken" ]]
END
printf '#!/bin/sh\nexec "$@"\n' >"$work/path/sudo"
printf '#!/bin/sh\n' >"$work/path/sleep"
chmod +x "$work"/path/*
demo() { PATH="$work/path:$PATH" "$work/tools/demo" "$@" >"$work/out.txt" 2>"$work/err.txt" </dev/null; }

demo || fail "ended with $?: $(cat "$work/err.txt")"
expect "$work/cmake.calls" '-S .*-DPLANEMAP_TESTS=OFF -DPLANEMAP_BENCHMARKS=OFF'
head -n 1 "$work/err.txt" >"$work/first.txt"
expect "$work/first.txt" 'tools/demo: builds planemap .*, and maps sim:office'
expect "$work/err.txt" 'building: 50 % 100 of 200 steps, [0-9]+ (s|min) left'
[[ "$(wc -l <"$work/err.txt")" -le 14 ]] || fail "more than 14 lines: $(cat "$work/err.txt")"
[[ "$(grep -c compiling "$work/out/build.log")" -eq 200 ]] || fail "the log does not hold what the build said"
expect "$work/out.txt" "mapped sim:office --output $work/out/sim_office"
expect "$work/out.txt" "$work/out/sim_office/report.html"

rm "$work/cmake.calls"
demo sim:office --output "$work/mine" || fail "the second time: $(cat "$work/err.txt")"
expect_not "$work/cmake.calls" 'PLANEMAP_|CMAKE_BUILD_TYPE'
expect "$work/out.txt" "mapped sim:office --output $work/mine"
expect "$work/out.txt" "$work/mine/report.html"

touch "$work/broken"
if demo; then fail "a broken build is no error"; fi
expect "$work/err.txt" 'build.log'
rm "$work/broken"

echo no-such-package >"$work/tools/packages.txt"
demo || fail "with a package: $(cat "$work/err.txt")"
expect "$work/err.txt" 'installs 1 Debian packages .*brings the build up to date'
expect "$work/err.txt" 'tools/install: 50 % Unpacking x'
[[ "$(wc -l <"$work/err.txt")" -le 40 ]] || fail "apt's words are not in the log: $(cat "$work/err.txt")"
[[ "$(grep -c "apt's word" "$work/out/install.log")" -ge 2500 ]] || fail "apt's words are lost"
touch "$work/broken"
if demo; then fail "an apt that fails is no error"; fi
expect "$work/err.txt" "apt's word 2500"
expect "$work/err.txt" "failed three times"
echo "demo_test: passed"
