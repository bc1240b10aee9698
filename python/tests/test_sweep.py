"""Sweeps: the same rows on every executor, resumed after a loss, failures as rows."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import jurist
import pyarrow.parquet
import pytest
from conftest import program
from jurist import _sweep

GRID = {"T": [f"{k}e-5" for k in range(5, 29)]}
FEW = {"T": ["1e-4", "2e-4", "3e-4"]}


@pytest.fixture(scope="module")
def expected():
    with ThreadPoolExecutor(1) as pool:
        return jurist.sweep(jurist.Loop.drive(), "K_pwm", GRID, executor=pool, progress=False).rows


def spawn():
    return ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn"))


def fork():
    return ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("fork"))


@pytest.mark.parametrize("make", [lambda: ThreadPoolExecutor(3), spawn, fork], ids=["threads", "spawn", "fork"])
def test_standard_pools_give_the_same_rows(make, expected):
    jurist.Loop.drive().intervals("K_pwm")
    with make() as pool:
        assert jurist.sweep(jurist.Loop.drive(), "K_pwm", GRID, executor=pool, progress=False, chunk=5).rows == expected


def test_loky_and_joblib_and_no_executor_give_the_same_rows(expected):
    import joblib
    from loky import get_reusable_executor

    loop = jurist.Loop.drive()
    assert jurist.sweep(loop, "K_pwm", GRID, executor=get_reusable_executor(max_workers=2), progress=False).rows == expected
    for returned in ("list", "generator"):
        parallel = joblib.Parallel(n_jobs=2, return_as=returned)
        assert jurist.sweep(loop, "K_pwm", GRID, executor=parallel, progress=False).rows == expected
    assert jurist.sweep(loop, "K_pwm", GRID, progress=False).rows == expected
    get_reusable_executor().shutdown(wait=True)


def test_rows_are_the_answers_of_the_loop(expected):
    for row in expected:
        s = jurist.Loop.drive().intervals("K_pwm", {"T": row["p.T"]})
        assert (row["lower"], row["upper"]) == (float(s[row["interval"]].lower), float(s[row["interval"]].upper))
        assert row["upper_causes"] == ["complex pair"]
        assert row["upper_hz"] > 0


def test_equal_numbers_are_one_question(tmp_path):
    loop = jurist.Loop.drive()
    with ThreadPoolExecutor(1) as pool:
        r = jurist.sweep(loop, "K_pwm", {"T": ["1e-4", "1/10000", 0.0001]}, executor=pool, out=tmp_path, progress=False)
        assert (r.asked, len(r)) == (1, 1)
        again = jurist.sweep(loop, "K_pwm", [{"T": "0.0001"}], executor=pool, out=tmp_path, progress=False)
    assert (again.asked, again.resumed, again.rows) == (0, 1, r.rows)
    anew = jurist.sweep(loop, "K_pwm", [{"T": "0.0001"}], out=tmp_path, resume=False, progress=False)
    assert (anew.asked, anew.rows) == (1, r.rows)


def test_failures_are_rows_and_undecided_questions_are_asked_again(tmp_path):
    loop = jurist.Loop.drive()
    with ThreadPoolExecutor(1) as pool:
        r = jurist.sweep(loop, ["K_pwm", "K_pmw", "verdict"], FEW, executor=pool, out=tmp_path, timeout=0, progress=False)
        statuses = {(row["parameter"], row["status"]) for row in r.rows}
        assert statuses == {("K_pwm", "undecided"), ("K_pmw", "refused"), ("verdict", "undecided")}
        assert {row["code"] for row in r.rows} == {"undecided", "E-unknown-parameter"}
        again = jurist.sweep(loop, ["K_pwm", "verdict"], FEW, executor=pool, out=tmp_path, retry={"undecided"}, progress=False)
        assert again.asked == 6
        assert {row["status"] for row in again.rows} == {"decided"}
        # What is decided replaces what was not.
        last = jurist.sweep(loop, ["K_pwm", "verdict"], FEW, executor=pool, out=tmp_path, progress=False)
        assert (last.asked, last.rows) == (0, again.rows)
        with pytest.raises(jurist.JuristError, match="K_pmw"):
            jurist.sweep(loop, "K_pmw", FEW, executor=pool, on_error="raise", progress=False)


def test_a_killed_run_goes_on_and_ends_with_the_same_bytes(tmp_path):
    clean, broken = tmp_path / "clean", tmp_path / "broken"
    grid = {"T": [f"{k}e-6" for k in range(50, 290)]}
    with ThreadPoolExecutor(1) as pool:
        want = jurist.sweep(jurist.Loop.drive(), "K_pwm", grid, executor=pool, out=clean, chunk=20, progress=False).compact()
    code = f"""
        import jurist
        from concurrent.futures import ThreadPoolExecutor
        grid = {grid!r}
        with ThreadPoolExecutor(1) as pool:
            jurist.sweep(jurist.Loop.drive(), "K_pwm", grid, executor=pool, out={str(broken)!r}, chunk=10, progress=False)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)])
    while len(list(broken.glob("part-*.parquet"))) < 3 and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    known = sum(pyarrow.parquet.read_metadata(p).num_rows for p in broken.glob("part-*.parquet"))
    assert known >= 30
    with ThreadPoolExecutor(1) as pool:
        r = jurist.sweep(jurist.Loop.drive(), "K_pwm", grid, executor=pool, out=broken, chunk=7, progress=False)
    assert r.asked == 240 - r.resumed
    assert r.resumed >= 30
    assert r.compact().read_bytes() == want.read_bytes()


def test_every_file_format_holds_the_same_rows(tmp_path, expected):
    import csv

    import pyarrow as pa

    with ThreadPoolExecutor(1) as pool:
        r = jurist.sweep(jurist.Loop.drive(), "K_pwm", GRID, executor=pool, progress=False)
    decimals = [row["upper_decimal"] for row in expected]
    assert pyarrow.parquet.read_table(r.compact(tmp_path / "a.parquet")).column("upper_decimal").to_pylist() == decimals
    with pa.ipc.open_file(str(r.compact(tmp_path / "a.arrow"))) as reader:
        assert reader.read_all().column("upper_decimal").to_pylist() == decimals
    with open(r.compact(tmp_path / "a.csv"), newline="") as file:
        assert [row["upper_decimal"] for row in csv.DictReader(file)] == decimals
    lines = r.compact(tmp_path / "a.jsonl").read_text().splitlines()
    assert [json.loads(line)["upper_decimal"] for line in lines] == decimals
    assert list(r.to_frame()["upper_decimal"]) == decimals
    assert pa.table(r).num_rows == len(r)
    with pytest.raises(ValueError, match="name a file"):
        r.compact()


MODEL = """
title = "two windows, and none"
time = "discrete"
parameters.K = { nominal = 0, min = -10 }
parameters.a = { nominal = 0 }
[loop]
characteristic = "z^2 + (K^2 - 3)*z + 1/3 + a/(a - 2)"
"""


def test_the_program_sweeps_with_the_same_keys_and_columns_and_bytes(tmp_path):
    """Ends that are rational, irrational, infinite; sets without intervals; points where the model is undefined."""
    model = tmp_path / "model.toml"
    model.write_text(MODEL)
    loop = jurist.Loop.from_file(model)
    values = ["-1/7", "-1/20", 0, "1/20", 2, 5, "1e-9"]
    over = "a=" + ",".join(str(v) for v in values)
    for ask, words in (("K", ["--param", "K"]), ("verdict", ["--set", "K=1/2"])):
        fixed = {} if ask == "K" else {"K": ["1/2"]}
        with ThreadPoolExecutor(1) as pool:
            r = jurist.sweep(loop, ask, {"a": values, **fixed}, executor=pool, progress=False)
        for ending in ("jsonl", "csv"):
            theirs = tmp_path / f"{ask}.{ending}"
            done = program("sweep", str(model), *words, "--over", over, "-o", str(theirs))
            assert (done.returncode, done.stderr) == (0, f"wrote {theirs}\n")
            assert r.compact(tmp_path / f"ours.{ending}").read_bytes() == theirs.read_bytes()
    assert {row["status"] for row in r.rows} == {"decided"}


def test_the_program_goes_on_with_a_sweep_that_was_killed(tmp_path):
    out = tmp_path / "rows.jsonl"
    words = ["sweep", "--param", "K_pwm", "--over", "T=1e-5..1e-3:400", "-o", str(out)]
    whole = program(*words[:-1], str(tmp_path / "whole.jsonl"))
    assert whole.returncode == 0
    process = subprocess.Popen([sys.executable, "-m", "jurist", *words])
    part = tmp_path / "rows.jsonl.part"
    while process.poll() is None and not (part.exists() and part.stat().st_size > 1000):
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    process.wait()
    if part.exists():
        # A line that was cut in the middle is not taken for a row.
        part.write_bytes(part.read_bytes()[:-20])
    done = program(*words, "--resume")
    assert done.returncode == 0, done
    assert out.read_bytes() == (tmp_path / "whole.jsonl").read_bytes()
    assert not part.exists()


def test_progress_is_told(tmp_path):
    told = []
    with ThreadPoolExecutor(1) as pool:
        jurist.sweep(jurist.Loop.drive(), "K_pwm", FEW, executor=pool, progress=lambda done, total: told.append((done, total)), chunk=1)
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_a_lost_worker_costs_its_chunk_only(expected):
    """An executor that loses every chunk when it is sent for the first time."""

    class Loses(ThreadPoolExecutor):
        sent = set()

        def submit(self, fn, /, *args, **kw):
            chunk = str(args[0])
            if chunk not in self.sent:
                self.sent.add(chunk)
                return super().submit(self.lost)
            return super().submit(fn, *args, **kw)

        @staticmethod
        def lost():
            raise OSError("the worker is gone")

    with Loses(2) as pool:
        assert jurist.sweep(jurist.Loop.drive(), "K_pwm", GRID, executor=pool, progress=False, chunk=2).rows == expected

    class Never(ThreadPoolExecutor):
        def submit(self, fn, /, *args, **kw):
            return super().submit(Loses.lost)

    with Never(1) as pool, pytest.raises(OSError, match="gone"):
        jurist.sweep(jurist.Loop.drive(), "K_pwm", FEW, executor=pool, progress=False)


def test_batches_of_arrow_give_the_columns_of_a_sweep(expected):
    import pyarrow as pa

    text = jurist.Loop.drive().to_toml()
    columns = {"model": [text] * len(GRID["T"]), "parameter": ["K_pwm"] * len(GRID["T"]), "p.T": GRID["T"]}
    out = pa.Table.from_batches(jurist.sweep_batches([pa.RecordBatch.from_pydict(columns)]))
    assert sorted(out.column("upper_decimal").to_pylist()) == sorted(row["upper_decimal"] for row in expected)
    assert out.schema.names == _sweep.arrow_schema(["T"]).names


def test_a_key_is_of_the_model_the_question_and_nothing_else():
    key = _sweep.key_of("model", "K", [("a", "1"), ("b", "2")])
    assert key == _sweep.key_of("model", "K", [("b", "2"), ("a", "1")])
    others = [("model ", "K", [("a", "1"), ("b", "2")]), ("model", "T", [("a", "1"), ("b", "2")]), ("model", "K", [("a", "1")])]
    assert key not in {_sweep.key_of(*other) for other in others}


def test_ray_where_it_is_installed(expected):
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, log_to_driver=False)
    try:
        r = jurist.sweep(jurist.Loop.drive(), "K_pwm", GRID, executor=jurist.ray_executor(), progress=False)
        assert r.rows == expected
    finally:
        ray.shutdown()


@pytest.mark.skipif(os.environ.get("JURIST_DASK") == "0", reason="switched off")
def test_a_local_dask_cluster_loses_a_worker_and_no_answer(tmp_path):
    """Two workers, one of them killed in the middle: nothing is lost, and the bytes are those of one process.

    10 000 questions, or as many as JURIST_DASK_QUESTIONS says; the figures are printed (`pytest -s`).
    """
    from distributed import Client, LocalCluster

    count = int(os.environ.get("JURIST_DASK_QUESTIONS", "10000"))
    loop = jurist.Loop.characteristic("z^3 + a*z^2 + K*z - 1/3", time="discrete", parameters={"K": 0, "a": 0})
    grid = {"a": [f"{k}/{count}" for k in range(count)]}
    begun = time.perf_counter()
    with ThreadPoolExecutor(1) as pool:
        jurist.set_threads(1)
        one = jurist.sweep(loop, "K", grid, executor=pool, out=tmp_path / "one", progress=False)
        jurist.set_threads(None)
    alone = time.perf_counter() - begun
    killed = []
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        begun = time.perf_counter()
        whole = jurist.sweep(loop, "K", grid, executor=client, out=tmp_path / "whole", progress=False)
        two = time.perf_counter() - begun
        begun = time.perf_counter()

        def middle(done, total):
            if done > total // 4 and not killed:
                pids = client.run(os.getpid)
                killed.append(min(pids.values()))
                os.kill(killed[0], signal.SIGKILL)

        both = jurist.sweep(loop, "K", grid, executor=client, out=tmp_path / "dask", progress=middle)
        together = time.perf_counter() - begun
    assert killed
    assert whole.rows == both.rows == one.rows
    assert len({row["key"] for row in both.rows}) == count
    assert both.compact().read_bytes() == one.compact().read_bytes()
    times = f"{alone:.1f} s in one process, {two:.1f} s on two workers, {together:.1f} s on two workers of which one was killed"
    print(f"\n{count} questions: {times}")
