#!/bin/sh
# Real root isolation beside PARI/GP, family by family in one run, one thread: milliseconds and ratios.
# Usage: benches/compare_roots.sh  (needs gp and a built example: cargo build --release -p jurist-benches --example bench_roots)
set -eu
cd "$(dirname "$0")/.."
cargo build --release --quiet -p jurist-benches --example bench_roots
ours=$(mktemp)
theirs=$(mktemp)
trap 'rm -f "$ours" "$theirs"' EXIT
RAYON_NUM_THREADS=1 cargo run --release --quiet -p jurist-benches --example bench_roots >"$ours"
gp -q -f benches/pari/roots.gp </dev/null >"$theirs" 2>/dev/null
printf '%-20s %6s %12s %12s %8s\n' family roots 'PARI ms' 'ours ms' ratio
awk '
    { match($0, / degree /); name = substr($0, 1, RSTART - 1); sub(/ +$/, "", name)
      rest = substr($0, RSTART); split(rest, f, " "); roots = f[4]; time = f[5] }
    NR == FNR { peer[name] = time; peer_roots[name] = roots; next }
    !(name in peer) { printf "%-20s %6d %12s %12.3f\n", name, roots, "-", time; next }
    { if (peer_roots[name] != roots) wrong = wrong " " name
      printf "%-20s %6d %12.3f %12.3f %8.1f\n", name, roots, peer[name], time, peer[name] / time
      sum += log(peer[name] / time); count++ }
    END { if (count) printf "geometric mean %.1f over %d families\n", exp(sum / count), count
          if (wrong) { print "different numbers of roots:" wrong; exit 1 } }
' "$theirs" "$ours"
