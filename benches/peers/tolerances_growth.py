"""What a box of tolerances costs by the number of its parameters, beside codac and random points:

    pip install codac numpy
    cargo build --release && python benches/peers/tolerances_growth.py target/release/jurist

Families: the drive's components with 20 % each; random loops of order 5 whose matrices move with each parameter along one direction,
`sI - A - sum q_i b_i c_i'`, |q_i| <= 1/10. Of each: Bernstein coefficients, cells of the proof of the box of half the largest factor and
of the box itself where that is smaller, the factor's bracket (a millionth), the processor time of the whole process for that and for a
bracket of one digit; codac: is there a common zero of the pair in the box of 0.9 times the factor (seconds, or more than the time it got);
random points: how many of 10 000 are not stable in the box that is a thousandth larger than the largest stable one.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
from fractions import Fraction
from math import prod

import numpy
from codac_tolerances import SECONDS, excluded, functions

NAMES = "R_a L_a J B_v K_a k_1 k_2 E_sw K_pi K_ii K_ps K_is".split()
ORDER, POINTS = 5, 10_000


def random_model(count, seed):
    """The generator of `benches/drivers/tolerances.rs`."""
    state = seed

    def between(low, high):
        nonlocal state
        state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
        return low + (state >> 33) % (high - low + 1)

    vectors = [[between(-2, 2) for _ in range(ORDER)] for _ in range(2 * count)]
    rows = []
    for row in range(ORDER):
        entries = []
        for column in range(ORDER):
            a = -between(12, 30) if row == column else between(-3, 3)
            products = [vectors[2 * i][row] * vectors[2 * i + 1][column] for i in range(count)]
            entries.append(f'"{a}' + "".join(f" + ({p})*q{i}" for i, p in enumerate(products) if p) + '"')
        rows.append("[" + ", ".join(entries) + "]")
    parameters = "".join(f"q{i} = {{ nominal = 0, tolerance = 0.1 }}\n" for i in range(count))
    return f"time = 'continuous'\n[parameters]\n{parameters}[loop]\nmatrix = [{', '.join(rows)}]\n"


def run(*arguments):
    """The document that the program prints, and the processor time of the process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    output = subprocess.run([*arguments, "--json", "-q"], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(output.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def cleared(document):
    """The coefficients as {exponents: number} over one denominator, which has one term each."""
    pairs = []
    for c in document["coefficients"]:
        [(below, number)] = c["denominator"]
        pairs.append(({tuple(e): Fraction(x) for e, x in c["numerator"]}, below, Fraction(number)))
    common = [max(below) for below in zip(*(below for _, below, _ in pairs))]
    return [
        {tuple(e + c - b for e, c, b in zip(es, common, below)): x / number for es, x in top.items()}
        for top, below, number in pairs
    ]


def in_half_plane(d):
    n = len(d) - 1
    out = [{} for _ in d]
    for i, c in enumerate(d):
        row = [1]
        for k in range(n):
            row = [x + y if k < i else x - y for x, y in zip([*row, 0], [0, *row])]
        for target, w in zip(out, row):
            for e, x in c.items():
                target[e] = target.get(e, 0) + w * x
    return out


def unstable_points(d, sides, discrete, generator):
    """How many of the points have a root outside, in floating point."""
    points = generator.uniform(*zip(*sides), size=(POINTS, len(sides)))
    values = [sum(float(x) * numpy.prod(points ** numpy.array(e), axis=1) for e, x in c.items()) for c in d]
    roots = (numpy.roots([v[k] for v in values[::-1]]) for k in range(POINTS))
    return sum(bool((abs(r) >= 1).any() if discrete else (r.real >= 0).any()) for r in roots)


def row(name, program, model, names, seconds):
    discrete = model is None
    arguments = [program, "tolerance"] + (["--tol", ",".join(names) + "=20%"] if discrete else [model])
    document, one_digit = run(*arguments, "--digits", "1")
    document, own = run(*arguments)
    factor = document["factor"]
    lower = Fraction(factor["lower"])
    keep = [word for name in names for word in ("--keep", name)]
    polynomial, _ = run(program, "charpoly", *([] if discrete else [model]), *keep)
    d = cleared(polynomial)
    order = polynomial["parameters"]
    nominal = {name: sum(map(Fraction, ends)) / 2 for name, ends in document["box"].items()}

    def sides(factor):
        return [[nominal[n] + factor * (Fraction(end) - nominal[n]) for end in document["box"][n]] for n in order]

    p = in_half_plane(d) if discrete else d
    size = ((len(p) - 1) // 2 + 1) * prod(1 + max(e[i] for c in d for e in c) for i in range(len(order)))
    question = {
        "box": [[str(end) for end in side] for side in sides(Fraction(9, 10) * lower)],
        "coefficients": [[[list(e), str(x)] for e, x in c.items()] for c in p],
    }
    found, codac_seconds, boxes = (None, 0.0, 0) if len(names) > 12 else excluded(*functions(question), seconds)
    wider = [[float(end) for end in side] for side in sides(Fraction(factor["upper"] or factor["lower"]) * Fraction(1001, 1000))]
    unstable = unstable_points(d, wider, discrete, numpy.random.default_rng(7))
    codac = "not asked" if len(names) > 12 else f"{codac_seconds:.2f}" if found else f"> {codac_seconds:.0f} ({boxes} boxes)"
    print(
        f"| {name} | {len(names)} | {size} | {float(lower):.9g} | {document['cells']} | {one_digit * 1e3:.0f} | {own * 1e3:.0f} "
        f"| {codac} | {unstable} |",
        flush=True,
    )


def main():
    program = os.path.abspath(sys.argv[1])
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else SECONDS
    print("| family | m | coefficients | factor | cells | one digit, ms | six digits, ms | codac, s | points |")
    print("|---|---|---|---|---|---|---|---|---|")
    for count in (2, 4, 6, 8, 10, 12):
        row("drive", program, None, NAMES[:count], seconds)
    for count in (2, 4, 6, 8, 10, 12, 14, 16):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(random_model(count, 1))
            file.flush()
            row("random", program, file.name, [f"q{i}" for i in range(count)], seconds)


if __name__ == "__main__":
    main()
