#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# outage_test.sh BIN: the modules as separate processes outlive their network and disk.
#   1. tcpq without a server: all wait, say so once, and stop within a second when told to; with a server that comes,
#      is killed and comes again, a map comes out; one that hangs is left, and a stop does not wait for it.
#   2. udpm, with the interface down for two seconds in the middle: a map comes out. A sensor and a map that start again
#      are said.
#   3. The output folder is gone, with a file in its place: planemap-map goes on, and ends with code 1 and one line.
# Exits with 77, ctest's code for a skipped test, where there is no network namespace to take down.
set -euo pipefail

bin="$1"
modules=(segmentation odometry graph map octomap)

source "$(dirname "${BASH_SOURCE[0]}")/own_network.sh"
enter_own_network "$0" "$@"
if ! "$OWN_NETWORK"; then
    echo "SKIP: no network namespace may be made here"
    exit 77
fi

work="$(mktemp -d)"
declare -A pid_of=()
server=
cleanup() {
    for pid in "${pid_of[@]}" $server; do kill -KILL "$pid" 2>/dev/null || true; done
    rm -rf "$work"
}
trap cleanup EXIT

fail() {
    echo "outage_test: $*" >&2
    tail -n 20 "$work"/*.err >&2 || true
    exit 1
}

# start NAME ARGUMENTS...: planemap-NAME with its stderr in NAME.err.
start() {
    local name="$1"
    shift
    "$bin/planemap-$name" "$@" 2>"$work/$name.err" &
    pid_of[$name]=$!
}
start_modules() {
    local name
    for name in "${modules[@]}"; do
        if [[ "$name" == map ]]; then
            start map --lcm-url "$1" --output "$work/out"
        else
            start "$name" --lcm-url "$1"
        fi
    done
}
expect_alive() {
    local name
    for name in "${modules[@]}"; do
        kill -0 "${pid_of[$name]}" 2>/dev/null || fail "planemap-$name has ended: $1"
    done
}
# stop NAME CODE: SIGTERM; it must end within a second (two are allowed: finishing is work too) and with the code.
stop() {
    local name="$1" code=0 began="${EPOCHREALTIME/./}"
    kill -TERM "${pid_of[$name]}" || fail "planemap-$name has ended before it was told to"
    wait "${pid_of[$name]}" || code=$?
    local took=$((${EPOCHREALTIME/./} - began))
    [[ "$code" -eq "$2" ]] || fail "planemap-$name ended with code $code, not $2"
    [[ "$took" -lt 2000000 ]] || fail "planemap-$name took $took us to stop"
    unset "pid_of[$name]"
}
stop_modules() {
    local name
    for name in "${modules[@]}"; do stop "$name" 0; done
}
expect_map() {
    [[ -s "$work/out/plane_map.lcmlog" ]] || fail "no map was written: $1"
    # An empty map's event is of some 100 bytes.
    [[ "$(stat -c %s "$work/out/plane_map.lcmlog")" -gt 400 ]] || fail "the map is empty: $1"
}
said() { grep -c "$2" "$work/$1.err" || true; }
# expect_said NAME TEXT: within ten seconds; on a busy machine a module comes to it late.
expect_said() {
    local try
    for ((try = 0; try < 100; try++)); do
        [[ "$(said "$1" "$2")" -eq 0 ]] || return 0
        sleep 0.1
    done
    fail "planemap-$1 did not say: $2"
}

echo "== tcpq without a server"
port=$((20000 + $$ % 20000))
start_modules "tcpq://127.0.0.1:$port"
start sensor "sim:office?frames=150" --rate 30 --lcm-url "tcpq://127.0.0.1:$port"
sleep 2.2
expect_alive "there was no server"
for name in "${modules[@]}" sensor; do
    [[ "$(said "$name" "no connection")" -eq 1 ]] || fail "planemap-$name did not say once that there is no server"
done
kill -0 "${pid_of[sensor]}" || fail "planemap-sensor played its input to nobody"
if command -v java >/dev/null && [[ -f /usr/share/java/lcm.jar ]]; then
    echo "== a server that comes, is killed, and comes again"
    serve() {
        java -Djava.net.preferIPv4Stack=true -Xmx256m -cp /usr/share/java/lcm.jar lcm.lcm.TCPService "$port" >/dev/null 2>&1 &
        server=$!
    }
    serve
    sleep 4
    kill -KILL "$server"
    wait "$server" 2>/dev/null || true
    sleep 1
    expect_alive "the server was killed"
    serve
    wait "${pid_of[sensor]}" || fail "planemap-sensor ended with code $?"
    unset "pid_of[sensor]"
    sleep 1
    expect_alive "the server came again"
    for name in "${modules[@]}"; do
        [[ "$(said "$name" "connected after")" -eq 2 ]] || fail "planemap-$name did not connect twice"
    done
    stop_modules
    expect_map "tcpq"
    echo "== a server that hangs"
    hang() {
        start sensor "sim:office?frames=3000&width=320&height=240" --rate 30 --color raw --depth raw --lcm-url "tcpq://127.0.0.1:$port"
        sleep 3
        kill -STOP "$server"
        sleep "$1"
    }
    hang 1.5
    stop sensor 0  # while it waits for the server
    kill -CONT "$server"
    hang 6
    [[ "$(said sensor "no connection (the server hangs")" -ge 1 ]] || fail "planemap-sensor did not say that the server hangs"
    kill -CONT "$server"
    sleep 2.5
    [[ "$(said sensor "connected after")" -ge 1 ]] || fail "planemap-sensor did not find the server again"
    stop sensor 0
    kill -KILL "$server"
    wait "$server" 2>/dev/null || true
    server=
else
    stop sensor 0
    stop_modules
fi

echo "== the interface goes down for two seconds"
rm -rf "$work/out"
url="udpm://239.255.76.67:$port?ttl=0"
start_modules "$url"
sleep 1
start sensor "sim:office?frames=90" --rate 30 --lcm-url "$url"
sleep 1.5
ip link set lo down
sleep 2
expect_alive "the interface is down"
raise_loopback
wait "${pid_of[sensor]}" || fail "planemap-sensor ended with code $?"
unset "pid_of[sensor]"
sleep 1
expect_alive "the interface is up again"
[[ "$(said map "connected after")" -eq 1 ]] || fail "planemap-map did not connect again"
stop map 0
start map --lcm-url "$url" --output "$work/out"
start sensor "sim:office?frames=120" --rate 30 --lcm-url "$url"
wait "${pid_of[sensor]}" || fail "planemap-sensor ended with code $?"
unset "pid_of[sensor]"
expect_said odometry "the sensor started again"
expect_said map "were never received: the map is incomplete"
stop_modules
expect_map "udpm"

echo "== the output folder goes"
start map --lcm-url "$url" --output "$work/out" --map "$work/out/plane_map.lcmlog"
start graph --lcm-url "$url"
start odometry --lcm-url "$url"
start segmentation --lcm-url "$url"
modules=(segmentation odometry graph map)
sleep 1
rm -rf "$work/out"
touch "$work/out"
"$bin/planemap-sensor" "sim:office?frames=30" --rate 30 --lcm-url "$url" 2>"$work/sensor.err"
sleep 6
expect_alive "its folder is gone"
[[ "$(said map "the map is kept, trying every second")" -eq 1 ]] || fail "planemap-map did not say that it cannot write"
for name in segmentation odometry graph; do stop "$name" 0; done
stop map 1
[[ "$(said map "the map could not be written")" -eq 1 ]] || fail "planemap-map did not end with one line"
echo "outage_test: all modules outlived their network and disk"
