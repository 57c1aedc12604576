#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# process_test.sh BIN: launch, record, replay. The modules as separate processes on udpm, in a network of their own:
#   1. a simulated camera at 30 Hz goes through all modules; lcm-logger must have every frame, and a map must come out;
#   2. that log goes into the modules without a sensor, and a map must come out again;
#   3. who joins in the middle of a slow recording has camera, trajectory and map within two seconds of the wall clock.
# Exits with 77, ctest's code for a skipped test, where multicast cannot be had.
set -euo pipefail

bin="$1"
frames=90

source "$(dirname "${BASH_SOURCE[0]}")/own_network.sh"
enter_own_network "$0" "$@"

work="$(mktemp -d)"
stop_launch_at_exit

# expect_map LOG FOLDER: map messages on the bus, and the map in the output folder.
expect_map() {
    [[ "$(events "$1" PLANEMAP_MAP)" -gt 0 ]] || fail "$1 holds no PLANEMAP_MAP"
    [[ "$(events "$2/plane_map.lcmlog" PLANEMAP_MAP)" -eq 1 ]] || fail "$2/plane_map.lcmlog holds not one map"
}

echo "== launch and record"
(launch "sim:office?frames=$frames" --rate 30 --log "$work/live.lcmlog" --output "$work/live") ||
    fail "tools/launch ended with code $?"
recorded="$(events "$work/live.lcmlog" OPENNI_FRAME)"
[[ "$recorded" -eq "$frames" ]] || fail "$recorded of $frames frames were recorded"
expect_map "$work/live.lcmlog" "$work/live"

echo "== replay"
replay "$work/live.lcmlog" "$work/replay.lcmlog" "$work/replay" || fail "the replay ended with code $?"
replayed="$(events "$work/replay.lcmlog" OPENNI_FRAME)"
[[ "$replayed" -eq "$frames" ]] || fail "$replayed of $frames frames arrived from the replay"
expect_map "$work/replay.lcmlog" "$work/replay"
echo "== late"
launch 'sim:office?frames=60&width=320&height=240' --rate 5 --no-octomap --output "$work/late" 2>"$work/late.stderr" &
launch_pid=$!
sleep 6
timeout -s INT 2 lcm-logger --quiet --lcm-url="$url" "$work/late.lcmlog" || true
kill -TERM "$launch_pid"
wait "$launch_pid" || fail "tools/launch ended with code $?"
launch_pid=
for channel in PLANEMAP_CAMERA_INFO PLANEMAP_TRAJECTORY PLANEMAP_MAP; do
    [[ "$(events "$work/late.lcmlog" "$channel")" -gt 0 ]] || fail "who comes late has no $channel within two seconds"
done
echo "process_test: $frames frames recorded and replayed, a map each time"
