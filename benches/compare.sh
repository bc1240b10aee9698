#!/bin/sh
# Times the loop family here and in PARI/GP, one thread each, one after the other, and prints the ratios
# of the medians (PARI's time over ours). Usage: benches/compare.sh [SECONDS_PER_FIGURE]
set -eu
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "${BENCH_LOOP:-}" ]; then
    cargo build --release --quiet --example bench_loop
    BENCH_LOOP=target/release/examples/bench_loop
fi
echo "jurist:"
RAYON_NUM_THREADS=1 "$BENCH_LOOP" "${1:-0.5}" | tee "$work/ours"
if ! command -v gp >/dev/null; then
    echo "gp (PARI/GP) is not installed: nothing to compare with"
    exit 0
fi
echo "PARI/GP:"
gp -q -f benches/pari/loop.gp </dev/null 2>/dev/null | grep '^n=' | tee "$work/theirs"
echo "PARI / jurist:"
awk '
    # The figures of a line are the words before "ms".
    function figures(out,   i, k) { k = 0; for (i = 2; i <= NF; i++) if ($i == "ms") out[++k] = $(i - 1); return k }
    { sub(/^n= */, "n=") }
    NR == FNR { count[$1] = figures(f); for (i in f) ours[$1, i] = f[i]; next }
    { k = figures(f); printf "%s", $1; for (i = 1; i <= k; i++) printf "  %8.2f", f[i] / ours[$1, i]; print "" }
' "$work/ours" "$work/theirs"
