#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# page_sources_test.sh TOOLS/REPORT_PAGE: page/report.html is what web/ is the source of (it bears their SHA-256), under 2 MB
# with its licence, holds the licence's text, and names nothing that a browser would fetch.
set -euo pipefail

cd "$1"
fail() {
    echo "page_sources_test: $1" >&2
    exit 1
}
mapfile -t sources < <(cd web && ls index.html package-lock.json vite.config.js src/* | LC_ALL=C sort)
digest="$(cd web && cat "${sources[@]}" | sha256sum | cut -d ' ' -f 1)"
grep -q "name=\"planemap-sources\" content=\"$digest\"" page/report.html ||
    fail "page/report.html is not of these sources: npm ci && npm run build in tools/report_page/web"
[[ "$(cat page/* | wc -c)" -lt 2000000 ]] || fail "page/ takes 2 MB or more"
[[ "$(grep -o '@PLANEMAP_DATA@' page/report.html | wc -l)" == 1 ]] || fail "there must be one place for the data"
while IFS= read -r line; do
    grep -qF "$line" page/report.html || fail "page/report.html lacks a line of three.js's licence: $line"
done < <(grep . page/LICENSE.three.txt)
if grep -qE '(src|href)="?(https?:)?//' page/report.html; then fail "page/report.html names something to fetch"; fi
