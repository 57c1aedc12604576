#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# spy_plugin_test.sh BUILD SOURCE [PICTURE.png]: the windows that tools/spy adds to lcm-spy draw a stored map where it is,
# without a display; lcm-spy finds the plug-ins; and where Xvfb is, the windows open.
set -euo pipefail

build="$1" source="$2" picture="${3:-}"
work="$(mktemp -d)"
started=()
finish() {
    [[ "${#started[@]}" -eq 0 ]] || kill "${started[@]}" 2>/dev/null || true
    wait
    rm -rf -- "$work"
}
trap finish EXIT
fail() {
    echo "FAILED: $*" >&2
    exit 1
}
jars="/usr/share/java/lcm.jar:$build/share/java/lcmtypes_planemap.jar:$build/share/java/planemap_spy.jar"

# The stored map is of an earlier format: what is written of it is in today's, and exported from there.
"$build/bin/planemap-export" "$source/tests/stored/plane_map.lcmlog" --output "$work/stored" --quiet
"$build/bin/planemap-export" "$work/stored/plane_map.lcmlog" --output "$work/map" --quiet
python3 -c '
import json, sys
for plane in json.load(open(sys.argv[1]))["planes"]:
    print(plane["id"], *plane["outline"][0][0], plane["area"])' "$work/map/planes.json" >"$work/rings.txt"
javac -nowarn -d "$work/classes" -cp "$jars" "$source/tests/spy_plugin/MapPictureTest.java"
java -Djava.awt.headless=true -ea -cp "$work/classes:$jars" planemap.spy.MapPictureTest "$work/map/plane_map.lcmlog" \
    "$work/rings.txt" ${picture:+"$picture"} || fail "the map is not drawn as it is"

if ! command -v Xvfb >/dev/null; then
    echo "SKIP the windows: Xvfb is not installed"
    exit 0
fi
Xvfb -displayfd 3 -screen 0 1280x800x24 3>"$work/display" 2>/dev/null &
started+=($!)
for ((i = 0; i < 100; i++)); do [[ -s "$work/display" ]] && break || sleep 0.1; done
[[ -s "$work/display" ]] || fail "Xvfb does not start"
: >"$work/spy.txt"
DISPLAY=":$(cat "$work/display")" "$source/tools/spy" map depth --no-viewer --lcm-url 'udpm://239.255.76.67:7683?ttl=0' \
    >"$work/spy.txt" 2>&1 &
spy=$!
started+=("$spy")
for ((i = 0; i < 300; i++)); do
    grep -q 'planemap.spy.MapPlugin' "$work/spy.txt" && break
    kill -0 "$spy" 2>/dev/null || fail "tools/spy ended: $(cat "$work/spy.txt")"
    sleep 0.1
done
for plugin in MapPlugin PreviewPlugin; do
    grep -q "planemap.spy.$plugin" "$work/spy.txt" || fail "lcm-spy does not find $plugin: $(cat "$work/spy.txt")"
done
sleep 2
kill -0 "$spy" 2>/dev/null || fail "tools/spy ended: $(cat "$work/spy.txt")"
if grep -qi 'exception' "$work/spy.txt"; then fail "$(cat "$work/spy.txt")"; fi
echo "lcm-spy and its windows open"
