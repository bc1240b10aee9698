"""Random loops over each coefficient ring, each as a model text and, built apart from it, as numbers.

The names are those of the table's test: K decides the ring, L and W enter rationally, or K beside them.
"""

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from scipy.linalg import expm

NAMES = ("K", "L", "W")


@dataclass
class Numbers:
    """An open loop: num/den in s or z, highest power first, times exp(-tau s); T is the sample time."""

    num: np.ndarray
    den: np.ndarray
    tau: float = 0.0
    T: float | None = None


@dataclass
class Loop:
    """A model text, the loop's nominal point and domains, and its numbers at a point."""

    kind: str
    time: str
    text: str
    point: dict
    domain: dict
    at: object
    is_complex: bool = False
    refused: tuple = field(default=())


def decimal(value):
    """A number for a model file."""
    return f"'{value}'"


def some(r, low, high, parts=10):
    """A fraction between two whole numbers."""
    return Fraction(r.randint(low * parts, high * parts), parts)


def text(time, point, domain, blocks, sample_time=None):
    """The model of a loop r - y through blocks in series."""
    lines = [f"time = '{time}'"]
    if sample_time:
        lines.append(f"sample_time = '{sample_time}'")
    lines.append("[parameters]")
    for name in NAMES:
        low, high = domain[name]
        lines.append(f"{name} = {{ nominal = '{point[name]}', min = '{low}', max = '{high}' }}")
    lines += ["[loop]", "inputs = ['r']", "outputs = ['y']"]
    signals = ["r - y"] + [f"u{k}" for k in range(1, len(blocks))] + ["y"]
    for k, block in enumerate(blocks):
        lines += ["[[block]]", f"name = 'block{k}'", f"input = '{signals[k]}'", f"output = '{signals[k + 1]}'", block]
    return "\n".join(lines) + "\n"


def made(r, kind, time, blocks, at, nominal=(1, 1), sample_time=None, is_complex=False):
    """A loop with domains around its nominal point."""
    point = {"K": Fraction(nominal[0]), "L": Fraction(nominal[1]), "W": Fraction(1)}
    domain = {name: (value / 5, value * 5) for name, value in point.items()}
    domain["W"] = (Fraction(1, 2), Fraction(3))
    return Loop(kind, time, text(time, point, domain, blocks, sample_time), point, domain, at, is_complex)


def factors(r, order):
    """Random factors of a continuous denominator, as texts and polynomials."""
    words, poly = [], np.array([1.0])
    while order > 0:
        if order >= 2 and r.random() < 0.4:
            w, z = some(r, 1, 8, 2), Fraction(r.randint(1, 9), 10)
            words.append(f"(s^2 + {2 * z * w}*s + {w * w})")
            poly, order = np.polymul(poly, [1, float(2 * z * w), float(w * w)]), order - 2
        else:
            a = r.choice([Fraction(0), some(r, 0, 6, 4), some(r, 0, 6, 4), some(r, -1, 0, 4)])
            words.append(f"(s + {a})" if a >= 0 else f"(s - {-a})")
            poly, order = np.polymul(poly, [1, float(a)]), order - 1
    return "*".join(words), poly


def state_space(num, den):
    """The controllable form of a proper transfer function without direct part."""
    den, num = np.asarray(den, dtype=complex), np.asarray(num, dtype=complex) / den[0]
    den, n = den / den[0], len(den) - 1
    num = np.concatenate([np.zeros(n - len(num)), num])
    a = np.zeros((n, n), dtype=complex)
    a[0, :] = -den[1:]
    a[1:, :-1] += np.eye(n - 1)
    b = np.zeros((n, 1), dtype=complex)
    b[0, 0] = 1
    return a, b, num.reshape(1, n)


def pulse_transfer(phi, gammas, c):
    """c (z I - phi)^-1 (gammas[0] + gammas[1]/z + ..): numerator and denominator."""
    n = len(phi)
    den = np.poly(phi)
    num = np.zeros(1)
    for k, gamma in enumerate(gammas):
        # det(z I - phi + gamma c) - det(z I - phi)
        part = np.polysub(np.poly(phi - gamma @ c), den)
        num = np.polyadd(num, np.concatenate([part, np.zeros(len(gammas) - 1 - k)]))
    return num, np.concatenate([den, np.zeros(len(gammas) - 1)])


def held(num, den, T, delay=0.0):
    """A plant behind a zero-order hold, its input delayed."""
    a, b, c = state_space(num, den)
    n = len(a)
    block = np.zeros((n + 1, n + 1), dtype=complex)
    block[:n, :n], block[:n, n:] = a, b

    def step(t):
        e = expm(block * t)
        return e[:n, :n], e[:n, n:]

    whole = int(np.floor(delay / T + 1e-12))
    rest = max(delay - whole * T, 0.0)
    phi, _ = step(T)
    late, first = step(T - rest)
    _, early = step(rest)
    gammas = [first, late @ early] if rest > 1e-12 else [first]
    num, den = pulse_transfer(phi, gammas, c)
    return np.polyadd(num, 0), np.concatenate([den, np.zeros(whole)])


def real(p):
    """A polynomial without imaginary rounding."""
    p = np.asarray(p)
    return p.real if np.iscomplexobj(p) and np.max(np.abs(p.imag)) < 1e-9 * (1 + np.max(np.abs(p.real))) else p


def continuous(r):
    words, poly = factors(r, r.randint(2, 4))
    k = some(r, 1, 9, 3)
    if r.random() < 0.5:
        blocks = ["transfer = 'K*W*(s + L)/s'", f"transfer = '1/({words})'"]

        def at(p):
            return Numbers(p["K"] * p["W"] * np.array([1, p["L"]]), np.polymul([1, 0], poly))
    else:
        blocks = ["gain = 'K*W'", f"transfer = '(s/4 + 1)/((s + L)*{words})'"]

        def at(p):
            return Numbers(p["K"] * p["W"] * np.array([0.25, 1]), np.polymul([1, p["L"]], poly))

    return made(r, "continuous", "continuous", blocks, at, (k, some(r, 1, 3, 2)))


def discrete(r):
    poles = [Fraction(r.randint(-11, 12), 12) for _ in range(r.randint(1, 3))]
    zero = Fraction(r.randint(-12, 12), 12)
    words = "*".join(f"(z - ({p}))" for p in poles)
    poly = np.poly([float(p) for p in poles])
    blocks = ["transfer = 'K*W*(1 + L/(10*(z - 1)))'", f"transfer = '(z - ({zero}))/(z*{words})'"]

    def at(p):
        num = np.polymul(p["K"] * p["W"] * np.array([1, p["L"] / 10 - 1]), [1, -float(zero)])
        return Numbers(num, np.polymul([1, -1, 0], poly), T=1.0)

    return made(r, "discrete", "discrete", blocks, at, (Fraction(r.randint(1, 9), 10), some(r, 1, 3, 2)))


def feedthrough(r):
    words, poly = factors(r, 2)
    a = some(r, 1, 4, 2)
    blocks = ["gain = 'K*W'", f"transfer = '(s^2 + L*s + {a})/({words})'"]

    def at(p):
        return Numbers(p["K"] * p["W"] * np.array([1, p["L"], float(a)]), poly)

    return made(r, "feedthrough", "continuous", blocks, at, (some(r, 1, 4, 3), some(r, 1, 3, 2)))


def complex_continuous(r):
    a, b, c = some(r, 0, 3, 2), some(r, -4, 4, 2), some(r, 1, 5, 2)
    blocks = ["gain = 'K*W'", f"transfer = '(4 + 3*j)/5*(s + L)/(s*(s + {a} + ({b})*j)*(s + {c}))'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, float(a) + 1j * float(b)]), [1, float(c)])
        return Numbers(p["K"] * p["W"] * (4 + 3j) / 5 * np.array([1, p["L"]]), den)

    return made(r, "complex", "continuous", blocks, at, (some(r, 1, 4, 3), some(r, 1, 2, 2)), is_complex=True)


def behind_hold(r, kind="hold", delayed=False):
    words, poly = factors(r, r.randint(1, 3))
    T = Fraction(r.randint(1, 8), 20)
    delay = T * Fraction(r.randint(1, 9), 5) if delayed else Fraction(0)
    extra = f", delay = '{delay}'" if delayed else ""
    blocks = [
        "transfer = 'K*W*(1 + L/(10*(z - 1)))'",
        f"transfer = '1/({words})'\ndiscretize = {{ method = 'zoh', T = '{T}'{extra} }}",
    ]
    num, den = held([1.0], poly, float(T), float(delay))
    num, den = real(num), real(den)

    def at(p):
        pi = p["K"] * p["W"] * np.array([1, p["L"] / 10 - 1])
        return Numbers(np.polymul(pi, num), np.polymul([1, -1], den), T=float(T))

    return made(r, kind, "discrete", blocks, at, (some(r, 1, 5, 2), some(r, 1, 2, 2)), sample_time=T)


def hold_with_delay(r):
    return behind_hold(r, "hold and dead time", True)


def square_root(r):
    words, poly = factors(r, 2)
    n = r.choice([2, 3, 5])
    blocks = ["transfer = 'K*W*(s + L)/s'", f"transfer = '1/((s + sqrt({n}))*{words})'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, np.sqrt(n)]), poly)
        return Numbers(p["K"] * p["W"] * np.array([1, p["L"]]), den)

    return made(r, "square root", "continuous", blocks, at, (some(r, 1, 9, 3), some(r, 1, 3, 2)))


def pulses(r):
    a, b = some(r, 1, 4, 2), some(r, 1, 6, 2)
    T, duty = Fraction(r.randint(1, 6), 20), Fraction(r.randint(2, 8), 10)
    blocks = [
        "transfer = 'K*W*(1 + L/(10*(z - 1)))/z'",
        f"gain = 1\npwm = {{ amplitude = 1, carrier = 1, period = '{T}' }}",
        f"A = [[{decimal(-a)}, 1], [-1, {decimal(-b)}]]\nB = [[0], [1]]\nC = [[1, 0]]\n"
        f"discretize = {{ method = 'pwm', edge = 'trailing', duty = '{duty}' }}",
    ]
    A, t = np.array([[-float(a), 1], [-1, -float(b)]]), float(T)
    gamma = expm(A * t * (1 - float(duty))) @ np.array([[0], [1.0]]) * t
    num, den = pulse_transfer(expm(A * t), [gamma], np.array([[1.0, 0]]))
    num, den = num, np.concatenate([den, [0.0]])

    def at(p):
        pi = p["K"] * p["W"] * np.array([1, p["L"] / 10 - 1])
        return Numbers(np.polymul(pi, num), np.polymul([1, -1], den), T=t)

    return made(r, "pulses", "discrete", blocks, at, (some(r, 1, 8, 2), some(r, 1, 2, 2)), sample_time=T)


def complex_hold(r):
    a, b = some(r, 1, 3, 2), some(r, -4, 4, 2)
    T = Fraction(r.randint(1, 8), 20)
    blocks = [
        "transfer = 'K*W*(1 + L/(10*(z - 1)))'",
        f"transfer = '1/(s + {a} + ({b})*j)'\ndiscretize = {{ method = 'zoh', T = '{T}' }}",
    ]
    num, den = held([1.0], [1.0, complex(a, b)], float(T))

    def at(p):
        pi = p["K"] * p["W"] * np.array([1, p["L"] / 10 - 1])
        return Numbers(np.polymul(pi, num), np.polymul([1, -1], den), T=float(T))

    loop = made(r, "complex behind a hold", "discrete", blocks, at, (some(r, 1, 4, 2), 1), sample_time=T, is_complex=True)
    return loop


def sample_time(r, delayed=False):
    words, poly = factors(r, r.randint(1, 3))
    extra = ", delay = 'K*4/5'" if delayed else ""
    blocks = ["gain = 'L*W'", f"transfer = '1/({words})'\ndiscretize = {{ method = 'zoh'{extra} }}"]

    def at(p):
        num, den = held([1.0], poly, p["K"], 0.8 * p["K"] if delayed else 0.0)
        return Numbers(p["L"] * p["W"] * real(num), real(den), T=p["K"])

    kind = "sample time and dead time" if delayed else "sample time"
    return made(r, kind, "discrete", blocks, at, (Fraction(r.randint(1, 8), 20), some(r, 1, 6, 2)), sample_time="K")


def sample_time_with_delay(r):
    return sample_time(r, True)


def plant_pole(r, is_factor=False):
    words, poly = factors(r, r.randint(1, 2))
    T = Fraction(r.randint(1, 8), 20)
    gain = "3*K" if is_factor else "3"
    blocks = [
        "transfer = 'W*(1 + L/(10*(z - 1)))'",
        f"transfer = '{gain}/((s + K)*{words})'\ndiscretize = {{ method = 'zoh', T = '{T}' }}",
    ]

    def at(p):
        num, den = held([3 * (p["K"] if is_factor else 1.0)], np.polymul([1, p["K"]], poly), float(T))
        pi = p["W"] * np.array([1, p["L"] / 10 - 1])
        return Numbers(np.polymul(pi, real(num)), np.polymul([1, -1], real(den)), T=float(T))

    kind = "pole of the plant that is a factor" if is_factor else "pole of the plant"
    return made(r, kind, "discrete", blocks, at, (some(r, 1, 4, 2), some(r, 1, 2, 2)), sample_time=T)


def plant_pole_and_gain(r):
    return plant_pole(r, is_factor=True)


def root_of_name(r):
    words, poly = factors(r, 2)
    k = some(r, 2, 8, 1)
    blocks = ["transfer = 'W*(s + L)/s'", f"transfer = '4/((s + sqrt(K + 1))*{words})'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, np.sqrt(p["K"] + 1)]), poly)
        return Numbers(4 * p["W"] * np.array([1, p["L"]]), den)

    return made(r, "square root of a name", "continuous", blocks, at, (k, some(r, 1, 3, 2)))


def dead_time(r):
    words, poly = factors(r, r.randint(1, 3))
    tau = Fraction(r.randint(1, 10), 10)
    blocks = ["transfer = 'K*W*(s + L)/s'", f"transfer = 'exp(-{tau}*s)/((s + 1)*{words})'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, 1]), poly)
        return Numbers(p["K"] * p["W"] * np.array([1, p["L"]]), den, tau=float(tau))

    return made(r, "dead time", "continuous", blocks, at, (some(r, 1, 4, 5), some(r, 1, 2, 2)))


def free_dead_time(r):
    words, poly = factors(r, r.randint(2, 3))
    blocks = ["gain = 'L*W'", f"transfer = 'exp(-K*s)*(s/3 + 1)/({words})'"]

    def at(p):
        return Numbers(p["L"] * p["W"] * np.array([1 / 3, 1]), poly, tau=p["K"])

    return made(r, "free dead time", "continuous", blocks, at, (Fraction(r.randint(1, 10), 10), some(r, 1, 4, 2)))


def neutral(r):
    a, b, tau = some(r, 1, 4, 2), some(r, 1, 4, 2), Fraction(r.randint(1, 10), 10)
    blocks = ["gain = 'K*W/8'", f"transfer = 'exp(-{tau}*s)*(s + L)/(s + {a})*(s + {b})/(s + 1)'"]

    def at(p):
        num = p["K"] * p["W"] / 8 * np.polymul([1, p["L"]], [1, float(b)])
        return Numbers(num, np.polymul([1, float(a)], [1, 1]), tau=float(tau))

    return made(r, "neutral", "continuous", blocks, at, (some(r, 1, 3, 5), some(r, 1, 2, 2)))


def dead_time_beside(r):
    n, tau = r.choice([2, 3, 5]), Fraction(r.randint(1, 10), 10)
    blocks = ["transfer = 'K*W*(s + L)/s'", f"transfer = 'exp(-{tau}*s)/((s + 1)*(s + sqrt({n})))'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, 1]), [1, np.sqrt(n)])
        return Numbers(p["K"] * p["W"] * np.array([1, p["L"]]), den, tau=float(tau))

    return made(r, "dead time beside a root", "continuous", blocks, at, (some(r, 1, 4, 5), some(r, 1, 2, 2)))


def dead_time_beside_pi(r):
    f, tau = some(r, 1, 4, 5), Fraction(r.randint(1, 10), 20)
    blocks = [f"transfer = 'K*W*exp(-{tau}*s)/(s/(2*pi*{f}) + 1)'", "transfer = '2*pi*L/(s*(s + 3))'"]

    def at(p):
        den = np.polymul([1 / (2 * np.pi * float(f)), 1], [1, 3, 0])
        return Numbers(p["K"] * p["W"] * np.array([2 * np.pi * p["L"]]), den, tau=float(tau))

    return made(r, "dead time beside pi", "continuous", blocks, at, (some(r, 1, 4, 5), some(r, 1, 2, 2)))


def free_dead_time_beside(r):
    n, b = r.choice([2, 3, 5]), some(r, 1, 4, 2)
    blocks = ["gain = 'L*W/4'", f"transfer = 'exp(-K*s)/((s + sqrt({n}))*(s + {b}))'"]

    def at(p):
        return Numbers([p["L"] * p["W"] / 4], np.polymul([1, np.sqrt(n)], [1, float(b)]), tau=p["K"])

    return made(r, "free dead time beside a root", "continuous", blocks, at, (Fraction(r.randint(1, 10), 10), some(r, 1, 4, 2)))


def dead_time_beside_function(r):
    n, tau = r.choice([1, 2, 3]), Fraction(r.randint(1, 10), 10)
    blocks = ["transfer = 'W*(s + L)/s'", f"transfer = 'exp(-{tau}*s)/((s + 1)*(s + sqrt(K + {n})))'"]

    def at(p):
        den = np.polymul(np.polymul([1, 0], [1, 1]), [1, np.sqrt(p["K"] + n)])
        return Numbers(p["W"] * np.array([1, p["L"]]), den, tau=float(tau))

    return made(r, "dead time beside a function", "continuous", blocks, at, (some(r, 1, 4, 5), some(r, 1, 2, 2)))


def varying_order(r):
    words, poly = factors(r, r.randint(1, 2))
    delay = Fraction(r.randint(2, 12), 20)
    blocks = ["gain = 'L*W'", f"transfer = '1/((s + 1)*{words})'\ndiscretize = {{ method = 'zoh', delay = '{delay}' }}"]

    def at(p):
        num, den = held([1.0], np.polymul([1, 1], poly), p["K"], float(delay))
        return Numbers(p["L"] * p["W"] * real(num), real(den), T=p["K"])

    return made(r, "varying order", "discrete", blocks, at, (Fraction(r.randint(2, 8), 20), some(r, 1, 6, 2)), sample_time="K")


# The rings as the page of the table calls them.
GENERATORS = {
    "rational": [continuous, discrete, feedthrough, complex_continuous],
    "constants": [behind_hold, hold_with_delay, square_root, pulses, complex_hold],
    "functions": [sample_time, sample_time_with_delay, plant_pole, plant_pole_and_gain, root_of_name],
    "dead time": [dead_time, free_dead_time, neutral],
    "dead time beside constants": [dead_time_beside, dead_time_beside_pi, free_dead_time_beside],
    "dead time beside functions": [dead_time_beside_function],
    "varying order": [varying_order],
}
