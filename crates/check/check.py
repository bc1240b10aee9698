#!/usr/bin/env python3
"""Checks a certificate of jurist against a model:  check.py MODEL CERTIFICATE

A second checker, independent of the program: plain Python (3.11) with nothing but its standard library, exact
integers throughout, no search.  The grammar of certificates, and why these checks suffice, is in the documentation
of jurist's module `certificate`.  Exit status 0: proved; 4: rejected.

Whatever the form of the loop, it is read as linear equations in signals and states.  They are linear by the reading:
the values of expressions are objects of class Linear, which have no other operations.

Polynomials are objects of class P, or lists of integers, the constant term first, where numbers are put in.
"""
import hashlib
import json
import re
import signal
import sys
import tomllib
from bisect import bisect_left
from fractions import Fraction
from functools import reduce
from itertools import accumulate
from math import comb, gcd, isqrt, lcm, prod

VERSION = "0.3.0"
MAX_TEXT, MAX_MODEL = 64 << 20, 4 << 20  # characters
MAX_DIGITS = 100_000
MAX_BITS = 1 << 22  # of the numbers that the check computes
MAX_TERMS = 100_000
MAX_DEPTH = 16  # of JSON
MAX_NESTING = 200  # of expressions
MAX_ORDER = 2000
MAX_DEGREE = 4000
MAX_WORK, WORK_OF_BYTE = 10**9, 10**6  # about as many nanoseconds: for every text, and for each byte of it
WORK_OF_PART = 10**7  # for each letter of a tree of parts in several names
MAX_BYTES = 48 << 20  # of the numbers of one step
SECONDS = 60  # the last resort
sys.set_int_max_str_digits(2 * MAX_DIGITS)
sys.setrecursionlimit(4000)

class Rejected(Exception):
    pass

class Refused(Rejected):
    """The check would be more work, or take more memory, than texts of their length may ask for."""

def need(condition, reason):
    if not condition:
        raise Rejected(reason)

def allow(condition, reason):
    if not condition:
        raise Refused(reason)

spent, most = 0, MAX_WORK

def spend(count, bits=0, others=0):
    """Counts operations on numbers of so many bits before they are done."""
    global spent
    allow(bits + others <= MAX_BITS, "a number grows too long")
    spent += count * (500 + bits // 30 + others // 30 + bits * others // 1000)
    allow(spent <= most, "the check is more work than texts of this length may ask for")

def hold(count, bits):
    """Refuses numbers that take too many bytes together, before they are computed."""
    allow(count * (bits // 8 + 32) <= MAX_BYTES, "the numbers of a step would take too much memory")

# ---------------------------------------------------------------- polynomials in one variable, as lists

def size(numbers):
    """The bits of the longest."""
    return max((c.bit_length() for c in numbers), default=0)

def value(p, x):
    """At a rational number, times its denominator to the power of len(p) - 1."""
    (top, bottom), result, power = x.as_integer_ratio(), 0, 1
    spend(len(p), size(p) + len(p) * top.bit_length(), len(p) * bottom.bit_length())
    for c in reversed(p):
        result, power = result * top + c * power, power * bottom
    return result

def changes(signs):
    """The number of sign changes, zeros left out."""
    signs = [s > 0 for s in signs if s != 0]
    return sum(a != b for a, b in zip(signs, signs[1:]))

def mirrored(p):
    """p(-x)"""
    return [-c if k % 2 else c for k, c in enumerate(p)]

def shifted(p, a):
    """p(x + a) by Horner's scheme; zeros at the top stay."""
    c, out = p[::-1], []
    if p and isinstance(p[0], int):
        spend(len(p) ** 2 // 2, size(p) + len(p) * a.bit_length(), a.bit_length())
    while c:
        c = list(accumulate(c, lambda s, x: s * a + x))
        out.append(c.pop())
    return out

def scaled(p, top, bottom=1):
    """bottom^d p(top/bottom x), d the degree."""
    spend(2 * len(p), size(p) + len(p) * top.bit_length(), len(p) * bottom.bit_length())
    return [c * top ** k * bottom ** (len(p) - 1 - k) for k, c in enumerate(p)]

def descartes(p, a, b):
    """At least the number of roots in the open interval (a, b), equal to it if 0 or 1; None is an infinite end."""
    if len(p) < 2 or a is b is None:
        return len(p) - 1 if p else 0
    if a is None:
        p, a, b = mirrored(p), -b, None
    width = Fraction(1) if b is None else b - a
    bottom = lcm(a.denominator, width.denominator)
    p = scaled(shifted(scaled(p, 1, bottom), int(a * bottom)), int(width * bottom))  # of t in a + width t
    return changes(p if b is None else shifted(p[::-1], 1))  # t = 1/(1 + y)

# ---------------------------------------------------------------- polynomials in several variables

FIELD = 16  # bits of an exponent, of which the highest four stay free
MASK = (1 << FIELD) - 1
HIGHEST = int("f000" * 1000, 16)

class P(dict):
    """Integer coefficients by exponents, which are packed into one integer: x_v^k is k << FIELD v.

    Variable 0 is z (or s), 1 the parameter in question, the others are those that have a value.
    """

    @staticmethod
    def of(numbers, v=0):
        """From a list of coefficients, or a dictionary."""
        items = numbers.items() if isinstance(numbers, dict) else enumerate(numbers)
        return P({k << FIELD * v: c for k, c in items if c})

    def listed(self, v):
        """The coefficients of a polynomial in variable v alone."""
        return [self.get(k << FIELD * v, 0) for k in range(self.degree(v) + 1)] if self else []

    def __add__(self, other):
        spend(2 * (len(self) + len(other)))
        out = dict(self)
        for e, c in other.items():
            out[e] = out.get(e, 0) + c
        return P.of(out)

    def __neg__(self):
        return P({e: -c for e, c in self.items()})

    def __mul__(self, other):
        bits = size(self.values()), size(other.values())
        hold(min(len(self) * len(other), MAX_TERMS), sum(bits))
        spend(5 + len(self) * len(other), *bits)
        out = {}
        for e, c in self.items():
            for f, d in other.items():
                out[e + f] = out.get(e + f, 0) + c * d
        allow(len(out) <= MAX_TERMS and not any(e & HIGHEST for e in out), "an expression grows too large")
        return P.of(out)

    def __pow__(self, k):
        if not any(self):  # a number
            spend(k, k * size(self.values()))
            return number(self.get(0, 0) ** k)
        out = ONE
        for _ in range(k):
            out = out * self
        return out

    def __truediv__(self, other):
        """The quotient of a division without remainder, otherwise None."""
        quotient, rest, lead = P(), dict(self), max(other)
        while rest:
            spend(2 * len(other) + len(rest) // 4, size(rest.values()), size(other.values()))
            e = max(rest) - lead
            factor, no = divmod(rest[e + lead], other[lead])
            if no or e < 0 or e & HIGHEST:
                return None
            quotient[e] = factor
            for f, c in other.items():
                rest[e + f] = rest.get(e + f, 0) - factor * c
                if not rest[e + f]:
                    del rest[e + f]
        return quotient

    def degree(self, v):
        return max((e >> FIELD * v & MASK for e in self), default=0)

    def coefficients(self, v):
        """The coefficients of the powers of one variable, the constant term first."""
        spend(4 * len(self))
        out = [P() for _ in range(self.degree(v) + 1)]
        for e, c in self.items():
            k = e >> FIELD * v & MASK
            out[k][e - (k << FIELD * v)] = c
        return out

    def content(self, v):
        content = P()
        for c in self.coefficients(v):
            content = content if content == ONE else content.common(c)
        return content

    def lead(self, v):
        """The leading coefficient."""
        spend(4 * len(self))
        top = self.degree(v) << FIELD * v
        return P({e - top: c for e, c in self.items() if e & MASK << FIELD * v == top})

    def over(self, x):
        return P({e: c // x for e, c in self.items()}) if x > 1 else self

    def primitive(self):
        """Without a common factor of the numbers; a positive factor is lost."""
        spend(1 + len(self) // 10, size(self.values()), size(self.values()))
        return self.over(gcd(*self.values()))

    def remainder(self, other, v):
        """A multiple, by a positive number if no other variable occurs."""
        a, b = self, -other if other.lead(v).get(0, 0) < 0 else other
        while a and a.degree(v) >= b.degree(v):
            shift = P({a.degree(v) - b.degree(v) << FIELD * v: 1})
            a = a * b.lead(v) + -(b * (a.lead(v) * shift))
        return a.primitive()

    def common(self, other):
        """A greatest common divisor without an integer factor, by primitive remainders in the last variable."""
        a, b = self.primitive(), other.primitive()
        if not a or not b:
            return a or b
        v = (max(*a, *b, 0).bit_length() - 1) // FIELD
        if v < 0 or a == b:
            return a if a == b else ONE
        contents = a.content(v), b.content(v)
        a, b, content = a / contents[0], b / contents[1], contents[0].common(contents[1])
        if a.degree(v) < b.degree(v):
            a, b = b, a
        while b and b.degree(v):
            rest = a.remainder(b, v)
            a, b = b, (rest / rest.content(v)).primitive() if rest else rest
        return content if b else content * a

    def at(self, values):
        """Numbers in the place of the variables from 2 on; the coefficients are rational.  Symbols come down to 2."""
        out = {}
        for e, c in self.items():
            key, e = e & (MASK << FIELD | MASK), e >> 2 * FIELD
            for x in values:
                k = e & MASK
                spend(1, size([c.numerator, c.denominator]), k * size(x.as_integer_ratio()))
                c, e = c * x ** k, e >> FIELD
            key |= e << 2 * FIELD
            out[key] = out.get(key, 0) + c
        return P.of(out)

ZERO, ONE, Z = P(), P({0: 1}), P({1: 1})

def number(x):
    return P({0: x}) if x else ZERO

MAX_VARIABLES = 900  # none may be the unit or the factor
UNIT = 1 << 950 * FIELD  # the imaginary unit, behind all other variables
FACTOR = 1 << 951 * FIELD  # the complex factor at the cut of a loop; while it has no value, what contains it has no real part

def is_real(*polynomials):
    return all(e < UNIT for p in polynomials for e in p)

def has_unit(p):
    return any(e >> 950 * FIELD & MASK for e in p)

def re_im(p):
    """The real and the imaginary part."""
    need(max(p, default=0) < FACTOR, "the factor of the cut is inside of what must be a number")
    found = {}, {}
    for e, c in p.items():
        k, e = divmod(e, UNIT)
        found[k % 2][e] = found[k % 2].get(e, 0) + (c if k % 4 < 2 else -c)
    return [P.of(part) for part in found]

def with_unit(x, y):
    return x + y * P({UNIT: 1})

def short(p):
    """With j^2 = -1."""
    if max(p, default=0) < 2 * UNIT:
        return p
    spend(2 * len(p))
    out = {}
    for e, c in p.items():
        k = e >> 950 * FIELD & MASK
        e -= (k - k % 2) * UNIT
        out[e] = out.get(e, 0) + (c if k % 4 < 2 else -c)
    return P.of(out)

def conjugated(p):
    x, y = re_im(p)
    return with_unit(x, -y)

def squared_modulus(p):
    x, y = re_im(p)
    return x * x + y * y

class Value:
    """A sum of signals and states with coefficients, and a constant (under the name ""), over one denominator.

    It is linear by construction.  A signal that occurs is there, be its coefficient zero.  Only numbers are cancelled, so
    that everything divided by stays visible.
    """

    def __init__(self, tops, bottom=ONE):
        tops, bottom = {name: short(p) for name, p in tops.items()}, short(bottom)
        numbers = [c for p in (bottom, *tops.values()) for c in p.values()]
        spend(50 + len(numbers), size(numbers), size(numbers))
        common = gcd(*numbers)
        self.tops = {name: p.over(common) for name, p in tops.items()}
        self.bottom = bottom.over(common)

    def scalar(self):
        need(set(self.tops) <= {""}, "a signal where none may be: in a divisor, in a power, or times another one")
        return self.tops.get("", ZERO)

    def __add__(self, other):  # over the least common denominator
        left = right = ONE
        if self.bottom != other.bottom:
            common = self.bottom.common(other.bottom)
            left, right = other.bottom / common, self.bottom / common
        tops = {name: p * left for name, p in self.tops.items()}
        for name, p in other.tops.items():
            tops[name] = tops.get(name, ZERO) + p * right
        return Value(tops, self.bottom * left)

    def __neg__(self):
        return Value({name: -p for name, p in self.tops.items()}, self.bottom)

    def __mul__(self, other):
        one, factor = (self, other) if set(self.tops) - {""} else (other, self)
        return Value({name: p * factor.scalar() for name, p in one.tops.items()}, one.bottom * factor.bottom)

    def __pow__(self, k):
        return self if k == 1 else Value({"": self.scalar() ** k}, self.bottom ** k)

    def number(self):
        """If no variable occurs; otherwise None."""
        return None if any(self.scalar()) or any(self.bottom) else Fraction(self.scalar().get(0, 0), self.bottom[0])

    def is_real(self):
        return is_real(self.bottom, *self.tops.values())

    def parts(self):
        """The real and the imaginary part of a value without signals."""
        if self.is_real():
            return self, NOTHING
        below = conjugated(self.bottom)
        return [Value({"": part}, short(self.bottom * below)) for part in re_im(self.scalar() * below)]

    def conjugate(self):
        return Value({"": conjugated(self.scalar())}, conjugated(self.bottom))

def real(f):
    need(f is None or f.is_real(), "what has to be real is complex")
    return f

def scalar(p):
    return Value({"": p})

NOTHING = scalar(ZERO)

def dot(row, values):
    return sum((c * x for c, x in zip(row, values) if c.scalar() and x.tops), NOTHING)

# ---------------------------------------------------------------- expressions

DIGITS = "[0-9](?:_?[0-9])*"
NUMBER = rf"(?:{DIGITS}(?:\.(?:{DIGITS})?)?|\.{DIGITS})(?:[eE][+-]?{DIGITS})?(?![\w.])"
BLANK = r"[^\S\x1c-\x1f]*"  # what Unicode calls white space
BLANKS = "".join(c for c in map(chr, range(0x3001)) if c.isspace() and c not in "\x1c\x1d\x1e\x1f")
TOKEN = re.compile(rf"{BLANK}({NUMBER}|[^\W\d]\w*|[-+*/^()])")

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")

class Number(str):
    """A number of a TOML text that is no integer, as it is written."""

    def __new__(cls, text):
        need("n" not in text, f"{text} is not a number of a model")
        return super().__new__(cls, text)

def is_name(text):
    if any(c in "\u115f\u1160\u3164\uffa0" for c in text):  # letters that are drawn as nothing
        return False
    return re.fullmatch(r"[^\W\d]\w*", text) and (text[0] == "_" or text[0].isalpha())

def decimal(text):
    mantissa, _, exponent = text.lower().partition("e")
    need(len(mantissa) <= MAX_DIGITS and len(exponent) < 8 and abs(int(exponent or 0)) <= MAX_DIGITS, "a number is too long")
    spend(1, 4 * len(mantissa), 4 * len(mantissa) + 4 * abs(int(exponent or 0)))
    x = Fraction(text)
    return Value({"": number(x.numerator)}, number(x.denominator))

def tokens_of(text):
    tokens, at, text = [], 0, text.rstrip(BLANKS)
    while at < len(text):
        match = TOKEN.match(text, at)
        need(match, f"cannot read {text[:60]!r}")
        tokens.append(match[1])
        at = match.end()
    return tokens

def no_names(name):
    raise Rejected(f"the name {name:.40} where only numbers may stand")

def evaluate(text, names, inverse, functions={}):
    """The value of an expression; `names` and `inverse` are functions, those that it may call have names."""
    tokens, depth = tokens_of(text)[::-1], 0  # the next token is the last of the list

    def accept(*operators):
        return tokens.pop() if tokens and tokens[-1] in operators else None

    def nested(part, names):
        nonlocal depth
        depth += 1
        need(depth <= MAX_NESTING, "an expression is nested too deep")
        result = part(names)
        depth -= 1
        return result

    def total(names):
        result = product(names)
        while operator := accept("+", "-"):
            term = product(names)
            result = result + (term if operator == "+" else -term)
        return result

    def product(names):
        result = signed(names)
        while operator := accept("*", "/"):
            factor = signed(names)
            result = result * (factor if operator == "*" else inverse(factor))
        return result

    def signed(names):
        if sign := accept("+", "-"):
            return nested(signed, names) if sign == "+" else -nested(signed, names)
        base = atom(names)
        if not accept("^"):
            return base
        k = nested(signed, no_names).number()
        need(k.denominator == 1 and abs(k) <= 1000, "an exponent is not a small integer")
        return (inverse(base) if k < 0 else base) ** abs(int(k))

    def atom(names):
        token = tokens.pop() if tokens else ")"
        if token == "(":
            result = nested(total, names)
            need(accept(")"), "')' is missing")
            return result
        if token[0] in ".0123456789":
            return decimal(token)
        need(is_name(token), f"{token:.40} is not expected in {text[:60]!r}")
        if token in functions and accept("("):
            result = functions[token](nested(total, names))
            need(accept(")"), "')' is missing")
            return result
        return names(token)

    result = total(names)
    need(not tokens, f"cannot read {text[:60]!r}")
    return result

def without_exponentials(tokens, depth=0):
    """Without those factors of the whole that are exponentials of s, and their exponents."""
    need(depth <= MAX_NESTING, "an expression is nested too deep")
    partner, opened = {}, []
    for i, token in enumerate(tokens):
        if token == "(":
            opened.append(i)
        elif token == ")" and opened:
            partner[opened.pop()] = i
    factors, found, begin, i, operator = [], [], 0, 0, "*"
    while i <= len(tokens):
        token = tokens[i] if i < len(tokens) else "end"
        if token == "(":
            i = partner.get(i, len(tokens) - 1)
        elif token in ("+", "-") and i > begin and tokens[i - 1] not in ("+", "-", "^"):
            return tokens, []  # a sum
        elif token in ("*", "/", "end"):
            at = next((k for k in range(begin, i) if tokens[k] not in ("+", "-")), i)
            signs, factor = tokens[begin:at], tokens[at:i]
            if operator == "*" and factor[:2] == ["exp", "("] and partner.get(at + 1) == i - 1 and "s" in factor:
                found.append(factor[2:-1])
                factor = ["1"]
            elif operator == "*" and factor[:1] == ["("] and partner.get(at) == i - 1:
                inner, more = without_exponentials(factor[1:-1], depth + 1)
                factor, found = ["(", *inner, ")"], found + more
            factors += [*signs, *factor, *([token] if token != "end" else [])]
            begin, operator = i + 1, token
        i += 1
    return factors, found

def without_variable(f):
    need(not f.scalar().degree(0) and not f.bottom.degree(0), "a function of the loop's variable")
    return f

OF_COMPLEX = {"conj": lambda f: without_variable(f).conjugate(), "re": lambda f: without_variable(f).parts()[0],
              "im": lambda f: without_variable(f).parts()[1]}

class Scope:
    """What names mean, and everything that was divided by."""

    exponential = None  # exp(-tau s), where it is read

    def __init__(self, constants, variables, moving=None, unit=None, cut=None):
        self.cut = cut if cut and cut.kind == "parameter" else None
        self.moving = moving  # functions, where they are read
        self.unit = unit  # whether j is the imaginary unit; None where there are nothing but numbers
        need(len(variables) < MAX_VARIABLES, "there are too many parameters")
        self.matrices = {name: c for name, c in constants.items() if isinstance(c, list)}
        self.divisors, self.constants = [], {name: c for name, c in constants.items() if name not in self.matrices}
        self.known = {name: self.with_factor(name, scalar(P({1 << FIELD * v: 1}))) for name, v in variables.items()}
        for name in self.constants:
            self.define(name)
        for rows in self.matrices.values():  # defined, used or not
            self.matrix(rows)

    def define(self, name):
        """A constant, after those that it uses."""
        waiting = {name: None}  # in order
        while waiting:
            name = next(reversed(waiting))
            uses = tokens_of(self.constants[name]) if isinstance(self.constants[name], str) else []
            new = next((u for u in uses if u in self.constants and u not in self.known), None)
            need(new not in waiting, f"the constant {name:.40} uses itself")
            if new:
                waiting[new] = None
            else:
                self.known.setdefault(name, self.with_factor(name, self.value(self.constants[name])))
                waiting.popitem()

    def with_factor(self, name, value):
        return value * self.cut.factor if self.cut and self.cut.name == name else value

    def value(self, toml, more={}, division_by_z=True):
        """Of an expression or a number; `more` are names of signals, or of the loop's variable."""
        def named(name):
            if self.moving and name == "pi" and name not in more and name not in self.known:
                return self.moving.variable("pi")
            if self.unit and name == "j" and name not in more and name not in self.known:
                return scalar(P({UNIT: 1}))
            need(name in more or name in self.known, f"the name {name:.40} is unknown")
            return more[name] if name in more else self.known[name]

        def inverse(f):
            need(f.scalar(), "division by zero")
            need(division_by_z or not f.scalar().degree(0), "division by the loop's variable")
            self.divisors.append(f.scalar())
            return Value({"": f.bottom}, f.scalar())

        need(isinstance(toml, (str, int)) and not isinstance(toml, bool), "an expression is expected")
        if isinstance(toml, str):
            functions = self.moving.functions if self.moving else {"exp": self.exponential} if self.exponential else {}
            functions = functions | ({} if self.unit is None else OF_COMPLEX)
            functions = {name: f for name, f in functions.items() if name not in self.known and name not in more}
            return evaluate(toml, named, inverse, functions)
        spend(1, toml.bit_length())
        return scalar(number(toml))

    def linear(self, toml, signals):
        value = self.value(toml, signals)
        need(not value.tops.pop("", ZERO), "a linear expression has a constant term")
        return value

    def rows(self, toml):
        """A matrix as it is written, or the constant of this name."""
        if isinstance(toml, str) and not isinstance(toml, Number):
            need(toml.strip(BLANKS) in self.matrices, "no constant of this name is a matrix")
            toml = self.matrices[toml.strip(BLANKS)]
        return listed(toml)

    def matrix(self, toml, rows=None, columns=None):
        m = [[self.value(e) for e in listed(row)] for row in self.rows(toml)]
        need(len({len(row) for row in m}) < 2, "the rows differ in length")
        need(rows is None or len(m) == rows and (not m or len(m[0]) == columns), "sizes do not fit")
        return m

# ---------------------------------------------------------------- the parts of a model

def listed(toml):
    need(isinstance(toml, list), "an array is expected")
    return toml

def several(toml):
    return toml if isinstance(toml, list) else [toml]

def text_of(toml):
    need(isinstance(toml, str) and not isinstance(toml, Number), "a string is expected")
    return toml

def constant(toml):
    """A number, or an expression of numbers."""
    return Scope({}, {}).value(toml).number()

def table(toml, keys=None):
    """A table, in which only these keys may be."""
    need(isinstance(toml, dict), "a table is expected")
    unknown = set(toml) - set(keys.split()) if keys else set()
    need(not unknown, f"unknown key {min(unknown, default='')!r:.60}")
    return toml

def distinct(names, others=()):
    """Names, each of which occurs once."""
    names = [text_of(name) for name in names]
    need(all(map(is_name, names)), "not a name")
    need(len({*names, *others}) == len(names) + len(others), "a name has two meanings, or one that is reserved")
    return names

# What opens and closes in a model, and what lies between; a quotation mark alone begins a string that has no end.
PIECE = re.compile(
    r""" (?P<text> "{3}(?:[^\\]|\\.)*?"{3} | "(?:[^"\\\n]|\\.)*") | '{3}.*?'{3} | '[^'\n]*' | (?P<endless> ["'])
       | (?P<blank> (?:[ \t] | \r?\n | \#[\t\x20-\x7e\x80-\U0010ffff]*)+) | [^"'\#\s\[\]{},]+ | .""", re.VERBOSE | re.DOTALL)
ESCAPE = re.compile(r"\\(?:x([0-9A-Fa-f]{2})|(e)|.)", re.DOTALL)

def toml_1_0(text):
    """The same model without what TOML 1.1 adds: lines, comments and a last comma in inline tables, and two escapes."""
    out, opened, before, comma = [], [], "", ""
    for match in PIECE.finditer(text):
        piece, inline = match[0], opened[-1:] == ["{"]
        if match["endless"]:
            return text
        if match["blank"] and inline:
            out.append(" ")
            continue
        if match["text"]:
            piece = ESCAPE.sub(lambda m: f"\\u00{m[1]}" if m[1] else "\\u001b" if m[2] else m[0], piece)
        out.append("" if piece == "}" else comma)
        comma = ""
        if piece in ("[", "{"):
            opened.append(piece)
        elif piece in ("]", "}"):
            opened[-1:] = []
        if piece == "," and inline and before not in ("{", ","):
            comma = piece
        else:
            out.append(piece)
        before = piece
    return "".join(out)

def parsed(text):
    """The tables of a model. `tomllib` reads TOML 1.0 before Python 3.15."""
    try:
        return tomllib.loads(text, parse_float=Number)
    except tomllib.TOMLDecodeError:
        return tomllib.loads(toml_1_0(text), parse_float=Number)

# What tomllib would make decimal without a word; strings and comments are passed over.
NOT_DECIMAL = re.compile(
    r""" "{3}(?:[^\\]|\\.)*?"{3} | '{3}.*?'{3} | "(?:[^"\\\n]|\\.)*" | '[^'\n]*' | \#[^\n]*
       | (?<![\w.-]) [+-]? (?P<number> 0[xob])""", re.VERBOSE | re.DOTALL)

BOUND = re.compile(rf"{BLANK}([+-]?)((?:[0-9._/]|[eE][+-]?)+){BLANK}(%?){BLANK}")

def tolerance(toml):
    """Refuses what is no tolerance; it has no influence on what is proved."""
    def bound(part):
        match = BOUND.fullmatch(str(part))
        need(match and match[2].count("/") <= 1, "a bound of a tolerance is not a number")
        value = constant(match[2])
        return (-value if match[1] == "-" else value), match[3]
    if isinstance(toml, dict):
        need(set(toml) == {"low", "high"} and constant(toml["low"]) <= constant(toml["high"]), "no range")
        return
    if isinstance(toml, str) and not isinstance(toml, Number) and ".." in toml:
        toml = toml.split("..", 1)
    if isinstance(toml, list):
        need(len(toml) == 2, "a tolerance has two bounds")
        (low, is_share), (high, too) = map(bound, toml)
        need(is_share == too and (low <= 0 <= high if is_share else low <= high), "the bounds do not go together")
    else:
        need(isinstance(toml, (str, int, Number)) and not isinstance(toml, bool) and bound(toml)[0] >= 0, "no tolerance")

class Model:
    """What does not depend on a question."""

    def __init__(self, text):
        need(len(text) <= MAX_MODEL, "the model is too long")
        keys = "title time sample_time constants parameters loop block simulation require expect ship tune"  # the last four change nothing of the loop
        self.root = table(parsed(text.removeprefix("\ufeff")), keys)
        need(not any(match["number"] for match in NOT_DECIMAL.finditer(text)), "a number is not decimal")
        text_of(self.root.get("title", ""))
        self.discrete = text_of(self.root.get("time")) == "discrete"
        need(self.discrete or self.root["time"] == "continuous", "the model has no time")
        self.z = "z" if self.discrete else "s"
        self.constants, self.parameters = (table(self.root.get(key, {})) for key in ("constants", "parameters"))
        self.constants = {name: self.value(c) for name, c in self.constants.items()}
        self.taken = distinct([*self.constants, *self.parameters, self.z, "radius", "decay"])
        for parameter in self.parameters.values():
            if not isinstance(parameter, dict):
                parameter = {"nominal": parameter}
            table(parameter, "nominal min max closed domain unit description tolerance")
            if "tolerance" in parameter:
                tolerance(parameter["tolerance"])
            if "nominal" in parameter:
                self.formula(parameter["nominal"])
            numbers = {key: constant(parameter[key]) for key in ("min", "max") if key in parameter}
            need(isinstance(parameter.get("closed", True), bool) and ("closed" not in parameter or numbers), "'closed' closes nothing")
            if "domain" in parameter:
                need(not set(parameter) & {"min", "max", "closed"}, "a domain is given twice")
                need(isinstance(parameter["domain"], list) and len(parameter["domain"]) == 2, "a domain has not two ends")
                numbers = dict(zip(("min", "max"), map(constant, parameter["domain"])))
            need(not {"min", "max"} <= set(numbers) or numbers["min"] < numbers["max"], "a domain is empty")
            [text_of(parameter[key]) for key in ("unit", "description") if key in parameter]

    def formula(self, toml):
        """A nominal value: what it is does not matter here, since a certificate has all values."""
        names = [name for name, value in self.constants.items() if not isinstance(value, list)] + list(self.parameters)
        used = [name for name in names if isinstance(toml, str) and name in tokens_of(toml)]
        Scope({}, {name: v for v, name in enumerate(used, 1)}, Moving(1 + len(used)), False).value(toml)

    @staticmethod
    def value(toml):
        """The value of a constant, which may stand in a table."""
        if not isinstance(toml, dict):
            return toml
        value = table(toml, "value unit description tolerance").get("value")
        need(value is not None, "a constant has no value")
        [text_of(toml[key]) for key in ("unit", "description") if key in toml]
        if "tolerance" in toml:
            tolerance(toml["tolerance"])
            constant(value)
        return value

class DeadTime:
    """All dead times are multiples of a base, which is a number times this power of the parameter."""

    def __init__(self, base, power):
        self.base, self.power = base, power

BELOW_PI = Fraction(31415926535897932384626433832795028, 10 ** 34)

class Loop:
    """Equations of signals and states, and everything that is divided by."""

    def __init__(self, model, variables, values=None, symbols=None, boxed=0, cut=None):
        self.z, self.taken, self.cut, root = model.z, model.taken, cut, model.root
        self.values, self.symbols, self.sample_time = values, symbols, root.get("sample_time")
        self.first = 2 + len(values or []) + boxed  # symbols are the variables from here on
        allow(self.first + len(getattr(symbols, "symbols", [])) <= MAX_VARIABLES, "there are too many symbols")
        self.moving = symbols if isinstance(symbols, Moving) else None
        if self.moving:
            self.moving.is_continuous = self.z == "s"
        self.scope = Scope({name: c for name, c in model.constants.items() if name not in variables}, variables, self.moving,
                           "j" not in model.taken, cut)
        if isinstance(symbols, DeadTime) and self.z == "s":
            self.scope.exponential = lambda f: self.delayed(-f, 1)
        self.unknowns, self.equations, self.degree, self.own, self.frame = [], [], 0, [], None
        if "sample_time" in root:
            t = real(self.scope.value(root["sample_time"])).number()
            need(t is None or t > 0, "the sample time is not positive")
        loop = table(root.get("loop"), "characteristic matrix A B C K states inputs E outputs")
        forms = ("characteristic" in loop, "matrix" in loop, any(k in loop for k in "ABCK"), "block" in root)
        need(sum(forms) == 1, "the model has not exactly one form of loop")
        need(not cut or cut.kind in ("parameter", "variable") or forms[3], "a loop without blocks is cut at a parameter")
        self.inputs, self.signals, self.states, self.outputs = [], [], [], []
        if forms[0]:
            written = self.scope.value(loop["characteristic"], {self.z: scalar(Z)}, division_by_z=False)
            self.degree, self.equations = written.scalar().degree(0), [self.unknown() * written]
        elif forms[3]:
            self.blocks(loop, listed(root["block"]))
        else:
            a = self.scope.matrix(loop["matrix"] if forms[1] else loop["A"])
            x = [self.unknown() for _ in a]
            b, u = [[]] * len(x), []
            if forms[2]:
                b, c = (self.scope.matrix(loop[key]) for key in "BC")
                need(len(b) == len(x) and all(len(row) == len(x) for row in c), "sizes do not fit")
                k = self.scope.matrix(loop["K"], len(b[0]) if b else 0, len(c))
                y = [dot(row, x) for row in c]
                u = [-dot(row, y) for row in k]
            need(x and len(a[0]) == len(x), "the matrix is not square, or empty")
            self.state_space(a, b, x, u)
            self.states = self.signals = distinct(several(loop.get("states", [])), self.taken)
            need("states" not in loop or len(self.states) == len(x), "not as many states as rows")
            self.inputs = distinct(several(loop.get("inputs", [])), self.taken)
            need(("inputs" in loop) == ("E" in loop), "'inputs' and 'E' go together")
            if "E" in loop:
                self.scope.matrix(loop["E"], len(x), len(self.inputs))
            self.responses(loop, self.states)
        self.simulation(table(root.get("simulation", {}), "inputs initial duration units"))
        if cut and cut.is_complex:
            polynomials = [p for list_ in [self.equations, *(own for own, _ in self.own)] for e in list_ for p in (e.bottom, *e.tops.values())]
            self.doubled = any(map(has_unit, polynomials + self.scope.divisors))
            return
        self.doubled = not all(e.is_real() for list_ in [self.equations, *(own for own, _ in self.own)] for e in list_)
        self.scope.divisors = [p if is_real(p) else squared_modulus(p) for p in self.scope.divisors]
        if self.doubled and forms[0]:
            [e], [name] = self.equations, self.unknowns
            self.equations = [Value({name: squared_modulus(e.tops[name])}, squared_modulus(e.bottom))]
        elif self.doubled:
            self.equations, self.unknowns = self.in_parts(self.equations, self.unknowns)
            self.own = [self.in_parts(*own) for own in self.own]
        self.degree *= 1 + self.doubled

    @staticmethod
    def in_parts(equations, unknowns):
        """A complex equation, times its denominator, as one for its real part and one for its imaginary part."""
        out = []
        for e in equations:
            parts = {name: re_im(p) for name, p in e.tops.items()}
            out.append(Value({(name, k): p for name, (x, y) in parts.items() for k, p in enumerate((x, -y))}))
            out.append(Value({(name, k): p for name, (x, y) in parts.items() for k, p in enumerate((y, x))}))
        return out, [(name, k) for name in unknowns for k in (0, 1)]

    def unknown(self, name=None):
        self.unknowns.append(name or len(self.unknowns))
        return Value({self.unknowns[-1]: ONE})

    def state_space(self, a, b, x, u, up=Z, down=ONE):
        """up x = down (A x + B u)"""
        for i in range(len(x)):
            self.equations.append(x[i] * scalar(up) + -((dot(a[i], x) + dot(b[i], u)) * scalar(down)))
        self.degree += len(x)

    def responses(self, loop, names):
        outputs = several(loop.get("outputs", []))
        self.outputs = [CONTROL.sub(" ", text_of(output).strip(BLANKS)) for output in outputs]  # a name is one line
        need(len(set(self.outputs)) == len(outputs), "an output is named twice")
        for output in outputs:
            self.scope.linear(output, {name: Value({name: ONE}) for name in names})

    def simulation(self, given):
        known = {"inputs": self.inputs, "initial": self.states, "units": self.inputs + self.signals + self.outputs}
        for key, names in known.items():
            for name, item in table(given.get(key, {})).items():
                need(name in names, f"unknown name {name:.40} in the simulation")
                text_of(item) if key == "units" else constant(item)
        need("duration" not in given or constant(given["duration"]) > 0, "the duration is not positive")

    def blocks(self, loop, blocks):
        keys = "name input output discretize pwm every phase transfer num den gain delay A B C D"
        need("states" not in loop and "E" not in loop, "blocks have their own states")
        for block in blocks:
            need({"input", "output"} <= set(table(block, keys)), "a block has no input or no output")
        given = [text_of(block["name"]) if "name" in block else None for block in blocks]
        bare = given.index(None) if None in given and "block" not in given else -1
        names = [name if name is not None else "block" if i == bare else f"block {i + 1}" for i, name in enumerate(given)]
        need(len(set(names)) == len(names), "two blocks have one name")
        driven = [name for block in blocks for name in several(block["output"])]
        self.inputs = several(loop.get("inputs", []))
        self.signals = distinct([*driven, *self.inputs], self.taken)
        self.unknowns = driven[:]
        used = {name: Value({name: ONE}) for name in self.signals}
        if self.cut and self.cut.kind == "signal":
            need(self.cut.name in driven, "the loop is cut at a signal that is no output of a block")
            used[self.cut.name] = used[self.cut.name] * self.cut.factor
        need(not self.cut or self.cut.kind != "input" or self.cut.name in names, "the loop is cut at a block that is not there")
        rates, of_rows, of_states = [], [], {}
        for name, block in zip(names, blocks):
            self.every, phase = (constant(block.get(key, usual)) for key, usual in (("every", 1), ("phase", 0)))
            need(self.every.denominator == phase.denominator == 1 and 0 <= phase < self.every, "a rate is no number of samples")
            need(self.z == "z" or not {"every", "phase"} & set(block), "a continuous loop has no rates")
            self.every = int(self.every)
            rates.append((self.every, int(phase), several(block["output"])))
            self.block(name, block, used)
            of_rows += [rates[-1]] * (len(self.equations) - len(of_rows))
            of_states |= {name: rates[-1] for name in self.unknowns[len(driven):] if name not in of_states}
        if any(every > 1 for every, _, _ in rates):
            self.lift(rates, of_rows, of_states)
        self.responses(loop, self.signals)

    def lift(self, rates, of_rows, of_states):
        """The equations of a hyperperiod: an unknown for each signal at each sample and for each state at each sample at which its block is
        active, w from one hyperperiod to the next, and outputs that are held in between."""
        steps = lcm(*(every for every, _, _ in rates))
        allow(steps * len(self.unknowns) <= 400, "a hyperperiod is too long for the check")

        def active(rate, sample):
            return sample % rate[0] == rate[1]

        computed = [sum(len(names) for every, phase, names in rates if every > 1 and k % every == phase) for k in range(steps)]
        start = computed.index(max(computed))
        equations = []
        for equation, rate in zip(self.equations, of_rows):
            for t in range(steps):
                if not active(rate, start + t):
                    continue
                lifted = {}
                for name, p in equation.tops.items():
                    for m, c in enumerate(p.coefficients(0)):
                        if c and name != "":
                            turns, place = divmod(t + m * rate[0], steps)
                            lifted[name, place] = lifted.get((name, place), ZERO) + c * Z ** turns
                equations.append((t, Value(lifted, equation.bottom)))
        for rate in rates:
            for name in rate[2]:
                self.degree += not active(rate, start)
                for t in range(steps):
                    if not active(rate, start + t):  # what it was one sample before
                        now = Value({(name, t): ONE if t else Z})
                        equations.append((t, now + -Value({(name, (t - 1) % steps): ONE})))
        self.equations = [e for _, e in sorted(equations, key=lambda timed: timed[0])]  # neighbours share signals
        self.unknowns = [(name, t) for name in self.unknowns for t in range(steps) if active(of_states.get(name, (1, 0)), start + t)]

    def block(self, called, block, signals):
        scope = self.scope
        u = [scope.linear(e, signals) for e in several(block["input"])]
        # External signals are zero, and what divides them is not in the equations.
        u = [Value({name: p for name, p in e.tops.items() if name not in self.inputs}, e.bottom) for e in u]
        if self.cut and self.cut.kind == "input" and self.cut.name == called:
            need(len(u) == 1, "the loop is cut at the input of a block that has not one")
            u = [u[0] * self.cut.factor]
        y = [Value({name: ONE}) for name in several(block["output"])]
        up, down, inner = Z, ONE, self.z
        hold, pulses = None, []
        if "discretize" in block:  # s = up / down
            need(self.z == "z", "a continuous loop has nothing to discretise")
            need("transfer" not in block or "s" not in self.taken, "s has two meanings")
            rule, inner = block["discretize"], "s"
            rule = {"method": rule} if isinstance(rule, str) else dict(table(rule, "method T c prewarp delay edge duty frame advance"))
            method = text_of(rule.get("method"))
            pulses = self.pulses(method, rule, u)
            is_of_loop = "T" not in rule and "c" not in rule and self.sample_time is not None
            if is_of_loop:
                rule["T"] = self.sample_time
            t, c, w, delay, frame, advance = (real(scope.value(rule[k])) if k in rule else None
                                              for k in ("T", "c", "prewarp", "delay", "frame", "advance"))
            need(not frame or method == "zoh", "only 'zoh' has a frame")
            need(frame or not advance, "an advance goes with a frame")
            if is_of_loop and self.every > 1:  # a slower block has its own period
                t = t * of_number(Fraction(self.every))
            is_hold = method in ("zoh", "foh", "pwm")
            need(not is_hold or self.every == 1, "a continuous plant has no rate of its own")
            need(is_hold or not delay, "only a hold has a delay")
            need(not w or method == "tustin" and t and not c, "'prewarp' goes with tustin and a sample time, without 'c'")
            if is_hold:
                need(t and not c, "'discretize' does not fit")
                if isinstance(block.get("transfer"), str) and not isinstance(block["transfer"], Number) and "exp" not in scope.known:
                    rest, exponents = without_exponentials(tokens_of(block["transfer"]))
                    block = {**block, "transfer": " ".join(rest)}
                    for exponent in exponents:
                        exponent = scope.value(" ".join(exponent), {"s": scalar(Z)})
                        powers = exponent.scalar().coefficients(0)
                        need(len(powers) == 2 and not powers[0] and not exponent.bottom.degree(0), "an exponent is no dead time times s")
                        time = Value({"": -powers[1]}, exponent.bottom)
                        delay = delay + real(time) if delay else real(time)
                if self.values is not None and frame:  # exp(ja) G(z exp(jwT))
                    self.frame = self.rotation(frame * t), self.rotation(advance or NOTHING)
                if self.values is not None and self.moving:
                    hold = method == "foh", t, self.ratio(delay, t) if delay else Fraction(0)
                elif self.values is not None:
                    hold = method == "foh", self.number(t), self.number(delay) if delay else Fraction(0)
                    need(hold[1] > 0 and hold[2] >= 0, "the times of a hold are not positive")
                    pulses = [p and [self.number(f) for f in p] for p in pulses]
                    need(all(0 < p[0] < 1 for p in pulses if p), "a duty ratio is not between 0 and 1")
            elif w and (c := self.prewarped(w, t)) is None:
                pass  # only what is written is looked at
            elif method == "tustin" and (c or t):
                c = c or scope.value("2/T", {"T": t})
                up, down = (Z + number(-1)) * c.scalar(), (Z + ONE) * c.bottom
            else:
                need(method in ("forward", "backward") and t and not c, "'discretize' does not fit")
                up, down = (Z + number(-1)) * t.bottom, t.scalar() * (ONE if method == "forward" else Z)
        if "pwm" in block:
            need(len(table(block["pwm"], "amplitude carrier period")) == 3, "'pwm' is not complete")
            [scope.value(e) for e in block["pwm"].values()]
        kinds = [any(k in block for k in keys) for keys in (["transfer"], ["gain"], ["delay"], ["num", "den"], "ABCD")]
        need(sum(kinds) == 1, "a block does not say exactly once what it does")
        if kinds[4]:
            need(("A" in block) == ("B" in block) and ("A" in block or "C" not in block), "A and B are needed")
            n = len(scope.rows(block.get("A", [])))
            sizes = {"A": (n, n), "B": (n, len(u)), "C": (len(y), n), "D": (len(y), len(u))}
            a, b, c, d = (scope.matrix(block[k], *sizes[k]) if k in block else None for k in "ABCD")
            x = [self.unknown() for _ in range(n)]
            if hold:
                one = [[scalar(number(int(i == j))) for j in range(n)] for i in range(n)]
                c = c if c is not None else one if a is not None else [[]] * len(y)
                self.states = self.states + (several(block["output"]) if a is not None and "C" not in block else [])
                need(n == len(y) or "C" in block or a is None, "without C the outputs are the states")
                return self.held(hold, pulses, a or [], b or [], c, d, x, u, y)
            if n:
                self.state_space(a, b, x, u, up, down)
            if n and "discretize" in block:
                self.own.append((self.equations[-n:], self.unknowns[-n:]))
            if a is not None and c is None:
                need(len(y) == n, "without C the outputs are the states")
                self.states = self.states + several(block["output"])
            for i in range(len(y)):
                seen = x[i] if a is not None and c is None else dot(c[i], x) if n else NOTHING
                self.equations.append(y[i] + -(seen + (dot(d[i], u) if d else NOTHING)))
            return
        need(len(u) == len(y) == 1, "a transfer function has one input and one output")
        if kinds[2] and self.scope.exponential:
            num, den = self.delayed(real(scope.value(block["delay"])), 0).scalar(), ONE
        elif kinds[2] and self.moving and self.moving.is_continuous:
            num, den = self.moving.delayed(scope.value(block["delay"])).scalar(), ONE
        elif kinds[2]:
            samples = constant(block["delay"])
            need(samples.denominator == 1 and 0 <= samples <= MAX_ORDER and inner == "z", "a delay is a number of samples")
            num, den = ONE, Z ** int(samples)
        elif kinds[3]:
            num, den = ([scope.value(e) for e in several(block[key])[::-1]] for key in ("num", "den"))
            need(num and den, "a list without coefficients")
            num, den = (dot(list_, [scalar(Z ** k) for k in range(len(list_))]) for list_ in (num, den))
            num, den = num.scalar() * den.bottom, den.scalar() * num.bottom
        else:
            ratio = scope.value(block["transfer"], {inner: scalar(Z)}) if kinds[0] else scope.value(block["gain"])
            num, den = ratio.scalar(), ratio.bottom
        order = den.degree(0)
        need(den and num.degree(0) <= order <= MAX_ORDER, "a transfer function is improper")
        scope.divisors.append(den.coefficients(0)[order])
        if hold:  # the companion matrix of the denominator
            below = [scalar(c) if self.moving else self.complex_number(scalar(c)) for c in den.coefficients(0)]
            need(below[-1].scalar(), "a held block loses its order")
            inverse = Value({"": below[-1].bottom}, below[-1].scalar())
            whole = [scalar(c) * inverse for c in num.coefficients(0)] + [NOTHING] * order
            below = [c * inverse for c in below[:-1]]
            a = [[of_number(Fraction(int(j == i + 1))) for j in range(order)] for i in range(order)]
            a[-1:] = [[-c for c in below]] if order else []
            b = [[of_number(Fraction(int(i == order - 1)))] for i in range(order)]
            c = [[whole[k] + -(whole[order] * below[k]) for k in range(order)]]
            return self.held(hold, pulses, a, b, c, [[whole[order]]], [self.unknown() for _ in range(order)], u, y)
        if "discretize" in block:
            num, den = (sum((c * up ** k * down ** (order - k) for k, c in enumerate(p.coefficients(0))), ZERO)
                        for p in (num, den))
            scope.divisors.append((den.coefficients(0) + [ZERO] * order)[order])
        self.equations.append(y[0] * scalar(den) + -(u[0] * scalar(num)))
        self.degree += order

    def delayed(self, f, power):
        """exp(-tau s) as a power of the symbol, for tau as a value, or tau s with the power 1 of s."""
        real(f)
        top, bottom = (p.at(self.values) for p in (f.scalar(), f.bottom))
        at = (self.symbols.power << FIELD) + power
        need(not any(bottom) and list(top) == [at], "a dead time is no number, or not a multiple of the parameter")
        k = Fraction(top[at]) / Fraction(bottom[0]) / self.symbols.base
        need(k.denominator == 1 and 0 < k <= 256, "a dead time is not a multiple of the base")
        return scalar(P({int(k) << FIELD * self.first: 1}))

    def number(self, f):
        """The number that a value is with all parameters."""
        real(f)
        top, bottom = (p.at(self.values) for p in (f.scalar(), f.bottom))
        need(not any(top) and not any(bottom) and bottom, "a held block depends on the parameter in its exponential")
        return Fraction(top.get(0, 0)) / Fraction(bottom[0])

    def complex_number(self, f):
        """The number that a value is, as a value."""
        x, y = f.parts()
        return of_number(self.number(x)) + of_number(self.number(y)) * scalar(P({UNIT: 1}))

    def rotation(self, angle):
        """exp(j angle)"""
        if not angle.scalar():
            return scalar(ONE)
        need(self.scope.unit, "j has another meaning here")
        need(self.moving, "cosines and sines of a frame are read by enclosures alone")
        return self.moving.rotation(angle)

    def ratio(self, delay, time):
        """The delay over the sample time, a number that is not negative."""
        top, bottom = cleared([p.at(self.values) for p in (delay.scalar() * time.bottom, time.scalar() * delay.bottom)])
        need(bottom, "a sample time is zero")
        q = Fraction(top.get(max(bottom), 0), bottom[max(bottom)])
        need(top * number(q.denominator) == bottom * number(q.numerator) and q >= 0, "a dead time is no multiple of the sample time")
        return q

    def prewarped(self, w, t):
        """The factor w/tan(w T/2) of Tustin's rule that is exact at the frequency w, which has to be below half the sampling rate."""
        def certain(w, t):
            need(all(q is None or q > 0 for q in (w, t)), "the frequency of 'prewarp', or its sample time, is not positive")
            need(w is None or t is None or w * t <= BELOW_PI, "the frequency of 'prewarp' is not below half the sampling rate")
        certain(w.number(), t.number())
        if self.values is None:
            return None
        if self.moving:
            return self.moving.prewarped(w, t)
        w, t = self.number(w), self.number(t)
        certain(w, t)
        x = self.symbols.tangent(w ** 2, t / 2, self.first, self.scope.divisors)
        self.scope.divisors.append(x.scalar())
        return Value({"": x.bottom}, x.scalar())

    def pulses(self, method, rule, u):
        """For each input its duty ratio and where the edges of its pulse stand; None where it is held.  With one word for all, an input
        that no signal of the loop is in is held."""
        if method != "pwm":
            need("edge" not in rule and "duty" not in rule, "only 'pwm' has an edge and a duty ratio")
            return []
        need(not {"T", "c", "prewarp"} & set(rule), "a modulator has no sample time of its own")
        need("edge" in rule and "duty" in rule, "a modulator has one edge and one duty ratio, or one for each input")
        edges, duties = several(rule["edge"]), [real(self.scope.value(e)) for e in several(rule["duty"])]
        need({len(edges), len(duties)} <= {1, len(u)}, "a modulator has one edge and one duty ratio, or one for each input")
        need(all(text_of(edge) in EDGES for edge in edges), "a modulator has an edge that is not known")
        need(all(d.number() is None or 0 < d.number() < 1 for d in duties), "a duty ratio is not between 0 and 1")
        out = []
        for j, e in enumerate(u):
            is_external = len(edges) == 1 and len(u) > 1 and not any(p for name, p in e.tops.items() if name)
            duty, places = duties[j % len(duties)], EDGES[edges[j % len(edges)]]
            places = [of_number(Fraction(begin, 2)) + of_number(Fraction(slope, 2)) * duty for begin, slope in places]
            out.append(None if is_external or not places else [duty, *places])
        need(any(out), "no input of a modulator is a pulse")
        return out

    def held(self, hold, pulses, a, b, c, d, x, u, y):
        """over x[k+1] = state x[k] + sum of matrix B u[k - age], and the states of past inputs."""
        (turn, ahead), self.frame = self.frame or (scalar(ONE), scalar(ONE)), None
        z, u = scalar(Z) * turn, [e * ahead for e in u]  # seen from a frame that turns
        in_parts = not all(e.is_real() for row in a for e in row)
        if in_parts:  # the real matrix of a complex one
            rows = [[e.parts() for e in row] for row in a]
            a = [line for row in rows for line in ([v for x, y in row for v in (x, -y)], [v for x, y in row for v in (y, x)])]
        a = a if self.moving else [[self.number(e) for e in row] for row in a]

        def whole(m):
            return [[with_unit(p, q) for p, q in zip(re[::2], im[::2])] for re, im in zip(m[::2], m[1::2])] if in_parts else m

        held = [j for j in range(len(u)) if not pulses or pulses[j] is None]
        if held:
            state, enters, over, past = self.symbols.held(a, *hold, self)
        else:
            (state, over), enters, past = self.symbols.flow(a, hold[1], None, None, self), [], 0
        columns = []
        for j, (duty, *edges) in ((j, pulse) for j, pulse in enumerate(pulses) if pulse):
            for edge in edges:
                age, rest = self.symbols.placed(edge, hold)
                if rest == 1:  # a sample stands on the edge: no output may change there
                    step = [dot(row, [r[j] for r in b]) if b else NOTHING for row in c] + ([row[j] for row in d] if d else [])
                    need(not any(e.scalar() for e in step), "a sample stands on an edge of a pulse")
                columns.append((age, j, self.symbols.flow(a, hold[1], rest, duty, self), len(edges)))
                past = max(past, age)
        weight = hold[1] if self.moving else of_number(hold[1])
        p = [[self.unknown() for _ in u] for _ in range(past)]

        def aged(age):
            return [e * z for e in u] if age < 0 else u if age == 0 else p[age - 1]

        for i in range(len(x)):
            next_x = dot([scalar(e) for e in whole(state)[i]], x)
            for age, matrix, _ in enters:
                held_inputs = [dot([row[j] for j in held], [aged(age)[j] for j in held]) for row in b]
                next_x = next_x + dot([scalar(e) for e in whole(matrix)[i]], held_inputs)
            for age, j, (matrix, own), edges in columns:  # of a pulse T/edges times the flow behind the edge
                share = dot([Value({"": e * over}, own) for e in whole(matrix)[i]], [row[j] for row in b])
                next_x = next_x + share * weight * of_number(Fraction(1, edges)) * aged(age)[j]
            self.equations.append(x[i] * z * scalar(over) + -next_x)
        for k in range(past):
            self.equations += [q * z + -e for q, e in zip(p[k], aged(k))]
        self.degree += len(x) + past * len(u)
        for i in range(len(y)):
            seen = dot(c[i], x)
            for age, _, share in enters:
                if d and share:
                    seen = seen + dot([d[i][j] for j in held], [aged(age)[j] for j in held]) * of_number(share)
            self.equations.append(y[i] + -seen)

# Of pulses in a period of 1, twice the places of their edges: what each has without the duty ratio, and its factor.
EDGES = {"hold": [], "trailing": [(0, 2)], "leading": [(2, -2)], "double": [(1, -1), (1, 1)], "double-ends": [(0, 1), (2, -1)]}

def of_number(x):
    return Value({"": number(x.numerator)}, number(x.denominator))

# ---------------------------------------------------------------- symbols and holds

def floor_shift(x, bits):
    return x[0] >> bits, -(-x[1] >> bits)

def times(x, y, bits):
    spend(1, x[1].bit_length(), y[1].bit_length())
    (a, b), (c, d) = x, y
    corners = a * c, a * d, b * c, b * d
    return min(corners) >> bits, -(-max(corners) >> bits)

def scaled_by(x, k):
    return (x[0] * k, x[1] * k) if k >= 0 else (x[1] * k, x[0] * k)

def added(x, y):
    return x[0] + y[0], x[1] + y[1]

def enclosed(q, bits):
    return (q.numerator << bits) // q.denominator, -(-(q.numerator << bits) // q.denominator)

def certain(x):
    """The sign, 0 only of zero itself."""
    need(x[0] > 0 or x[1] < 0 or x == (0, 0), "a sign is not certain")
    return (x[0] > 0) - (x[1] < 0)

def product_of(m, k, bits):
    def entry(row, column):
        out = (0, 0)
        for x, y in zip(row, column):
            corners = [a * b for a in x for b in y]
            out = added(out, (min(corners), max(corners)))
        return floor_shift(out, bits)
    of_m, of_k = (size(end for row in matrix for x in row for end in x) for matrix in (m, k))  # large arguments make long numbers
    hold(2 * len(m) ** 2, of_m + of_k)
    spend(len(m) ** 3, max(of_m, bits), max(of_k, bits))
    return [[entry(row, column) for column in zip(*k)] for row in m]

def solutions(monic, t, bits):
    """The first row of exp(companion t), all entries at most four units wide."""
    working = bits + 64
    while True:
        row = [floor_shift(x, working - bits) for x in first_row(monic, t, working)]
        if all(hi - lo <= 4 for lo, hi in row):
            return row
        need(working <= 64 * (bits + 64), "a symbol is too large to be enclosed")
        working *= 2

def first_row(monic, t, bits):
    """Taylor's polynomial of exp(M/2^s), where |M|/2^s has sums of rows of at most 1/4, and s squarings."""
    d = len(monic)
    m = [[t * (j == i + 1) for j in range(d)] for i in range(d - 1)] + [[-c * t for c in monic]]
    norm, s = max(sum(map(abs, row)) for row in m), 0
    while norm > Fraction(1, 4):
        norm, s = norm / 2, s + 1
        need(s <= 4096, "a symbol is too large to be enclosed")
    m = [[enclosed(x / 2 ** s, bits) for x in row] for row in m]
    term = [[(int(i == j) << bits,) * 2 for j in range(d)] for i in range(d)]
    total, k, least, bound = term, 0, norm.denominator // norm.numerator if norm else 1 << bits, 1
    while bound <= 1 << bits:  # one over a bound of the sums of rows of a term: few terms where M is small
        k, bound = k + 1, bound * least * (k + 1)
        term = [[(lo // k, -(-hi // k)) for lo, hi in row] for row in product_of(term, m, bits)]
        total = [[added(x, y) for x, y in zip(*rows)] for rows in zip(total, term)]
    total = [[(lo - 2, hi + 2) for lo, hi in row] for row in total]  # the remainder is below a unit
    for _ in range(s):
        total = product_of(total, total, bits)
    return total[0]

class Table:
    """What the symbols of a certificate stand for, and their values.  Symbol i is variable i + 2 in the end."""

    def __init__(self, bits=64, symbols=(), modes=()):
        need(type(bits) is int and 64 <= bits <= 1 << 15, "bits: out of range")
        self.bits, self.symbols = bits, [self.symbol(item) for item in items(list(symbols), lambda item: item)]
        self.modes = [[Fraction(0)], *(m for m in (items(m, rational) for m in modes) if m != [0])]
        need(all(0 < len(m) <= 64 for m in self.modes), "a mode has no degree")
        self.values = None

    @staticmethod
    def symbol(item):
        if "exp" in item:
            return "exp", rational(parts(item, ["exp"])[0])
        if "tan" in item:
            w, t = items(parts(item, ["tan"])[0], rational)
            need(w, "a tangent of nothing")
            return "tan", w, t
        monic, t, index = parts(item, ["solution", "time", "index"])
        monic = items(monic, rational)
        need(0 <= count(index) < len(monic) <= 64, "no such solution")
        return "solution", monic, rational(t), index

    def find(self, kind):
        return [(i, *s[1:]) for i, s in enumerate(self.symbols) if s[0] == kind]

    def exponential(self, x, first):
        if not x:
            return scalar(ONE)
        found = [(abs(x / of), i, x / of) for i, of in self.find("exp") if of and (x / of).denominator == 1 and abs(x / of) <= 200]
        need(found, f"exp({x}) is not among the symbols")
        _, i, k = min(found)  # the symbol with the smallest multiple
        power = scalar(P({abs(int(k)) << FIELD * (first + i): 1}))
        return power if k > 0 else Value({"": ONE}, power.scalar())

    def tangent(self, w, t, first, divisors):
        """tan(sqrt(w) t)/sqrt(w), by sums of a symbol's angle."""
        found = []
        for i, of, at in self.find("tan"):
            r = square_root(w / of)
            if r and (k := r * t / at).denominator == 1 and 0 < abs(k) <= 200:
                found.append((abs(k), i, k, r, of))
        need(found, "a tangent is not among the symbols")
        _, i, k, r, of = min(found)  # the symbol with the smallest multiple
        x = total = scalar(P({1 << FIELD * (first + i): 1}))
        for _ in range(abs(int(k)) - 1):
            below = scalar(ONE) + -(total * x * of_number(of))
            divisors.append(below.scalar())
            total = (total + x) * Value({"": below.bottom}, below.scalar())
        return total * of_number((1 if k > 0 else -1) / r)

    def basis(self, monic, t, index, first, divisors):
        """A fundamental solution of a mode at a time."""
        if monic == [0]:
            return scalar(ONE)
        if len(monic) == 1:
            return self.exponential(-monic[0] * t, first)
        w = monic[0] - monic[1] ** 2 / 4
        if len(monic) > 2 or w == 0:
            found = [i for i, *of in self.find("solution") if of == [monic, t, index]]
            need(found, "a solution is not among the symbols")
            return scalar(P({1 << FIELD * (first + found[0]): 1}))
        # X = exp(-b t/2), x = tan(sqrt(w) t/2)/sqrt(w): X 2x/(1 + w x^2), X (1 - w x^2)/(1 + w x^2) and b/2 times the former
        decay, x = self.exponential(-monic[1] * t / 2, first), self.tangent(w, t / 2, first, divisors)
        square = x * x * of_number(w)
        below = scalar(ONE) + square
        divisors.append(below.scalar())
        decay = decay * Value({"": below.bottom}, below.scalar())
        sine = (x + x) * decay
        return sine if index == 1 else (scalar(ONE) + -square) * decay + sine * of_number(monic[1] / 2)

    def held(self, a, first_order, time, delay, loop):
        ratio = delay / time
        samples, rest = int(ratio // 1), ratio % 1
        need(samples <= MAX_ORDER, "a dead time has too many samples")

        def respond(share):
            return self.response(a, time, share * time, 2 if first_order else 1, loop)

        def by(factor, m):
            factor = factor if isinstance(factor, P) else number(factor)
            return [[e * factor for e in row] for row in m]

        def plus(m, k):
            return [[e + f for e, f in zip(*rows)] for rows in zip(m, k)]

        def product(m, k):
            return [[sum((e * f for e, f in zip(row, column)), ZERO) for column in zip(*k)] for row in m]

        if not rest:
            (state, whole, slope), over = respond(Fraction(1))
            enters = [(samples, plus(whole, by(-1, slope)) if first_order else whole, Fraction(1))]
            enters += [(samples - 1, slope, Fraction(0))] if first_order else []
            return state, enters, over, samples
        (s0, s1, s2), s_over = respond(1 - rest)
        (r0, r1, r2), r_over = respond(rest)
        n, d = rest.numerator, rest.denominator
        state, over = by(d, product(s0, r0)), r_over * s_over * number(d)
        if first_order:
            early = product(s0, plus(by(n, r1), by(-d, r2)))
            now = plus(product(s0, plus(by(d - n, r1), by(d, r2))), by(r_over * number(d), plus(s1, by(-1, s2))))
            late = [(samples - 1, by(r_over * number(d), s2), Fraction(0))]
            shares = rest, 1 - rest
        else:
            early, now, late, shares = by(d, product(s0, r1)), by(r_over * number(d), s1), [], (Fraction(1), Fraction(0))
        return state, [(samples, now, shares[1]), (samples + 1, early, shares[0]), *late], over, samples + 1

    @staticmethod
    def placed(edge, hold):
        """How many samples an edge stands behind what commands it, and the rest of its period."""
        place = hold[2] / hold[1] + edge
        need(place // 1 <= MAX_ORDER, "a dead time has too many samples")
        return int(place // 1), 1 - place % 1

    def flow(self, a, time, rest, duty, loop):
        """exp(A r T), over one denominator."""
        (whole, _, _), over = self.response(a, time, time if rest is None else rest * time, 1, loop)
        return whole, over

    def response(self, a, time, span, zeros, loop):
        """exp(A t), its integral, and that one's integral over the sample time, over one denominator: the first row of exp(M t)
        for M = [[A, 1, 0], [0, 0, 1/T], [0, 0, 0]] is the sum of the b(t) Z_b, with Z_b from the derivatives at 0."""
        n = len(a)
        one = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
        powers, monic, m = [one], [], one

        def product(m, k):
            spend(n ** 3, size(x.denominator for row in m for x in row), size(x.denominator for row in k for x in row))
            return [[sum((x * y for x, y in zip(row, column)), Fraction(0)) for column in zip(*k)] for row in m]

        for k in range(1, n + 1):  # Faddeev, LeVerrier
            am = product(a, m)
            monic.insert(0, -sum((am[i][i] for i in range(n)), Fraction(0)) / k)
            m = [[am[i][j] + monic[0] * one[i][j] for j in range(n)] for i in range(n)]
        basis, rest = [], [*monic, Fraction(1)]
        for mode in self.modes:
            multiplicity = zeros if mode == [0] else 0
            while (quotient := divided_monic(rest, mode)) is not None:
                rest, multiplicity = quotient, multiplicity + 1
            basis += [(mode, j, k) for j in range(multiplicity) for k in range(len(mode))]
        need(rest == [1], "a held block has a mode that is not among the modes")
        order = len(basis)
        while len(powers) < order:
            powers.append(product(a, powers[-1]))
        derivatives = []
        for mode, j, k in basis:
            phi = [Fraction(int(l == k)) for l in range(len(mode))]
            while len(phi) < order:
                phi.append(-sum(c * f for c, f in zip(mode, phi[-len(mode):])))
            derivatives.append([prod(range(l - j + 1, l + 1)) * phi[l - j] if l >= j else Fraction(0) for l in range(order)])
        weights = inverse_of([list(row) for row in zip(*derivatives)])
        values, over = [], ONE
        for mode, j, k in basis:
            value = self.basis(mode, span, k, loop.first, loop.scope.divisors) * of_number(span ** j)
            values.append(value)
            over = over * (value.bottom / over.common(value.bottom) if any(over) or any(value.bottom) else
                           number(value.bottom[0] // gcd(over[0], value.bottom[0])))
            while over / value.bottom is None:  # a common divisor has no integers in it
                over = over * number(value.bottom[max(value.bottom)])
        tops = [value.scalar() * (over / value.bottom) for value in values]
        z = [[[[sum((weights[b][l] * powers[l - s][i][j] for l in range(s, order)), Fraction(0)) / (time if s == 2 else 1)
                for j in range(n)] for i in range(n)] for s in range(3)] for b in range(order)]
        common = lcm(*(x.denominator for m in z for part in m for row in part for x in row))
        return [[[sum((tops[b] * number(int(z[b][s][i][j] * common)) for b in range(order)), ZERO) for j in range(n)]
                 for i in range(n)] for s in range(3)], over * number(common)

    def enclosures(self, p):
        """The coefficients of the powers of the parameter, enclosed."""
        out = [(0, 0)] * (p.degree(1) + 1 if p else 0)
        for e, c in self.beside(p, 2).items():
            out[e >> FIELD] = c
        return out

    def beside(self, p, first):
        """The coefficients of the monomials in the variables before the symbols, enclosed."""
        if self.values is None:
            self.values = []
            for kind, *of in self.symbols:
                if kind == "exp":
                    value = solutions([Fraction(-1)], of[0], self.bits)[0]
                elif kind == "solution":
                    value = solutions(of[0], of[1], self.bits)[of[2]]
                else:
                    cosine, sine = solutions([of[0], Fraction(0)], of[1], self.bits)
                    need(cosine[0] > 0 or cosine[1] < 0, "a tangent is not told from infinity")
                    ends = [Fraction(s << self.bits, c) for s in sine for c in cosine]
                    value = min(ends) // 1, -(-max(ends) // 1)
                self.values.append(value)
        one, out, known = (1 << self.bits,) * 2, {}, {}
        for e, c in p.items():
            k, e = e & (1 << FIELD * first) - 1, e >> FIELD * first
            if e not in known:
                product, rest = one, e
                for x in self.values:
                    for _ in range(rest & MASK):
                        product = times(product, x, self.bits)
                    rest >>= FIELD
                need(not rest, "a polynomial has a variable that is no symbol")
                known[e] = product
            out[k] = added(out.get(k, (0, 0)), scaled_by(known[e], c))
        return out

def square_root(q):
    """If it is rational and positive."""
    if q <= 0:
        return None
    r = Fraction(isqrt(q.numerator), isqrt(q.denominator))
    return r if r * r == q else None

def divided_monic(p, mode):
    """The quotient of monic polynomials, the divisor without its leading coefficient, or None."""
    rest, n, out = p[:], len(mode), []
    if len(rest) <= n:
        return None
    while len(rest) > n:
        c = rest.pop()
        out.insert(0, c)
        for j in range(n):
            rest[len(rest) - n + j] -= c * mode[j]
    return None if any(rest) else out

def inverse_of(m):
    n = len(m)
    m = [row + [Fraction(int(i == j)) for j in range(n)] for i, row in enumerate(m)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if m[i][k]), None)
        need(pivot is not None, "the modes of a held block are not coprime")
        m[k], m[pivot] = m[pivot], m[k]
        m[k] = [x / m[k][k] for x in m[k]]
        m = [row if i == k else [x - row[k] * y for x, y in zip(row, m[k])] for i, row in enumerate(m)]
    return [row[n:] for row in m]

# ---------------------------------------------------------------- the characteristic polynomial

def cleared(entries):
    """Polynomials with rational coefficients, times a positive number: integers without a common factor."""
    common = lcm(*(c.denominator for e in entries for c in e.values()))
    entries = [P({k: int(c * common) for k, c in e.items()}) for e in entries]
    numbers = [c for e in entries for c in e.values()]
    spend(1 + len(numbers) // 10, size(numbers), size(numbers))
    return [e.over(gcd(*numbers)) for e in entries]

def eliminated(rows):
    """The determinant of integers [Bareiss1968]."""
    bits, last, sign = prod(sum(map(abs, row)) for row in rows).bit_length(), 1, 1
    spend(1 + len(rows) ** 3 // 3, bits // 2, bits // 2)
    while rows:
        k = min((k for k, row in enumerate(rows) if row[0]), key=lambda k: abs(rows[k][0]), default=None)
        if k is None:
            return 0
        (top, *rest), sign = rows.pop(k), -sign if k % 2 else sign
        rows = [[(top * x - first * y if first else top * x) // last for x, y in zip(row, rest)] for first, *row in rows]
        last = top
    return sign * last

def interpolated(values, nodes=None):
    """The coefficients of the polynomial with these values at 0, 1, 2, ..., or other integers, by Newton's divided differences."""
    d, out = values[:], []
    nodes = range(len(d)) if nodes is None else nodes
    spend(len(d) ** 2, size(d), 10)
    for k in range(1, len(d)):
        d[k:] = [(b - a) // (y - x) for a, b, x, y in zip(d[k - 1:], d[k:], nodes, nodes[k:])]
    for c, x in zip(d[::-1], nodes[::-1]):  # out (z - x) + c
        out = [a - x * b for a, b in zip([c, *out], [*out, 0])]
    return out

def determinant(m):
    """By its values at more points than its degrees."""
    if len(m) == 1:
        return m[0][0]
    degrees = []
    for v in (0, 1):
        sizes = [[e.degree(v) for e in row] for row in m]
        degrees.append(1 + min(sum(map(max, sizes)), sum(map(max, zip(*sizes)))))
    columns = []
    allow(degrees[0] * degrees[1] <= 1 << 20, "the model is too large for the check")
    for p in range(degrees[1]):
        columns.append(interpolated([
            eliminated([[sum(c * z ** (k & MASK) * p ** (k >> FIELD) for k, c in e.items()) for e in row] for row in m])
            for z in range(degrees[0])]))
    return sum((P.of(interpolated(list(row)), 1) * Z ** k for k, row in enumerate(zip(*columns))), ZERO)

MAX_BITS_OF_TERMS = 1 << 32  # of the exponents of a determinant's terms

def expanded(rows):
    """The determinant of a matrix with few entries: those of the rows so far, for each set of columns [Laplace]."""
    minors = {0: ONE}
    for row in rows:
        after, terms = {}, 0
        longest = sum(max(max(p, default=0) for p in of).bit_length() for of in (minors.values(), row))
        for columns, minor in minors.items():
            allow(terms * longest <= MAX_BITS_OF_TERMS, "a loop with symbols is too large for the check")
            for j, e in enumerate(row):
                if e and not columns >> j & 1:
                    term = minor * e
                    term = -term if (columns >> j).bit_count() % 2 else term
                    old = after.get(columns | 1 << j, ZERO)
                    after[columns | 1 << j] = old + term
                    terms += len(after[columns | 1 << j]) - len(old)
        minors = {columns: short(minor) for columns, minor in after.items() if minor}
        terms = sum(map(len, minors.values()))
        allow(len(minors) <= 20_000 and terms <= 400_000, "a loop with symbols is too large for the check")
    return next(iter(minors.values()), ZERO)

class Enclosed:
    """Determinants of numbers that are enclosed: pairs of a middle and a radius, in units of 2^-bits."""

    def __init__(self, bits):
        self.bits = bits

    def times(self, f, g):
        (a, r), (b, s) = f, g
        return a * b >> self.bits, (-(-(abs(a) * s + (abs(b) + s) * r) >> self.bits)) + 1 if r or s else int(bool(a and b))

    def shifted(self, f, left):
        return (f[0] << left, f[1] << left) if left >= 0 else (f[0] >> -left, (f[1] >> -left) + 2 if f[1] or f[0] else 0)

    def balanced(self, numbers, bits=None):
        """All times a power of two, so that the longest has all bits; and by how much they were shifted."""
        longest = max((abs(m) + r for m, r in numbers), default=0).bit_length()
        left = (self.bits if bits is None else bits) - longest if longest else 0
        return [self.shifted(f, left) for f in numbers], left

    def inverse(self, f):
        m, r = f  # |1/x - 1/m| <= r/(|m| (|m| - r))
        return (1 << 2 * self.bits) // m, (r << 2 * self.bits) // (abs(m) * (abs(m) - r)) + 2

    def determinant(self, rows):
        """By elimination, with the exponent of a power of two by which it is multiplied; None where a pivot may be zero."""
        rows, product, exponent, taken, n = dict(enumerate(rows)), (1 << self.bits, 0), 0, [], len(rows)
        while rows:
            hold(sum(map(len, rows.values())), 2 * self.bits)
            order = sorted(rows, key=lambda r: len(rows[r]))  # the shortest row fills up least
            if not rows[order[0]]:
                return (0, 0), 0
            for r in order:
                column = max((c for c, (m, e) in rows[r].items() if abs(m) > e), key=lambda c: abs(rows[r][c][0]), default=None)
                if column is not None:
                    break
            else:
                if n > len(taken) + 1:
                    return None
                [r] = rows  # nothing is divided by the last one
                column = next(iter(rows[r]))
            row = rows.pop(r)
            pivot = row.pop(column)
            taken.append((r, column))
            [product], left = self.balanced([self.times(product, pivot)])
            exponent -= left
            below = [other for other in rows.values() if column in other]
            if not below:
                continue
            inverse = self.inverse(pivot)
            spend((1 + len(below)) * len(row), self.bits, self.bits)
            shares = [(c, self.times(f, inverse)) for c, f in row.items()]
            for other in below:
                factor = other.pop(column)
                for c, share in shares:
                    (m, e), (x, d) = other.get(c, (0, 0)), self.times(factor, share)
                    other[c] = m - x, e + d
        columns = [column for _, column in sorted(taken)]
        for i in range(n):  # a permutation that is odd changes the sign
            while columns[i] != i:
                k = columns[i]
                columns[i], columns[k], product = columns[k], k, (-product[0], product[1])
        return product, exponent

    def interpolated(self, nodes, values):
        """From lists of values, each with its exponent, the lists of coefficients one after the other, with one exponent."""
        def length(numbers):
            return max(abs(m) + r for m, r in numbers).bit_length()

        most = max((length(numbers) + exponent for numbers, exponent in values if length(numbers)), default=0) - self.bits
        lists = [[self.shifted(f, exponent - most) if length(numbers) else f for f in numbers] for numbers, exponent in values]
        out = [[] for _ in nodes]
        spend(len(nodes) ** 2 * len(lists[0]), self.bits, 64)
        for d in map(list, zip(*lists)):
            for step in range(1, len(d)):
                for i in range(len(d) - 1, step - 1, -1):
                    (a, r), (b, s), gap = d[i], d[i - 1], nodes[i] - nodes[i - step]
                    d[i] = (a - b) // gap, (r + s) // abs(gap) + 2 if r or s or a != b else 0
            p = []
            for (a, r), x in zip(d[::-1], nodes[::-1]):  # p (t - x) + d
                p = [(a, r), *p]
                for i in range(1, len(p)):
                    p[i - 1] = p[i - 1][0] - x * p[i][0], p[i - 1][1] + abs(x) * p[i][1]
            for list_, c in zip(out, p):
                list_.append(c)
        return [c for list_ in out for c in list_], most

    def coefficients(self, rows, degree, known, asked, bits):
        """Of the powers of z and the names of a box in the determinant. Of each name it is said whether it is left; the others have values, which
        are known. All times one number."""
        entries = []
        for row in rows:
            out = {}
            for column, p in enumerate(row):
                for e, c in p.items():
                    powers, term, e = [e & MASK, *[0] * len(asked)], (c << self.bits, 0), e >> 2 * FIELD
                    for v, f in enumerate(known):
                        if v < len(asked) and asked[v]:
                            powers[1 + v] = e & MASK
                        else:
                            for _ in range(e & MASK):
                                spend(2, self.bits, size([term[0]]))
                                term = self.times(term, f)
                        e >>= FIELD
                    old = out.setdefault(column, {}).get(tuple(powers), (0, 0))
                    out[column][tuple(powers)] = old[0] + term[0], old[1] + term[1]
            places = [(column, powers) for column in out for powers in out[column]]
            for (column, powers), f in zip(places, self.balanced([out[column][powers] for column, powers in places])[0]):
                out[column][powers] = f
            entries.append(out)
        counts = [degree + 1]
        for v in range(1, len(asked) + 1):
            sizes = [{column: max(powers[v] for powers in e) for column, e in row.items()} for row in entries]
            columns = [max((row.get(column, 0) for row in sizes), default=0) for column in range(len(rows))]
            counts.append(1 + min(sum(max(row.values(), default=0) for row in sizes), sum(columns)))
        allow(prod(counts) <= 800, "a determinant by enclosures has too many values")

        def at(point):
            nodes, values = [], []
            for z in (sign * k for k in range(2, degree + 12) for sign in (1, -1)):  # usual roots are at none of them
                if len(nodes) > degree:
                    break
                numbers = []
                for row in entries:
                    spend(sum(map(len, row.values())), self.bits, 64)
                    powers = {c: [(f, prod(x ** k for x, k in zip((z, *point), powers))) for powers, f in e.items()] for c, e in row.items()}
                    sums = {c: (sum(f[0] * q for f, q in terms), sum(f[1] * abs(q) for f, q in terms)) for c, terms in powers.items()}
                    numbers.append({c: f for c, f in sums.items() if f != (0, 0)})
                found = self.determinant(numbers)
                if found:
                    nodes.append(z)
                    values.append(([found[0]], found[1]))
            need(len(nodes) > degree, "a determinant by enclosures is not told from zero")
            return self.interpolated(nodes, values)

        def over(point):
            """Puts in values for the last names. The result is a polynomial in the first names; its list of coefficients goes through the powers of z first."""
            if len(point) == len(asked):
                return at(point)
            nodes = [k // 2 + 1 if k % 2 else -k // 2 for k in range(counts[len(asked) - len(point)])]
            return self.interpolated(nodes, [over((x, *point)) for x in nodes])

        found, _ = self.balanced(over(())[0], bits)
        powers = [()]
        for count in counts:
            powers = [(*others, k) for k in range(count) for others in powers]
        return dict(zip(powers, found))

def loop_of(text, kept, values, boxed=(), symbols=None, cut=None):
    """The model, its loop with the parameters of a box behind those that have values, and these values. A cut may have further names of its own."""
    model = Model(text)
    names = [*([kept] if kept is not None else []), *values, *boxed]
    need(len(set(names)) == len(names), "a parameter has two values")
    need(set(model.parameters) <= set(names), "a parameter has no value")
    numbers = set(names) - set(model.parameters)
    need(numbers <= set(model.constants), "the model has no such parameter")
    if numbers:  # given as such; and the model must be right as it is
        [constant(model.constants[name]) for name in numbers]
        others = {name: v for v, name in enumerate(model.parameters, 1)}
        Loop(model, others, symbols=Moving(1 + len(others)) if isinstance(symbols, (Moving, DeadTime)) else None)
    # A constant that is set has another number, and nothing else changes.
    model.constants = model.constants | {name: str(x) for name, x in values.items() if name in numbers}
    values = {name: x for name, x in values.items() if name not in numbers}
    variables = {name: v for v, name in enumerate([*values, *boxed], 2)} | ({} if kept is None else {kept: 1})
    values = list(values.values())
    count = len(boxed)
    if cut:
        need(cut.kind != "parameter" or cut.name in model.parameters or cut.name in model.constants, "the loop is cut at no parameter")
        if cut.kind == "parameter" and cut.name in model.constants:
            constant(model.constants[cut.name])
        cut.begin(2 + len(values) + count)
        count += cut.names
    if isinstance(symbols, Moving):
        symbols.next = 2 + len(values) + count  # behind all others
        if cut and cut.requirement == "delay_margin":
            cut.factor = symbols.delayed(cut.factor)
    return model, Loop(model, variables, values, Table() if symbols is None else symbols, count, cut), values

def characteristic_polynomial(text, kept, values, symbols=None):
    """Whether time is discrete, the degree, the coefficients of z^0, z^1, ... (none if undefined), the poles."""
    model, loop, values = loop_of(text, kept, values, symbols=symbols)
    if symbols:
        return over_symbols(model, loop, values)

    def system(equations, unknowns):
        return determinant([cleared([e.tops.get(name, ZERO).at(values) for name in unknowns]) for e in equations])

    # Undefined where all coefficients of a divisor vanish together.
    poles = [cleared([divisor.at(values)])[0].content(0) for divisor in loop.scope.divisors]
    n, undefined = loop.degree, (model.discrete, loop.degree, [], [ZERO], loop.doubled)
    if not all(poles):
        return undefined
    need(len(loop.equations) == len(loop.unknowns), "there are not as many equations as unknowns")
    d = system(loop.equations, loop.unknowns)
    need(d.degree(0) <= n, "a determinant has too high a degree")
    # A characteristic polynomial is taken as it is written, a determinant with the leading coefficient 1.
    written = "characteristic" in model.root["loop"]
    lead = cleared([loop.equations[0].bottom.at(values)])[0] if written else d.lead(0) if d.degree(0) == n else ZERO
    poles.append(lead)  # not well posed, if these are blocks
    for equations, states in loop.own:  # a block loses its order, which the other blocks' numerators can hide
        own = system(equations, states)
        poles.append(own.lead(0) if own.degree(0) == len(states) else ZERO)
    if not all(poles):
        return undefined
    common = lead.common(d.content(0)) if any(lead) else ONE  # to lowest terms
    d = (d if lead[max(lead)] * common[max(common)] > 0 else -d) / common
    d = d.coefficients(0) + [ZERO] * (n - d.degree(0))
    return model.discrete, n, d, poles if "block" in model.root else poles[:-1], loop.doubled

def over_symbols(model, loop, values):
    """The same with symbols; nothing is brought to lowest terms."""
    need(model.discrete and "block" in model.root, "only a sampled diagram of blocks has symbols")
    poles = []
    for divisor in loop.scope.divisors:
        [p] = cleared([divisor.at(values)])
        has_symbols = any(e >> 2 * FIELD for e in p)
        need(not has_symbols or not p.degree(0), "a divisor has symbols and the variable")
        poles.append(p if has_symbols else p.content(0))

    def system(equations, unknowns):
        return expanded([cleared([e.tops.get(name, ZERO).at(values) for name in unknowns]) for e in equations])

    need(len(loop.equations) == len(loop.unknowns), "there are not as many equations as unknowns")
    for equations, states in loop.own:
        own = system(equations, states)
        poles.append(own.lead(0) if own.degree(0) == len(states) else ZERO)
    d = system(loop.equations, loop.unknowns)
    need(d and d.degree(0) == loop.degree, "the loop is not well posed")
    poles.append(d.lead(0))
    need(all(poles), "the loop is undefined for every value")
    return True, loop.degree, d.coefficients(0), poles, loop.doubled

def characteristic_function(text, parameter, values, dead_time):
    """The function in s, the parameter and the symbol z for the dead time, and what is divided by, none of it with z."""
    model, loop, values = loop_of(text, parameter, values, symbols=dead_time)
    need(not model.discrete, "a sampled loop has no dead time")
    need(not loop.doubled, "a loop with dead time has complex coefficients")
    divisors = [cleared([divisor.at(values)])[0] for divisor in loop.scope.divisors]
    if "characteristic" in model.root["loop"]:
        divisors.append(cleared([loop.equations[0].bottom.at(values)])[0])
        need(not divisors[-1].degree(0), "the characteristic function has a denominator")

    def system(equations, unknowns):
        return expanded([cleared([e.tops.get(name, ZERO).at(values) for name in unknowns]) for e in equations])

    for equations, states in loop.own:
        own = system(equations, states)
        need(own.degree(0) == len(states), "a block loses its order")
        divisors.append(own.lead(0))
    need(all(p and not p.degree(2) for p in divisors), "a divisor depends on the dead time, or is zero")
    need(len(loop.equations) == len(loop.unknowns), "there are not as many equations as unknowns")
    d = system(loop.equations, loop.unknowns)
    need(d and d.degree(0) == loop.degree, "the loop is not well posed")
    return cleared([d])[0], divisors

def quasi_polynomial(text, parameter, values, base):
    """P_0(s) + P_1(s) z + ..., where nothing but the dead time depends on the parameter."""
    d, divisors = characteristic_function(text, parameter, values, DeadTime(base, 1))
    need(not any(p.degree(1) for p in [d, *divisors]), "the loop, or a divisor, depends on the parameter beside its dead time")
    parts = d.coefficients(2)
    while not parts[0]:
        parts.pop(0)
    return cleared(parts)

class Exact:
    """Polynomials in the parameter with integer coefficients."""

    def __init__(self, read=None):
        self.read = read or polynomial

    def descartes(self, f, a, b):
        return descartes(f.listed(1), a, b)

    def vanishes(self, f, x):
        return value(f.listed(1), x) == 0

    def is_unit(self, p):
        return bool(p) and not any(p)

    def is_nonzero(self, p):
        return bool(p)

    def is_stable(self, d, n, discrete, x):
        longest = 1 + max(c.degree(1) for c in d)
        at_sample = [value([*c.listed(1), *[0] * longest][:longest], x) for c in d]
        need(at_sample[-1], "line: the sample loses degree")
        return places(at_sample, discrete)[0] == n

class OverSymbols:
    """Polynomials in the parameter and symbols: zero is an identity, any other sign is read off an enclosure."""

    def __init__(self, table):
        self.table, self.known = table, {}

    def enclosures(self, p):
        key = id(p)
        if key not in self.known:
            self.known[key] = p, self.table.enclosures(p)  # p is kept, so that no other has its id
        return self.known[key][1]

    def read(self, json_value):
        out = {}
        for c, *exponents in items(json_value, lambda term: items(term, lambda item: item)):
            e = sum(count(k) << FIELD * (v + 1) for v, k in enumerate(exponents))
            need(all(0 <= k <= 4000 for k in exponents) and (not exponents or exponents[-1]), "a term is not in its shortest form")
            need(len(exponents) <= len(self.table.symbols) + 1 and integer(c) and e not in out, "a term is not in its shortest form")
            out[e] = integer(c)
        return P(out)

    def at(self, p, x, degree):
        """A positive multiple of the value, a polynomial in the symbols."""
        out = ZERO
        for k, c in enumerate(p.coefficients(1)):
            out = out + c * number(x.numerator ** k * x.denominator ** (degree - k))
        return out

    def descartes(self, f, a, b):
        if not f.degree(1) or a is b is None:
            return f.degree(1)
        c = self.enclosures(f)
        if a is None:
            c, a, b = [scaled_by(x, (-1) ** k) for k, x in enumerate(c)], -b, None
        width = Fraction(1) if b is None else b - a
        bottom, n = lcm(a.denominator, width.denominator), len(c) - 1
        c = [scaled_by(x, bottom ** (n - k)) for k, x in enumerate(c)]
        c = [scaled_by(x, int(width * bottom) ** k) for k, x in enumerate(self.shifted(c, int(a * bottom)))]
        return changes(map(certain, c if b is None else self.shifted(c[::-1], 1)))

    @staticmethod
    def shifted(c, a):
        c = c[:]
        spend(len(c) ** 2, size(x for x, _ in c), a.bit_length())
        for i in range(len(c)):
            for j in range(len(c) - 2, i - 1, -1):
                c[j] = added(c[j], scaled_by(c[j + 1], a))
        return c

    def vanishes(self, f, x):
        left = self.at(f, x, f.degree(1))
        return not left or not certain(self.table.enclosures(left)[0])

    def is_unit(self, p):
        return not p.degree(1) and self.is_nonzero(p)

    def is_nonzero(self, p):
        return any(lo > 0 or hi < 0 for lo, hi in self.enclosures(p))

    def is_stable(self, d, n, discrete, x):
        degree = max(c.degree(1) for c in d)
        at_sample = [(self.table.enclosures(self.at(c, x, degree)) or [(0, 0)])[0] for c in d]
        return self.inside(at_sample, True) == n

    def inside(self, d, stop):
        """The roots inside the unit circle, with none on it, by Schur-Cohn's reduction; with `stop` less if one is outside."""
        bits, found = self.table.bits, 0
        need(certain(d[-1]), "the degree is lost")
        while len(d) > 1:
            more = bits - max(size(x) for x in d)
            d = [(lo << more, hi << more) if more >= 0 else floor_shift((lo, hi), -more) for lo, hi in d]
            first, last = d[0], d[-1]
            sign = certain(added(times(last, last, bits), scaled_by(times(first, first, bits), -1)))
            need(sign, "a root count is not certain")
            if sign < 0 and stop:
                return found
            found += sign > 0
            one, other = (last, first) if sign > 0 else (first, last)
            d = [added(times(one, x, bits), scaled_by(times(other, y, bits), -1)) for x, y in zip(d, d[::-1])]
            d = d[1:] if sign > 0 else d[:-1]
        need(certain(d[0]), "a root count is not certain")
        return found

    def places(self, d, poles):
        need(all(map(self.is_unit, [*poles, d[-1]])), "a divisor is not shown to be other than zero")
        on = 0
        for root in (1, -1):  # by an identity
            while len(d) > 1:
                quotient = [d[-1]]
                for c in d[-2::-1]:
                    quotient.append(quotient[-1] * number(root) + c)
                if quotient.pop():
                    break
                d, on = quotient[::-1], on + 1
        inside = self.inside([(self.table.enclosures(c) or [(0, 0)])[0] for c in d], False)
        return inside, on, len(d) - 1 - inside

def same_over_symbols(given, own):
    """Whether the own polynomial is the given one times something that has no zero where the loop is defined."""
    need(len(given) == len(own) and given[-1], "characteristic: not that of the model")
    given, own = cleared(given), cleared(own)
    quotient = own[-1] / given[-1]
    need(quotient is not None and all(g * quotient == o for g, o in zip(given, own)), "characteristic: not that of the model")

def in_region(d, discrete, extent):
    """The coefficients of D(R z) or D(s - S): integers without a common factor; a positive factor is lost."""
    top, bottom = (P({1 << FIELD: 1}), 1) if extent == "parameter" else (number(extent.numerator), extent.denominator)
    powers = [number(bottom ** k) for k in range(len(d))]
    if discrete:
        d = [c * top ** k * power for k, (c, power) in enumerate(zip(d, powers[::-1]))]
    else:
        d = shifted([c * power for c, power in zip(d, powers[::-1])], -top)
        d = [c * power for c, power in zip(d, powers)]
    return cleared(d)

# ---------------------------------------------------------------- roots and boundaries

def variations(sturm_chain):
    """Between minus infinity and infinity."""
    return changes(f[-1] * (-1) ** (len(f) - 1) for f in sturm_chain) - changes(f[-1] for f in sturm_chain)

def sturm(f, g):
    """The chain f, g, and minus the remainder each time; it ends with a greatest common divisor."""
    f, g, out = P.of(f), P.of(g), []
    while g:
        out.append(f.listed(0))
        f, g = g, -f.remainder(g, 0)
    return [*out, f.listed(0)]

def places(d, discrete):
    """The numbers of roots inside, on and outside."""
    if discrete:
        on = 0
        while (quotient := P.of(d) / P.of([1, 1])) is not None:
            d, on = quotient.listed(0), on + 1
        d = scaled(shifted(d, -1), 2)[::-1]  # z = 2/w - 1
        inside, more, outside = places(shifted(mirrored(d), -1), False)  # w = 1 - s
        return inside, on + more, outside
    # With s = iw, over w: the Cauchy index of the odd part over the even part is roots left minus roots right; what
    # both have in common has the roots on the axis.
    n, on = len(d) - 1, 0
    turned = [(-1) ** ((n - k) // 2) * c for k, c in enumerate(d)]
    chain = sturm(*([c if (n - k) % 2 == odd else 0 for k, c in enumerate(turned)] for odd in (0, 1)))
    index, common = variations(chain), chain[-1]
    while len(common) > 1:  # the real roots, of any multiplicity
        chain = sturm(common, [k * c for k, c in enumerate(common)][1:])
        on, common = on + variations(chain), chain[-1]
    inside = (n - on + index) // 2
    return inside, on, n - on - inside

def half_size_pair(d, discrete):
    """A and B, polynomials in x (variable 0) and the parameter, and their formal degrees: see the grammar."""
    n = len(d) - 1
    k = n // 2
    if not discrete:
        return *(sum((c * Z ** j for j, c in enumerate(d[first::2])), ZERO) for first in (0, 1)), k, (n - 1) // 2

    def in_x(coefficients, first, then):
        """sum c_j t_j(x) with t_0, t_1 as given and t_(j+1) = x t_j - t_(j-1)"""
        out = ZERO
        for c in coefficients:
            out = out + c * first
            first, then = then, Z * then + -first
        return out

    even, odd = ([d[j] + d[n - j] * number(sign) for j in range(n - k, n + 1)] for sign in (1, -1))
    if n % 2 == 0:  # z^j + z^-j, and (z^j - z^-j)/(z - 1/z)
        return in_x([d[k], *even[1:]], number(2), Z), in_x(odd[1:], ONE, Z), k, k - 1
    # (z^(j+1) + z^-j)/(z + 1), and (z^(j+1) - z^-j)/(z - 1)
    return in_x(even, ONE, Z + number(-1)), in_x(odd, ONE, Z + ONE), k, k

# ---------------------------------------------------------------- boxes of tolerances

class Tensor:
    """Bernstein coefficients of polynomials over a box, each polynomial times a positive number, and by how much they may be off at most; the
    last axis is the frequency and runs fastest."""

    def __init__(self, counts, planes, slack=(0, 0)):
        self.counts, self.planes, self.slack = counts, planes, slack

    @staticmethod
    def of(lists, sides, ring, scales=None):
        """Of lists of polynomials in the variables from 2 on, each list for the powers of the frequency, which count times these numbers."""
        counts = [1 + max(p.degree(2 + i) for p in sum(lists, [])) for i in range(len(sides))] + [len(lists[0])]
        need(prod(counts) <= 1 << 17, "a box has too many coefficients")
        planes, slack = [], []
        for powers, factors in zip(lists, scales or [[1] * len(lists[0])]):
            plane, off = [0] * prod(counts), 0
            for j, (p, factor) in enumerate(zip(powers, factors)):
                known = ring.known(p)
                for e, (c, _) in known.items():
                    place = 0
                    for count in counts[:-1]:
                        place, e = place * count + (e & MASK), e >> FIELD
                    plane[place * len(powers) + j] = c
                off = max(off, factor * Tensor.loose({e: radius for e, (_, radius) in known.items() if radius}, sides, counts))
            planes.append(plane)
            slack.append(-(-off // 1))
        tensor = Tensor(counts, planes, slack)
        for i, side in enumerate(sides):
            if counts[i] > 1:
                tensor.change_basis(i, *side)
        return tensor

    @staticmethod
    def loose(radii, sides, counts):
        """By how much Bernstein coefficients are off at most, times what a change of basis makes of them: those of a power of a parameter are means
        of products of its ends."""
        if not radii:
            return 0
        bits = sum((count - 1) * (2 * size(x for end in side for x in end.as_integer_ratio()) + 4) for side, count in zip(sides, counts))
        hold(1, bits + size(radii.values()))
        spend(len(radii) + len(sides), bits, bits)
        total = Fraction(0)
        for e, radius in radii.items():
            for side in sides:
                radius, e = radius * max(map(abs, side)) ** (e & MASK), e >> FIELD
            total += radius
        return total * prod(lcm(*(end.denominator for end in side)) ** (count - 1) * lcm(*(comb(count - 1, e) for e in range(count)))
                            for side, count in zip(sides, counts) if count > 1)

    @staticmethod
    def of_pair(p, sides, v0, weight, ring):
        """Of (1 - t)^k E and weight (1 - t)^k O, v = v0 t/(1 - t), p(i w) = E(v) + i w O(v), v = w^2."""
        k = (len(p) - 1) // 2
        p = [c * number((-1) ** (j // 2)) for j, c in enumerate(p + [ZERO])]
        ways = [comb(k, j) for j in range(k + 1)]
        top, bottom, common = v0.numerator, v0.denominator, lcm(*ways)
        scale_bits = k * (2 + size(v0.as_integer_ratio()))
        hold(k + 1, scale_bits)
        spend(4 * k, scale_bits, k)
        scales = [[w * top ** j * bottom ** (k - j) * common // ways[j] for j in range(k + 1)]
                  for w in (weight.denominator, weight.numerator)]
        tensor = Tensor.of([p[0:2 * k + 1:2], p[1:2 * k + 2:2]], sides, ring, scales)
        hold(len(tensor.planes[0]), size(c for plane in tensor.planes for c in plane) + scale_bits)
        for plane, factors in zip(tensor.planes, scales):
            spend(len(plane), size(plane), size(factors))
            for j, scale in enumerate(factors):
                plane[j::k + 1] = [c * scale for c in plane[j::k + 1]]
        common = 1 if any(tensor.slack) else gcd(*(c for plane in tensor.planes for c in plane)) or 1
        return Tensor(tensor.counts, [[c // common for c in plane] for plane in tensor.planes], tensor.slack)

    def slices(self, plane, axis):
        """The coefficients with each index along an axis."""
        stride, count = prod(self.counts[axis + 1:]), self.counts[axis]
        if stride == 1:
            return [plane[j::count] for j in range(count)]
        starts = range(0, len(plane), stride * count)
        return [[c for at in starts for c in plane[at + j * stride:at + (j + 1) * stride]] for j in range(count)]

    def joined(self, slices, axis):
        """A plane of slices, of which there may be other than before."""
        stride, out = prod(self.counts[axis + 1:]), []
        for at in range(0, len(slices[0]), stride):
            for part in slices:
                out += part[at:at + stride]
        return out

    def change_basis(self, axis, low, high):
        """From the powers of p to Bernstein's polynomials of u, p = low + (high - low) u = (a + w u)/q, along an axis, times a positive
        number."""
        l, q = self.counts[axis] - 1, lcm(low.denominator, high.denominator)
        a, w = int(low * q), int((high - low) * q)
        hold(l + 1, 2 * l)
        ways = [comb(l, e) for e in range(l + 1)]
        common = lcm(*ways)
        grown = (l + 1) * (size([a, w, q]) + 4)

        def changed(lane):
            if not any(lane):
                return lane
            spend(4 * len(lane), bits, size([q, w]))
            c = shifted([x * q ** (l - f) for f, x in enumerate(lane)], a)
            c = [x * w ** e * (common // ways[e]) for e, x in enumerate(c)]
            spend(l * l // 2, bits)
            for i in range(l):  # b_j = sum of C(j, e) c_e
                c[i:] = [c[i], *map(int.__add__, c[i:], c[i + 1:])]
            return c

        bits = max(map(size, self.planes)) + grown
        hold(len(self.planes) * len(self.planes[0]), bits)
        for n, plane in enumerate(self.planes):
            lanes = [changed(list(lane)) for lane in zip(*self.slices(plane, axis))]
            self.planes[n] = self.joined(list(map(list, zip(*lanes))), axis)

    def halves(self, axis):
        """Over both halves along an axis, times a power of two [de Casteljau]."""
        low, high, last = [], [], self.counts[axis] - 1
        for plane in self.planes:
            spend(len(plane) * last // 2, size(plane))
            level, lower, upper = self.slices(plane, axis), [], []
            for k in range(last, -1, -1):
                lower.append([c << k for c in level[0]])
                upper.insert(0, [c << k for c in level[-1]])
                level = [list(map(int.__add__, a, b)) for a, b in zip(level, level[1:])]
            low.append(self.joined(lower, axis))
            high.append(self.joined(upper, axis))
        slack = [off << last for off in self.slack]
        return Tensor(self.counts, low, slack), Tensor(self.counts, high, slack)

    def combined(self, a, b):
        spend(2 * len(self.planes[0]), size(self.planes[0]), size([a, b]))
        return [a * x + b * y for x, y in zip(*self.planes)]

    def raised(self, plane, axis, times_share):
        """The same polynomial, or times 2 u - 1, with one degree more along an axis, times that degree."""
        parts, sign = self.slices(plane, axis), -1 if times_share else 1
        n, none = len(parts), [0] * len(parts[0])
        spend(2 * len(plane), size(plane))
        return self.joined([[j * x + sign * (n - j) * y for x, y in zip(below, here)]
                            for j, (below, here) in enumerate(zip([none, *parts], [*parts, none]))], axis)

    def affine(self, axes, vectors):
        """Of the product with a vector that is affine along axes, and by how much it may be off."""
        total, off = None, sum(abs(a) * self.slack[0] + abs(b) * self.slack[1] for a, b in vectors)
        for k, (a, b) in enumerate(vectors):
            term, shape = self.combined(a, b), Tensor(self.counts[:], [])
            for i, axis in enumerate(axes):
                term = shape.raised(term, axis, k == i + 1)
                shape.counts[axis] += 1
            total = term if total is None else list(map(int.__add__, total, term))
        return total, off * prod(self.counts[axis] for axis in axes)  # with one degree more the weights add up to that

NODE = re.compile(r"x|s([0-9]{1,6}),|l(-?[0-9]+,-?[0-9]+);|a((?:[0-9]{1,6},|x,)*(?:[0-9]{1,6}|x)):([-0-9,]+);|[+-]")

def follow(tree, whole):
    """Whether the tree halves the box until each cell shows what is claimed: of one polynomial that it is not zero, of two that
    they are not both."""
    need(isinstance(tree, str), "a tree is a text")
    at, stack, pair, last = 0, [whole], len(whole.planes) == 2, len(whole.counts) - 1
    while stack:
        cell = stack.pop()
        node = NODE.match(tree, at)
        need(node, "a tree ends too early, or has another part")
        letter, at = node[0][0], node.end()
        if letter in "xs":
            axis = last if letter == "x" else int(node[1])
            need(pair if letter == "x" else axis < last, "a tree halves what is not there")
            bits = max(map(size, cell.planes)) + cell.counts[axis]
            hold((len(stack) + 2) * len(cell.planes) * len(cell.planes[0]), bits)
            stack += cell.halves(axis)[::-1]
        elif letter in "+-":
            need(not pair, "a sign where a vector must be")
            need(all((c if letter == "+" else -c) > cell.slack[0] for c in cell.planes[0]), "a leaf has not its sign")
        else:
            need(pair, "a vector where a sign must be")
            axes = [last if axis == "x" else int(axis) for axis in node[3].split(",")] if letter == "a" else []
            need(all(a < b for a, b in zip(axes, [*axes[1:], last + 1])), "the axes of a leaf are not in order")
            need("x" in (node[3] or "") or last not in axes, "a leaf has an axis that is not there")
            numbers = [integer(c) for c in (node[2] or node[4]).split(",")]
            need(len(numbers) == 2 * len(axes) + 2, "a leaf has not one vector for each axis and one more")
            product, off = cell.affine(axes, list(zip(numbers[::2], numbers[1::2])))
            need(all(c > off for c in product), "a leaf is not on one side")
    need(at == len(tree), "something follows a tree")

def with_values(entries, values):
    """Entries with numbers in the place of the parameters that have one, times a positive number. The factor of a cut is variable 1 then."""
    if is_real(*entries):
        return cleared([p.at(values) for p in entries])
    places, found = [], []
    for k, p in enumerate(entries):
        of_place = {}
        for e, c in p.items():
            of_place.setdefault(e // UNIT, P())[e % UNIT] = c
        places += [(k, e % (MASK + 1) * UNIT + (e >> FIELD << FIELD)) for e in of_place]
        found += [part.at(values) for part in of_place.values()]
    out = [P() for _ in entries]
    for (k, place), part in zip(places, cleared(found)):
        out[k] = out[k] + P({e + place: c for e, c in part.items()})
    return out

def over_box(text, names, values, symbols=None, enclosed=None, cut=None):
    """The coefficients in the parameters of a box, which are the variables from 2 on, and lists of polynomials at whose common zeros
    the loop is undefined.  By enclosures, over sides of a window and with a number of bits, each number in a coefficient is a variable of its own.
    With a complex factor it is variable 1, and nothing is doubled."""
    model, loop, values = loop_of(text, None, values, names, symbols, cut)
    moving, is_cut = loop.moving, cut and cut.is_complex
    if moving:
        moving.given(values)
    divisors = [with_values([divisor], values)[0].coefficients(0) for divisor in loop.scope.divisors]

    def system(equations, unknowns):
        return expanded([with_values([e.tops.get(name, ZERO) for name in unknowns], values) for e in equations])

    need(len(loop.equations) == len(loop.unknowns), "there are not as many equations as unknowns")
    if "characteristic" in model.root["loop"]:
        [equation], [name] = loop.equations, loop.unknowns
        d, below = with_values([equation.tops.get(name, ZERO), equation.bottom], values)
        divisors.append([below])
    elif enclosed:
        sides, bits = enclosed
        rows = [cleared([e.tops.get(name, ZERO).at(values) for name in loop.unknowns]) for e in loop.equations]
        models, first = Models(1, 2 * bits + 128, len(sides)), moving.next - len(values)
        known = moving.values([models.coordinate(*side, i) for i, side in enumerate(sides)], models)
        known = [(f[0][0], beside_constant(f)) for f in known]
        asked = [low != high for low, high in sides]
        found = Enclosed(models.bits).coefficients(rows, loop.degree, known, asked, bits)
        moving.sources.append(("numbers", list(found.values())))
        d = sum((P({sum((k << FIELD * (2 + i) for i, k in enumerate(powers)), z) | 1 << FIELD * (first + v): 1})
                 for v, (z, *powers) in enumerate(found)), ZERO)
    else:
        d = system(loop.equations, loop.unknowns)
        need(d.degree(0) <= loop.degree, "a determinant has too high a degree")
    for equations, states in loop.own:
        own = system(equations, states)
        divisors.append([own.lead(0) if own.degree(0) == len(states) else ZERO])
    if "characteristic" not in model.root["loop"] and not is_cut:  # else looked at beside what has the factor
        divisors.append([d.lead(0) if d.degree(0) == loop.degree else ZERO])
        if moving:
            moving.has_lead_last = True
    return model.discrete, d.coefficients(0) + [ZERO] * (loop.degree - d.degree(0)), divisors, loop.doubled

class InBox:
    """Polynomials in the parameters of a box, with integers or with polynomials in the symbols of a table for coefficients."""

    def __init__(self, parameters, table=None):
        self.table, self.parameters = table, parameters
        self.read = boxed(parameters + (len(table.symbols) if table else 0))

    def has_parameters(self, p):
        return any(e & (1 << FIELD * (2 + self.parameters)) - 1 for e in p)

    def known(self, p):
        """What stands with the exponents of the parameters, and by how much that may be off, all times one positive number."""
        if not self.table:
            return {e >> 2 * FIELD: (c, 0) for e, c in p.items()}
        return {e >> 2 * FIELD: (lo + hi, hi - lo) for e, (lo, hi) in self.table.beside(p, 2 + self.parameters).items()}

    def vanishes_only_with(self, p, factors):
        """Whether nothing but a number other than zero is left of a polynomial when what it has in common with the factors is divided out."""
        p = p.primitive()
        for f in factors:  # most often enough, and cheap beside common divisors
            while self.has_parameters(p) and (quotient := p / f) is not None:
                p = quotient
        for f in factors:
            while self.has_parameters(p) and self.may_share(p, f) and any(common := p.common(f)):
                p = p / common
        return bool(p) and not self.has_parameters(p) and all(abs(about) > off for about, off in self.known(p).values())

    def may_share(self, p, f):
        """Whether there may be a common factor with a parameter in it, as images in one variable tell."""
        shared = [v for v in range(2, 2 + self.parameters) if p.degree(v) and f.degree(v)]
        return any(len(common_image(image(p, v, POINTS[0]), image(f, v, POINTS[0]))) != 1 for v in shared)

    def at(self, polynomials, point):
        """Polynomials in symbols, together times a positive number."""
        return cleared([p.at(point) for p in polynomials])

    def is_stable(self, d, point, discrete):
        if not self.table:
            d, n = at_point(d, point), len(d) - 1
            return len(d) == n + 1 and places(d, discrete) == (n, 0, 0)
        d = [(self.table.enclosures(c) or [(0, 0)])[0] for c in self.at(d, point)]
        return OverSymbols(self.table).inside(d, True) == len(d) - 1

    def vanish(self, polynomials, point):
        """Whether all vanish there; that one does not is to be certain."""
        at = [c for c in self.at(polynomials, point) if c]
        need(not at or not self.table or any(map(OverSymbols(self.table).is_nonzero, at)), "a divisor is not shown to be other than zero")
        return not at

    def places(self, d, point, discrete):
        if not self.table:
            d = at_point(d, point)
            return places(d, discrete) if d else (0, 0, 0)
        d = self.at(d, point)
        while d and not d[-1]:
            d.pop()
        return OverSymbols(self.table).places(d, []) if d else (0, 0, 0)

def boxed(parameters):
    """A reader of polynomials in so many parameters of a box (and symbols behind them), which are the variables from 2 on."""
    def read(json_value):
        out = {}
        for c, *exponents in items(json_value, lambda term: items(term, lambda item: item)):
            e = sum(count(k) << FIELD * (v + 2) for v, k in enumerate(exponents))
            need(all(0 <= k <= MAX_DEGREE for k in exponents) and (not exponents or exponents[-1]), "a term is not in its shortest form")
            need(len(exponents) <= parameters and integer(c) and e not in out, "a term is not in its shortest form")
            out[e] = integer(c)
        return P(out)
    return read

def at_point(polynomials, point):
    """Polynomials in the parameters of a box, as the coefficients of one in z, times a positive number."""
    return P.of([c.get(0, 0) for c in cleared([p.at(point) for p in polynomials])]).listed(0)

def in_half_plane(d):
    """(1 - s)^n D((1 + s)/(1 - s))"""
    n, bits = len(d) - 1, size(c for p in d for c in p.values())
    hold((n + 1) * sum(map(len, d)), bits + n)
    p = [ZERO] * (n + 1)
    for i, c in enumerate(d):
        spend(n * n // 4 + n * len(c), bits + n)
        row = [1]
        for j in range(n):
            row = [x + y if j < i else x - y for x, y in zip([*row, 0], [0, *row])]
        p = [x + c * number(w) for x, w in zip(p, row)]
    return p

def beside(given, own, doubled):
    """What the model's own polynomial has beside the given one, or beside its square."""
    given = squared(given) if doubled and len(given) != len(own) else given
    need(len(given) == len(own) and any(given), "characteristic: not that of the model")
    given = cleared(given)
    k = min((k for k, c in enumerate(given) if c), key=lambda k: len(given[k]))
    common = own[k] / given[k]
    need(common is not None and all(g * common == o for g, o in zip(given, own)), "characteristic: not that of the model")
    return common

def check_tolerance(model, document, statement, values, discrete, extent):
    symbols, further = table_of(document)
    names = ["schema", "statement", "characteristic", "factors", "pair"]
    _, _, given, factors, pair, *_ = parts(document, names + further, ["model"])
    keys = ["kind", "time", "set", "region", "tolerances", "factor", "limit", "beyond"]
    *_, tolerances, factor, limit, beyond = parts(statement, keys)
    need(extent != "parameter", "the region has no parameter here")
    tolerances = items(tolerances, lambda item: parts(item, ["name", "nominal", "between"]))
    names = [name_of(name) for name, _, _ in tolerances]
    nominal = [rational(x) for _, x, _ in tolerances]
    between = [items(ends, rational) for _, _, ends in tolerances]
    factor = rational(factor)
    need(names and factor >= 0 and all(len(ends) == 2 for ends in between), "there is no box")
    need(all(low <= x <= high for x, (low, high) in zip(nominal, between)), "a nominal value is not within its tolerance")

    need(limit is None or limit in names, "the limit is that of no tolerance")

    def at_factor(factor, of_limit=None):
        factors = [of_limit if of_limit is not None and limit in (None, name) else factor for name in names]
        return [[x + factor * (end - x) for end in ends] for factor, x, ends in zip(factors, nominal, between)]

    is_discrete, own, divisors, doubled = over_box(model, names, values, symbols)
    need(is_discrete == discrete and (discrete or not symbols), "the model's time is another")
    ring = InBox(len(names), symbols)
    own, given = in_region(own, discrete, extent), items(given, ring.read)
    common, given = beside(given, own, doubled), cleared(given)
    n, p = len(given) - 1, in_half_plane(given) if discrete else given
    sides, known = at_factor(factor), []
    for item in items(factors, lambda item: parts(item, ["polynomial", "tree"])):
        f = ring.read(item[0]).primitive()
        need(ring.has_parameters(f), "factors: one is constant")
        follow(item[1], Tensor.of([[f]], sides, ring))
        known.append(f)
    for ways in [[common], [p[0]], [p[n]], *divisors]:
        need(any(ring.vanishes_only_with(way, known) for way in ways), "factors: what must not vanish is not a product of them")
    v0, weight, tree = parts(pair, ["v0", "weight", "tree"])
    v0, weight = rational(v0), rational(weight)
    need(v0 > 0 and weight > 0, "pair: a scale is not positive")
    follow(tree, Tensor.of_pair(p, sides, v0, weight, ring))
    need(ring.is_stable(given, nominal, discrete), "stable: the nominal point is not")
    sentence = "For all " + ", ".join("{} from {} to {}".format(name, *inward(*side)) for name, side in zip(names, sides))
    sentence += f"{and_with(values)}, the loop is stable{within(discrete, extent)}; these are the tolerances times {exact(factor)}."
    keys = ["factor", "point", "degree", "inside", "on", "outside", "infinite"]
    for own_factor, point, *counts in items(beyond, lambda item: parts(item, keys)):
        own_factor, point = rational(own_factor), items(point, rational)
        need(own_factor >= 0 and len(point) == len(names), "beyond: there is no point")
        box = at_factor(factor, own_factor)
        need(all(low <= x <= high for x, (low, high) in zip(point, box)), "beyond: the point is not in its box")
        undefined = any(ring.vanish(ways, point) for ways in divisors)
        found = (0, 0, 0) if undefined else ring.places(own, point, discrete)
        found = [len(own) - 1, *found, 0 if undefined else len(own) - 1 - sum(found)]
        found = half_of(found) if doubled else found
        need([*map(count, counts)] == found, f"beyond: the counts are {found}")
        is_zero = not undefined and len(own) == 1 and ring.vanish(own, point)  # no roots to count, and not stable
        need(undefined or is_zero or found[1] < found[0], "beyond: the point is stable")
        of = "within the tolerances" if limit is None else f"the range of {limit} alone"
        sentence += f" At {at_values(dict(zip(names, point)))}, {of} times {exact(own_factor)}, it is not: "
        inside, on, outside, infinite = found[1:]
        sentence += (f"{inside} roots are inside, {on} on the boundary, {outside} outside, {infinite} infinite."
                     if sum(found[1:]) == found[0] else "it is undefined there.")
    return sentence

# ---------------------------------------------------------------- maps of two parameters

def curve(f):
    """A polynomial in the variables 2 and 3, x and y, as coefficients in y which are lists of coefficients in x."""
    return [c.listed(2) for c in f.coefficients(3)]

def at_x(f, x):
    """A curve over a rational x, in y; times a positive number."""
    longest = max(map(len, f))
    return [value([*c, *[0] * (longest - len(c))], x) for c in f]

def at_y(f, y):
    """A curve at a rational y, in x; times a positive number."""
    longest = max(map(len, f))
    return trimmed([value([c[k] if k < len(c) else 0 for c in f], y) for k in range(longest)])

def trimmed(p):
    while p and not p[-1]:
        p.pop()
    return p

def resultant_of_numbers(a, b):
    """Of two polynomials with integer coefficients, by subresultants [BrownTraub1971]."""
    sign = 1
    if len(a) < len(b):
        a, b, sign = b, a, -1 if len(a) % 2 == len(b) % 2 == 0 else 1
    g = h = 1
    while len(b) > 1:
        excess, last = len(a) - len(b), b[-1]
        spend(2 * len(a) * (excess + 1), size(a), size(b))
        if len(a) % 2 == len(b) % 2 == 0:
            sign = -sign
        divisor = g * h ** excess
        while len(a) >= len(b):  # the remainder of last^(excess + 1) a
            top, shift = a[-1], len(a) - len(b)
            a = [last * c for c in a[:shift]] + [last * c - top * d for c, d in zip(a[shift:], b[:-1])]
        a, b = b, [c // divisor for c in trimmed(a)]
        if not b:
            return 0
        g = last
        h = g ** excess // h ** (excess - 1) if excess else h
    n = len(a) - 1
    return sign * (b[0] ** n // h ** (n - 1) if n else h)

def resultant(f, g):
    """The resultant in y of two curves, in x, by its values at more integers than its degree."""
    m, n = len(f) - 1, len(g) - 1
    degrees = [[(k, len(c) - 1) for k, c in enumerate(p) if c] for p in (f, g)]
    steepest = max(d for p in degrees for _, d in p)
    bound = min(n * max(d + l * k for k, d in degrees[0]) + m * max(d + l * k for k, d in degrees[1]) - l * m * n
                for l in range(-steepest, steepest + 1))
    need(bound <= MAX_DEGREE, "a resultant has too high a degree")
    nodes, values, x = [], [], 0
    while len(nodes) <= bound:
        a, b = ([value(c, x) for c in p] for p in (f, g))
        if a[-1] and b[-1]:
            nodes.append(x)
            values.append(resultant_of_numbers(a, b))
        x = -x if x > 0 else 1 - x
    return trimmed(interpolated(values, nodes))

def isolated(json_list, f, low, high):
    """The places of the roots of a polynomial in the open interval, as pairs of ends, equal at a rational root."""
    need(f, "roots: a polynomial is zero everywhere")
    found, before = [], low

    def gap(after):
        if before is not None and before == after:
            need(value(f, after), "roots: not in order")
        else:
            need(before is None or after is None or before < after, "roots: not in order")
            need(descartes(f, before, after) == 0, "roots: a gap is not shown to have none")

    need(isinstance(json_list, list), "roots: not a list")
    for item in json_list:
        ends = items(item, rational) if isinstance(item, list) else [rational(item)]
        need(len(ends) in (1, 2), "roots: an item has more than two numbers")
        gap(ends[0])
        if isinstance(item, list):
            if len(ends) == 1:
                need(not value(f, ends[0]), "roots: a number is none")
            else:
                need(ends[0] < ends[1] and value(f, ends[0]) and value(f, ends[1]), "roots: a root at an end of an enclosure")
                need(descartes(f, *ends) == 1, "roots: an enclosure is not shown to hold just one")
            found.append((ends[0], ends[-1]))
        else:
            need(value(f, ends[0]), "roots: a gap is split at one")
        before = ends[-1]
    gap(high)
    return found

def merged(lists):
    """The places of the roots of several polynomials, which are different."""
    places = sorted(place for one in lists for place in one)
    for (a, b), (c, d) in zip(places, places[1:]):
        need(b < c or b == c and not a == b == d, "roots: two are not shown to be different")
    return places

def in_stretch(x, places, k, low, high):
    """Whether x is behind k of the places, before the next one, and in the interval."""
    before = places[k - 1] if k else None
    after = places[k] if k < len(places) else None
    return (k <= len(places) and (low is None or low < x) and (high is None or x < high)
            and (before is None or before[1] < x or before[0] < before[1] == x)
            and (after is None or x < after[0] or x == after[0] < after[1]))

def check_map(model, document, statement, values, discrete, extent):
    names = ["schema", "statement", "characteristic", "boundary", "factors", "x_factors", "strips", "joins"]
    _, _, given, boundary, factors, x_factors, strips, joins = parts(document, names, ["model"])
    *_, x, y, domain, regions = parts(statement, ["kind", "time", "set", "region", "x", "y", "domain", "regions"])
    need(extent != "parameter", "the region has no parameter here")
    names = [name_of(x), name_of(y)]
    domain = [[None if b is None else rational(b) for b in parts(ends, ["lower", "upper"])] for ends in parts(domain, ["x", "y"])]
    need(all(None in ends or ends[0] < ends[1] for ends in domain), "the domain is empty")
    regions = items(regions, lambda cells: items(cells, lambda cell: tuple(items(cell, count))))
    need(all(len(cell) == 2 for cells in regions for cell in cells), "a cell is not a pair")
    (left, right), (low, high) = domain
    is_discrete, own, divisors, doubled = over_box(model, names, values)
    need(is_discrete == discrete, "the model's time is another")
    ring = Exact(boxed(2))
    given, nothing = items(given, ring.read), not all(map(any, divisors))
    if not (nothing and not given):
        own = in_region(own, discrete, extent)
        need(any(own) or given == own, "characteristic: not that of the model")
    common = beside(given, own, doubled) if given and any(own) else ONE
    certain, identity, nowhere = boundaries(given, len(given or own) - 1, discrete, [ZERO] * nothing, boundary, ring)
    sentence = f"For all real {ranged(names[0], left, right)} and {ranged(names[1], low, high)}{and_with(values)}, the loop is stable"
    sentence += within(discrete, extent)
    if nowhere:
        need(factors == x_factors == strips == joins == regions == [], "the loop is stable nowhere")
        return sentence + " nowhere off its boundary curves."
    factors = [f.primitive() for f in items(factors, ring.read)]
    need(all(map(any, factors)), "factors: one is constant")
    for ways in divisors + [[p] for p in (common, *certain, *([identity["value"]] if identity else []))]:
        need(any(InBox(2).vanishes_only_with(way, factors) for way in ways), "factors: a boundary polynomial is not a product of them")
    curves = [curve(f) for f in factors]
    with_y = [f for f in curves if len(f) > 1]
    # The values of x where curves may meet, turn, leave or end.
    found, known = [], []
    for p, own_roots in items(x_factors, lambda item: parts(item, ["polynomial", "roots"])):
        p = polynomial(p)
        need(p.degree(1), "x_factors: one is constant")
        known.append(p.primitive())
        found.append(isolated(own_roots, p.listed(1), left, right))
    walls = merged(found)
    critical = [f[-1] for f in curves]
    for i, f in enumerate(with_y):
        if len(f) > 2:
            critical.append(resultant(f, [[k * c for c in row] for k, row in enumerate(f)][1:]))
        critical += [p for p in (at_y(f, e) for e in (low, high) if e is not None) if p]
        critical += [resultant(f, g) for g in with_y[:i]]
    for p in critical:
        p = P.of(p, 1).primitive()
        for f in known:
            while p.degree(1) and (quotient := p / f) is not None:
                p = quotient
        need(p and not any(p), "x_factors: a polynomial is not a product of them")
    # The strips between them.
    need(isinstance(strips, list) and len(strips) == len(walls) + 1, "strips: not one between two walls")

    def branches(own_roots, x, high):
        need(isinstance(own_roots, list) and len(own_roots) == len(with_y), "strips: not one list of roots for each curve")
        return [isolated(one, at_x(f, x), low, high) for one, f in zip(own_roots, with_y)]

    stable = set()
    for i, (x, own_roots, cells) in enumerate(parts(strip, ["x", "roots", "cells"]) for strip in strips):
        x, cells = rational(x), items(cells, rational)
        need(in_stretch(x, walls, i, left, right), "strips: the sample is outside")
        places_in_y = merged(branches(own_roots, x, high))
        need(len(cells) == len(places_in_y) + 1, "strips: not one cell between two branches")
        for k, y in enumerate(cells):
            need(in_stretch(y, places_in_y, k, low, high), "strips: the point of a cell is outside")
            d = at_point(given, [x, y])
            need(len(d) == len(given), "strips: the point of a cell loses degree")
            if places(d, discrete)[0] == len(d) - 1:
                stable.add((i, k))
    listed_cells = [cell for cells in regions for cell in cells]
    need(all(regions) and len(listed_cells) == len(stable) and set(listed_cells) == stable, "stable: the regions are not the stable cells")
    # What joins the cells of a region.
    region_of = {cell: {cell} for cell in stable}
    number_of = {cell: i for i, cells in enumerate(regions) for cell in cells}
    for i, x, y, below, clear in items(joins, lambda item: parts(item, ["strip", "x", "y", "below", "clear"])):
        (a, b), y, sides = items(x, rational), rational(y), items(below, list)
        need(in_stretch(y, [], 0, low, high) and len(sides) == 2 and len(clear) == len(curves), "joins: a part is wrong")
        cells = []
        for i, x, side in ((count(i), a, sides[0]), (i + 1, b, sides[1])):
            need(in_stretch(x, walls, i, left, right), "joins: an end is not in its strip")
            cells.append((i, sum(map(len, branches(side, x, y)))))
        for splits, f in zip(clear, curves):
            along = at_y(f, y)
            need(isolated(splits, along, a, b) == [] and value(along, a) and value(along, b), "joins: the segment meets a curve")
        need(all(cell in stable for cell in cells) and number_of[cells[0]] == number_of[cells[1]], "joins: not between cells of one region")
        both = region_of[cells[0]] | region_of[cells[1]]
        region_of |= dict.fromkeys(both, both)
    need(all(region_of[cells[0]] == set(cells) for cells in regions), "joins: the cells of a region are not all joined")
    if not regions:
        return sentence + " nowhere off its boundary curves."

    def wall(k, outer, infinite):
        if not 0 <= k < len(walls):
            return infinite if outer is None else exact(outer)
        a, b = walls[k]
        return exact(a) if a == b else "[a number between {} and {}]".format(*outward(a, b))

    def plural(count, word):
        return f"{count} {word}{'s' * (count != 1)}"

    sentence += f", off its boundary curves and {plural(len(walls), 'line')} of constant {names[0]}, exactly in "
    parted = []
    for cells in regions:
        first, last = min(cells)[0], max(cells)[0]
        ends = wall(first - 1, left, "-infinity"), wall(last, right, "infinity")
        parted.append("{} for {} from {} to {}".format(plural(len(cells), "cell"), names[0], *ends))
    return f"{sentence}{plural(len(regions), 'connected region')}: {'; '.join(parted)}."

# ---------------------------------------------------------------- maps by boxes

class TooWide(Rejected):
    """A series does not reach over a box: nothing is shown of it."""

    def __str__(self):
        return "a function is not known over the whole of a box"

def of_degree(degree, names):
    """The exponents of the monomials in so many names, falling powers of the first name first."""
    if names < 2:
        return [(degree,) * names] if names or not degree else []
    return [(k, *rest) for k in range(degree, -1, -1) for rest in of_degree(degree - k, names - 1)]

class Models:
    """Functions of coordinates from -1 to 1, one for each name, as pairs: coefficients of a polynomial up to a total degree, by degree, then by
    falling powers of the first coordinate, in units of 2^-bits; and a bound of what is left out."""

    def __init__(self, order, bits, names=2):
        self.order, self.bits, self.one, self.names = order, bits, 1 << bits, names
        spend(2 * comb(2 * names + order, order))
        levels = [of_degree(d, names) for d in range(order + 1)]
        self.exponents = sum(levels, [])
        at = {e: k for k, e in enumerate(self.exponents)}
        # Where the products of a coefficient with the first others are that are not of too high a degree.
        below = list(accumulate(map(len, levels)))
        self.places = [[at[tuple(map(int.__add__, e, other))] for other in self.exponents[:below[order - sum(e)]]] for e in self.exponents]
        self.degrees = [slice(end - len(level), end) for end, level in zip(below, levels)]
        self.at, self.ways = at, {}
        self.most = sum(map(len, self.places)) if names > 2 else len(at) ** 2  # products of two coefficients

    def way(self, axis, shift):
        """((u + shift)/2)^n in units of 2^-order."""
        if (axis, shift) not in self.ways:
            self.ways[axis, shift] = [[(self.at[(*e[:axis], k, *e[axis + 1:])], comb(e[axis], k) * shift ** (e[axis] - k)
                                        << self.order - e[axis]) for k in range(e[axis] + 1)] for e in self.exponents]
        return self.ways[axis, shift]

    def units(self, c, rest=0):
        return [c, *[0] * (len(self.exponents) - 1)], rest

    def number(self, q):
        c, over = divmod(q.numerator << self.bits, q.denominator)
        return self.units(c, int(over > 0))

    def coordinate(self, low, high, axis):
        (c, rest), (half, more) = self.number((low + high) / 2), self.number((high - low) / 2)
        c[1 + axis] = half[0]
        return c, rest + more

    def times(self, f, g):
        (a, r), (b, s) = f, g
        pairs = min((len(a) - a.count(0)) * (len(b) - b.count(0)), self.most)
        spend(3 + len(a) // 4 + pairs // 2 + pairs * (self.bits ** 2 // 1000) // 500)
        longest = [max(size(c), bound.bit_length()) for c, bound in (f, g)]  # exponentials grow far beyond one
        if max(longest) > 4 * self.bits:
            spend(pairs, *longest)
        full = [0] * len(a)
        for x, places in zip(a, self.places):
            if x:
                for y, place in zip(b, places):
                    if y:
                        full[place] += x * y
        own, others = ([sum(map(abs, c[part])) for part in self.degrees] for c in (a, b))
        left = sum(x * sum(others[self.order + 1 - d:]) for d, x in enumerate(own) if x)
        left += sum(own) * s + (sum(others) + s) * r
        return [c >> self.bits for c in full], -(-left >> self.bits) + len(full)

    def quotient(self, f, g):
        return self.times(f, self.inverse(g))

    def relative(self, f):
        """f = c (1 + y) with the constant c: 1/c, y, and a bound of |y|^(order + 1) + |y|^(order + 2) + ..., |y| at most 1/2."""
        c = f[0][0]
        if 2 * beside_constant(f) > abs(c) or not c:
            raise TooWide
        reciprocal = self.units((1 << 2 * self.bits) // c, 1)
        y = self.times(([0, *f[0][1:]], f[1]), reciprocal)
        bound, ratio = 2 * self.one, min(abs(y[0][0]) + beside_constant(y), self.one >> 1)
        for _ in range(self.order + 1):
            bound = -(-bound * ratio >> self.bits)
        return reciprocal, y, bound

    def inverse(self, f):
        reciprocal, y, bound = self.relative(f)
        total = one = self.units(self.one)
        for _ in range(self.order):
            total = summed(one, self.times(total, y), -1)
        return self.times((total[0], total[1] + bound), reciprocal)

    def root(self, f):
        _, y, bound = self.relative(f)
        if f[0][0] <= 0:
            raise TooWide
        total = one = self.units(self.one)
        for k in range(self.order - 1, -1, -1):  # the coefficients of (1 + y)^(1/2), none above one
            total = summed(one, divided_by(multiplied(self.times(total, y), 1 - 2 * k), 2 * k + 2))
        return self.times((total[0], total[1] + bound), self.units(isqrt(f[0][0] << self.bits), 1))

    def halves(self, f, axis):
        spend(len(f[0]), self.bits)
        out = []
        for shift in (-1, 1):
            c = [0] * len(f[0])
            for x, ways in zip(f[0], self.way(axis, shift)):
                if x:
                    for place, way in ways:
                        c[place] += x * way
            out.append(([x >> self.order for x in c], f[1] + len(c)))
        return out

    def pi(self):
        def inverse_of_tangent(n):
            power, total, k = (1 << self.bits + 64) // n, 0, 1
            while power:
                total, power, k = total + (power // k if k % 4 == 1 else -(power // k)), power // (n * n), k + 2
            return total
        return self.units(16 * inverse_of_tangent(5) - 4 * inverse_of_tangent(239) >> 64, 2)  # Machin

    def product(self, m, k):
        def entry(row, column):
            total = self.units(0)
            for f, g in zip(row, column):
                if any(f[0]) or f[1]:
                    total = summed(total, self.times(f, g))
            return total
        return [[entry(row, column) for column in zip(*k)] for row in m]

    def exponentials(self, m):
        """The sums of M^k/k!, M^k/(k + 1)!, M^k/(k + 2)!: of M/2^s, with rows of at most 2^-8, doubled s times."""
        n = range(len(m))
        hold(8 * len(m) ** 2 * len(self.exponents), 0)
        norm, s = max((sum(abs(f[0][0]) + beside_constant(f) for f in row) for row in m), default=0), 0
        while norm >> s >= self.one >> 8:
            s += 1
            if s > 64:
                raise TooWide
        m = [[halved(f, s) for f in row] for row in m]
        term = [[self.units(self.one if i == j else 0) for j in n] for i in n]
        sums, k, bound = [term, term, each(lambda f: divided_by(f, 2), term)], 0, 1
        while bound <= self.one:
            k, bound = k + 1, bound * (k + 1) << 8
            term = each(lambda f: divided_by(f, k), self.product(term, m))
            for i, divisor in enumerate((1, k + 1, (k + 1) * (k + 2))):
                sums[i] = each(summed, sums[i], each(lambda f: divided_by(f, divisor), term))
        whole, first, second = (each(lambda f: (f[0], f[1] + 2), total) for total in sums)  # what is left out is below a unit
        for _ in range(s):
            second = each(lambda f: halved(f, 2), each(summed, each(summed, second, first), self.product(whole, second)))
            first = each(lambda f: halved(f, 1), each(summed, first, self.product(whole, first)))
            whole = self.product(whole, whole)
        return whole, first, second

    def turned(self, f):
        return self.exponentials([[self.units(0), f], [multiplied(f, -1), self.units(0)]])[0][0]

def beside_constant(f):
    """A bound of what is beside the constant."""
    return sum(map(abs, f[0][1:])) + f[1]

def summed(f, g, factor=1):
    return [x + factor * y for x, y in zip(f[0], g[0])], f[1] + abs(factor) * g[1]

def multiplied(f, k):
    return [x * k for x in f[0]], f[1] * abs(k)

def divided_by(f, k):
    return [x // k for x in f[0]], -(-f[1] // k) + len(f[0])

def halved(f, times):
    return [x >> times for x in f[0]], -(-f[1] >> times) + len(f[0])

def sign_of(f):
    """At every point of the box, or 0."""
    c = f[0][0]
    return 0 if abs(c) <= beside_constant(f) else 1 if c > 0 else -1

def each(function, *matrices):
    return [[function(*entries) for entries in zip(*rows)] for rows in zip(*matrices)]

class Moving:
    """Functions in expressions and matrices behind holds, as variables behind the parameters of a box."""

    def __init__(self, first=0):
        self.next, self.known, self.sources, self.is_continuous = first, [], [], False
        self.functions = {name: lambda f, name=name: self.variable(name, self.argument(f)) for name in ("sqrt", "exp", "sin", "cos", "tan")}
        self.functions["exp"], self.has_lead_last = self.exponential, False

    @staticmethod
    def argument(f):
        real(without_variable(f))
        return f.scalar(), f.bottom

    def rotation(self, angle):
        """exp(j angle)"""
        cosine, sine = (self.variable(name, self.argument(angle)) for name in ("cos", "sin"))
        return cosine + sine * scalar(P({UNIT: 1}))

    def exponential(self, f):
        """Of s times a dead time, or of something without the loop's variable."""
        if not f.is_real() and not f.scalar().degree(0) and not f.bottom.degree(0):
            x, y = f.parts()
            turn = self.rotation(y) if y.scalar() else scalar(ONE)
            return self.variable("exp", self.argument(x)) * turn if x.scalar() else turn
        powers = real(f).scalar().coefficients(0)
        if len(powers) == 2 and not powers[0] and not f.bottom.degree(0) and self.is_continuous:
            return self.delayed(Value({"": -powers[1]}, f.bottom))
        return self.variable("exp", self.argument(f))

    def delayed(self, time):
        """exp(-T s)"""
        need(time.number() is None or time.number() >= 0, "a negative dead time")
        return self.variable("delay", self.argument(time))

    def variables(self, source, count):
        for known, first in self.known:
            if known == source:
                return first
        allow(self.next + count <= MAX_VARIABLES, "the model has too many functions")
        self.known.append((source, self.next))
        self.next += count
        return self.next - count

    def variable(self, name, argument=None):
        return scalar(P({1 << FIELD * self.variables((name, argument), 1): 1}))

    def prewarped(self, w, time):
        return scalar(P({1 << FIELD * self.variables(("prewarp", self.argument(w), self.argument(time)), 1): 1}))

    def held(self, a, first_order, time, ratio, loop):
        """The state matrix, and how inputs enter: their age, matrix, and the share that passes on at once."""
        samples, share = int(ratio // 1), ratio % 1
        need(samples <= MAX_ORDER, "a dead time has too many samples")
        count, n = 2 + first_order + bool(share), len(a)
        source = "hold", [[self.argument(f) for f in row] for row in a], self.argument(time), share, first_order
        first = self.variables(source, count * n * n)
        state, now, *others = ([[P({1 << FIELD * (first + (k * n + i) * n + j): 1}) for j in range(n)] for i in range(n)]
                               for k in range(count))
        enters = [(samples, now, Fraction(1) if not share else 1 - share if first_order else Fraction(0))]
        if first_order:
            enters.append((samples - 1, others[0], Fraction(0)))
        if share:
            enters.append((samples + 1, others[-1], share if first_order else Fraction(1)))
        return state, enters, ONE, samples + bool(share)

    @staticmethod
    def placed(edge, hold):
        """How many samples an edge stands behind what commands it, and the rest of its period."""
        ratio, at = hold[2], edge.number()
        if at is None:  # within the period, as long as the duty ratio is between 0 and 1
            need(ratio.denominator == 1, "an edge of a pulse may pass a sample")
            at, rest = ratio, of_number(Fraction(1)) + -edge
        else:
            at, rest = ratio + at, 1 - (ratio + at) % 1
        need(at // 1 <= MAX_ORDER, "a dead time has too many samples")
        return int(at // 1), rest

    def flow(self, a, time, rest, duty, loop):
        """exp(A r T) for the rest of a period behind an edge, where the duty ratio is between 0 and 1."""
        rest = of_number(Fraction(1) if rest is None else rest) if rest is None or isinstance(rest, Fraction) else rest
        duty = duty or of_number(Fraction(1, 2))
        n = len(a)
        source = "flow", [[self.argument(f) for f in row] for row in a], *map(self.argument, (time, rest, duty))
        first = self.variables(source, n * n)
        return [[P({1 << FIELD * (first + i * n + j): 1}) for j in range(n)] for i in range(n)], ONE

    def given(self, values):
        """With the values of the parameters that have one."""
        def quotient(f):
            return f and cleared([p.at(values) for p in f])
        for (name, *of), _ in self.known:
            if name == "flow":
                of = [[quotient(f) for f in row] for row in of[0]], *map(quotient, of[1:])
            elif name == "hold":
                of = [[quotient(f) for f in row] for row in of[0]], quotient(of[1]), *of[2:]
            else:
                of = map(quotient, of)
            self.sources.append((name, *of))

    def values(self, parameters, models):
        known = parameters[:]

        def over(quotient):
            top, bottom = (self.at(p, known, models) for p in quotient)
            return models.quotient(top, bottom)

        for name, *of in self.sources:
            if name == "numbers":  # known by enclosures only
                known += [models.units(*f) for f in of[0]]
                continue
            if name == "hold":
                a, time, share, first_order = of
                known += self.matrices([[over(f) for f in row] for row in a], over(time), share, first_order, models)
                continue
            if name == "flow":
                time, rest, duty = map(over, of[1:])
                if min(sign_of(time), sign_of(duty), sign_of(summed(models.units(models.one), duty, -1))) <= 0:
                    raise TooWide
                span = models.times(time, rest)
                whole = models.exponentials([[models.times(over(f), span) for f in row] for row in of[0]])[0]
                known += [f for row in whole for f in row]
                continue
            f, *others = (over(f) if f else None for f in of)
            if name == "prewarp":
                known.append(self.factor(f, *others, models))
                continue
            if name == "delay":  # no number: polynomials are sorted by it before they have values
                known.append(models.units(0))
                continue
            if name == "pi":
                known.append(models.pi())
            elif name == "sqrt":
                known.append(models.root(f))
            elif name == "exp":
                known.append(models.exponentials([[f]])[0][0][0])
            else:
                cosine, sine = models.turned(f)
                known.append(cosine if name == "cos" else sine if name == "sin" else models.quotient(sine, cosine))
        return known

    @staticmethod
    def at(p, known, models):
        total = models.units(0)
        for e, c in p.items():
            term, e = models.units(models.one), e >> 2 * FIELD
            for f in known:
                for _ in range(e & MASK):
                    term = models.times(term, f)
                e >>= FIELD
            total = summed(total, term, c)
        return total

    @staticmethod
    def factor(w, time, models):
        """w cos(w T/2)/sin(w T/2), for an angle w T between 0 and pi."""
        angle = models.times(w, time)
        if min(sign_of(w), sign_of(time), sign_of(summed(models.pi(), angle, -1))) <= 0:
            raise TooWide
        cosine, sine = models.turned(halved(angle, 1))
        return models.quotient(models.times(w, cosine), sine)

    @staticmethod
    def matrices(a, time, share, first_order, models):
        """The entries of F = exp(A T), of what enters now, late and early; G is the integral of exp(A t), H that one's over T."""
        if sign_of(time) <= 0:
            raise TooWide
        product = models.product

        def by(q, m):
            return each(lambda f: divided_by(multiplied(f, q.numerator), q.denominator), m)

        def over(part):
            span = divided_by(multiplied(time, part.numerator), part.denominator)
            whole, first, second = models.exponentials(each(lambda f: models.times(f, span), a))
            first, second = (each(lambda f: models.times(f, span), m) for m in (first, second))
            return whole, first, by(part, second)

        s0, s1, s2 = over(1 - share)
        r0, r1, r2 = over(share) if share else (None, None, None)
        out = [product(s0, r0) if share else s0]
        if not first_order:
            out += [s1, product(s0, r1)] if share else [s1]
        else:
            now = each(lambda f, g: summed(f, g, -1), s1, s2)
            if share:
                now = each(summed, product(s0, each(summed, by(1 - share, r1), r2)), now)
            out += [now, s2]
            out += [product(s0, each(lambda f, g: summed(f, g, -1), by(share, r1), r2))] if share else []
        return [f for m in out for row in m for f in row]

class OverBoxes:
    """Polynomials in the names of a box and what depends on them, over boxes."""

    def __init__(self, polynomials, sources, models):
        self.sources, self.models, self.monomials, self.powers = sources, models, {}, {}
        self.rows = []
        for p in polynomials:
            row = {}
            for e, c in p.items():
                power, monomial = e >> 2 * FIELD & (1 << models.names * FIELD) - 1, e >> (2 + models.names) * FIELD
                row.setdefault(self.monomials.setdefault(monomial, len(self.monomials)), []).append(
                    (self.powers.setdefault(power, len(self.powers)), c))
            self.rows.append(row)

    def allow_to_compute(self):
        hold((len(self.powers) + len(self.monomials) + len(self.rows)) * len(self.models.exponents), self.models.bits)

    def at(self, sides):
        """The functions, None where a series does not reach over the box."""
        models = self.models
        try:
            values = self.sources.values([models.coordinate(*side, axis) for axis, side in enumerate(sides)], models)
        except TooWide:
            return None
        tables = [[models.units(models.one)] for _ in values]

        def product(e, first):
            out = None
            while e:
                k, table = e & MASK, tables[first]
                while len(table) <= k:
                    table.append(models.times(table[-1], values[first]))
                if k:
                    out = models.times(out, table[k]) if out else table[k]
                e, first = e >> FIELD, first + 1
            return out

        powers = [product(e, 0) or models.units(models.one) for e in self.powers]
        monomials = [product(e, models.names) for e in self.monomials]
        found = []
        for row in self.rows:
            total = models.units(0)
            for k, terms in row.items():
                spend(len(terms) * len(total[0]) // 10, size(c for _, c in terms), models.bits)
                coefficients, rest = [0] * len(total[0]), 0
                for power, c in terms:
                    f, bound = powers[power]
                    rest += abs(c) * bound
                    coefficients = [x + c * y if y else x for x, y in zip(coefficients, f)]
                factor = coefficients, rest
                total = summed(total, models.times(factor, monomials[k]) if monomials[k] else factor)
            found.append(total)
        return found

class InParts:
    """Functions over boxes, first the real and the imaginary parts of n + 1 coefficients, which come out as those of the polynomial times its
    conjugate: it is real, and has each root and its conjugate."""

    def __init__(self, functions, n):
        self.functions, self.n = functions, n
        self.allow_to_compute = functions.allow_to_compute

    def at(self, sides):
        found, n, models = self.functions.at(sides), self.n, self.functions.models
        if not found:
            return None
        more = models.bits - max(size([abs(f[0][0]) + beside_constant(f)]) for f in found[:2 * n + 2])
        parts = [multiplied(f, 1 << max(more, 0)) for f in found[:2 * n + 2]]  # squares of small numbers have few digits
        product = [models.units(0)] * (2 * n + 1)
        for part in (parts[:n + 1], parts[n + 1:]):
            part = [(k, f) for k, f in enumerate(part) if any(f[0]) or f[1]]
            for i, (j, f) in enumerate(part):
                for k, g in part[i:]:
                    product[j + k] = summed(product[j + k], models.times(f, g), 1 if j == k else 2)
        return product + found[2 * n + 2:]

AXES = (1, 0), (0, 1), (-1, 0), (0, -1)  # directions, by quarters of a turn

def quarter_of(x, y):
    """The number of the quarter a direction is in, which begins with an axis."""
    return 0 if x > 0 <= y else 1 if x <= 0 < y else 2 if x < 0 else 3

def turn(d, to):
    """How many quarters further another direction is, by less than half a turn; None if that is opposite."""
    quarters, side = quarter_of(*to) - quarter_of(*d), d[0] * to[1] - d[1] * to[0]
    if side == 0:
        return 0 if d[0] * to[0] + d[1] * to[1] > 0 else None
    return quarters % 4 if side > 0 else -(-quarters % 4)

def across(x, y, side):
    """Across a vector, on the side where another one is, in short numbers."""
    long = max(size([x, y]) - 12, 0)
    x, y = x >> long, y >> long
    return () if x == y == 0 else ((-y, x),) if side[1] * x > side[0] * y else ((y, -x),)

def holds(d, e, o):
    """Whether the values of a pair, given by coefficients, are in the half plane around a direction."""
    if 0 in d:
        return all(sign_of(f) == (1 if sum(d) > 0 else -1) for f in (o if d[0] == 0 else e))
    return all(sign_of(summed(multiplied(f, d[0]), g, d[1])) > 0 for f, g in zip(e, o))

def half_plane(last, e, o, names):
    """One that all values are in: around an axis, or across the ways on which they change most; None if that is not found."""
    k = len(e) // 2
    for d in (*last, *AXES):
        if holds(d, e, o):
            return d
    ways = [(e[k][0][i], o[k][0][i]) for i in range(1, names + 1)] + [[c[-1][0][0] - c[0][0][0] for c in (e, o)]]
    return next((d for x, y in ways for d in across(x, y, (e[k][0][0], o[k][0][0])) if holds(d, e, o)), None)

def roots_to_the_right(p, models):
    """Of p_0 + p_1 s + ..., none on the axis and the degree not lost, at every point of a box; None where that is not shown.

    The vector (E, O), p(i w) = E(w^2) + i w O(w^2), is kept within half planes along parts of the axis."""
    n, k = len(p) - 1, (len(p) - 1) // 2
    first, last = sign_of(p[0]), sign_of(p[n])
    if not first or not last:
        return None
    w, ways = size_of_roots(p), [comb(k, j) for j in range(k + 1)]
    common, pair = lcm(*ways), [[], []]
    for odd in (0, 1):  # Bernstein coefficients of (1 - t)^k E(v) and 2^w (1 - t)^k O(v), v = 4^w t/(1 - t)
        for j in range(k + 1):
            shift = w * (2 * j + odd) if w >= 0 else -w * (2 * (k - j) + 1 - odd)
            c = p[2 * j + odd] if 2 * j + odd <= n else models.units(0)
            pair[odd].append(multiplied(c, (-1) ** j * (common // ways[j]) << shift))
    extra = max(size([abs(c[0][0]) + beside_constant(c)]) for part in pair for c in part) - models.bits
    if extra > 0:
        pair = [[halved(c, extra) for c in part] for part in pair]

    direction, turns, todo, seen = AXES[0 if first > 0 else 2], 0, [(*pair, 0)], 0
    while todo:
        e, o, halvings = todo.pop()
        seen += 1
        spend(8 * (n + 1), models.bits)
        found = half_plane([direction], e, o, models.names)
        if found and turn(direction, found) is not None:
            turns, direction = turns + turn(direction, found), found
            continue
        # Where not even one point of the axis is told from a root there is nothing to halve for.
        if not all(half_plane([], [e[i]], [o[i]], models.names) for i in (0, -1)) or halvings >= 64 or seen >= 2000:
            return None
        spend((k + 1) ** 2 * len(e[0][0]) // 4, models.bits)
        lower, upper = [], []
        for level in (e, o):
            low, high = [], []
            while level:
                low.append(level[0])
                high.append(level[-1])
                level = [halved(summed(f, g), 1) for f, g in zip(level, level[1:])]
            lower.append(low)
            upper.append(high[::-1])
        todo += [(*upper, halvings + 1), (*lower, halvings + 1)]
    step = turn(direction, AXES[(n + (0 if last > 0 else 2)) % 4])
    if step is None or (n - turns - step) % 2 or n < turns + step:
        return None
    return (n - turns - step) // 2

def size_of_roots(p):
    """The exponent of a power of two."""
    return (size(p[0][0][:1]) - size(p[-1][0][:1])) // (len(p) - 1) if len(p) > 1 else 0

def moved(p, e):
    """p(s + 2^e), times a positive number."""
    n = len(p) - 1
    p = [multiplied(c, 1 << (e * k if e >= 0 else -e * (n - k))) for k, c in enumerate(p)]
    for i in range(n):
        for j in range(n - 1, i - 1, -1):
            p[j] = summed(p[j], p[j + 1])
    return p

PRIME, POINTS = (1 << 31) - 1, (1_000_003, 7_654_321)

def image(p, v, point):
    """The coefficients of the powers of a variable modulo a prime, the others at values of their own."""
    spend(10 * len(p), size(p.values()))
    out = [0] * (p.degree(v) + 1)
    for e, c in p.items():
        k, u, e = e >> FIELD * v & MASK, 0, e & ~(MASK << FIELD * v)
        while e:
            c, e, u = c * pow(point + u, e & MASK, PRIME) % PRIME, e >> FIELD, u + 1
        out[k] = (out[k] + c) % PRIME
    return trimmed(out)

def common_image(a, b):
    """Euclid's algorithm modulo the prime."""
    while b:
        inverse = pow(b[-1], -1, PRIME)
        spend(3 * len(a) * len(b))
        while len(a) >= len(b):
            shift, factor = len(a) - len(b), a[-1] * inverse
            a = trimmed([*a[:shift], *((x - factor * y) % PRIME for x, y in zip(a[shift:], b))])
        a, b = b, a
    return a

def in_common(polynomials, above):
    """A greatest common divisor in variables from 2 on and below a bound. In most it has none, as images in one variable show."""
    some = [p.primitive() for p in polynomials if p]
    top = max((max(*p, 0).bit_length() + FIELD - 1) // FIELD for p in some) if some else 0
    suspects = 0
    for v in range(2, min(top, above)):
        if all(p.degree(v) for p in some) and any(len(reduce(common_image, (image(p, v, x) for p in some))) > 1 for x in POINTS):
            suspects |= MASK << FIELD * v
    if not suspects:
        return ONE
    parts = []
    for p in some:  # the coefficients of all monomials in the other variables
        of_rest = {}
        for e, c in p.items():
            of_rest.setdefault(e & ~suspects, P())[e & suspects] = c
        parts += of_rest.values()
    found = ZERO
    for part in sorted(parts, key=len):
        found = found.common(part)
        if not any(found):
            return ONE
    return found

def separated(lists, positive):
    """Divides out of each list the factors that other lists hold, and what is positive: the signs of factors are easier to prove than that of their
    product. In no list may all polynomials vanish together."""
    def divided_by(list_, f):
        while any(list_) and not any(p and not any(p) for p in list_):
            quotients = [p / f if p else p for p in list_]
            if None in quotients:
                break
            list_ = quotients
        return list_

    def degree(p):
        return max(sum(e >> FIELD * v & MASK for v in range(e.bit_length() // FIELD + 1)) for e in p)

    known = list(positive)
    for p in sorted((ways[0].primitive() for ways in lists if len(ways) == 1 and ways[0]), key=degree):
        for v in range(2, max(p).bit_length() // FIELD + 1):
            variable = P({1 << FIELD * v: 1})
            if variable not in known and all(e >> FIELD * v & MASK for e in p):
                known.append(variable)
        [rest] = reduce(divided_by, known, [p])
        known += [rest] if any(rest) else []
    several = [reduce(divided_by, known, cleared(ways)) for ways in lists if len(ways) != 1 or not ways[0]]
    return [ways for ways in several if not any(p and not any(p) for p in ways)] + [[p] for p in known[len(positive):]]

class Judge:
    """Whether boxes are stable everywhere, or nowhere. What is known of one are the functions over it, and whether they are its own or
    those of a larger one, halved."""

    def __init__(self, functions, n, divisors, models, nowhere):
        self.functions, self.n, self.divisors, self.models, self.nowhere = functions, n, divisors, models, nowhere

    def allow_to_keep(self, boxes):
        functions = 1 + max([self.n, *(place for ways in self.divisors for place in ways)])
        hold(boxes * functions * len(self.models.exponents), 2 * self.models.bits)

    def is_precise(self, known, share):
        return all(f[1] << share <= beside_constant(f) or f[1] < 1 << 7 for f in known[:self.n + 1])

    def halves(self, sides, known, own, axis):
        if not known or not own and not self.is_precise(known, 4):
            known = self.functions.at(sides) or known
        low, high = sides[axis]
        middle, parts = (low + high) / 2, [None, None]
        if known:
            parts = zip(*(self.models.halves(f, axis) for f in known))
        for side, part in zip(([low, middle], [middle, high]), parts):
            yield [side if i == axis else other for i, other in enumerate(sides)], part, False

    def shows(self, sides, known, own, stable):
        if known and self.decides(known, stable):
            return True
        if own or known and self.is_precise(known, 10):
            return False
        known = self.functions.at(sides)
        return bool(known) and self.decides(known, stable)

    def has_root_beyond(self, sides, e):
        """Whether roots are right of the line that 2^e is right of the axis."""
        n, terms, bits = self.n, len(self.models.exponents), self.models.bits + abs(e) * self.n
        hold((n + 1) * terms, bits)
        spend(n * n * terms // 4, bits)
        known = self.functions.at(sides)
        return bool(known) and bool(roots_to_the_right(moved(list(known[:n + 1]), e), self.models))

    def decides(self, known, stable):
        p, models = list(known[:self.n + 1]), self.models
        if stable:
            defined = all(any(sign_of(known[i]) for i in ways) for ways in self.divisors)
            return defined and roots_to_the_right(p, models) == 0
        signs = set(map(sign_of, p))
        if {1, -1} <= signs:
            return True  # with all roots to the left all coefficients have one sign
        w = size_of_roots(p)
        return any(roots_to_the_right(q, models) for q in (p, *(moved(p, w + e) for e in (-3, -1))))

# ---------------------------------------------------------------- maps by boxes of loops with dead time

FREQUENCY_BITS = 64  # frequencies are whole multiples of 2^-64
HEADINGS = [(x * a - y * b, x * b + y * a) for a, b in AXES for x, y in ((17, 0), (15, 8), (12, 12), (8, 15))]  # by sixteenths of a turn
LONGEST = 17  # of a heading

def up(x, bits):
    """x / 2^bits, rounded up."""
    return -(-x >> bits)

def at_most(c, w):
    """A bound of a polynomial without negative coefficients up to a frequency."""
    total = 0
    for x in reversed(c):
        total = -(-total * w >> FREQUENCY_BITS) + x
    return total

def on_axis(c, w):
    """A polynomial at i w."""
    square, out = w * w, []
    for part in (c[::2], c[1::2]):
        total = 0
        for x in reversed(part):
            total = x - (total * square >> 2 * FREQUENCY_BITS)
        out.append(total)
    return out[0], out[1] * w >> FREQUENCY_BITS

def modulus(z):
    """At least: sqrt(a^2 + b^2) <= a + b/2 for a >= b."""
    a, b = abs(z[0]), abs(z[1])
    return a + (b + 1 >> 1) if a >= b else b + (a + 1 >> 1)

def derivative(c):
    return [j * x for j, x in enumerate(c)][1:]

class Turns:
    """Cosine and sine of many angles, off by less than two units of 2^-bits."""

    def __init__(self, bits):
        self.bits, self.quarter, self.known = bits, Models(1, bits + 32).pi()[0][0] >> 1, {}

    def of(self, time, w):
        angle = (time.numerator * w << self.bits + 32) // (time.denominator << FREQUENCY_BITS)
        if angle not in self.known:
            quarters, rest = divmod(angle, self.quarter)
            if quarters >= 1 << 16:
                return None
            bits, sums, k = self.bits + 32, [0, 0], 0
            term = 1 << bits
            while term:
                sums[k % 2] += term if k % 4 < 2 else -term
                k += 1
                term = (term * rest >> bits) // k
            c, s = (x >> 32 for x in sums)
            self.known[angle] = ((c, s), (-s, c), (-c, -s), (s, -c))[quarters % 4]
        return self.known[angle]

class Delayed:
    """A polynomial in s times exp(-tau s), over a box: the coefficients as models, the dead time's middle and changes, none for no delay."""

    def __init__(self, coefficients, delay, models):
        bits = models.bits
        self.about = [[c[0][way] for c in coefficients] for way in range(models.names + 1)]
        moduli = [sum(map(abs, ways)) for ways in zip(*self.about[1:])]
        self.rest = [beside_constant(c) - x + 8 for c, x in zip(coefficients, moduli)]  # and roundings
        self.change = [x + r for x, r in zip(moduli, self.rest)]
        self.derivative = derivative(self.about[0])
        self.first = list(map(abs, self.derivative))
        self.second, self.change_slope = derivative(self.first), derivative(self.change)
        self.delay = delay
        if delay:
            self.middle, *changes = delay
            self.floor, *self.changes = ((q.numerator << bits) // q.denominator for q in delay)
            self.spread = sum(abs(x) + 1 for x in self.changes)

def local(parts, middle, half, turns, bits):
    """The function about the middle of a stretch of the axis and of a box: its value, the changes by half of each side and of the stretch,
    what is off that at most, and the derivative by the frequency with how far it is off."""
    far, one = middle + half, 1 << bits
    above = (far >> FREQUENCY_BITS) + 2
    rest, slope_rest, *totals = 0, 0, *([0, 0] for _ in range(len(parts[0].about) + 1))
    for part in parts:
        p, *ways = (on_axis(c, middle) for c in part.about)
        d = on_axis(part.derivative, middle)
        d = -d[1], d[0]
        change_slope, second = at_most(part.change_slope, far), at_most(part.second, far)
        off = at_most(part.change, far) + up(at_most(part.first, far) * half, FREQUENCY_BITS)
        slope_off = change_slope + up(second * half, FREQUENCY_BITS)
        bent = (at_most(part.rest, far) + up(change_slope * half, FREQUENCY_BITS)
                + up(second * half * half, 2 * FREQUENCY_BITS + 1))
        if not part.delay:
            rest, slope_rest = rest + bent, slope_rest + slope_off
        else:
            p_size, longest = modulus(p), part.floor + 1
            angle = up(far * part.spread, FREQUENCY_BITS) + up(longest * half, FREQUENCY_BITS)
            turn = turns.of(part.middle, middle) if angle < one else None
            if turn is None:  # anything of this size
                rest += p_size + off
                slope_rest += modulus(d) + slope_off + up((longest + part.spread) * (p_size + off), bits)
                continue

            def back(z, by):  # times -i and a number
                return z[1] * by >> bits, -(z[0] * by >> bits)

            changed = []
            for z, time in zip(ways, part.changes):
                more = back(p, middle * time >> FREQUENCY_BITS)
                changed.append((z[0] + more[0], z[1] + more[1]))
            more = back(p, part.floor)
            d = d[0] + more[0], d[1] + more[1]
            d_size = modulus(d)
            rounded = 2 * p_size * above + sum(map(modulus, changed))
            c, s = turn
            p, d, *ways = ((x * c + y * s >> bits, y * c - x * s >> bits) for x, y in (p, d, *changed))
            # exp(-i x) is off 1 - i x by at most x^2/2, and off 1 by at most x.
            square = up(part.spread * half, FREQUENCY_BITS) + up(angle * angle, bits + 1)
            slope_rounded = (p_size + d_size >> bits - 3) + 64
            rest += bent + up(p_size * square + off * angle, bits) + (rounded >> bits - 3) + 64 + up(slope_rounded * half, FREQUENCY_BITS)
            slope_rest += slope_off + up(longest * off + part.spread * (p_size + off) + d_size * angle, bits) + slope_rounded
        for total, z in zip(totals, (p, d, *ways)):
            total[0] += z[0]
            total[1] += z[1]
    value, slope, *ways = totals
    vectors = value, *ways, [x * half >> FREQUENCY_BITS for x in slope]
    far = max(size([*(x for z in vectors for x in z), rest]) - 56, 0)
    own = max(size([*slope, slope_rest]) - 56, 0)
    return [(x >> far, y >> far) for x, y in vectors], (rest >> far) + 8, (slope[0] >> own, slope[1] >> own), (slope_rest >> own) + 4

def clear(found, before=None, margin=None):
    """The first heading about which the function is in the half plane, one before all others; with a margin, a share of the value is left."""
    vectors, rest = found[:2]
    for k in (before, *range(16)) if before is not None else range(16):
        a, b = HEADINGS[k % 16]
        along = a * vectors[0][0] + b * vectors[0][1]
        if along > 0:
            left = along - sum(abs(a * x + b * y) for x, y in vectors[1:]) - LONGEST * rest
            if left > 0 and (margin is None or left << margin > along):
                return k
    return None

def slopes_of(found, margin=None):
    """The headings about which the derivative is in the half plane."""
    (x, y), rest = found[2:]
    out = set()
    for k, (a, b) in enumerate(HEADINGS):
        left = a * x + b * y - LONGEST * rest
        if left > 0 and (margin is None or left << margin > a * x + b * y):
            out.add(k)
    return out

ALL = frozenset(range(16))  # headings

def turn_to(now, k):
    """The way by less than half a turn, None if the other heading is opposite."""
    k = (k - now) % 16
    return None if k == 8 else k if k < 8 else k - 16

def largest_change(now, to, slopes):
    """Of the heading, on a stretch on which the derivative is in these half planes; None if nothing is known."""
    common = None
    for along in slopes:
        before, behind = ([(k - along + 8) % 16 - 8 for k in (now, to)], [(k - along) % 16 for k in (now, to)])
        found = {before[1] - before[0]} if -8 not in before else set()
        found |= {behind[1] - behind[0]} if 0 not in behind else set()
        if behind[0] and before[1] != -8:  # zero is passed on one side or the other
            found |= {before[1] - behind[0], before[1] - behind[0] + 16}
        common = found if common is None else common & found
    return max(common) if common else None

def roots_beside(pieces, n, is_negative):
    """At least so many roots are to the right where none is on the axis, and whether that is their number everywhere; None if unknown.
    Pieces are pairs of headings, on which the function is clear of zero, or a cell and the headings of the derivative."""
    end = (4 * n + 8 * is_negative) % 16
    start = now = slopes = None
    is_exact = True
    for first, last in [*pieces, (end, end)]:
        if isinstance(first, tuple):
            slopes, is_exact = (ALL if slopes is None else slopes) & last, False
            continue
        if now is None and slopes is None:
            if first % 8 == 4:
                return None
            start, now = (first + 4) // 8 * 8, first
        elif now is None:  # the imaginary part grows or falls from zero on
            start, lowest = (0, -3) if 4 in slopes else (-8, -11) if 12 in slopes else (None, None)
            if start is None or (first - lowest) % 16 == 15:
                return None
            now = (first - lowest) % 16 + lowest
        else:
            step = turn_to(now, first) if slopes is None else largest_change(now, first, slopes)
            if step is None:
                return None
            now += step
        now, slopes = now + last - first, None
    eighths = 4 * n - (now - start)
    return None if eighths % 8 else (eighths // 8, is_exact)

class Walk:
    """Along the axis, for a box."""

    def __init__(self, parts, turns, bits, pieces):
        self.parts, self.turns, self.bits, self.looked_at, self.pieces = parts, turns, bits, 0, []
        self.is_whole = True
        for first, last in pieces:
            if not self.is_whole:
                self.pieces.append((first, last))
            elif isinstance(first, tuple):
                self.is_whole = self.over(first)
            elif self.push(first):
                self.pieces[-1] = self.pieces[-1][0], self.pieces[-1][1] + last - first
            else:
                self.is_whole = False

    def push(self, k):
        """A stretch in the half plane about a heading."""
        if not self.pieces or isinstance(self.pieces[-1][0], tuple):
            self.pieces.append((k, k))
            return True
        first, last = self.pieces[-1]
        step = turn_to(last, k)
        if step is not None:
            self.pieces[-1] = first, last + step
        return step is not None

    def local(self, middle, half):
        self.looked_at += 1
        spend(36 + 10 * sum(len(part.rest) for part in self.parts), self.bits, self.bits)
        return local(self.parts, middle, half, self.turns, self.bits)

    def over(self, cell):
        shortest, cells = max(cell[1] - 24, 1), [cell]
        while cells:
            low, length = cells.pop()
            half = 1 << length - 1
            before = self.pieces[-1][1] if self.pieces and not isinstance(self.pieces[-1][0], tuple) else None
            found = self.local(low + half, half)
            k = clear(found, before)
            if k is not None:
                if self.push(k):
                    continue
                self.pieces += [(cell, frozenset()) for cell in ((low, length), *reversed(cells))]
                return False
            slopes = slopes_of(found)
            if length > shortest and self.looked_at < 2000:
                point = self.local(low + half, 0)
                if clear(point, None, 3) is not None or not slopes and slopes_of(point, 3):
                    cells += [(low + half, length - 1), (low, length - 1)]
                    continue
            self.pieces.append(((low, length), slopes))
            common = ALL
            for first, last in reversed(self.pieces):
                if not isinstance(first, tuple):
                    break
                common &= last
            if not common:  # the rest of the way is of no use to this box
                self.pieces += [(cell, frozenset()) for cell in reversed(cells)]
                return False
        return True

def times_range(time, sides):
    """The least and the greatest value of a + b x + c y + ..."""
    ends = [sorted(slope * end for end in side) for slope, side in zip(time[1:], sides)]
    return time[0] + sum(least for least, _ in ends), time[0] + sum(most for _, most in ends)

class JudgeOfDelays:
    """Whether boxes are stable everywhere, or nowhere. What is known of one is the way along the axis."""

    def __init__(self, own, divisors, positive, sources, sides, models):
        need(all(name in ("delay", "pi", *sources.functions) for name, *_ in sources.sources), "beside dead time the loop has other functions")
        n, self.models, names = len(own) - 1, models, models.names
        delays = [(v, *of) for v, (name, *of) in enumerate(sources.sources, 2 + names) if name == "delay"]
        self.times, places = [self.time(*f, names) for _, f in delays], [v for v, _ in delays]
        is_delayed = lambda p: any(p.degree(v) for v in places)
        inside = (p for _, f, *_ in sources.sources for p in f or ())
        need(not any(map(is_delayed, inside)), "a function of the loop's variable")
        self.n, self.turns = n, Turns(models.bits)
        divisors = divisors[:-1] if sources.has_lead_last else divisors  # it is looked at where the highest power is to outweigh the rest
        need(not any(is_delayed(p) for ways in divisors for p in ways), "a divisor depends on the dead time")
        parts = {}
        for j, p in enumerate(cleared(own)):
            for e, c in p.items():
                total = (Fraction(0),) * (names + 1)
                for v, time in zip(places, self.times):
                    k = e >> FIELD * v & MASK
                    total, e = tuple(x + k * y for x, y in zip(total, time)), e - (k << FIELD * v)
                part = parts.setdefault(total, [P() for _ in own])
                part[j] = part[j] + P({e: c})
        parts = sorted((time, part) for time, part in parts.items() if any(part))
        leads = [k for k, (_, part) in enumerate(parts) if part[n]]
        need(1 <= n <= 64 and leads, "the loop is not well posed, or has no fitting order")
        first = next((k for k in leads if not any(parts[k][0])), leads[0])
        parts[0], parts[first] = parts[first], parts[0]
        self.delays = [tuple(x - y for x, y in zip(time, parts[0][0])) for time, _ in parts]
        parts = [part for _, part in parts]
        need(not any(self.is_long(end) for side in sides for end in side), "an end of the window has too many digits")
        lengths = [x.numerator.bit_length() - x.denominator.bit_length() for x in (max(map(abs, side)) for side in sides)]
        sizes = [max((c.bit_length() + sum((e >> FIELD * (2 + i) & MASK) * lengths[i] for i in range(names)) for p in column for e, c in p.items()),
                     default=None) for column in zip(*parts)]
        self.scale = w = max(((x - sizes[n]) // (n - j) + 1 for j, x in enumerate(sizes[:n]) if x is not None), default=0)
        need(abs(w) <= 1000, "the frequencies are too low or too high")
        functions = cleared([p * number(1 << (w * j if w >= 0 else -w * (n - j))) for part in parts for j, p in enumerate(part)])
        self.divisors = []
        self.nowhere = not all(map(any, divisors))
        self.separated = separated(divisors, positive)
        for ways in self.separated:
            self.divisors.append(range(len(functions), len(functions) + len(ways)))
            functions += ways
        self.functions = OverBoxes(functions, sources, models)

    @staticmethod
    def time(top, bottom, names):
        places = 0, *(1 << FIELD * (2 + i) for i in range(names))
        need(not any(bottom) and set(top) <= set(places), "a dead time is not linear in the names of the box")
        time = tuple(Fraction(top.get(e, 0), bottom[0]) for e in places)
        need(not any(map(JudgeOfDelays.is_long, time)), "a dead time has too many digits")
        return time

    @staticmethod
    def is_long(q):
        return size(q.as_integer_ratio()) > 4096

    def allow_to_keep(self, boxes):
        """Of each the way along the axis, which is short."""

    def halves(self, sides, known, own, axis):
        if not own:
            known = self.look(sides, known)[1]
        low, high = sides[axis]
        for side in ([low, (low + high) / 2], [(low + high) / 2, high]):
            yield [side if i == axis else other for i, other in enumerate(sides)], known, False

    def shows(self, sides, known, own, stable):
        return self.look(sides, known)[0] is stable

    def has_root_beyond(self, sides, e):
        return False

    def look(self, sides, way):
        """The verdict on a box, None if nothing is shown; and the way for parts of it."""
        if self.nowhere:
            return False, None
        times = [times_range(time, sides) for time in self.times]
        if any(most < 0 for _, most in times):
            return False, None  # no loop has a negative dead time
        delays = [times_range(time, sides) for time in self.delays]
        if any(least < 0 for least, _ in times + delays):
            return None, None
        n, functions = self.n, self.functions.at(sides)
        if functions is None:
            return None, None
        parts = [functions[k * (n + 1):(k + 1) * (n + 1)] for k in range(len(delays))]
        top, sign = parts[0][n], sign_of(parts[0][n])
        if not sign:
            return None, None
        if way is None:
            bound = self.bound(parts)
            if bound is None:
                return (False if self.has_chain(parts, delays) else None), None
            e = bound + FREQUENCY_BITS
            cells = [(0, e - 8), *((k << i - 2, i - 2) for i in range(e - 8, e) for k in range(4, 8))]
            way = sign < 0, [(cell, frozenset()) for cell in cells]
        zero = self.models.units(0)
        for part in parts:
            zero = summed(zero, part[0])
        if sign_of(zero) == -sign:
            return False, None  # a real root is to the right
        bits = self.models.bits
        down = max(size([abs(c[0][0]) + beside_constant(c) for part in parts for c in part]) - bits, 0)
        factor = Fraction(2) ** self.scale
        scaled = []
        for part, time, (least, most) in zip(parts, self.delays, delays):
            changes = (slope * (high - low) / 2 * factor for slope, (low, high) in zip(time[1:], sides))
            delay = ((least + most) / 2 * factor, *changes) if any(time) else None
            scaled.append(Delayed([halved(c, down) for c in part], delay, self.models))
        walk = Walk(scaled, self.turns, bits, way[1])
        way = way[0], walk.pieces
        right = roots_beside(walk.pieces, n, way[0]) if walk.is_whole else None
        if right and right[0] > 0:
            return False, way
        defined = all(any(sign_of(functions[i]) for i in ways) for ways in self.divisors)
        return (True if right == (0, True) and defined else None), way

    def bound(self, parts):
        """A power of two beyond which the highest power of s outweighs, on the axis, all that may point against it."""
        n, top = self.n, parts[0][self.n]
        others = [sum(abs(part[j][0][0]) + beside_constant(part[j]) for k, part in enumerate(parts)
                      if k or j < n and (n - j) % 2 == 0) for j in range(n + 1)]
        least = abs(top[0][0]) - beside_constant(top)
        if others[n] >= least:
            return None
        return next((e for e in range(-20, 41) if sum(x << (e + 20) * j + 20 * (n - j) for j, x in enumerate(others)) < least << (e + 20) * n), None)

    def has_chain(self, parts, delays):
        """Whether one delayed highest power, the only one, outweighs that without delay: infinitely many roots are to the right."""
        tops = [part[self.n] for part in parts]
        moduli = [abs(top[0][0]) + beside_constant(top) for top in tops]
        [*delayed] = [k for k in range(1, len(parts)) if moduli[k]]
        return len(delayed) == 1 and delays[delayed[0]][0] > 0 and 2 * abs(tops[delayed[0]][0][0]) - moduli[delayed[0]] > moduli[0]

def judge_of(text, names, values, sides, region, precision, cut=None):
    """Of the boxes in a window, of names of the model and those of a cut behind them."""
    discrete, extent = region
    sources, sides = Moving(), sides + (cut.sides(True) if cut else [])
    enclosed = (sides, precision[1]) if has_several_rates(text) else None
    need(not enclosed or not cut or not cut.is_complex, "a requirement of a loop with several rates has no certificate")
    is_discrete, own, divisors, is_complex = over_box(text, names, values, sources, enclosed, cut)
    need(is_discrete == discrete, "the model's time is another")
    if cut:
        cut.is_real, sides = not is_complex, sides[:len(names)] + cut.sides(not is_complex)
    models = Models(*precision, len(sides))
    parts, positive = [own], []  # the real and the imaginary part, of what has complex coefficients
    has_delay = any(name == "delay" for name, *_ in sources.sources)
    if cut:
        is_linear = cut.requirement != "delay_margin" or all(p.degree(3 + len(names)) < 2 + is_complex for p in own)
        need(cut.kind != "parameter" or is_linear, "require: the loop is not linear in what is cut")
        need(cut.kind != "variable" or not has_delay, "require: where the roots of a loop with dead time are has no certificate")
        parts = [own] = [cut.of_variable(own, 2 + len(names))]
    if cut and cut.is_complex:
        parts, divisors = cut.in_parts(own, divisors, 2 + len(names))
        positive = cut.positive(2 + len(names))

    def depends(lists):
        """Whether a name of the cut is in a divisor."""
        return any(p.degree(v) for ways in lists for p in ways for v in range(2 + len(names), 2 + len(sides)))

    common = ONE if enclosed else in_common(sum(parts, []), 2 + len(sides) if has_delay else 1 << FIELD)
    if any(common):  # where it vanishes, all coefficients do; the last divisor has a meaning of its own
        parts, divisors = [[c / common if c else c for c in part] for part in parts], [[common], *divisors]
    if has_delay:
        need(not discrete and extent == 0, "a loop with dead time is not continuous, or its boundary is not the imaginary axis")
        own = parts[0] if len(parts) == 1 else [sum(both, ZERO) for both in zip(*map(squared, parts))]
        judge = JudgeOfDelays(own, divisors, positive, sources, sides, models)
        judge.divides_by_factor = depends(judge.separated)
        return judge
    if len(parts) == 1:
        parts = [in_region(parts[0], discrete, extent)]
    n = len(own) - 1
    functions = cleared(sum((in_half_plane(part) if discrete else part for part in parts), []))
    nowhere = not all(map(any, divisors))
    nowhere = nowhere or (not all(functions) if len(parts) == 1 else not any(functions[::n + 1]) or not any(functions[n::n + 1]))
    places, begin = [], n + 1 if len(parts) == 1 else 2 * n + 1
    divisors = separated(divisors, positive)
    for ways in divisors:
        places.append(range(begin, begin + len(ways)))
        functions, begin = functions + ways, begin + len(ways)
    functions = OverBoxes(functions, sources, models)
    judge = Judge(functions, n, places, models, nowhere) if len(parts) == 1 else Judge(InParts(functions, n), 2 * n, places, models, nowhere)
    judge.divides_by_factor = depends(divisors)
    return judge

def check_boxes(model, document, statement, values, discrete, extent):
    _, _, order, bits = parts(document, ["schema", "statement", "order", "bits"], ["model"])
    *_, x, y, window, tree = parts(statement, ["kind", "time", "set", "region", "x", "y", "window", "tree"])
    need(extent != "parameter", "the region has no parameter here")
    need(1 <= count(order) <= 8 and 64 <= count(bits) <= 1024, "order or bits: out of range")
    names, sides = [name_of(x), name_of(y)], [items(ends, rational) for ends in parts(window, ["x", "y"])]
    need(all(len(ends) == 2 for ends in sides) and isinstance(tree, str), "a side has not two ends, or there is no tree")
    is_line = sides[1][0] == sides[1][1]  # one parameter alone is asked about
    need(sides[0][0] < sides[0][1] and sides[1][0] <= sides[1][1], "the window is empty")
    judge = judge_of(model, names, values, sides, (discrete, extent), (order, bits))
    where = " and ".join("{} from {} to {}".format(name, *inward(*side)) for name, side in zip(names, sides[:1] if is_line else sides))
    where = f"For {where}{and_with(({names[1]: sides[1][0]} if is_line else {}) | values)}, "
    inside = within(discrete, extent)
    stack, shares, pieces = [(sides, None, False, 0)], {"+": Fraction(0), "-": Fraction(0), "?": Fraction(0)}, []
    for letter in tree:
        need(stack, "tree: something follows it")
        sides, known, is_own, depth = stack.pop()
        if letter in "xy":
            need(depth < 160, "tree: too deep")
            need(letter == "x" or not is_line, "tree: a side without a width is halved")
            stack += [(*half, depth + 1) for half in judge.halves(sides, known, is_own, int(letter == "y"))][::-1]
            continue
        need(letter in shares, "tree: another letter")
        shares[letter] += Fraction(1, 1 << depth)
        if letter != "?" and not (judge.nowhere and letter == "-"):
            shown = not judge.nowhere and judge.shows(sides, known, is_own, letter == "+")
            need(shown, f"stable: a leaf {letter} is not shown, {' x '.join(f'[{a}, {b}]' for a, b in sides)}")
        if pieces and pieces[-1][0] == letter:  # those of one parameter follow each other
            pieces[-1][2] = sides[0][1]
        else:
            pieces.append([letter, *sides[0]])
    need(not stack, "tree: it ends too early")
    if is_line:
        def ranges(letter):
            own = (inward(low, high) for kind, low, high in pieces if kind == letter)
            return " and ".join(f"{low} <= {names[0]} <= {high}" for low, high in own)

        stable, unstable = ranges("+"), ranges("-")
        said = (f"the loop is stable{inside} for {stable}, and not stable for any value in {unstable}." if stable and unstable else
                f"the loop is stable{inside} for {stable}." if stable else
                f"the loop is not stable{inside} for any value in {unstable}." if unstable else "nothing is said of the loop.")
        return f"{where}{said} Nothing is said of the rest."
    tenths = [int(1000 * shares[letter]) for letter in "+-"]
    stable, unstable = (f"{k // 10}.{k % 10} %" for k in tenths)
    return (f"{where}the loop is stable{inside} in all boxes '+' of the tree, and nowhere in its boxes '-': at least {stable} and {unstable} of "
            "the window. Nothing is said of the rest.")

# ---------------------------------------------------------------- for all values

class Cut:
    """A requirement: where the loop is cut, and the factor that it has there, in names of its own. The loop meets the requirement where it is stable
    with the factor for all values of these. Those of a disc are r and t, delta = r (1 + j t)/(1 - j t)."""

    def __init__(self, item, discrete):
        need(isinstance(item, dict) and isinstance(item.get("kind"), str), "require: no kind")
        self.requirement = kind = item["kind"]
        key = {"phase_margin": "turns", "damping": "slopes", "log_radius": "radii"}.get(kind)
        if kind in ("damping", "log_radius"):  # where the roots are: the cut is wherever the loop's variable stands
            self.kind, self.name = "variable", ""
            _, bound, *around = parts(item, ["kind", "bound", key])
        else:
            _, at, bound, *around = parts(item, ["kind", "at", "bound"] + ([key] if key else []))
            need(isinstance(at, dict) and len(at) == 1 and set(at) <= {"signal", "input", "parameter"}, "require: a cut is a signal, an input or a parameter")
            [(self.kind, name)] = at.items()
            self.name = text_of(name) if self.kind == "input" else name_of(name)
        self.bound = x = of_few_digits(bound)
        self.is_complex, self.is_real = kind not in ("gain_margin", "delay_margin", "log_radius"), True
        self.names = 1 if key or not self.is_complex else 2
        need(not discrete or kind not in ("damping", "delay_margin"), "require: it is not of discrete time")
        need(discrete or kind != "log_radius", "require: it is not of continuous time")
        need(x < 0 if kind == "log_radius" else x > 0, "require: a bound has another sign")
        if key:
            self.around = items(around[0], of_few_digits)
            need(len(self.around) == 2 and 0 < self.around[0] <= self.around[1], "require: there are not two positive numbers in order")
        if kind == "phase_margin":
            need(x < 180, "require: a phase margin is not below 180 degrees")
            self.need_around_tangent()
        elif kind == "damping":
            need(x < 1, "require: a damping is not below 1")
            low, high = (t * t * (1 - x * x) for t in self.around)
            need(low <= x * x <= high, "require: the tangent is not between the 'slopes'")
        elif kind == "log_radius":
            self.need_around_exponential()
        elif kind == "delay_margin":
            pass  # any time will do
        elif kind == "gain_margin":
            need(x > 1, "require: a gain margin is not above 1")
        elif kind == "disk_margin":
            need(x < 2, "require: a disk margin is not below 2")
        else:
            need(kind in ("modulus_margin", "complementary_peak"), "require: unknown kind")
            need(kind == "complementary_peak" or x < 1, "require: a modulus margin is not below 1")

    def need_around_tangent(self):
        """The tangent of half the angle is between two numbers."""
        turns = self.around
        if self.bound == 90:
            need(turns[0] <= 1 <= turns[1], "require: the tangent is not between the 'turns'")
            return
        bits = 128 + 4 * size(x for q in (*turns, self.bound) for x in q.as_integer_ratio())
        pi = scaled_by(inverse_tangent(1 << bits, bits), 4)
        low, high = (scaled_by(arc(enclosed(t, bits), bits), 360 * self.bound.denominator) for t in turns)
        angle = scaled_by(pi, self.bound.numerator)
        need(low[1] <= angle[0] and angle[1] <= high[0], "require: the tangent is not between the 'turns'")

    def need_around_exponential(self):
        bits = 128 + 4 * size(x for q in (*self.around, self.bound) for x in q.as_integer_ratio())
        [exponential] = solutions([Fraction(1)], -self.bound, bits)
        low, high = (enclosed(r, bits) for r in self.around)
        need(low[1] <= exponential[0] and exponential[1] <= high[0], "require: the exponential is not between the 'radii'")

    def of_variable(self, own, first):
        """The coefficients of D(f x) for those of D(x), where the factor f of the variable x is r, or 1 + j t."""
        if self.kind != "variable":
            return own
        factor, power, found = P({1 << FIELD * first: 1}), ONE, []
        if self.is_complex:
            factor = ONE + factor * P({UNIT: 1})
        for c in own:
            found.append(short(c * power))
            power = short(power * factor)
        return found

    def begin(self, first):
        """From here on the variables are its own."""
        self.factor = scalar(P({FACTOR if self.is_complex else 1 << FIELD * first: 1}))

    def sides(self, is_real, refuting=False):
        """The ranges of its names. What has real coefficients without the factor is stable for a factor where it is for its conjugate."""
        if self.requirement == "gain_margin":
            return [[1 / self.bound, self.bound]]
        if self.requirement == "delay_margin":
            return [[Fraction(0), self.bound]]
        if self.requirement == "log_radius":
            return [[self.around[refuting]] * 2]
        t = self.around[not refuting] if self.names == 1 else Fraction(1)
        return [[-t, t]] * (self.names - 1) + [[Fraction(0) if is_real else -t, t]]

    def boxes(self, sides, judge):
        """The boxes of a leaf `+`: it says that the loop is stable in each of them. A disc has three. No factor of its edge may move a root to the boundary;
        then one point of the axes decides for the inside. Of a real loop real factors are enough there. A sector has one for each edge."""
        if self.requirement == "damping":
            [[low, high]] = self.sides(self.is_real)
            return [sides + [[t, t]] for t in ([high] if self.is_real else [high, low])]
        if self.names < 2 or not sides or judge.divides_by_factor:
            return [sides + self.sides(self.is_real)]
        [disc, turn], middle = self.sides(self.is_real), [[(low + high) / 2] * 2 for low, high in sides]
        one, zero = Fraction(1), Fraction(0)
        return [sides + [[one, one], turn], sides + [[-one, -one], turn], middle + [disc, [zero, zero] if self.is_real else turn]]

    def positive(self, first):
        """What has no zero where the factors are asked about."""
        if self.kind == "variable":
            return []
        top, bottom = self.quotient(first)
        found = [squared_modulus(short(p)).primitive() for p in ([bottom] if self.requirement == "complementary_peak" else [bottom, top])]
        return [p for i, p in enumerate(found) if any(p) and p not in found[:i]]

    def quotient(self, first):
        """The factor over a denominator that has no zero; one of the variable is put in before."""
        if self.kind == "variable":
            return ONE, ONE
        t = P({UNIT | 1 << FIELD * (first + self.names - 1): 1})
        plus, minus, x = ONE + t, ONE + -t, self.bound / 2 if self.requirement == "disk_margin" else self.bound
        if self.requirement == "phase_margin":
            return minus, plus
        x = 1 / x if self.requirement == "complementary_peak" else x
        disc, whole = P({1 << FIELD * first: x.numerator}) * plus, minus * number(x.denominator)
        top = whole if self.requirement == "modulus_margin" else whole + disc
        return top, whole if self.requirement == "complementary_peak" else whole + -disc

    def in_parts(self, own, divisors, first):
        """The real and the imaginary parts of coefficients with the factor in the place of variable 1, times a number that is never zero; and the
        squares of the moduli of complex divisors."""
        top, bottom = self.quotient(first)

        def put_in(p, degree):
            powers = p.coefficients(1)
            return short(sum((c * top ** k * bottom ** (degree - k) for k, c in enumerate(powers)), ZERO))

        need(all(p.degree(1) < 2 for p in own), "require: the loop is not linear in what is cut")
        found = [re_im(put_in(p, 1)) for p in own]
        divisors = [cleared([p if is_real(p) and not p.degree(1) else squared_modulus(put_in(short(p), p.degree(1))) for p in ways])
                    for ways in divisors]
        return [list(part) for part in zip(*found)], divisors

    def in_words(self):
        return f"{WISHES[self.requirement].format(exact(self.bound))}{self.where()}"

    def where(self):
        if self.kind == "variable":
            return ""
        return {"signal": " at {}", "parameter": " at the parameter {}", "input": " at the input of '{}'"}[self.kind].format(CONTROL.sub(" ", self.name))

WISHES = {"phase_margin": "a phase margin of at least {} degrees", "gain_margin": "a gain margin of at least {} both ways",
          "modulus_margin": "a modulus margin of at least {}", "disk_margin": "a disk margin of at least {}",
          "complementary_peak": "a peak of the complementary sensitivity of at most {}", "delay_margin": "a delay margin of at least {}",
          "damping": "a damping of all roots of at least {}", "log_radius": "a radius of all roots of at most exp({})"}

def of_few_digits(text):
    q = rational(text)
    need(size(q.as_integer_ratio()) <= 4096, "a number has too many digits")
    return q

class Proofs:
    """Reads the parts of a tree, and has them shown, for the loop of each requirement, or for the one without."""

    def __init__(self, text, loops, axes, names):
        self.text, self.at, self.loops, self.axes, self.names = text, 0, loops, axes, names

    def letter(self):
        need(self.at < len(self.text), "tree: it ends too early")
        self.at += 1
        return self.text[self.at - 1]

    def axis(self, letter, sides):
        """A name by its letter."""
        k = "abcdefgh".find(letter)
        need(0 <= k < len(sides), "tree: another letter")
        return k

    def good(self, sides):
        """Proofs for each loop: that it is stable at all points."""
        for judge, whole in ((judge, box) for cut, judge in self.loops for box in (cut.boxes(sides, judge) if cut else [sides])):
            stack = [(whole, None, False, 0)]
            while stack:
                box, known, is_own, depth = stack.pop()
                letter = self.letter()
                if letter != ".":
                    axis = self.axis(letter, box)
                    need(depth < MOST_HALVINGS, "tree: too deep")
                    need(box[axis][0] < box[axis][1], "tree: a side without a width is halved")
                    judge.allow_to_keep(len(stack) + 2)
                    stack += [(*half, depth + 1) for half in judge.halves(box, known, is_own, axis)][::-1]
                    continue
                shown = not judge.nowhere and judge.shows(box, known, is_own, True)
                need(shown, f"stable: a part is not shown to be stable, {' x '.join(f'[{a}, {b}]' for a, b in box)}")

    def part(self, sides):
        """The number of a loop, and the part that the steps lead to from the ranges of its names."""
        letter = self.letter()
        need(letter in "0123456789" and int(letter) < len(self.loops), "tree: there is no such loop")
        cut = self.loops[int(letter)][0]
        box, steps = sides + (cut.sides(cut.is_real, True) if cut else []), 0
        while (step := self.letter()) != ".":
            need(step in "lum<>", "tree: another step")
            k = self.axis(self.letter(), box)
            need(k >= self.axes, "tree: a step along an axis")
            need(steps < MOST_HALVINGS, "tree: too deep")
            low, high = box[k]
            middle = (low + high) / 2
            box[k] = {"l": [low, middle], "u": [middle, high], "m": [middle, middle], "<": [low, low], ">": [high, high]}[step]
            steps += 1
        return int(letter), box

    @staticmethod
    def nowhere_stable(judge, box):
        shown = judge.nowhere or judge.shows(box, None, False, False)
        need(shown, f"stable: a part is not shown to be nowhere stable, {' x '.join(f'[{a}, {b}]' for a, b in box)}")

    def leaves(self, sides):
        """The boxes of the axes, in order, each with its letter and its share of the window."""
        stack, found = [(sides[:self.axes], 0)], []
        while stack:
            box, depth = stack.pop()
            letter = self.letter()
            if letter in "+-?":
                found.append((letter, box, Fraction(1, 1 << depth)))
                if letter == "+":
                    self.good(box + sides[self.axes:])
                elif letter == "-":
                    k, part = self.part(box + sides[self.axes:])
                    self.nowhere_stable(self.loops[k][1], part)
                continue
            axis = self.axis(letter, box)
            need(depth < MOST_HALVINGS, "tree: too deep")
            low, high = box[axis]
            for side in [(low + high) / 2, high], [low, (low + high) / 2]:
                stack.append(([side if i == axis else other for i, other in enumerate(box)], depth + 1))
        need(self.at == len(self.text), "tree: something follows it")
        return found

MOST_HALVINGS = 160

def ranges_of(json_list):
    found = {}
    for name, between in items(json_list, lambda item: parts(item, ["name", "between"])):
        low, high = items(between, of_few_digits)
        need(name_of(name) not in found and low <= high, "a range is empty, or a name has two")
        found[name] = [low, high]
    return found

def check_for_all(model, document, statement, values, discrete, extent):
    _, _, order, bits = parts(document, ["schema", "statement", "order", "bits"], ["model"])
    keys = ["kind", "time", "set", "region", "axes", "for_all", "require", "tree", "beyond"]
    *_, axes, for_all, require, tree, beyond = parts(statement, keys)
    need(extent != "parameter", "the region has no parameter here")
    need(1 <= count(order) <= 8 and 64 <= count(bits) <= 1024, "order or bits: out of range")
    axes, for_all, require = ranges_of(axes), ranges_of(for_all), items(require, lambda item: Cut(item, discrete))
    need(len(axes) <= 2 and all(low < high for low, high in axes.values()), "the window is empty, or has more than two axes")
    need(not set(axes) & set(for_all), "a name has two ranges")
    need(len(require) <= 9, "there are more than nine requirements")
    need(len(axes) + len(for_all) + max((cut.names for cut in require), default=0) <= 8, "there are too many names")
    need(not require or extent == (1 if discrete else 0), "a region of its own has no requirements beside")
    several = has_several_rates(model)
    need(isinstance(tree, str), "there is no tree")
    global most
    most += WORK_OF_PART * len(tree)
    names, sides = [*axes, *for_all], [*axes.values(), *for_all.values()]

    def judge(cut, sides):
        found = judge_of(model, names, values, sides, (discrete, extent), (order, bits), cut)
        found.functions.allow_to_compute()
        return found

    loops = [(cut, judge(cut, sides)) for cut in require or [None]]
    leaves = Proofs(tree, loops, len(axes), names).leaves(sides)
    if beyond is not None:
        need(not axes, "beyond: there are axes")
        point, steps = parts(beyond, ["point", "not"])
        point = items(point, of_few_digits)
        need(len(point) == len(names) and isinstance(steps, str), "beyond: there is no point")
        proofs, sides = Proofs(steps, loops, 0, names), [[x, x] for x in point]
        k, part = proofs.part(sides)
        need(proofs.at == len(steps), "beyond: something follows the steps")
        # By enclosures a judge knows nothing beyond its window.
        proofs.nowhere_stable(judge(require[k] if require else None, sides) if several else loops[k][1], part)
        beyond = dict(zip(names, point))
    return of_for_all(axes, for_all, values, within(discrete, extent), require, leaves, beyond)

def of_for_all(axes, for_all, values, inside, require, leaves, beyond):
    """The statement in words. Ends of ranges are written exactly: a smaller range may leave out the value that breaks the loop."""
    wishes = " and ".join(cut.in_words() for cut in require)
    good, not_good = (f"{word}stable{inside}{f'{comma} with {wishes}' if wishes else ''}" for word, comma in (("", ","), ("not ", "")))
    so = ", " if wishes else " "
    values = {name: low for name, (low, high) in for_all.items() if low == high} | values
    every = " and ".join(f"{name} from {exact(low)} to {exact(high)}" for name, (low, high) in for_all.items() if low < high)
    if not axes:
        [(letter, _, _)] = leaves
        begin = f"For all {every}{and_with(values)}, the" if every else f"At {at_values(values)}, the" if values else "The"
        sentence = (f"{begin} loop is {good}." if letter == "+" else f"{begin} loop is stable or not: nothing is said of it." if letter == "?" else
                    f"Not f{begin[1:]} loop is {good}." if every else f"{begin} loop is {not_good}.")
        if beyond is not None:
            sentence += f" At {at_values(beyond)}, it is not." if beyond else " It is not."
        return sentence
    where = " and ".join("{} from {} to {}".format(name, *inward(*side)) for name, side in axes.items())
    where = f"For {where}{f', for all {every}' if every else ''}{and_with(values)}, "
    if len(axes) == 1:
        [name], pieces = axes, []
        for letter, [(low, high)], _ in leaves:
            if pieces and pieces[-1][0] == letter:
                pieces[-1][2] = high
            else:
                pieces.append([letter, low, high])

        def ranges(letter):
            own = (inward(low, high) for kind, low, high in pieces if kind == letter)
            return " and ".join(f"{low} <= {name} <= {high}" for low, high in own)

        for_, not_for = ranges("+"), ranges("-")
        said = (f"the loop is {good}{so}for {for_}, and not so for any value in {not_for}." if for_ and not_for else f"the loop is {good}{so}for {for_}." if for_ else
                f"the loop is {not_good}{so}for any value in {not_for}." if not_for else "nothing is said of the loop.")
        return f"{where}{said} Nothing is said of the rest."
    tenths = [int(1000 * sum(share for kind, _, share in leaves if kind == letter)) for letter in "+-"]
    shares = " and ".join(f"{k // 10}.{k % 10} %" for k in tenths)
    return (f"{where}the loop is {good}{so}in all boxes '+' of the tree, and nowhere in its boxes '-': at least {shares} of the window. "
            "Nothing is said of the rest.")

# ---------------------------------------------------------------- best gains

class Formula:
    """A rational function of the gains."""

    def __init__(self, item, gains):
        self.above, self.below = (self.polynomial(p, gains) for p in parts(item, ["above", "below"]))

    @staticmethod
    def polynomial(json_value, gains):
        p = boxed(gains)(json_value)
        exponents = {e: [e >> FIELD * (2 + i) & MASK for i in range(gains)] for e in p}
        need(p and len(p) <= 1000, "objective: a polynomial is zero, or has too many terms")
        need(all(sum(of) <= 32 for of in exponents.values()), "objective: a polynomial has too high a degree")
        need(size(p.values()) <= 1 << 15, "objective: too long numbers")
        terms = [(of, p[e]) for e, of in exponents.items()]
        return sorted(terms, key=lambda term: (sum(term[0]), term[0]), reverse=True)

    def gain(self):
        """The number of the gain that it is, None if it is another function."""
        (exponents, c), *others = self.above
        is_plain = not others and c == 1 == sum(exponents) and self.is_polynomial()
        return exponents.index(1) if is_plain else None

    def is_polynomial(self):
        return len(self.below) == 1 and not any(self.below[0][0]) and self.below[0][1] == 1

    def at(self, point):
        above, below = (sum(c * prod(x ** k for x, k in zip(point, of)) for of, c in p) for p in (self.above, self.below))
        return above / below if below else None

    def is_worse(self, is_greatest, number, cell):
        """Whether all values over a cell are worse than a number."""
        def sign(terms):
            p = P({sum(k << FIELD * (2 + i) for i, k in enumerate(of)): c for of, c in terms if c})
            if not p:
                return 0
            [plane] = Tensor.of([[p]], cell, InBox(len(cell), None)).planes
            return 1 if min(plane) > 0 else -1 if max(plane) < 0 else 0

        below = sign(self.below)
        difference = {tuple(of): c * number.denominator for of, c in self.above}
        for of, c in self.below:
            difference[tuple(of)] = difference.get(tuple(of), 0) - c * number.numerator
        return below != 0 and sign(list(difference.items())) == (-below if is_greatest else below)

    def in_words(self, names):
        def polynomial(terms):
            out = ""
            for of, c in terms:
                powers = [name if k == 1 else f"{name}^{k}" for name, k in zip(names, of) if k]
                sign = ("-" if c < 0 else "") if not out else " - " if c < 0 else " + "
                out += sign + "*".join(([] if abs(c) == 1 and powers else [exact(Fraction(abs(c)))]) + powers)
            return out

        above = polynomial(self.above)
        return above if self.is_polynomial() else f"({above})/({polynomial(self.below)})"

class Level:
    """A number of the loop that is to be best: a region, or a requirement."""

    def __init__(self, item, discrete):
        self.discrete, self.cut = discrete, Cut(item, discrete) if isinstance(item, dict) and "kind" in item else None
        if not self.cut:
            [bound] = parts(item, ["radius" if discrete else "decay"])
            self.bound = of_few_digits(bound)
            need(0 < self.bound < 1 if discrete else self.bound > 0, "a level is no more than stability")

    def is_better_than(self, other):
        a, b = self.cut or self, other.cut or other
        if self.cut and other.cut:
            need((a.requirement, a.kind, a.name) == (b.requirement, b.kind, b.name), "the levels are not of the same kind")
        need(bool(self.cut) == bool(other.cut), "the levels are not of the same kind")
        is_least_best = a.requirement in ("complementary_peak", "log_radius") if self.cut else self.discrete
        return a.bound < b.bound if is_least_best else a.bound > b.bound

class Gains(Proofs):
    """Reads cells of gains: in no cell are any gains good."""

    def cells(self, sides, is_worse):
        stack = [(sides, 0)]
        while stack:
            cell, depth = stack.pop()
            letter = self.letter()
            if letter == "o":
                need(is_worse(cell), "stable: a leaf o is not shown")
            elif letter in "-s":
                exponent = None
                if letter == "s":
                    found = re.compile("-?[0-9]{1,3};").match(self.text, self.at)
                    need(found, "tree: no exponent")
                    self.at, exponent = found.end(), int(found[0][:-1])
                    need(abs(exponent) <= 100, "tree: no exponent")
                k, part = self.part([*cell])
                judge = self.loops[k][1]
                if exponent is None:
                    self.nowhere_stable(judge, part)
                else:
                    need(judge.nowhere or judge.has_root_beyond(part, exponent), "stable: no root is shown to be beyond")
            else:
                axis = self.axis(letter, cell)
                need(depth < MOST_HALVINGS, "tree: too deep")
                low, high = cell[axis]
                need(low < high, "tree: a side without a width is halved")
                for side in [(low + high) / 2, high], [low, (low + high) / 2]:
                    stack.append(([side if i == axis else other for i, other in enumerate(cell)], depth + 1))
        need(self.at == len(self.text), "tree: something follows it")

def read_objective(objective, gains, discrete):
    """A function, whether it is to be great, and a value; or a level; or nothing."""
    if objective is None:
        return None, None, None, None
    need(isinstance(objective, dict), "objective: an object is expected")
    if "level" in objective:
        [level] = parts(objective, ["level"])
        return None, None, None, Level(level, discrete)
    is_greatest = "greatest" in objective
    formula, proved = parts(objective, ["greatest" if is_greatest else "least", "proved"])
    return Formula(formula, gains), is_greatest, of_few_digits(proved), None

def read_found(found, sides, discrete, formula, level):
    """Gains in the box, their level if one is to be best, and the proof; or nothing."""
    if found is None:
        return None, None, None
    point, found_level, proof = parts(found, ["point", "level", "proof"])
    point = items(point, of_few_digits)
    need(len(point) == len(sides) and all(low <= x <= high for x, (low, high) in zip(point, sides)), "found: the point is not in the box")
    need((formula or level) and (found_level is None) == (level is None), "found: nothing is to be best, or another kind of level")
    if level:
        found_level = Level(found_level, discrete)
        need(level.is_better_than(found_level), "found: its level is not worse than the level that no gains have")
    need(not formula or formula.at(point) is not None, "found: what is to be best is undefined there")
    need(isinstance(proof, str), "found: there is no proof")
    return point, found_level, proof

def check_gains(model, document, statement, values, discrete, extent):
    _, _, order, bits = parts(document, ["schema", "statement", "order", "bits"], ["model"])
    keys = ["kind", "time", "set", "region", "gains", "require", "objective", "found", "tree"]
    *_, gains, require, objective, found, tree = parts(statement, keys)
    need(extent != "parameter", "the region has no parameter here")
    need(1 <= count(order) <= 8 and 64 <= count(bits) <= 1024, "order or bits: out of range")
    gains, require = ranges_of(gains), items(require, lambda item: Cut(item, discrete))
    names, sides = [*gains], [*gains.values()]
    need(1 <= len(gains) <= 5 and all(low < high for low, high in sides), "there are no gains or more than five, or the box is empty")
    need(len(require) <= 7, "more than seven requirements")
    formula, is_greatest, proved, level = read_objective(objective, len(names), discrete)
    point, found_level, proof = read_found(found, sides, discrete, formula, level)
    levels = [of for of in (level, found_level) if of]
    need(all(of.cut or (of.bound <= extent if discrete else of.bound >= extent) for of in levels), "the region of a level is not inside of the required one")
    several = has_several_rates(model)
    need(not several or not any(not of.cut for of in levels), "the radius of a loop of several rates has no certificate")
    cuts = [None, *require, *(of.cut for of in levels if of.cut)]
    need(len(names) + max((cut.names for cut in cuts if cut), default=0) <= 8, "there are too many names")
    need(isinstance(tree, str), "there is no tree")
    global most
    most += WORK_OF_PART * (len(tree) + len(proof or ""))

    def judge(cut, region):
        judged = judge_of(model, names, values, sides, (discrete, region), (order, bits), cut)
        judged.functions.allow_to_compute()
        return cut, judged

    usual = 1 if discrete else 0
    inside = level.bound if level and not level.cut else extent
    loops = [judge(cut, usual if cut else inside) for cut in cuts]
    of_found = loops
    if found_level and found_level.cut:
        loops, of_found = loops[:-1], loops[:-2] + loops[-1:]
    elif found_level:
        of_found = [*loops[1:], judge(None, found_level.bound)]
    cells, gain = [*sides], formula.gain() if formula else None
    if gain is not None:
        low, high = sides[gain]
        if is_greatest and low < proved <= high:
            cells[gain] = [proved, high]
        elif not is_greatest and low <= proved < high:
            cells[gain] = [low, proved]
    Gains(tree, loops, len(names), names).cells(cells, lambda cell: bool(formula) and formula.is_worse(is_greatest, proved, cell))
    if point is not None:
        proofs = Proofs(proof, of_found, len(names), names)
        proofs.good([[x, x] for x in point])
        need(proofs.at == len(proof), "proof: something follows it")
    best = formula and (formula, is_greatest, proved)
    return of_cells(gains, values, within(discrete, inside), [cut for cut, _ in loops[1:]], best, point and (point, found_level))

def of_cells(gains, values, inside, cuts, best, found):
    """The statement in words. Ranges are written exactly: a smaller one may leave out gains that are good."""
    names = [*gains]
    wishes = f", with {' and '.join(cut.in_words() for cut in cuts)}" if cuts else ""
    formula, is_greatest, proved = best or (None, None, None)
    beside = f" with {formula.in_words(names)} {'>=' if is_greatest else '<='} {exact(proved)}" if best else ""
    where = " and ".join(f"{name} from {exact(low)} to {exact(high)}" for name, (low, high) in gains.items())
    sentence = f"For no {where}{beside}{and_with(values)}, the loop is stable{inside}{wishes}."
    if not found:
        return sentence
    point, level = found
    at = at_values(dict(zip(names, point)))
    if best:
        return f"{sentence} At {at} it is, and {formula.in_words(names)} is {exact(formula.at(point))} there."
    has = f" with {level.cut.in_words()}" if level.cut else within(level.discrete, level.bound)
    return f"{sentence} At {at} it is,{has} instead."

# ---------------------------------------------------------------- dead time

def inverse_tangent(x, bits):
    """Of a number over 2^bits, enclosed: the argument is halved, then Euler's alternating series is cut off."""
    one, halvings = 1 << bits, 8
    lo = hi = abs(x)
    for _ in range(halvings):  # atan x = 2 atan(x/(1 + sqrt(1 + x^2)))
        lo = (lo << bits) // (one + isqrt(one * one + lo * lo) + 1)
        hi = -(-(hi << bits) // (one + isqrt(one * one + hi * hi)))
    out, power, k = (0, 0), (lo, hi), 1
    square = times(power, power, bits)
    while power[1] > 0:
        term = power[0] // k, -(-power[1] // k)
        out = added(out, term if k % 4 == 1 else (-term[1], -term[0]))
        power, k = times(power, square, bits), k + 2
        if power[1] <= 1:
            break
    out = (out[0] - 2) << halvings, (out[1] + 2) << halvings
    return out if x >= 0 else (-out[1], -out[0])

def arc(x, bits):
    return inverse_tangent(x[0], bits)[0], inverse_tangent(x[1], bits)[1]

def over(x, y, bits):
    need(y[0] > 0 or y[1] < 0, "a divisor is not shown to be other than zero")
    pairs = [(a << bits, b) for a in x for b in y]
    return min(a // b for a, b in pairs), max(-(-a // b) for a, b in pairs)

def root_of(x):
    """The square root of a positive number over 2^bits, given with 2 bits."""
    return isqrt(x[0]), isqrt(x[1]) + 1

class Crossing:
    """A root i omega of the axis, simple in omega^2, which is the only root of F between a and b."""

    def __init__(self, p, q, f, a, b, bits):
        need(0 < a < b and value(f, a) * value(f, b) < 0, "crossings: no change of sign")
        self.direction = 1 if value(f, b) > 0 else -1
        w = enclosed(a, bits)[0], enclosed(b, bits)[1]
        self.omega = root_of((w[0] << bits, w[1] << bits))
        # z = exp(-i omega tau) = -P_0/P_1: the angle omega tau is that of x + i omega y
        (e0, o0), (e1, o1) = ([part[0::2], part[1::2]] for part in (p, q))
        alternating = [[c * (-1) ** k for k, c in enumerate(part)] for part in (e0, o0, e1, o1)]
        e0, o0, e1, o1 = map(P.of, alternating)  # in omega^2
        x = -(e0 * e1 + P.of([0, 1]) * o0 * o1)
        y = o0 * e1 + -(e0 * o1)
        at = [self.horner(part.listed(0), w, bits) for part in (x, y)]
        x_at, y_at = at[0], times(at[1], self.omega, bits)
        pi = scaled_by(inverse_tangent(1 << bits, bits), 4)
        self.turn = scaled_by(pi, 2)
        half = floor_shift(pi, 1)
        if not y:  # z is 1 or -1
            self.is_one = certain(x_at) > 0
            need(x_at[0] > 0 or x_at[1] < 0, "a sign is not certain")
            self.theta = (0, 0) if self.is_one else pi
            return
        self.is_one = False
        if x_at[0] <= 0 <= x_at[1]:
            sign = certain(y_at)
            self.theta = added(half if sign > 0 else added(pi, half), scaled_by(arc(over(x_at, y_at, bits), bits), -1))
        else:
            angle = arc(over(y_at, x_at, bits), bits)
            self.theta = added(angle, pi if x_at[1] < 0 else (0, 0) if certain(y_at) > 0 else self.turn)

    @staticmethod
    def horner(p, x, bits):
        out = (0, 0)
        for c in reversed(p):
            out = added(times(out, x, bits), (c << bits, c << bits))
        return out

    def dead_time(self, k, bits):
        return over(added(self.theta, scaled_by(self.turn, k)), self.omega, bits)

def square_of_modulus(p):
    """|p(i omega)|^2, a polynomial in omega^2."""
    even, odd = (P.of([c * (-1) ** k for k, c in enumerate(p[first::2])]) for first in (0, 1))
    return even * even + P.of([0, 1]) * odd * odd

def check_windows(model, document, statement, values, extent):
    """The stable dead times: from the roots without delay, counted on over all crossings."""
    names = ["schema", "statement", "bits", "delay", "parts", "crossings"]
    _, _, bits, base, given, crossings = parts(document, names, ["model"])
    *_, parameter, domain, claimed = parts(statement, ["kind", "time", "set", "region", "parameter", "domain", "stable"])
    need(type(bits) is int and 64 <= bits <= 1 << 15, "bits: out of range")
    low, high = (None if b is None else rational(b) for b in parts(domain, ["lower", "upper"]))
    need(low is not None and 0 <= low and (high is None or low < high), "the domain is not one of dead times")
    base = rational(base)
    need(base > 0 and extent == 0, "the dead time or the region is another")
    given = items(given, lambda part: items(part, integer))
    own = [part.listed(0) for part in quasi_polynomial(model, name_of(parameter), values, base)]
    need(given in (own, [[-c for c in part] for part in own]), "parts: not those of the model")
    need(len(given) == 2, "parts: more than one multiple of the dead time")
    p, q = given
    n = len(p) - 1
    need(n >= len(q) and p and q or len(q) - 1 == n and abs(q[n]) < abs(p[n]), "the loop is advanced, or neutral and never stable")
    total = (P.of(p) + P.of(q)).listed(0)
    if not total or not total[0]:
        found, right, events = [], 1, []  # s = 0 for every dead time
        need(crossings == [], "crossings: there is nothing to cross")
    else:
        f = (square_of_modulus(p) + -square_of_modulus(q)).listed(0)
        need(f, "crossings: on the axis for all frequencies")
        f = f[next(k for k, c in enumerate(f) if c):]
        chain = sturm(f, [k * c for k, c in enumerate(f)][1:])
        need(len(chain[-1]) == 1, "crossings: a root of F is multiple")
        need(changes(g[0] for g in chain) - changes(g[-1] for g in chain) == len(crossings), "crossings: not as many as roots")
        enclosures = items(crossings, pair)
        need(all(a[1] <= b[0] for a, b in zip(enclosures, enclosures[1:])), "crossings: not in order")
        found = [Crossing(p, q, f, a, b, bits) for a, b in enclosures]
        inside, on, right = places(total, False)
        at_zero = [c for c in found if c.is_one]
        need(on == 2 * len(at_zero) and inside + on + right == n, "crossings: the roots without delay do not fit")
        right += 2 * sum(c.direction > 0 for c in at_zero)
        last = None if high is None else high * base
        if found:
            growth = (0, 0)
            for c in found:
                growth = added(growth, scaled_by(c.omega, c.direction))
            need(growth[0] > 0, "crossings: the count is not shown to grow")
            bound = Fraction(found[0].turn[1] * len(found), growth[0])
            last = bound if last is None else min(last, bound)
        events = []
        for j, c in enumerate(found):
            k = int(c.is_one)
            while (e := c.dead_time(k, bits))[0] < last * (1 << bits):
                events.append((*e, c.direction, j, k))
                k += 1
                need(len(events) < 100_000, "there are too many switches")
        events.sort()
        need(all(a[1] < b[0] for a, b in zip(events, events[1:])), "crossings: the order of two switches is not certain")
    scale = base * (1 << bits)
    behind = [[hi for _, hi, _, crossing, _ in events if crossing == i] for i in range(len(found))]

    def is_alone(j, k, between):
        """Whether no other switch is in the interval: of each crossing the first that is not before it is looked at."""
        for i, c in enumerate(found):
            turns = int(c.is_one) + bisect_left(behind[i], between[0] * scale)
            if i == j and turns != k:
                return False
            if c.dead_time(turns + (i == j), bits)[0] <= between[1] * scale:
                return False
        return True

    before, stable = low, []
    for e0, e1, direction, j, k in events:
        at = Fraction(e0) / scale, Fraction(e1) / scale
        if at[1] < low:
            right += 2 * direction
            continue
        if high is not None and at[0] > high:
            break
        need(low < at[0] and (high is None or at[1] < high), "a switch is not told from an end of the domain")
        if right == 0:
            stable.append((before, (j, k, at)))
        right, before = right + 2 * direction, (j, k, at)
    if right == 0:
        need(high is not None or not found, "the count does not grow")
        stable.append((before, high))
    need(isinstance(claimed, list) and len(claimed) == len(stable), "stable: not as many intervals")

    def fits(end, own):
        if not isinstance(own, tuple):
            return (None if end is None else rational(end)) == own
        crossing, turns, between = parts(end, ["crossing", "turns", "between"])
        between = pair(between)
        is_own = [count(crossing), count(turns)] == [*own[:2]] and between[0] <= own[2][0] and own[2][1] <= between[1]
        return is_own and is_alone(*own[:2], between)

    for interval, ends in zip(claimed, stable):
        need(all(map(fits, parts(interval, ["lower", "upper"]), ends)), "stable: an end is another")
    stable = [[e[2] if isinstance(e, tuple) else e for e in ends] for ends in stable]
    return of_intervals(parameter, values, False, extent, low, high, stable)

# ---------------------------------------------------------------- a gain beside dead time

def times_complex(x, y, bits):
    (a, b), (c, d) = x, y
    return added(times(a, c, bits), scaled_by(times(b, d, bits), -1)), added(times(a, d, bits), times(b, c, bits))

def conjugate(x):
    return x[0], scaled_by(x[1], -1)

def square_of(x, bits):
    """The square of the modulus of an enclosed complex number."""
    squares = [(0 if part[0] <= 0 <= part[1] else times(part, part, bits)[0], times(part, part, bits)[1]) for part in x]
    return added(*squares)

class Family:
    """sum (A_k(s) + p B_k(s)) z^k with z = exp(-tau s)."""

    MOST_HALVINGS, MOST_PARTS, MOST_ORDER = 200, 100_000, 64

    def __init__(self, rows, tau, bits):
        self.order = max((j for row in rows for j, c in enumerate(row) if any(c)), default=0)
        need(1 <= self.order <= self.MOST_ORDER, "the loop has no fitting order")
        rows = [[*row, *[[]] * (self.order + 1)][:self.order + 1] for row in rows]
        self.parts = [[[[*c, 0, 0][k] for c in row] for k in (0, 1)] for row in rows]
        self.tau, self.bits, self.turns, self.looked_at = tau, bits, {}, 0

    def coefficient(self, k, j, p):
        return self.parts[k][0][j] + p * self.parts[k][1][j]

    def beyond(self, a, b):
        """From this power of two on the highest power of s without delay outweighs all else, for p from a to b and Re s >= 0."""
        n, delays = self.order, range(len(self.parts))
        ends = [self.coefficient(0, n, p) for p in (a, b)]
        largest = lambda k, j: max(abs(self.coefficient(k, j, p)) for p in (a, b))
        others = [sum(largest(k, j) for k in delays) for j in range(n)]
        left = min(map(abs, ends)) - sum(largest(k, n) for k in delays[1:])
        need(ends[0] * ends[1] > 0 and left > 0, "the highest power of s is not shown to outweigh the others")
        for e in range(-128, 257):
            s = Fraction(2) ** e
            spend(n, 600 * n, 600)
            if sum(c * s ** j for j, c in enumerate(others)) < left * s ** n:
                return e
        raise Rejected("the highest power of s is not shown to outweigh the others")

    def turn(self, k):
        """exp(i omega tau) for omega of 2^k units."""
        if k not in self.turns:
            self.turns[k] = tuple(solutions([Fraction(1), Fraction(0)], Fraction(2) ** (k - self.bits) * self.tau, self.bits))
        return self.turns[k]

    def walk(self, exponent, settles):
        """Calls it with A and B on parts of the axis up to a power of two, in order; what it does not settle is halved."""
        end, bits = self.bits + exponent, self.bits
        least = max(end - self.MOST_HALVINGS, 2)
        need(end > least, "the frequencies are too low for the bits")
        todo = [(0, end, self.turn(end - 1))]
        while todo:
            lower, width, turn = todo.pop()
            self.looked_at += 1
            need(self.looked_at <= self.MOST_PARTS, "the axis would have to be cut into too many parts")
            if settles(*self.enclosed(lower, width, turn)):
                continue
            need(width > least, "a root may be on the axis")
            quarter = self.turn(width - 2)
            todo.append((lower + (1 << width - 1), width - 1, times_complex(turn, quarter, bits)))
            todo.append((lower, width - 1, times_complex(turn, conjugate(quarter), bits)))

    def enclosed(self, lower, width, turn):
        """A and B for s = i omega, omega from a number of units on, and exp(i omega tau) known in the middle."""
        bits, one = self.bits, 1 << self.bits
        omega, powers = (lower, lower + (1 << width)), [(one, one)]
        for _ in range(self.order):
            powers.append(times(powers[-1], omega, bits))
        radius = -(-(self.tau.numerator << width - 1) // self.tau.denominator)  # the angle to the ends of the part
        power, out = ((one, one), (0, 0)), [((0, 0), (0, 0))] * 2
        for k, both in enumerate(self.parts):
            power = times_complex(power, turn, bits) if k else power
            z = conjugate(tuple((max(lo - k * radius, -one), min(hi + k * radius, one)) for lo, hi in power))
            for which, coefficients in enumerate(both):
                if any(coefficients):
                    spend(len(coefficients), bits, size(coefficients))
                    sums = [(0, 0), (0, 0)]
                    for j, c in enumerate(coefficients):  # i^j: 1, i, -1, -i
                        sums[j % 2] = added(sums[j % 2], scaled_by(powers[j], -c if j % 4 >= 2 else c))
                    term = times_complex(sums, z, bits) if k else sums
                    out[which] = tuple(map(added, out[which], term))
        return out

    def clear(self, exponent, a, b):
        """No root is on the axis for p from a to b: p |B|^2 = -Re(A conj B) where A conj B is real."""
        bits, largest = self.bits, max(abs(a), abs(b)) ** 2

        def settles(x, y):
            re, im = times_complex(x, conjugate(y), bits)
            if im[0] > 0 or im[1] < 0:
                return True
            of_x, of_y = square_of(x, bits), square_of(y, bits)
            beside = [added(scaled_by(re, p.denominator), scaled_by(of_y, p.numerator)) for p in (a, b)]
            return (beside[0][0] > 0 or beside[1][1] < 0
                    or of_x[0] * largest.denominator > of_y[1] * largest.numerator)

        self.walk(exponent, settles)

    def right(self, exponent, p):
        """The roots to the right at one value: quarter turns of the argument on the way along the axis [Mikhailov]."""
        first = sum(self.coefficient(k, 0, p) for k in range(len(self.parts)))
        need(first, "s = 0 is a root")
        half_plane, turns = 2 * (first < 0), 0  # around 1, i, -1, -i

        def settles(x, y):
            nonlocal half_plane, turns
            re, im = (added(scaled_by(x[i], p.denominator), scaled_by(y[i], p.numerator)) for i in (0, 1))
            inside = re[0] > 0, im[0] > 0, re[1] < 0, im[1] < 0
            for step in (0, 1, -1):
                if inside[(half_plane + step) % 4]:
                    half_plane, turns = (half_plane + step) % 4, turns + step
                    return True
            return False

        self.walk(exponent, settles)
        step = (self.order + 2 * (self.coefficient(0, self.order, p) < 0) - half_plane) % 4
        need(step != 2, "the argument does not turn as it must")
        twice = self.order - turns - (-1 if step == 3 else step)
        need(twice >= 0 and twice % 2 == 0, "the argument does not turn as it must")
        return twice // 2

def check_cells(model, document, statement, values, extent):
    """Root counts for all values of a parameter in closed intervals, at a fixed dead time."""
    _, _, bits, base = parts(document, ["schema", "statement", "bits", "delay"], ["model"])
    if statement["kind"] == "verdict":  # a cell of one point, without a parameter
        *_, verdict, right = parts(statement, ["kind", "time", "set", "region", "verdict", "right"])
        need(verdict == ("unstable" if count(right) else "stable"), "stable: the verdict is another")
        parameter, cells = None, [(Fraction(0), Fraction(0), right)]
    else:
        *_, parameter, cells = parts(statement, ["kind", "time", "set", "region", "parameter", "cells"])
        cells = items(cells, lambda cell: parts(cell, ["between", "right"]))
        cells, parameter = [(*pair(between), count(right)) for between, right in cells], name_of(parameter)
    need(type(bits) is int and 64 <= bits <= 1024, "bits: out of range")
    base = rational(base)
    need(base > 0 and extent == 0, "the dead time or the region is another")
    need(cells and all(a[1] < b[0] for a, b in zip(cells, cells[1:])), "cells: not in order")
    ends = [x for a, b, _ in cells for x in (a, b)]
    need(size(x.numerator for x in ends) <= 4096 >= size(x.denominator for x in ends), "cells: too many digits")
    d, divisors = characteristic_function(model, parameter, values, DeadTime(base, 0))
    divisors = [p.content(0) for p in divisors]
    rows = [part.coefficients(0) for part in d.coefficients(2)]
    while not any(rows[0]):
        rows.pop(0)
    content = ZERO
    for c in (c for row in rows for c in row if c):
        content = content.common(c)
    divisors.append(content)
    rows = [[(c / content).listed(1) for c in row] for row in rows]
    need(all(len(c) <= 2 for row in rows for c in row), "the parameter does not enter as a factor")
    family = Family(rows, base, bits)
    for a, b, right in cells:
        for p in (p.listed(1) for p in divisors):
            need(value(p, a) and value(p, b) and descartes(p, a, b) == 0, "a divisor is not shown to be other than zero")
        exponent = family.beyond(a, b)
        family.clear(exponent, a, b)
        found = family.right(exponent, (a + b) / 2)
        need(found == right, f"cells: {found} roots are to the right from {a} to {b}")
    if parameter is None:
        at = f"At {at_values(values)}, the" if values else "The"
        return f"{at} loop is {verdict}: {cells[0][2]} roots to the right of the imaginary axis, none on it."
    of = [" or ".join(f"[{', '.join(inward(a, b))}]" for a, b, right in cells if right in wanted) for wanted in ({0}, {c[2] for c in cells})]
    return (f"For {parameter} in {of[1]}{and_with(values)}, the loop is stable exactly {f'in {of[0]}' if of[0] else 'for none of them'}. "
            "Nothing is said of other values.")

# ---------------------------------------------------------------- words

DIGITS, FEW, SHORT, WHOLE = 12, 3, 12, 15  # of a decimal, at least of an enclosure, of a fraction, an integer
MOST_DIGITS = 3072  # No more are written where ends of a set would look the same.
PLAIN = range(-5, 12)  # powers of ten without exponent

def is_short(q):
    return len(str(q)) <= SHORT or q.denominator == 1 and len(str(q)) <= WHOLE

def exponent(q):
    """Of the leading digit the power of ten; None of zero."""
    if not q:
        return None
    about = len(str(abs(q.numerator))) - len(str(q.denominator))
    return about - 1 if over_power(abs(q), about) < 1 else about

def over_power(q, power):
    return q / 10 ** power if power >= 0 else q * 10 ** -power

def layout(digits, power, dots=""):
    """A whole number times a power of ten, with something behind its digits."""
    sign, every = "-" if digits < 0 else "", str(abs(digits))
    if not digits:
        return "0"
    leading, every = len(every) + power - 1, every if dots else every.rstrip("0")
    if leading not in PLAIN:
        return f"{sign}{every[0]}{'.' * (len(every) > 1)}{every[1:]}{dots}e{leading}"
    if leading < 0:
        return f"{sign}0.{'0' * (-leading - 1)}{every}{dots}"
    whole = every[:leading + 1].ljust(leading + 1, "0")
    return f"{sign}{whole}" + (f".{every[leading + 1:]}" if len(every) > leading + 1 else "") + dots

def exact(q, count=DIGITS):
    """A number: its fraction if that is short; its decimal; or the first digits of that and three dots."""
    if is_short(q):
        return str(q)
    return decimal_of(q, count)

def with_decimal(q, count):
    """An end of a set, to so many digits: a short fraction has its decimal behind it."""
    shown = exact(q, count)
    return f"{shown} ({decimal_of(q, count)})" if "/" in shown else shown

def digits_apart(ends):
    """The digits that tell the ends of a set apart, ascending and each between two numbers: those that are always written, unless two neighbours look the same."""
    ends, count = [tuple(e) for e in ends], DIGITS
    while count <= MOST_DIGITS:
        texts = [told(e, count) for e in ends]
        if not any(a == b and low != high and low[1] <= high[0] for a, b, low, high in zip(texts, texts[1:], ends, ends[1:])):
            return count
        count *= 2
    return DIGITS

def told(e, count):
    """The digits of an end without what says nothing more: dots, and zeros at the end."""
    low, high = e
    text = shared_digits(low, high, count) if low != high else decimal_of(low, count) if low else "0"
    mantissa, _, power = text.replace("...", "").partition("e")
    return (mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa) + "e" + power

def decimal_of(q, count):
    """The decimal of a number other than 0, or the first digits of it and three dots."""
    power = exponent(q) - count + 1
    digits = over_power(abs(q), power)
    text = layout(int(digits), power, "" if digits.denominator == 1 else "...")
    return "-" + text if q < 0 else text

def rounded(q, leading, up):
    if is_short(q):
        return str(q)
    digits = over_power(q, leading - DIGITS + 1)
    return layout(-int(-digits // 1) if up else int(digits // 1), leading - DIGITS + 1)

def inward(low, high):
    """The ends of an interval, which is not made wider."""
    return rounded(low, exponent(low), True), rounded(high, exponent(high), False)

def outward(low, high):
    """The ends of an enclosure, which is not made narrower: both with as many decimals."""
    leading = max(e for e in map(exponent, (low, high)) if e is not None)
    return rounded(low, leading, False), rounded(high, leading, True)

def shared_digits(low, high, most):
    """A number inside of an open interval: the first digits that all numbers in it have, so many at most; where these are few, the interval."""
    near, far = sorted((abs(low), abs(high)))
    if low >= 0 < near or high <= 0 < near:
        for count in range(most, FEW - 1, -1):
            power = exponent(near) - count + 1
            if power > 0 and exponent(near) in PLAIN:
                break  # zeros would stand in the place of digits that are not known
            digits = over_power(near, power) // 1
            if over_power(far, power) <= digits + 1:
                return ("-" if high < 0 else "") + layout(int(digits), power, "...")
    return "[a number between {} and {}]".format(*outward(low, high))

def within(discrete, extent):
    """The region, if it is not the usual one."""
    if extent == "parameter":
        return " with all |z| < radius" if discrete else " with all Re s < -decay"
    if extent == (1 if discrete else 0):
        return ""
    return f" with all |z| < {exact(extent)}" if discrete else f" with all Re s < {exact(-extent)}"

def at_values(values):
    return ", ".join(f"{name} = {exact(x)}" for name, x in values.items())

def and_with(values):
    return f", with {at_values(values)}" if values else ""

def ranged(name, low, high):
    return (f"{name} in ({exact(low)}, {exact(high)})" if low is not None is not high else
            f"{name} > {exact(low)}" if low is not None else f"{name} < {exact(high)}" if high is not None else name)

def root_counts(inside, on, outside, infinite):
    return f"{inside} roots inside, {on} on the boundary, {outside} outside, {infinite} infinite."

def end_in_words(e, parameter, count):
    """An end of an interval to so many digits, and for an irrational one what it is; None where it is infinite."""
    if e is None or isinstance(e, Fraction):
        return (None if e is None else with_decimal(e, count)), None
    if isinstance(e[0], Fraction):
        return shared_digits(*e, DIGITS), "a dead time with roots on the axis"
    if any(k >> 2 * FIELD for k in e[0]):
        of = "a polynomial over exponentials in 'stable'"
    else:
        powers = ["", f"*{parameter}"]
        of = " + ".join(f"{c}{powers[k] if k < 2 else f'*{parameter}^{k}'}" for k, c in enumerate(e[0].listed(1)) if c)
        of = of.replace("+ -", "- ")
        if len(of) > 200:
            of = f"a polynomial of degree {e[0].degree(1)} in 'stable'"
    return shared_digits(*e[1], count), f"a root of {of}"

def of_intervals(parameter, values, discrete, extent, low, high, stable):
    sentence = f"For all real {ranged(parameter, low, high)}{and_with(values)}, the loop is stable{within(discrete, extent)}"
    pieces, origins = [], []
    ends = [e for interval in stable for e in interval if isinstance(e, Fraction) or e and not isinstance(e[0], Fraction)]
    count = digits_apart([(e, e) if isinstance(e, Fraction) else e[1] for e in ends])
    for interval in stable:
        (lower, below), (upper, above) = (end_in_words(e, parameter, count) for e in interval)
        for number, origin in (lower, below), (upper, above):
            if origin and f"{number} is {origin}" not in origins:
                origins.append(f"{number} is {origin}")
        pieces.append("all of them" if lower is upper is None else f"{parameter} > {lower}" if upper is None else
                      f"{parameter} < {upper}" if lower is None else f"{lower} < {parameter} < {upper}")
    where = f", where {', and '.join(origins)}" if origins else ""
    return f"{sentence} exactly for {' or '.join(pieces)}{where}." if pieces else f"{sentence} nowhere."

# ---------------------------------------------------------------- the parts of a certificate

def integer(text):
    need(isinstance(text, str) and re.fullmatch("-?[0-9]+", text), "not an integer")
    need(len(text.lstrip("-")) <= MAX_DIGITS, "a number has too many digits")
    spend(1, 4 * len(text), 4 * len(text))
    return int(text)

def rational(text):
    need(isinstance(text, str), "not a number")
    top, slash, bottom = text.partition("/")
    d = integer(bottom) if slash else 1
    need(d > 0, "a denominator is not positive")
    return Fraction(integer(top), d)

def name_of(text):
    need(isinstance(text, str) and is_name(text), "not a name")
    return text

def count(number):
    need(type(number) is int, "not a count")
    return number

def items(json_list, kind):
    need(isinstance(json_list, list), "not a list")
    return [kind(item) for item in json_list]

def polynomial(coefficients):
    """In variable 1, the parameter."""
    p = items(coefficients, integer)
    need(not p or p[-1], "a polynomial has a zero at the top")
    need(len(p) <= MAX_DEGREE, "a polynomial has too high a degree")
    return P.of(p, 1)

def pair(json_list):
    ab = items(json_list, rational)
    need(len(ab) == 2 and ab[0] < ab[1], "not a pair in order")
    return ab

def parts(json_object, names, optional=()):
    need(isinstance(json_object, dict), "an object is expected")
    need(set(names) <= set(json_object) <= {*names, *optional}, f"the keys are not {', '.join(names)}")
    return [json_object[name] for name in names]

def end(json_value, ring):
    if not isinstance(json_value, dict):
        return None if json_value is None else rational(json_value)
    p, between = parts(json_value, ["polynomial", "between"])
    return ring.read(p), pair(between)

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
    if "\\u" in certificate:
        json.dumps(document, ensure_ascii=False).encode()  # fails where half of a surrogate pair stands alone
    need(depth(document) <= MAX_DEPTH, "nested too deep")
    need(isinstance(document, dict) and document.get("schema") in SCHEMAS, "unknown schema")
    return document

SCHEMAS = [f"jurist/certificate/{version}" for version in range(1, 12)]
RATIONAL, WITH_SYMBOLS, WITH_DEAD_TIME, OF_BOXES, OF_MAPS, OF_CELLS, OF_MAPS_BY_BOXES, OF_BOXES_WITH_SYMBOLS, BY_ENCLOSURES, FOR_ALL, OF_GAINS = SCHEMAS
FURTHER = ["bits", "symbols", "modes"]

def table_of(document):
    """The symbols, if the certificate has any; and the keys for them."""
    if document["schema"] not in (WITH_SYMBOLS, OF_BOXES_WITH_SYMBOLS):
        return None, []
    return Table(*(document[key] for key in FURTHER)), FURTHER

# ---------------------------------------------------------------- the check

def has_several_rates(model):
    blocks = Model(model).root.get("block", [])
    return isinstance(blocks, list) and any(type(block) is dict and str(block.get("every", 1)) != "1" for block in blocks)

def check(model, certificate):
    """The proved statement as a sentence; raises an exception if it is not proved."""
    document = read(certificate)
    statement = document["statement"]
    kind, time, values, region = (statement[key] for key in ("kind", "time", "set", "region"))
    kinds = {OF_BOXES: ["tolerance"], OF_MAPS: ["map"], OF_CELLS: ["cells", "verdict"], OF_MAPS_BY_BOXES: ["boxes"],
             OF_BOXES_WITH_SYMBOLS: ["tolerance"], BY_ENCLOSURES: ["verdict"], FOR_ALL: ["for_all"], OF_GAINS: ["tune"]}
    need(kind in kinds.get(document["schema"], ["intervals", "verdict"]), "unknown kind of statement")
    need(time in ("discrete", "continuous"), "unknown time")
    discrete = time == "discrete"
    values = {name_of(name): rational(x) for name, x in values.items()}
    [extent] = parts(region, ["radius" if discrete else "decay"])
    extent = "parameter" if extent == "parameter" else rational(extent)
    need(not discrete or extent == "parameter" or extent > 0, "the radius is not positive")
    if has_several_rates(model):
        need(extent == 1 and document["schema"] in (RATIONAL, WITH_SYMBOLS, OF_MAPS_BY_BOXES, BY_ENCLOSURES, FOR_ALL, OF_GAINS),
             "a loop of several rates has certificates of stability without further wishes alone")
    if kind == "tolerance":
        return check_tolerance(model, document, statement, values, discrete, extent)
    if kind == "boxes":
        return check_boxes(model, document, statement, values, discrete, extent)
    if kind == "for_all":
        return check_for_all(model, document, statement, values, discrete, extent)
    if kind == "tune":
        return check_gains(model, document, statement, values, discrete, extent)
    if kind == "map":
        return check_map(model, document, statement, values, discrete, extent)
    if document["schema"] == OF_CELLS:
        need(not discrete, "unknown kind of statement")
        return check_cells(model, document, statement, values, extent)
    if document["schema"] == WITH_DEAD_TIME:
        need(kind == "intervals" and not discrete, "unknown kind of statement")
        return check_windows(model, document, statement, values, extent)
    if kind == "verdict":
        return check_verdict(model, document, statement, values, discrete, extent)
    symbols, further = table_of(document)
    ring = OverSymbols(symbols) if symbols else Exact()
    names = ["schema", "statement", "characteristic", "boundary", "factors", "line"]
    _, _, characteristic, boundary, factors, line, *_ = parts(document, names + further, ["model"])
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
    claimed = items(claimed, lambda interval: [end(e, ring) for e in parts(interval, ["lower", "upper"])])
    is_discrete, n, d, poles, doubled = characteristic_polynomial(model, None if relative else parameter, values, symbols)
    need(is_discrete == discrete, "the model's time is another")
    d, n, _ = the_given(characteristic, in_region(d, discrete, extent), ring, symbols, n, doubled)
    certain, identity, nowhere = boundaries(d, n, discrete, poles, boundary, ring)
    factors = items(factors, ring.read)
    if nowhere:
        need(factors == line == claimed == [], "the loop is stable nowhere")
    else:
        need(all(f.degree(1) for f in factors), "factors: one is constant")
        for p in certain + ([identity["value"]] if identity else []):
            for f in factors:
                while p.degree(1) and (quotient := p.primitive() / f.primitive()) is not None:
                    p = quotient
            for f in factors if doubled and not symbols else []:  # divisors are squares of moduli then
                while p.degree(1) and (common := p.common(f)).degree(1):
                    p = p.primitive() / common
            need(ring.is_unit(p), "factors: a boundary polynomial is not a product of them")
        found = walk(d, n, discrete, certain, identity, factors, line, low, high, ring)
        need(found == claimed, "stable: the claimed set is not the one that the line shows")
    return of_intervals(parameter, values, discrete, extent, low, high, claimed)

def the_given(characteristic, own, ring, symbols, n, doubled):
    """The characteristic polynomial of the certificate, which is the model's own, or the root of a doubled one; its degree; whether it is doubled."""
    given = items(characteristic, ring.read)
    is_root = doubled and len(given) != len(own)
    whole = squared(given) if is_root else given
    if symbols:
        same_over_symbols(whole, own)
    else:
        need(whole == own or is_root and [-c for c in whole] == own, "characteristic: not that of the model")
    return (given, n // 2, False) if is_root else (given, n, doubled)

def squared(p):
    out = [ZERO] * max(2 * len(p) - 1, 0)
    for i, x in enumerate(p):
        for k, y in enumerate(p):
            out[i + k] = out[i + k] + x * y
    return out

def half_of(counts):
    need(all(k % 2 == 0 for k in counts), "internal: a doubled polynomial has an odd number of roots")
    return [k // 2 for k in counts]

def boundaries(d, n, discrete, poles, boundary, ring):
    """The polynomials at whose zeros the loop is not stable, the identity, whether the loop is stable nowhere."""
    certain = poles + [d[n] if d else ZERO]
    if n > 0 and d:
        for x in (1, -1) if discrete else (0,):
            certain.append(sum((c * number(x ** k) for k, c in enumerate(d)), ZERO))
    if n < 2 or not all(certain):
        need(boundary is None, "boundary: must be null")
        return certain, None, not all(certain)
    u, v, result = parts(boundary, ["u", "v", "value"])
    u, v, result = items(u, ring.read), items(v, ring.read), ring.read(result)
    a, b, degree_a, degree_b = half_size_pair(d, discrete)
    need(len(u) <= degree_b and len(v) <= degree_a, "boundary: a cofactor's degree is too high")
    need(any(map(ring.is_nonzero, u + v)), "boundary: both cofactors are zero")
    left = [sum((c * Z ** k for k, c in enumerate(p)), ZERO) for p in (u, v)]
    need(left[0] * a + left[1] * b == result, "boundary: the identity does not hold")
    return certain, {"u": u, "v": v, "value": result}, not result

def walk(d, n, discrete, certain, identity, factors, line, low, high, ring):
    """The stable intervals that the line from `low` to `high` shows."""
    def none_between(a, b):
        return all(ring.descartes(f, a, b) == 0 for f in factors)

    def domain_end(x):
        return {"end": x, "left": x, "right": x, "regular": False, "factor": None, "touch": None}

    def point(item):
        touch = item.get("touch")
        if touch is not None:
            need(isinstance(touch, list) and len(touch) == 2 and touch[0] in ("u", "v"), "line: bad touch")
            count(touch[1])
        if "at" in item:
            x = rational(parts(item, ["at"], ["touch"])[0])
            need(any(ring.vanishes(f, x) for f in factors), "line: no factor vanishes at 'at'")
            return domain_end(x) | {"touch": touch}
        between, k = parts(item, ["between", "factor"], ["touch"])
        (a, b), k = pair(between), count(k)
        need(k < len(factors), "line: there is no such factor")
        for i, f in enumerate(factors):
            need(not ring.vanishes(f, a) and not ring.vanishes(f, b), "line: a factor vanishes at an end of 'between'")
            need(ring.descartes(f, a, b) == (i == k), "line: 'between' is not shown to hold just one root")
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
        need(not any(ring.vanishes(f, x) for f in factors for x in split), "line: a factor vanishes at a split point")
        need(left is None or left < s or left == s and before["regular"], "line: the sample is outside")
        need(right is None or s < right or s == right and after["regular"], "line: the sample is outside")
        need(ring.is_stable(d, n, discrete, s) == stable, "line: at a sample the verdict is wrong")
        return stable

    def excluded(p):
        """The loop is undefined there, loses degree, or has a root on the boundary or a pair of mirror images."""
        x, f, touch = p["end"], p["factor"], p["touch"]
        vanishes = (lambda g: g.primitive() / f.primitive() is not None) if f else (lambda g: ring.vanishes(g, x))
        if any(map(vanishes, certain)):
            return True
        if identity is None or touch is None or not vanishes(identity["value"]):
            return False
        w = dict(enumerate(identity[touch[0]])).get(touch[1])  # not zero there: Theorem 2
        if f and w and not w.degree(1):
            return ring.is_nonzero(w)
        return bool(w) and (ring.descartes(w, p["left"], p["right"]) == 0 if f else not ring.vanishes(w, x))

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

def places_by_enclosures(model, values, extent, bits):
    """The degree, and how many roots are inside and outside; none is on the boundary, and none at infinity."""
    sources, models = Moving(), Models(1, bits, 0)
    is_discrete, d, divisors, doubled = over_box(model, [], values, sources, ([], bits))
    need(is_discrete and not any(name == "delay" for name, *_ in sources.sources), "the model's time is another")
    known = sources.values([], models)

    def number(p):
        f = sources.at(p, known, models)
        return f[0][0] - beside_constant(f), f[0][0] + beside_constant(f)

    need(all(any(0 < low or high < 0 for low, high in map(number, ways)) for ways in divisors), "a divisor is not shown to be other than zero")
    inside = OverSymbols(Table(bits)).inside([number(c) for c in in_region(d, True, extent)], False)
    counts = [len(d) - 1, inside, len(d) - 1 - inside]
    return half_of(counts) if doubled else counts

def check_verdict(model, document, statement, values, discrete, extent):
    if document["schema"] == BY_ENCLOSURES:
        _, _, bits = parts(document, ["schema", "statement", "bits"], ["model"])
        need(64 <= count(bits) <= 1024, "bits: out of range")
        need(extent != "parameter" and discrete, "the region has no parameter here, or the time is continuous")
        n, inside, outside = places_by_enclosures(model, values, extent, bits)
        return said_of_verdict(statement, values, discrete, extent, ["unstable" if outside else "stable", n, inside, 0, outside, 0])
    symbols, further = table_of(document)
    ring = OverSymbols(symbols) if symbols else Exact()
    _, _, characteristic, *_ = parts(document, ["schema", "statement", "characteristic"] + further, ["model"])
    need(extent != "parameter", "the region has no parameter here")
    is_discrete, n, d, poles, doubled = characteristic_polynomial(model, None, values, symbols)
    need(is_discrete == discrete, "the model's time is another")
    d, n, doubled = the_given(characteristic, in_region(d, discrete, extent), ring, symbols, n, doubled)
    p = d if symbols else P.of([c.get(0, 0) for c in d]).listed(0)
    if symbols:
        inside, on, outside = ring.places(d, poles)
    else:
        inside, on, outside = places(p, discrete) if p else (0, 0, 0)
    infinite = n - (inside + on + outside) if all(poles) else 0
    found = "unstable" if outside + infinite or not p else "marginal" if on else "stable"
    counts = [n, inside, on, outside, infinite]
    return said_of_verdict(statement, values, discrete, extent,
                           [found if all(poles) else "undefined", *(half_of(counts) if doubled else counts)])

def said_of_verdict(statement, values, discrete, extent, found):
    """The sentence, if the statement is what was found."""
    names = ["verdict", "degree", "inside", "on", "outside", "infinite"]
    name, *counts = parts(statement, names, ["kind", "time", "set", "region"])
    need([name, *map(count, counts)] == found, f"stable: it is {dict(zip(names, found))}")
    at = f"At {at_values(values)}, the" if values else "The"
    if name == "undefined":
        return f"{at} loop is undefined."
    return f"{at} loop is {name}{within(discrete, extent)}: {root_counts(*found[2:])}"


# Whatever is wrong in a certificate or a model ends in one of these; the check itself has no other way out.
FAILURES = (ArithmeticError, AttributeError, LookupError, MemoryError, RecursionError, Rejected, TypeError, ValueError)

def judge(model, certificate):
    """Whether the certificate is accepted, and the statement or the reason."""
    global spent, most
    spent, most = 0, MAX_WORK + WORK_OF_BYTE * len((model + certificate).encode(errors="replace"))
    try:
        return True, check(model, certificate)
    except FAILURES as error:
        return False, reason_of(error)

def reason_of(error):
    """For people; which exception it was says more than its own words where these are not the check's."""
    if isinstance(error, Refused):
        return f"refused: {error}"
    if isinstance(error, Rejected):
        return str(error)
    if isinstance(error, MemoryError):
        return "refused: the check takes too much memory"
    if isinstance(error, RecursionError):
        return "nested too deep"
    return f"a part of the certificate or of the model has not its form ({type(error).__name__}: {str(error)[:80]})"

def give_up(*_):
    raise Refused(f"the check takes longer than {SECONDS} s")

def one_line(text):
    text = CONTROL.sub(" ", text)
    return text[:40] + "..." if len(text) > 100 else text.strip(BLANKS)

def fnv1a64(text):
    digest = 0xcbf29ce484222325
    for byte in text.encode():
        digest = (digest ^ byte) * 0x100000001b3 % (1 << 64)
    return f"{digest:016x}"

def loop_alone(text):
    """The text without the sections `[[expect]]`, `[ship]` and `[tune]`: their lines from the one in brackets to the next that begins with another `[`."""
    kept, left_out = [], False
    for line in re.findall(r"[^\n]*\n|[^\n]+", text):
        start = line.lstrip(" \t")
        if start.startswith("["):
            left_out = start.lstrip("[").startswith(("expect", "ship", "tune"))
        if not left_out:
            kept.append(line)
    return "".join(kept)

def report(sentence, model, certificate, names):
    """The statement, the names and SHA-256 of both texts, the version of the checker, and a remark if the certificate names another text."""
    title = one_line(Model(model).root.get("title", ""))
    title = f", '{title}'" if title else ""
    of_model, of_certificate = (hashlib.sha256(text.encode()).hexdigest() for text in (model, certificate))
    lines = [f"proved: {sentence}", f"model: {one_line(names[0])}{title}, SHA-256 {of_model}",
             f"certificate: {one_line(names[1])}, SHA-256 {of_certificate}", f"checked by: check.py {VERSION}"]
    about = json.loads(certificate).get("model")
    digest = about.get("digest") if isinstance(about, dict) else None
    kind, _, digest = digest.partition(":") if isinstance(digest, str) else ("", "", "")
    own = {"sha256": lambda: hashlib.sha256(loop_alone(model).encode()).hexdigest(), "fnv1a64": lambda: fnv1a64(model)}.get(kind)
    if own and own() != digest:
        lines.append("note: the certificate was written for another text of a model; what it proves of this one stands above")
    return "\n".join(lines)

def main():
    if len(sys.argv) != 3:
        sys.exit("usage: check.py MODEL CERTIFICATE")
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, give_up)
        signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        texts = [open(name, encoding="utf-8", newline="").read(MAX_TEXT + 1) for name in sys.argv[1:]]
    except (OSError, UnicodeDecodeError) as error:
        accepted, sentence = False, str(error)
    else:
        accepted, sentence = judge(*texts)
    if accepted:
        print(report(sentence, *texts, sys.argv[1:]))
    else:
        print(sentence if sentence.startswith("refused: ") else f"rejected: {sentence}", file=sys.stderr)
    sys.exit(0 if accepted else 4)


if __name__ == "__main__":
    main()
