#!/usr/bin/env python3
"""Asks random loops over each coefficient ring every question of the table, and counts what becomes of them.

    benches/coverage/campaign.py PROGRAM [-n LOOPS] [--seconds S] [--work UNITS] [--minutes M] [--question TEXT] [--ring RING] [--seed SEED] [--keep FOLDER] [-j JOBS]

The cells are those of docs/explanation/coverage.md, which is made of the table. A cell counts as answered where at most one loop in a hundred stays
undecided, and none is wrong against numbers that are found another way (plants.py, truth.py). On a machine that has other work to do a time says little: '--work' counts. Needs numpy and scipy.
"""

import argparse
import json
import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from multiprocessing import Pool
from pathlib import Path

from ask import Judge, Wrong, arguments
from plants import GENERATORS

ROOT = Path(__file__).resolve().parents[2]
WRITES = ("--certificate", "--smt2", "--coq", "report", "simulate", "locus", "--root-locus-form", "--transfer")


def table():
    """The rows: command, kind of time or None, and what the page says of each ring."""
    page = (ROOT / "docs/explanation/coverage.md").read_text()
    lines = page.split("## Questions")[1].split("## Complex")[0].splitlines()
    rings = [cell.strip() for cell in next(line for line in lines if line.startswith("| question")).strip("|").split("|")[1:]]
    rows = []
    for line in lines:
        match = re.match(r"\| `([^`]*)`(?:, (\w+) time)? \|(.*)\|", line)
        if match:
            cells = [cell.strip() for cell in match[3].split("|")]
            rows.append((match[1], match[2], dict(zip(rings, cells))))
    return rows


def is_refused(cell):
    return re.fullmatch("[A-Z]", cell) is not None


def loop_of(ring, kind, seed):
    """A random loop of this kind of time, most often one that is stable."""
    import truth

    r = random.Random(seed)
    kinds = GENERATORS.get(ring, [])
    for attempt in range(200):
        loop = kinds[(r.randrange(1 << 30)) % len(kinds)](r) if kinds else None
        if loop is None or (kind and loop.time != kind):
            continue
        wants = attempt > 20 or r.random() < 0.1
        if wants or truth.stable(loop, {k: float(v) for k, v in loop.point.items()}):
            return loop, r
    return None, r


def run(job):
    """One question about one loop: the cell, what became of it, and a remark."""
    program, (command, kind, ring), seed, (seconds, work, memory) = job
    try:
        loop, r = loop_of(ring, kind, seed)
        if loop is None:
            return (command, kind, ring), "no generator", "", "", ""
        with tempfile.TemporaryDirectory() as folder:
            words, required, region = arguments(command, loop, r, f"{folder}/out.html")
            if command == "report":
                words += ["-o", f"{folder}/out.html"]
            else:
                words.append("--json")
            line = [program, *words, "--timeout", str(seconds), "--memory", str(memory), "-q"]
            line += ["--work", str(work)] if work else []
            done = subprocess.run(line, input=loop.text, capture_output=True, text=True, timeout=seconds + 20)
        outcome, remark = judge(command, loop, r, required, region, done)
    except subprocess.TimeoutExpired:
        outcome, remark = "late", "it did not end by itself"
    except Exception as problem:  # a fault of the campaign, shown as such
        outcome, remark = "fault", f"{type(problem).__name__}: {problem}"
    shown = " ".join(words) if loop else ""
    return (command, kind, ring), outcome, f"{loop.kind}: {remark}", shown, loop.text


def judge(command, loop, r, required, region, done):
    errors = done.stderr.strip().splitlines()
    first = next((line for line in errors if line.strip()), "")
    if done.returncode == 3:
        return "undecided", first
    if done.returncode == 2:
        return "refused", first
    if done.returncode not in (0, 1):
        return "wrong", f"status {done.returncode}: {first}"
    if command == "report" or any(word in command for word in WRITES):
        return "answered", "no truth"
    document = json.loads(done.stdout)
    about = Judge(loop, r, required, region)
    try:
        found = getattr(about, command.split(" ")[0])(document, command)
    except Wrong as wrong:
        return "wrong", str(wrong)
    return ("undecided", "a part") if found == "undecided" else ("answered", found or "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("-n", type=int, default=3, help="loops for each cell; 300 for a full campaign")
    parser.add_argument("--seconds", type=int, default=5, help="time of a question")
    parser.add_argument("--work", type=int, help="units of work of a question, beside its time")
    parser.add_argument("--minutes", type=float, help="begins no more questions after this time")
    parser.add_argument("--memory", type=int, default=800)
    parser.add_argument("--question", help="only rows whose command contains this text")
    parser.add_argument("--ring", help="only this ring")
    parser.add_argument("--refused", action="store_true", help="also cells that the table says are refused")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="the folder to which the campaign writes the models of questions without an answer")
    parser.add_argument("-j", type=int, default=2)
    options = parser.parse_args()
    cells = [(command, kind, ring) for command, kind, row in table() for ring in row
             if (options.refused or not is_refused(row[ring]))
             and (options.question is None or options.question in command)
             and (options.ring is None or options.ring == ring)]
    limits = (options.seconds, options.work, options.memory)
    end = time.monotonic() + 60 * options.minutes if options.minutes else None
    # One loop of each cell after the other: what is counted when time is over is about all cells.
    jobs = [(options.program, cell, f"{options.seed}/{cell}/{k}", limits) for k in range(options.n) for cell in cells]
    counts, remarks = defaultdict(Counter), defaultdict(list)
    with Pool(options.j) as pool:
        for k, (cell, outcome, remark, words, text) in enumerate(pool.imap(run, jobs, chunksize=1)):
            if end and time.monotonic() > end:
                pool.terminate()
                break
            counts[cell][outcome] += 1
            if outcome != "answered":
                remarks[cell].append((outcome, remark, words))
                if options.keep:
                    options.keep.mkdir(parents=True, exist_ok=True)
                    (options.keep / f"{outcome}-{k}.toml").write_text(f"# {words}\n# {remark}\n{text}")
            elif remark.endswith("no truth"):
                counts[cell]["without a truth"] += 1
            if outcome in ("wrong", "fault", "late"):
                print(f"{outcome} [{k}] {cell[2]}: {words}: {remark}", file=sys.stderr, flush=True)
    print("| question | ring | answered | undecided | refused | wrong | without a truth |\n|---|---|---|---|---|---|---|")
    for cell in cells:
        c = counts[cell]
        if c["no generator"]:
            print(f"| {cell[0]}{', ' + cell[1] if cell[1] else ''} | {cell[2]} | no generator | | | | |")
            continue
        bad = c["wrong"] + c["late"] + c["fault"]
        print(f"| {cell[0]}{', ' + cell[1] if cell[1] else ''} | {cell[2]} | {c['answered']} | {c['undecided']} | {c['refused']} | {bad} | {c['without a truth']} |")
    for cell in cells:
        for (outcome, remark), count in Counter((o, re.sub(r"-?\d+(\.\d+)?(e[-+]?\d+)?", "#", m)) for o, m, _ in remarks[cell]).most_common(4):
            if outcome != "no generator":
                print(f"{cell[0]} | {cell[2]} | {outcome} x{count}: {remark}")
    total = sum(counts.values(), Counter())
    print(dict(total))
    return 1 if total["wrong"] or total["late"] or total["fault"] else 0


if __name__ == "__main__":
    sys.exit(main())
