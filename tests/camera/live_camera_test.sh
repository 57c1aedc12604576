#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# live_camera_test.sh BIN: cameras without hardware.
#   1. planemap-sensor on the virtual camera: frames, and each of its faults as it is told;
#   2. an .oni recorded from it, mapped twice with the same bytes; a truncated one;
#   3. planemap-run on the live camera; 4. a Kinect v1 by fakenect.
set -euo pipefail

bin="$1"
source "$(dirname "${BASH_SOURCE[0]}")/../tools/own_network.sh"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
world='sim:office?width=320&height=240&frames=200'
size='--camera-resolution 320x240'

fail() {
    echo "live_camera_test: $*" >&2
    exit 1
}

# sense LOG SECONDS [camera options] -- [sensor options]: planemap-sensor on the virtual camera into a log, what it says
# into LOG.txt.
sense() {
    local log="$1" seconds="$2" faults=()
    shift 2
    while [[ "$1" != -- ]]; do faults+=("$1") && shift; done
    shift
    # shellcheck disable=SC2086
    timeout 60 "$bin/planemap-virtual-camera" "${input:-$world}" "${faults[@]}" -- planemap-sensor openni2 $size \
        --duration "$seconds" --lcm-url "file://$log?mode=w" "$@" >"$log.txt" 2>&1 ||
        fail "the sensor ended with code $?: $(cat "$log.txt")"
}
# says LOG TEXT: in what the sensor said.
says() { grep -qF "$2" "$1.txt" || fail "nothing of '$2' in: $(cat "$1.txt")"; }
# frames LOG LEAST MOST
frames() {
    local n
    n="$(events "$1" OPENNI_FRAME)"
    [[ "$n" -ge "$2" && "$n" -le "$3" ]] || fail "$n frames in $1, not $2 to $3: $(cat "$1.txt")"
}

echo "== list"
timeout 20 "$bin/planemap-virtual-camera" "$world" -- planemap-sensor --list >"$work/list.txt" || fail "--list failed"
grep -q 'VIRTUAL0001' "$work/list.txt" && grep -q '320x240 at 30 Hz, 100 um' "$work/list.txt" ||
    fail "--list says: $(cat "$work/list.txt")"
code=0
timeout 20 "$bin/planemap-virtual-camera" "$world" -- planemap-sensor openni2:NOBODY >"$work/nobody.txt" 2>&1 || code=$?
[[ "$code" -eq 1 ]] && grep -q 'openni2:NOBODY' "$work/nobody.txt" || fail "code $code: $(cat "$work/nobody.txt")"

echo "== frames, and a recording of them"
sense "$work/good.lcmlog" 2.5 -- --record "$work/good.oni"
frames "$work/good.lcmlog" 40 80
says "$work/good.lcmlog" 'stopped:'
[[ -s "$work/good.oni" && ! -e "$work/.good.oni.partial" ]] || fail "no recording in place"

echo "== faults"
sense "$work/drops.lcmlog" 2.5 --drop 0.2 --color-drop 0.2 --jitter-ms 5 --registration ignored --
says "$work/drops.lcmlog" 'depth frames without a colour frame near in time'
says "$work/drops.lcmlog" 'colour frames without a depth frame near in time'
says "$work/drops.lcmlog" 'frames that the camera did not send'
input="$world&registered=0" sense "$work/refused.lcmlog" 1 --registration refused --
says "$work/refused.lcmlog" 'registration was asked for and is not done: its colour is unregistered'
input="$world&registered=0" sense "$work/late.lcmlog" 1 --registration late --
! grep -q unregistered "$work/late.lcmlog.txt" || fail "registration is not asked for again once the streams run"
sense "$work/astra.lcmlog" 1 --color no --
says "$work/astra.lcmlog" 'depth alone is used'
frames "$work/astra.lcmlog" 10 35
sense "$work/unplugged.lcmlog" 5 --unplug-s 1 --back-s 0.5 --
says "$work/unplugged.lcmlog" 'unplugged'
says "$work/unplugged.lcmlog" 'frames come again'
frames "$work/unplugged.lcmlog" 40 130
sense "$work/frozen.lcmlog" 5.5 --freeze-s 1 --
says "$work/frozen.lcmlog" 'sends nothing any more'
says "$work/frozen.lcmlog" 'frames come again'

echo "== recording, twice the same bytes"
for run in a b; do
    timeout 120 "$bin/planemap-run" "$work/good.oni" --output "$work/$run" --quiet --no-octomap >"$work/$run.txt" 2>&1 ||
        fail "planemap-run ended with code $?: $(cat "$work/$run.txt")"
done
for file in trajectory.txt planes.json plane_map.lcmlog; do
    cmp "$work/a/$file" "$work/b/$file" || fail "$file differs between two runs of one recording"
done
[[ "$(grep -vc '^#' "$work/a/trajectory.txt")" -ge 30 ]] || fail "few frames of the recording were tracked"
head -c 200000 "$work/good.oni" >"$work/cut.oni"
code=0
timeout 20 "$bin/planemap-run" "$work/cut.oni" --output "$work/cut" >"$work/cut.txt" 2>&1 || code=$?
[[ "$code" -eq 1 && "$(wc -l <"$work/cut.txt")" -eq 1 ]] && grep -q 'cut short at byte' "$work/cut.txt" ||
    fail "a truncated recording: code $code, $(cat "$work/cut.txt")"

echo "== a recording that its disk does not take ends, and nothing else does"
# recorded FILE FRAMES: the sensor went on to its end, said once at once and once at its end that the recording ends, and
# what is recorded is whole.
recorded() {
    [[ "$code" -eq 1 && "$(grep -c 'warning.*the recording ends here' "$work/full.txt")" -eq 1 ]] &&
        tail -n 1 "$work/full.txt" | grep -q 'planemap-sensor: .*the recording ends here.*is whole' ||
        fail "a full disk: code $code: $(cat "$work/full.txt")"
    grep -qE "stopped:.* ($2) out" "$work/full.txt" || fail "the frames did not go on: $(cat "$work/full.txt")"
    timeout 20 "$bin/planemap-sensor" "$1" --speed 0 --lcm-url "file://$work/replay.lcmlog?mode=w" >"$work/replay.txt" 2>&1 ||
        fail "what was recorded is not whole: $(cat "$work/replay.txt")"
}
record() {
    # shellcheck disable=SC2086
    timeout 60 "$bin/planemap-virtual-camera" "$world" -- planemap-sensor openni2 $size --duration "$2" --record "$1" \
        --lcm-url 'udpm://239.255.76.67:7693?ttl=0' >"$work/full.txt" 2>&1
}
code=0
(ulimit -f 500 && record "$work/limited.oni" 8) || code=$?
recorded "$work/limited.oni" '[6-9][0-9]|[12][0-9][0-9]'
mkdir "$work/disk"
export bin work world size
export -f record
if unshare -rm mount -t tmpfs tmpfs "$work/disk" 2>/dev/null; then
    code=0
    unshare -rm bash -c 'mount -t tmpfs -o size=65m tmpfs "$work/disk" && {
        record "$work/disk/a.oni" 4; code=$?; cp "$work/disk/a.oni" "$work/disk.oni"; exit "$code"; }' || code=$?
    recorded "$work/disk.oni" '[2-9][0-9]|1[0-9][0-9]'
    grep -q 'its disk is nearly full' "$work/full.txt" || fail "not told as a full disk: $(cat "$work/full.txt")"
fi

echo "== live map"
# shellcheck disable=SC2086
timeout 120 "$bin/planemap-virtual-camera" "$world" -- planemap-run openni2 $size --duration 3 --output "$work/live" \
    --quiet --no-octomap >"$work/live.txt" 2>&1 || fail "planemap-run ended with code $?: $(cat "$work/live.txt")"
[[ -s "$work/live/planes.json" ]] || fail "a live run leaves no planes"

fakenect="$(find /usr/lib -path '*/fakenect/libfreenect.so.0.5' -print -quit)"
if [[ -z "$fakenect" ]]; then
    echo "SKIP: libfreenect's fakenect library is not here"
    exit 0
fi
echo "== a Kinect v1"
"$bin/planemap-convert" 'sim:office?frames=20' --to fakenect --quiet --output "$work/kinect" >/dev/null || fail "no recording for fakenect"
LD_PRELOAD="$fakenect" FAKENECT_PATH="$work/kinect" timeout 60 "$bin/planemap-sensor" freenect --duration 2 \
    --lcm-url "file://$work/kinect.lcmlog?mode=w" >"$work/kinect.lcmlog.txt" 2>&1 ||
    fail "freenect: code $?: $(cat "$work/kinect.lcmlog.txt")"
says "$work/kinect.lcmlog" 'raw depth'
frames "$work/kinect.lcmlog" 10 90
echo "live_camera_test: all cameras do what they say"
