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
    area = sum(p.get_width() * p.get_height() for p in ax.patches)
    assert 4 - 24 * 0.05 <= area <= 4


def test_a_locus_has_its_crossings_on_the_boundary(ax, drive):
    locus = drive.locus("K_pwm")
    assert locus.plot(ax) is ax
    dots = [line for line in ax.lines if line.get_marker() == "o"]
    assert np.allclose(np.hypot(dots[0].get_xdata(), dots[0].get_ydata()), 1)
    assert len([line for line in ax.lines if line.get_marker() != "o"]) == 1 + len(locus.branches)
    continuous = jurist.Loop.characteristic("s^3 + 2*s^2 + 3*s + K", time="continuous", parameters={"K": 1})
    assert continuous.locus("K", range=(0, 10)).plot(ax) is ax


def test_a_response_is_drawn_signal_by_signal(ax, drive):
    r = drive.simulate(duration="0.01")
    r.plot(ax, signals=["omega"])
    assert len(ax.lines) == 1
    assert ax.get_xlabel() == "time (s)"
