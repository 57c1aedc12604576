#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# live_map_test.sh BIN COMPARE_MAPS [LOG]: while nothing is dropped, the modules as separate processes on udpm give
# planemap-run's map of the same log: for a camera that walks, for one that stands still (its first keyframe is its only
# one), and, if given, for LOG. In a network of their own; exits with 77, ctest's code for a skipped test, where multicast
# cannot be had.
set -euo pipefail

bin="$1"
compare_maps="$2"
speed="${PLANEMAP_LIVE_SPEED:-0.5}" # of the recording: nothing may be dropped, on a busy machine neither

source "$(dirname "${BASH_SOURCE[0]}")/own_network.sh"
enter_own_network "$0" "$@"

work="$(mktemp -d)"
stop_launch_at_exit

# expect_the_same LOG NAME: LOG through planemap-run and through the processes.
expect_the_same() {
    echo "== $2"
    "$bin/planemap-run" "$1" --no-octomap -q --output "$work/$2/offline" >/dev/null || fail "planemap-run ended with $?"
    replay "$1" "$work/$2/live.lcmlog" "$work/$2/live" -s "$speed" 2>"$work/$2.stderr" || {
        local code=$?
        cat "$work/$2.stderr" >&2
        fail "the replay ended with code $code"
    }
    grep "stopped:" "$work/$2.stderr" || true
    "$compare_maps" "$work/$2/offline/plane_map.lcmlog" "$work/$2/live/plane_map.lcmlog" ||
        fail "$2: the live map is not planemap-run's"
}

"$bin/planemap-simulate" 'sim:office?frames=90' --output "$work/walk/walk.lcmlog" >/dev/null
"$bin/planemap-simulate" 'sim:office?frames=20&speed=0.01&turn=1' --output "$work/still/still.lcmlog" >/dev/null
expect_the_same "$work/still/still.lcmlog" still
expect_the_same "$work/walk/walk.lcmlog" walk
if [[ $# -gt 2 ]]; then expect_the_same "$3" given; fi
echo "live_map_test: the same maps live as offline"
