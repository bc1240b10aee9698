#!/bin/sh
# Times the loop family here and in PARI/GP, one thread each, one after the other, and prints the ratios
# of the medians (PARI's time over ours). Usage: benches/compare.sh [SECONDS_PER_FIGURE]
set -eu
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "${BENCH_LOOP:-}" ]; then
    cargo build --release --quiet -p jurist-benches --example bench_loop
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
# The exponent e of the least-squares fit of n^e.
for side in ours theirs; do
    awk -v side="$side" '
        function figures(out,   i, k) { k = 0; for (i = 2; i <= NF; i++) if ($i == "ms") out[++k] = $(i - 1); return k }
        /^n=/ { sub(/^n= */, "n="); x = log(substr($1, 3)); k = figures(f); if (k > most) most = k
            for (i = 1; i <= k; i++) { y = log(f[i]); c[i]++; sx[i] += x; sy[i] += y; sxx[i] += x * x; sxy[i] += x * y } }
        END { printf "growth, %s:", side == "ours" ? "jurist" : "PARI/GP"
            for (i = 1; i <= most; i++) printf "  n^%.2f", (c[i] * sxy[i] - sx[i] * sy[i]) / (c[i] * sxx[i] - sx[i] * sx[i])
            print "" }
    ' "$work/$side"
done
BENCH_ORDER=40 RAYON_NUM_THREADS=1 "$BENCH_LOOP" 0 | sed -n 's/^peak/order 40 alone, peak/p'
