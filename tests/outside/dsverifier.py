#!/usr/bin/env python3
"""Every closed loop in a checkout of DSVerifier: a second reader, verdicts in exact fractions, roots by numpy, and what was expected.

    git clone https://github.com/ssvlab/dsverifier
    python3 -m venv v && v/bin/pip install numpy
    v/bin/python tests/outside/dsverifier.py dsverifier [PROGRAM] [--table FILE]

The second reader knows nothing of ours: regular expressions, and conditions `#if NAME == NUMBER` in all their combinations. Each loop is read as falling
powers of z (lists aligned at their ends) and as powers of z^-1 (at their beginnings), as it is printed and with every coefficient of the controller rounded down
as DSVerifier stores it. Stability is the Schur-Cohn recursion in fractions, and beside it stands the greatest modulus of the roots that numpy computes.
Printed are the expectations in `test.desc` that are false, the loops whose readings differ, and counts. With PROGRAM, `jurist import` and `jurist verdict`
answer the same questions, and every difference is printed and is status 1. `--table` writes the numbers of the loops, which the tests of `crates/ship` read.
"""

import argparse
import collections
import itertools
import json
import math
import re
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

import numpy as np

READINGS = ("z", "z^-1")
Loop = collections.namedtuple("Loop", "path defines integer fraction lists sizes percent expected float")


def text_of(path):
    text = path.read_text(encoding="utf-8", errors="replace")
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    return re.sub(r"//[^\n]*", " ", text)


def chosen(text, defines):
    """The lines outside of conditions that do not hold."""
    out, stack = [], []
    for line in text.split("\n"):
        condition = re.match(r"\s*#\s*if\s+(\w+)\s*==\s*(\d+)", line)
        if condition:
            stack.append(defines.get(condition[1], 0) == int(condition[2]))
        elif re.match(r"\s*#\s*endif", line):
            stack and stack.pop()
        elif not re.match(r"\s*#", line) and all(stack):
            out.append(line)
    return "\n".join(out)


def structs(text):
    found = {}
    for start in re.finditer(r"\b(?:digital_system|implementation)\s+(\w+)\s*=\s*\{", text):
        depth, at = 1, start.end()
        while depth and at < len(text):
            depth += (text[at] == "{") - (text[at] == "}")
            at += 1
        fields = re.finditer(r"\.(\w+)\s*=\s*(\{[^}]*\}|[^,}]+)", text[start.end() : at - 1])
        # What is given twice no compiler takes.
        found[start[1]] = None if start[1] in found else {f[1]: [n.strip().rstrip("fF") for n in f[2].strip(" {}\r\n\t").split(",") if n.strip()] for f in fields}
    return found


def sized(system, name):
    size = int(system[name + "_size"][0])
    return (system[name] + ["0"] * size)[:size]


def expectation(path):
    """What test.desc expects of closed-loop stability, and whether in floating point."""
    desc = path.parent / "test.desc"
    if path.name != "input.c" or not desc.exists():
        return None, False
    text = desc.read_text()
    if "STABILITY_CLOSED_LOOP" not in text:
        return None, False
    return ("successful" if "SUCCESSFUL" in text else "failed"), "FLOATBV" in text


def loops_of(path):
    text = text_of(path)
    values = collections.defaultdict(set)
    for name, value in re.findall(r"#\s*if\s+(\w+)\s*==\s*(\d+)", text):
        values[name].add(int(value))
    seen = set()
    for combination in itertools.product(*([(n, v) for v in sorted(vs)] for n, vs in sorted(values.items()))):
        found = structs(chosen(text, dict(combination)))
        controller, plant = found.get("controller") or found.get("control"), found.get("plant")
        if not controller or not plant or not found.get("impl"):
            continue
        lists = tuple(tuple(sized(s, n)) for s in (controller, plant) for n in "ba")
        percent = tuple(tuple((plant.get(n + "_uncertainty", []) + ["0"] * 50)[: len(sized(plant, n))]) for n in "ba")
        bits = [int(found["impl"][name][0]) for name in ("int_bits", "frac_bits")]
        if (lists, percent, *bits) in seen:
            continue
        seen.add((lists, percent, *bits))
        uncertain = any(Fraction(p) > 0 for ps in percent for p in ps)
        yield Loop(path, combination, *bits, lists, tuple(map(len, lists)), uncertain, *expectation(path))


def product(a, b):
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def characteristic(lists, reading):
    """a_c a_p + b_c b_p with the highest power of z first; None where it would need values that are still to come."""
    bc, ac, bp, ap = lists
    degree = lambda p: len(p) - next((k for k, c in enumerate(p) if c), len(p))
    if reading == "z":
        if any(not any(a) or degree(b) > degree(a) for b, a in ((bc, ac), (bp, ap))):
            return None
        top, bottom = product(bc, bp), product(ac, ap)
        length = max(len(top), len(bottom))
        return [x + y for x, y in zip([0] * (length - len(top)) + top, [0] * (length - len(bottom)) + bottom)]
    if not ac[0] or not ap[0]:
        return None
    top, bottom = product(bc, bp), product(ac, ap)
    length = max(len(top), len(bottom))
    return [x + y for x, y in zip(top + [0] * (length - len(top)), bottom + [0] * (length - len(bottom)))]


def is_stable(p):
    """Whether all roots lie inside the unit circle, by the recursion of Schur and Cohn."""
    while p and not p[0]:
        p = p[1:]
    while len(p) > 1:
        if abs(p[-1]) >= abs(p[0]):
            return False
        ratio = p[-1] / p[0]
        p = [p[i] - ratio * p[-1 - i] for i in range(len(p) - 1)]
    return bool(p)


def stored(lists, fraction):
    unit = 2**fraction
    return [[Fraction(math.floor(n * unit), unit) for n in row] for row in lists[:2]] + list(lists[2:])


def verdicts(loop):
    """For each reading, the verdicts as printed and as stored with the greatest moduli; None where there is no loop."""
    printed = [[Fraction(n) for n in row] for row in loop.lists]
    leading = next((k for k, c in enumerate(printed[1]) if c), None)
    limit = Fraction(2) ** (loop.integer - 1)
    fits = all(-limit <= n <= limit - Fraction(1, 2**loop.fraction) for row in printed[:2] for n in row)
    out = {}
    for reading in READINGS:
        for how, lists in (("printed", printed), ("stored", stored(printed, loop.fraction))):
            divides = leading is not None and lists[1][leading] != 0
            p = characteristic(lists, reading) if divides and (fits or how == "printed") else None
            modulus = max(abs(np.roots([float(c) for c in p])), default=0) if p else None
            out[reading, how] = (is_stable(p), float(modulus)) if p else None
    return out, fits


def asked(program, loop):
    """What the program answers to the same four questions."""
    out = {}
    for reading in READINGS:
        for how in ("printed", "stored"):
            defines = [part for name, value in loop.defines for part in ("-D", f"{name}={value}")]
            command = [program, "import", loop.path, "--reading", reading, "-q", *defines, *(["--stored"] if how == "stored" else [])]
            model = subprocess.run(command, capture_output=True, text=True)
            if model.returncode:
                out[reading, how] = None
                continue
            run = subprocess.run([program, "verdict", "-", "--json", "-q"], input=model.stdout, capture_output=True, text=True)
            out[reading, how] = json.loads(run.stdout)["verdict"] == "stable" if run.stdout else run.stderr
    return out


def table(loops, root, file):
    """One line for each different loop: where it was seen first, bits, the four lists, what is expected."""
    seen, lines = {}, []
    for loop in loops:
        key = (loop.integer, loop.fraction, loop.lists, loop.expected, loop.float)
        if key in seen:
            continue
        seen[key] = True
        name = str(loop.path.relative_to(root)).removesuffix("/input.c").removesuffix(".c")
        name += "".join(f" {n}={v}" for n, v in loop.defines)
        expected = f"{loop.expected or '-'}{' float' if loop.float else ''}"
        lines.append(" | ".join([name, f"{loop.integer} {loop.fraction}", *map(" ".join, loop.lists), expected]))
    head = "# Closed loops of DSVerifier, https://github.com/ssvlab/dsverifier at commit 1daca47, as numbers; written by tests/outside/dsverifier.py.\n"
    head += "# where | bits before and behind the point | controller b | a | plant b | a | closed-loop stability that test.desc expects\n"
    Path(file).write_text(head + "\n".join(lines) + "\n")
    print(f"{len(lines)} lines in {file}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("checkout")
    parser.add_argument("program", nargs="?")
    parser.add_argument("--table")
    options = parser.parse_args()
    root = Path(options.checkout)
    files = [p for part in ("regression", "benchmarks") for p in sorted((root / part).rglob("*.c"))]
    loops, unread = [], []
    for path in files:
        try:
            loops += loops_of(path)
        except (ValueError, KeyError, IndexError) as error:
            unread.append((path, error))
    counts, false, differing, wrong = collections.Counter(), [], [], 0
    answers = {}
    for loop in loops:
        found, fits = verdicts(loop)
        counts["loops"] += 1
        counts["leading coefficient of the controller's denominator not 1"] += Fraction(loop.lists[1][0]) != 1
        counts["with an uncertain plant"] += loop.percent
        values = {k: v and v[0] for k, v in found.items()}
        if any(None not in (values["z", how], values["z^-1", how]) and values["z", how] != values["z^-1", how] for how in ("printed", "stored")):
            differing.append(loop)
        if loop.expected:
            counts["with an expectation"] += 1
            holds = fits and values["z", "stored"] is True
            if loop.expected == "failed" and not fits:
                counts["expected to fail, and a coefficient does not fit"] += 1
            elif not loop.float and holds != (loop.expected == "successful"):
                false.append((loop, found, fits))
        if options.program:
            key = (loop.integer, loop.fraction, loop.lists, loop.path.suffix)
            if key not in answers:
                answers[key] = asked(options.program, loop)
                for question, answer in answers[key].items():
                    counts["verdicts compared"] += 1
                    if answer != values[question]:
                        wrong += 1
                        print("DIFFERS", loop.path.relative_to(root), question, "jurist:", answer, "fractions:", values[question])
    print(f"{'expectation that is false':62} {'format':8} printed  modulus     stored  modulus")
    for loop, found, fits in false:
        show = lambda v: f"{'stable' if v[0] else 'not':7} {v[1]:.6f}" if v else "none            "
        name = str(loop.path.relative_to(root).parent)
        print(f"{name:62} <{loop.integer},{loop.fraction}>  {show(found['z', 'printed'])} {show(found['z', 'stored'])} {'' if fits else 'out of range'}")
    print(f"{len(files)} files, {len(unread)} not read by this script, {len(false)} false expectations, {len(differing)} loops whose readings differ")
    for what, count in counts.items():
        print(f"  {count} {what}")
    for path, error in unread[:20]:
        print("  not read:", path.relative_to(root), repr(error))
    if options.table:
        table(loops, root, options.table)
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
