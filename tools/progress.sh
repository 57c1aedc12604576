# SPDX-License-Identifier: BSD-3-Clause
# For the scripts of this folder: long work in few lines. Its output goes to a log; sourced, not run.

# show_progress NAME: reads lines "PERCENT WORDS" and shows them on stderr, on a terminal in one line that is redrawn,
# elsewhere a line for each 10 %.
show_progress() {
    local name="$1" percent words shown=-1 drawn=false
    while read -r percent words; do
        percent="${percent%%.*}"
        if [[ -t 2 ]]; then
            printf '\r\033[K%s: %3d %% %s' "$name" "$percent" "$words" >&2
            drawn=true
        elif ((percent / 10 != shown)); then
            printf '%s: %d %% %s\n' "$name" "$percent" "$words" >&2
            shown=$((percent / 10))
        fi
    done
    if "$drawn"; then printf '\n' >&2; fi
}

# duration SECONDS: as people say it.
duration() {
    local minutes=$((($1 + 30) / 60))
    if (($1 < 90)); then echo "$1 s"; else echo "$minutes min"; fi
}

# show_tail LOG: what a command that failed said last, and where the rest is.
show_tail() {
    echo "--- the end of $1:" >&2
    tail -n 25 "$1" >&2
    echo "---" >&2
}
