#!/usr/bin/env python3
"""The largest factors of published boxes of tolerances: jurist's answers, both checkers on their certificates, and a second way.

    python3 -m venv v && v/bin/pip install numpy mpmath
    v/bin/python tests/outside/published_tolerances.py target/release/jurist [MODEL [COUNT]]

The second way reads the model files itself and knows nothing of Bernstein coefficients. On the ray to each corner of a box (up to
4096) the first loss of stability is bracketed by the eigenvalues that numpy computes, first on a grid and then by halving: no
corner may lose stability before the certified lower end, and the worst corner's loss is refined by mpmath at 60 digits and
compared with the exact factor. Of the unstable disc, whose worst point is no corner, the second way is a formula. Prints a table.
"""

import functools
import itertools
import json
import re
import subprocess
import sys
import tempfile
import time
import tomllib
from fractions import Fraction
from pathlib import Path

import mpmath as mp
import numpy as np

mp.mp.dps = 60
ROOT = Path(__file__).resolve().parents[2]
NAMES = "R_a L_a J B_v K_a k_1 k_2 E_sw K_pi K_ii K_ps K_is".split()
GRID, HALVINGS, DIGITS = 64, 50, 25

# Name, model, names with 20 %, the digits that are expected, whether the factor is proved as an exact number.
PROBLEMS = [
    ("de Gaston and Safonov", "de-gaston-safonov", 0, "3.41739553123723210518", True),
    ("Vicino, Tesi and Milanese", "vicino-tesi-milanese", 0, "6.27463433653790895", True),
    ("track-guided bus", "bus-steering", 0, "0.98877122828155174", True),
    ("Fiat Dedra", "fiat-dedra", 0, "1.463330048511604", False),
    ("Ackermann's disc", "unstable-disc", 0, "3/11", True),
    ("drive", "drive", 4, "4.0014443545063", False),
    ("drive", "drive", 8, "2.2998047407519", False),
    ("drive", "drive", 12, "1.9111019153889", False),
]


NUMERAL = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][+-]?\d+)?)")


@functools.cache
def compiled(text):
    """An expression of a model file, its numerals as calls of `_n`, exponents as they are."""
    text = re.sub(r"\*\*\s*(\d+)", r"**\1", text.strip().replace("\n", " ").replace("^", "**"))
    parts = re.split(r"(\*\*\d+)", text)
    marked = "".join(p if p.startswith("**") else NUMERAL.sub(r"_n('\1')", p) for p in parts)
    return compile(marked, "model", "eval")


@functools.cache
def to_float(text):
    return float(Fraction(str(text)))


def to_mp(text):
    value = Fraction(str(text))
    return mp.mpf(value.numerator) / value.denominator


class Loop:
    """The roots of a loop, of a model file that is read without jurist."""

    def __init__(self, path):
        self.document = tomllib.loads(path.read_text(), parse_float=str)
        self.discrete = self.document["time"] == "discrete"
        both = self.document.get("constants", {}) | self.document.get("parameters", {})
        value = lambda e: e.get("value", e.get("nominal")) if isinstance(e, dict) else e
        self.nominal = {name: Fraction(str(value(e))) for name, e in both.items()}
        ends = lambda e: [Fraction(e["tolerance"][key]) for key in ("low", "high")]
        self.tolerances = {name: ends(e) for name, e in both.items() if isinstance(e, dict) and "tolerance" in e}

    def evaluated(self, text, names, convert):
        return eval(compiled(str(text)), {"__builtins__": {}, "_n": convert}, names)

    def excess(self, point, convert):
        """The greatest real part of a root, or the greatest modulus less one; floats for many points at once."""
        names = {name: convert(value) for name, value in self.nominal.items()} | point
        loop = self.document["loop"]
        if "A" in loop:
            a, b, c, k = ([[self.evaluated(e, names, convert) for e in row] for row in loop[key]] for key in "ABCK")
            if convert is to_mp:
                a, b, c, k = (mp.matrix(m) for m in (a, b, c, k))
                roots = mp.eig(a - b * k * c, left=False, right=False)
            else:
                a, b, c, k = (stacked(m) for m in (a, b, c, k))
                roots = np.linalg.eigvals(a - b @ k @ c)
        else:
            p = lift(self.evaluated(loop["characteristic"], names | {"s": Powers([0, 1])}, convert)).c
            if convert is to_mp:
                roots = mp.polyroots(p[::-1], maxsteps=500, extraprec=400)
            else:
                n = len(p) - 1
                below = [[float(i + 1 == j) for j in range(n)] for i in range(n - 1)]
                roots = np.linalg.eigvals(stacked([*below, [-c / p[n] for c in p[:n]]]))
        if convert is to_mp:
            return max(abs(r) - 1 if self.discrete else mp.re(r) for r in roots)
        return (abs(roots) - 1 if self.discrete else roots.real).max(axis=-1)


def stacked(rows):
    """Matrices of floats, one for each point."""
    parts = np.broadcast_arrays(*(np.asarray(e, float) for row in rows for e in row))
    return np.stack(parts, axis=-1).reshape(*parts[0].shape, len(rows), -1)


class Powers:
    """A polynomial in s as the list of its coefficients."""

    __array_ufunc__ = None

    def __init__(self, c):
        self.c = c

    def __add__(self, other):
        a, b = self.c, lift(other).c
        n = max(len(a), len(b))
        return Powers([(a[i] if i < len(a) else 0) + (b[i] if i < len(b) else 0) for i in range(n)])

    def __mul__(self, other):
        a, b = self.c, lift(other).c
        out = [0] * (len(a) + len(b) - 1)
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                out[i + j] = out[i + j] + x * y
        return Powers(out)

    def __neg__(self):
        return Powers([-x for x in self.c])

    def __sub__(self, other):
        return self + (-lift(other))

    def __rsub__(self, other):
        return lift(other) - self

    def __pow__(self, n):
        out = Powers([1])
        for _ in range(n):
            out = out * self
        return out

    __radd__, __rmul__ = __add__, __mul__


def lift(x):
    return x if isinstance(x, Powers) else Powers([x])


def second_way(loop, sides, lower, signs, still):
    """The least loss over all corners (floats), and the loss at the worst one (60 digits)."""
    names = list(sides)
    corners = list(itertools.product(*(sorted(set(sides[n])) for n in names)))
    step = {n: np.array([float(corner[i] - loop.nominal[n]) for corner in corners]) for i, n in enumerate(names)}

    def excess(t, chosen):
        return loop.excess({n: float(loop.nominal[n]) + t * step[n][chosen] for n in names}, to_float)

    chosen, lost = np.arange(len(corners)), None
    upto = float(lower) * 1.0001
    for k in range(1, GRID + 1):
        bad = excess(upto * k / GRID, chosen) >= 0
        if bad.any():
            chosen, lost = chosen[bad], k
            break
    least = None
    if lost is not None:
        lo, hi = upto * (lost - 1) / GRID * np.ones(len(chosen)), upto * lost / GRID * np.ones(len(chosen))
        for _ in range(HALVINGS):
            middle = (lo + hi) / 2
            bad = excess(middle, chosen) >= 0
            lo, hi = np.where(bad, lo, middle), np.where(bad, middle, hi)
        least = float(hi.min())
    if any(sign == "inside" and name not in still for name, sign in signs.items()):
        return least, None
    lo = to_mp(lower)
    hi = lo * mp.mpf("1.00001")
    end = {n: 0 if n in still else sides[n][signs[n] == "+"] - loop.nominal[n] for n in names}
    for _ in range(DIGITS * 4):
        middle = (lo + hi) / 2
        bad = loop.excess({n: to_mp(loop.nominal[n]) + middle * to_mp(end[n]) for n in names}, to_mp) >= 0
        lo, hi = (lo, middle) if bad else (middle, hi)
    return least, hi


def run(*command):
    start = time.perf_counter()
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    return done, time.perf_counter() - start


def agrees(text, digits):
    """Whether two decimals have the digits of the shorter one, up to one in the last."""
    places = min(len(number.split(".")[1]) for number in (text, digits))
    return abs(mp.mpf(text) - mp.mpf(digits)) <= mp.mpf(10) ** -places


def row(program, checker, problem):
    title, example, count, digits, exact_expected = problem
    model = ROOT / "examples" / f"{example}.toml"
    loop = Loop(model)
    sides = loop.tolerances
    asked = [program, "tolerance", model, "--json", *(["--exact", "--digits", "18"] if exact_expected else ["--digits", "12"])]
    if count:
        sides = {n: [loop.nominal[n] * Fraction(4, 5), loop.nominal[n] * Fraction(6, 5)] for n in NAMES[:count]}
        asked += ["--tol", ",".join(NAMES[:count]) + "=20%"]
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        done, seconds = run(*asked, "--certificate", file.name)
        document = json.loads(done.stdout)
        rust, rust_seconds = run(checker, model, file.name)
        python, python_seconds = run(sys.executable, ROOT / "crates/check/check.py", model, file.name)
        size = Path(file.name).stat().st_size
    factor = document["factor"]
    lower, upper = Fraction(factor["lower"]), Fraction(factor["upper"])
    exact_value = factor["exact"]
    expected = Fraction(digits) if "/" in digits else None
    shown = str(expected) if expected is not None else digits
    problems = []
    signs = document["worst"]["signs"]
    point = document["worst"]["point"]
    # At its nominal value where the box has no room on that side.
    still = {n for n in sides if Fraction(point[n]) == loop.nominal[n]}
    least, refined = second_way(loop, sides, lower, signs, still)
    if expected is not None:
        if not (exact_value and Fraction(exact_value["exact"]) == expected):
            problems.append("exact value")
        # The nearest point of the disc (q1 - 1)^2 + (q2 - 1)^2 = 1/100 to the nominal point, in widths of 11/10 and 17/20.
        way = "formula (7/5 - 11/10)/(11/10)"
        if (Fraction(7, 5) - Fraction(11, 10)) / Fraction(11, 10) != expected:
            problems.append("formula")
    else:
        value = exact_value or document["worst"]["on_line"]
        if not agrees(value["decimal"], digits):
            problems.append(f"decimal {value['decimal']}")
        if refined is None or not agrees(mp.nstr(refined, 30), digits):
            problems.append(f"second way {refined}")
        way = "all corners; worst one " + (mp.nstr(refined, 20) if refined is not None else "none")
    if least is not None and least < float(lower) * (1 - 1e-9):
        problems.append(f"a corner is lost at {least}")
    if exact_expected and not exact_value:
        problems.append("no exact factor")
    if not (lower < (expected or Fraction(str(digits)) + Fraction(1, 10**12)) and upper >= lower):
        problems.append("bracket")
    if rust.returncode or python.returncode:
        problems.append((rust.stderr or rust.stdout)[:80] + (python.stderr or python.stdout)[:80])
    degree = len(exact_value["polynomial"]) - 1 if exact_value and exact_value["polynomial"] else None
    kind = f"exact, degree {degree}" if degree and degree > 1 else "exact, rational" if exact_value else f"gap {float((upper - lower) / upper):.0e}"
    verdict = document["verdict"]
    print(
        f"| {title}{f', {count}' if count else ''} | {len(sides)} | {shown} | {kind} | {verdict} | {document['cells'] or '-'} "
        f"| {size} B, {rust_seconds:.2f} s, {python_seconds:.2f} s | {way} | {'; '.join(problems) or 'agrees'} |",
        flush=True,
    )
    print(f"{title} {count}: {seconds:.2f} s", file=sys.stderr)
    return not problems


def main():
    program = Path(sys.argv[1]).resolve()
    checker = program.with_name("jurist-check")
    print("| problem | m | largest factor | here | box | cells | certificate: size, jurist-check, check.py | second way | |")
    print("|---|---|---|---|---|---|---|---|---|")
    wanted = [p for p in PROBLEMS if not sys.argv[2:] or [p[1], str(p[2])][: len(sys.argv) - 2] == sys.argv[2:]]
    sys.exit(0 if all([row(program, checker, p) for p in wanted]) else 1)


if __name__ == "__main__":
    main()
