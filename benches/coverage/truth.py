"""What is true of a loop's numbers, as far as floating point tells: `None` where it is too close."""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

CLOSE = 1e-6


def closed_roots(n):
    """The roots of the closed loop, without dead time."""
    return np.roots(np.polyadd(n.den, n.num))


def count_right(n, decay):
    """How many roots of den + num exp(-tau s) lie right of -decay; None where that is not told."""
    order = len(n.den) - 1
    lead = abs(n.num[0] / n.den[0]) * np.exp(n.tau * decay) if len(n.num) == len(n.den) else 0.0
    if lead > 1 - 1e-3:
        return 99 if lead > 1 + 1e-3 else None
    top = 1e3
    while top < 1e7:
        s = 1j * top - decay
        ratio = abs(np.polyval(n.num, s) / np.polyval(n.den, s)) * np.exp(n.tau * decay)
        if ratio < lead + 0.02:
            break
        top *= 2
    step = min(0.01, 0.05 / max(n.tau, 1e-3))
    w = np.concatenate([np.linspace(0, 300, int(300 / step)), np.geomspace(300, top, 20000 + int(min(top, 1e4) * n.tau * 20))[1:]])
    s = 1j * w - decay
    f = np.polyval(n.den, s) + np.polyval(n.num, s) * np.exp(-n.tau * s)
    f = f / (1 + np.abs(s)) ** order
    if np.min(np.abs(f)) < 1e-5 * np.max(np.abs(f)):
        return None
    turns = np.angle(f[1:] / f[:-1])
    if np.max(np.abs(turns)) > 2:
        return None
    total = np.sum(turns)
    count = (order * np.pi / 2 - total) / np.pi
    return int(round(count)) if abs(count - round(count)) < 0.35 else None


def stable(loop, point, radius=1.0, decay=0.0, n=None):
    """Whether all roots are in the region."""
    n = n or loop.at(point)
    if n.tau:
        count = count_right(n, decay)
        if count is None:
            return None
        # A root on the edge: counted a little beside.
        near = [count_right(n, decay + d) for d in (1e-4, -1e-4)]
        return None if near[0] != count or near[1] != count else count == 0
    roots = closed_roots(n)
    far = np.max(np.abs(roots)) - radius if n.T else np.max(roots.real) + decay
    close = CLOSE * (1 + (0 if n.T else np.max(np.abs(roots)))) * 10 ** (len(roots) / 4)
    return None if abs(far) < close else bool(far < 0)


def grid(n, both):
    """Angular frequencies."""
    if n.T:
        w = np.concatenate([np.geomspace(1e-8, 0.03, 2500), np.linspace(0.03, np.pi, 12000)]) / n.T
    else:
        w = np.concatenate([np.geomspace(1e-8, 1e4, 20000), np.linspace(0.001, 60, 20000)])
        w.sort()
    return np.concatenate([-w[::-1], w]) if both else w


def open_loop(n, w):
    """Its values."""
    s = np.exp(1j * w * n.T) if n.T else 1j * w
    return np.polyval(n.num, s) / np.polyval(n.den, s) * np.exp(-1j * w * n.tau)


def extreme(n, f, both):
    """The greatest value of f(L) over the frequencies."""
    w = grid(n, both)
    with np.errstate(all="ignore"):
        values = f(open_loop(n, w))
    best = np.nanmax(values)
    for k in np.argsort(values)[-3:]:
        low, high = w[max(k - 1, 0)], w[min(k + 1, len(w) - 1)]
        found = minimize_scalar(lambda x: -f(open_loop(n, x)), bounds=(low, high), method="bounded", options={"xatol": 1e-12})
        best = max(best, -found.fun)
    return best


def phase_margin(n, both):
    """The least turn, and the least delay of it; infinite without crossings."""
    w = grid(n, both)
    size = np.log(np.abs(open_loop(n, w)))
    found, delays = [np.inf], [np.inf]
    for k in np.nonzero(np.sign(size[1:]) != np.sign(size[:-1]))[0]:
        if w[k] < 0 < w[k + 1]:
            continue
        x = brentq(lambda x: np.log(abs(open_loop(n, x))), w[k], w[k + 1], xtol=1e-14)
        angle = np.angle(-open_loop(n, x))
        found.append(abs(np.degrees(angle)))
        later = angle if x > 0 else -angle
        delays.append((later % (2 * np.pi)) / abs(x))
    return min(found), min(delays)


def margin(loop, point, name):
    """The margin of this name at a stable point."""
    n, both = loop.at(point), loop.is_complex
    with np.errstate(all="ignore"):
        if name == "modulus_margin":
            return 1 / extreme(n, lambda L: 1 / np.abs(1 + L), both)
        if name == "complementary_peak":
            return extreme(n, lambda L: np.abs(L / (1 + L)), both)
        if name == "disk_margin":
            return 1 / extreme(n, lambda L: np.abs(1 - L) / np.abs(1 + L) / 2, both)
        if name == "phase_margin":
            return phase_margin(n, both)[0]
        if name == "delay_margin":
            # With a direct part of modulus one or more any dead time is too long.
            direct = abs(n.num[0] / n.den[0]) if len(n.num) == len(n.den) else 0.0
            return None if n.T else 0.0 if direct >= 1 else phase_margin(n, both)[1]
        if name == "damping" and not n.tau:
            roots = closed_roots(n).astype(complex)
            roots = np.log(roots[np.abs(roots) > 1e-9]) if n.T else roots
            return np.min(-roots.real / np.abs(roots)) if len(roots) else 1.0
    return None


def met(loop, point, name, required):
    """Whether a point is stable and meets a requirement."""
    is_stable = stable(loop, point)
    if not is_stable:
        return is_stable
    if name == "gain_margin":
        n = loop.at(point)
        factors = np.geomspace(1 / required, required, 25)
        known = [stable(loop, point, n=type(n)(np.multiply(n.num, f), n.den, n.tau, n.T)) for f in factors]
        ends = [stable(loop, point, n=type(n)(np.multiply(n.num, f), n.den, n.tau, n.T)) for f in (required * 1.001, 1 / required / 1.001)]
        return False if False in known else (True if all(known) and all(ends) else None)
    if name == "settling_time":
        n = loop.at(point)
        return stable(loop, point, radius=np.exp(-4 * n.T / required) if n.T else 1.0, decay=4 / required)
    found = margin(loop, point, name)
    if found is None or abs(found - required) < 2e-3 * required:
        return None
    return bool(found < required) if name == "complementary_peak" else bool(found > required)
