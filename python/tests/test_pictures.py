"""Pictures: on the axes given, returned, never shown."""

import jurist
import matplotlib as mpl
import numpy as np
import pytest

mpl.use("agg")
import matplotlib.pyplot as plt


@pytest.fixture
def ax():
    figure, ax = plt.subplots()
    yield ax
    plt.close(figure)


def test_a_set_is_drawn_where_it_is(ax, drive):
    s = drive.intervals("K_pwm")
    assert s.plot(ax, color="tab:red") is ax
    bar = ax.lines[0]
    assert bar.get_color() == "tab:red"
    assert np.allclose(bar.get_xdata(), list(s[0]))
    assert ax.get_xscale() == "log"
    assert ax.get_xlabel() == "K_pwm (V)"


def test_the_current_axes_are_used_where_none_are_given(ax, small):
    assert small.intervals("K").plot() is ax
    assert small.intervals("K").plot(scale="linear").get_xscale() == "linear"


def test_a_map_is_the_stable_region(ax):
    """The triangle of the second order: its area is 4."""
    loop = jurist.Loop.characteristic("z^2 + a*z + b", time="discrete", parameters={"a": 0, "b": 0})
    m = loop.map("a", "b")
    assert m.plot(ax, columns=200) is ax
    area = 0.0
    for path in ax.collections[0].get_paths():
        x, y = path.vertices[:-1].T
        area += 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
    assert area == pytest.approx(4, rel=0.01)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("a", "b")


def test_boxes_are_drawn_as_they_were_proved(ax):
    loop = jurist.Loop.characteristic("z^2 + a*z + b", time="discrete", parameters={"a": 0, "b": 0})
    m = loop.map("a", "b", method="boxes", window={"a": (-3, 3), "b": (-2, 2)}, undecided="0.05")
    assert not m.is_exact
    m.plot(ax)
    def area(label):
        words = [text.get_text() for text in ax.get_legend().get_texts()]
        looks = ax.get_legend().get_patches()[words.index(label)].get_facecolor()
        return sum(p.get_width() * p.get_height() for p in ax.patches if p.get_facecolor() == looks)

    assert 4 - 24 * 0.05 <= area("stable") <= 4 <= area("stable") + area("undecided")


def test_a_locus_has_its_crossings_on_the_boundary(ax, drive):
    locus = drive.locus("K_pwm")
    assert locus.plot(ax) is ax
    looks = {line.get_label(): line for line in ax.lines}
    crossing = looks["crossing, exact"]
    assert np.allclose(np.hypot(crossing.get_xdata(), crossing.get_ydata()), 1)
    for name, points in (("poles", locus.poles), ("zeros", locus.zeros)):
        assert np.allclose(looks[f"{name} of the open loop"].get_xdata(), points.real)
    curves = [line for line in ax.lines if line.get_marker() == "None"]
    assert len(curves) == 1 + len(locus.branches) + len(locus.beyond)
    continuous = jurist.Loop.characteristic("s^3 + 2*s^2 + 3*s + K", time="continuous", parameters={"K": 1})
    assert continuous.locus("K", range=(0, 10)).plot(ax) is ax


def test_a_locus_of_a_gain_goes_on_from_poles_to_zeros():
    locus = jurist.Loop.from_line("K*(s + 3)/(s*(s + 1))").locus("K", range=(1, 2))
    assert sorted(locus.poles.real) == [-1, 0] and list(locus.zeros) == [-3]
    ends = [z for _, roots in locus.beyond for z in (roots[0], roots[-1])]
    assert all(any(abs(z - end) < 1e-9 for end in ends) for z in (*locus.poles, *locus.zeros))
    time = jurist.Loop.characteristic("s^2 + T^2*s + 1", time="continuous", parameters={"T": 1}).locus("T", range=(1, 2))
    assert time.poles is None and time.zeros is None and time.beyond == []


def test_a_response_is_drawn_signal_by_signal(ax, drive):
    r = drive.simulate(duration="0.01")
    r.plot(ax, signals=["omega"])
    assert len(ax.lines) == 1
    assert ax.get_xlabel() == "time (s)"
    assert ax.lines[0].get_drawstyle() == "steps-post"
    ax.clear()
    r.plot(ax)
    assert [line.get_label().split(" ")[0] for line in ax.lines] == [name for name in r.names if name in drive.outputs]


def test_states_are_drawn_where_they_are_named_only(ax):
    """The states of a plant may be much larger than its output."""
    builder = jurist.LoopBuilder("continuous").block("plant", "r - y", "y", "1/(s^2 + s)")
    r = builder.build(inputs=["r"], outputs=["y"]).simulate(duration="5")
    assert len(r.names) > 1
    r.plot(ax)
    assert [line.get_label() for line in ax.lines] == ["y"]
    assert ax.lines[0].get_drawstyle() == "default"
    r.plot(ax, signals=r.names)
    assert len(ax.lines) == 1 + len(r.names)


def test_a_map_shows_the_limits_around_the_nominal_point(ax, drive):
    m = drive.map("T", "K_pwm")
    m.plot(ax, columns=20)
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    lower, upper = (float(end) for end in drive.intervals("K_pwm")[0])
    assert bottom < lower < 110 < upper < top
    assert left < 1e-4 < float(drive.intervals("T")[0].upper) < right
    assert ax.get_yscale() == "log"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["stable", "nominal"]
    assert ax.get_title() == drive.title


def test_a_title_that_is_there_stays(ax, drive):
    ax.set_title("mine")
    drive.intervals("T").plot(ax)
    assert ax.get_title() == "mine"


@pytest.fixture
def third():
    """A gain margin of 8 at sqrt(3) rad/s; stable."""
    return jurist.Loop.from_line("K/(s+1)^3")


def test_bode_takes_two_axes_one_or_none_and_names_the_margins(ax, third):
    response = third.bode(set={"K": 2})
    upper, lower = response.plot(ax)
    assert upper is not ax and lower is not ax and upper.figure is ax.figure
    assert "gain margin 12.04 dB at 0.2757 Hz" in upper.get_title()
    assert any(text.get_text() == "gain margin 4" for text in upper.texts)
    assert any(text.get_text().startswith("phase margin") for text in lower.texts)
    assert any(set(line.get_ydata()) == {-180} for line in lower.lines)
    assert all(round(tick % 15, 9) == 0 for tick in lower.get_yticks())
    figure, pair = plt.subplots(2, 1)
    assert response.plot(pair) == tuple(pair)
    plt.close(figure)
    figure = plt.figure()
    assert len(response.plot()) == 2
    plt.close(figure)
    assert "not stable" in third.bode(set={"K": 9}).plot(ax)[0].get_title()


def test_nyquist_names_the_margins(ax, third):
    third.nyquist(set={"K": 6}).plot(ax)
    assert "phase margin" in ax.get_title()
    assert any(text.get_text().startswith("gain margin") for text in ax.texts)
    assert sum(text.arrow_patch is not None for text in ax.texts) >= 2
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    assert left < -1 and right > 1 and bottom < -1 and top > 1
