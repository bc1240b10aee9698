"""The open loop over frequency, in floating point; what is exact about it is in the margins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ._answers import Document
from ._margins import Margins

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class FrequencyResponse(Document):
    """The loop cut at a signal over frequency.

    Examples
    --------
    >>> import jurist
    >>> b = jurist.Loop.characteristic([1, 3, 3, "1 + k"], time="continuous", parameters={"k": 2}).bode("k")
    >>> b.at, b.hertz, len(b.frequency) == len(b.response), round(float(abs(b.response[0])), 2)
    ('k', True, True, 2.0)
    """

    __slots__ = ()

    @property
    def at(self) -> str:
        """Where the loop is cut."""
        return str(self._document["at"])

    @property
    def hertz(self) -> bool:
        """Whether frequencies are in hertz; else in radians per sample."""
        return bool(self._document["hertz"])

    @property
    def frequency(self) -> Any:
        """The frequencies, an array; of a loop with complex coefficients from the lowest negative one on."""
        return self._array("frequency")

    @property
    def response(self) -> Any:
        """The open loop there, a complex array."""
        import numpy

        points = numpy.array(self._document["response"], dtype=float).reshape(-1, 2)
        return points[:, 0] + 1j * points[:, 1]

    @property
    def phase_degrees(self) -> Any:
        """Its phase, continued from the lowest frequency on, or from 0 in both directions."""
        return self._array("phase_degrees")

    def _array(self, name: str) -> Any:
        import numpy

        return numpy.array(self._document[name], dtype=float)

    def margins(self) -> Margins:
        """The exact margins and crossings of the same loop, cut there."""
        assert self._loop is not None
        asked = self._loop._asked()
        words = ("margins", *self._words[1:])
        return Margins(self._loop._document(words, asked), self._loop, words)


class Bode(FrequencyResponse):
    """Magnitude and phase over frequency."""

    __slots__ = ()

    def plot(self, ax: Axes | Sequence[Axes] | None = None, *, exact: bool = True, **kw: Any) -> tuple[Axes, Axes]:
        """Draws magnitude and phase, one above the other; the title names the margins.

        Parameters
        ----------
        ax : pair of matplotlib Axes, or one, optional
            Where: two, or the place of one, which is divided; two new ones in the current figure if not given.
        exact : bool
            Marks the exact crossings.
        **kw
            For the lines.

        Returns
        -------
        pair of matplotlib Axes
        """
        from ._plot_response import plot_bode

        return plot_bode(self, ax, exact, kw)


class Nyquist(FrequencyResponse):
    """The curve of the open loop around -1."""

    __slots__ = ()

    def plot(self, ax: Axes | None = None, *, exact: bool = True, **kw: Any) -> Axes:
        """Draws the curve and its mirror image, the unit circle and -1; marks the exact crossings; returns the Axes."""
        from ._plot_response import plot_nyquist

        return plot_nyquist(self, ax, exact, kw)
