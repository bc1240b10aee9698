#!/usr/bin/env bash
# The page of `jurist map -o FILE.html` in a headless Chromium: the verdicts that its script looks up are
# compared with those of `jurist verdict`. Without Chromium there is nothing to test.
#
# usage: tests/browser/map_page.sh [JURIST [SCREENSHOT_FOLDER]]
set -euo pipefail
cd "$(dirname "$0")/../.."
jurist=${1:-target/debug/jurist}
pictures=${2:-}
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$chromium" ]; then
    echo "no Chromium here: not tested"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

browse() {
    timeout 60 "$chromium" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
        --disable-background-networking --disable-component-update --disable-sync \
        --user-data-dir="$folder/profile" --virtual-time-budget=3000 "$@" 2> "$folder/chromium.log"
}

# The text of an element of the page at a point.
text() {
    browse --dump-dom "file://$folder/map.html#$1" | tr '\n' ' ' | sed -n "s/.*<div id=\"$2\"[^>]*>\([^<]*\)<.*/\1/p"
}

"$jurist" map -x T -y K_pwm -o "$folder/map.html"
failures=0
for point in 'T=1e-4 K_pwm=110' 'T=1e-4 K_pwm=550.94' 'T=1e-4 K_pwm=550.95' 'T=1e-4 K_pwm=0.0381' \
    'T=1e-4 K_pwm=0.0382' 'T=1/2010 K_pwm=110' 'T=1/2020 K_pwm=110' 'T=0.062065 K_pwm=0.47128' \
    'T=0.062066 K_pwm=0.47128' 'T=0.0672 K_pwm=0.534' 'T=3/10 K_pwm=7' 'T=1/25 K_pwm=1' \
    'T=1/25 K_pwm=1/2' 'T=1/25 K_pwm=1/100'; do
    # shellcheck disable=SC2086
    set -- $point
    says=$("$jurist" verdict --set "$1" --set "$2" --json || true)
    verdict=$(sed -n 's/.*"verdict": "\(.*\)".*/\1/p' <<< "$says" | head -1)
    outside=$(sed -n 's/.*"outside": \([0-9]*\).*/\1/p' <<< "$says")
    shown=$(text "$1&$2" verdict)
    roots=$(text "$1&$2" roots)
    expected="$outside of 6 roots outside"
    [ "$outside" = 0 ] && expected='all 6 roots inside'
    if [ "$shown" = "$verdict" ] && [[ "$roots" = "$expected"* ]]; then
        echo "ok    $point: $shown, $roots"
    else
        echo "WRONG $point: the page says '$shown', '$roots'; jurist says '$verdict', $outside outside"
        failures=$((failures + 1))
    fi
done
check() {
    local shown
    shown=$(text "$1" verdict)
    if [ "$shown" = "$2" ]; then echo "ok    $1: $shown"; else
        echo "WRONG $1: '$shown' instead of '$2'"
        failures=$((failures + 1))
    fi
}
check 'T=-1&K_pwm=1' 'outside the domain'
check 'T=1/0&K_pwm=1' 'enter numbers such as 110, 1e-4 or 1/3'

if [ -n "$pictures" ]; then
    mkdir -p "$pictures"
    for size in 1200,1100 390,844; do
        browse --window-size="$size" --screenshot="$pictures/map-${size%,*}.png" "file://$folder/map.html" > "$folder/out.log"
    done
fi
exit "$failures"
