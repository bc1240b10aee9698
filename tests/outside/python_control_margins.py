#!/usr/bin/env python3
"""Margins of the loops of python-control's own tests, beside what these tests expect.

    pip install control && pip download --no-deps control
    python3 tests/outside/python_control_margins.py control-*.whl target/release/jurist

The loops are read from `control/tests/margin_test.py` in the wheel: its tables of systems and expected values, and nothing
of its code. Each loop is written as a model with its coefficients as decimals, asked for its margins, and compared. A value
that differs by more than the test's own tolerance is printed; so is every loop that the test gives margins of though it is
unstable.
"""

import json
import math
import subprocess
import sys
import types
import zipfile


def tables(wheel):
    """The module of the tests, with a stand-in for pytest that only keeps the tables."""
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


def model(system):
    import control

    system = control.tf(system)
    part = lambda p: ", ".join(repr(float(c)) for c in p)
    time = "discrete" if system.dt else "continuous"
    step = f"sample_time = {system.dt!r}\n" if system.dt else ""
    return (
        f"time = '{time}'\n{step}[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n"
        f"num = [{part(system.num[0][0])}]\nden = [{part(system.den[0][0])}]\n"
    )


def margins(program, system):
    run = subprocess.run([program, "margins", "-", "--json", "--digits", "15"], input=model(system), text=True, capture_output=True)
    if run.returncode > 1:
        return {"refused": run.stderr.splitlines()[0]}
    return json.loads(run.stdout)


def crossings(found):
    """Gain factors, phase margins, and the modulus margin, as the tests list them."""
    gains = [float(c["factor"]) for c in found["crossings"]["phase"]]
    phases = [float(c["phase_margin_degrees"]) for c in found["crossings"]["gain"]]
    modulus = float(found["modulus"]["value"]["decimal"]) if found.get("modulus") else None
    return gains, phases, modulus


def near(value, values, absolute, relative):
    return any(abs(value - v) <= absolute + relative * abs(value) for v in values)


def compare(name, found, gain, phase, absolute, relative=0.0):
    if "refused" in found:
        print(f"{name}: refused: {found['refused']}")
        return
    gains, phases, _ = crossings(found)
    remarks = [] if found["stable"] else ["UNSTABLE, so these are no margins"]
    for what, value, values in (("gain", gain, gains), ("phase", phase, phases)):
        if value is None or not math.isfinite(value):
            continue
        if not near(value, values, absolute, relative):
            remarks.append(f"{what} {value} expected, crossings {[round(v, 6) for v in values]}")
    print(f"{name}: {'; '.join(remarks) or 'agrees'}")


def main():
    wheel, program = sys.argv[1:3]
    kept, names = tables(wheel)
    for test, what, rows in kept:
        if test == "tsys":
            for i, row in enumerate(rows):
                make, given, one, _ = row
                system = make(*given) if make else given
                compare(f"tsys[{i}]", margins(program, system), one[0], one[1], 1.5e-2)
        elif test == "test_zmore_margin":
            systems = names["tsys_zmoresystems"]()
            for row in rows:
                system = systems[row["sysname"]] * row["K"]
                gain, phase, _, _ = row["result"]
                compare(f"{row['sysname']} * {row['K']:g}", margins(program, system), gain, phase, row["atol"])
        elif test == "test_stability_margins_discrete":
            import control

            for i, (num, den, dt, ref, relative, _) in enumerate(rows):
                system = control.TransferFunction(num, den).sample(dt)
                compare(f"discrete[{i}]", margins(program, system), ref[0], ref[1], 0.0, relative)


if __name__ == "__main__":
    main()
