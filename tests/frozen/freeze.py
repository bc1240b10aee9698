#!/usr/bin/env python3
"""Every command on every example, template and corpus model, frozen as hashes beside the work that was counted.

    tests/frozen/freeze.py [--program target/release/jurist]        compares with outputs.txt, exit status 1 where they differ
    tests/frozen/freeze.py --keep DIR                                also writes each run's output to DIR, to compare two programs
    tests/frozen/freeze.py --accept PATTERN [PATTERN ...]            replaces the lines whose command holds a PATTERN (a regular expression)
    tests/frozen/freeze.py --only PATTERN                            runs those only

A line of outputs.txt is the run's hash, its exit status, the units of counted work, and the command. The hash is that of standard
output, standard error and every file written. No clock ends a run: all have the same budget of counted work, and one thread.
A change of hashes is a change for users: the commit that makes it says which and why. Python 3.11, nothing else.
"""

import argparse
import concurrent.futures
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
RECORD = HERE / "outputs.txt"
# About a second: what takes longer is frozen as undecided.
WORK = 100_000_000
STEP = re.compile(rb"^(note: )?\s*\d+\.\d{3} s  .*\n", re.MULTILINE)
UNITS = re.compile(rb"^(note: )?(\d+) units of work\n", re.MULTILINE)


def parameters(text):
    """The names of the free parameters of a model's text; none where it is no TOML."""
    try:
        return list(tomllib.loads(text).get("parameters", {}))
    except tomllib.TOMLDecodeError:
        return []


def questions(name, text, whole):
    """The command lines asked of one model, `MODEL` for its file and `OUT.` for files written."""
    free = parameters(text)
    # Free parameters beyond the first two ask nothing new.
    one = [["--param", parameter] for parameter in free[: 2 if whole else 1]]
    yield from (["check"], ["verdict"], ["verdict", "--json", "--certificate", "OUT.json"], ["charpoly"], ["charpoly", "--json"])
    yield from (["jury"], ["analyze"], ["margins"], ["margins", "--json"], ["roots"], ["test", "--json"])
    for p in one:
        yield ["intervals", *p]
        yield ["intervals", *p, "--json", "--certificate", "OUT.json"]
    if not whole:
        return
    yield from (["check", "--json"], ["check", "--sarif"], ["jury", "--json"], ["analyze", "--json"])
    for ending in ("csv", "tex", "m", "py", "rs"):
        yield ["charpoly", "-o", f"OUT.{ending}"]
    for p in one[:1]:
        yield ["jury", *p]
        yield ["intervals", *p, "--smt2", "OUT.smt2"]
        yield ["intervals", *p, "--coq", "OUT.v"]
        yield ["intervals", *p, "--digits", "60"]
        yield from (["locus", *p, "-o", "OUT.csv"], ["locus", *p, "-o", "OUT.svg"], ["locus", *p, "--json"])
    for command in ("bode", "nyquist", "simulate"):
        yield from ([command, "-o", "OUT.svg"], [command, "-o", "OUT.csv"], [command, "--json"])
    if len(free) > 1:
        axes = ["-x", free[0], "-y", free[1]]
        yield ["map", *axes]
        yield ["map", *axes, "--json", "--certificate", "OUT.json"]
        yield ["map", *axes, "-o", "OUT.svg"]
        yield ["map", "-x", free[1], "-y", free[0]]
    blocks = tomllib.loads(text).get("block", [])
    if blocks and "name" in blocks[0]:
        yield ["ship", "--block", blocks[0]["name"], "--format", "Q15.16", "--signal", "Q15.16", "--fewest"]
        yield ["ship", "--block", blocks[0]["name"], "--format", "float32", "--realisation", "df2t", "--json", "--c", "OUT.h"]
    tolerances = ["--tol", ",".join(free[:3]) + "=10%"] if free else []
    yield ["tolerance", *tolerances]
    yield ["tolerance", *tolerances, "--json", "--certificate", "OUT.json"]
    yield ["report", "-o", "OUT.html"]


def runs(program, folder):
    """All runs: a label and a command line."""
    models = []
    for path in sorted((ROOT / "examples").glob("*.toml")):
        models.append((f"examples/{path.stem}", path.read_text(), True))
    for path in sorted((ROOT / "src/cli/templates").glob("*.toml")):
        text = subprocess.run([program, "new", path.stem], capture_output=True, text=True, check=True).stdout
        models.append((f"templates/{path.stem}", text, True))
    for path in sorted((ROOT / "tests/corpus").glob("*.toml")):
        case = tomllib.loads(path.read_text())
        if "model" in case:
            models.append((f"corpus/{path.stem}", case["model"], False))
    yield from (("", [command]) for command in ("paper", "new", "explain"))
    yield "", []
    yield "", ["new", "--list"]
    yield "", ["paper", "-o", "OUT"]
    for shell in ("bash", "zsh", "fish"):
        yield "", ["completions", shell]
    for name, text, whole in models:
        file = folder / (name.replace("/", "-") + ".toml")
        file.write_text(text)
        for arguments in questions(name, text, whole):
            yield name, [arguments[0], str(file), *arguments[1:]]


def files(folder):
    """What a run has written: paths and bytes."""
    return sorted((str(p.relative_to(folder)), p.read_bytes()) for p in folder.rglob("*") if p.is_file())


def ask(program, models, name, arguments, keep):
    """Runs one command; its line for the record."""
    with tempfile.TemporaryDirectory() as out:
        line = [a.replace("OUT", f"{out}/out") if a.startswith("OUT") else a for a in arguments]
        takes_work = arguments[:1] not in (["new"], ["explain"], ["completions"])
        budget = ["--work", str(WORK), "--threads", "1", "--verbose"] if takes_work else []
        if arguments[:1] == ["check"]:
            budget = []
        # The program's clock decides nothing here; the last resort ends a run that does not count its work.
        try:
            done = subprocess.run([program, *line, *budget], capture_output=True, stdin=subprocess.DEVNULL, timeout=120, cwd=out)
            status, stdout, stderr = done.returncode, done.stdout, done.stderr
        except subprocess.TimeoutExpired:
            status, stdout, stderr = "endless", b"", b""
        units = UNITS.search(stderr)
        stderr = UNITS.sub(b"", STEP.sub(b"", stderr))
        parts = [("stdout", stdout), ("stderr", stderr), *files(pathlib.Path(out))]
        shown = " ".join(arguments).replace(str(models) + "/", "")
        digest = hashlib.sha256()
        for part, content in parts:
            content = content.replace(out.encode(), b"OUT").replace(str(models).encode() + b"/", b"")
            digest.update(f"{part} {len(content)}\n".encode() + content)
            if keep is not None:
                place = keep / re.sub(r"[^\w.=-]+", "_", shown or "main")
                place.mkdir(parents=True, exist_ok=True)
                (place / part.replace("/", "_")).write_bytes(content)
        return f"{digest.hexdigest()[:16]} {status} {units[2].decode() if units else '-'} {shown}"


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--program", default=str(ROOT / "target/release/jurist"))
    options.add_argument("--accept", nargs="+", default=[])
    options.add_argument("--only", default="")
    options.add_argument("--keep", type=pathlib.Path)
    options.add_argument("--jobs", type=int, default=2)
    asked = options.parse_args()
    program = str(pathlib.Path(asked.program).resolve())
    recorded = {}
    if RECORD.exists():
        for line in RECORD.read_text().splitlines():
            recorded[line.split(" ", 3)[3]] = line
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        models = pathlib.Path(folder)
        lists = [r for r in runs(program, models) if re.search(asked.only, " ".join(r[1]))]
        lines = list(pool.map(lambda run: ask(program, models, run[0], run[1], asked.keep), lists))
    found = {line.split(" ", 3)[3]: line for line in lines}
    changed = work = 0
    for shown, line in found.items():
        before = recorded.get(shown)
        if before == line:
            continue
        same = before is not None and before.split(" ")[:2] == line.split(" ")[:2]
        work += same
        changed += not same
        print(("work    " if same else "changed ") + f"{before or 'new'} -> {line}")
        if any(re.search(pattern, shown) for pattern in asked.accept):
            recorded[shown] = line
    gone = [] if asked.only else [shown for shown in recorded if shown not in found]
    for shown in gone:
        print(f"gone    {shown}")
        if any(re.search(pattern, shown) for pattern in asked.accept):
            del recorded[shown]
    if asked.accept:
        RECORD.write_text("".join(recorded[shown] + "\n" for shown in sorted(recorded)))
    print(f"{len(found)} runs: {changed} changed, {work} with other work, {len(gone)} gone")
    sys.exit(1 if (changed or gone) and not asked.accept else 0)


if __name__ == "__main__":
    main()
