#!/usr/bin/env python3
"""For which gains the phase margin is 45 degrees: jurist's sets against margins computed by floating-point roots.

    python3 -m venv v && v/bin/pip install numpy mpmath
    v/bin/python tests/outside/required_sets.py target/release/jurist [POINTS]

The drive of examples/drive-blocks.toml at its current error, and six loops with a gain in front. At random gains (1000 in
all) the phase margin is computed by numpy: zeros of |N|^2 - |D|^2 along the boundary, the angle of -L there, stability by
the roots of the closed loop. Each end at which the requirement binds is bracketed by mpmath at 80 digits: a part in 10^20
below it the angle is on one side of 45 degrees, a part in 10^20 above on the other.
"""

import json
import random
import subprocess
import sys
from pathlib import Path

import mpmath as mp
import numpy as np

mp.mp.dps = 80
ROOT = Path(__file__).resolve().parents[2]


def polynomial(text):
    return [mp.mpf(c) for c in text.split()]


def product(*factors):
    out = [mp.mpf(1)]
    for f in factors:
        out = [sum((out[i] * f[k - i] for i in range(len(out)) if 0 <= k - i < len(f)), mp.mpf(0)) for k in range(len(out) + len(f) - 1)]
    return out


def total(p, q, scale=1):
    n = max(len(p), len(q))
    at = lambda r, i: r[i - (n - len(r))] if i >= n - len(r) else mp.mpf(0)
    return [at(p, i) + scale * at(q, i) for i in range(n)]


# Highest power first, as in model files: name, time, numerator, denominator, range of the gain.
LOOPS = [
    ("three lags", "continuous", "1", "1 3 3 1", 9),
    ("integrator with zero", "continuous", "1 0.1", "1 1 0", 20),
    ("double integrator", "continuous", "1 0.1", "1 1 0 0", 20),
    ("conditionally stable", "continuous", "2500 5000 2500", "1 100 2500 0 0 0", 60),
    ("servo", "discrete", "0.011 -0.01", "1 -1.9 0.9 0 0", 14),
    ("two lags and a delay", "discrete", "0.2", "1 -1.5 0.54 0", 2),
]


def drive():
    """L/K_pwm at the input of the current controller, from the blocks by hand; T = 1e-4."""
    T, R, La, J, B, Ka = (mp.mpf(x) for x in ("1e-4", "1", "46e-3", "0.093", "0.008", "0.55"))
    w = [1 / T, -1 / T]  # (z - 1)/T in the place of s
    characteristic = total(product(total(product([La], w), [R]), total(product([J], w), [B])), [Ka * Ka])
    current, speed = total(product([J], w), [B]), [Ka]
    pi = lambda p, i: ([p + i * T / 2, i * T / 2 - p], product([1, -1], [1, 0]))  # (P + I T/2 (z+1)/(z-1))/z
    (ni, di), (ns, ds) = pi(mp.mpf(10), mp.mpf(500)), pi(mp.mpf(1), mp.mpf(5))
    inner = total(product(current, ds), product(ns, speed))
    return product(ni, inner, [mp.mpf(1) / 12]), product(di, ds, characteristic)


def along(p, n, discrete):
    """Coefficients in w of p(jw), or in v of (1 - jv)^n p((1 + jv)/(1 - jv)), highest power first."""
    j = mp.mpc(0, 1)
    if not discrete:
        return [c * j ** (len(p) - 1 - i) for i, c in enumerate(p)]
    out = [mp.mpc(0)]
    for i, c in enumerate(p):
        k = len(p) - 1 - i
        out = total(out, product([c], *[[j, 1]] * k, *[[-j, 1]] * (n - k)))
    return out


class Loop:
    def __init__(self, num, den, discrete):
        n = max(len(num), len(den)) - 1
        self.num, self.den, self.discrete = num, den, discrete
        self.n, self.d = along(num, n, discrete), along(den, n, discrete)
        square = lambda p: [mp.re(c) for c in product(p, [mp.conj(c) for c in p])]
        self.nn, self.dd = square(self.n), square(self.d)

    def is_stable(self, k):
        roots = np.roots([float(c) for c in total(self.den, self.num, mp.mpf(k))])
        return bool(np.all(np.abs(roots) < 1)) if self.discrete else bool(np.all(roots.real < 0))

    def excess(self, k):
        return total(self.dd, self.nn, -mp.mpf(k) ** 2)

    def angles(self, k, exact=False):
        """|arg(-L)| in degrees at all frequencies where |L| = 1."""
        p = self.excess(k)
        if exact:
            roots = mp.polyroots(p, maxsteps=500, extraprec=400)
            roots = [mp.re(r) for r in roots if abs(mp.im(r)) < abs(r) * mp.mpf(10) ** -30 and mp.re(r) > 0]
            value = lambda q, v: mp.polyval(q, v)
            return [abs(mp.degrees(mp.arg(-k * value(self.n, v) / value(self.d, v)))) for v in roots]
        scaled = np.array([float(c / max(abs(x) for x in p)) for c in p])
        roots = np.roots(scaled)
        roots = [r.real for r in roots if abs(r.imag) < 1e-7 * abs(r) and r.real > 0]
        n, d = (np.array([complex(c) for c in q]) for q in (self.n, self.d))
        return [abs(np.degrees(np.angle(-k * np.polyval(n, v) / np.polyval(d, v)))) for v in roots]

    def meets(self, k):
        return self.is_stable(k) and min(self.angles(k), default=180.0) >= 45.0


def asked(program, arguments, model):
    run = subprocess.run([program, "intervals", *arguments, "--phase-margin", "45 deg", "--json", "--digits", "40"], input=model, text=True, capture_output=True, cwd=ROOT)
    if run.returncode != 0:
        raise SystemExit(run.stderr)
    return json.loads(run.stdout)["stable"]


def main():
    program, points = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    random.seed(45)
    cases = [("drive at its current error", Loop(*drive(), True), 600, ["examples/drive-blocks.toml", "--param", "K_pwm", "--at", "current controller"], None)]
    for name, time, num, den, most in LOOPS:
        loop = Loop(polynomial(num), polynomial(den), time == "discrete")
        lists = [", ".join(f'"K*({c})"' for c in num.split()), ", ".join(den.split())]
        model = (
            f"time = '{time}'\n[parameters]\nK = {{ nominal = 1, min = 0 }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\n"
            f"input = 'r - y'\noutput = 'y'\nnum = [{lists[0]}]\nden = [{lists[1]}]\n"
        )
        cases.append((name, loop, most, ["-", "--param", "K"], model))
    wrong = tried = bracketed = 0
    for name, loop, most, arguments, model in cases:
        found = asked(program, arguments, model)
        number = lambda end: mp.mpf(end["decimal"]) if end else None
        ends = [(number(i["lower"]), number(i["upper"])) for i in found]
        known = [x for pair in ends for x in pair if x is not None]
        for _ in range(-(-points // len(cases))):
            k = random.uniform(0, most)
            if any(abs(k - x) < 1e-6 * (1 + abs(x)) for x in known):
                continue
            inside = any((lo is None or lo < k) and (hi is None or k < hi) for lo, hi in ends)
            tried += 1
            if inside != loop.meets(k):
                wrong += 1
                print(f"{name}: K = {k!r}: jurist {inside}, numpy {not inside}")
        for end in (e for i in found for e in (i["lower"], i["upper"]) if e and e.get("requirement")):
            x = mp.mpf(end["decimal"])
            sides = [min((a - 45 for a in loop.angles(x * (1 + s * mp.mpf(10) ** -20), True)), key=abs) for s in (-1, 1)]
            bracketed += 1
            if sides[0] * sides[1] >= 0 or max(abs(s) for s in sides) > mp.mpf(10) ** -15:
                wrong += 1
                print(f"{name}: the end {end['decimal']} is not bracketed: {[mp.nstr(s, 5) for s in sides]}")
        shown = ", ".join(f"{mp.nstr(lo, 10) if lo is not None else '-oo'} .. {mp.nstr(hi, 10) if hi is not None else 'oo'}" for lo, hi in ends)
        print(f"{name}: {shown or 'nowhere'}")
    print(f"{tried} points, {bracketed} ends bracketed to a part in 10^20, {wrong} disagreements")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
