#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# launch_test.sh BIN: what tools/launch refuses, it refuses before it starts or touches anything.
set -euo pipefail

bin="$1"
launch="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/tools/launch"
work="$(mktemp -d)" said="$(mktemp)"
trap 'rm -rf "$work" "$said"' EXIT

# refused WORDS ARGUMENTS...: launch must end with an error that contains the words, and leave the folder as it was.
refused() {
    local words="$1" before after
    shift
    before="$(cd "$work" && find . -type f -exec sha256sum {} + | sort; find "$work" | sort)"
    if "$launch" --bin "$bin" --lcm-url 'udpm://239.255.76.67:7697?ttl=0' "$@" >/dev/null 2>"$said"; then
        echo "launch_test: launch $* was not refused" >&2
        exit 1
    fi
    grep -qF -- "$words" "$said" || {
        echo "launch_test: launch $*: no '$words' in:" >&2
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
echo "launch_test: all refused, nothing touched"
