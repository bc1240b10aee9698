#!/bin/sh
# Counts the instructions of the jobs of benches/drivers/instructions.rs under callgrind (one thread) and prints
# them beside the recorded ones; `benches/instructions.sh record` writes the record.
set -eu
cd "$(dirname "$0")/.."
cargo build --release --quiet -p jurist-benches --example instructions
record=benches/instructions.txt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for job in $(target/release/examples/instructions); do
    RAYON_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file="$work/out" \
        target/release/examples/instructions "$job" 2>"$work/log" >/dev/null
    count=$(sed -n 's/.*Collected : //p' "$work/log")
    before=$(sed -n "s/^$job //p" "$record" 2>/dev/null || true)
    echo "$job $count" >>"$work/record"
    echo "$job $count ${before:-0}" | awk '{ printf "%-20s %14d  recorded %14d", $1, $2, $3; if ($3) printf "  %+.2f %%", 100 * ($2 / $3 - 1); print "" }'
done
if [ "${1:-}" = record ]; then cp "$work/record" "$record"; fi
