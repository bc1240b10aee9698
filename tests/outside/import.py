#!/usr/bin/env python3
"""Systems written by SciPy and NumPy: what jurist imports against models that this script writes itself; then damaged files.

    python3 -m venv v && v/bin/pip install numpy scipy
    v/bin/python tests/outside/import.py target/release/jurist [SYSTEMS [DAMAGED]]

Each of the random systems (200) goes into every format: .mat with and without compression and as a struct, .npz stored and
deflated, .json, .csv. Order 1 to 6, one to three inputs and outputs, continuous and discrete, in double and single precision,
with integers, in both orders of bytes and of entries. The script's own model has the same numbers by Python's repr, which is
the shortest decimal too, and the loop in another form: unity feedback written into the plant's inputs. The answers of
'intervals' (to 40 digits) and 'verdict' have to be equal as documents. Then files of all formats are changed (2000): bytes
turned, cut out, doubled, and ends cut off. The exit status has to be 0 or 2, within 20 s and 400 MB.
"""

import collections
import json
import os
import random
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import scipy.io

DIGITS = "40"
MEMORY = 400_000_000


def shortest(x):
    return str(int(x)) if np.issubdtype(type(x), np.integer) else np.format_float_scientific(x, unique=True, trim="-")


def matrix(m):
    return "[" + ", ".join("[" + ", ".join(shortest(x) for x in row) + "]" for row in m) + "]"


def own_model(s, closed):
    time = f"time = 'discrete'\nsample_time = {shortest(s['Ts'][0, 0])}\n" if "Ts" in s else "time = 'continuous'\n"
    p, m = s["C"].shape[0], s["B"].shape[1]
    outputs = [f"y_{i + 1}" for i in range(p)]
    inputs = [f"r_{i + 1}" for i in range(m)]
    enter = [f"K*{r} - K*{y}" for r, y in zip(inputs, outputs)] if closed else inputs
    parameter = "[parameters]\nK = 1\n" if closed else ""
    return (
        f"{time}{parameter}[loop]\ninputs = {inputs}\noutputs = {outputs}\n[[block]]\ninput = {enter}\noutput = {outputs}\n"
        + "".join(f"{key} = {matrix(s[key])}\n" for key in "ABCD" if key in s)
    )


def entries(rng, rows, columns):
    kind = rng.random()
    size = (rows, columns)
    if kind < 0.2:
        return np.array([[rng.randint(-4, 4) for _ in range(columns)] for _ in range(rows)], dtype=rng.choice([np.int8, np.int32, np.int64, float]))
    values = np.array([[rng.gauss(0, 1) * 10 ** rng.uniform(-2, 1) for _ in range(columns)] for _ in range(rows)]).reshape(size)
    if kind < 0.4:
        values = np.round(values, 2)
    if kind > 0.85:
        values = values.astype(np.float32)
    return values


def system(rng):
    n = rng.randint(1, 6)
    m = rng.choice([1, 1, 2, 3])
    p = m if rng.random() < 0.8 else rng.randint(1, 3)
    a = entries(rng, n, n)
    if rng.random() < 0.7 and a.dtype == float:
        # Most loops are stable for some gains.
        a = np.round(a / max(abs(np.linalg.eigvals(a)).max(), 0.1) * 0.8, 6)
    s = {"A": a, "B": entries(rng, n, m), "C": entries(rng, p, n)}
    if rng.random() < 0.5:
        s["D"] = entries(rng, p, m)
    if rng.random() < 0.5:
        s["Ts"] = np.array([[rng.choice([0.1, 1e-3, 0.02, 1e-4, 0.3333])]])
    elif s["A"].dtype == float:
        s["A"] = np.round(s["A"] - np.eye(n), 6)
    return s


def files(s, folder, rng):
    """The system in every format that keeps its numbers."""
    turned = {k: np.asfortranarray(v) if rng.random() < 0.3 else v for k, v in s.items()}
    turned = {k: v.astype(v.dtype.newbyteorder(">")) if rng.random() < 0.3 else v for k, v in turned.items()}
    paths = {name: folder / name for name in ("plain.mat", "packed.mat", "struct.mat", "plain.npz", "packed.npz", "one.json", "struct.json", "one.csv")}
    scipy.io.savemat(paths["plain.mat"], s)
    scipy.io.savemat(paths["packed.mat"], s, do_compression=True)
    scipy.io.savemat(paths["struct.mat"], {"sys": s, "note": "a text", "x": np.zeros((2, 3, 4))}, do_compression=True)
    np.savez(paths["plain.npz"], **turned)
    np.savez_compressed(paths["packed.npz"], **{k: v for k, v in turned.items() if k != "Ts"}, **({"dt": s["Ts"][0, 0]} if "Ts" in s else {}))
    # Decimals of single precision are written by this script: Python's json would write those of the double.
    text = "{" + ", ".join(f'"{k}": {shortest(v[0, 0]) if k == "Ts" else matrix(v)}' for k, v in s.items()) + "}"
    paths["one.json"].write_text(text)
    paths["struct.json"].write_text('{"model": ' + text + ', "note": null}')
    paths["one.csv"].write_text("".join(k + "\r\n" + "".join(",".join(map(shortest, row)) + "\r\n" for row in v) for k, v in s.items()))
    return paths


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (20, 20))


def run(program, *arguments, text=None):
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True, errors="replace", timeout=120, preexec_fn=limits)
    if done.returncode not in (0, 1, 2):
        raise SystemExit(f"{arguments}: status {done.returncode}\n{done.stderr}")
    return done


def answer(program, command, text):
    done = run(program, command, "-", "--json", "--digits", DIGITS, text=text)
    if done.returncode == 2:
        raise SystemExit(f"{command}: {done.stderr}\n{text}")
    document = json.loads(done.stdout)
    # The models differ in title and text, not in what they say of the loop.
    return {key: value for key, value in document.items() if key not in ("title", "model")}


def compare(program, number):
    rng = random.Random(f"system {number}")
    s = system(rng)
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        imported = {kind: run(program, "import", "-q", str(path)) for kind, path in files(s, Path(name), rng).items()}
    bodies = set()
    for kind, done in imported.items():
        if done.returncode != 0:
            raise SystemExit(f"system {number}, {kind}: {done.stderr}")
        # Of the comments and the title the file's name is another in each format.
        bodies.add("\n".join(line for line in done.stdout.split("\n") if not line.startswith(("#", "title"))))
        counts["files imported"] += 1
    closed = s["B"].shape[1] == s["C"].shape[0]
    expected = {command: answer(program, command, own_model(s, closed)) for command in (["intervals", "verdict"] if closed else ["verdict"])}
    for body in bodies:
        for command, wanted in expected.items():
            if answer(program, command, body) != wanted:
                raise SystemExit(f"system {number}: {command} differs\n{body}\n{own_model(s, closed)}")
            counts[f"{command} equal"] += 1
    counts["closed" if closed else "open"] += 1
    counts["discrete" if "Ts" in s else "continuous"] += 1
    return counts


def damage(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8])):
        at = rng.randrange(len(data))
        kind = rng.random()
        if kind < 0.5:
            data[at] = rng.choice([rng.randrange(256), data[at] ^ 1 << rng.randrange(8), 0, 255])
        elif kind < 0.65:
            del data[at : at + rng.choice([1, 4, 8, 100])]
        elif kind < 0.8:
            data[at:at] = data[at : at + rng.choice([1, 8, 500])]
        elif kind < 0.9:
            data[at : at + 4] = rng.choice([b"\xff\xff\xff\x7f", b"\xff\xff\xff\xff", b"\0\0\0\0"])
        else:
            del data[at:]
        if not data:
            break
    return bytes(data)


def attack(program, number):
    rng = random.Random(f"damage {number}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = files(system(rng), folder, rng)
        paths["linear.mo"] = folder / "linear.mo"
        paths["linear.mo"].write_bytes((Path(__file__).resolve().parents[1] / "import/files/linearized_model.mo").read_bytes())
        kind, path = rng.choice(sorted(paths.items()))
        path.write_bytes(damage(rng, path.read_bytes()))
        options = rng.choice([[], ["--last-place"], ["--open"]])
        child = subprocess.Popen([program, "import", str(path), *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, preexec_fn=limits)
        out = child.stdout.read()
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = 0
        code = os.waitstatus_to_exitcode(status)
        if code not in (0, 2) or used.ru_maxrss * 1024 > MEMORY:
            kept = Path(tempfile.gettempdir()) / f"damaged-{number}{path.suffix}"
            kept.write_bytes(path.read_bytes())
            raise SystemExit(f"damage {number}, {kind}: status {code}, {used.ru_maxrss} kB; kept as {kept}")
        if code == 0 and run(program, "check", "-", text=out.decode()).returncode != 0:
            raise SystemExit(f"damage {number}, {kind}: what is written is no model\n{out.decode()}")
    return collections.Counter({f"damaged: status {code}": 1, "most memory, kB": 0, f"damaged {path.suffix}": 1}), used.ru_maxrss


def main():
    program = str(Path(sys.argv[1]).resolve())
    systems, damaged = (int(a) for a in (sys.argv[2:] + ["200", "2000"][len(sys.argv) - 2 :]))
    counts, most = collections.Counter(), 0
    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(lambda k: compare(program, k), range(systems)):
            counts += found
        for found, memory in pool.map(lambda k: attack(program, k), range(damaged)):
            counts += found
            most = max(most, memory)
    for what, count in sorted(counts.items()):
        print(f"{what}: {count}")
    print(f"most memory of a damaged file: {most // 1024} MB")


if __name__ == "__main__":
    main()
