"""The same question at many points, on any executor, resumable."""

from __future__ import annotations

import hashlib
import itertools
import os
import queue
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Protocol

from . import _jurist
from ._errors import JuristError
from ._exact import Exact, text_of
from ._loop import Loop
from ._rows import Point, SweepResult, arrow_schema, ask_chunk, key_of, rows_of

_FIRST_CHUNK = 8
_CHUNK_SECONDS = 1.0
_TRIES = 4
_LARGEST_CHUNK = 2000


class Submits(Protocol):
    """An executor: `concurrent.futures`, loky, a Dask client, and others."""

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> Any:
        """Gives a future with ``result`` and ``add_done_callback``."""


def _points(over: Any) -> list[Point]:
    if isinstance(over, Mapping):
        names = sorted(over)
        values = [[text_of(v) for v in over[name]] for name in names]
        return [tuple(zip(names, point, strict=True)) for point in itertools.product(*values)]
    return [tuple(sorted((str(n), text_of(v)) for n, v in point.items())) for point in over]


def _known(out: Path, retry: Collection[str]) -> list[dict[str, Any]]:
    import pyarrow.parquet

    rows = []
    for part in sorted(out.glob("part-*.parquet")):
        # A file that was not finished has another name: it was renamed last.
        rows += pyarrow.parquet.read_table(part).to_pylist()
    return [row for row in rows if row["status"] not in retry]


def _write_part(out: Path, rows: list[dict[str, Any]], names: Collection[str]) -> None:
    import pyarrow as pa
    import pyarrow.parquet

    name = hashlib.sha256("".join(row["key"] + row["status"] for row in rows).encode()).hexdigest()[:32]
    beside = out / f".part-{name}.tmp"
    pyarrow.parquet.write_table(pa.Table.from_pylist(rows, schema=arrow_schema(names)), beside, compression="zstd")
    os.replace(beside, out / f"part-{name}.parquet")


class _Bar:
    """How far a sweep is."""

    def __init__(self, wanted: bool | Callable[[int, int], None], total: int, done: int) -> None:
        self.total, self.done, self.tell, self.bar = total, done, None, None
        if callable(wanted):
            self.tell = wanted
        elif wanted and sys.stderr.isatty():
            try:
                from tqdm import tqdm
            except ImportError:
                return
            self.bar = tqdm(total=total, initial=done, unit="question", file=sys.stderr)

    def advance(self, count: int) -> None:
        self.done += count
        if self.bar is not None:
            self.bar.update(count)
        if self.tell is not None:
            self.tell(self.done, self.total)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


def _one_thread() -> None:
    _jurist.set_threads(1)


def _workers(executor: Any) -> int:
    """How many chunks are worked on at the same time, as far as an executor says so."""
    if hasattr(executor, "ncores"):
        return max(1, int(sum(executor.ncores().values())))
    return int(getattr(executor, "_max_workers", 0) or os.cpu_count() or 1)


Question = tuple[str, str, str, Point]


def sweep(
    loops: Loop | Iterable[Loop],
    ask: str | Sequence[str],
    over: Mapping[str, Iterable[Exact]] | Iterable[Mapping[str, Exact]] | None = None,
    *,
    executor: Submits | Any | None = None,
    out: str | os.PathLike[str] | None = None,
    resume: bool = True,
    retry: Collection[str] = (),
    chunk: int | Literal["auto"] = "auto",
    timeout: float | None = 10,
    progress: bool | Callable[[int, int], None] = True,
    on_error: Literal["record", "raise"] = "record",
) -> SweepResult:
    """Asks the same question of loops at many points.

    Parameters
    ----------
    loops : Loop or iterable of Loop
    ask : str or sequence of str
        Parameters whose stable sets are wanted, or ``"verdict"``.
    over : mapping from names to values, or iterable of mappings
        A grid, all combinations; or the points themselves. All values nominal, if not given.
    executor : optional
        Anything with ``submit`` (standard pools, loky, a Dask client, `ray_executor`), or a joblib ``Parallel``. By default a pool
        of processes, as many as there are cores.
    out : path, optional
        A folder for the rows, a Parquet file for each chunk. Questions whose rows are there are not asked again.
    resume : bool
        `False` asks everything anew.
    retry : collection of {"undecided", "refused", "defect"}
        Asks these again, with more time for example.
    chunk : int or "auto"
        Questions sent at a time; by default about a second's worth.
    timeout : float, optional
        Seconds for each question.
    progress : bool or callable
        A bar on a terminal (with tqdm), or told how many of how many are done.
    on_error : {"record", "raise"}
        Failures are rows, or raised.

    Returns
    -------
    SweepResult

    Examples
    --------
    >>> import jurist
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     r = jurist.sweep(jurist.Loop.drive(), "K_pwm", {"T": ["1e-4", "2e-4"]}, executor=pool)
    >>> [(row["p.T"], round(row["upper"], 3)) for row in r.rows]
    [('1/10000', 550.941), ('1/5000', 274.936)]
    """
    all_loops = [loops] if isinstance(loops, Loop) else list(loops)
    asks = [ask] if isinstance(ask, str) else list(ask)
    points: list[Point] = [()] if over is None else _points(over)
    names = {name for point in points for name, _ in point}
    questions: dict[str, Question] = {}
    for loop, one, point in itertools.product(all_loops, asks, points):
        text, name = loop.to_toml(), loop.title or loop.name
        questions[key_of(text, one, point)] = (text, name, one, point)
    folder = None if out is None else Path(out)
    rows: list[dict[str, Any]] = []
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        if resume:
            rows = [row for row in _known(folder, retry) if row["key"] in questions]
    known = {row["key"] for row in rows}
    open_questions = [question for key, question in questions.items() if key not in known]
    bar = _Bar(progress, len(questions), len(known))

    def take(found: list[dict[str, Any]], count: int) -> None:
        if on_error == "raise":
            for row in found:
                if row["status"] != "decided":
                    raise JuristError(row["message"])
        if folder is not None:
            _write_part(folder, found, names)
        rows.extend(found)
        bar.advance(count)

    try:
        if open_questions:
            _run(open_questions, executor, chunk, timeout, take)
    except KeyboardInterrupt:
        if folder is not None:
            print(f"jurist: stopped; the same call goes on from {folder}", file=sys.stderr)
        raise
    finally:
        bar.close()
    return SweepResult(rows, names, len(open_questions), len(known), folder)


def _run(
    questions: list[Question],
    executor: Any,
    chunk: int | Literal["auto"],
    timeout: float | None,
    take: Callable[[list[dict[str, Any]], int], None],
) -> None:
    if executor is None:
        import multiprocessing
        from concurrent.futures import ProcessPoolExecutor

        # Never by fork: other libraries' threads do not survive it.
        spawn = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(mp_context=spawn, initializer=_one_thread) as pool:
            _submitted(questions, pool, chunk, timeout, take)
    elif hasattr(executor, "submit"):
        _submitted(questions, executor, chunk, timeout, take)
    else:
        _by_joblib(questions, executor, chunk, timeout, take)


def _by_joblib(questions: list[Question], parallel: Any, chunk: Any, timeout: float | None, take: Any) -> None:
    from joblib import delayed

    size = chunk
    if chunk == "auto":
        first, questions = questions[:_FIRST_CHUNK], questions[_FIRST_CHUNK:]
        found, seconds = ask_chunk(first, timeout, None)
        take(found, len(first))
        size = _sized(seconds / len(first))
    chunks = [questions[i : i + size] for i in range(0, len(questions), size)]
    for done, (found, _) in zip(chunks, parallel(delayed(ask_chunk)(c, timeout) for c in chunks), strict=True):
        take(found, len(done))


def _sized(seconds: float) -> int:
    return max(1, min(_LARGEST_CHUNK, int(_CHUNK_SECONDS / max(seconds, 1e-6))))


def _submitted(questions: list[Question], executor: Any, chunk: Any, timeout: float | None, take: Any) -> None:
    at_once = 2 * _workers(executor)
    threads = None if type(executor).__name__ == "ThreadPoolExecutor" else 1
    done: queue.SimpleQueue[Any] = queue.SimpleQueue()
    running: dict[Any, tuple[list[Question], int]] = {}
    waiting = list(reversed(questions))
    again: list[tuple[list[Question], int]] = []
    size = _FIRST_CHUNK if chunk == "auto" else chunk

    def send(part: list[Question], tries: int) -> None:
        options = {"pure": False} if hasattr(executor, "ncores") else {}
        future = executor.submit(ask_chunk, part, timeout, threads, **options)
        running[id(future)] = (part, tries)
        future.add_done_callback(done.put)

    try:
        while waiting or running or again:
            while (waiting or again) and len(running) < at_once:
                if again:
                    send(*again.pop())
                else:
                    part = [waiting.pop() for _ in range(min(size, len(waiting)))]
                    send(part, 1)
            try:
                future = done.get(timeout=0.2)
            except queue.Empty:
                continue
            part, tries = running.pop(id(future))
            try:
                found, seconds = future.result()
            except JuristError:
                raise
            except Exception:
                # A worker was lost; its chunk is all that is repeated.
                if tries >= _TRIES:
                    raise
                again.append((part, tries + 1))
                continue
            take(found, len(part))
            if chunk == "auto":
                size = _sized(seconds / len(part))
    except BaseException:
        for future in list(running):
            getattr(future, "cancel", lambda: None)()
        raise


class _RayFuture:
    def __init__(self, reference: Any) -> None:
        self.reference = reference

    def result(self) -> Any:
        import ray

        return ray.get(self.reference)

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        import threading

        import ray

        def watch() -> None:
            ray.wait([self.reference])
            callback(self)

        threading.Thread(target=watch, daemon=True).start()


class _RayExecutor:
    def __init__(self, options: Mapping[str, Any]) -> None:
        import ray

        self._task = ray.remote(**{"num_cpus": 1, **options})(ask_chunk)
        self._max_workers = int(ray.cluster_resources().get("CPU", 1))

    def submit(self, fn: Callable[..., Any], /, *args: Any) -> _RayFuture:
        return _RayFuture(self._task.remote(*args))


def ray_executor(**options: Any) -> Submits:
    """An executor on the Ray cluster that this process is connected to; options are those of ``ray.remote``."""
    return _RayExecutor(options)


def sweep_batches(batches: Iterable[Any]) -> Iterator[Any]:
    """Arrow batches in, Arrow batches out: for Spark ``mapInArrow``, Ray ``map_batches``, Dask ``map_partitions``.

    A batch has the columns ``model`` (the text of a model file), ``parameter`` (what is asked) and ``p.NAME`` for each value; what comes
    out has the columns of `sweep`.

    Examples
    --------
    >>> import jurist, pyarrow as pa
    >>> model = jurist.Loop.drive().to_toml()
    >>> batch = pa.RecordBatch.from_pydict({"model": [model], "parameter": ["K_pwm"], "p.T": ["2e-4"]})
    >>> out = list(jurist.sweep_batches([batch]))[0]
    >>> out.column("upper").to_pylist()
    [274.9358757804702]
    """
    import pyarrow as pa

    for batch in batches:
        names = [n.removeprefix("p.") for n in batch.schema.names if n.startswith("p.")]
        rows: list[dict[str, Any]] = []
        for row in batch.to_pylist():
            given = ((n, row[f"p.{n}"]) for n in names)
            point = tuple(sorted((n, text_of(v)) for n, v in given if v is not None))
            rows += rows_of(row["model"], row.get("name") or "<batch>", row["parameter"], point, row.get("timeout"))
        yield pa.RecordBatch.from_pylist(rows, schema=arrow_schema(names))
