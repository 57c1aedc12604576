#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# page_browser_test.sh BIN: report.html in headless Chromium without WebGL and without a network: no word on the console,
# all sections there, text of the map as text. Without chromium it is skipped (77).
set -euo pipefail

bin="$1"
if ! command -v chromium >/dev/null; then
    echo "page_browser_test: skipped, there is no chromium" >&2
    exit 77
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
fail() {
    echo "page_browser_test: $1" >&2
    exit 1
}

# The page before its scripts, as Chromium has it once they ran; console lines go to the second file.
show() {
    chromium --headless=new --no-sandbox --disable-gpu --disable-3d-apis --user-data-dir="$folder/profile" --window-size=390,900 \
        --host-resolver-rules='MAP * ~NOTFOUND' --virtual-time-budget=5000 --enable-logging=stderr --dump-dom "file://$1" \
        2>"$folder/console" | sed '/<noscript>/,$d' >"$folder/dom"
    if grep CONSOLE "$folder/console" >&2; then fail "$1 says something on the console"; fi
}
contains() { grep -qF -- "$1" "$folder/dom" || fail "the page lacks: $1"; }

"$bin/planemap-run" 'sim:office?frames=6' --quiet --output "$folder/run" >/dev/null 2>&1
show "$folder/run/report.html"
for id in plan view sizes missed paper growth time planes run; do contains "<section id=\"$id\">"; done
contains 'needs WebGL'
contains 'the simulator'
if grep -q 'could not be drawn' "$folder/dom"; then fail "a part of the page could not be drawn"; fi

# A folder with nothing but a report, whose text tries to break out.
mkdir "$folder/old"
python3 - "$folder/run/report.json" "$folder/old/report.json" <<'PYTHON'
import json, sys
report = json.load(open(sys.argv[1]))
report['warnings'] = ['</script><script>document.title = "broken out"</script><!--']
for key in ('sizes', 'headline', 'growth', 'accuracy_beside_size', 'host', 'cpu'):
    report.pop(key, None)
json.dump(report, open(sys.argv[2], 'w'))
PYTHON
"$bin/planemap-report" "$folder/old" --html >/dev/null
show "$folder/old/report.html"
contains '<title>planemap: sim:office'
contains '&lt;/script&gt;&lt;script&gt;document.title'
contains 'There are no planes to draw'
