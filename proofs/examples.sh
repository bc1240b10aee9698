#!/usr/bin/env bash
# Every example and each of its parameters: the program writes the theorem, Coq checks it. A table goes to standard output.
#
#     proofs/examples.sh PROGRAM [LARGEST_ORDER] [SECONDS]
#
# The library has to be compiled. With QUICK=1 the loops that take more than half a minute each are left out (fiat-dedra, and T of
# drive-filters-2). A file that takes more than SECONDS of the processor (240), that Coq refuses, or that
# uses an axiom is a failure; a loop of an order above LARGEST_ORDER (8), or one for which the program has no file, is a line with
# the reason.
set -euo pipefail
program=$(realpath "$1")
export largest=${2:-8} seconds=${3:-240}
cd "$(dirname "$0")"
export program proofs=$PWD
files=$(mktemp -d)
export files
trap 'rm -rf "$files"' EXIT
# The machine's cores, two at most: a file takes up to 1.2 GB.
jobs=${COQ_JOBS:-$(nproc)}
[ "$jobs" -le 2 ] || jobs=2

one() { # loop, parameter
    local name file why seconds_used statement order size
    name=$(printf '%s__%s' "$1" "$2" | tr -c 'A-Za-z0-9_\n' _)
    file=$files/$name.v
    if ! "$program" intervals "../examples/$1.toml" --param "$2" --timeout "$seconds" --coq "$file" > "$files/$name.out" 2>&1; then
        why=$(grep -m1 -E '^(error|undecided)' "$files/$name.out" || true)
        case $why in
            *'no file for Coq'*) echo "| $1 | \`$2\` | - | no file:${why#*no file for Coq:} | | |" ; return 0 ;;
            undecided*) echo "| $1 | \`$2\` | - | no file: undecided by \`intervals\` | | |" ; return 0 ;;
        esac
        cat "$files/$name.out" >&2
        return 1
    fi
    order=$(grep -oE 'check_matrix 8 \([^)]*\) [0-9]+' "$file" | grep -oE '[0-9]+$' || true)
    [ -n "$order" ] || order=$(($(awk '/coefficients : list expr/ { on = 1; next } on { n++ } on && /\]\./ { exit } END { print n }' "$file") - 1))
    size=$(wc -c < "$file")
    # The last line of the theorem, with the limits' first decimals for their names.
    statement=$(awk '/^Theorem/ { on = 1 } on && /<->/ { sub(/.*<-> /, ""); sub(/\.$/, ""); print; exit }' "$file")
    while read -r limit decimal; do
        statement=${statement//$limit/"${decimal}.."}
    done < <(sed -nE 's/^  exists ([A-Za-z0-9_]+) : R, only_root [A-Za-z0-9_]+ \(?([-0-9.]+)\)? .*/\1 \2/p' "$file")
    statement=${statement//qr R /}
    statement=${statement// \\\/ /, or }
    statement=$(sed -E 's/\(?(-?[0-9]+)#([0-9]+)\)/\1\/\2/g' <<< "$statement")
    if [ "$order" -gt "$largest" ]; then
        echo "| $1 | \`$2\` | $order | \`$statement\` | $size | order above $largest |"
        return 0
    fi
    local TIMEFORMAT=%U
    # 'time' counts what coqc takes of the processor.
    if ! seconds_used=$(ulimit -t "$seconds"; { time coqc -w -notation-overridden,-ambiguous-paths -R "$proofs" Jurist \
            "$file" > "$files/$name.out" 2>&1; } 2>&1); then
        echo "$1 $2: Coq refuses, or takes more than $seconds s" >&2
        cat "$files/$name.out" >&2
        return 1
    fi
    if [ "$(cat "$files/$name.out")" != 'Closed under the global context' ]; then
        echo "$1 $2: not free of axioms" >&2
        cat "$files/$name.out" >&2
        return 1
    fi
    echo "| $1 | \`$2\` | $order | \`$statement\` | $size | $seconds_used |"
}
export -f one

echo "| loop | parameter | order | stable if and only if | bytes | s |"
echo "|---|---|---|---|---|---|"
for model in ../examples/*.toml; do
    # The names in the table of parameters.
    awk -v loop="$(basename "$model" .toml)" \
        '/^\[/ { on = ($0 == "[parameters]") } on && /^[A-Za-z_0-9]+ *=/ { sub(/ *=.*/, ""); print loop, $0 }' "$model"
done | if [ -n "${QUICK:-}" ]; then grep -vE '^(fiat-dedra q[0-9]|drive-filters-2 T)$'; else cat; fi | xargs -P "$jobs" -L 1 bash -c 'set -euo pipefail; one "$@"' one
