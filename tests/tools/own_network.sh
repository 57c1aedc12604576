# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# To be sourced, with the script's arguments: goes on in a network namespace with nothing but loopback, as root or as a
# user who may make one. OWN_NETWORK is then true; else the script goes on where it is, and it is false. Exits with 77,
# ctest's code for a skipped test, where multicast cannot be had.
# shellcheck disable=SC2034  # for the script that sources this
OWN_NETWORK=true

# Loopback and its route for multicast; taking the interface down removes the route.
raise_loopback() {
    ip link set lo up
    ip route replace 224.0.0.0/4 dev lo
}

if [[ -z "${PLANEMAP_OWN_NETWORK:-}" ]]; then
    for unshare in "unshare --net" "unshare --net --map-root-user"; do
        if $unshare ip link set lo up 2>/dev/null; then
            PLANEMAP_OWN_NETWORK=1 exec $unshare "$0" "$@"
        fi
    done
    # shellcheck disable=SC2034
    OWN_NETWORK=false
    if ! ip route get 239.255.76.67 >/dev/null 2>&1; then
        echo "SKIP: no network namespace may be made here, and this network has no route for multicast"
        exit 77
    fi
else
    raise_loopback
fi
