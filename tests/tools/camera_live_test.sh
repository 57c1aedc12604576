#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# camera_live_test.sh BIN: frames whose camera nobody describes, live. Without --camera every one that takes them fails
# and says the way out, and nothing claims a map; with it they are mapped. A log is played by planemap-sensor.
# Exits with 77, ctest's code for a skipped test, where multicast cannot be had.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
# shellcheck source=own_network.sh
source "$here/own_network.sh"
enter_own_network "$0" "$@"

bin="$1"
launch="$here/../../tools/launch"
url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304'
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
fail() {
    echo "camera_live_test: $*" >&2
    exit 1
}

"$bin/planemap-convert" 'sim:office?frames=30&width=320&height=240' --color jpeg --quiet --output "$work/full.lcmlog" >/dev/null
"$bin/planemap-convert" 'sim:office?frames=1&width=320&height=240' --quiet --output "$work/tum" >/dev/null
"$bin/planemap-log" cut "$work/full.lcmlog" --channels OPENNI_FRAME --output "$work/frames.lcmlog" >/dev/null

# live NAME FLAGS...: modules without a sensor while another program sends the frames; the exit code.
live() {
    local name="$1" pid code=0 attempt
    shift
    "$launch" --bin "$bin" --no-sensor --lcm-url "$url" --output "$work/$name" "$@" >"$work/$name.txt" 2>&1 &
    pid=$!
    for ((attempt = 0; attempt < 100; attempt++)); do
        [[ "$(grep -c ': on udpm' "$work/$name.txt" || true)" -lt 5 ]] || break
        sleep 0.1
    done
    sleep 0.5
    lcm-logplayer --lcm-url="$url" "$work/frames.lcmlog" >/dev/null 2>&1
    sleep 1
    kill "$pid"
    wait "$pid" || code=$?
    return "$code"
}

if live without; then fail "frames that nobody describes: launch ended with code 0"; fi
for module in segmentation odometry; do
    grep -q "planemap-$module: none of the 30 inputs could be used: no PLANEMAP_CAMERA_INFO .*--camera camera.json" \
        "$work/without.txt" || fail "planemap-$module does not say what is missing: $(cat "$work/without.txt")"
done
grep -q 'planemap-map: nothing was mapped' "$work/without.txt" || fail "planemap-map does not say that nothing was mapped"
if grep -q 'the map is in' "$work/without.txt"; then fail "launch claims a map that is empty"; fi

live with --camera "$work/tum/camera.json" || fail "with --camera: $(cat "$work/with.txt")"
grep -q 'the map is in' "$work/with.txt" || fail "with --camera nothing was mapped: $(cat "$work/with.txt")"

code=0
"$bin/planemap-sensor" "$work/frames.lcmlog" --lcm-url "$url" 2>"$work/sensor.txt" || code=$?
[[ "$code" -eq 1 ]] || fail "planemap-sensor ended with code $code"
grep -q 'no camera_info_t in this log says what its camera is; give --camera camera.json' "$work/sensor.txt" ||
    fail "planemap-sensor: $(cat "$work/sensor.txt")"
"$bin/planemap-sensor" "$work/frames.lcmlog" --camera "$work/tum/camera.json" --speed 0 --lcm-url "$url" 2>"$work/sensor.txt" ||
    fail "planemap-sensor --camera: $(cat "$work/sensor.txt")"
grep -q '30 in, 30 out' "$work/sensor.txt" || fail "planemap-sensor --camera: $(cat "$work/sensor.txt")"
