#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# hosts_test.sh BIN LOSSY_LINK: the sensor on one host and all else on another, each a network namespace, with a cable
# between that loses one packet in a hundred and delays each by up to 5 ms, and so puts them out of order:
#   1. with the URL that every program has by itself (ttl=0) not one packet leaves a host;
#   2. with ttl=1 the frames cross, of two cameras on one bus, told apart by --channel-prefix: what arrives is used, what
#      is lost is counted, no session gets a frame of the other's, and each makes its map.
# Exits with 77, ctest's code for a skipped test, where no network namespace may be made.
set -euo pipefail

bin="$1"
lossy_link="$2"
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
frames=100

fail() {
    echo "hosts_test: $*" >&2
    tail -n 8 "$work"/*.err >&2 || true
    exit 1
}

source "$(dirname "${BASH_SOURCE[0]}")/own_network.sh"
enter_own_network "$0" "$@"
if ! "$OWN_NETWORK"; then
    echo "SKIP: no network namespace may be made here"
    exit 77
fi
work="$(mktemp -d)"
launches=()
cleanup() {
    [[ "${#launches[@]}" -eq 0 ]] || kill -TERM "${launches[@]}" 2>/dev/null || true
    stop_hosts
    wait || true
    rm -rf "$work"
}
trap cleanup EXIT
make_hosts camera robot

echo "== nothing leaves a host by itself"
connect_hosts "$lossy_link" 0 0
unset LCM_DEFAULT_URL
for name in segmentation odometry graph map octomap; do
    exec_on robot "$bin/planemap-$name" 2>"$work/$name.err" &
    launches+=("$!")
done
sleep 0.5
on camera "$bin/planemap-sensor" "sim:office?frames=30&width=160&height=120" --rate 30 2>"$work/sensor.err" || fail "planemap-sensor ended with code $?"
on camera "$root/tools/launch" --bin "$bin" "sim:office?frames=30&width=160&height=120" --rate 30 --output "$work/default" 2>"$work/default.err" ||
    fail "tools/launch ended with code $?"
kill -TERM "${launches[@]}"
wait "${launches[@]}"
launches=()
disconnect_hosts
[[ "$udp_sent" -eq 0 ]] || fail "$udp_sent packets left a host although ttl is 0"

echo "== two cameras on one host, their maps on the other"
url='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304'
connect_hosts "$lossy_link" 0.01 5
# So that the kernel gives up incomplete packets while the test runs; only root may say so.
gives_up=false
if on robot bash -c 'echo 1 >/proc/sys/net/ipv4/ipfrag_time' 2>/dev/null; then gives_up=true; fi
# camera/NAME NUMBER-OF-FRAMES
start_camera() {
    on camera "$bin/planemap-sensor" "sim:office?frames=$2&width=320&height=240" --rate 15 --lcm-url "$url" --channel-prefix "$1/" \
        2>"$work/$1-sensor.err"
}
for name in left right; do
    launch_on robot --no-sensor --channel-prefix "$name/" --log "$work/$name.lcmlog" --output "$work/$name" 2>"$work/$name.err" &
    launches+=("$!")
done
for name in left right; do wait_for_modules "$work/$name.lcmlog" "$name/"; done
start_camera right $((frames / 2)) &
right=$!
start_camera left "$frames" || fail "planemap-sensor ended with code $?"
wait "$right" || fail "planemap-sensor ended with code $?"
sleep 1
kill -TERM "${launches[@]}"
for pid in "${launches[@]}"; do wait "$pid" || fail "tools/launch ended with code $?"; done
launches=()
disconnect_hosts
echo "$udp_lost of $udp_sent packets were lost"
[[ "$udp_lost" -gt 0 ]] || fail "the cable lost nothing"

# expect_session NAME FRAMES OTHER
expect_session() {
    local arrived line received missed
    arrived="$(events "$work/$1.lcmlog" "$1/OPENNI_FRAME")"
    [[ "$(events "$work/$1.lcmlog" "$3/OPENNI_FRAME")" -eq 0 ]] || fail "$1 recorded frames of $3"
    line="$(grep "segmentation: .*stopped" "$work/$1.err" | tail -n 1)"
    echo "$1: $arrived of $2 frames arrived; $line"
    received="$(sed 's/.* \([0-9]*\) in,.*/\1/' <<<"$line")" missed="$(sed 's/.* \([0-9]*\) missed.*/\1/' <<<"$line")"
    # A frame that is lost at the end is missed by nobody.
    [[ "$missed" -gt 0 && $((received + missed)) -le "$2" && $((received + missed)) -gt $(($2 - 5)) ]] ||
        fail "$1: of $2 frames the segmentation counts $received received and $missed missed"
    ! "$gives_up" || grep -q "UDP packets reached this host incomplete" "$work/$1.err" ||
        fail "$1 did not say that packets were incomplete"
    [[ "$arrived" -gt $(($2 / 2)) && "$arrived" -lt "$2" ]] || fail "$1: $arrived of $2 frames arrived"
    [[ "$(stat -c %s "$work/$1/plane_map.lcmlog")" -gt 400 ]] || fail "$1: the map is empty"
}
expect_session left "$frames" right
expect_session right $((frames / 2)) left
echo "hosts_test: two cameras on one host, two maps on the other"
