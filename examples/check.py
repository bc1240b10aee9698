#!/usr/bin/env python3
"""Checks a certificate of jurist against a model:  check.py MODEL CERTIFICATE

A second checker, independent of the program: plain Python (3.11) with nothing but its standard library, exact
numbers throughout, no search.  The grammar of certificates, and why these checks suffice, is in the documentation
of jurist's module `certificate`.  Exit status 0: proved; 4: rejected.

Polynomials in one variable are lists of coefficients, the constant term first.  Polynomials in several variables
are objects of class P.
"""
import json
import os
import re
import sys
import threading
import tomllib
from fractions import Fraction
from itertools import zip_longest
from math import gcd, lcm, prod

MAX_DIGITS = 100_000
MAX_TEXT = 64 << 20
MAX_DEPTH = 16
SECONDS = 60
sys.set_int_max_str_digits(2 * MAX_DIGITS)
sys.setrecursionlimit(20000)

class Rejected(Exception):
    pass

def need(condition, reason):
    if not condition:
        raise Rejected(reason)

# ---------------------------------------------------------------- polynomials in one variable

def trim(p):
    while p and not p[-1]:
        p = p[:-1]
    return p

def times(p, q):
    out = [0] * (len(p) + len(q) - 1) if p and q else []
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out

def value(p, x):
    result = 0
    for c in reversed(p):
        result = result * x + c
    return result

def primitive(p):
    """Integers without a common factor; a positive factor is lost."""
    m = lcm(*(Fraction(c).denominator for c in p))
    p = trim([int(c * m) for c in p])
    return [c // gcd(*p) for c in p]

def divided(p, q):
    """Quotient and remainder."""
    p, quotient = [Fraction(c) for c in p], []
    while len(p) >= len(q):
        factor = p[-1] / q[-1]
        quotient.insert(0, factor)
        shift = len(p) - len(q)
        p = [c - factor * q[k - shift] if k >= shift else c for k, c in enumerate(p)][:-1]
    return quotient, trim(p)

def divides(f, p):
    return len(p) >= len(f) and not divided(p, f)[1]

def common_divisor(p, q):
    while q:
        p, q = q, primitive(divided(p, q)[1])
    return primitive(p)

def derivative(p):
    return [k * c for k, c in enumerate(p)][1:]

def changes(signs):
    """The number of sign changes, zeros left out."""
    signs = [s > 0 for s in signs if s != 0]
    return sum(a != b for a, b in zip(signs, signs[1:]))

def quotient_put_in(p, top, bottom):
    """bottom^d p(top/bottom) for two linear polynomials top and bottom, d the degree of p."""
    result, power = [], [1]
    for c in reversed(p):
        result = [a + c * b for a, b in zip_longest(times(result, top), power, fillvalue=0)]
        power = times(power, bottom)
    return result

def descartes(p, a, b):
    """At least the number of roots in the open interval (a, b), equal to it if 0 or 1; None is an infinite end."""
    if len(p) > 1 and a is None and b is None:
        return None
    a0, a1 = (-1, 0) if a is None else a.as_integer_ratio()
    b0, b1 = (1, 0) if b is None else b.as_integer_ratio()
    return changes(quotient_put_in(p, [a0, b0], [a1, b1]))  # y > 0 in (a0 + b0 y)/(a1 + b1 y)

# ---------------------------------------------------------------- polynomials in several variables

def monomial(exponents):
    return tuple(trim(list(exponents)))

class P:
    """Rational coefficients by exponents of the variables.  Variable 0 is z (or s), 1 the parameter in question."""

    def __init__(self, terms):
        self.terms = {e: c for e, c in terms.items() if c}

    @staticmethod
    def variable(v):
        return P({(0,) * v + (1,): 1})

    @staticmethod
    def table(rows):
        """From a list by powers of variable 0 of lists by powers of variable 1."""
        return P({monomial((i, j)): c for i, row in enumerate(rows) for j, c in enumerate(row)})

    def rows(self):
        """The reverse of `table`."""
        out = [[0] * (self.degree(1) + 1) for _ in range(self.degree(0) + 1)] if self.terms else []
        for e, c in self.terms.items():
            i, j = (*e, 0, 0)[:2]
            out[i][j] = c
        return [trim(row) for row in out]

    def __add__(self, other):
        out = dict(self.terms)
        for e, c in other.terms.items():
            out[e] = out.get(e, 0) + c
        return P(out)

    def __neg__(self):
        return P({e: -c for e, c in self.terms.items()})

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        out = {}
        for e, c in self.terms.items():
            for f, d in other.terms.items():
                key = tuple(map(sum, zip_longest(e, f, fillvalue=0)))
                out[key] = out.get(key, 0) + c * d
        return P(out)

    def __pow__(self, k):
        out = ONE
        for _ in range(k):
            out = out * self
        return out

    def __eq__(self, other):
        return self.terms == other.terms

    def __truediv__(self, other):
        """The quotient of a division without remainder."""
        quotient, rest, lead = ZERO, self, max(other.terms)
        while rest.terms:
            top = max(rest.terms)
            exponents = [a - b for a, b in zip_longest(top, lead, fillvalue=0)]
            need(min(exponents, default=0) >= 0, "internal: a division has a remainder")
            term = P({monomial(exponents): Fraction(rest.terms[top]) / other.terms[lead]})
            quotient, rest = quotient + term, rest - term * other
        return quotient

    def degree(self, v):
        return max((e[v] for e in self.terms if len(e) > v), default=0)

    def coefficients(self, v):
        """The coefficients of the powers of one variable, the constant term first."""
        out = [{} for _ in range(self.degree(v) + 1)] if self.terms else []
        for e, c in self.terms.items():
            k = e[v] if len(e) > v else 0
            out[k][monomial((*e[:v], 0, *e[v + 1:]))] = c
        return [P(terms) for terms in out]

    def coefficient(self, v, k):
        """That of the k-th power of one variable."""
        return P({monomial((*e[:v], 0, *e[v + 1:])): c for e, c in self.terms.items() if (e[v] if len(e) > v else 0) == k})

    def primitive(self):
        """Integers without a common factor; a positive factor is lost."""
        return P(dict(zip(self.terms, primitive(list(self.terms.values())))))

    def in_parameter(self):
        """A polynomial in variable 1 alone, as a list."""
        return (self.rows() or [[]])[0]

    def number(self):
        """The value, if no variable occurs; otherwise None."""
        return None if any(self.terms) else Fraction(self.terms.get((), 0))

    def content(self, v):
        content = ZERO
        for c in self.coefficients(v):
            content = content.common(c)
        return content

    def common(self, other):
        """A greatest common divisor, by primitive remainders in the first variable that occurs."""
        a, b = self, other
        if not a.terms or not b.terms:
            return a + b
        if a.number() is not None or b.number() is not None:
            return ONE
        v = min(next(v for v, k in enumerate(e) if k) for e in (*a.terms, *b.terms) if e)
        content = a.content(v).common(b.content(v))
        a, b = a / a.content(v), b / b.content(v)
        if a.degree(v) < b.degree(v):
            a, b = b, a
        while b.terms and b.degree(v):
            rest, lead = a, b.coefficients(v)[-1]
            while rest.terms and rest.degree(v) >= b.degree(v):
                top = rest.coefficients(v)[-1] * P.variable(v) ** (rest.degree(v) - b.degree(v))
                rest = rest * lead - b * top
            a, b = b, (rest / rest.content(v)).primitive() if rest.terms else ZERO
        return content if b.terms else content * a

    def with_values(self, values):
        """Numbers in the place of all variables from 2 on."""
        out = {}
        for e, c in self.terms.items():
            need(len(e) <= 2 + len(values), "a signal where none may be, or a product of signals")
            for k, x in zip(e[2:], values):
                c = c * x ** k
            key = monomial(e[:2])
            out[key] = out.get(key, 0) + c
        return P(out)

ONE, ZERO, Z = P({(): 1}), P({}), P.variable(0)

class F:
    """A quotient of two polynomials.  It is never reduced, so that everything divided by stays visible."""

    def __init__(self, top, bottom=ONE):
        self.top, self.bottom = top, bottom

    def __add__(self, other):  # over the least common denominator
        if self.bottom == other.bottom:
            return F(self.top + other.top, self.bottom)
        common = self.bottom.common(other.bottom)
        left, right = other.bottom / common, self.bottom / common
        return F(self.top * left + other.top * right, self.bottom * left)

    def __neg__(self):
        return F(-self.top, self.bottom)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        return F(self.top * other.top, self.bottom * other.bottom)

    def __pow__(self, k):
        return F(self.top ** k, self.bottom ** k)

# ---------------------------------------------------------------- expressions

DIGITS = "[0-9](?:_?[0-9])*"
NUMBER = rf"(?:{DIGITS}\.?(?:{DIGITS})?|\.{DIGITS})(?:[eE][+-]?{DIGITS})?(?![\w.])"
TOKEN = re.compile(rf"\s*({NUMBER}|[^\W\d]\w*|[-+*/^()])")

def decimal(text):
    mantissa, _, exponent = text.replace("_", "").lower().partition("e")
    whole, _, fraction = mantissa.partition(".")
    need(len(mantissa) <= MAX_DIGITS and len(exponent) < 8, "a number is too long")
    exponent = int(exponent or 0) - len(fraction)
    need(abs(exponent) <= MAX_DIGITS, "a number is too long")
    return int(whole + fraction) * Fraction(10) ** exponent

def no_names(name):
    raise Rejected(f"the name {name} where only numbers may stand")

def evaluate(text, names, inverse):
    """The value of an expression; `names` and `inverse` are functions."""
    tokens, at, text = [], 0, text.rstrip()
    shown = repr(text[:60])
    while at < len(text):
        match = TOKEN.match(text, at)
        need(match, f"cannot read {shown}")
        tokens.append(match[1])
        at = match.end()
    tokens.reverse()  # the next token is the last of the list

    def accept(*operators):
        return tokens.pop() if tokens and tokens[-1] in operators else None

    def total(names):
        result = product(names)
        while operator := accept("+", "-"):
            term = product(names)
            result = result + term if operator == "+" else result - term
        return result

    def product(names):
        result = signed(names)
        while operator := accept("*", "/"):
            factor = signed(names)
            result = result * (factor if operator == "*" else inverse(factor))
        return result

    def signed(names):
        if sign := accept("+", "-"):
            return signed(names) if sign == "+" else -signed(names)
        base = atom(names)
        if not accept("^"):
            return base
        exponent = signed(no_names)
        k = exponent.top.number() / exponent.bottom.number()
        need(k.denominator == 1 and abs(k) <= 1000, "an exponent is not a small integer")
        return (inverse(base) if k < 0 else base) ** abs(int(k))

    def atom(names):
        token = tokens.pop() if tokens else ")"
        if token == "(":
            result = total(names)
            need(accept(")"), "')' is missing")
            return result
        if token[0] in ".0123456789":
            return F(P({(): decimal(token)}))
        need(token[0] == "_" or token[0].isalpha(), f"{token:.40} is not expected in {shown}")
        return names(token)

    result = total(names)
    need(not tokens, f"cannot read {shown}")
    return result

class Scope:
    """What names mean, and everything that was divided by."""

    def __init__(self, constants, variables):
        self.constants, self.variables, self.divisors = constants, variables, []
        self.unused = 2 + max(0, *variables.values()) if variables else 2

    def inverse(self, f):
        need(f.top.terms, "division by zero")
        self.divisors.append(f.top)
        return F(f.bottom, f.top)

    def value(self, toml, extra={}):
        """Of an expression or number in the model; `extra` are names of variables and signals."""
        need(isinstance(toml, (str, int)) and not isinstance(toml, bool), "an expression is expected")

        def named(name):
            if name in extra:
                return F(extra[name])
            return F(P.variable(self.variables[name])) if name in self.variables else self.constant(name)
        return evaluate(str(toml), named, self.inverse)

    def constant(self, name):
        need(name in self.constants, f"the name {name} is unknown, or used by itself")
        known = self.constants.pop(name)
        self.constants[name] = known if isinstance(known, F) else self.value(known)
        return self.constants[name]

    def matrix(self, toml, rows=None, columns=None):
        m = [[self.value(e) for e in row] for row in toml]
        need(rows is None or len(m) == rows and all(len(row) == columns for row in m), "sizes do not fit")
        return m

    def unknown(self):
        """A new variable."""
        self.unused += 1
        return P.variable(self.unused - 1)

def several(toml):
    return toml if isinstance(toml, list) else [toml]

# ---------------------------------------------------------------- the model

def dot(row, vector):
    return sum((c * x for c, x in zip(row, vector) if c.top.terms), F(ZERO))

def finite(text):
    need("n" not in text, f"{text} is not a number of a model")
    return text

KNOWN = {
    "model": "title time sample_time constants parameters loop block simulation",
    "parameter": "nominal min max unit description",
    "loop": "characteristic matrix A B C K states inputs E outputs",
    "loop of blocks": "inputs outputs",
    "block": "name input output discretize pwm transfer num den gain delay A B C D",
    "discretize": "method T c",
    "pwm": "amplitude carrier period",
    "simulation": "inputs initial duration units",
}

def known_keys(root):
    """Rejects every key that has no meaning: it may be a misspelt one that has."""
    def only(table, kind):
        need(isinstance(table, dict), f"{kind}: not a table")
        unknown = set(table) - set(KNOWN[kind].split())
        need(not unknown, f"{kind}: unknown key {min(unknown, default='')!r:.60}")

    only(root, "model")
    only(root.get("loop", {}), "loop of blocks" if "block" in root else "loop")
    only(root.get("simulation", {}), "simulation")
    for parameter in root.get("parameters", {}).values():
        if isinstance(parameter, dict):  # otherwise it is the nominal value
            only(parameter, "parameter")
    for block in root.get("block", []):
        only(block, "block")
        for kind in {"discretize", "pwm"} & set(block):
            only(block[kind], kind)

def characteristic_polynomial(text, kept, values):
    """(discrete, degree, coefficients of z^0, z^1, ... as polynomials in the parameter, poles)."""
    root = tomllib.loads(text.removeprefix("\ufeff"), parse_float=finite)
    known_keys(root)
    need(root.get("time") in ("discrete", "continuous"), "the model has no time")
    discrete = root["time"] == "discrete"
    z = "z" if discrete else "s"
    constants, declared = dict(root.get("constants", {})), set(root.get("parameters", {}))
    need(not declared & set(constants), "a name is both constant and parameter")
    names = ([kept] if kept is not None else []) + list(values)
    need(len(set(names)) == len(names), "a parameter has two values")
    need(declared <= set(names), "a parameter has no value")
    for name in set(names) - declared:  # a constant given as a number may be the parameter or have another number
        need(name in constants, f"the model has no parameter {name}")
        evaluate(str(constants.pop(name)), no_names, Scope({}, {}).inverse)
    constants |= {name: str(value) for name, value in values.items() if name not in declared}
    need(z not in names and z not in constants, f"{z} is the loop's variable")
    scope = Scope(constants, {name: v for v, name in enumerate(values, 2) if name in declared} | {kept: 1})
    for name in list(constants):
        scope.constant(name)
    if "sample_time" in root:
        scope.value(root["sample_time"])
    loop = root.get("loop", {})
    forms = ("characteristic" in loop, "matrix" in loop, any(k in loop for k in "ABCK"), "block" in root)
    need(sum(forms) == 1, "the model has not exactly one form of loop")
    first, written, own = scope.unused, None, []
    if forms[0]:
        written = scope.value(loop["characteristic"], {z: Z})
        need(written.bottom.degree(0) == 0, "the polynomial divides by its variable")
        degree = written.top.degree(0)
    elif forms[3]:
        equations, own, degree = diagram(loop, root["block"], z, scope)
    else:
        degree = len(loop["matrix"] if forms[1] else loop["A"])
        x = [F(scope.unknown()) for _ in range(degree)]
        if forms[1]:
            rates = [dot(row, x) for row in scope.matrix(loop["matrix"], degree, degree)]
        else:
            n, m, p = degree, len(loop["K"]), len(loop["C"])
            sizes = {"A": (n, n), "B": (n, m), "C": (p, n), "K": (m, p)}
            a, b, c, k = (scope.matrix(loop[name], *sizes[name]) for name in "ABCK")
            y = [dot(row, x) for row in c]
            u = [dot(row, y) for row in k]
            rates = [dot(a[i], x) - dot(b[i], u) for i in range(n)]
        equations = [F(Z) * x[i] - rates[i] for i in range(degree)]
        scope.matrix(loop.get("E", []))
        states = {name: ONE for name in several(loop.get("states", []))}
        for output in several(loop.get("outputs", [])):
            scope.value(output, states)

    numbers = list(values.values())
    # Undefined where all coefficients of a divisor vanish together.
    poles = [divisor.with_values(numbers).content(0).in_parameter() for divisor in scope.divisors]
    if written:
        d, lead = written.top.with_values(numbers), written.bottom.with_values(numbers)
    else:
        need(len(equations) == scope.unused - first, "there are not as many equations as unknowns")

        def system(equations, unknowns, degree):
            """Determinant and leading coefficient."""
            d = determinant([[e.top.coefficient(v, 1).with_values(numbers) for v in unknowns] for e in equations])
            need(d.degree(0) <= degree, "a determinant has too high a degree")
            return d, d.coefficient(0, degree)

        d, lead = system(equations, range(first, scope.unused), degree)
        if forms[3]:  # not well posed
            poles.append(lead.in_parameter())
        for states, among in own:  # a block loses its order, which the other blocks' numerators can hide
            poles.append(system(states, among, len(states))[1].in_parameter())
    if not lead.terms or not all(poles):
        return discrete, degree, ZERO, [[]]
    common = d.content(0).common(lead)  # to lowest terms
    if (lead / common).in_parameter()[-1] < 0:
        common = -common
    return discrete, degree, d / common, poles

def determinant(m):
    """Up to a number, by Bareiss' elimination of integers [Bareiss1968].

    The variables are powers of 2 so large that the coefficients can be read off the value, digit by digit.
    """
    rows = [primitive([c for e in row for c in e.terms.values()]) for row in m]
    bits = prod(sum(map(abs, row)) for row in rows).bit_length() + 1  # no coefficient is greater than the product
    width = 1 + sum(max(e.degree(1) for e in row) for row in m)
    for i, row in enumerate(m):
        numbers = iter(rows[i])
        exponents = [[(*e, 0, 0)[:2] for e in entry.terms] for entry in row]
        rows[i] = [sum(next(numbers) << bits * (j * width + k) for j, k in entry) for entry in exponents]
    last = 1
    while rows:
        pivot = min((row for row in rows if row[0]), key=lambda row: abs(row[0]), default=None)
        if pivot is None:
            return ZERO
        rows.remove(pivot)
        rows = [[(pivot[0] * x - row[0] * y) // last for x, y in zip(row[1:], pivot[1:])] for row in rows]
        last = pivot[0]
    digits = []
    while last:
        digit = last & (1 << bits) - 1
        digits.append(digit - (digit >> bits - 1 << bits))
        last = last - digits[-1] >> bits
    return P({monomial(divmod(k, width)): c for k, c in enumerate(digits)})

def diagram(loop, blocks, z, scope):
    """The equations of all blocks in the driven signals and the states; of each block with states its own equations
    and states; and the sum of the orders."""
    first, equations, own, degree = scope.unused, [], [], 0
    driven = [name for block in blocks for name in several(block.get("output", []))]
    external = several(loop.get("inputs", []))
    signals = {name: ZERO for name in external} | {name: scope.unknown() for name in driven}
    need(len(signals) == len(driven) + len(external), "a signal is driven twice")
    need(not set(signals) & {*scope.constants, *scope.variables}, "a signal is also something else")
    for block in blocks:
        inputs = [scope.value(e, signals) for e in several(block.get("input", []))]
        need(all(len(e) > first for i in inputs for e in i.top.terms), "an input has a constant term")
        outputs = [F(signals[name]) for name in several(block.get("output", []))]
        up, down, inner = Z, ONE, z
        if "discretize" in block:  # s = up / down
            need(z == "z", "a continuous loop has nothing to discretise")
            rule, inner = block["discretize"], "s"
            t, c = (scope.value(rule[key]) if key in rule else None for key in ("T", "c"))
            if rule.get("method") in ("forward", "backward") and t and not c:
                up, down = (Z - ONE) * t.bottom, t.top * (ONE if rule["method"] == "forward" else Z)
            else:
                need(rule.get("method") == "tustin" and (t or c), "'discretize' is not complete")
                c = c or F(ONE + ONE) * scope.inverse(t)
                up, down = (Z - ONE) * c.top, (Z + ONE) * c.bottom
        for key in ("amplitude", "carrier", "period"):
            if key in block.get("pwm", {}):
                scope.value(block["pwm"][key])
        kinds = [any(k in block for k in keys) for keys in (["transfer"], ["gain"], ["delay"], ["num", "den"], "ABCD")]
        need(sum(kinds) == 1, "a block does not say exactly once what it does")
        if kinds[4]:
            order, state = len(block.get("A", [])), scope.unused
            need(("A" in block) == ("B" in block) and ("A" in block or "C" not in block), "A and B are needed")
            sizes = {"A": (order, order), "B": (order, len(inputs)), "C": (len(outputs), order)}
            sizes["D"] = (len(outputs), len(inputs))
            a, b, c, d = (scope.matrix(block[k], *sizes[k]) if k in block else [] for k in "ABCD")
            x = [F(scope.unknown()) for _ in range(order)]
            seen = [dot(row, x) for row in c] if "C" in block else x if order else [F(ZERO)] * len(outputs)
            need(len(seen) == len(outputs), "sizes do not fit")
            for i in range(order):
                equations.append(F(up) * x[i] - F(down) * (dot(a[i], x) + dot(b[i], inputs)))
            own.append((equations[len(equations) - order:], range(state, state + order)))
            for i, y in enumerate(outputs):
                equations.append(y - seen[i] - (dot(d[i], inputs) if d else F(ZERO)))
            degree += order
            continue
        need(len(inputs) == 1 and len(outputs) == 1, "a transfer function has one input and one output")
        if kinds[3]:
            num, den = (dot([scope.value(e) for e in several(block[key])][::-1],
                            [F(Z ** k) for k in range(len(several(block[key])))]) for key in ("num", "den"))
            num, den = num.top * den.bottom, den.top * num.bottom
        elif kinds[2]:
            samples = scope.value(block["delay"])
            samples = samples.top.number() / samples.bottom.number()
            need(samples.denominator == 1 and 0 <= samples <= 2000 and inner == "z", "a delay is a number of samples")
            num, den = ONE, Z ** int(samples)
        else:
            f = scope.value(block["transfer"], {inner: Z}) if kinds[0] else scope.value(block["gain"])
            num, den = f.top, f.bottom
        order = den.degree(0)
        need(den.terms and num.degree(0) <= order, "a transfer function is improper")
        scope.divisors.append(den.coefficient(0, order))
        if "discretize" in block:
            num, den = (sum((c * up ** k * down ** (order - k) for k, c in enumerate(p.coefficients(0))), ZERO)
                        for p in (num, den))
            scope.divisors.append(den.coefficient(0, order))
        equations.append(F(den) * outputs[0] - F(num) * inputs[0])
        degree += order
    for output in several(loop.get("outputs", [])):
        scope.value(output, signals)
    return equations, own, degree

# ---------------------------------------------------------------- roots and boundaries

def is_stable(d, discrete):
    """All roots strictly inside: Schur-Cohn's reduction, or Routh's."""
    while len(d) > 1:
        n, first, next_to_last, last = len(d) - 1, d[0], d[-2], d[-1]
        if discrete:
            if abs(first) >= abs(last):
                return False
            d = [last * d[k] - first * d[n - k] for k in range(1, n + 1)]
        else:
            if last * next_to_last <= 0:
                return False
            odd = [d[k] if (n - k) % 2 else 0 for k in range(n)]  # d_(n-1), d_(n-3), ...
            d = [next_to_last * d[k] - (last * odd[k - 1] if k else 0) for k in range(n)]
        d = primitive(d)
    return bool(d)

def at_minus_infinity(f):
    return f[-1] * (-1) ** (len(f) - 1)

def sturm(f, g):
    """The chain f, g, and minus the remainder each time."""
    chain = [primitive(f), primitive(g)]
    while chain[-1]:
        chain.append([-c for c in primitive(divided(*chain[-2:])[1])])
    return chain[:-1]

def places(d, discrete):
    """The numbers of roots inside, on and outside."""
    if discrete:
        on = 0
        while value(d, -1) == 0:
            d, on = divided(d, [1, 1])[0], on + 1
        inside, more, outside = places(quotient_put_in(d, [1, 1], [1, -1]), False)  # z = (1 + s)/(1 - s)
        return inside, on + more, outside
    h = common_divisor(d, [(-1) ** k * c for k, c in enumerate(d)])  # the roots that are mirror images
    rest = divided(d, h)[0]
    on = next(k for k, c in enumerate(h) if c)
    e = h[on::2]  # h = s^on e(s^2): each negative root of e is a pair on the axis
    while len(e) > 1:
        chain = sturm(e, derivative(e))
        on += 2 * (changes(at_minus_infinity(f) for f in chain) - changes(f[0] for f in chain))
        e = common_divisor(e, derivative(e))
    n = len(rest) - 1
    # The Cauchy index of the odd part over the even part along the axis is roots left minus roots right.
    turned = [(-1) ** ((n - k) // 2) * c for k, c in enumerate(rest)]
    chain = sturm([c * ((n - k) % 2 == 0) for k, c in enumerate(turned)],
                  trim([c * ((n - k) % 2 == 1) for k, c in enumerate(turned)]))
    index = changes(at_minus_infinity(f) for f in chain) - changes(f[-1] for f in chain)
    inside = (len(h) - 1 - on) // 2 + (n + index) // 2
    return inside, on, len(d) - 1 - on - inside

def half_size_pair(d, discrete):
    """A and B, polynomials in x (variable 0) and the parameter, and their formal degrees: see the grammar."""
    n = len(d) - 1
    k = n // 2
    degree_b = k - 1 if n % 2 == 0 else k
    if not discrete:
        return P.table(d[0::2]), k, P.table(d[1::2]), degree_b

    def in_x(p, m):  # z^-m p in x = z + 1/z
        out = ZERO
        for j in range(m, -1, -1):
            top = (p.coefficients(0) + [ZERO] * (2 * m + 1))[m + j]
            out += top * Z ** j
            p -= top * (Z ** 2 + ONE) ** j * Z ** (m - j)
        return out

    plus, minus = P.table(d) + P.table(d[::-1]), P.table(d) - P.table(d[::-1])
    if n % 2 == 0:
        return in_x(plus, k), k, in_x(minus / (Z ** 2 - ONE), k - 1), degree_b
    return in_x(plus / (Z + ONE), k), k, in_x(minus / (Z - ONE), k), degree_b

# ---------------------------------------------------------------- the parts of a certificate

def integer(text):
    need(isinstance(text, str) and re.fullmatch("-?[0-9]+", text), "not an integer")
    need(len(text.lstrip("-")) <= MAX_DIGITS, "a number has too many digits")
    return int(text)

def rational(text):
    need(isinstance(text, str), "not a number")
    top, slash, bottom = text.partition("/")
    d = integer(bottom) if slash else 1
    need(d > 0, "a denominator is not positive")
    return Fraction(integer(top), d)

def name_of(text):
    need(isinstance(text, str) and re.fullmatch(r"[^\W\d]\w*", text), "not a name")
    return text

def count(number):
    need(type(number) is int, "not a count")
    return number

def items(json_list, kind):
    need(isinstance(json_list, list), "not a list")
    return [kind(item) for item in json_list]

def polynomial(coefficients):
    p = items(coefficients, integer)
    need(p == trim(p), "a polynomial has a zero at the top")
    return p

def polynomials(json_list):
    return items(json_list, polynomial)

def pair(json_list):
    ab = items(json_list, rational)
    need(len(ab) == 2 and ab[0] < ab[1], "not a pair in order")
    return ab

def parts(json_object, names, optional=()):
    need(isinstance(json_object, dict), "an object is expected")
    need(set(names) <= set(json_object) <= {*names, *optional}, f"the keys are not {', '.join(names)}")
    return [json_object[name] for name in names]

def end(json_value):
    if not isinstance(json_value, dict):
        return None if json_value is None else rational(json_value)
    p, between = parts(json_value, ["polynomial", "between"])
    return polynomial(p), pair(between)

def strict(pairs):
    need(len({key for key, _ in pairs}) == len(pairs), "a key occurs twice")
    return dict(pairs)

def small(text):
    need(re.fullmatch("[0-9]{1,9}", text), "only small counts are written as numbers")
    return int(text)

def depth(json_value):
    inside = json_value.values() if isinstance(json_value, dict) else json_value
    return 1 + max(map(depth, inside), default=0) if isinstance(json_value, (dict, list)) else 0

def read(certificate):
    need(len(certificate) <= MAX_TEXT, "the text is too long")
    hooks = {"parse_int": small, "parse_float": small, "parse_constant": small, "object_pairs_hook": strict}
    document = json.loads(certificate, **hooks)
    need(depth(document) <= MAX_DEPTH, "nested too deep")
    need(isinstance(document, dict) and document.get("schema") == "jurist/certificate/1", "unknown schema")
    return document

# ---------------------------------------------------------------- the check

def in_region(d, n, discrete, extent):
    """The coefficients of D(R z) or D(s - S): integers without a common factor; a positive factor is lost."""
    extent = P.variable(1) if extent == "parameter" else P({(): extent})
    argument = Z * extent if discrete else Z - extent
    d = sum((c * argument ** k for k, c in enumerate(d.coefficients(0))), ZERO)
    rows = d.primitive().rows()
    return rows + [[]] * (n + 1 - len(rows))

def check(model, certificate):
    """The proved statement as a sentence; raises an exception if it is not proved."""
    document = read(certificate)
    statement = document["statement"]
    kind, time, values, region = (statement[key] for key in ("kind", "time", "set", "region"))
    need(kind in ("intervals", "verdict"), "unknown kind of statement")
    need(time in ("discrete", "continuous"), "unknown time")
    discrete = time == "discrete"
    values = {name_of(name): rational(x) for name, x in values.items()}
    [extent] = parts(region, ["radius" if discrete else "decay"])
    extent = "parameter" if extent == "parameter" else rational(extent)
    need(not discrete or extent == "parameter" or extent > 0, "the radius is not positive")
    if kind == "verdict":
        return check_verdict(model, document, statement, values, discrete, extent)
    names = ["schema", "statement", "characteristic", "boundary", "factors", "line"]
    _, _, characteristic, boundary, factors, line = parts(document, names, ["model"])
    names = ["kind", "time", "set", "region", "parameter", "domain", "stable"]
    *_, parameter, domain, claimed = parts(statement, names)
    name_of(parameter)
    low, high = (None if b is None else rational(b) for b in parts(domain, ["lower", "upper"]))
    need(low is None or high is None or low < high, "the domain is empty")
    relative = extent == "parameter"
    if relative:
        need(parameter == ("radius" if discrete else "decay"), "the parameter is not that of the region")
        need(parameter not in values, "the model has a parameter of this name")
        need(not discrete or low is not None and low >= 0, "a radius is positive")
    claimed = items(claimed, lambda interval: [end(e) for e in parts(interval, ["lower", "upper"])])
    is_discrete, n, d, poles = characteristic_polynomial(model, None if relative else parameter, values)
    need(is_discrete == discrete, "the model's time is another")
    d = in_region(d, n, discrete, extent) if all(poles) else []
    need(polynomials(characteristic) == d, "characteristic: not that of the model")
    certain, identity, nowhere = boundaries(d, n, discrete, poles, boundary)
    factors = polynomials(factors)
    if nowhere:
        need(factors == line == claimed == [], "the loop is stable nowhere")
    else:
        need(all(len(f) > 1 for f in factors), "factors: one is constant")
        for p in certain + ([identity["value"]] if identity else []):
            for f in factors:
                while divides(f, p):
                    p = primitive(divided(p, f)[0])
            need(len(p) == 1, "factors: a boundary polynomial is not a product of them")
        found = walk(d, n, discrete, certain, identity, factors, line, low, high)
        need(found == claimed, "stable: the claimed set is not the one that the line shows")
    given = ", ".join([f"{low} < {parameter} < {high}".replace("None < ", "").replace(" < None", ""),
                       *(f"{name} = {x}" for name, x in values.items())])
    where = [f"{in_words(lower, '-infinity')} to {in_words(upper, 'infinity')}" for lower, upper in claimed]
    return f"in {time} time, {given}, {region}: stable exactly for {parameter} from {' or '.join(where) or 'nowhere'}"

def in_words(e, infinite):
    if e is None:
        return infinite
    return str(e) if isinstance(e, Fraction) else f"[the root of {e[0]} in ({e[1][0]}, {e[1][1]})]"

def boundaries(d, n, discrete, poles, boundary):
    """The polynomials at whose zeros the loop is not stable, the identity, whether the loop is stable nowhere."""
    certain = poles + [d[n] if d else []]
    if n > 0 and d:
        for x in (1, -1) if discrete else (0,):
            certain.append(trim([value(column, x) for column in zip_longest(*d, fillvalue=0)]))
    if n < 2 or not all(certain):
        need(boundary is None, "boundary: must be null")
        return certain, None, not all(certain)
    u, v, result = parts(boundary, ["u", "v", "value"])
    u, v, result = polynomials(u), polynomials(v), polynomial(result)
    a, degree_a, b, degree_b = half_size_pair(d, discrete)
    need(len(u) <= degree_b and len(v) <= degree_a, "boundary: a cofactor's degree is too high")
    need(any(u) or any(v), "boundary: both cofactors are zero")
    need(P.table(u) * a + P.table(v) * b == P.table([result]), "boundary: the identity does not hold")
    return certain, {"u": u, "v": v, "value": result}, not result

def walk(d, n, discrete, certain, identity, factors, line, low, high):
    """The stable intervals that the line from `low` to `high` shows."""
    def none_between(a, b):
        return all(descartes(f, a, b) == 0 for f in factors)

    def domain_end(x):
        return {"end": x, "left": x, "right": x, "regular": False, "factor": None, "touch": None}

    def point(item):
        touch = item.get("touch")
        if touch is not None:
            need(isinstance(touch, list) and len(touch) == 2 and touch[0] in ("u", "v"), "line: bad touch")
            count(touch[1])
        if "at" in item:
            x = rational(parts(item, ["at"], ["touch"])[0])
            need(any(value(f, x) == 0 for f in factors), "line: no factor vanishes at 'at'")
            return domain_end(x) | {"touch": touch}
        between, k = parts(item, ["between", "factor"], ["touch"])
        (a, b), k = pair(between), count(k)
        need(k < len(factors), "line: there is no such factor")
        for i, f in enumerate(factors):
            need(value(f, a) != 0 and value(f, b) != 0, "line: a factor vanishes at an end of 'between'")
            need(descartes(f, a, b) == (i == k), "line: 'between' is not shown to hold just one root")
        root = {"end": (factors[k], [a, b]), "left": a, "right": b}
        return root | {"regular": True, "factor": factors[k], "touch": touch}

    def stretch(item, before, after):
        split, sample, stable = parts(item, ["split", "sample", "stable"])
        split, s, left, right = items(split, rational), rational(sample), before["right"], after["left"]
        need(type(stable) is bool, "line: 'stable' is not true or false")
        one_point = before["regular"] and after["regular"] and left == right and not split
        ends = [left, *split, right]
        for a, b in zip(ends, ends[1:]):
            need(one_point or a is None or b is None or a < b, "line: the points are not in order")
            need(one_point or none_between(a, b), "line: a stretch is not shown to have no roots")
        need(all(value(f, x) != 0 for f in factors for x in split), "line: a factor vanishes at a split point")
        need(left is None or left < s or left == s and before["regular"], "line: the sample is outside")
        need(right is None or s < right or s == right and after["regular"], "line: the sample is outside")
        at_sample = trim([value(c, s) for c in d])
        need(len(at_sample) == n + 1, "line: the sample loses degree")
        need(is_stable(at_sample, discrete) == stable, "line: at a sample the verdict is wrong")
        return stable

    def excluded(p):
        """The loop is undefined there, loses degree, or has a root on the boundary or a pair of mirror images."""
        x, f, touch = p["end"], p["factor"], p["touch"]
        vanishes = (lambda g: divides(f, g)) if f else (lambda g: value(g, x) == 0)
        if any(map(vanishes, certain)):
            return True
        if identity is None or touch is None or not vanishes(identity["value"]):
            return False
        w = dict(enumerate(identity[touch[0]])).get(touch[1])  # not zero there: Theorem 2
        return bool(w) and (descartes(w, p["left"], p["right"]) == 0 if f else value(w, x) != 0)

    need(isinstance(line, list) and len(line) % 2 == 1, "line: must begin and end with a stretch")
    before, was_stable, found = domain_end(low), False, []
    for i in range(0, len(line), 2):
        after = point(line[i + 1]) if i + 1 < len(line) else domain_end(high)
        stable = stretch(line[i], before, after)
        need(not (stable and was_stable) or excluded(before), "line: a point between two stable stretches")
        if stable:
            found.append([before["end"], after["end"]])
        before, was_stable = after, stable
    return found

def check_verdict(model, document, statement, values, discrete, extent):
    _, _, characteristic = parts(document, ["schema", "statement", "characteristic"], ["model"])
    names = ["verdict", "degree", "inside", "on", "outside", "infinite"]
    name, *counts = parts(statement, names, ["kind", "time", "set", "region"])
    need(extent != "parameter", "the region has no parameter here")
    is_discrete, n, d, poles = characteristic_polynomial(model, None, values)
    need(is_discrete == discrete, "the model's time is another")
    d = in_region(d, n, discrete, extent) if all(poles) else []
    need(polynomials(characteristic) == d, "characteristic: not that of the model")
    p = trim([value(c, 0) for c in d])
    inside, on, outside = places(p, discrete) if p else (0, 0, 0)
    infinite = n - (inside + on + outside) if all(poles) else 0
    found = "unstable" if outside + infinite or not p else "marginal" if on else "stable"
    found = [found if all(poles) else "undefined", n, inside, on, outside, infinite]
    need([name, *map(count, counts)] == found, f"stable: it is {dict(zip(names, found))}")
    at = ", ".join(f"{name} = {x}" for name, x in values.items())
    roots = ", ".join(f"{name} {x}" for name, x in zip(names, found))
    return f"in {statement['time']} time, {at or 'without parameters'}, {statement['region']}: {roots}"


# Whatever is wrong in a certificate or a model ends in one of these; the check itself has no other way out.
FAILURES = (ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError, Rejected, TypeError, ValueError)

def judge(model, certificate):
    """Whether the certificate is accepted, and the statement or the reason."""
    try:
        return True, check(model, certificate)
    except FAILURES as error:
        return False, f"{type(error).__name__}: {error}"

def main():
    if len(sys.argv) != 3:
        sys.exit("usage: check.py MODEL CERTIFICATE")

    def give_up():
        print(f"rejected: the check takes longer than {SECONDS} s", file=sys.stderr, flush=True)
        os._exit(4)

    timer = threading.Timer(SECONDS, give_up)
    timer.daemon = True
    timer.start()
    try:
        texts = [open(name, encoding="utf-8", newline="").read(MAX_TEXT + 1) for name in sys.argv[1:]]
    except (OSError, UnicodeDecodeError) as error:
        accepted, sentence = False, str(error)
    else:
        accepted, sentence = judge(*texts)
    print("proved:" if accepted else "rejected:", sentence, file=sys.stdout if accepted else sys.stderr)
    sys.exit(0 if accepted else 4)


if __name__ == "__main__":
    main()
