"""A plugin of pytest: the expectations of model files as tests, and the fixture ``jurist``.

    pytest --jurist control/

Each ``[[expect]]`` of a model file is a test with its own name. Without ``--jurist``, the ini option ``jurist_models`` names the files. Where
neither is given, nothing but the fixture is there.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from . import Loop

SCHEMA = "jurist/test/1"
"""What the document of ``jurist test --json`` is called."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the option and its counterpart in the configuration."""
    group = parser.getgroup("jurist", "stability of control loops")
    group.addoption(
        "--jurist",
        action="store_true",
        help="collect the expectations of all model files: TOML files with [[expect]]",
    )
    parser.addini("jurist_models", "model files whose expectations are collected: patterns, relative to the root folder", type="args", default=[])


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> ModelFile | None:
    """A model file that is asked for."""
    if file_path.suffix != ".toml":
        return None
    config = parent.config
    # `match` compares from the right: a pattern with folders needs the path from the root.
    place = file_path.relative_to(config.rootpath) if file_path.is_relative_to(config.rootpath) else file_path
    is_named = any(place.match(pattern) for pattern in config.getini("jurist_models"))
    if not is_named and not (config.getoption("--jurist") and _expects(file_path)):
        return None
    return ModelFile.from_parent(parent, path=file_path)


def _expects(path: Path) -> bool:
    """Whether a TOML file has expectations. One that cannot be read has them if it seems so: then the program says what is wrong."""
    content = path.read_bytes()
    try:
        return isinstance(tomllib.loads(content.decode()).get("expect"), list)
    except (UnicodeDecodeError, tomllib.TOMLDecodeError):
        return b"[[expect]]" in content


class ModelFile(pytest.File):
    """A model file. It is asked once, when it is collected."""

    def collect(self) -> Iterable[pytest.Item]:
        """The expectations."""
        names: dict[str, int] = {}
        for test in _tests(self.path):
            name = test["name"]
            names[name] = names.get(name, 0) + 1
            own = name if names[name] == 1 else f"{name} ({names[name]})"
            yield Expectation.from_parent(self, name=own, found=test)


class Expectation(pytest.Item):
    """An expectation of a model file, and what was found."""

    def __init__(self, *, found: dict[str, Any], **keys: Any) -> None:
        super().__init__(**keys)
        self.found = found

    def runtest(self) -> None:
        """Fails unless the expectation is met. What is undecided is not met."""
        if self.found["status"] != "passed":
            raise NotMet(self.found)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The program's line in place of a traceback."""
        if not isinstance(excinfo.value, NotMet):
            return super().repr_failure(excinfo, style)
        line = self.found.get("line")
        place = f"{self.path}:{line}" if line else str(self.path)
        return f"{place}: {self.found['status']}: {self.found['text']}"

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where the expectation stands; pytest counts lines from 0."""
        line = self.found.get("line")
        return self.path, line - 1 if line else None, self.name


class NotMet(Exception):
    """An expectation that is not met."""


def _tests(path: Path) -> list[dict[str, Any]]:
    """What the program says of a file."""
    status, output, said = run(["jurist", "test", str(path), "--json"])
    try:
        document = json.loads(output)
    except ValueError:
        document = {}
    if document.get("schema") != SCHEMA:
        raise pytest.Collector.CollectError(said.strip() or f"jurist test {path} ended with the status {status} and no document")
    return [test for file in document["files"] for test in file["tests"]]


def run(arguments: list[str]) -> tuple[int, str, str]:
    """Runs the program in this process: its status, and what it wrote to standard output and to standard error."""
    from . import _jurist

    # The program writes to the descriptors of the process and not to objects of Python.
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as said:
        with _instead(1, output), _instead(2, said):
            status = _jurist.program(arguments)
        return status, _content(output), _content(said)


@contextlib.contextmanager
def _instead(descriptor: int, file: IO[bytes]) -> Iterator[None]:
    """Has a descriptor lead to a file for a while."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    kept = os.dup(descriptor)
    try:
        os.dup2(file.fileno(), descriptor)
        yield
    finally:
        os.dup2(kept, descriptor)
        os.close(kept)


def _content(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode(errors="replace")


class Jurist:
    """The package `jurist`, with what tests need beside it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __getattr__(self, name: str) -> Any:
        import jurist

        return getattr(jurist, name)

    def load(self, path: str | os.PathLike[str]) -> Loop:
        """Reads a model file; a relative path begins in the folder of the test."""
        import jurist

        return jurist.Loop.from_file(self._folder / path)

    def check(self, path: str | os.PathLike[str]) -> None:
        """Fails unless all expectations of a model file are met."""
        __tracebackhide__ = True
        wrong = [test for test in _tests(self._folder / path) if test["status"] != "passed"]
        if wrong:
            pytest.fail("\n".join(f"{test['name']}: {test['status']}: {test['text']}" for test in wrong), pytrace=False)


@pytest.fixture
def jurist(request: pytest.FixtureRequest) -> Jurist:
    """The package `jurist`, with ``load`` for model files beside the test and ``check`` for their expectations."""
    return Jurist(request.path.parent)
