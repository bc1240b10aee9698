"""What a call of the package costs over the engine alone.

python overhead.py [PROGRAM]; the program is that of `cargo build --release -p jurist-benches --example question`. Both are asked the same in turn, and the
least time of each counts: what else the machine does only makes it longer.
"""

import subprocess
import sys
import time
from pathlib import Path

import jurist

ROOT = Path(__file__).resolve().parents[2]
LOOPS = {
    "small": (jurist.Loop.from_file(ROOT / "benches" / "data" / "small.toml"), "K"),
    "drive": (jurist.Loop.drive(), "K_pwm"),
}


def least(loop: jurist.Loop, parameter: str, repetitions: int = 200) -> float:
    """Milliseconds of a call."""

    def timed() -> float:
        begun = time.perf_counter()
        loop.intervals(parameter)
        return (time.perf_counter() - begun) * 1e3

    return min(timed() for _ in range(repetitions))


def main(program: str = str(ROOT / "target" / "release" / "examples" / "question")) -> None:
    rounds = []
    for _ in range(5):
        said = subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines()
        rounds.append([(name, float(alone), float(written), least(*LOOPS[name])) for name, alone, written in map(str.split, said)])
    for of_one in zip(*rounds, strict=True):
        (name, *_), (alone, written, ours) = of_one[0], (min(row[k] for row in of_one) for k in (1, 2, 3))
        print(f"{name}: answer {alone:.3f} ms, with its document {written:.3f} ms; loop.intervals {ours:.3f} ms, {ours - written:+.3f} ms")


if __name__ == "__main__":
    main(*sys.argv[1:])
