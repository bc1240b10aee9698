"""What the tests share."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import jurist
import pytest

# Processes of the tests import what is installed, not what lies in the folder in which they begin.
os.environ["PYTHONSAFEPATH"] = "1"

ROOT = Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests" / "corpus"


def program(*arguments: str, stdin: str | None = None) -> subprocess.CompletedProcess[str]:
    """Runs the program: that of the environment's JURIST_PROGRAM, else the one that comes with the package."""
    own = os.environ.get("JURIST_PROGRAM")
    command = [own] if own else [sys.executable, "-m", "jurist"]
    return subprocess.run([*command, *arguments], input=stdin, capture_output=True, text=True, check=False)


def corpus() -> list[tuple[str, str, dict]]:
    """Name, model and questions of each file of the corpus."""
    out = []
    for path in sorted(CORPUS.glob("*.toml")):
        case = tomllib.loads(path.read_text())
        model = case.get("model") or (ROOT / "examples" / f"{case['example']}.toml").read_text()
        out.append((path.stem, model, case["expect"]))
    return out


@pytest.fixture(scope="session")
def drive() -> jurist.Loop:
    return jurist.Loop.drive()


@pytest.fixture
def small() -> jurist.Loop:
    """Stable for 0 < K < 2."""
    return jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": 1})
