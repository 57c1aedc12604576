#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# kill_test.sh BIN COMPARE_MAPS [SECONDS [SEED]]: modules are killed (SIGKILL) at random moments for so long (default 12),
# each at least once, while a camera walks slowly. Afterwards every one must have been started again, nothing may be left behind, and the map must have
# the planes of an undisturbed run: of those over 1 m2 each with a partner of the same place that overlaps it by half or
# more (compare_maps). In a network of its own; exits with 77, ctest's code for a skipped test, where multicast cannot be
# had.
set -euo pipefail

bin="$1"
compare_maps="$2"
seconds="${3:-${PLANEMAP_KILL_SECONDS:-12}}"
seed="${4:-7}"
url="udpm://239.255.76.67:$((20000 + $$ % 20000))?ttl=0&recv_buf_size=4194304"
rate=15
# The input goes on for as long as the last round of kills may take. The longer the kills, the slower the camera walks the
# same way: an odometry that dies again and again is started ever later, and is to find a place that it knows.
slower="$(awk -v s="$seconds" 'BEGIN { f = 12 / s; printf "speed=%.4f&turn=%.4f", 0.15 * f, 8 * f }')"
input="sim:office?frames=$((rate * (seconds + 14)))&width=320&height=240&$slower"
smallest_iou=0.5

source "$(dirname "${BASH_SOURCE[0]}")/own_network.sh"
enter_own_network "$0" "$@"

work="$(mktemp -d)"
stop_launch_at_exit
fail() {
    echo "kill_test: seed $seed: $*" >&2
    grep -v "Hz" "$work/said" >&2 || true
    exit 1
}
process_of() { pgrep -f "^$bin/planemap-$1 .*${url%%\?*}" || true; }

echo "kill_test: $seconds s of kills, seed $seed"
: >"$work/said"
"$bin/planemap-run" "$input" -q --no-octomap --output "$work/undisturbed" >/dev/null || fail "planemap-run ended with $?"
launch "$input" --rate "$rate" --output "$work/killed" 2>"$work/said" &
launch_pid=$!
for ((attempt = 0; attempt < 100; attempt++)); do
    [[ -z "$(process_of sensor)" ]] || break
    sleep 0.1
done

# All six in a random order, then again, a moment apart.
RANDOM="$seed"
declare -A kills=()
SECONDS=0
sleep 1.5
while [[ "$SECONDS" -lt "$seconds" || "${#kills[@]}" -lt 6 ]]; do
    order=()
    for name in sensor segmentation odometry graph map octomap; do order+=("$RANDOM $name"); done
    mapfile -t order < <(printf '%s\n' "${order[@]}" | sort -n | cut -d' ' -f2)
    for module in "${order[@]}"; do
        kill -0 "$launch_pid" 2>/dev/null || fail "planemap-launch ended"
        pid="$(process_of "$module")"
        if [[ -n "$pid" ]]; then
            kill -KILL "$pid"
            kills[$module]=$((${kills[$module]:-0} + 1))
        fi
        sleep "$((1 + RANDOM % 2)).$((RANDOM % 10))"
    done
done

# The recording is played to its end, and the run ends by itself.
code=0
wait "$launch_pid" || code=$?
launch_pid=
[[ "$code" -eq 0 ]] || fail "planemap-launch ended with code $code"
for module in sensor segmentation odometry graph map octomap; do
    said="$(grep -c "planemap-launch.*: $module was ended by signal 9" "$work/said" || true)"
    [[ "$said" -eq "${kills[$module]}" ]] || fail "$module was killed ${kills[$module]} times and $said were said"
    grep -q "started again: .*$module ${kills[$module]}" "$work/said" || fail "$module was not started again each time"
done
left="$(pgrep -f "${url%%\?*}" | grep -vx "$$" || true)"
[[ -z "$left" ]] || fail "left behind: $(ps -o pid,args -p "$left")"
left="$(cd "$work/killed" && find . -name '.partial*' -o -name '*.new')"
[[ -z "$left" ]] || fail "left behind: $left"
for file in plane_map.lcmlog trajectory.txt octomap.bt; do
    [[ -s "$work/killed/$file" ]] || fail "no $file"
done
"$compare_maps" "$work/undisturbed/plane_map.lcmlog" "$work/killed/plane_map.lcmlog" "$smallest_iou" ||
    fail "the map lacks planes of the undisturbed run"
echo "kill_test: $(for m in "${!kills[@]}"; do echo "$m ${kills[$m]}"; done | sort | paste -sd, -) killed; the map is there"
