# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# For scripts that put modules as separate processes on udpm; to be sourced.

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
url="udpm://239.255.76.67:$((20000 + $$ % 20000))?ttl=0&recv_buf_size=4194304"

fail() {
    echo "$(basename "$0" .sh): $*" >&2
    exit 1
}

# Loopback and its route for multicast; taking the interface down removes the route.
raise_loopback() {
    ip link set lo up
    ip route replace 224.0.0.0/4 dev lo
}

# enter_own_network SCRIPT ARGS...: runs the script again in a network namespace with nothing but loopback, as root or as
# a user who may make one; OWN_NETWORK is then true. Else it goes on where it is, and OWN_NETWORK is false. Exits with 77,
# ctest's code for a skipped test, where multicast cannot be had.
# shellcheck disable=SC2034  # for the script that sources this
enter_own_network() {
    local unshare
    OWN_NETWORK=true
    if [[ -n "${PLANEMAP_OWN_NETWORK:-}" ]]; then
        raise_loopback
        return
    fi
    for unshare in "unshare --net" "unshare --net --map-root-user"; do
        if $unshare ip link set lo up 2>/dev/null; then
            PLANEMAP_OWN_NETWORK=1 exec $unshare "$@"
        fi
    done
    OWN_NETWORK=false
    if ! ip route get 239.255.76.67 >/dev/null 2>&1; then
        echo "SKIP: no network namespace may be made here, and this network has no route for multicast"
        exit 77
    fi
}

# make_hosts NAME NAME: two hosts, each a network namespace inside the one that the script is in, with their cables here;
# their programs hear each other once connect_hosts is called.
declare -A host_pid=()
link_pid=
make_hosts() {
    local name number=0
    for name in "$@"; do
        unshare --net sleep infinity &
        host_pid[$name]=$!
        while [[ "$(readlink "/proc/${host_pid[$name]}/ns/net")" == "$(readlink /proc/$$/ns/net)" ]]; do sleep 0.01; done
        number=$((number + 1))
        ip link add "to_$name" type veth peer name eth0 netns "${host_pid[$name]}"
        ip link set "to_$name" up
        on "$name" ip link set lo up
        on "$name" ip address add "10.77.0.$number/24" dev eth0
        on "$name" ip link set eth0 up
        on "$name" ip route add 224.0.0.0/4 dev eth0
    done
}
# on HOST COMMAND...; and in place of this subshell, so that its process id is the command's.
on() { nsenter --net="/proc/${host_pid[$1]}/ns/net" "${@:2}"; }
exec_on() { exec nsenter --net="/proc/${host_pid[$1]}/ns/net" setpriv --pdeathsig TERM "${@:2}"; }
# connect_hosts LOSSY_LINK LOSS JITTER_MS: until disconnect_hosts, which sets udp_sent and udp_lost to what crossed.
connect_hosts() {
    local names=("${!host_pid[@]}")
    "$1" "${names[@]/#/to_}" "$2" "$3" >"$work/link.txt" &
    link_pid=$!
    sleep 0.2
}
disconnect_hosts() {
    local word
    kill -TERM "$link_pid"
    wait "$link_pid"
    link_pid=
    # shellcheck disable=SC2034  # for the script that sources this
    read -r word udp_sent word udp_lost <"$work/link.txt"
}
stop_hosts() { kill "${host_pid[@]}" $link_pid 2>/dev/null || true; }

# events LOG CHANNEL: how many events of a channel an LCM log holds.
events() {
    perl -e '
        open(my $log, "<:raw", $ARGV[0]) or die "$ARGV[0]: $!\n";
        my $count = 0;
        while (read($log, my $head, 28) == 28) {
            my ($sync, $number, $utime, $channel_size, $data_size) = unpack("N q> q> N N", $head);
            die "$ARGV[0]: a record does not start with the sync word\n" if $sync != 0xEDA1DA01;
            read($log, my $channel, $channel_size);
            seek($log, $data_size, 1);
            $count++ if $channel eq $ARGV[1];
        }
        print $count;' "$1" "$2"
}

# wait_for_modules LOG [PREFIX]: until a running tools/launch --no-sensor --log LOG has recorded that the segmentation is there:
# every module says so on the bus once a second.
wait_for_modules() {
    local attempt
    for ((attempt = 0; attempt < 150; attempt++)); do
        [[ -f "$1" && "$(events "$1" "${2:-}PLANEMAP_STATUS_SEGMENTATION")" -gt 0 ]] && return
        sleep 0.1
    done
}

# launch ARGS...: planemap-launch of $bin with $url in place of this subshell; its process id goes into launch_pid.
launch() { exec setpriv --pdeathsig TERM "$bin/planemap-launch" --lcm-url "$url" "$@"; }
launch_on() { exec_on "$1" "$bin/planemap-launch" --lcm-url "$url" "${@:2}"; }

# replay LOG RECORDED OUTPUT PLAYER-ARGS...: plays what a camera sent in LOG into the modules; all that is on the bus goes
# into the log RECORDED, and the map into the folder OUTPUT. Returns the exit code of what went wrong.
replay() {
    local log="$1" recorded="$2" output="$3" code=0
    shift 3
    launch --no-sensor --log "$recorded" --output "$output" &
    launch_pid=$!
    wait_for_modules "$recorded"
    lcm-logplayer "$@" --lcm-url="$url" -e 'OPENNI_FRAME|PLANEMAP_CAMERA_INFO' "$log" >/dev/null || return
    sleep 1
    kill -TERM "$launch_pid"
    wait "$launch_pid" || code=$?
    launch_pid=
    return "$code"
}

# When the script ends, the launch still running is stopped and the folder $work removed.
stop_launch_at_exit() {
    launch_pid=
    trap '[[ -z "$launch_pid" ]] || ! kill -TERM "$launch_pid" 2>/dev/null || wait "$launch_pid" || true; rm -rf "$work"' EXIT
}
