#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# launch_test.sh BIN: what planemap-launch refuses, it refuses before it starts or touches anything; a recording that ends,
# ends nothing else; a module that dies is started again; and a stop takes less than two seconds and leaves nothing.
set -euo pipefail

bin="$1"
launch="$bin/planemap-launch"
work="$(mktemp -d)" said="$(mktemp)"
trap 'rm -rf "$work" "$said"' EXIT

# refused WORDS ARGUMENTS...: launch must end with an error that contains the words, and leave the folder as it was.
refused() {
    local words="$1" before after
    shift
    before="$(cd "$work" && find . -type f -exec sha256sum {} + | sort; find "$work" | sort)"
    [[ "$*" == *--lcm-url* ]] || set -- --lcm-url 'udpm://239.255.76.67:7697?ttl=0' "$@"
    if "$launch" --bin "$bin" "$@" >/dev/null 2>"$said"; then
        echo "launch_test: launch $* was not refused" >&2
        exit 1
    fi
    grep -qF -- "$words" "$said" && [[ "$(wc -l <"$said")" -eq 1 ]] || {
        echo "launch_test: launch $*: not '$words' in one line:" >&2
        cat "$said" >&2
        exit 1
    }
    after="$(cd "$work" && find . -type f -exec sha256sum {} + | sort; find "$work" | sort)"
    [[ "$before" == "$after" ]] || {
        echo "launch_test: launch $* touched files: $before became $after" >&2
        exit 1
    }
}

echo precious >"$work/existing.lcmlog"
mkdir "$work/used"
refused "no_such" no_such --log "$work/existing.lcmlog" --output "$work/out"
refused "existing.lcmlog is there already" sim:office --log "$work/existing.lcmlog" --output "$work/out"
refused "no_such" no_such --log "$work/new/new.lcmlog" --output "$work/out"
refused "the channel prefix 'two words'" --channel-prefix 'two words' --output "$work/out"
refused "castle" sim:castle --output "$work/out"
refused "rate" --rate fast --output "$work/out"
refused "rate" --rate=-3 --output "$work/out"
refused "speed" --speed -1 --output "$work/out"
refused "--no-such-flag" --no-such-flag --output "$work/out"
refused "hears nobody but itself" --lcm-url memq:// --output "$work/out"
refused "'tll' is not an option of udpm" --lcm-url 'udpm://239.255.76.67:7697?tll=1' --output "$work/out"
refused "nonsense://" --lcm-url nonsense:// --output "$work/out"
refused "--no-sensor takes no INPUT" --no-sensor sim:office --output "$work/out"
refused "--rate" --no-sensor --rate 5 --output "$work/out"
refused "is a file" --output "$work/existing.lcmlog"
touch "$work/used/.partial.lock"
(
    flock 8
    refused "another run" --output "$work/used"
) 8>"$work/used/.partial.lock"

# Stand-ins for the programs, and an lcm-logger that ends as on a full disk: the launch must go on until the sensor ends.
stand_ins="$work/stand-ins"
mkdir "$stand_ins"
for name in segmentation odometry graph map octomap; do
    printf '#!/bin/bash\ntrap "exit 0" TERM\nfor ((i = 0; i < 300; ++i)); do sleep 0.1; done\n' >"$stand_ins/planemap-$name"
done
printf '#!/bin/bash\n[[ "$1" == --check ]] || { $AT_START; sleep 2; echo sensor done >&2; }\n' >"$stand_ins/planemap-sensor"
printf '#!/bin/bash\nsleep "$LOGGER_LIVES"\necho "No space left on device" >&2\nexit 1\n' >"$stand_ins/lcm-logger"
chmod +x "$stand_ins"/*
for lives in 0 3; do # it ends before the sensor starts, and while it plays
    code=0
    AT_START=true LOGGER_LIVES="$lives" PATH="$stand_ins:$PATH" "$launch" --bin "$stand_ins" --lcm-url tcpq://127.0.0.1:1 \
        --log "$work/full-$lives.lcmlog" --output "$work/recorded" 2>"$said" || code=$?
    if [[ "$code" -ne 1 || "$(grep -c "lcm-logger ended" "$said")" -ne 2 ]] || ! grep -q "sensor done" "$said" ||
        ! tail -n 1 "$said" | grep -q "lcm-logger ended.*full-$lives.lcmlog" ||
        grep -q "stopping the others" "$said"; then
        echo "launch_test: the recording ended, code $code:" >&2
        cat "$said" >&2
        exit 1
    fi
done
[[ ! -e "$work/recorded/.partial.lock" ]] || { echo "launch_test: the lock was left behind" >&2 && exit 1; }

# The folder is another run's now: its lock stays.
lock="$work/recorded/.partial.lock"
printf '#!/bin/bash\nrm -f "%s"\ntouch "%s"\n' "$lock" "$lock" >"$stand_ins/take"
chmod +x "$stand_ins/take"
AT_START="$stand_ins/take" "$launch" --bin "$stand_ins" --lcm-url tcpq://127.0.0.1:1 --output "$work/recorded" 2>"$said"
[[ -e "$lock" ]] || { echo "launch_test: another run's lock was removed" >&2 && exit 1; }

# A module that dies is started again, later each time, and said; the others live on.
printf '#!/bin/bash\necho "$$" >>"$WORK/graph.lives"; sleep 0.2; kill -SEGV $$\n' >"$stand_ins/planemap-graph"
printf '#!/bin/bash\n[[ "$1" == --check ]] && exit\ntrap "exit 0" TERM\nfor ((i = 0; i < 45; ++i)); do sleep 0.1; done\n' \
    >"$stand_ins/planemap-sensor"
chmod +x "$stand_ins"/*
code=0
WORK="$work" "$launch" --bin "$stand_ins" --lcm-url tcpq://127.0.0.1:1 --output "$work/dying" 2>"$said" || code=$?
lives="$(wc -l <"$work/graph.lives")"
if [[ "$code" -ne 0 || "$lives" -lt 3 || "$lives" -gt 6 ]] || ! grep -q "graph was ended by signal 11.*again in 0.5 s" "$said" ||
    ! grep -q "graph was ended by signal 11.*again in 1.0 s" "$said" || ! grep -q "started again: graph $((lives - 1))" "$said" ||
    grep -q "map was ended" "$said"; then
    echo "launch_test: a module that dies: code $code, $lives lives:" >&2
    cat "$said" >&2
    exit 1
fi

# A stop takes less than two seconds, also where a module does not obey, and leaves no process and no lock.
printf '#!/bin/bash\ntrap "" TERM\necho "$$" >"$WORK/map.pid"\nwhile true; do sleep 0.1; done\n' >"$stand_ins/planemap-map"
printf '#!/bin/bash\ntrap "exit 0" TERM\nfor ((i = 0; i < 300; ++i)); do sleep 0.1; done\n' >"$stand_ins/planemap-graph"
chmod +x "$stand_ins"/*
WORK="$work" "$launch" --bin "$stand_ins" --lcm-url tcpq://127.0.0.1:1 --output "$work/stubborn" 2>"$said" &
pid=$!
sleep 3
began="$(date +%s%N)"
kill -TERM "$pid"
code=0
wait "$pid" || code=$?
took_ms=$((($(date +%s%N) - began) / 1000000))
if [[ "$code" -ne 1 || "$took_ms" -gt 2000 ]] || ! grep -q "map did not stop in time and was killed" "$said" ||
    kill -0 "$(cat "$work/map.pid")" 2>/dev/null || [[ -e "$work/stubborn/.partial.lock" ]]; then
    echo "launch_test: a stop: code $code, $took_ms ms:" >&2
    cat "$said" >&2
    exit 1
fi
echo "launch_test: all refused, nothing touched; what ends or dies, ends nothing else; a stop leaves nothing"
