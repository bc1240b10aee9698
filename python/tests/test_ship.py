"""Controllers as they are stored: the program's document, and what it is read as."""

import json
import pickle
import re
import shutil
import subprocess
from fractions import Fraction

import jurist
import pytest
from conftest import ROOT, program

PI = """
time = "discrete"
[parameters]
K = { nominal = 1, min = 0, unit = "V" }
[loop]
inputs = ["r", "d"]
outputs = ["y"]
[[block]]
name = "controller"
input = "r - y"
output = "u"
transfer = "(0.5*z - 0.4999)/(z - 1)"
[[block]]
name = "plant"
input = "u + d"
output = "y"
transfer = "0.1*K/(z - 0.9)"
"""

WORDS = ["--block=controller", "--format=Q2.14", "--signal=Q8.14", "--input", "r=1", "--param=K", "--fewest"]


@pytest.fixture(scope="module")
def loop() -> jurist.Loop:
    return jurist.Loop.from_toml(PI)


@pytest.fixture(scope="module")
def ship(loop) -> jurist.Ship:
    return loop.ship("controller", format="Q2.14", signal="Q8.14", inputs={"r": 1}, param="K", fewest=True)


def run(*words, model=PI):
    return program("ship", "-", *words, stdin=model)


def test_the_document_and_the_text_are_those_of_the_program(ship):
    assert ship.json() == run(*WORDS, "--json", "-q").stdout
    assert ship.document == json.loads(ship.json())
    assert str(ship) == run(*WORDS, "-q").stdout.rstrip()


def test_every_option_is_one_of_the_program(loop):
    found = loop.ship("controller", {"K": "1/2"}, format="Q2.14", realisation="df2t", round="floor", phase_margin="45 deg", at="u", radius="0.99995", digits=6)
    words = ["--block=controller", "--format=Q2.14", "--realisation=df2t", "--round=floor", "--phase-margin=45 deg", "--at=u", "--radius=0.99995", "--digits=6"]
    assert found.json() == run("--set", "K=1/2", *words, "--json", "-q").stdout
    assert (found.realisation, found.format.round, found.point) == ("df2t", "floor", {"K": Fraction(1, 2)})


def test_what_the_model_says_need_not_be_said():
    said = PI + "[ship]\nblock = 'controller'\nformat = 'Q2.14'\nsignal = 'Q8.14'\ninputs = { r = 1 }\nsaturate = true\n"
    found = jurist.Loop.from_toml(said).ship()
    assert (found.block, found.overflow, found.holds) == ("controller", "saturate", True)
    assert found.json() == run("--json", "-q", model=said).stdout


def test_the_numbers_are_exact(ship):
    b0, b1 = ship.coefficients["b"]
    assert b0 == jurist.Coefficient("b0", Fraction(1, 2), Fraction(1, 2), 8192, "0x02000")
    assert b1 == jurist.Coefficient("b1", Fraction(-4999, 10000), Fraction(-8190, 2**14), -8190, "0x1e002")
    assert ship.coefficients["a"][0] == jurist.Coefficient(None, Fraction(1), Fraction(1), None, None)
    assert (ship.format.bits, ship.format.fraction, ship.signal.bits, ship.realisation) == (17, 14, 23, "df1")
    assert (ship.stable, ship.holds, bool(ship), ship.changes) == (True, True, True, [])
    # The sum b0 + b1 is 1e-4: every rounding within e on both sides holds while 2e is less.
    assert ship.every_rounding.factor.lower < Fraction("1e-4") / Fraction(1, 2**14) <= ship.every_rounding.factor.upper
    assert ship.every_rounding.holds is True
    assert ship.fewest.every_rounding == 14
    assert ship.fewest.refuted == 13
    assert [signal.node for signal in ship.ranges] == ["u", "y"]
    for signal in ship.ranges:
        assert signal.holds is True
        assert signal.greatest[0] <= signal.greatest[1] <= signal.bound <= signal.limit
    assert ship.limit_cycle["y"] > 0


def test_numbers_that_are_not_rational_have_bounds():
    found = jurist.Loop.from_toml(PI.replace("0.4999", "exp(-7/10)")).ship("controller", format="float32")
    low, high = found.coefficients["b"][1].exact
    assert low < high < low + Fraction(1, 10**9)
    assert abs(found.coefficients["b"][1].stored - low) < Fraction(1, 2**24)
    assert (found.coefficients["b"][0].integer, found.coefficients["b"][0].hex) == (None, "0x3f000000")
    assert (found.format.fraction, found.fewest, found.limits, found.exact_limits) == (None, None, [], None)


def test_limits_by_bits_are_those_of_the_models(loop, ship):
    assert ship.exact_limits[0].upper.value == loop.intervals("K")[0].upper.value
    assert (ship.exact_limits.unit, ship.exact_limits.domain) == ("V", (0, None))
    bits = [bits for bits, _ in ship.limits]
    assert bits == sorted(bits)
    own = dict(ship.limits)[14]
    assert own[0].upper.value == ship.rounded_model().intervals("K")[0].upper.value


def test_parts_know_their_questions(loop, ship):
    rounded = ship.rounded_model()
    assert str(ship.verdict) == str(rounded.verdict()) == "stable: 2 inside"
    assert str(ship.exact_verdict) == str(loop.verdict())
    assert jurist.verify(rounded, ship.verdict.certificate()).kind == "verdict"
    assert str(ship.margins) == str(rounded.margins("u"))
    assert ship.margins.modulus.value.decimal(40) == rounded.margins("u").modulus.value.decimal(40)
    again = ship.every_rounding_model().tolerance()
    assert again.box == ship.every_rounding.box
    assert str(ship.every_rounding) == str(again)


def test_every_rounding_is_about_the_coefficients_alone():
    model = PI.replace("nominal = 1,", "nominal = 1, tolerance = '20%',").replace("0.9)", "p)") + "[constants]\np = { value = 0.9, tolerance = '1%' }\n"
    found = jurist.Loop.from_toml(model).ship("controller", format="Q2.14")
    assert set(found.every_rounding.box) == {"ship_b0", "ship_b1"}
    alone = found.every_rounding_model().tolerance(fix=["K", "p"])
    assert alone.box == found.every_rounding.box
    assert str(found.every_rounding) == str(alone)
    assert set(found.every_rounding_model().tolerance().box) == {"ship_b0", "ship_b1", "K", "p"}


def test_a_controller_that_is_not_right_is_an_answer(loop):
    lost = loop.ship("controller", format="Q2.12")
    assert (lost.stable, lost.holds, bool(lost), lost.verdict.verdict, lost.exact_verdict.verdict) == (False, False, False, "marginal", "stable")
    assert "integral action is lost" in lost.changes[0]
    assert (lost.margins.stable, lost.every_rounding.holds, lost.ranges) == (False, False, [])
    too_far = loop.ship("controller", format="Q2.14", signal="Q1.14", inputs={"r": 50})
    assert (too_far.stable, too_far.holds, too_far.ranges[0].holds) == (True, False, False)
    assert "does not hold" in repr(too_far)
    (missed,) = loop.ship("controller", format="Q2.14", phase_margin="170 deg", at="u").requirements
    assert (missed.name, missed.met) == ("phase_margin", False)


def test_a_range_that_is_not_decided_is_an_answer(ship, monkeypatch):
    document = ship.to_dict()
    document["ranges"][0]["holds"] = None
    error = jurist.Undecided("undecided")
    error.document = json.dumps(document)

    def stopped(loop, words, asked):
        # The program writes the models and ends with the status 3.
        for word in words:
            if word.endswith(("written0", "written1")):
                open(word, "w").close()
        raise error

    monkeypatch.setattr(jurist.Loop, "_document", stopped)
    found = jurist.Loop.from_toml(PI).ship("controller", format="Q2.14")
    assert (found.stable, found.holds, bool(found), repr(found)) == (True, None, False, "<Ship controller: stable with 17 bits, open>")
    error.document = json.dumps(document | {"undecided": {"budget": "time"}})
    with pytest.raises(jurist.Undecided):
        jurist.Loop.from_toml(PI).ship("controller", format="Q2.14")


def test_code_is_that_of_the_program(ship, tmp_path):
    run(*WORDS, "--c", str(tmp_path / "c"), "--st", str(tmp_path / "st"), "--rust", str(tmp_path / "rust"), "--rounded", str(tmp_path / "rounded"))
    without_name = re.compile(r"of the model .*")
    for name, text in (("c", ship.c()), ("st", ship.st()), ("rust", ship.rust())):
        written = (tmp_path / name).read_text()
        assert without_name.sub("", text) == without_name.sub("", written)
    assert ship.rounded_model().to_toml() == (tmp_path / "rounded").read_text()
    if compiler := shutil.which("cc"):
        (tmp_path / "one.c").write_text(ship.c())
        subprocess.run([compiler, "-std=c99", "-Wall", "-fsyntax-only", tmp_path / "one.c"], check=True)


def test_what_cannot_be_is_refused_with_what_to_do(loop):
    with pytest.raises(jurist.QuestionError, match="which block is the controller") as caught:
        loop.ship(format="Q2.13")
    assert (caught.value.code, "controller, plant" in caught.value.help) == ("E-ship-block", True)
    with pytest.raises(jurist.QuestionError, match="unknown number format"):
        loop.ship("controller", format="Q2")
    with pytest.raises(jurist.QuestionError, match="the loop has no input 'q'") as caught:
        loop.ship("controller", format="Q2.13", inputs={"q": 1})
    # No file that nobody named is quoted.
    assert "--input q=1" in str(caught.value)
    assert "written" not in str(caught.value)
    with pytest.raises(TypeError, match="unexpected keyword"):
        loop.ship("controller", form="Q2.13")
    with pytest.raises(jurist.Undecided):
        loop.ship("controller", format="Q2.14", timeout=0)


def test_answers_travel(ship):
    again = pickle.loads(pickle.dumps(ship))
    assert again == ship
    assert again.c() == ship.c()
    assert str(again.margins) == str(ship.margins)
    assert "8192" in ship._repr_html_()


def test_numbers_from_other_files_are_taken_along(tmp_path):
    (tmp_path / "gains.h").write_text("#define K_P 0.5f\n")
    (tmp_path / "loop.toml").write_text(PI.replace("0.5*z", "K_p*z") + '[constants]\nK_p = { from = "gains.h#K_P" }\n')
    found = jurist.Loop.from_file(tmp_path / "loop.toml").ship("controller", format="Q2.14")
    assert found.coefficients["b"][0].stored == Fraction(1, 2)
    assert found.rounded_model().verdict().verdict == "stable"


def test_the_drive_behind_a_hold_is_answered():
    found = jurist.Loop.from_file(ROOT / "examples" / "drive-hold.toml").ship("speed controller", format="Q4.11", signal="Q8.16", inputs={"omega_ref": 80})
    assert (found.stable, found.every_rounding.holds, found.every_rounding.factor.decimal) == (True, True, "1.02391815185")
    assert [c.integer for c in found.coefficients["b"]] == [None, 2049, -2047]
