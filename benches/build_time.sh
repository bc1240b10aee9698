#!/usr/bin/env bash
# Runs a cargo command on a fresh clone of the last commit and prints its wall time and its processor time, by crate.
# Wall time means something on a quiet machine only; processor time grows by up to a fifth on a busy one.
#
#     benches/build_time.sh                          cargo test --locked
#     benches/build_time.sh run --release --locked   any other command
set -euo pipefail

# Seconds as the shell counts them: user, system, wall.
TIMEFORMAT="%U %S %R"

# Cargo calls this script for each crate, with the compiler and its arguments.
if [ -n "${BUILD_TIME_LOG:-}" ]; then
    crate='' before='' harness=''
    for argument in "$@"; do
        [ "$before" != --crate-name ] || crate=$argument
        [ "$argument" != --test ] || harness=' (its tests)'
        before=$argument
    done
    status=0
    measured=$(mktemp)
    { time "$@" 2>&3; } 3>&2 2> "$measured" || status=$?
    # Cargo also asks the compiler for its version.
    [ -z "$crate" ] || [ "$crate" = ___ ] || echo "$(tail -n 1 "$measured") $crate$harness" >> "$BUILD_TIME_LOG"
    rm -f "$measured"
    exit "$status"
fi

cd "$(dirname "$0")/.."
script=$PWD/benches/build_time.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ $# -gt 0 ] || set -- test --locked
git clone -q . "$work/clone"
cd "$work/clone"
: > "$work/crates"
{
    time RUSTC_WRAPPER=$script BUILD_TIME_LOG=$work/crates CARGO_TARGET_DIR=$work/target cargo "$@" > "$work/output" 2>&1 ||
        { tail -n 40 "$work/output" >&3; exit 1; }
} 3>&2 2> "$work/whole"
sort -rn "$work/crates" | awk 'NR <= 30 { printf "%7.1f s  %s %s %s\n", $1 + $2, $4, $5, $6 }'
awk -v whole="$(tail -n 1 "$work/whole")" '
    { compiling += $1 + $2 }
    END {
        split(whole, t)
        printf "%7.1f s  the compiler, of %.1f s of processor time in all, in %.1f s\n", compiling, t[1] + t[2], t[3]
    }' "$work/crates"
