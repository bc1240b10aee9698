#!/usr/bin/env python3
"""Hostile runs of the program: whether every command keeps its time and its memory.

    benches/hostile.py [PROGRAM] [--runs 2000] [--seed 1] [--jobs 2] [--times 0.05,0.1,0.3,0.6] [--models FOLDER ...]

Commands, models (the examples, the corpus, and some that are made to be large) and short times are drawn at random; half of
the models are mutated: numbers become extreme, lines are doubled, left out or exchanged. Reported are the greatest overrun of
`--timeout` and the greatest memory, each with its command, and how often each exit status came. A panic, a death by a signal
and an unknown status are failures.

Two overruns are measured. Wall time says what a person waits, and means something on a quiet machine only. Late work is the
processor time used after the time was up: a busy machine does not change it much. Needs Linux, and Python 3.11 alone.
"""

import argparse
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
TICK = os.sysconf("SC_CLK_TCK")
ADDRESS_SPACE = 6 << 30
PATIENCE = 60  # seconds after which a run is ended as one that does not keep its time
EXTREME = ("0", "-1", "1e-9", "1e9", "3e9999", "1/3", "7" * 300, "1e-300", "sqrt(2)", "exp(1)", "200", "4000")


def large():
    """Models that are made to be large."""
    head = "time = 'discrete'\n[parameters]\nK = { nominal = 1 }\nL = 1\n"
    dense = " + ".join(f"{(i * j * 7919) % 1000 + 1}*K^{j}*z^{i}" for i in range(60) for j in range(12))
    block = "[[block]]\ninput = '{}'\noutput = '{}'\n{}\n"
    yield "dense", f"{head}[loop]\ncharacteristic = '{dense}'\n"
    yield "order", f"{head}[loop]\ncharacteristic = 'z^900 - K*z^450 + L/3'\n"
    yield "power", f"{head}[loop]\ncharacteristic = '(z + K + L + 1/7)^60 - K'\n"
    yield "digits", f"{head}[loop]\ncharacteristic = 'z - {'3' * 200_000}*K'\n"
    yield "unused", f"{head}[constants]\n" + "".join(f"c{i} = {i}\n" for i in range(40_000)) + "[loop]\ncharacteristic = 'z - K'\n"
    yield "unknown", f"{head}[constants]\n" + "".join(f"c{i} = 'd{i} + 1'\n" for i in range(20_000)) + "[loop]\ncharacteristic = 'z - K'\n"
    yield "chain", f"{head}[constants]\nc0 = 'K'\n" + "".join(f"c{i} = 'c{i - 1}^2 + L'\n" for i in range(1, 40)) + "[loop]\ncharacteristic = 'z - c39'\n"
    delays = block.format("-K*y", "w", "delay = 2000") + block.format("w", "y", "delay = 2000")
    yield "delays", f"{head}[loop]\n{delays}"
    rows = [[f"'K*{i * j % 7} + L/{i + j + 1}'" for j in range(24)] for i in range(24)]
    yield "matrix", f"{head}[loop]\nmatrix = [" + ", ".join("[" + ", ".join(row) + "]" for row in rows) + "]\n"
    lag = "transfer = '1/((s + 1)*(s^2 + 0.4*s + 4)*(s^2 + 0.66*s + 11)*(s^2 + s + 26))'\ndiscretize = 'zoh'"
    held = block.format("r - y", "u", "gain = 'K'") + block.format("u", "y", lag)
    yield "modes", head.replace("[par", "sample_time = 0.1\n[par") + f"[loop]\ninputs = ['r']\noutputs = ['y']\n{held}"
    yield "roots", f"{head}[constants]\n" + "".join(f"r{i} = 'sqrt(K + {i})'\n" for i in range(12)) + "[loop]\ncharacteristic = 'z^3 + " + " + ".join(f"r{i}*z" for i in range(12)) + " + exp(K)*sin(L)'\n"
    continuous = head.replace("discrete", "continuous")
    delayed = " + ".join(f"K*exp(-{k}*s)/(s^2 + {k}*s + L)" for k in range(1, 9))
    yield "dead-time", f"{continuous}[loop]\ninputs = ['r']\noutputs = ['y']\n" + block.format("r - y", "y", f"transfer = '{delayed}'")


def mutated(text, draw):
    lines = text.splitlines()
    for _ in range(draw.choice((1, 1, 1, 3))):
        at = draw.randrange(len(lines))
        match draw.randrange(10):
            case 0:
                lines.insert(at, lines[at])
            case 1 if len(lines) > 3:
                del lines[at]
            case 2:
                other = draw.randrange(len(lines))
                lines[at], lines[other] = lines[other], lines[at]
            case _:
                numbers = list(re.finditer(r"(?<![\w.])\d[\d.]*(?:e[+-]?\d+)?", lines[at]))
                if numbers:
                    found = draw.choice(numbers)
                    lines[at] = lines[at][: found.start()] + draw.choice(EXTREME) + lines[at][found.end() :]
    return "\n".join(lines) + "\n"


def names(text):
    """The parameters of a model, as far as a glance tells."""
    section = re.search(r"^\[parameters\]$(.*?)(?=^\[|\Z)", text, re.M | re.S)
    found = re.findall(r"^\s*(\w+)\s*=", section[1], re.M) if section else []
    return found + re.findall(r"^parameters\.(\w+)", text, re.M) or ["K"]


def command(draw, text, folder, number):
    known = names(text)
    one = draw.choice(known)
    two = draw.choice([name for name in known if name != one] or [one])
    out = lambda ending: str(folder / f"{number}.{ending}")
    choices = [
        ["analyze"],
        ["intervals", "--param", one],
        ["intervals", "--param", one, "--certificate", out("json")],
        ["intervals", "--param", one, "--phase-margin", "30 deg"],
        ["intervals", "--param", one, "--digits", "70000"],
        ["intervals", "--param", one, "--domain", f"{one}=0..1e6", "--sensitivity"],
        ["verdict", "--set", f"{one}=1/3"],
        ["verdict", "--radius", "9/10"],
        ["charpoly"],
        ["charpoly", "--keep", one, "--format", "latex"],
        ["jury", "--param", one],
        ["map", "-x", one, "-y", two, "-o", out("svg")],
        ["map", "-x", one, "-y", two, "--json"],
        ["locus", "--param", one, "-o", out("svg")],
        ["margins"],
        ["bode", "-o", out("svg")],
        ["nyquist", "--json"],
        ["simulate", "-o", out("csv")],
        ["sweep", "--param", one, "--over", f"{two}=1..2:40", "-o", out("jsonl")],
        ["tolerance", "--all", "10%"],
        ["tolerance", "--tol", f"{one}=20%", "--limit", two],
        ["tolerance", "--all", "5%", "--volume", "--json"],
        ["report", "-o", out("html")],
        ["check", "--json"],
    ]
    return draw.choice(choices)


def processor_time(pid):
    """Seconds of processor time that a process has used; `None` where it is gone."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) / TICK


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Run:
    """What a run took."""

    def __init__(self, words, seconds, error):
        self.words, self.error = words, error
        begun = time.monotonic()
        with open(error, "wb") as stderr:
            child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=stderr, preexec_fn=limited)
        at_end = []
        timer = threading.Timer(seconds, lambda: at_end.append(processor_time(child.pid)))
        killer = threading.Timer(PATIENCE, lambda: os.kill(child.pid, signal.SIGKILL))
        timer.start(), killer.start()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        timer.cancel(), killer.cancel()
        self.status, self.memory = child.returncode, usage.ru_maxrss / 1024
        self.wall = time.monotonic() - begun - seconds
        used = usage.ru_utime + usage.ru_stime
        self.late = used - at_end[0] if at_end and at_end[0] is not None else 0.0
        self.said = error.read_text(errors="replace")

    def failure(self):
        if self.status not in range(5):
            return f"status {self.status}"
        return "a panic" if "E-internal" in self.said or "panicked" in self.said else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="?", default=str(HERE / "target/release/jurist"))
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--times", default="0.05,0.1,0.3,0.6", help="timeouts in seconds; each run gets one of them")
    parser.add_argument("--models", nargs="*", type=Path, help="folders of models, in place of all others")
    options = parser.parse_args()
    times = [float(time) for time in options.times.split(",")]
    models = [(path.stem, path.read_text()) for path in sorted((HERE / "examples").glob("*.toml"))]
    cases = [(path.stem, tomllib.loads(path.read_text())) for path in sorted((HERE / "tests/corpus").glob("*.toml"))]
    models += [(name, case["model"]) for name, case in cases if "model" in case]
    models += list(large()) * (len(models) // 24)
    if options.models:
        models = [(path.stem, path.read_text()) for folder in options.models for path in sorted(folder.glob("*.toml"))]
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(options.jobs) as pool:
        folder = Path(folder)

        def one(number, seed):
            draw = random.Random(seed)
            name, text = draw.choice(models)
            if draw.random() < 0.5:
                name, text = name + " (mutated)", mutated(text, draw)
            model = folder / f"{number}.toml"
            model.write_text(text)
            seconds = draw.choice(times)
            first, *rest = command(draw, text, folder, number)
            words = [options.program, first, str(model), *rest, "--timeout", str(seconds), "--threads", str(draw.choice((1, 2)))]
            run = Run(words, seconds, folder / f"{number}.err")
            run.shown = f"{first} {name} {' '.join(rest)} --timeout {seconds}"
            if run.failure() is None and run.late < 1 and run.memory < 1000:
                for path in folder.glob(f"{number}.*"):
                    path.unlink()
            return run

        runs = list(pool.map(one, range(options.runs), [draw.random() for _ in range(options.runs)]))
        left = [path.name for path in folder.iterdir() if path.name.startswith(".jurist")]
    report(runs, left)
    failures = [run for run in runs if run.failure()]
    for run in failures:
        print(f"FAILED ({run.failure()}): {run.shown}\n    {run.said.strip()[-300:]}")
    sys.exit(bool(failures or left))


def report(runs, left):
    statuses = {status: sum(run.status == status for run in runs) for status in sorted({run.status for run in runs})}
    outside = [run for run in runs if "did not end by itself" in run.said]
    stopped = sum("the budget ran out: time" in run.said for run in runs)
    full = sum("the budget ran out: memory" in run.said for run in runs)
    print(f"{len(runs)} runs; exit statuses {statuses}; {stopped} ended by time, {full} by memory, {len(outside)} of both from outside")
    for what, key, unit in [("overrun, wall", "wall", "s"), ("late work", "late", "s"), ("memory", "memory", "MB")]:
        print(f"greatest {what}:")
        for run in sorted(runs, key=lambda run: -getattr(run, key))[:8]:
            print(f"  {getattr(run, key):8.2f} {unit}  {run.shown[:150]}")
    print("ended from outside:")
    for run in sorted(outside, key=lambda run: run.shown)[:40]:
        print(f"  {run.shown[:120]}: {run.said.strip().rpartition('reached: ')[2][:80]}")
    if left:
        print(f"FAILED: left behind: {left}")


if __name__ == "__main__":
    main()
