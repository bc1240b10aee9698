"""The rows of a sweep: questions by their keys, answers as columns."""

from __future__ import annotations

import hashlib
import json
import math
import os
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from . import _jurist
from ._errors import JuristError, JuristWarning, Undecided
from ._exact import fraction
from ._loop import Loop
from ._real import Real

SCHEMA = "jurist/sweep/1"
VERDICT = "verdict"
Point = tuple[tuple[str, str], ...]
"""Names and exact texts, sorted by name."""


def key_of(model: str, ask: str, point: Iterable[tuple[str, str]]) -> str:
    """What a question is known by: a hash of the schema, the engine's version, the model file, and the question.

    Examples
    --------
    >>> from jurist._sweep import key_of
    >>> key_of("text", "K", [("T", "1/2")]) == key_of("text", "K", [("T", "1/2")]), len(key_of("", "K", []))
    (True, 64)
    """
    lines = [SCHEMA, _jurist.__version__, hashlib.sha256(model.encode()).hexdigest(), ask]
    lines += [f"{name}={value}" for name, value in sorted(point)]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


_LOOPS: dict[str, Loop] = {}
"""Models that this process has read."""


def _loop(text: str, name: str) -> Loop:
    if text not in _LOOPS:
        if len(_LOOPS) > 64:
            _LOOPS.clear()
        _LOOPS[text] = Loop.from_toml(text, name=name)
    return _LOOPS[text]


def _end_columns(side: str, end: dict[str, Any] | None) -> dict[str, Any]:
    if end is None:
        return {side: -float("inf") if side == "lower" else float("inf")}
    # Both bounds mostly round alike; else the number itself is asked.
    lower, upper = (float(fraction(bound)) for bound in end["enclosure"])
    return {
        side: lower if lower == upper else float(Real._from_document(end)),
        f"{side}_decimal": end["decimal"],
        f"{side}_exact": end["exact"],
        f"{side}_polynomial": end["polynomial"],
        f"{side}_enclosure": end["enclosure"],
        f"{side}_causes": end["cause"].split("+"),
        f"{side}_closed": end["closed"],
        f"{side}_hz": end["frequency_hz"],
    }


def rows_of(text: str, name: str, ask: str, point: Point, timeout: float | None) -> list[dict[str, Any]]:
    """The rows of one question: one for each interval, one where there is none, one for a verdict or a failure."""
    base: dict[str, Any] = {"key": key_of(text, ask, point), "model": name, "parameter": ask, "status": "decided"}
    base |= {f"p.{n}": v for n, v in point}
    try:
        loop = _loop(text, name)
        if ask == VERDICT:
            document = loop.verdict(dict(point), timeout=timeout).to_dict()
            names = ("verdict", "degree", "inside", "on", "outside", "infinite")
            return [{**base, **{n: document[n] for n in names}}]
        found = loop.intervals(ask, dict(point), timeout=timeout, digits=17).to_dict()["stable"]
    except Undecided as error:
        return [{**base, "status": "undecided", "code": error.code, "message": str(error)}]
    except JuristError as error:
        status = "defect" if error.code == "E-internal" else "refused"
        return [{**base, "status": status, "code": error.code, "message": str(error)}]
    if not found:
        return [base]
    rows = []
    for k, i in enumerate(found):
        rows.append({**base, "interval": k, **_end_columns("lower", i["lower"]), **_end_columns("upper", i["upper"])})
    return rows


def ask_chunk(
    questions: Sequence[tuple[str, str, str, Point]], timeout: float | None, threads: int | None = 1
) -> tuple[list[dict[str, Any]], float]:
    """What a worker does: the rows of its questions, and the seconds they took."""
    import warnings

    if threads is not None and _jurist.threads() != threads:
        _jurist.set_threads(threads)
    begun = time.perf_counter()
    rows: list[dict[str, Any]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", JuristWarning)
        for question in questions:
            rows += rows_of(*question, timeout)
    return rows, time.perf_counter() - begun


def arrow_schema(parameters: Iterable[str]) -> Any:
    """The columns, with the values of the parameters that are swept over."""
    import pyarrow as pa

    def side(name: str) -> list[tuple[str, Any]]:
        texts = [(f"{name}_{part}", pa.string()) for part in ("decimal", "exact")]
        lists = [(f"{name}_{part}", pa.list_(pa.string())) for part in ("polynomial", "enclosure", "causes")]
        return [(name, pa.float64()), *texts, *lists, (f"{name}_closed", pa.bool_()), (f"{name}_hz", pa.float64())]

    counts = [(name, pa.int32()) for name in ("degree", "inside", "on", "outside", "infinite")]
    columns = [("key", pa.string()), ("model", pa.string()), *((f"p.{n}", pa.string()) for n in sorted(parameters))]
    columns += [("parameter", pa.string()), ("interval", pa.int32()), *side("lower"), *side("upper")]
    columns += [("verdict", pa.string()), *counts, *((n, pa.string()) for n in ("status", "code", "message"))]
    return pa.schema(columns, metadata={"schema": SCHEMA, "engine": _jurist.__version__})


def _cell(value: Any) -> Any:
    """A value as the program writes it in a table."""
    if isinstance(value, bool):
        return str(value).lower()
    return "+".join(value) if isinstance(value, list) else value


def _order(row: Mapping[str, Any]) -> tuple[Any, ...]:
    names = sorted(n for n in row if n.startswith("p."))
    values = [(n, fraction(row[n])) for n in names]
    return row["model"], row["parameter"], values, row["key"], row.get("interval", 0)


_RANK = {"decided": 0, "refused": 1, "undecided": 2, "defect": 3}


class SweepResult:
    """The rows of a sweep, in order of the questions' models, parameters and values.

    Attributes
    ----------
    rows : list of dict
        One for each interval; one for a question that is never stable, not decided or refused.
    asked : int
        How many questions were asked in this run.
    resumed : int
        How many were known from earlier runs.
    """

    def __init__(self, rows: list[dict[str, Any]], names: Collection[str], asked: int, resumed: int, out: Path | None) -> None:
        # What a row has nothing to say of is left out: so a row is the same before and after it was a file.
        rows = [{name: value for name, value in row.items() if value is not None} for row in rows]
        best: dict[str, int] = {}
        for row in rows:
            best[row["key"]] = min(best.get(row["key"], 9), _RANK[row["status"]])
        seen: dict[tuple[Any, ...], dict[str, Any]] = {}
        for row in rows:
            if _RANK[row["status"]] == best[row["key"]]:
                seen[row["key"], row.get("interval")] = row
        self.rows = sorted(seen.values(), key=_order)
        self.names = tuple(sorted(names))
        self.asked = asked
        self.resumed = resumed
        self.out = out

    def table(self) -> Any:
        """As a pyarrow table."""
        import pyarrow as pa

        return pa.Table.from_pylist(self.rows, schema=arrow_schema(self.names))

    def to_frame(self) -> Any:
        """As a pandas frame."""
        import pandas

        return pandas.DataFrame(self.rows)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self.table().__arrow_c_stream__(requested_schema)

    def compact(self, path: str | os.PathLike[str] | None = None) -> Path:
        """Writes one file whose bytes depend on the questions only: ``.parquet`` (default), ``.arrow``, ``.csv`` or ``.jsonl``."""
        import pyarrow as pa
        import pyarrow.parquet

        if path is None:
            if self.out is None:
                raise ValueError("name a file, or sweep into a folder")
            path = self.out / "sweep.parquet"
        target = Path(path)
        beside = target.with_name(target.name + ".tmp")
        if target.suffix == ".jsonl":
            # No number of JSON is infinite.
            finite = ({k: None if v in (-math.inf, math.inf) else v for k, v in row.items()} for row in self.rows)
            beside.write_text("".join(json.dumps(row, ensure_ascii=False) + "\n" for row in finite), encoding="utf-8")
        elif target.suffix == ".csv":
            import csv

            with open(beside, "w", newline="", encoding="utf-8") as file:
                names = arrow_schema(self.names).names
                writer = csv.DictWriter(file, names, restval="")
                writer.writeheader()
                for row in self.rows:
                    writer.writerow({name: _cell(value) for name, value in row.items()})
        elif target.suffix == ".arrow":
            with pa.OSFile(str(beside), "wb") as sink, pa.ipc.new_file(sink, arrow_schema(self.names)) as writer:
                writer.write_table(self.table())
        else:
            pyarrow.parquet.write_table(self.table(), beside, compression="zstd")
        os.replace(beside, target)
        return target

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        return f"<SweepResult {len(self.rows)} rows: {self.asked} questions asked, {self.resumed} known>"
