#!/usr/bin/env bash
# How the check grows with the order: with Coq's Z, as in the library, and with machine integers (Bignums' BigZ over Uint63).
# A table goes to standard output, then the axioms that machine integers add. The library has to be compiled.
#
#     apt-get install --no-install-recommends libcoq-bignums
#     proofs/growth.sh PROGRAM [SECONDS]
#
# The checker over BigZ is made here from Compute.v by its text, to measure it; it is not part of the library, and nothing is
# proved with it. The seconds are those of the check alone; loading the libraries takes 2 more, and 'Print Assumptions' as many.
# What takes more than SECONDS of the processor (300) is shown as '>'.
set -euo pipefail
program=$(realpath "$1")
seconds=${2:-300}
cd "$(dirname "$0")"
proofs=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=(-w none -R "$proofs" Jurist -R "$work" Growth)

sed -E \
    -e 's/^From Coq Require Import.*/From Coq Require Import ZArith List Bool QArith.\nFrom Bignums Require Import BigZ./' \
    -e 's/^Local Open Scope Z_scope/Local Open Scope bigZ_scope/' \
    -e 's/\bZ\.$/BigZ.t./; s/\bZ\./BigZ./g; s/\bZ\b([^.])/BigZ.t\1/g' \
    -e 's/Zpos \(Qden ([a-z]+)\)/(BigZ.of_Z (Zpos (Qden \1)))/g; s/Qnum ([a-z])\b/BigZ.of_Z (Qnum \1)/g' \
    -e 's/\[([a-z0-9])\]/(\1 :: nil)/g; /^  \| \(1 :: nil\) => p$/d' \
    Compute.v > "$work/BigCompute.v"
coqc "${flags[@]}" "$work/BigCompute.v"

# The check of an exported file, without the theorem: file, Z or BigZ. Prints the seconds.
check() {
    local name=$work/check_$2.v polynomial region out
    sed '/^Lemma checked/,$d' "$1" > "$name"
    polynomial=$(sed -nE 's/^Lemma checked : check_matrix 8 (\([^)]*\)) ([0-9]+) (.*) limits = true\.$/charpoly \2 \3/p;
        s/^Lemma checked : check_coefs 8 (\([^)]*\)) (.*) limits = true\.$/cleared (coefs \2)/p' "$1")
    region=$(sed -nE 's/^Lemma checked : check_[a-z]+ 8 \(([^)]*)\) .*/\1/p' "$1")
    {
        echo "Definition polynomial := Eval vm_compute in ($polynomial)."
        if [ "$2" = Z ]; then
            echo "Time Eval vm_compute in (check_poly 8 ($region) polynomial limits)."
        else
            echo "From Bignums Require Import BigZ. From Growth Require BigCompute."
            echo "Definition big (p : list Z) := map BigZ.of_Z p."
            echo "Definition big_piece p := match p with Along b => BigCompute.Along b | Up F b => BigCompute.Up (big F) b"
            echo "  | Down F b => BigCompute.Down (big F) b | Touch F b => BigCompute.Touch (big F) b"
            echo "  | From => BigCompute.From | Until b => BigCompute.Until b end."
            echo "Definition big_limits := BigCompute.Answer (lower limits) (upper limits) (starts limits) (map big_piece (pieces limits))."
            echo "Time Eval vm_compute in (BigCompute.check_poly 8 (BigCompute.$region) (map big polynomial) big_limits)."
        fi
    } >> "$name"
    if ! out=$(ulimit -t "$seconds"; coqc "${flags[@]}" "$name" 2>&1); then
        if [ -n "$out" ]; then echo "$out" >&2; fi
        echo "> $seconds"
    elif ! grep -q '= true' <<< "$out"; then
        echo "$out" >&2
        echo "not checked"
    else
        sed -nE 's/^Finished transaction in .* secs \(([0-9.]+)u,.*/\1/p' <<< "$out"
    fi
}

line() { # loop, order, model, parameter
    local file=$work/loop.v
    if ! "$program" intervals "$3" --param "$4" --coq "$file" > "$work/out" 2>&1; then
        cat "$work/out" >&2
        return
    fi
    echo "| $1 | $2 | $(wc -c < "$file") | $(check "$file" Z) | $(check "$file" BigZ) |"
}

echo "| loop | order | bytes | Z | BigZ |"
echo "|---|---|---|---|---|"
for n in 4 5 6 7 8 9 10 11 12; do
    cat > "$work/lags.toml" << END
time = "discrete"
[parameters]
K = { min = 0 }
[loop]
characteristic = "(z - 1)*(z - 0.9)^$((n - 1)) + K*0.1^$((n - 1))"
END
    line "a chain of lags, \`K\`" "$n" "$work/lags.toml" K
done
line "the drive, \`K_pwm\`" 6 ../examples/drive.toml K_pwm
for filters in 2 4 6; do
    line "$filters filters, \`K_pwm\`" $((6 + filters)) "../examples/drive-filters-$filters.toml" K_pwm
done
line "the drive, \`T\`" 6 ../examples/drive.toml T
for filters in 2 4; do
    line "$filters filters, \`T\`" $((6 + filters)) "../examples/drive-filters-$filters.toml" T
done

cat > "$work/axioms.v" << 'END'
From Bignums Require Import BigZ.
(* What a proof that the checker over BigZ is right would stand on. *)
Definition meaning := (BigZ.spec_add, BigZ.spec_sub, BigZ.spec_opp, BigZ.spec_mul, BigZ.spec_div, BigZ.spec_gcd,
  BigZ.spec_eqb, BigZ.spec_ltb, BigZ.spec_leb, BigZ.spec_of_Z).
Print Assumptions meaning.
END
echo
echo "Print Assumptions, of what the operations of BigZ mean:"
coqc "${flags[@]}" "$work/axioms.v" | grep -oE '^[A-Za-z0-9_.]+( :|$)' | tr -d ' :' | sort -u | tr '\n' ' '
echo
