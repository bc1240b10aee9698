"""Set operations, against membership as the oracle."""

import math
import pickle
from fractions import Fraction

import jurist
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jurist import Real


def stable(polynomial, domain=(None, None)):
    """The set where a polynomial in K is positive: a loop of degree one whose root is minus that polynomial."""
    return jurist.Loop.characteristic(f"s + ({polynomial})", time="continuous", parameters={"K": 0}).intervals("K", domain=domain)


SETS = [
    stable("K"),
    stable("2 - K^2"),
    stable("K^2 - 2"),
    stable("(K^2 - 2)*(K^2 - 3)"),
    stable("K^2"),
    stable("K^2 + 1"),
    stable("-1 - K^2"),
    stable("K*(K - 1)^2*(3 - K)"),
    stable("(K^2 - 2)^2"),
]
POINTS = sorted(
    {x for s in SETS for i in s for end in (i.lower, i.upper) if end for x in (end.value,)}
    | {Real(Fraction(k, 4)) for k in range(-16, 17)}
)


@settings(deadline=None, max_examples=200)
@given(st.sampled_from(SETS), st.sampled_from(SETS), st.sampled_from(POINTS))
def test_operations_are_those_of_membership(a, b, x):
    assert (x in (a & b)) == (x in a and x in b)
    assert (x in (a | b)) == (x in a or x in b)
    assert (x in (a - b)) == (x in a and x not in b)
    assert (x in (a ^ b)) == ((x in a) != (x in b))
    assert (x in ~a) == (x not in a)


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(SETS), st.sampled_from(SETS))
def test_the_laws_of_sets(a, b):
    assert ~~a == a
    assert ~(a & b) == ~a | ~b
    assert (a - b) | (a & b) == a
    assert a ^ b == (a | b) - (a & b)
    assert hash(~~a) == hash(a)


def test_a_set_of_intervals_that_touch_leaves_the_point_out():
    s = stable("K^2")
    assert str(s) == "(-inf, 0), (0, inf)"
    assert 0 not in s
    assert str(~s) == "[0, 0]"
    assert s | ~s == ~(s & ~s)


def test_the_complement_stays_inside_the_domain():
    s = stable("2 - K", domain=(1, 3))
    assert str(s) == "(1, 2)"
    assert str(~s) == "[2, 3)"
    assert ~~s == s
    assert (~s)[0].upper.causes == {jurist.Cause.DOMAIN}


def test_ends_know_their_causes_and_those_of_both_sets_where_they_meet(drive):
    a = drive.intervals("K_pwm")
    b = drive.intervals("K_pwm", domain=(a[0].lower.value.enclosure(5)[0], 100))
    c = a & b
    assert c[0].lower.causes == {jurist.Cause.PAIR}
    assert c[0].upper.causes == {jurist.Cause.DOMAIN}


def test_sets_of_two_parameters_are_not_combined(drive):
    with pytest.raises(ValueError, match="not combined"):
        drive.intervals("T") & drive.intervals("K_pwm")
    with pytest.raises(TypeError):
        drive.intervals("T") & 3


def test_membership_is_exact_and_takes_numbers_as_the_model_file_does(drive):
    s = drive.intervals("T", domain=(0, "0.1"))
    assert 1e-4 in s
    assert "1/10000" in s
    two = stable("2 - K^2")
    assert math.sqrt(2) not in two
    assert 1.414213562373095 in two
    assert Real.root((-2, 0, 1), 1, 2) not in two
    with pytest.raises(TypeError):
        two[0] in two  # noqa: B015


def test_an_item_has_the_type_of_an_interval():
    said = jurist.StableSet.__getitem__.__annotations__
    assert said == {"i": "int | slice", "return": "Interval | tuple[Interval, ...]"}


def test_sequence_sample_nearest_and_rows(drive):
    s = stable("(K^2 - 2)*(K^2 - 3)")
    assert len(s) == 3
    assert [str(i) for i in s[1:]] == [str(s[1]), str(s[2])]
    inside = s.sample(7)
    assert len(inside) == len(set(inside)) == 7
    assert inside[:3] == [-2, 0, 2]
    assert all(x in s for x in inside)
    assert s.nearest_end("1.41").value == Real.root((-2, 0, 1), 1, 2)
    assert s.nearest_end(-100).value == Real.root((-3, 0, 1), -2, 0)
    assert len(s.rows()) == 6
    with pytest.raises(ValueError, match="no ends"):
        stable("K^2 + 1").nearest_end(1)
    with pytest.raises(ValueError, match="nominal"):
        jurist.Loop.characteristic("s + K", time="continuous", parameters=["K"]).intervals("K").nearest_end()


def test_arrow_and_pandas_see_the_same_rows(drive):
    import pyarrow

    s = drive.intervals("K_pwm")
    table = pyarrow.table(s)
    assert table.column("decimal").to_pylist() == list(s.to_frame()["decimal"])
    assert table.column("value").to_pylist() == [float(s[0].lower), float(s[0].upper)]


def test_a_derived_set_has_no_certificate(drive):
    s = drive.intervals("K_pwm")
    with pytest.raises(ValueError, match="no certificate"):
        (s | s).certificate()
    assert '"stable"' in (s | s).json()


def test_ends_of_a_derived_set_are_as_those_of_a_document():
    document = (~stable("K^2 - 2")).to_dict()["stable"][0]
    assert document["lower"]["polynomial"] == ["-2", "0", "1"]
    assert document["lower"]["closed"] is True
    assert document["lower"]["cause"] == "s=0"


def test_a_line_is_a_loop_and_values_go_by_the_word_of_the_program(drive):
    assert str(jurist.Loop.from_line("K/(s(s+1))", hold="T").intervals("K", set={"T": 1})) == "(0, 2.39221119118)"
    assert str(jurist.Loop.from_line("K/(s+1)", delay=1).intervals("K")) == "(-1, 2.26182633411)"
    assert repr(jurist.Loop.from_line("K/(s+1)", hold="1/2")) == "Loop.from_line('K/(s+1)', hold='1/2')"
    assert pickle.loads(pickle.dumps(jurist.Loop.from_line("z^2 + z + K"))) == jurist.Loop.from_line("z^2 + z + K")
    with pytest.raises(jurist.ModelError, match="two ways"):
        jurist.Loop.from_line("K/s(s+1)")
    assert drive.intervals("T", set={"K_pwm": 200}) == drive.intervals("T", {"K_pwm": 200})
    assert drive.bode(set={"K_pwm": 200}).to_dict() == drive.bode(values={"K_pwm": 200}).to_dict()
    with pytest.raises(TypeError, match="two values"):
        drive.verdict({"T": "1e-4"}, set={"T": "2e-4"})
    assert not {"Any", "os", "annotations"} & set(dir(jurist))
