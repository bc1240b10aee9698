"""Roots of closed loops."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Root:
    """A root of the closed loop, or a pair of conjugate roots of which this is the upper one.

    Attributes
    ----------
    re, im : str
        Real and imaginary part, with as many digits as were asked for and are certain.
    re_enclosure, im_enclosure : pair of fractions.Fraction
        Certified bounds.
    is_pair : bool
        Whether the conjugate number is a root as well.
    multiplicity : int
        How often it is a root.
    is_one : bool
        False where several roots that are not told apart lie within the enclosures.
    magnitude, damping, natural_frequency, natural_frequency_hz : float or None
        Rounded; the frequency in radians per second, and in hertz.
    """

    re: str
    im: str
    re_enclosure: tuple[Fraction, Fraction]
    im_enclosure: tuple[Fraction, Fraction]
    is_pair: bool
    multiplicity: int
    is_one: bool
    magnitude: float | None
    damping: float | None
    natural_frequency: float | None
    natural_frequency_hz: float | None

    @property
    def value(self) -> complex:
        """The nearest complex number in floating point."""
        re, im = (float(sum(bounds) / 2) for bounds in (self.re_enclosure, self.im_enclosure))
        return complex(re, im)


class Roots(list[Root]):
    """The roots of a closed loop, the slowest first: a list of `Root`, and how far they are listed.

    Attributes
    ----------
    others_left_of : fractions.Fraction or None
        Of a loop with dead time, which has infinitely many roots: no root that is not listed has this real part or a greater one. None where
        all roots are listed.
    chain : pair of fractions.Fraction or None
        Of a loop of neutral type: certified bounds of the real part of a line that infinitely many roots come as near to as one likes.
    """

    def __init__(
        self,
        roots: Iterable[Root] = (),
        others_left_of: Fraction | None = None,
        chain: tuple[Fraction, Fraction] | None = None,
    ) -> None:
        super().__init__(roots)
        self.others_left_of = others_left_of
        self.chain = chain


def roots_of(text: str) -> Roots:
    """The roots of a document `jurist/roots/1`."""
    document = json.loads(text)
    roots = [
        Root(
            re=root["re"],
            im=root["im"],
            re_enclosure=_bounds(root["re_enclosure"]),
            im_enclosure=_bounds(root["im_enclosure"]),
            is_pair=root["pair"],
            multiplicity=root["multiplicity"],
            is_one=root["one"],
            magnitude=root["magnitude"],
            damping=root["damping"],
            natural_frequency=root["natural_frequency"],
            natural_frequency_hz=root["natural_frequency_hz"],
        )
        for root in document["roots"]
    ]
    line, chain = document.get("others_left_of"), document.get("chain")
    return Roots(roots, None if line is None else Fraction(line), None if chain is None else _bounds(chain))


def _bounds(texts: list[str]) -> tuple[Fraction, Fraction]:
    low, high = map(Fraction, texts)
    return low, high
