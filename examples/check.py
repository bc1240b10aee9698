#!/usr/bin/env python3
"""Checks a certificate of jurist against a model:  check.py MODEL CERTIFICATE

A second checker, independent of the program: plain Python (3.11) with nothing but its standard
library, exact numbers throughout, no search.  The grammar of certificates, and why these checks
suffice, is in the documentation of jurist's module `certificate`.  Exit status 0: proved; 4: rejected.

Polynomials in one variable are lists of coefficients, the constant term first.  Polynomials in
several variables are dictionaries from tuples of exponents to integers; variable 0 is z (or s),
variable 1 the parameter in question, then come the other parameters.
"""
import json
import re
import sys
import tomllib
from fractions import Fraction
from math import gcd, lcm

sys.set_int_max_str_digits(0)
sys.setrecursionlimit(20000)
MAX_DIGITS = 100_000


class Rejected(Exception):
    pass


def need(condition, reason):
    if not condition:
        raise Rejected(reason)


# ---------------------------------------------------------------- numbers and polynomials in one variable

def integer(text):
    need(isinstance(text, str) and re.fullmatch(r"-?[0-9]+", text) and len(text) <= MAX_DIGITS, f"not an integer: {text!r:.40}")
    return int(text)


def rational(text):
    need(isinstance(text, str), f"not a number: {text!r:.40}")
    top, slash, bottom = text.partition("/")
    d = integer(bottom) if slash else 1
    need(d > 0, "a denominator is not positive")
    return Fraction(integer(top), d)


def trim(p):
    p = list(p)
    while p and p[-1] == 0:
        p.pop()
    return p


def add(p, q, factor=1):
    n = max(len(p), len(q))
    return trim([(p[i] if i < len(p) else 0) + factor * (q[i] if i < len(q) else 0) for i in range(n)])


def mul(p, q):
    out = [0] * (len(p) + len(q) - 1) if p and q else []
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return trim(out)


def value(p, x):
    result = 0
    for c in reversed(p):
        result = result * x + c
    return result


def primitive(p):
    """Integer coefficients without a common factor; a positive factor is lost."""
    m = lcm(*(Fraction(c).denominator for c in p)) if p else 1
    p = trim([int(c * m) for c in p])
    g = gcd(*p) if p else 1
    return [c // g for c in p]


def divide(p, q):
    """Quotient and remainder over the rationals."""
    rest, quotient = [Fraction(c) for c in p], []
    for k in range(len(p) - len(q), -1, -1):
        c = rest[k + len(q) - 1] / q[-1]
        quotient.insert(0, c)
        for j, b in enumerate(q):
            rest[k + j] -= c * b
    return quotient, trim(rest)


def poly_gcd(p, q):
    p, q = primitive(p), primitive(q)
    while q:
        p, q = q, primitive(divide(p, q)[1]) if len(p) >= len(q) else p
    return [-c for c in p] if p and p[-1] < 0 else p


def divides(f, p):
    return len(p) >= len(f) and not divide(p, f)[1]


def shift(p, a):
    """p(x + a)"""
    p = list(p)
    for i in range(len(p)):
        for j in range(len(p) - 2, i - 1, -1):
            p[j] += a * p[j + 1]
    return p


def changes(signs):
    signs = [s > 0 for s in signs if s != 0]
    return sum(a != b for a, b in zip(signs, signs[1:]))


def descartes(p, a, b):
    """At least the number of roots in the open interval (a, b), equal to it if 0 or 1; None is infinity."""
    if len(p) <= 1:
        return 0
    if a is None and b is None:
        return None
    if b is None:
        return changes(primitive_shift(p, a))
    if a is None:
        return changes([(-1) ** k * c for k, c in enumerate(primitive_shift(p, b))])
    m = lcm(a.denominator, b.denominator)
    p = [c * m ** (len(p) - 1 - k) for k, c in enumerate(p)]
    p = shift(p, int(a * m))
    p = [c * int((b - a) * m) ** k for k, c in enumerate(p)]
    return changes(shift(p[::-1], 1))


def primitive_shift(p, a):
    m = a.denominator
    return shift([c * m ** (len(p) - 1 - k) for k, c in enumerate(p)], a.numerator)


# ---------------------------------------------------------------- polynomials in several variables

def m_add(p, q, factor=1):
    out = dict(p)
    for e, c in q.items():
        out[e] = out.get(e, 0) + factor * c
    return {e: c for e, c in out.items() if c}


def m_mul(p, q):
    out = {}
    for e, c in p.items():
        for f, d in q.items():
            key = tuple(map(sum, zip(e, f)))
            out[key] = out.get(key, 0) + c * d
    return {e: c for e, c in out.items() if c}


def m_pow(p, k, n):
    out = {(0,) * n: 1}
    for _ in range(k):
        out = m_mul(out, p)
    return out


def m_degree(p, v):
    return max((e[v] for e in p), default=0)


def m_coefficients(p, v):
    out = [{} for _ in range(m_degree(p, v) + 1)] if p else []
    for e, c in p.items():
        out[e[v]][e[:v] + (0,) + e[v + 1:]] = c
    return out


def m_divide(p, q):
    """The exact quotient over the integers, or None."""
    lead = max(q)
    rest, quotient = dict(p), {}
    while rest:
        e = max(rest)
        c, remainder = divmod(rest[e], q[lead])
        difference = tuple(a - b for a, b in zip(e, lead))
        if remainder or min(difference) < 0:
            return None
        quotient[difference] = c
        rest = m_add(rest, m_mul({difference: c}, q), -1)
    return quotient


def m_content(p, v):
    content = {}
    for c in m_coefficients(p, v):
        content = m_gcd(content, c)
    return content


def m_gcd(p, q):
    """By primitive remainders in the first variable that occurs."""
    if not p or not q:
        return m_add(p, q)
    n = len(next(iter(p)))
    occurring = [v for v in range(n) if m_degree(p, v) or m_degree(q, v)]
    if not occurring:
        return {(0,) * n: gcd(*p.values(), *q.values())}
    v = occurring[0]
    content_p, content_q = m_content(p, v), m_content(q, v)
    p, q = m_divide(p, content_p), m_divide(q, content_q)
    if m_degree(p, v) < m_degree(q, v):
        p, q = q, p
    while q:
        if m_degree(q, v) == 0:
            p = {(0,) * n: 1}
            break
        lead = m_coefficients(q, v)[-1]
        rest = p
        while rest and m_degree(rest, v) >= m_degree(q, v):
            up = tuple(m_degree(rest, v) - m_degree(q, v) if i == v else 0 for i in range(n))
            top = m_mul({up: 1}, m_coefficients(rest, v)[-1])
            rest = m_add(m_mul(rest, lead), m_mul(q, top), -1)
        p, q = q, (m_divide(rest, m_content(rest, v)) if rest else {})
    return m_mul(m_gcd(content_p, content_q), p)


# ---------------------------------------------------------------- expressions

class F:
    """top / (bottom scalar): bottom contains z or is 1, scalar does not.  Only integers are cancelled."""

    def __init__(self, top, bottom, scalar):
        g = gcd(*top.values(), *scalar.values()) * (-1 if scalar[max(scalar)] < 0 else 1)
        self.top = {e: c // g for e, c in top.items()}
        self.bottom, self.scalar = bottom, {e: c // g for e, c in scalar.items()}

    def below(self):
        return m_mul(self.bottom, self.scalar)

    def __neg__(self):
        return F({e: -c for e, c in self.top.items()}, self.bottom, self.scalar)

    def __add__(self, other):
        d, e = self.bottom, other.bottom
        one = {(0,) * len(next(iter(d))): 1}
        if d == e:
            d_rest, e_rest = one, one
        elif m_degree(d, 0) == 0 or m_degree(e, 0) == 0:
            d_rest, e_rest = d, e
        else:  # the least common denominator
            g = m_gcd(d, e)
            g = m_divide(g, m_content(g, 0))
            d_rest, e_rest = m_divide(d, g), m_divide(e, g)
        g = m_gcd(self.scalar, other.scalar)
        s_rest, o_rest = m_divide(other.scalar, g), m_divide(self.scalar, g)
        top = m_add(m_mul(m_mul(self.top, e_rest), s_rest), m_mul(m_mul(other.top, d_rest), o_rest))
        return F(top, m_mul(d, e_rest), m_mul(self.scalar, s_rest))

    def __mul__(self, other):
        return F(m_mul(self.top, other.top), m_mul(self.bottom, other.bottom), m_mul(self.scalar, other.scalar))

    def inverse(self):
        one = {(0,) * len(next(iter(self.bottom))): 1}
        if m_degree(self.top, 0) == 0:
            return F(self.below(), one, self.top)
        return F(self.below(), self.top, one)


TOKEN = re.compile(r"\s*(?:((?=[\d.])(?:\d(?:_?\d)*)?\.?(?:\d(?:_?\d)*)?(?:[eE][+-]?\d(?:_?\d)*)?(?<=[\d.])(?![\w.]))|([^\W\d]\w*)|([-+*/^()]))")


class Scope:
    """Names, and everything that was divided by."""

    def __init__(self, constants, parameters):
        self.constants, self.parameters, self.n = constants, parameters, 2 + max([0, *(i - 1 for i in parameters.values())])
        self.known, self.open, self.divisors = {}, set(), []

    def number(self, q):
        q = Fraction(q)
        zero = (0,) * self.n
        return F({zero: q.numerator} if q else {}, {zero: 1}, {zero: q.denominator})

    def variable(self, i):
        zero = (0,) * self.n
        return F({tuple(int(j == i) for j in range(self.n)): 1}, {zero: 1}, {zero: 1})

    def constant(self, name):
        if name not in self.known:
            need(name in self.constants, f"unknown name {name}")
            need(name not in self.open, f"the constant {name} uses itself")
            self.open.add(name)
            self.known[name] = self.scalar(self.constants[name])
        return self.known[name]

    def inverse(self, f):
        need(f.top, "division by zero")
        self.divisors.append(f.top)
        return f.inverse()

    def scalar(self, text, variable=None):
        return self.linear(text, {}, variable)[None]

    def linear(self, text, signals, variable=None):
        """A dictionary from signals to coefficients, the constant part under None."""
        tokens, at = [], 0
        text = text.rstrip()
        while at < len(text):
            match = TOKEN.match(text, at)
            need(match and match.end() > at, f"cannot read {text!r:.60}")
            tokens.append(match.groups())
            at = match.end()
        tokens.append((None, None, "end"))
        position, zero = 0, self.number(0)

        def peek():
            return tokens[position][2]

        def advance():
            nonlocal position
            position += 1
            return tokens[position - 1]

        def scaled(a, f):
            return {k: c * f for k, c in a.items()}

        def total():
            result = product()
            while peek() in ("+", "-"):
                minus = advance()[2] == "-"
                term = product()
                for k, c in term.items():
                    result[k] = result.get(k, zero) + (-c if minus else c)
            return result

        def product():
            result = prefix()
            while peek() in ("*", "/"):
                over = advance()[2] == "/"
                factor = prefix()
                if over:
                    need(len(factor) == 1, "division by a signal")
                    factor = {None: self.inverse(factor[None])}
                need(len(result) == 1 or len(factor) == 1, "a product of signals")
                result = scaled(factor, result[None]) if len(result) == 1 else scaled(result, factor[None])
            return result

        def prefix(numbers_only=False):
            if peek() == "-":
                advance()
                return {k: -c for k, c in prefix(numbers_only).items()}
            if peek() == "+":
                advance()
                return prefix(numbers_only)
            base = atom(numbers_only)
            if peek() != "^":
                return base
            advance()
            exponent = prefix(True)[None]
            need(all(max(e) == 0 for e in exponent.top), "an exponent is not a number")
            k = Fraction(sum(exponent.top.values()), sum(exponent.scalar.values()))
            need(k.denominator == 1 and abs(k) <= 1000, "an exponent is not a small integer")
            k = int(k)
            if len(base) > 1:
                need(k == 1, "a power of a signal")
                return base
            f = self.inverse(base[None]) if k < 0 else base[None]
            k = abs(k)
            return {None: F(m_pow(f.top, k, self.n), m_pow(f.bottom, k, self.n), m_pow(f.scalar, k, self.n))}

        def atom(numbers_only):
            number, name, operator = advance()
            if number is not None:
                number = number.replace("_", "")
                mantissa, _, exponent = number.lower().partition("e")
                need(any(c.isdigit() for c in mantissa) and len(mantissa) <= MAX_DIGITS, "not a number")
                need(len(exponent) < 8 and abs(int(exponent or 0)) <= MAX_DIGITS, "an exponent is too large")
                return {None: self.number(Fraction(number if not number.endswith(".") else number[:-1]))}
            if operator == "(":
                result = total()
                need(advance()[2] == ")", "')' is missing")
                return result
            need(name is not None and not numbers_only, f"unexpected {operator or name}")
            if name == variable:
                return {None: self.variable(0)}
            if name in signals:
                return {None: zero, signals[name]: self.number(1)}
            if name in self.parameters:
                return {None: self.variable(self.parameters[name])}
            return {None: self.constant(name)}

        result = total()
        need(peek() == "end", f"cannot read {text!r:.60}")
        return result


# ---------------------------------------------------------------- the model

def expression(toml):
    need(isinstance(toml, (str, int)) and not isinstance(toml, bool), "an expression is expected")
    return str(toml)


def several(toml):
    return toml if isinstance(toml, list) else [toml]


def matrix(toml, scope):
    return [[scope.scalar(expression(e)) for e in row] for row in toml]


def sized(m, rows, columns):
    need(len(m) == rows and all(len(row) == columns for row in m), "the sizes of the matrices do not fit")


def characteristic_polynomial(text, kept, values):
    """(discrete, degree, coefficients of z^0, z^1, .. as polynomials in the parameter, poles)."""
    try:
        root = tomllib.loads(text, parse_float=lambda number: number.replace("_", ""))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise Rejected(f"the model is not TOML: {error}") from None
    need(root.get("time") in ("discrete", "continuous"), "the model has no time")
    discrete = root["time"] == "discrete"
    z = "z" if discrete else "s"
    constants = {name: expression(e) for name, e in root.get("constants", {}).items()}
    declared = set(root.get("parameters", {}))
    need(not declared & set(constants), "a name is both constant and parameter")
    parameters, numbers = {}, [None, None]
    for name in ([kept] if kept is not None else []) + list(values):
        if name not in declared:  # a constant given as a number may be freed
            need(name in constants and not re.search(r"[^\W\d]\w*", re.sub(r"\d[eE]", "0", constants.pop(name))), f"no parameter {name}")
        need(name not in parameters, f"{name} has two values")
        parameters[name] = 1 if name == kept and kept is not None else len(numbers)
        if parameters[name] != 1:
            numbers.append(values[name])
    need(declared <= set(parameters), "a parameter has no value")
    need(z not in parameters and z not in constants, f"{z} is the loop's variable")
    scope = Scope(constants, parameters)
    scope.n = len(numbers)
    for name in list(constants):
        scope.constant(name)
    if "sample_time" in root:
        scope.scalar(expression(root["sample_time"]))
    loop = root.get("loop", {})
    feedback = [k for k in "ABCK" if k in loop]
    need(("characteristic" in loop) + ("matrix" in loop) + bool(feedback) + ("block" in root) == 1, "not exactly one form of loop")
    rows = written = None
    if "characteristic" in loop:
        written = scope.scalar(expression(loop["characteristic"]), z)
        need(m_degree(written.bottom, 0) == 0, "the polynomial divides by its variable")
        degree = m_degree(written.top, 0)
    elif "block" in root:
        rows, degree = diagram(root, z, scope)
    else:
        if "matrix" in loop:
            m = matrix(loop["matrix"], scope)
        else:
            need(len(feedback) == 4, "A, B, C, K are needed")
            a, b, c, k = (matrix(loop[name], scope) for name in "ABCK")
            sized(a, len(a), len(a)), sized(b, len(a), len(k)), sized(c, len(c), len(a)), sized(k, len(k), len(c))
            m = [list(row) for row in a]
            kc = [[sum((k[i][l] * c[l][j] for l in range(len(c)) if k[i][l].top and c[l][j].top), scope.number(0)) for j in range(len(a))] for i in range(len(k))]
            for i in range(len(a)):
                for j in range(len(a)):
                    for l in range(len(k)):
                        if b[i][l].top and kc[l][j].top:
                            m[i][j] = m[i][j] + -(b[i][l] * kc[l][j])
        degree = len(m)
        sized(m, degree, degree)
        matrix(loop.get("E", []), scope)
        states = {name: i for i, name in enumerate(several(loop.get("states", [])))}
        for output in several(loop.get("outputs", [])):
            scope.linear(expression(output), states)
        rows = []
        for i, row in enumerate(m):  # z - m, every row times its denominators
            diagonal = [scope.variable(0) if i == j else scope.number(0) for j in range(degree)]
            rows.append(cleared([d + -f for d, f in zip(diagonal, row)], scope))

    def special(p):
        """The parameters' values put in: a list by powers of z of lists by powers of the kept parameter."""
        out = [[Fraction(0)] * (m_degree(p, 1) + 1) for _ in range(m_degree(p, 0) + 1)]
        for e, c in p.items():
            for i in range(2, scope.n):
                if e[i]:
                    c = c * numbers[i] ** e[i]
            out[e[0]][e[1]] += c
        return [trim(c) for c in out]

    poles = []
    for divisor in scope.divisors:  # undefined where all coefficients vanish together
        common = []
        for c in special(divisor):
            common = poly_gcd(common, c)
        poles.append(common)
    if rows is None:
        coefficients = special(written.top)
        lead = special(written.scalar)[0]
    else:
        coefficients = determinant([[special(p) for p in row] for row in rows])
        need(len(coefficients) <= degree + 1, "a determinant has too high a degree")
        lead = coefficients[degree] if len(coefficients) > degree else []
        if "block" in root:
            poles.append(lead)
    if not lead:
        poles.append([])
    if any(not p for p in poles):
        return discrete, degree, [], [[]]
    common = lead
    for c in coefficients:
        common = poly_gcd(common, c)
    sign = 1 if lead[-1] > 0 else -1
    coefficients = [[sign * x for x in divide(c, common)[0]] if c else [] for c in coefficients]
    coefficients += [[]] * (degree + 1 - len(coefficients))
    return discrete, degree, together(coefficients), poles


def together(coefficients):
    """Integers without a common factor; a positive factor is lost."""
    everything = [Fraction(x) for c in coefficients for x in c]
    m = lcm(*(x.denominator for x in everything))
    g = gcd(*(int(x * m) for x in everything)) or 1
    return [trim([int(x * m) // g for x in c]) for c in coefficients]


def cleared(row, scope):
    common = {(0,) * scope.n: 1}
    for f in row:
        if f.top:
            need(m_degree(f.bottom, 0) == 0, "a coefficient contains the variable")
            common = m_mul(common, m_divide(f.scalar, m_gcd(common, f.scalar)))
    return [m_mul(f.top, m_divide(common, f.scalar)) if f.top else {} for f in row]


def determinant(m):
    """By values at small integers; degrees are bounded by sums over rows and over columns."""
    n = len(m)
    z_degree = lambda e: max((k for k, c in enumerate(e) if c), default=-1)
    p_degree = lambda e: max((len(c) - 1 for c in e), default=-1)
    bounds = []
    for degree in (z_degree, p_degree):
        d = [[degree(e) for e in row] for row in m]
        by_rows = [max(row) for row in d]
        by_columns = [max(column) for column in zip(*d)]
        if min(by_rows + by_columns, default=0) < 0:
            return []
        bounds.append(min(sum(by_rows), sum(by_columns)))
    columns = [[] for _ in range(bounds[0] + 1)]
    for p in range(bounds[1] + 1):
        at_p = [[[value(c, p) for c in e] for e in row] for row in m]
        values = [bareiss([[value(e, x) for e in row] for row in at_p]) for x in range(bounds[0] + 1)]
        for k, c in enumerate(interpolated(values)):
            columns[k].append(c)
    return trim_list([trim(interpolated(c)) for c in columns])


def trim_list(p):
    while p and not p[-1]:
        p.pop()
    return p


def bareiss(m):
    factor = Fraction(1)
    for i, row in enumerate(m):
        d = lcm(*(Fraction(x).denominator for x in row))
        m[i] = [int(x * d) for x in row]
        factor /= d
    previous, sign = 1, 1
    for k in range(len(m)):
        pivot = next((i for i in range(k, len(m)) if m[i][k]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != k:
            m[k], m[pivot], sign = m[pivot], m[k], -sign
        for i in range(k + 1, len(m)):
            for j in range(k + 1, len(m)):
                m[i][j] = (m[k][k] * m[i][j] - m[i][k] * m[k][j]) // previous
        previous = m[k][k]
    return sign * previous * factor


def interpolated(values):
    """The polynomial with these values at 0, 1, 2, ..., not trimmed."""
    d = [Fraction(v) for v in values]
    for k in range(1, len(d)):
        for i in range(len(d) - 1, k - 1, -1):
            d[i] = (d[i] - d[i - 1]) / k
    out = []
    for k in range(len(d) - 1, -1, -1):
        out = [(out[i - 1] if i else 0) - (k * out[i] if i < len(out) else 0) for i in range(len(out) + 1)]
        out[0] += d[k]
    return out


def diagram(root, z, scope):
    """One polynomial matrix for all blocks; the unknowns are the driven signals and all states."""
    loop, blocks = root.get("loop", {}), root["block"]
    driven = [name for b in blocks for name in several(b.get("output", []))]
    external = several(loop.get("inputs", []))
    signals = {name: i for i, name in enumerate(driven)} | {name: -1 - i for i, name in enumerate(external)}
    need(len(signals) == len(driven) + len(external), "a signal is driven twice")
    need(not set(signals) & (set(scope.constants) | set(scope.parameters)), "a signal is also something else")
    n, one = scope.n, {(0,) * scope.n: 1}
    whole = lambda p: F(p, one, one)
    rows, unknowns, degree, output = [], len(driven), 0, 0

    def feed(row, factor, inputs):
        for k, c in inputs.items():
            if k is not None:
                row[k] = row.get(k, scope.number(0)) + factor * c

    for block in blocks:
        inputs = [scope.linear(expression(e), signals) for e in several(block.get("input", []))]
        need(all(not i[None].top for i in inputs), "an input has a constant term")
        outputs = range(output, output + len(several(block.get("output", []))))
        output = outputs.stop
        up, down, inner = scope.variable(0).top, one, z
        if "discretize" in block:  # s = up / down
            need(z == "z", "a continuous loop has nothing to discretise")
            inner, d = "s", block["discretize"]
            time, c = (scope.scalar(expression(d[k])) if k in d else None for k in ("T", "c"))
            minus, plus = m_add(up, one, -1), m_add(up, one)
            method = d.get("method")
            if method in ("forward", "backward") and time is not None and c is None:
                up, down = m_mul(minus, time.below()), m_mul(time.top, one if method == "forward" else up)
            elif method == "tustin" and (c is not None or time is not None):
                if c is None:
                    c = scope.number(2) * scope.inverse(time)
                up, down = m_mul(minus, c.top), m_mul(plus, c.below())
            else:
                raise Rejected("'discretize' is not complete")
        for key in ("amplitude", "carrier", "period"):
            if key in block.get("pwm", {}):
                scope.scalar(expression(block["pwm"][key]))
        given = lambda *keys: any(k in block for k in keys)
        need(given("transfer") + given("gain") + given("delay") + given("num", "den") + given("A", "B", "C", "D") == 1, "not exactly one kind of block")
        if given("A", "B", "C", "D"):
            a, b, c, d = (matrix(block[k], scope) if k in block else None for k in "ABCD")
            if a is None and b is None and c is None:
                a, b, c = [], [], [[] for _ in outputs]
            need(a is not None and b is not None, "a state-space block needs A and B")
            order = len(a)
            c = c if c is not None else [[scope.number(int(i == j)) for j in range(order)] for i in range(order)]
            d = d if d is not None else [[scope.number(0) for _ in inputs] for _ in outputs]
            sized(a, order, order), sized(b, order, len(inputs)), sized(c, len(outputs), order), sized(d, len(outputs), len(inputs))
            for i in range(order):  # up x = down (A x + B u)
                row = {unknowns + i: whole(up)}
                for j in range(order):
                    row[unknowns + j] = row.get(unknowns + j, scope.number(0)) + -(whole(down) * a[i][j])
                for j, u in enumerate(inputs):
                    feed(row, -(whole(down) * b[i][j]), u)
                rows.append(row)
            for i, y in enumerate(outputs):  # y = C x + D u
                row = {y: scope.number(1)} | {unknowns + j: -c[i][j] for j in range(order)}
                for j, u in enumerate(inputs):
                    feed(row, -d[i][j], u)
                rows.append(row)
            unknowns, degree = unknowns + order, degree + order
            continue
        need(len(inputs) == 1 and len(outputs) == 1, "a transfer function has one input and one output")
        if "num" in block or "den" in block:
            sides = []
            for key in ("num", "den"):
                f = scope.number(0)
                for e in several(block[key]):
                    f = f * scope.variable(0) + scope.scalar(expression(e))
                sides.append(f)
            num, den = m_mul(sides[0].top, sides[1].scalar), m_mul(sides[1].top, sides[0].scalar)
        elif "delay" in block:
            samples = int(expression(block["delay"]))
            need(0 <= samples <= 2000 and inner == "z", "a delay is a number of samples")
            num, den = one, {(samples,) + (0,) * (n - 1): 1}
        else:
            f = scope.scalar(expression(block["transfer"]), inner) if "transfer" in block else scope.scalar(expression(block["gain"]))
            num, den = f.top, f.below()
        order = m_degree(den, 0)
        need(den and m_degree(num, 0) <= order, "a transfer function is improper")
        if "discretize" in block:
            num, den = (
                F(*(sum_of([m_mul(c, m_mul(m_pow(up, k, n), m_pow(down, order - k, n))) for k, c in enumerate(m_coefficients(p, 0))]), one, one)).top
                if p else {} for p in (num, den))
        row = {outputs[0]: whole(den)}  # den y = num u
        feed(row, -whole(num), inputs[0])
        rows.append(row)
        degree += order
    for e in several(loop.get("outputs", [])):
        scope.linear(expression(e), signals)
    need(len(rows) == unknowns, "there are not as many equations as unknowns")
    return [cleared([row.get(k, scope.number(0)) for k in range(unknowns)], scope) for row in rows], degree


def sum_of(terms):
    out = {}
    for t in terms:
        out = m_add(out, t)
    return out


# ---------------------------------------------------------------- roots and boundaries

def is_stable(d, discrete):
    """All roots strictly inside: Schur-Cohn's reduction, or Routh's."""
    d = primitive(d)
    while len(d) > 1:
        n, last, first, size = len(d) - 1, d[-1], d[0], abs(d[-2])
        if discrete:
            if abs(first) >= abs(last):
                return False
            d = primitive([last * d[k] - first * d[n - k] for k in range(1, n + 1)])
        else:
            if d[-2] * last <= 0:
                return False
            last = last if d[-2] > 0 else -last
            reduced = [c * size for c in d]
            for k in range(n - 1, -1, -2):
                reduced[k + 1] -= last * d[k]
            d = primitive(reduced)
    return bool(d)


def places(d, discrete):
    """Roots inside, on and outside."""
    d, on = primitive(d), 0
    if discrete:
        while len(d) > 1 and value(d, -1) == 0:
            d, on = primitive(divide(d, [1, 1])[0]), on + 1
        image, weight = [], [1]  # z = (1 + s)/(1 - s)
        for c in reversed(d):
            image = add(mul(image, [1, 1]), weight, c)
            weight = mul(weight, [1, -1])
        inside, more, outside = places(image, False)
        return inside, on + more, outside
    h = poly_gcd(d, [(-1) ** k * c for k, c in enumerate(d)])  # the mirror images of each other
    rest = divide(d, h)[0]
    m = next(k for k, c in enumerate(h) if c)
    e = h[m::2]  # h = s^m e(s^2): each negative root of e is a pair on the axis
    on = m
    while len(e) > 1:
        derivative = trim([k * c for k, c in enumerate(e)][1:])
        chain = sturm(e, derivative)
        on += 2 * (changes([at_minus_infinity(g) for g in chain]) - changes([g[0] for g in chain]))
        e = poly_gcd(e, derivative)
    beside, n = len(h) - 1 - on, len(rest) - 1
    difference = 0
    if n:  # the Cauchy index along the axis
        part = lambda first: trim([(0 if (n - k - first) % 2 else (-1) ** ((n - k - first) // 2) * rest[k]) if k <= n - first else 0 for k in range(n + 1)])
        chain = sturm(part(0), part(1))
        difference = changes([at_minus_infinity(g) for g in chain]) - changes([g[-1] for g in chain])
    inside = beside // 2 + (n + difference) // 2
    return inside, on, len(d) - 1 - on - inside


def at_minus_infinity(g):
    return g[-1] * (-1) ** (len(g) - 1)


def sturm(f, g):
    chain = [primitive(f), primitive(g)]
    while chain[-1]:
        rest = divide(chain[-2], chain[-1])[1] if len(chain[-2]) >= len(chain[-1]) else chain[-2]
        chain.append([-c for c in primitive(rest)])
    return chain[:-1]


def half_size_pair(d, discrete):
    """A, B and their formal degrees: see the grammar."""
    n = len(d) - 1
    k = n // 2
    degree_b = k - 1 if n % 2 == 0 else k
    if not discrete:
        return d[0::2], k, d[1::2], degree_b
    plus = [add(d[i], d[n - i]) for i in range(n + 1)]
    minus = [add(d[i], d[n - i], -1) for i in range(n + 1)]

    def over(p, step, c):  # p / (z^step + c), exact, from the constant term up
        q = []
        for i in range(len(p) - step):
            q.append([c * x for x in (add(p[i], q[i - step], -1) if i >= step else p[i])])
        return q

    def in_x(p, m):  # z^-m p in x = z + 1/z
        rest, out = list(p), []
        for j in range(m, -1, -1):
            top, binomial = rest[m + j], 1
            out.insert(0, top)
            for i in range(j + 1):
                rest[m + j - 2 * i] = add(rest[m + j - 2 * i], top, -binomial)
                binomial = binomial * (j - i) // (i + 1)
        return out

    if n % 2 == 0:
        return in_x(plus, k), k, in_x(over(minus, 2, -1), k - 1), degree_b
    return in_x(over(plus, 1, 1), k), k, in_x(over(minus, 1, -1), k), degree_b


# ---------------------------------------------------------------- the certificate

def strict(pairs):
    need(len({k for k, _ in pairs}) == len(pairs), "a key occurs twice")
    return dict(pairs)


def no_number(text):
    raise Rejected(f"only small counts are written as numbers, not {text:.20}")


def keys(json_object, names, optional=()):
    need(isinstance(json_object, dict), "an object is expected")
    need(set(names) <= set(json_object) <= set(names) | set(optional), f"the keys are not {', '.join(names)}")
    return [json_object[name] for name in names]


def polynomial(coefficients):
    need(isinstance(coefficients, list) and len(coefficients) <= 20000, "not a polynomial")
    p = [integer(c) for c in coefficients]
    need(not p or p[-1] != 0, "a polynomial has a zero at the top")
    return p


def polynomials(items):
    need(isinstance(items, list), "not a list of polynomials")
    return [polynomial(p) for p in items]


def pair_of(items):
    need(isinstance(items, list) and len(items) == 2, "not a pair")
    a, b = map(rational, items)
    need(a < b, "a pair is not in order")
    return a, b


def end_of(item):
    if item is None:
        return None
    if isinstance(item, str):
        return rational(item)
    p, between = keys(item, ["polynomial", "between"])
    return tuple(polynomial(p)), pair_of(between)


def in_region(d, discrete, extent):
    if discrete:
        if extent == "parameter":
            return together([[0] * k + c if c else [] for k, c in enumerate(d)])
        return together([[x * extent ** k for x in c] for k, c in enumerate(d)])
    step = [0, -1] if extent == "parameter" else trim([-extent])
    d = list(d)
    for i in range(len(d)):
        for j in range(len(d) - 2, i - 1, -1):
            d[j] = add(d[j], mul(d[j + 1], step))
    return together(d)


def check(model, certificate):
    """The proved statement as a sentence; raises Rejected."""
    try:
        document = json.loads(certificate, object_pairs_hook=strict, parse_float=no_number, parse_constant=no_number,
                              parse_int=lambda t: int(t) if len(t) < 10 and t[0] != "-" else no_number(t))
    except (json.JSONDecodeError, RecursionError) as error:
        raise Rejected(f"not JSON: {error}") from None
    need(isinstance(document, dict) and document.get("schema") == "jurist/certificate/1", "unknown schema")
    statement = document.get("statement")
    need(isinstance(statement, dict) and statement.get("kind") in ("intervals", "verdict"), "unknown kind of statement")
    intervals = statement["kind"] == "intervals"
    names = ["schema", "statement", "characteristic"] + (["boundary", "factors", "line"] if intervals else [])
    keys(document, names, ["model"])
    need(statement.get("time") in ("discrete", "continuous"), "unknown time")
    discrete = statement["time"] == "discrete"
    need(isinstance(statement.get("set"), dict), "no values")
    values = {name: rational(v) for name, v in statement["set"].items()}
    [extent] = keys(statement.get("region"), ["radius" if discrete else "decay"])
    if extent != "parameter":
        extent = rational(extent)
        need(not discrete or extent > 0, "the radius is not positive")
    if not intervals:
        return check_verdict(model, document, statement, values, discrete, extent)
    _, _, parameter, _, _, domain, claimed = keys(statement, ["kind", "time", "parameter", "set", "region", "domain", "stable"])
    need(isinstance(parameter, str), "no parameter")
    low, high = (None if b is None else rational(b) for b in keys(domain, ["lower", "upper"]))
    need(low is None or high is None or low < high, "the domain is empty")
    relative = extent == "parameter"
    if relative:
        need(parameter == ("radius" if discrete else "decay"), "the parameter is not that of the region")
        need(not discrete or (low is not None and low >= 0), "a radius is positive")
    need(isinstance(claimed, list), "no claimed set")
    claimed = [tuple(map(end_of, keys(i, ["lower", "upper"]))) for i in claimed]
    is_discrete, n, d, poles = characteristic_polynomial(model, None if relative else parameter, values)
    need(is_discrete == discrete, "the model's time is another")
    d = in_region(d, discrete, extent)
    need(polynomials(document["characteristic"]) == d, "characteristic: not that of the model")

    # Polynomials at whose zeros the loop is surely not stable.
    certain = list(poles) + [d[n] if d else []]
    if n > 0 and d:
        if discrete:
            even, odd = [], []
            for k, c in enumerate(d):
                even, odd = (add(even, c), odd) if k % 2 == 0 else (even, add(odd, c))
            certain += [add(even, odd), add(even, odd, -1)]
        else:
            certain.append(d[0])
    boundary, factors, line = document["boundary"], polynomials(document["factors"]), document["line"]
    nowhere, pair = any(not c for c in certain), None
    if n < 2 or nowhere:
        need(boundary is None, "boundary: must be null")
    else:
        u, v, result = keys(boundary, ["u", "v", "value"])
        u, v, result = polynomials(u), polynomials(v), polynomial(result)
        a, degree_a, b, degree_b = half_size_pair(d, discrete)
        need(len(u) <= degree_b and len(v) <= degree_a, "boundary: a cofactor's degree is too high")
        need(any(u) or any(v), "boundary: both cofactors are zero")
        total = [[] for _ in range(len(u) + len(a) + len(v) + len(b))]
        for left, right in ((u, a), (v, b)):
            for i, x in enumerate(left):
                for j, y in enumerate(right):
                    total[i + j] = add(total[i + j], mul(x, y))
        need(total[0] == result and not any(total[1:]), "boundary: the identity does not hold")
        nowhere, pair = not result, (u, v, result)
    if nowhere:
        need(factors == [] and line == [] and claimed == [], "the loop is stable nowhere")
        return f"The loop is stable for no value of {parameter}."
    need(all(len(f) > 1 for f in factors), "factors: one is constant")
    for p in certain + ([pair[2]] if pair else []):
        p = primitive(p)
        for f in factors:
            while divides(f, p):
                p = primitive(divide(p, f)[0])
        need(len(p) == 1, "factors: a boundary polynomial is not a product of them")

    # The line, from left to right.
    need(isinstance(line, list) and len(line) % 2 == 1, "line: must begin and end with a stretch")
    outer = lambda q: {"end": q, "left": q, "right": q, "regular": False}

    def separator(item):
        need(isinstance(item, dict), "line: not an object")
        touch = item.get("touch")
        need(touch is None or (isinstance(touch, list) and len(touch) == 2 and touch[0] in ("u", "v") and type(touch[1]) is int), "line: bad touch")
        if "at" in item:
            q = rational(keys(item, ["at"], ["touch"])[0])
            need(any(value(f, q) == 0 for f in factors), f"line: no factor vanishes at {q}")
            return outer(q) | {"touch": touch}
        between, k = keys(item, ["between", "factor"], ["touch"])
        a, b = pair_of(between)
        need(type(k) is int and k < len(factors), "line: no such factor")
        for i, f in enumerate(factors):
            need(value(f, a) != 0 and value(f, b) != 0, "line: a factor vanishes at an end")
            need(descartes(f, a, b) == int(i == k), f"line: the roots in ({a}, {b}) are not isolated")
        return {"end": (tuple(factors[k]), (a, b)), "left": a, "right": b, "regular": True, "factor": factors[k], "touch": touch}

    def stretch(item, before, after):
        split, sample, stable = keys(item, ["split", "sample", "stable"])
        need(isinstance(split, list) and type(stable) is bool, "line: bad stretch")
        points = [before["right"], *map(rational, split), after["left"]]
        one_point = before["regular"] and after["regular"] and before["right"] == after["left"]
        need(not (one_point and split), "line: a point cannot be split")
        if not one_point:
            for a, b in zip(points, points[1:]):
                need(a is None or b is None or a < b, "line: points are not in order")
                need(all(descartes(f, a, b) == 0 for f in factors), "line: a gap may have roots")
        need(all(value(f, q) != 0 for f in factors for q in points[1:-1]), "line: a factor vanishes at a split")
        s, l, r = rational(sample), points[0], points[-1]
        need(l is None or l < s or (l == s and before["regular"]), "line: the sample is outside")
        need(r is None or s < r or (r == s and after["regular"]), "line: the sample is outside")
        polynomial_at = trim([value(c, s) for c in d])
        need(len(polynomial_at) == n + 1, "line: the sample loses degree")
        need(is_stable(polynomial_at, discrete) == stable, f"line: the verdict at {s} is wrong")
        return stable

    def excluded(s):
        """Two roots are mirror images at s, or one is on the boundary, or the loop is undefined."""
        rational_point = "factor" not in s
        vanishes = (lambda p: value(p, s["end"]) == 0) if rational_point else (lambda p: divides(s["factor"], p))
        if any(vanishes(c) for c in certain):
            return True
        if pair is None or s["touch"] is None or not vanishes(pair[2]):
            return False
        which, k = s["touch"]
        w = pair["uv".index(which)]
        if k >= len(w) or not w[k]:
            return False
        return value(w[k], s["end"]) != 0 if rational_point else descartes(w[k], s["left"], s["right"]) == 0

    before, was_stable, found = outer(low), False, []
    for i in range(0, len(line), 2):
        after = separator(line[i + 1]) if i + 1 < len(line) else outer(high)
        stable = stretch(line[i], before, after)
        need(not (stable and was_stable) or excluded(before), "line: a point between stable stretches is not excluded")
        if stable:
            found.append((before["end"], after["end"]))
        before, was_stable = after, stable
    need(found == claimed, "stable: the claimed set is not the one that the line shows")
    return f"The set of stable {parameter} is exactly the claimed one ({len(found)} intervals)."


def check_verdict(model, document, statement, values, discrete, extent):
    names = ["verdict", "degree", "inside", "on", "outside", "infinite"]
    claimed = keys(statement, names, ["kind", "time", "set", "region"])
    need(extent != "parameter", "the region has no parameter here")
    need(all(type(c) is int for c in claimed[1:]), "a count is not a number")
    is_discrete, n, d, _ = characteristic_polynomial(model, None, values)
    need(is_discrete == discrete, "the model's time is another")
    undefined = not d
    d = in_region(d, discrete, extent)
    need(polynomials(document["characteristic"]) == d, "characteristic: not that of the model")
    p = trim([c[0] if c else 0 for c in d])
    if undefined:
        found = ["undefined", n, 0, 0, 0, 0]
    elif not p:
        found = ["unstable", n, 0, 0, 0, n]
    else:
        inside, on, outside = places(p, discrete)
        infinite = n + 1 - len(p)
        name = "unstable" if outside + infinite else "marginal" if on else "stable"
        found = [name, n, inside, on, outside, infinite]
    need(claimed == found, f"stable: it is {dict(zip(names, found))}")
    return f"The loop is {found[0]}: {found[2]} roots inside, {found[3]} on the boundary, {found[4]} outside."


FAILURES = (Rejected, RecursionError, ZeroDivisionError, TypeError, KeyError, ValueError, AttributeError, OverflowError, IndexError)


def judge(model, certificate):
    """Whether the certificate is accepted, and the statement or the reason."""
    try:
        return True, check(model, certificate)
    except FAILURES as error:
        return False, str(error)


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: check.py MODEL CERTIFICATE")
    with open(sys.argv[1], encoding="utf-8") as model, open(sys.argv[2], encoding="utf-8") as certificate:
        try:
            print("proved:", check(model.read(), certificate.read()))
        except (Rejected, RecursionError, ZeroDivisionError, TypeError, KeyError, ValueError, AttributeError, OverflowError) as error:
            print("rejected:", error, file=sys.stderr)
            sys.exit(4)


if __name__ == "__main__":
    main()
