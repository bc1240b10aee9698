"""What a well-mannered extension does: threads, forks, interrupts, panics, pickles, imports, types."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import jurist
import pytest
from conftest import ROOT

HARD = """
time = "discrete"
[parameters]
a = { nominal = 1 }
b = { nominal = 1 }
[loop]
characteristic = "z^40 + a*z^39 + (a*b + 1/7)*z^31 + (a^3 - b^2)*z^23 + b^5*z^12 + (a + b)^4*z^5 + a^2*b^3*z + 1/3 + a*b"
"""
"""A model of which a map takes far longer than any test."""


def run(code, **environment):
    """Runs Python in a process of its own."""
    environment = {**os.environ, **environment}
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, env=environment, timeout=120, check=False
    )


def ends(loop):
    """What a worker is asked."""
    return [str(i) for i in loop.intervals("K_pwm")]


EXPECTED = ["(0.0381005333483, 550.941166687)"]


def test_a_panic_is_an_ordinary_exception_and_says_nothing_on_standard_error(capfd):
    with pytest.raises(jurist.InternalError, match="a defect on purpose") as caught:
        jurist._jurist.defect()
    assert isinstance(caught.value, RuntimeError)
    assert not type(caught.value).__name__.startswith("Panic")
    assert capfd.readouterr() == ("", "")


def test_answers_after_a_fork_and_in_the_parent_too():
    """A pool's threads do not survive a fork; work that needs several of them would wait for ever."""
    jurist.set_threads(3)
    try:
        assert ends(jurist.Loop.drive()) == EXPECTED
        with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("fork")) as pool:
            futures = [pool.submit(ends, jurist.Loop.drive()) for _ in range(4)]
            assert [f.result(timeout=60) for f in futures] == [EXPECTED] * 4
            areas = pool.submit(map_of_two, 3).result(timeout=60)
        assert ends(jurist.Loop.drive()) == EXPECTED
        assert areas == map_of_two(3)
    finally:
        jurist.set_threads(None)


def map_of_two(threads):
    """A map is decided on several threads."""
    jurist.set_threads(threads)
    loop = jurist.Loop.characteristic("z^3 + a*z^2 + b*z + 1/5", time="discrete", parameters={"a": 0, "b": 0})
    return loop.map("a", "b").json()


def test_the_number_of_threads_changes_no_answer():
    assert map_of_two(1) == map_of_two(4)
    assert jurist.threads() == 4
    jurist.set_threads(None)
    with pytest.raises(ValueError, match="at least one"):
        jurist.set_threads(0)
    done = run("import jurist; print(jurist.threads())", JURIST_NUM_THREADS="3")
    assert done.stdout == "3\n"


@pytest.mark.parametrize("start", ["spawn", "forkserver"])
def test_loops_and_answers_travel_between_processes(start):
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context(start)) as pool:
        answer = pool.submit(jurist.Loop.intervals, jurist.Loop.drive(), "K_pwm").result(timeout=120)
    assert answer == jurist.Loop.drive().intervals("K_pwm")
    assert answer.certificate() == jurist.Loop.drive().intervals("K_pwm").certificate()


def test_loops_and_answers_travel_through_loky_and_cloudpickle():
    import cloudpickle
    from loky import get_reusable_executor

    executor = get_reusable_executor(max_workers=1)
    assert executor.submit(lambda loop: [str(i) for i in loop.intervals("K_pwm")], jurist.Loop.drive()).result(timeout=120) == EXPECTED
    executor.shutdown(wait=True)
    assert cloudpickle.loads(cloudpickle.dumps(jurist.Real)) is jurist.Real


def test_loops_answers_and_errors_travel_to_a_worker_of_dask_and_back(drive):
    from distributed import Client, LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        there = client.submit(jurist.Loop.intervals, drive, "K_pwm").result(timeout=120)
        assert there == drive.intervals("K_pwm")
        assert client.submit(there.__contains__, "550.94").result(timeout=120)
        with pytest.raises(jurist.QuestionError, match="did you mean 'K_pwm'"):
            client.submit(jurist.Loop.intervals, drive, "K_pmw").result(timeout=120)


def test_everything_that_is_answered_can_be_pickled(drive):
    things = [
        drive,
        drive.intervals("K_pwm"),
        drive.intervals("K_pwm")[0],
        drive.intervals("K_pwm")[0].upper,
        drive.intervals("K_pwm")[0].upper.value,
        drive.verdict(),
        drive.analyze(),
        drive.jury("T"),
        drive.charpoly(),
        drive.locus("K_pwm"),
    ]
    for thing in things:
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            again = pickle.loads(pickle.dumps(thing, protocol))
            assert again == thing
            assert type(again) is type(thing)
    for wrong in ("K_pmw", "radius!"):
        with pytest.raises(jurist.QuestionError) as caught:
            drive.intervals(wrong)
        again = pickle.loads(pickle.dumps(caught.value))
        assert (str(again), again.code, again.help) == (str(caught.value), caught.value.code, caught.value.help)


INSIDE = """
import _thread, jurist, signal, sys, threading, time

# What runs in the background of a shell is deaf to interrupts, and so are the processes it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)

def inside():
    "Whether the main thread has begun to ask the engine."
    frame = sys._current_frames().get(threading.main_thread().ident)
    while frame is not None and frame.f_code.co_name != "_command":
        frame = frame.f_back
    return frame is not None

def when_inside(act):
    def wait():
        while not inside():
            time.sleep(0.001)
        act()
    threading.Thread(target=wait, daemon=True).start()
"""
"""What a thread needs to act while the main thread is at work."""


def test_an_interrupt_ends_a_question():
    """The question runs for hours, so that only the interrupt can end it; how fast it does is printed."""
    code = f"""
import os, signal
loop = jurist.Loop.from_toml({HARD!r})
sent = []
def interrupt():
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
try:
    when_inside(interrupt)
    loop.map("a", "b")
except KeyboardInterrupt:
    print("interrupted after", round(time.perf_counter() - sent[0], 3), "s")
print(jurist.Loop.drive().intervals("K_pwm"))
"""
    done = run(INSIDE + code)
    assert done.stdout.startswith("interrupted after"), done
    assert done.stdout.splitlines()[1] == EXPECTED[0]
    print(done.stdout)


def test_a_listener_that_raises_ends_the_question():
    loop = jurist.Loop.from_toml(HARD)
    steps = []

    def listener(step, share):
        steps.append((step, share))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        loop.map("a", "b", progress=listener)
    assert steps


def test_a_question_without_time_is_undecided_and_says_how_far_it_came():
    loop = jurist.Loop.from_toml(HARD)
    with pytest.raises(jurist.Undecided) as caught:
        loop.map("a", "b", timeout=0.3)
    assert isinstance(caught.value, TimeoutError)
    assert (caught.value.budget, caught.value.code) == ("time (0.3 s)", "undecided")
    assert caught.value.reached
    with pytest.raises(jurist.Undecided) as caught:
        loop.intervals("a", timeout=0)
    assert '"undecided"' in caught.value.document
    assert '"stable": null' in caught.value.document


def test_the_interpreter_goes_on_while_a_question_is_answered():
    """The GIL is released: another thread counts while the engine works, and ends the work, which has no end of its own."""
    code = f"""
loop = jurist.Loop.from_toml({HARD!r})
counted = []
def count():
    # Far longer than a thread keeps the interpreter that another one waits for.
    for k in range(10**6):
        counted.append(k)
    print(len(counted), inside())
    _thread.interrupt_main()
try:
    when_inside(count)
    loop.map("a", "b")
except KeyboardInterrupt:
    print("ended")
"""
    assert run(INSIDE + code).stdout == "1000000 True\nended\n"


def test_many_threads_ask_at_the_same_time(drive):
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda _: ends(drive), range(64)))
    assert found == [EXPECTED] * 64


def test_a_question_that_is_given_up_takes_no_other_with_it(drive):
    """A thread that waits for a part of one question takes up another: the first one's budget is none of the second's."""
    loop = jurist.Loop.from_toml(HARD)

    def give_up(k):
        with pytest.raises(jurist.Undecided):
            loop.map("a", "b", timeout=0.05 + 0.01 * k)

    jurist.set_threads(2)
    try:
        with ThreadPoolExecutor(6) as pool:
            hard = [pool.submit(give_up, k) for k in range(20)]
            easy = [pool.submit(map_of_two_here, drive) for _ in range(20)]
            assert {f.result() for f in easy} == {map_of_two_here(drive)}
            for f in hard:
                f.result()
    finally:
        jurist.set_threads(None)


def map_of_two_here(loop):
    """A question with parts on several threads."""
    return str(loop.analyze())


def test_errors_have_the_programs_text_code_and_place():
    with pytest.raises(jurist.ModelError) as caught:
        jurist.Loop.from_toml("time = 'discrete'\n[loop]\ncharacteristic = 'z - Q + R'", name="model.toml")
    assert isinstance(caught.value, ValueError)
    codes = [d.code for d in caught.value.diagnostics]
    assert caught.value.code == codes[0]
    assert len(codes) >= 2
    assert "--> model.toml:3:23" in str(caught.value)
    assert caught.value.labels[0].line == 3
    with pytest.raises(jurist.QuestionError, match="E-unknown-parameter") as caught:
        jurist.Loop.drive().intervals("K_pmw")
    assert caught.value.help == "did you mean 'K_pwm'?"
    with pytest.raises(jurist.QuestionError, match="E-empty-domain"):
        jurist.Loop.drive().intervals("T", domain=(2, 1))
    with pytest.raises(jurist.QuestionError):
        jurist.Loop.drive().command("intervals", "--parm", "T")
    with pytest.raises(FileNotFoundError):
        jurist.Loop.from_file("nowhere.toml")
    for code in codes:
        assert jurist.explain(code)
    with pytest.raises(KeyError):
        jurist.explain("E-nothing")


def test_remarks_are_warnings_with_a_code(drive):
    with pytest.warns(jurist.JuristWarning) as caught:
        drive.verdict({"K_pwm": -1})
    assert caught[0].message.code.startswith("W-")
    with pytest.warns(jurist.JuristWarning, match="W-unused"):
        jurist.Loop.from_toml("time = 'discrete'\nconstants.c = 1\nparameters.K = {}\nloop.characteristic = 'z - K'")


def test_a_rejected_certificate_names_the_step(small):
    certificate = small.intervals("K").certificate()
    assert jurist.verify(small, certificate).kind == "intervals"
    with pytest.raises(jurist.CertificateRejected) as caught:
        jurist.verify(small, certificate.replace('"2"', '"3"'))
    assert caught.value.step in ("stable", "line", "factors", "statement", "boundary", "characteristic", "format")
    assert jurist.verify(small, small.verdict().certificate()).kind == "verdict"
    assert jurist.verify(small, small.verdict(radius="0.9").certificate()).kind == "verdict"


def test_the_import_is_light():
    """Nothing that is optional is imported with the package."""
    heavy = "numpy pandas pyarrow sympy control matplotlib tqdm flint mpmath tempfile asyncio dataclasses inspect tomllib".split()
    done = run(f"import sys, jurist; print([m for m in {heavy!r} if m in sys.modules])")
    assert done.stdout == "[]\n", done
    assert set(dir(jurist)) >= set(jurist.__all__)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = jurist.nothing
    assert jurist.from_control is jurist._control.from_control


def test_the_program_comes_with_the_package():
    done = subprocess.run([sys.executable, "-m", "jurist", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout == f"jurist {jurist.__version__}\n"
    done = subprocess.run([sys.executable, "-m", "jurist", "verdict", "--set", "K_pwm=555"], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    done = subprocess.run([sys.executable, "-m", "jurist", "intervals"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "error[E-usage]" in done.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupt_ends_the_program_at_once(tmp_path):
    model = tmp_path / "hard.toml"
    model.write_text(HARD)
    command = [sys.executable, "-m", "jurist", "map", str(model), "-x", "a", "-y", "b", "--verbose"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        # The first step has been said: the program is at work, and would be for hours.
        assert process.stderr.readline()
        process.send_signal(signal.SIGINT)
        assert process.wait() == -signal.SIGINT


def test_the_module_does_not_bring_the_gil_back():
    """Only a free-threaded interpreter can show it."""
    import sysconfig

    if not sysconfig.get_config_var("Py_GIL_DISABLED"):
        pytest.skip("this interpreter has a GIL in any case")
    assert run("import jurist, sys; print(sys._is_gil_enabled())").stdout == "False\n"


def test_pages_use_the_colour_of_their_surroundings(drive):
    """GitHub takes style elements away, and a dark page has light text."""
    for page in (drive.intervals("K_pwm")._repr_html_(), drive._repr_html_(), drive.analyze()._repr_html_()):
        assert "<style" not in page
        assert "class=" not in page
        for colour in ("#000", "black", "white", "#fff", "background"):
            assert colour not in page
    page = drive.intervals("K_pwm")._repr_html_()
    assert "currentColor" in page
    assert 'aria-label="stable values of K_pwm' in page
    never = jurist.Loop.characteristic("z^2 + K^2 + 2", time="discrete", parameters={"K": 1}).intervals("K")
    assert "never stable" in never._repr_html_()
    assert str(never) == "never stable"


def test_names_from_a_model_are_not_taken_for_html():
    text = 'title = "<script>"\ntime = "discrete"\nparameters.K = { unit = "<b>" }\nloop.characteristic = "z - K"'
    loop = jurist.Loop.from_toml(text)
    for page in (loop._repr_html_(), loop.intervals("K")._repr_html_(), loop.report()._repr_html_()):
        assert "<script>" not in page
        assert "<b>" not in page.replace("<b>&lt;script&gt;</b>", "")


def mypy(folder, *words):
    """Asks in an empty folder, where the package is the installed one."""
    command = [sys.executable, "-m", *words, str(ROOT / "python" / "pyproject.toml")]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)


def test_stubs_are_those_of_the_module(tmp_path):
    done = mypy(tmp_path, "mypy.stubtest", "jurist._jurist", "--mypy-config-file")
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_strict(tmp_path):
    done = mypy(tmp_path, "mypy", "--strict", "-p", "jurist", "--config-file")
    assert done.returncode == 0, done.stdout


def test_every_warning_filter_is_put_back(drive):
    before = list(warnings.filters)
    pickle.loads(pickle.dumps(jurist.Loop.from_toml(drive.to_toml())))
    assert warnings.filters == before
