"""The questions of `tolerances --questions` asked of codac: `pip install codac`, then

    cargo run --release -p jurist-benches --example tolerances -- --questions | python benches/peers/codac_tolerances.py [SECONDS]

Whether the pair (E, O) has a common zero over a box of frequency and parameters: contraction and bisection, in floating
point and without a certificate, against the proof by Bernstein coefficients. Both are library calls; both get polynomials.
"""

import json
import sys
import time
from fractions import Fraction

from codac import AnalyticFunction, CtcInverse, Interval, IntervalVector, VectorVar, vec

SECONDS = 30.0


def functions(question):
    """E and O over t in [0, 1] and the parameters, v = v0 t/(1 - t), parameters relative to their middle."""
    box = [[Fraction(end) for end in side] for side in question["box"]]
    middle = [(low + high) / 2 for low, high in box]
    unit = [abs(m) if m else Fraction(1) for m in middle]
    coefficients = [
        [(exponents + [0] * (len(box) - len(exponents)), Fraction(c)) for exponents, c in f]
        for f in question["coefficients"]
    ]
    size = [sum(abs(c) * product(abs(m) ** e for m, e in zip(middle, es)) for es, c in f) for f in coefficients]
    degree = len(coefficients) - 1
    v0 = Fraction(float(size[0] / size[degree]) ** (2.0 / degree))
    greatest = max(s * v0 ** (i // 2) for i, s in enumerate(size))
    x = VectorVar(len(box) + 1)
    t = x[0]
    parts = []
    for odd in (0, 1):
        chosen = coefficients[odd::2]
        k = degree // 2
        total = None
        for j, f in enumerate(chosen):
            value = None
            for es, c in f:
                scale = (-1) ** j * c * v0**j / greatest * product(u**e for u, e in zip(unit, es))
                term = float(scale)
                for i, e in enumerate(es):
                    for _ in range(e):
                        term = term * x[i + 1]
                value = term if value is None else value + term
            if value is None:
                continue
            weight = value * (t**j if j else 1.0) * ((1.0 - t) ** (k - j) if k > j else 1.0)
            total = weight if total is None else total + weight
        parts.append(total)
    sides = [[0.0, 1.0]] + [[float(low / u), float(high / u)] for (low, high), u in zip(box, unit)]
    return AnalyticFunction([x], vec(*parts)), IntervalVector([Interval(*side) for side in sides])


def product(factors):
    value = Fraction(1)
    for factor in factors:
        value *= factor
    return value


def excluded(function, box, seconds=SECONDS):
    """The number of boxes until no zero is left, or None after so many seconds."""
    contractor = CtcInverse(function, IntervalVector([Interval(0.0), Interval(0.0)]))
    start, count, waiting = time.process_time(), 0, [box]
    while waiting:
        box = waiting.pop()
        count += 1
        box = IntervalVector(contractor.contract(box))
        if box.is_empty():
            continue
        if time.process_time() - start > seconds or box.max_diam() < 1e-9:
            return None, time.process_time() - start, count
        waiting.extend(box.bisect(box.max_diam_index(), 0.49))
    return True, time.process_time() - start, count


def main():
    limit = float(sys.argv[1]) if len(sys.argv) > 1 else SECONDS
    slower = 0
    print(f"{'question':22} {'jurist ms':>10} {'cells':>6} {'codac ms':>10} {'boxes':>8} {'ratio':>9}")
    for line in sys.stdin:
        question = json.loads(line)
        answer, seconds, count = excluded(*functions(question), limit)
        own = question["seconds"]
        bound = "" if answer else "> "
        print(
            f"{question['name']:22} {own * 1e3:10.3f} {question['cells']:6} "
            f"{bound + format(seconds * 1e3, '.1f'):>10} {count:8} {bound + format(seconds / own, '.1f'):>9}",
            flush=True,
        )
        slower += seconds < own
    print(f"slower than codac: {slower}")
    sys.exit(1 if slower else 0)


if __name__ == "__main__":
    main()
