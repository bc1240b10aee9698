"""The plugin of pytest: what it collects, and how it says what failed."""

import json

import pytest
from conftest import program

pytest_plugins = ["pytester"]

MODEL = """
time = 'discrete'
parameters.K = 1
loop.characteristic = 'z - 1 + K'

[[expect]]

verdict = "stable"
"""

FOUND = {
    "schema": "jurist/test/1",
    "passed": 1,
    "failed": 1,
    "undecided": 1,
    "errors": 0,
    "files": [
        {
            "file": "loop.toml",
            "tests": [
                {"name": "verdict", "status": "passed", "text": "stable", "line": 6},
                {"name": "verdict", "status": "failed", "text": "expected unstable, found stable", "line": 9},
                {"name": "intervals K", "status": "undecided", "text": "the budget ran out", "line": None},
            ],
        }
    ],
}


@pytest.fixture
def answers(monkeypatch):
    """The program's answer in place of the program: status, standard output, standard error."""
    said = {"answer": (1, json.dumps(FOUND), ""), "asked": []}

    def run(arguments):
        said["asked"].append(arguments)
        return said["answer"]

    monkeypatch.setattr("jurist._pytest_plugin.run", run)
    return said


def test_each_expectation_is_a_test(pytester, answers):
    pytester.makefile(".toml", loop=MODEL, pyproject="[project]\nname = 'x'")
    result = pytester.runpytest_inprocess("--jurist", "-v")
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(["*loop.toml::verdict PASSED*", "*loop.toml::verdict (2) FAILED*", "*loop.toml::intervals K FAILED*"])
    result.stdout.fnmatch_lines(["*loop.toml:9: failed: expected unstable, found stable", "*loop.toml: undecided: the budget ran out"])
    assert [arguments[:2] + arguments[3:] for arguments in answers["asked"]] == [["jurist", "test", "--json"]]


def test_nothing_is_collected_unless_it_is_asked_for(pytester, answers):
    pytester.makefile(".toml", loop=MODEL)
    pytester.runpytest_inprocess().assert_outcomes()
    assert answers["asked"] == []


def test_the_configuration_names_files(pytester, answers):
    pytester.makeini("[pytest]\njurist_models = control/*.toml")
    folder = pytester.mkdir("control")
    (folder / "loop.toml").write_text(MODEL)
    pytester.makefile(".toml", other=MODEL)
    pytester.runpytest_inprocess().assert_outcomes(passed=1, failed=2)
    assert [arguments[2].endswith("loop.toml") for arguments in answers["asked"]] == [True]


def test_a_file_that_is_refused_is_an_error_with_the_program_s_words(pytester, answers):
    answers["answer"] = (2, "", "error[E-unknown-name]: unknown name 'k'")
    pytester.makefile(".toml", loop=MODEL)
    result = pytester.runpytest_inprocess("--jurist")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*E-unknown-name*"])


def test_expectations_can_be_chosen_by_name(pytester, answers):
    pytester.makefile(".toml", loop=MODEL)
    pytester.runpytest_inprocess("--jurist", "-k", "intervals").assert_outcomes(failed=1, deselected=2)


def test_the_fixture_reads_models_beside_the_test(pytester, answers):
    pytester.makefile(".toml", loop=MODEL)
    pytester.makepyfile(
        """
        import pytest

        def test_margin(jurist):
            assert str(jurist.load("loop.toml").intervals("K")) == "(0, 2)"
            assert jurist.Loop.drive().time == "discrete"

        def test_all(jurist):
            with pytest.raises(pytest.fail.Exception, match="expected unstable, found stable"):
                jurist.check("loop.toml")
        """
    )
    pytester.runpytest_inprocess().assert_outcomes(passed=2)


@pytest.mark.skipif(program("test", "--help").returncode != 0, reason="this program has no command 'test'")
def test_the_program_itself(pytester):
    pytester.makefile(".toml", good=MODEL, wrong=MODEL.replace('verdict = "stable"', 'verdict = "unstable"'))
    pytester.runpytest_inprocess("--jurist", "good.toml").assert_outcomes(passed=1)
    pytester.runpytest_inprocess("--jurist", "wrong.toml").assert_outcomes(failed=1)


def test_the_program_s_output_does_not_leave_the_run(capfd):
    from jurist._pytest_plugin import run

    status, output, said = run(["jurist", "--version"])
    assert (status, said) == (0, "")
    assert output.startswith("jurist ")
    assert capfd.readouterr().out == ""
