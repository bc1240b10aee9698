#!/usr/bin/env python3
"""Margins of the loops of python-control's own tests: what these tests expect, what jurist answers, and a third way.

    python3 -m venv v && v/bin/pip install control mpmath && v/bin/pip download --no-deps control
    v/bin/python tests/outside/python_control_margins.py control-*.whl target/release/jurist > table.md

The loops are read from `control/tests/margin_test.py` in the wheel: its tables of systems and expected values, and nothing
of its code. Each loop is written as a model with its coefficients as decimals and asked for its margins to 50 digits. The
third way is mpmath at 120 digits: on the axis, and on the circle by z = (1 + jv)/(1 - jv), the conditions of the
crossings are polynomials in w or v, whose zeros it finds; it knows nothing of jurist's own. Every crossing and margin of
jurist has to agree with it to 40 digits, or the script ends with an error.
"""

import json
import math
import resource
import subprocess
import sys
import time
import types
import zipfile
from fractions import Fraction

import mpmath as mp

mp.mp.dps = 120


def tables(wheel):
    """The tables of the tests, with a stand-in for pytest that only keeps them."""
    kept = []

    class Mark:
        def parametrize(self, names, rows, **_):
            return lambda f: kept.append((f.__name__, names, rows)) or f

        def __getattr__(self, _):
            return lambda *a, **k: (lambda f: f)

    def fixture(*args, params=None, **_):
        if args:
            return args[0]
        return lambda f: kept.append((f.__name__, "fixture", params)) or f

    stand_in = types.ModuleType("pytest")
    stand_in.mark, stand_in.fixture = Mark(), fixture
    sys.modules["pytest"] = stand_in
    text = zipfile.ZipFile(wheel).read("control/tests/margin_test.py").decode()
    names = {"__name__": "margin_test"}
    exec(compile(text, "margin_test.py", "exec"), names)
    return kept, names


def decimals(p):
    return [repr(float(c)) for c in p]


def model(system):
    part = lambda p: ", ".join(decimals(p))
    kind = "discrete" if system.dt else "continuous"
    step = f"sample_time = {system.dt!r}\n" if system.dt else ""
    return (
        f"time = '{kind}'\n{step}[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n"
        f"num = [{part(system.num[0][0])}]\nden = [{part(system.den[0][0])}]\n"
    )


def asked(program, system):
    run = subprocess.run([program, "margins", "-", "--json", "--digits", "50"], input=model(system), text=True, capture_output=True)
    if run.returncode > 1:
        raise SystemExit(run.stderr)
    return json.loads(run.stdout)


# The third way. Polynomials are lists from the constant term up.


def times(p, q):
    out = [mp.mpc(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out


def plus(p, q, sign=1):
    n = max(len(p), len(q))
    at = lambda r, i: r[i] if i < len(r) else mp.mpc(0)
    return [at(p, i) + sign * at(q, i) for i in range(n)]


def along_boundary(p, n, discrete):
    """The polynomial in w of p(jw), or in v of (1 - jv)^n p((1 + jv)/(1 - jv))."""
    j = mp.mpc(0, 1)
    if not discrete:
        return [c * j**i for i, c in enumerate(p)]
    out = [mp.mpc(0)]
    for i, c in enumerate(p):
        term = [mp.mpc(c)]
        for _ in range(i):
            term = times(term, [1, j])
        for _ in range(n - i):
            term = times(term, [1, -j])
        out = plus(out, term)
    return out


def conjugate(p):
    return [mp.conj(c) for c in p]


def parts(p):
    return [mp.re(c) for c in p], [mp.im(c) for c in p]


def positive_zeros(p):
    """The simple and multiple positive zeros of a real polynomial, each once."""
    size = max((abs(c) for c in p), default=mp.mpf(0))
    p = [c for c in p]
    while p and abs(p[-1]) <= size * mp.mpf(10) ** -90:
        p.pop()
    while p and abs(p[0]) <= size * mp.mpf(10) ** -90:
        p.pop(0)
    if len(p) < 2:
        return []
    roots = mp.polyroots([mp.re(c) for c in reversed(p)], maxsteps=1000, extraprec=600)
    found = []
    for r in roots:
        if abs(mp.im(r)) <= abs(r) * mp.mpf(10) ** -35 and mp.re(r) > 0:
            x = mp.re(r)
            if all(abs(x - y) > x * mp.mpf(10) ** -30 for y in found):
                found.append(x)
    return sorted(found)


class Third:
    def __init__(self, system):
        exact = lambda p: [mp.mpf(Fraction(c).numerator) / Fraction(c).denominator for c in reversed(decimals(p))]
        num, den = exact(system.num[0][0]), exact(system.den[0][0])
        self.discrete = bool(system.dt)
        self.dt = system.dt
        n = max(len(num), len(den)) - 1
        self.n, self.d = (along_boundary(p, n, self.discrete) for p in (num, den))
        closed = [mp.re(c) for c in plus(num, den)]
        while closed and closed[-1] == 0:
            closed.pop()
        roots = mp.polyroots(list(reversed(closed)), maxsteps=1000, extraprec=600) if len(closed) > 1 else []
        outside = (lambda r: abs(r) >= 1) if self.discrete else (lambda r: mp.re(r) >= 0)
        self.outside = sum(1 for r in roots if outside(r))

    def at(self, v):
        value = lambda p: mp.polyval(list(reversed(p)), v)
        return value(self.n) / value(self.d)

    def rate(self, v):
        return 2 * mp.atan(v) if self.discrete else v

    def crossings(self):
        nn, dd = (parts(times(p, conjugate(p)))[0] for p in (self.n, self.d))
        gains = [(v, self.at(v)) for v in positive_zeros(plus(nn, dd, -1))]
        real, imaginary = parts(times(self.n, conjugate(self.d)))
        phases = [(v, self.at(v)) for v in positive_zeros(imaginary)]
        phases = [(v, x) for v, x in phases if mp.re(x) < 0]
        return gains, phases

    def least(self, above, below):
        """The least value of |above|/|below| over the positive frequencies and their ends."""
        a, b = (parts(times(p, conjugate(p)))[0] for p in (above, below))
        slope = lambda p: [i * c for i, c in enumerate(p)][1:] or [mp.mpf(0)]
        places = positive_zeros(plus(times(slope(a), b), times(a, slope(b)), -1))
        value = lambda p, v: mp.re(mp.polyval(list(reversed(p)), v))
        found = [mp.sqrt(abs(value(a, v) / value(b, v))) for v in places if abs(value(b, v)) > 0]
        if abs(b[0]) > 0:
            found.append(mp.sqrt(abs(a[0] / b[0])))
        top = max(i for i, c in enumerate(plus(a, b)) if abs(c) > mp.mpf(10) ** -100)
        if top < len(b) and abs(b[top]) > mp.mpf(10) ** -100:
            found.append(mp.sqrt(abs((a[top] if top < len(a) else 0) / b[top])))
        return min(found)

    def modulus(self):
        return self.least(plus(self.n, self.d), self.d)

    def disk(self):
        return 2 * self.least(plus(self.n, self.d), plus(self.d, self.n, -1))


def digits(ours, third):
    """To how many digits two numbers agree."""
    ours = mp.mpf(ours)
    if ours == third:
        return 99
    return int(-mp.log10(abs(ours - third) / max(abs(third), mp.mpf(10) ** -30)))


def matched(ours, third):
    """The least agreement of the numbers of two lists, pairwise by nearness."""
    if len(ours) != len(third):
        return -1
    rest, worst = list(third), 99
    for x in ours:
        near = min(rest, key=lambda y: abs(mp.mpf(x) - y))
        rest.remove(near)
        worst = min(worst, digits(x, near))
    return worst


def confirmed(found, third):
    """Everything that jurist says of a loop against the third way: the least number of digits that agree."""
    gains, phases = third.crossings()
    inside = lambda list, key: [c for c in found["crossings"][list] if c[key] not in (None, 0)]
    place = "angle" if third.discrete else "frequency_hz"
    ends = lambda c: third.discrete and abs(float(c["angle"] or 0) - math.pi) < 1e-12
    ours_gain = [c for c in inside("gain", place) if not ends(c)]
    ours_phase = [c for c in inside("phase", place) if not ends(c)]
    out = [
        matched([c["phase_margin_degrees"] for c in ours_gain], [mp.degrees(mp.arg(-x)) for _, x in gains]),
        matched([c["factor"] for c in ours_phase], [-1 / mp.re(x) for _, x in phases]),
    ]
    lag = lambda x: mp.arg(-x) % (2 * mp.pi)
    delays = [lag(x) / third.rate(v) for v, x in gains]
    out.append(matched([c["delay"] for c in ours_gain], delays))
    if found["stable"]:
        out.append(digits(found["modulus"]["value"]["decimal"], third.modulus()))
        if found["disk"]["alpha"]:
            out.append(digits(found["disk"]["alpha"]["decimal"], third.disk()))
    if (third.outside == 0) != found["stable"]:
        return -1
    return min(out)


def children():
    """Processor time of all finished child processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def short(x, places=8):
    return "–" if x is None or not math.isfinite(float(x)) else mp.nstr(mp.mpf(x), places)


def loops(wheel):
    """Name, system, and the expected gain margins, phase margins and modulus margins, with the tests' tolerances."""
    import control

    kept, names = tables(wheel)
    as_list = lambda x: [float(v) for v in x] if hasattr(x, "__len__") else [float(x)]
    for test, _, rows in kept:
        if test == "tsys":
            for i, (make, given, one, every) in enumerate(rows):
                system = control.tf(make(*given)) if make else given
                yield f"tsys {i}", system, [as_list(e) for e in every[:3]], 1.5e-2, 0.0
        elif test == "test_zmore_margin":
            systems = names["tsys_zmoresystems"]()
            for row in rows:
                gain, phase, _, _ = row["result"]
                yield f"{row['sysname']} × {row['K']:g}", systems[row["sysname"]] * row["K"], [[gain], [phase], []], row["atol"], 0.0
        elif test == "test_zmore_stability_margins":
            systems = names["tsys_zmoresystems"]()
            for row in rows:
                every = [as_list(e) for e in row["result"][:3]]
                yield f"{row['sysname']} × {row['K']:g}, all", systems[row["sysname"]] * row["K"], every, row["atol"], row["rtol"]
        elif test == "test_stability_margins_discrete":
            for i, (num, den, dt, ref, relative, _) in enumerate(rows):
                system = control.TransferFunction(num, den).sample(dt)
                yield f"discrete {i}", system, [[ref[0]], [ref[1]], [ref[2]]], 0.0, relative


def remarks(found, expected, absolute, relative):
    """The expected numbers that are no crossings or margins of this loop, and those with digits that are not theirs."""
    gains = [float(c["factor"]) for c in found["crossings"]["phase"]]
    phases = [float(c["phase_margin_degrees"]) for c in found["crossings"]["gain"]]
    modulus = [float(found["modulus"]["value"]["decimal"])] if found["modulus"] else None
    out = []
    for what, values, ours in (("gain", expected[0], gains), ("phase", expected[1], phases), ("modulus", expected[2], modulus)):
        values = [v for v in values if math.isfinite(v)]
        if ours is None or not values:
            continue
        # Of the local minima of |1 + L| the least one is the margin.
        values = [min(values)] if what == "modulus" else values
        for v in values:
            nearest = min(ours, key=lambda o: abs(o - v), default=None)
            if nearest is None or abs(v - nearest) > absolute + relative * abs(v):
                out.append(f"{what} {v!r} expected, {'none' if nearest is None else repr(nearest)} found")
            elif abs(v - nearest) > Fraction(51, 100) / 10 ** decimal_places(v):
                out.append(f"{what} {v!r} is {nearest:.8g}")
    return out


def decimal_places(v):
    """How many digits after the point a number is written with; negative for tens."""
    digits, _, exponent = repr(v).partition("e")
    return len(digits.partition(".")[2].rstrip("0")) - int(exponent or 0)


def main():
    import control

    wheel, program = sys.argv[1:3]
    print("| loop | stable | gain margin | phase margin | modulus | third way | against the test |")
    print("|---|---|---|---|---|---|---|")
    worst, deviations, digits_off, unstable, count = 99, 0, 0, 0, 0
    for name, system, expected, absolute, relative in loops(wheel):
        found, third = asked(program, system), Third(system)
        agreed = confirmed(found, third)
        if agreed < 40:
            raise SystemExit(f"{name}: jurist and the third way agree to {agreed} digits only")
        said = remarks(found, expected, absolute, relative)
        count, worst = count + 1, min(worst, agreed)
        deviations, unstable = deviations + any("expected" in s for s in said), unstable + (not found["stable"])
        digits_off += sum(" is " in s for s in said)
        gain = found["gain"]["upper"]["decimal"] if found["stable"] and found["gain"]["upper"] else None
        phase = found["phase"]["degrees"] if found["stable"] else None
        modulus = found["modulus"]["value"]["decimal"] if found["stable"] else None
        verdict = "yes" if found["stable"] else f"**no**, {third.outside} outside"
        if not found["stable"]:
            said.insert(0, "no margins: the test's numbers are crossings of an unstable loop")
        print(f"| {name} | {verdict} | {short(gain)} | {short(phase)} | {short(modulus)} | {agreed} digits | {'; '.join(said) or 'agrees'} |")
    print(f"\n{count} loops, {unstable} of them unstable, {deviations} with numbers that differ by more than the test allows, {digits_off} numbers whose last digits are not those of the loop; jurist and the third way agree to {worst} digits or more.")

    # Crossing by crossing beside what python-control computes, and the processor time of both, one after the other.
    print("\n| loop | gain crossings (jurist / python-control) | phase crossings | largest difference | python-control | jurist, whole process |")
    print("|---|---|---|---|---|---|")
    for name, system, *_ in loops(wheel):
        start = time.process_time()
        theirs = control.stability_margins(system, returnall=True)
        of_theirs = time.process_time() - start
        start = children()
        found = asked(program, system)
        of_ours = children() - start
        pairs = []
        for values, ours in ((theirs[0], [c["factor"] for c in found["crossings"]["phase"]]), (theirs[1], [c["phase_margin_degrees"] for c in found["crossings"]["gain"]])):
            ours = [float(v) for v in ours]
            for v in (float(v) for v in values if math.isfinite(v)):
                nearest = min(ours, key=lambda o: abs(o - v), default=math.inf)
                pairs.append(abs(v - nearest) / max(abs(v), 1e-12))
        largest = f"{max(pairs):.1e}" if pairs else "–"
        counts = [f"{len(found['crossings'][ours])} / {len(theirs[i])}" for ours, i in (("gain", 1), ("phase", 0))]
        print(f"| {name} | {counts[0]} | {counts[1]} | {largest} | {1e3 * of_theirs:.1f} ms | {1e3 * of_ours:.1f} ms |")


if __name__ == "__main__":
    main()
