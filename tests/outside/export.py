#!/usr/bin/env python3
"""The scripts of `jurist export`, run by the programs they are for, against jurist's own characteristic polynomials.

    python3 -m venv v && v/bin/pip install control mpmath
    v/bin/python tests/outside/export.py target/release/jurist            # python-control
    v/bin/python tests/outside/export.py target/release/jurist --matlab   # Octave with its package control

Every model of examples/, of the templates and of tests/corpus, and loops with each rule before each hold, are exported at its nominal point; a parameter without a value is set to 1/2. The poles
of the closed loop, as the other program finds them, are compared with the zeros of the exact characteristic polynomial, which
mpmath finds with 80 digits. There have to be as many, and each has to be near its own: within 1e-9 of the largest or
as far as it moves where coefficients change by their last bits, and for m zeros close together within the m-th root of what floating point leaves. From each input to each output of a loop that names both, the transfer
function has the value of jurist's exact one at a point away from the poles, within 1e-8 of the largest. A script that is refused is counted with its reason. Any
difference is an error.
"""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from fractions import Fraction
from pathlib import Path

import mpmath as mp

ROOT = Path(__file__).resolve().parents[2]
mp.mp.dps = 400

# What a script is run with, and how its poles are printed for this comparison.
POINT = 1.7 + 0.9j
PYTHON = f"""
import numpy
for p in poles if 'poles' in globals() else closed_loop.poles():
    print('POLE', repr(float(numpy.real(p))), repr(float(numpy.imag(p))))
if 'poles' not in globals():
    for row in closed_loop.D + closed_loop.C @ numpy.linalg.solve({POINT} * numpy.eye(closed_loop.nstates) - closed_loop.A, closed_loop.B):
        print('GAIN', *(f'{{complex(g).real!r}} {{complex(g).imag!r}}' for g in row))
"""
OCTAVE = "\nif exist('poles', 'var'), found = poles; else, found = pole(closed_loop); end\nfor k = 1:numel(found), printf('POLE %.17g %.17g\\n', real(found(k)), imag(found(k))); end\nif ~exist('poles', 'var'), [a_, b_, c_, d_] = ssdata(closed_loop); h_ = c_*(((1.7 + 0.9i)*eye(size(a_)) - a_)\\b_) + d_; for k = 1:size(h_, 1), printf('GAIN'); for l = 1:size(h_, 2), printf(' %.17g %.17g', real(h_(k, l)), imag(h_(k, l))); end, printf('\\n'); end, end\n"


# Each rule before each hold; outputs with a direct part.
RULES = ("'tustin'", "'backward'", "'forward'", "{ method = 'tustin', prewarp = 'w' }", "{ method = 'tustin', c = 'c' }", "{ method = 'forward', T = '2*T' }")
HOLDS = ("'zoh'", "'foh'", "{ method = 'zoh', delay = '1.3*T' }", "{ method = 'foh', delay = '0.4*T' }")
MADE = """
time = 'discrete'
sample_time = 'T'
parameters = {{ T = 0.1, w = 2, c = 3, K = 2 }}
[loop]
inputs = ['r']
outputs = ['y', 'r - y']
[[block]]
name = 'controller'
input = 'r - y'
output = 'u'
transfer = 'K*(1 + 1/(4*s) + 1/(s + 9)^2)'
discretize = {}
[[block]]
name = 'plant'
input = 'u'
output = 'y'
transfer = '(s + 3)/((s + 1)*(s + 2))/(s + 1) + 1/(s + 1)'
discretize = {}
"""


def models(folder):
    """Name and file of each model."""
    made = [MADE.format(rule, hold) for rule in RULES for hold in HOLDS]
    made.append((ROOT / "examples/drive-pwm.toml").read_text().replace('"trailing"', '"alternating"'))
    for k, text in enumerate(made, 1):
        file = folder / f"made-{k}.toml"
        file.write_text(text)
        yield f"made {k}", file
    yield from ((path.stem, path) for path in sorted((ROOT / "examples").glob("*.toml")))
    yield from ((f"template {path.stem}", path) for path in sorted((ROOT / "src/cli/templates").glob("*.toml")))
    for path in sorted((ROOT / "tests/corpus").glob("*.toml")):
        case = tomllib.loads(path.read_text())
        if "model" in case:
            file = folder / path.name
            file.write_text(case["model"])
            yield f"corpus {path.stem}", file


def run(*arguments):
    return subprocess.run(arguments, capture_output=True, text=True, timeout=300)


def exported(program, model, target):
    """The script and the values that were set for it, or why there is none."""
    values = []
    while True:
        done = run(program, "export", str(model), "--to", target, "--quiet", *(f"--set={v}" for v in values))
        missing = re.search(r"error\[E-no-value\]: the parameter '(.+)' has no value", done.stderr)
        if done.returncode == 0:
            return done.stdout, values
        if not missing or len(values) > 20:
            error = re.search(r"error(?:\[.*?\])?: .*", done.stderr)
            return None, error.group(0) if error else done.stderr.strip()
        values.append(f"{missing.group(1)}=1/2")


def value(terms, point):
    total = mp.mpf(0)
    for exponents, coefficient in terms:
        numerator, _, denominator = coefficient.partition("/")
        term = mp.mpf(int(numerator)) / int(denominator or 1)
        for x, exponent in zip(point, exponents):
            term *= x**exponent
        total += term
    return total


def constants(found):
    """The values of what the coefficients of a document are functions of."""
    names = {"sqrt": mp.sqrt, "exp": mp.exp, "sin": mp.sin, "cos": mp.cos, "tan": mp.tan, "tanh": mp.tanh, "pi": +mp.pi}
    point = [mp.mpf(0) for _ in found["parameters"]]
    for name, meaning in found.get("symbols", {}).items():
        text = re.sub(r"(?<![\w.])(\d+)(?![\w.])", r"mpf(\1)", meaning.replace("^", "**"))
        names[name] = mp.mpmathify(eval(text, {"mpf": mp.mpf, **names}))
        point.append(names[name])
    return point


def nominal(program, model, values):
    """The values of all parameters."""
    verdict = json.loads(run(program, "verdict", str(model), "--json", "--quiet", *(f"--set={v}" for v in values)).stdout)
    return [f"{name}={v}" for name, v in verdict["set"].items()]


def wrong_gain(program, model, values, gains):
    """The input and the output between which the loop's gain is another one; how many gains have been compared."""
    loop, compared = tomllib.loads(Path(model).read_text())["loop"], 0
    largest = max((abs(g) for row in gains for g in row), default=0)
    for i, output in enumerate(loop.get("outputs", [])):
        for j, given in enumerate(loop.get("inputs", [])):
            done = run(program, "charpoly", str(model), "--transfer", given, output, "--json", "--quiet", *(f"--set={v}" for v in values))
            if done.returncode:
                continue
            found = json.loads(done.stdout)
            point = constants(found)
            part = lambda p: mp.polyval([value(c["numerator"], point) / value(c["denominator"], point) for c in reversed(p)], mp.mpc(POINT))
            exact = part(found["numerator"]) / part(found["denominator"])
            if abs(exact - gains[i][j]) > 1e-8 * max(abs(exact), largest):
                return f"from {given} to {output}: {gains[i][j]}, exactly {mp.nstr(exact, 12)}", compared
            compared += 1
    return None, compared


def exact_roots(program, model, values):
    """The zeros of the characteristic polynomial, those at 0 first."""
    done = run(program, "charpoly", str(model), "--json", "--quiet", *(f"--set={v}" for v in values))
    found = json.loads(done.stdout)
    point = constants(found)
    entries = [value(c["numerator"], point) / value(c["denominator"], point) for c in found["coefficients"]]
    size = max(abs(c) for c in entries)
    while entries and abs(entries[-1]) <= size * mp.mpf(10) ** -200:
        entries.pop()
    zeros = 0
    while entries and abs(entries[0]) <= size * mp.mpf(10) ** -200:
        entries.pop(0)
        zeros += 1
    is_rational = not found.get("symbols")
    parts = square_free([rational(c) for c in found["coefficients"]][zeros : zeros + len(entries)]) if is_rational else [(entries, 1)]
    roots = []
    for part, times in parts:
        exact = [mp.mpf(c.numerator) / c.denominator if isinstance(c, Fraction) else c for c in reversed(part)]
        with mp.workdps(80):
            roots += times * (mp.polyroots(exact, maxsteps=2000, extraprec=400) if len(exact) > 1 else [])
    return [mp.mpc(0)] * zeros + [mp.mpc(r) for r in roots], entries


def rational(coefficient):
    """A coefficient without symbols."""
    constant = lambda terms: sum((Fraction(c) for _, c in terms), Fraction(0))
    return constant(coefficient["numerator"]) / constant(coefficient["denominator"])


def quotient(p, q):
    """Quotient and remainder of polynomials of fractions, from the constant term up."""
    rest, out = list(p), []
    while len(rest) >= len(q):
        factor = rest[-1] / q[-1]
        out.append(factor)
        for i, c in enumerate(q):
            rest[len(rest) - len(q) + i] -= factor * c
        rest.pop()
    while rest and rest[-1] == 0:
        rest.pop()
    return out[::-1], rest


def common(p, q):
    while q:
        p, q = q, quotient(p, q)[1]
        q = [c / q[-1] for c in q] if q else q
    return p


def square_free(p):
    """Factors without multiple zeros, each with its multiplicity: a zero that is not simple would take mpmath long."""
    slope = [i * c for i, c in enumerate(p)][1:]
    out, times = [], 1
    shared = common(p, slope) if slope else [Fraction(1)]
    rest = quotient(p, shared)[0]
    while len(rest) > 1:
        both = common(rest, shared)
        part = quotient(rest, both)[0]
        if len(part) > 1:
            out.append((part, times))
        rest, shared, times = both, quotient(shared, both)[0], times + 1
    return out


def shaken(polynomial, root):
    """By how much a zero moves where each coefficient changes by its last bits."""
    slope = sum(k * c * root ** (k - 1) for k, c in enumerate(polynomial) if k)
    sizes = sum(abs(c * root**k) for k, c in enumerate(polynomial))
    return sizes * mp.mpf(10) ** -13 / abs(slope) if slope else mp.mpf(0)


def farthest(roots, poles, polynomial):
    """How far the worst pole is from its zero, as a share of what is allowed."""
    size = max([abs(r) for r in roots], default=mp.mpf(1))
    size = max(size, mp.mpf(10) ** -12)
    rest, worst = list(poles), mp.mpf(0)
    for r in sorted(roots, key=abs, reverse=True):
        near = min(rest, key=lambda p: abs(p - r))
        rest.remove(near)
        close = sum(1 for other in roots if abs(other - r) <= size * mp.mpf(10) ** -2)
        allowed = size * (mp.mpf(10) ** -9 if close == 1 else 30 * mp.mpf(10) ** (mp.mpf(-14) / close))
        allowed = max(allowed, shaken(polynomial, r)) if close == 1 else allowed
        worst = max(worst, abs(near - r) / allowed)
    return worst


def poles_of(script, folder, is_matlab):
    file = folder / ("script.m" if is_matlab else "script.py")
    file.write_text(script + (OCTAVE if is_matlab else PYTHON))
    done = run("octave", "-q", str(file)) if is_matlab else run(sys.executable, "-W", "error", str(file))
    lines = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("POLE")]
    if done.returncode != 0:
        return None, done.stderr.strip().splitlines()[-1:] or ["no message"]
    rows = [[float(x) for x in line.split()[1:]] for line in done.stdout.splitlines() if line.startswith("GAIN")]
    gains = [[complex(*row[k : k + 2]) for k in range(0, len(row), 2)] for row in rows]
    return [mp.mpc(re, im) for re, im in lines], gains


def main():
    program, is_matlab = sys.argv[1], "--matlab" in sys.argv[2:]
    only = [a for a in sys.argv[2:] if not a.startswith("--")]
    target = "matlab" if is_matlab else "python-control"
    refused, different, equal, transfers = Counter(), [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, model in models(folder):
            if only and name not in only:
                continue
            script, values = exported(program, model, target)
            if script is None:
                refused[re.sub(r"'[^']*'", "'..'", values)[:110]] += 1
                continue
            poles, gains = poles_of(script, folder, is_matlab)
            if poles is None:
                different.append(f"{name}: does not run: {gains}")
                continue
            values = nominal(program, model, values)
            roots, polynomial = exact_roots(program, model, values)
            if len(roots) != len(poles):
                different.append(f"{name}: {len(poles)} poles, and {len(roots)} zeros of the polynomial")
                continue
            worst = farthest(roots, poles, polynomial)
            if worst > 1:
                different.append(f"{name}: {mp.nstr(worst, 3)} times what is allowed")
                continue
            wrong, compared = wrong_gain(program, model, values, gains)
            if wrong:
                different.append(f"{name}: {wrong}")
                continue
            equal, transfers = equal + 1, transfers + compared
    print(f"{target}: {equal} equal, {transfers} transfer functions among them, {sum(refused.values())} refused, {len(different)} different")
    for reason, count in refused.most_common():
        print(f"  refused {count}: {reason}")
    for line in different:
        print(f"  different: {line}")
    sys.exit(1 if different or (equal < 50 and not only) else 0)


if __name__ == "__main__":
    main()
