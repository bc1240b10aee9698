#!/usr/bin/env python3
"""Certificates for all values (`jurist/certificate/10`), as `check.py` reads them: margins known by hand, forgeries, and random changes whose truth
is sampled.

    python3 crates/check/tests/for_all.py          JURIST_THOROUGH=1 tries all cases, FOR_ALL_CHANGES=5000 looks at so many changes, FOR_ALL_SEED begins elsewhere
    python3 crates/check/tests/for_all.py write FOLDER          writes the certificates that are changed, and their models
"""
import cmath
import json
import math
import os
import random
import sys
import unittest
from fractions import Fraction
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.dont_write_bytecode = True
import check

U = {"signal": "u"}
IS_THOROUGH = "JURIST_THOROUGH" in os.environ

# ---------------------------------------------------------------- models

def siso(time, controller, plant, parameters="K", more="", behind=""):
    """A loop of two blocks, `c` from the error to u and `p` from u to y."""
    parameters = "\n".join(f"{name} = {{}}" for name in parameters.split())
    return (f'time = "{time}"\n{more}\n[parameters]\n{parameters}\n[loop]\ninputs = ["r"]\n[[block]]\nname = "c"\ninput = "r - y"\noutput = "u"\n'
            f'transfer = "{controller}"\n[[block]]\nname = "p"\ninput = "u"\noutput = "y"\ntransfer = "{plant}"\n{behind}')

def held(plant, parameters="K T"):
    return siso("discrete", "K", plant, parameters, 'sample_time = "T"', 'discretize = "zoh"')

def time_of(model):
    return "discrete" if model.startswith('time = "discrete"') else "continuous"

# ---------------------------------------------------------------- certificates

def statement(model, axes=(), for_all=(), values={}, require=(), tree="?", beyond=None, region=None):
    def ranges(of):
        return [{"name": name, "between": [str(low), str(high)]} for name, low, high in of]
    discrete = time_of(model) == "discrete"
    return {"kind": "for_all", "time": time_of(model), "axes": ranges(axes), "for_all": ranges(for_all),
            "set": {name: str(x) for name, x in values.items()}, "region": region or ({"radius": "1"} if discrete else {"decay": "0"}),
            "require": list(require), "tree": tree, "beyond": beyond}

def document(model, order=3, bits=128, **of):
    return {"schema": "jurist/certificate/10", "statement": statement(model, **of), "order": order, "bits": bits}

def require(kind, bound, at=U):
    out = {"kind": kind, "at": at, "bound": str(bound)}
    if kind == "phase_margin":
        t = math.tan(math.radians(float(Fraction(bound))) / 2)
        out["turns"] = [str(Fraction(t * k).limit_denominator(10 ** 12)) for k in (1 - 1e-9, 1 + 1e-9)]
    return out

def loops_of(model, of):
    """The judges of a certificate, and the sides of all names of the model."""
    check.spent, check.most = 0, 10 ** 15
    claim = of["statement"]
    ranges = [check.ranges_of(claim[key]) for key in ("axes", "for_all")]
    names, sides = [name for r in ranges for name in r], [side for r in ranges for side in r.values()]
    values = {name: Fraction(x) for name, x in claim["set"].items()}
    [extent], discrete = map(Fraction, claim["region"].values()), claim["time"] == "discrete"
    cuts = [check.Cut(item, claim["time"] == "discrete") for item in claim["require"]] or [None]
    return [(cut, check.judge_of(model, names, values, sides, (discrete, extent), (of["order"], of["bits"]), cut)) for cut in cuts], sides

def strongest(judge, box):
    """The side along which the functions change most; None where they are not known."""
    known = judge.functions.at(box) if isinstance(judge, check.Judge) else None
    if not known:
        return None
    places = [[k for k, e in enumerate(judge.models.exponents) if e[i]] for i in range(len(box))]
    changes = [sum(sum(abs(f[0][k]) for k in own) / (abs(f[0][0]) + 1) for f in known[:judge.n + 1]) for own in places]
    return changes.index(max(changes)) if any(changes) else None

def proof_of(judge, box, most=3000):
    """A PROOF that halves the side that matters most, or all in turn; None where it grows too long."""
    out, todo = [], [(box, None, [0] * len(box))]
    while todo:
        box, known, halvings = todo.pop()
        if len(out) > most:
            return None
        if not judge.nowhere and judge.shows(box, known, False, True):
            out.append(".")
            continue
        axis = strongest(judge, box)
        if axis is None:
            axis = min(((k, i) for i, k in enumerate(halvings) if box[i][0] < box[i][1]), default=(0, None))[1]
        if axis is None or halvings[axis] > 30:
            return None
        out.append("abcdefgh"[axis])
        after = [k + (i == axis) for i, k in enumerate(halvings)]
        todo += [(half, part, after) for half, part, _ in judge.halves(box, known, False, axis)][::-1]
    return "".join(out)

def sides_of(cut, refuting=False):
    return cut.sides(cut.is_real, refuting) if cut else []

def good(model, of):
    """The tree of one leaf `+`, or None."""
    loops, sides = loops_of(model, of)
    proofs = [proof_of(judge, box) for cut, judge in loops for box in (cut.boxes(sides, judge) if cut else [sides])]
    return None if None in proofs else "+" + "".join(proofs)

def step_to(axis, share):
    """The steps to a point of a side: an end, or a binary fraction of it."""
    if share in (0, 1):
        return "<>"[int(share)] + "abcdefgh"[axis]
    steps, low, high = "", Fraction(0), Fraction(1)
    while share != (low + high) / 2:
        middle = (low + high) / 2
        low, high, letter = (low, middle, "l") if share < middle else (middle, high, "u")
        steps += letter + "abcdefgh"[axis]
    return steps + "m" + "abcdefgh"[axis]

def bad(model, of, axes=0, points=64):
    """The tree of one leaf `-` at one point of all names that are no axes, or None."""
    loops, sides = loops_of(model, of)
    for i, (cut, judge) in enumerate(loops):
        box, own = sides + sides_of(cut, True), len(sides_of(cut))
        for k in range(-1, points + 1):
            shares = [Fraction(k % 2)] * (len(sides) - axes)
            share = min(max(Fraction(k, points), 0), 1)
            for first in ((0, 1) if own == 2 else (None,)):
                whole = shares + ([first] if own == 2 else []) + [share] * (own > 0)
                part = box[:axes] + [[low + x * (high - low)] * 2 for x, (low, high) in zip(whole, box[axes:])]
                if judge.nowhere or judge.shows(part, None, False, False):
                    return f"-{i}" + "".join(step_to(axes + j, x) for j, x in enumerate(whole)) + "."
    return None

def judged(model, of):
    return check.judge(model, json.dumps(of))

def with_tree(of, tree):
    return {**of, "statement": {**of["statement"], "tree": tree}}

class Case(unittest.TestCase):
    def accept(self, model, of, says=""):
        accepted, said = judged(model, of)
        self.assertTrue(accepted, said)
        self.assertIn(says, said)
        return said

    def reject(self, model, of, says=""):
        accepted, said = judged(model, of)
        self.assertFalse(accepted, said)
        self.assertIn(says, said)

    def assert_good(self, model, **of):
        own = document(model, **of)
        tree = good(model, own)
        self.assertIsNotNone(tree, own)
        self.accept(model, with_tree(own, tree))

    def assert_bad(self, model, **of):
        """At one point of the ranges; and the whole is not accepted as good, in one part or halved along each name."""
        own = document(model, **of)
        tree = bad(model, own)
        self.assertIsNotNone(tree, own)
        self.accept(model, with_tree(own, tree))
        for proof in (".", "a..", "b..", "ab..b..", "ab..b..".replace("b", "aa...")):
            self.reject(model, with_tree(own, "+" + proof))

    def around(self, model, kind, value, met="below", share=Fraction(1, 1000), at=U, **of):
        for k, is_met in ((-1, met == "below"), (1, met == "above")):
            wish = require(kind, Fraction(value).limit_denominator(10 ** 7) * (1 + k * share), at)
            (self.assert_good if is_met else self.assert_bad)(model, require=[wish], **of)

# ---------------------------------------------------------------- what is known by hand

class KnownMargins(Case):
    def test_continuous(self):
        # |L| = 1 at w = 3/4.
        self.around(siso("continuous", "K", "1/(s*(s+1))"), "phase_margin", 90 - math.degrees(math.atan(0.75)), values={"K": "15/16"})
        self.around(siso("continuous", "K", "1/(s+1)^3"), "gain_margin", 2, values={"K": 4})
        unstable = siso("continuous", "K", "1/((s-1)*(s/10+1))")
        places = (U, {"signal": "y"}, {"input": "c"}, {"input": "p"}, {"parameter": "K"})
        for at in places if IS_THOROUGH else places[3:]:
            self.around(unstable, "gain_margin", 2, values={"K": 2}, at=at)  # it is stable for K > 1
            self.around(unstable, "modulus_margin", Fraction(9, 11), values={"K": 2}, at=at)
        lag = siso("continuous", "K", "1/(s-1)")
        self.around(lag, "disk_margin", 1, values={"K": 3})  # 2 |s + 2|/|s - 4|
        self.around(lag, "complementary_peak", 1.5, "above", values={"K": 3})  # 3/|s + 2|
        self.around(siso("continuous", "K", "1/(s+2)"), "complementary_peak", Fraction(1, 3), "above", values={"K": 1})

    def test_discrete(self):
        for model, values in ((siso("discrete", "K", "1/(z-1)"), {"K": "1/2"}), (held("1/s"), {"K": "1/2", "T": 1})):
            self.around(model, "gain_margin", 4, values=values)
            self.around(model, "modulus_margin", 0.75, values=values)
            self.around(model, "phase_margin", 90 - math.degrees(math.asin(0.25)), values=values)  # |z - 1| = 1/2
        e = math.exp(-1)
        for plant, at in (("1/(s+1)", U), ("1/(s+1)", {"parameter": "K"})):
            self.around(held(plant), "modulus_margin", 2 * e / (1 + e), values={"K": 1, "T": 1}, at=at)
        inside = siso("discrete", "1", "K/(s+1)", "K T", 'sample_time = "T"', 'discretize = "zoh"')
        self.around(inside, "modulus_margin", 2 * e / (1 + e), values={"K": 1, "T": 1}, at={"parameter": "K"})

    def test_dead_time(self):
        model = siso("continuous", "K", "exp(-tau*s)/s", "K tau")
        of = {"values": {"K": 1, "tau": "1/2"}, "order": 1}
        self.around(model, "gain_margin", math.pi, **of)
        self.around(model, "phase_margin", 90 - math.degrees(0.5), **of)
        least = min(abs(1 + cmath.exp(-0.0005j * w) / (0.001j * w)) for w in range(100, 10000))
        self.around(model, "modulus_margin", least, share=Fraction(1, 50), **of)

    def test_complex(self):
        turned = siso("continuous", "K", "(1+j/10)/(s-1)")
        self.around(turned, "phase_margin", math.degrees(math.atan(math.sqrt(9.09 - 1)) - math.atan(0.1)), values={"K": 3})
        model = siso("continuous", "K", "1/(s-1-2*j)")
        self.around(model, "complementary_peak", 1.5, "above", share=Fraction(1, 100), values={"K": 3})
        self.around(model, "disk_margin", 1, share=Fraction(1, 100), values={"K": 3})
        self.around(model, "gain_margin", 3, values={"K": 3})
        # Of a complex loop t = -1/2 is not t = 1/2: the loop is stable for factors that turn one way.
        one_way = siso("continuous", "1", "(1 - j*K)/(s+1/10)")
        self.assert_good(one_way, values={"K": 1}, require=[require("phase_margin", 44)])
        self.assert_bad(one_way, values={"K": 8}, require=[require("phase_margin", 44)])
        mirrored = siso("continuous", "1", "(1 + j*K)/(s+1/10)")
        self.assert_bad(mirrored, values={"K": 8}, require=[require("phase_margin", 44)])

    def test_a_signal_has_its_factor_wherever_it_is_used(self):
        two = ('time = "continuous"\n[parameters]\nK = {}\n[loop]\n[[block]]\ninput = "-y - v"\noutput = "u"\ngain = "K"\n'
               '[[block]]\ninput = "u"\noutput = "y"\ntransfer = "1/(s+1)"\n[[block]]\ninput = "u"\noutput = "v"\ntransfer = "2/(s+1)"\n')
        self.around(two, "complementary_peak", Fraction(3, 4), "above", values={"K": 1})
        self.around(two, "complementary_peak", Fraction(1, 4), "above", at={"signal": "y"}, values={"K": 1})  # K/(s + 1 + 3 K)
        own = ('time = "continuous"\n[parameters]\nK = {}\n[loop]\n[[block]]\nname = "b"\ninput = "-K*y + 2*y"\noutput = "y"\ntransfer = "1/(s+1)"\n')
        # 1/(s + 1) times (K - 2) f: T = (K - 2)/(s + K - 1).
        for at in ({"signal": "y"}, {"input": "b"}):
            self.around(own, "complementary_peak", Fraction(3, 4), "above", at=at, values={"K": 5})
        # At K alone 2 y stays: K f/(s - 1).
        self.around(own, "complementary_peak", Fraction(5, 4), "above", at={"parameter": "K"}, values={"K": 5})

    def test_several_rates(self):
        model = ('time = "discrete"\n[parameters]\nK = {}\n[loop]\n[[block]]\ninput = "-y"\noutput = "u"\ngain = "K"\nevery = 2\n'
                 '[[block]]\ninput = "u"\noutput = "y"\ntransfer = "1/(z-1)"\n')
        self.around(model, "gain_margin", 2, values={"K": "1/2"})  # w = 1 - 2 K
        self.assert_good(model, for_all=[("K", "1/10", "9/10")])
        own = document(model, for_all=[("K", "1/10", "9/10")], tree="+.", beyond={"point": ["3/2"], "not": "0."})
        self.accept(model, own, "At K = 3/2, it is not.")
        self.reject(model, document(model, values={"K": "1/2"}, require=[require("phase_margin", 10)], tree="+."), "several rates")
        # What is known of a function over the window is not known beyond it: w = 1 - 2 K exp(b).
        model = model.replace("K = {}", "K = {}\nb = {}").replace('gain = "K"', 'gain = "K*exp(b)"')
        for point, judge in (("1", self.accept), ("-3", self.reject)):
            judge(model, document(model, for_all=[("b", 0, "1/100")], values={"K": 2}, tree="-0.", beyond={"point": [point], "not": "0."}))
        # Two names that are left in the determinant, and one with a value in a function.
        model = model.replace('transfer = "1/(z-1)"', 'transfer = "c/(z-c^2)"').replace("K = {}", "K = {}\nc = {}")
        for c, tree in ((["1/2", "3/4"], "+"), (["2", "9/4"], "-0.")):  # w = c^4 - (1 + c^2) c K exp(b)
            of = {"axes": [("K", "1/8", "1/4")], "for_all": [("b", 0, 0), ("c", *c)]}
            tree = good(model, document(model, **of)) if tree == "+" else tree
            self.accept(model, document(model, tree=tree, **of))
            self.reject(model, document(model, tree="+." if tree[0] == "-" else "-0.", **of))

    def test_several_rates_where_a_function_has_no_value(self):
        """What is not known over the window was an exception of its own, which nobody caught."""
        model = ('time = "discrete"\nsample_time = "T"\n[parameters]\nK = {}\nT = {}\n[loop]\n[[block]]\ninput = "-y"\noutput = "u"\ngain = "K"\nevery = 2\n'
                 '[[block]]\ninput = "u"\noutput = "y"\ntransfer = "1/(s+1)"\ndiscretize = "zoh"\n')
        of = {"for_all": [("K", "1/4", "1/2"), ("T", 1, 1)]}
        self.accept(model, document(model, tree="+.", **of))
        self.reject(model, document(model, tree="+.", beyond={"point": ["1", "-1"], "not": "0."}, **of), "a function is not known")
        for window in (["-1", "1"], ["-1", "-1/2"]):
            self.reject(model, document(model, tree="-0.", for_all=[("K", 1, 2), ("T", *window)]), "a function is not known")
        window = {"x": ["1", "2"], "y": ["-1", "1"]}
        boxes = {"kind": "boxes", "time": "discrete", "x": "K", "y": "T", "set": {}, "region": {"radius": "1"}, "window": window, "tree": "-"}
        self.reject(model, {"schema": "jurist/certificate/7", "statement": boxes, "order": 3, "bits": 128}, "a function is not known")

# ---------------------------------------------------------------- boxes

class Boxes(Case):
    def test_axes_and_three_names(self):
        model = siso("continuous", "K", "1/((s+a)*(s+b)*(s/4+1))", "K a b c")
        of = {"axes": [("K", "1/2", 1)], "for_all": [("a", 1, "5/4"), ("b", 1, "5/4"), ("c", 0, 1)], "require": [require("modulus_margin", "1/3")]}
        own = document(model, **of)
        tree = good(model, own)
        self.accept(model, with_tree(own, tree), "For K from 1/2 to 1, for all a from 1 to 5/4 and b from 1 to 5/4 and c from 0 to 1, the loop is stable, "
                    "with a modulus margin of at least 1/3 at u, for 1/2 <= K <= 1. Nothing is said of the rest.")
        wide = document(model, **of | {"axes": [("K", 0, 200)]})
        tree = "a?" + bad(model, document(model, **of | {"axes": [("K", 100, 200)]}), axes=1)
        self.accept(model, with_tree(wide, tree), "the loop is not stable with a modulus margin of at least 1/3 at u, for any value in 100 <= K <= 200.")
        self.reject(model, with_tree(wide, tree[1:] + "?"))

    def proofs(self, model, of):
        """Of each box of a leaf `+` of the one requirement; None where none is found."""
        [(cut, judge)], sides = loops_of(model, of)
        return [proof_of(judge, box, 300) for box in cut.boxes(sides, judge)]

    def test_each_part_of_a_disc_is_needed(self):
        edge = siso("discrete", "K", "(z + 1/100)/(z + 2/100)")  # 1 + L is about a tenth everywhere
        turned = siso("discrete", "1", "K*(z + 1/100)/(z + 2/100) - 1 + j/10")
        third, second = (siso("continuous", "K", p) for p in ("1/(s*(s+1)*(s+2))", "1/(s*(s+1))"))
        two = ("K", "19/10", "21/10")
        for model, name, kind, bad_bound, good_bound, seen in (
                (edge, ("K", "-91/100", "-89/100"), "modulus_margin", "1/2", "1/20", [True, True, False]),
                (turned, ("K", "-1/100", "1/100"), "modulus_margin", "1/2", "1/20", [True, True, False]),
                (third, two, "modulus_margin", "3/5", "1/3", [False, True, True]),
                (second, two, "complementary_peak", "3/2", "8/5", [True, False, True])):
            both = [{"axes": [name]}, {"for_all": [name]}]
            for ranges in both if IS_THOROUGH else both[model is third:][:1]:
                proofs = self.proofs(model, document(model, require=[require(kind, bad_bound)], **ranges))
                self.assertEqual([p is not None for p in proofs], seen)
                for forged in (".", "b..", "c..", "cc...", "a..", ""):
                    tree = "+" + "".join(forged if p is None else p for p in proofs)
                    self.reject(model, document(model, require=[require(kind, bad_bound)], tree=tree, **ranges))
                proofs = self.proofs(model, document(model, require=[require(kind, good_bound)], **ranges))
                self.accept(model, document(model, require=[require(kind, good_bound)], tree="+" + "".join(proofs), **ranges))
                for tree in ("+" + proofs[0] + proofs[1], "+" + "".join(proofs) + ".", "+b.." + proofs[1] + proofs[2], "+" + proofs[0] + proofs[1] + "a.."):
                    self.reject(model, document(model, require=[require(kind, good_bound)], tree=tree, **ranges), "tree")

    def test_divisors_with_the_factor_are_asked_about_over_the_whole_disc(self):
        for divisor, good_parts in (("K - 5/2", [False]), ("K + 9", [True]), ("7", [True] * 3)):  # 5/2 is one of the numbers 2 (1 + 2 d/3)
            model = siso("continuous", "K", "1/(s+1)", "K", f"constants = {{ unused = '1/({divisor})' }}")
            of = document(model, for_all=[("K", "19/10", "21/10")], require=[require("complementary_peak", "3/2", {"parameter": "K"})])
            self.assertEqual([p is not None for p in self.proofs(model, of)], good_parts)

    def test_two_axes(self):
        model = siso("continuous", "K", "1/(s-a)", "K a")
        own = document(model, axes=[("K", 0, 4), ("a", 0, 2)], tree="ab-0.?b+.?")
        self.reject(model, own)
        for tree in ("-0<a.", "-0>b.", "-0mamb."):  # at some of its points only
            self.reject(model, document(model, axes=[("K", 0, 4), ("a", 1, 3)], tree=tree))
        own = document(model, axes=[("K", 0, 4), ("a", 1, 3)], tree="ab??b?b??")
        said = self.accept(model, own)
        self.assertIn("at least 0.0 % and 0.0 % of the window", said)
        own = document(model, axes=[("K", 5, 7), ("a", 1, 3)], for_all=[], tree="ab+.?+.", require=[require("gain_margin", "3/2")])
        self.accept(model, own, "in all boxes '+' of the tree, and nowhere in its boxes '-': at least 75.0 % and 0.0 % of the window.")

    def test_tolerances(self):
        model = siso("continuous", "K", "1/(s-a)", "K a b")
        of = {"for_all": [("K", 3, 4), ("a", 1, 2)], "values": {"b": 1}}
        self.accept(model, document(model, tree="+.", **of), "For all K from 3 to 4 and a from 1 to 2, with b = 1, the loop is stable.")
        self.accept(model, document(model, tree="+.", beyond={"point": ["3", "4"], "not": "0."}, **of), "the loop is stable. At K = 3, a = 4, it is not.")
        self.reject(model, document(model, tree="+.", beyond={"point": ["4", "3"], "not": "0."}, **of), "nowhere stable")
        with_margin = of | {"require": [require("gain_margin", "5/4")]}
        self.accept(model, document(model, tree="+.", beyond={"point": ["3", "5/2"], "not": "0<c."}, **with_margin), "it is not.")
        self.reject(model, document(model, tree="+.", beyond={"point": ["3", "5/2"], "not": "0>c."}, **with_margin))
        wide = of | {"for_all": [("K", 1, 4), ("a", 1, 2)]}
        self.accept(model, document(model, tree="-0<a>b.", **wide), "Not for all K from 1 to 4 and a from 1 to 2, with b = 1, the loop is stable.")
        self.reject(model, document(model, tree="-0>a>b.", **wide))
        self.reject(model, document(model, tree="-0.", **wide))
        # A name of one value.
        self.accept(model, document(model, tree="+.", for_all=[("K", 3, 4), ("a", 1, 1)], values={"b": 1}), "For all K from 3 to 4, with a = 1, b = 1, the loop")

    def test_constants_have_ranges_too(self):
        model = siso("continuous", "K", "1/(s-a)", "K", "constants = { a = 1, unused = 7 }")
        self.accept(model, document(model, tree="+.", for_all=[("K", 3, 4), ("a", 1, 2)], values={"unused": 3}))
        self.accept(model, document(model, tree="+b..", for_all=[("K", 3, 4)], require=[require("gain_margin", 2)]))
        self.around(model, "gain_margin", 2, values={"K": 2}, at={"parameter": "a"})

    def test_boxes_where_a_loop_may_be_undefined_are_not_good(self):
        for divisor in ("K - 3", "1/K - 1/3", "exp(K - 3) - 1"):
            model = siso("continuous", "K", "1/(s+1)", "K", f"constants = {{ unused = '1/({divisor})' }}")
            for wishes, tree in (([], "+."), ([require("modulus_margin", "1/2")], "+b.b..")):
                self.reject(model, document(model, tree=tree, for_all=[("K", 2, 4)], require=wishes))
            self.accept(model, document(model, tree="+.", for_all=[("K", 4, 5)], require=[]))
        # K f is 3 for one of the factors.
        model = siso("continuous", "K", "1/(s+1)", "K", "constants = { unused = '1/(K - 3)' }")
        of = {"values": {"K": 2}, "require": [require("gain_margin", 2, {"parameter": "K"})]}
        self.reject(model, document(model, tree="+.", **of))
        self.accept(model, document(model, tree="+.", **of | {"require": [require("gain_margin", 2)]}))
        model = siso("continuous", "K", "1/(s+1)", "K", "constants = { unused = '1/(K^2 + 9)' }")
        tree = good(model, document(model, values={"K": 2}, require=[require("phase_margin", 80, {"parameter": "K"})]))
        self.assertIsNotNone(tree)
        of = {"values": {"K": 3}, "require": [require("phase_margin", 100, {"parameter": "K"})]}  # (3 f)^2 = -9 for f = j
        self.assertIsNone(good(model, document(model, **of)))

# ---------------------------------------------------------------- forgeries

def changed(of, path, value):
    """A copy with another value at a path of keys; without the key if the value is Ellipsis."""
    if not path:
        return value
    key, *rest = path
    out = list(of) if isinstance(of, list) else dict(of)
    if value is ... and not rest:
        del out[key]
    else:
        out[key] = changed(out[key] if rest else None, rest, value)
    return out

class Forgeries(Case):
    def setUp(self):
        self.model = siso("continuous", "K", "1/((s+a)*(s+1))", "K a b")
        wishes = [require("modulus_margin", "1/2"), require("phase_margin", 45)]
        of = {"axes": [("K", "1/2", 1)], "for_all": [("a", 1, "5/4")], "values": {"b": 2}, "require": wishes}
        self.own = document(self.model, **of)
        self.tree = good(self.model, self.own)
        self.own = with_tree(self.own, self.tree)
        self.accept(self.model, self.own)

    def test_each_part_has_its_form(self):
        s, at = ["statement"], ["statement", "require", 0]
        of_phase = ["statement", "require", 1]
        for path, value in [
            (["schema"], "jurist/certificate/7"), (["schema"], "jurist/certificate/11"), (["order"], 9), (["order"], 0), (["bits"], 63), (["bits"], 1025),
            (s + ["kind"], "boxes"), (s + ["time"], "discrete"), (s + ["region"], {"decay": "1/100"}), (s + ["region"], {"decay": "parameter"}),
            (s + ["set"], {}), (s + ["set"], {"b": "2", "a": "1"}), (s + ["set"], {"b": "2", "x": "1"}), (s + ["set", "b"], "1/0"),
            (s + ["axes", 0, "between"], ["1", "1/2"]), (s + ["axes", 0, "between"], ["1", "1"]), (s + ["axes", 0, "between"], ["1"]),
            (s + ["for_all", 0, "between"], ["5/4", "1"]), (s + ["for_all", 0, "name"], "K"), (s + ["for_all", 0, "name"], "x"), (s + ["for_all"], []),
            (s + ["axes", 0, "name"], "u"), (s + ["axes"], self.own["statement"]["axes"] * 2), (s + ["beyond"], {"point": ["1"], "not": "0."}),
            (s + ["require"], []), (s + ["require"], [self.own["statement"]["require"][0]] * 10),
            (at + ["bound"], "0"), (at + ["bound"], "1"), (at + ["bound"], "-1/2"), (at + ["bound"], "99/100"), (at + ["kind"], "damping"),
            (at + ["at"], {"signal": "x"}), (at + ["at"], {"signal": "r"}), (at + ["at"], {"input": "x"}), (at + ["at"], {"parameter": "x"}),
            (at + ["at"], {"parameter": "u"}), (at + ["at"], {"signal": "K"}), (at + ["at"], {"signal": "u", "input": "c"}), (at + ["at"], {}), (at + ["at"], "u"),
            (at + ["turns"], ["1", "1"]), (of_phase + ["turns"], ...), (of_phase + ["turns"], ["41422/100000", "1/2"]), (of_phase + ["turns"], ["1/3", "41421/100000"]),
            (of_phase + ["turns"], ["1/2", "1/3"]), (of_phase + ["turns"], ["0", "1/2"]), (of_phase + ["turns"], ["-1/3", "1/2"]), (of_phase + ["bound"], "180"),
            (of_phase + ["bound"], "46"), (of_phase + ["bound"], "44"), (s + ["further"], 1), (s + ["beyond"], ...), (s + ["tree"], ["+"]),
        ]:
            self.reject(self.model, changed(self.own, path, value))
        self.accept(self.model, changed(self.own, of_phase + ["turns"], ["1/1000", self.own["statement"]["require"][1]["turns"][1]]))

    def test_trees(self):
        self.assertTrue(self.tree.startswith("+") and self.tree.endswith("."))
        proofs = self.tree[1:]
        for tree in ("", "+", "+" + proofs[:-1], self.tree + "?", self.tree + ".", "a" + self.tree, "b??", "+" + proofs.replace("d", "e", 1), "x??", "+e..", "+c..",
                     "-", "-0", "-0.", "-2.", "-0mc.", "-0la.", "-0ma.", "-0le.", "-0xb.", "-9.", "-0lb", "-1ld.", "--", "+.", "+..", "-0>b.", "-1>b>c.",
                     "a" * 161, "-0" + "lb" * 161 + ".", "?" * 2, "-\u0660.", "+" + "c" * 200):
            self.reject(self.model, with_tree(self.own, tree))
        self.accept(self.model, with_tree(self.own, "a??"), "nothing is said of the loop.")
        self.accept(self.model, with_tree(self.own, "a" * 160 + "?" * 161))

    def test_ninety_degrees(self):
        for turns, fine in ((["1", "1"], True), (["1/2", "1"], True), (["1", "2"], True), (["1000001/1000000", "2"], False), (["1/2", "999999/1000000"], False)):
            item = {"kind": "phase_margin", "at": U, "bound": "90", "turns": turns}
            model = siso("continuous", "K", "1/(s+1)")
            own = document(model, values={"K": "1/2"}, require=[item], tree="?")
            (self.accept if fine else self.reject)(model, own)

    def test_turns_are_compared_exactly(self):
        for bound, places in (("45", 60), ("1/1000", 30), ("17999/100", 30), ("60", 60)):
            check.spent, check.most = 0, 10 ** 15
            bits = 400
            angle = Fraction(bound) / 360
            pi = Fraction(4 * check.inverse_tangent(1 << bits, bits)[0], 1 << bits)
            x = angle * pi
            sine = sum((-1) ** k * x ** (2 * k + 1) / math.factorial(2 * k + 1) for k in range(45))
            cosine = sum((-1) ** k * x ** (2 * k) / math.factorial(2 * k) for k in range(45))
            t = sine / cosine
            below = Fraction(int(t * 10 ** places), 10 ** places)
            above = below + Fraction(1, 10 ** places)
            model = siso("continuous", "K", "1/(s+1)")
            for turns, fine in (([below, above], True), ([above, 2 * above], False), ([below / 2, below], False)):
                item = {"kind": "phase_margin", "at": U, "bound": bound, "turns": [str(x) for x in turns]}
                own = document(model, values={"K": "1/2"}, require=[item], tree="?")
                (self.accept if fine else self.reject)(model, own)

    def test_cuts_that_are_no_factors(self):
        at = {"parameter": "K"}
        for controller in ("K^2", "exp(K)", "conj(K)", "re(K)", "K + im(K*j)", "1/K + K", "sqrt(K)", "exp(j*K)"):
            model = siso("continuous", controller, "1/(s+1)")
            self.reject(model, document(model, values={"K": 1}, require=[require("modulus_margin", "1/100", at)], tree="+."))
        model = held("1/(s+K)")
        self.reject(model, document(model, values={"K": 1, "T": 1}, require=[require("modulus_margin", "1/100", at)], tree="+."))
        self.reject(model, document(model, values={"K": 1, "T": 1}, require=[require("modulus_margin", "1/100", {"parameter": "T"})], tree="+."))
        self.accept(model, document(model, values={"K": 1, "T": 1}, require=[require("gain_margin", "11/10", {"parameter": "T"})], tree="+."))
        model = siso("continuous", "K", "exp(-tau*s)/(s+1)", "K tau")
        self.reject(model, document(model, values={"K": "1/2", "tau": 1}, require=[require("modulus_margin", "1/100", {"parameter": "tau"})], tree="+."))
        matrix = 'time = "continuous"\nparameters.K = {}\n[loop]\nmatrix = [["-K"]]'
        for at in (U, {"input": "c"}):
            self.reject(matrix, document(matrix, values={"K": 1}, require=[require("gain_margin", 2, at)], tree="+."))
        self.around(matrix, "complementary_peak", 1, "above", at={"parameter": "K"}, values={"K": 1}, share=Fraction(1, 50))
        two = self.model.replace('input = "u"\noutput = "y"\ntransfer', 'input = ["u", "u"]\noutput = "y"\nD = [[1, 1]]\n#')
        self.reject(two, document(two, values={"K": 1, "a": 1, "b": 1}, require=[require("gain_margin", 2, {"input": "p"})], tree="+."), "has not one")

    def test_much_work_is_refused(self):
        names = [("K", 1, 2), ("a", 1, 2), ("b", 1, 2), ("c", 1, 2), ("d", 1, 2), ("e", 1, 2)]
        model = siso("continuous", "K", "(s+a)^9*(s+b)^9/((s+c)^9*(s+d)^9*(s+e)^9)", "K a b c d e")
        own = document(model, for_all=names, require=[require("modulus_margin", "1/2")], tree="+" + "c" * 150, order=8, bits=1024)
        self.reject(model, own, "refused: ")
        size = 60  # a matrix behind a hold whose entries are functions: the terms of its determinant took gigabytes
        rows = json.dumps([["a/(K+1)" if i == j else "0" for j in range(size)] for i in range(size)])
        model = siso("discrete", "K", "1", "K a T", 'sample_time = "T"').replace('transfer = "1"', f'A = {rows}\nB = {json.dumps([["1"]] * size)}\n'
                     f'C = {json.dumps([["1"] * size])}\ndiscretize = "zoh"')
        self.reject(model, document(model, for_all=names[:2], values={"T": 1}, tree="+."), "refused: the model has too many functions")

    def test_no_function_is_taken_for_the_imaginary_unit(self):
        """Variables are counted; the 950th is j: x^2 + 1 was 0."""
        window = {"x": ["-1", "1"], "y": ["-1", "1"]}
        boxes = {"kind": "boxes", "time": "discrete", "x": "K", "y": "a", "set": {}, "region": {"radius": "1"}, "window": window, "tree": "+"}
        seven = {"schema": "jurist/certificate/7", "statement": boxes, "order": 3, "bits": 128}
        for count in (10, 946, 947):
            unused = "\n".join(f'c{i} = "exp({i}/1000)"' for i in range(count))
            model = (f'time = "discrete"\n[constants]\n{unused}\n[parameters]\nK = {{}}\na = {{}}\n[loop]\n'
                     'characteristic = "z - 3*(exp(K + a + 7)^2 + 1)"\n')
            self.reject(model, seven)
            for wishes, tree in (([], "+."), ([require("gain_margin", 2, {"parameter": "K"})], "+.")):
                self.reject(model, document(model, for_all=[("K", -1, 1), ("a", -1, 1)], require=wishes, tree=tree))

# ---------------------------------------------------------------- random changes

def roots(c):
    """Of a polynomial with complex coefficients, the constant first [Durand, Kerner]."""
    while c and abs(c[-1]) < 1e-12:
        c = c[:-1]
    n = len(c) - 1
    c = [x / c[-1] for x in c]
    z = [(0.4 + 0.9j) ** k * (1 + max(map(abs, c))) ** 0.5 for k in range(n)]
    for _ in range(200):
        for i in range(n):
            p = 0
            for x in reversed(c):
                p = p * z[i] + x
            q = math.prod(z[i] - z[k] for k in range(n) if k != i)
            z[i] -= p / q if q else 0.01
    return z

class Loop:
    """A loop D = den + f num, whose roots are counted in floating point."""

    def __init__(self, model, den, num, delay=None, starts=()):
        self.model, self.den, self.num, self.delay, self.starts = model, den, num, delay, starts

    def excess(self, x, f):
        """By how much the rightmost root is outside; of a loop with dead time 1 or -1 by the turns along the axis, 0 where that is not clear."""
        den, num = self.den(x), self.num(x)
        size = max(len(den), len(num))
        den, num = ([*c, *[0] * (size - len(c))] for c in (den, num))
        if not self.delay:
            z = roots([a + f * b for a, b in zip(den, num)])
            return max(abs(r) - 1 for r in z) if time_of(self.model) == "discrete" else max(r.real for r in z)
        turns, before, least = 0, None, 1e9
        for k in range(-6000, 6001):
            s = 1j * math.copysign(abs(k / 300) ** 2 / 4, k)
            value = sum((a + f * b * cmath.exp(-self.delay(x) * s)) * s ** i for i, (a, b) in enumerate(zip(den, num))) / (s + 1) ** (size - 1)
            turns += cmath.phase(value / before) if before else 0
            before, least = value, min(least, abs(value))
        return 0 if least < 1e-2 else 1 if round(turns / (2 * math.pi)) else -1

def corpus(every):
    """Loops, and certificates to change; of each loop one requirement, or all."""
    unstable = Loop(siso("continuous", "K", "1/((s-a)*(s/10+1))", "K a"), lambda x: [-x["a"], 1 - x["a"] / 10, 0.1], lambda x: [x["K"]])
    lag = Loop(siso("discrete", "K", "1/((z-1)*(z-b))", "K b"), lambda x: [x["b"], -1 - x["b"], 1], lambda x: [x["K"]])
    e = lambda x: math.exp(-x["a"] * x["T"])
    behind = Loop(held("1/(s+a)", "K T a"), lambda x: [-e(x), 1], lambda x: [x["K"] * (1 - e(x)) / x["a"]])
    turned = Loop(siso("continuous", "K", "(1+j*c)/(s-1)", "K c"), lambda x: [-1, 1], lambda x: [x["K"] * (1 + 1j * x["c"])])
    late = Loop(siso("continuous", "K", "exp(-tau*s)/(s+1)", "K tau"), lambda x: [1, 1], lambda x: [x["K"]], lambda x: x["tau"])
    kinds = [("modulus_margin", "1/3"), ("phase_margin", 30), ("gain_margin", "4/3"), ("disk_margin", "2/5"), ("complementary_peak", 3)]
    for number, (loop, axes, for_all) in enumerate(((unstable, [("K", 3, 4)], [("a", "1/2", 1)]), (lag, [("K", "1/8", "1/4")], [("b", "1/4", "3/8")]),
                                (behind, [("K", "1/4", "1/2"), ("T", "1/2", "3/4")], [("a", 1, 2)]), (turned, [("K", 4, 5)], [("c", "-1/8", "1/4")]),
                                (late, [("K", "1/4", "1/2")], [("tau", "1/2", 1)]))):
        order = 1 if loop.delay else 3
        for i, (kind, bound) in enumerate(kinds):
            if not every and i != number:
                continue
            at = [U, {"signal": "y"}, {"input": "c"}, {"input": "p"}, {"parameter": "K"}][i]
            wishes = [require(kind, bound, at)]
            of = document(loop.model, axes=axes, for_all=for_all, require=wishes, order=order)
            yield loop, with_tree(of, good(loop.model, of))
            of = document(loop.model, axes=[(name, 40 * Fraction(low), 41 * Fraction(high)) for name, low, high in axes[:1]] + axes[1:], for_all=for_all,
                          require=[require(kind, {"modulus_margin": "9/10", "complementary_peak": "1/10"}.get(kind, bound), at)], order=order)
            tree = bad(loop.model, of, len(axes), 8)
            if tree:
                yield loop, with_tree(of, tree)
        of = document(loop.model, for_all=axes + for_all, order=order)
        yield loop, with_tree(of, good(loop.model, of))

NUMBERS = ["0", "1", "2", "1/2", "1/3", "3/2", "3", "4", "8", "1/4", "9/10", "11/10", "20", "45", "60", "89", "-1/2"]

def change(of, draw):
    """One thing at random."""
    own, claim = json.loads(json.dumps(of)), None
    claim = own["statement"]
    kind = draw.randrange(9)
    if kind < 2:
        side = draw.choice(claim["axes"] + claim["for_all"])["between"]
        side[draw.randrange(2)] = draw.choice(NUMBERS)
    elif kind < 4 and claim["require"]:
        item = draw.choice(claim["require"])
        item["bound"] = draw.choice(NUMBERS)
        if item["kind"] == "phase_margin" and draw.random() < 0.8 and 0 < Fraction(item["bound"]) < 180:
            item["turns"] = require("phase_margin", item["bound"])["turns"]
    elif kind == 4 and claim["require"]:
        item = draw.choice(claim["require"])
        item["kind"] = draw.choice(["modulus_margin", "gain_margin", "disk_margin", "complementary_peak"])
        item.pop("turns", None)
    elif kind == 5 and claim["require"] and "turns" in claim["require"][0]:
        claim["require"][0]["turns"][draw.randrange(2)] = draw.choice(NUMBERS)
    elif kind == 6:
        axes, for_all = claim["axes"], claim["for_all"]
        claim["axes"], claim["for_all"] = draw.choice([(for_all, axes), (axes + for_all, []), (axes[::-1], for_all)])
    elif kind == 7:
        own["order"], own["bits"] = draw.choice([1, 2, 3, 4]), draw.choice([64, 65, 128])
    else:
        k, tree = draw.randrange(len(claim["tree"])), claim["tree"]
        claim["tree"] = tree[:k] + draw.choice(["", *"abcd+-?.0<>mlu"]) + tree[k + draw.randrange(2):]
    return own

class Truth:
    """Whether what was accepted is true, by samples: a reader of trees of its own, and factors from their meaning."""

    def __init__(self, loop, of, draw):
        self.loop, self.claim, self.draw, self.at = loop, of["statement"], draw, 0
        self.axes, self.for_all = ([(r["name"], *map(Fraction, r["between"])) for r in self.claim[key]] for key in ("axes", "for_all"))
        self.values = {name: Fraction(x) for name, x in self.claim["set"].items()}
        self.samples, self.wrong = 0, []

    def next(self):
        self.at += 1
        return self.claim["tree"][self.at - 1]

    def point(self, box):
        return {name: float(low + (high - low) * Fraction(self.draw.choice([0, 1, self.draw.random()]))) for name, low, high in box} | {
            name: float(x) for name, x in self.values.items()}

    def factor(self, item):
        if not item:
            return 1
        b, turn = float(Fraction(item["bound"])), cmath.exp(1j * self.draw.uniform(-math.pi, math.pi))
        delta = turn * self.draw.choice([1, self.draw.random()])
        return {"phase_margin": lambda: cmath.exp(1j * math.radians(b) * self.draw.choice([-1, 1, self.draw.uniform(-1, 1)])),
                "gain_margin": lambda: b ** self.draw.choice([-1, 1, self.draw.uniform(-1, 1)]), "modulus_margin": lambda: 1 / (1 - b * delta),
                "disk_margin": lambda: (1 + b / 2 * delta) / (1 - b / 2 * delta), "complementary_peak": lambda: 1 + delta / b}[item["kind"]]()

    def own(self, item, sides):
        """A factor in a part of the ranges of a requirement's names, and whether it is one that the requirement is about."""
        low_high = [low + (high - low) * self.draw.random() for low, high in sides]
        if not item:
            return 1, True
        b, t = float(Fraction(item["bound"])), low_high[-1]
        turn = (1 + 1j * t) / (1 - 1j * t)
        if item["kind"] == "gain_margin":
            return t, 1 / b - 1e-9 <= t <= b + 1e-9
        if item["kind"] == "phase_margin":
            return 1 / turn, abs(cmath.phase(turn)) <= math.radians(b) + 1e-9
        delta = low_high[0] * turn
        f = {"modulus_margin": lambda: 1 / (1 - b * delta), "disk_margin": lambda: (1 + b / 2 * delta) / (1 - b / 2 * delta),
             "complementary_peak": lambda: 1 + delta / b}[item["kind"]]()
        return f, abs(delta) <= 1 + 1e-9

    def is_complex(self):
        return "j*c" in self.loop.model

    def look(self, x, f, stable):
        self.samples += 1
        if any(x.get(name, 1) <= 0 for name in ("T", "tau")):
            excess = 1
        else:
            excess = self.loop.excess(x, f)
        tolerance = 1e-4
        if excess > tolerance if stable else excess < -tolerance:
            self.wrong.append((x, f, stable, excess))

    def check(self, samples):
        stack = [self.axes]
        wishes = self.claim["require"] or [None]
        while stack:
            box, letter = stack.pop(), self.next()
            if letter in "abcdefgh":
                k = "abcdefgh".index(letter)
                name, low, high = box[k]
                stack += [box[:k] + [(name, *side)] + box[k + 1:] for side in (((low + high) / 2, high), (low, (low + high) / 2))]
            elif letter == "+":
                for item in wishes:
                    depth = 1
                    while depth:
                        depth += -1 if self.next() == "." else 1
                    for _ in range(samples):
                        self.look(self.point(box + self.for_all), self.factor(item), True)
            elif letter == "-":
                self.refuted(box, wishes[int(self.next())], samples)
        return self.wrong

    def refuted(self, box, item, samples):
        part = [[low, high] for _, low, high in box + self.for_all]
        whole = -1 if self.is_complex() else 0
        if item and item["kind"] == "gain_margin":
            part.append([1 / Fraction(item["bound"]), Fraction(item["bound"])])
        elif item:
            t = Fraction(item["turns"][0]) if item["kind"] == "phase_margin" else Fraction(1)
            part += ([] if item["kind"] == "phase_margin" else [[Fraction(-1), Fraction(1)]]) + [[whole * t, t]]
        while (step := self.next()) != ".":
            k = "abcdefgh".index(self.next())
            low, high = part[k]
            middle = (low + high) / 2
            part[k] = {"l": [low, middle], "u": [middle, high], "m": [middle] * 2, "<": [low] * 2, ">": [high] * 2}[step]
        names = [name for name, _, _ in box + self.for_all]
        for _ in range(samples):
            x = self.point([(name, *side) for name, side in zip(names, part)])
            f, is_meant = self.own(item, [[float(end) for end in side] for side in part[len(names):]])
            if not is_meant:
                self.wrong.append((x, f, "not a factor of the requirement"))
            self.look(x, f, False)

class Changes(Case):
    def test_what_is_accepted_is_true(self):
        draw, count = random.Random(int(os.environ.get("FOR_ALL_SEED", 20020326))), int(os.environ.get("FOR_ALL_CHANGES", 100 if IS_THOROUGH else 0))
        known, count = list(corpus(count > 0)), count or 30
        self.assertGreater(len(known), 12)
        for loop, of in known:
            self.accept(loop.model, of)
            self.assertEqual(Truth(loop, of, draw).check(1 if loop.delay else 6), [], of)
        accepted = 0
        for _ in range(count):
            loop, of = draw.choice(known)
            for _ in range(draw.choice([1, 1, 2])):
                of = change(of, draw)
            fine, said = judged(loop.model, of)
            if fine:
                accepted += 1
                self.assertEqual(Truth(loop, of, draw).check(1 if loop.delay else 8), [], (said, of))
            else:
                self.assertNotIn("Error", said.replace("ZeroDivisionError", ""), (said, of))
        self.assertGreater(accepted, count // 20)
        print(f"{count} changes, {accepted} accepted and true by samples", file=sys.stderr)

def write(folder):
    for number, (loop, of) in enumerate(corpus(True)):
        (folder / f"for-all-{number}.toml").write_text(loop.model)
        (folder / f"for-all-{number}.10.json").write_text(json.dumps(of, indent=1) + "\n")

if __name__ == "__main__":
    write(Path(sys.argv[2])) if sys.argv[1:2] == ["write"] else unittest.main()
