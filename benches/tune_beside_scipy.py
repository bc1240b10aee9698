#!/usr/bin/env python3
"""Best gains of 20 loops, by `jurist tune` and by SciPy's differential evolution, side by side.

    benches/tune_beside_scipy.py [PROGRAM] [--seed 1] [--only 5]

For each loop the same question: what is to be best, within which bounds, what is required. SciPy minimises in floating point, with
requirements on a grid of frequencies and penalties, as scripts do. The table has both brackets or values, the times, who is better, and
whether SciPy's gains meet what is required: that is decided exactly, by `jurist verdict`; of a margin that is to be best the exact one of
SciPy's gains is compared, not the one of the grid. Needs Python 3.11, NumPy and SciPy.
"""

import argparse
import json
import subprocess
import time
from fractions import Fraction

import numpy as np
from scipy.optimize import differential_evolution

GRID = np.logspace(-3, 3, 1500) * 1j

# Denominators of plants, falling powers.
LAGS = ([1, 3, 3, 1], [1, 4, 5, 2], [2, 7, 7, 2], [1, 6, 11, 6], [4, 9, 6, 1], [1, 2.2, 1.4, 0.2])
WITH_INTEGRATOR = ([1, 3, 2, 0], [1, 4, 3, 0], [1, 5, 6, 0], [2, 7, 3, 0])
UNSTABLE = ([0.1, 0.9, -1], [0.2, 0.8, -1], [0.05, 0.95, -1], [0.1, 1.8, -4])


class Case:
    """A question: gains with bounds, the open loop as polynomials of the gains, the best one, the least modulus margin."""

    def __init__(self, name, gains, loop, objective, bounds, margin=None):
        self.name, self.gains, self.objective, self.bounds, self.margin = name, gains, objective, bounds, margin
        self.loop = loop

    def line(self):
        numerator, denominator = self.loop
        power = lambda p, names: " + ".join(f"({c})*s^{len(p) - 1 - k}" for k, c in enumerate(p))
        return f"({power(numerator, self.gains)})/({power(denominator, self.gains)})"

    def numbers(self, gains):
        values = dict(zip(self.gains, gains))
        numerator, denominator = self.loop
        return [np.array([float(values.get(c, c)) for c in p]) for p in (numerator, denominator)]

    def cost(self, gains):
        """What is minimised: the worse, the more is violated."""
        numerator, denominator = self.numbers(gains)
        closed = np.polyadd(numerator, denominator)
        decay = -np.roots(closed).real.max()
        if decay <= 0:
            return 1e3 * (1 - decay)
        least = np.abs(1 + np.polyval(numerator, GRID) / np.polyval(denominator, GRID)).min()
        if self.margin is not None and least < self.margin:
            return 1e2 * (1 + self.margin - least)
        word, name = self.objective.split()
        value = {"decay": decay, "modulus_margin": least, **dict(zip(self.gains, gains))}[name]
        return -value if word == "max" else value


def cases():
    one = lambda name, den, objective, top: Case(name, ["K"], (["K"], den), objective, {"K": (0, top)})
    for k, den in enumerate(LAGS):
        numerator, denominator = ["k", "ki"], [*den, 0]
        yield Case(f"PI, lags {k + 1}", ["k", "ki"], (numerator, denominator), "max ki", {"k": (0, 30), "ki": (0, 30)}, 0.6)
    for k, den in enumerate(WITH_INTEGRATOR):
        yield one(f"P, integrator {k + 1}", den, "max decay", 30)
    for k, den in enumerate(UNSTABLE):
        yield one(f"P, unstable {k + 1}", den, "max modulus_margin", 60)
    for k, den in enumerate(LAGS[:4]):
        yield Case(f"P, lags {k + 1}", ["K"], (["K"], den), "max K", {"K": (0, 60)}, 0.5)
    for k, den in enumerate(LAGS[:2]):
        numerator, denominator = ["kd", "kp", "ki"], [*den, 0]
        bounds = {"kp": (0, 6), "ki": (0, 4), "kd": (0, 3)}
        yield Case(f"PID, lags {k + 1}", ["kd", "kp", "ki"], (numerator, denominator), "max ki", bounds, 0.6)


def ours(program, case):
    words = [program, "tune", case.line(), "--objective", case.objective, "--json", "-q", "--timeout", "120"]
    for name, (low, high) in case.bounds.items():
        words += ["--free", name, "--bound", f"{name}={low}..{high}"]
    words += ["--modulus-margin", str(case.margin)] if case.margin is not None else []
    start = time.perf_counter()
    run = subprocess.run(words, capture_output=True, text=True)
    took = time.perf_counter() - start
    answer = json.loads(run.stdout)
    exact = (answer["optimum"] or {}).get("decimal")
    found = exact or answer["found"]["value"]
    return float(found), float(exact or answer["proved"] or "nan"), took


def theirs(case, seed):
    start = time.perf_counter()
    found = differential_evolution(case.cost, [case.bounds[name] for name in case.gains], seed=seed, tol=1e-8, maxiter=400)
    took = time.perf_counter() - start
    return found.x, (-found.fun if case.objective.startswith("max") else found.fun), took


def meets(program, case, gains):
    """Whether these gains, as the decimals that floating-point numbers are, meet what is required: decided exactly."""
    words = [program, "verdict", case.line(), "-q", "--json"]
    for name, value in zip(case.gains, gains):
        words += ["--set", f"{name}={Fraction(float(value))}"]
    words += ["--modulus-margin", str(case.margin)] if case.margin is not None else []
    return subprocess.run(words, capture_output=True, text=True).returncode == 0


def margin_of(program, case, gains):
    """The modulus margin that these gains have: between the frequencies of a grid it may be less."""
    words = [program, "margins", case.line(), "-q", "--json"]
    for name, value in zip(case.gains, gains):
        words += ["--set", f"{name}={Fraction(float(value))}"]
    answer = json.loads(subprocess.run(words, capture_output=True, text=True).stdout)
    return float(answer["modulus"]["value"]["decimal"])


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program", nargs="?", default="target/release/jurist")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", type=int)
    options = arguments.parse_args()
    print(f"{'loop':<16} {'what':<19} {'found':>12} {'proved':>12} {'s':>7} {'SciPy':>12} {'s':>6}  better   SciPy's gains")
    counts = {"jurist": 0, "SciPy": 0, "equal": 0, "violate": 0}
    for case in list(cases())[: options.only]:
        found, proved, took = ours(options.program, case)
        gains, value, seconds = theirs(case, options.seed)
        is_met = meets(options.program, case, gains)
        claimed = value
        if case.objective == "max modulus_margin":
            value = margin_of(options.program, case, gains)
        sign = 1 if case.objective.startswith("max") else -1
        difference = sign * (found - value) / max(abs(found), 1e-12)
        # Gains that do not meet what is required are no answer.
        better = "jurist" if not is_met or difference > 1e-6 else "SciPy" if difference < -1e-6 else "equal"
        counts[better] += 1
        counts["violate"] += not is_met
        print(f"{case.name:<16} {case.objective:<19} {found:12.8f} {proved:12.8f} {took:7.2f} {claimed:12.8f} {seconds:6.2f}  {better:<7}  {'meet it' if is_met else 'VIOLATE it'}")
    print(", ".join(f"{name}: {count}" for name, count in counts.items()))


main()
