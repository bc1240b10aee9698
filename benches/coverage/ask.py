"""A question of the table about a random loop: the program's arguments, and what a truth apart says of its document."""

from fractions import Fraction

import numpy as np

import truth

# Requirements in the place of the table's one, which nearly every stable loop meets.
MARGINS = [
    ("modulus_margin", "--modulus-margin", "1/2", 0.5),
    ("phase_margin", "--phase-margin", "40 deg", 40.0),
    ("gain_margin", "--gain-margin", "2", 2.0),
    ("complementary_peak", "--complementary-peak", "3/2", 1.5),
    ("disk_margin", "--disk-margin", "2/3", 2 / 3),
]
DAMPING = ("damping", "--damping", "1/10", 0.1)
DELAY = ("delay_margin", "--delay-margin", "1/20", 0.05)
POINTS = 24


class Wrong(Exception):
    """The document contradicts the truth."""


def arguments(command, loop, r, file):
    """The arguments after the program, and the requirement and the region that they ask for."""
    required, region, out, names, third = None, {}, [], iter("KLKLKL"), False
    words = command.split(" ")
    bound = words[0] == "map"
    for k, word in enumerate(words[1:]):
        if third:
            word, third = "W=1..2:2", False
        elif word == "--modulus-margin":
            required = r.choice(MARGINS)
            out += [required[1], required[2]]
            continue
        elif word == "--damping":
            required = DAMPING
        elif word == "--delay-margin":
            required = DELAY
            out += [required[1], required[2]]
            continue
        elif word in ("1/100", "1/1000"):
            continue
        elif word == "REGION":
            region = {"radius": 0.9} if loop.time == "discrete" else {"decay": 0.01}
            word = "--radius=9/10" if loop.time == "discrete" else "--decay=1/100"
        elif word == "BOUND":
            word = "radius" if loop.time == "discrete" else "decay"
        elif word == "FILE":
            word = file
        elif word in ("INPUT", "OUTPUT"):
            word = "r" if word == "INPUT" else "y"
        elif word == "NAME":
            word = next(names)
            if bound:
                low, high = loop.point[word] / 2, loop.point[word] * 2
                word = f"{word}={low}..{high}"
        elif "NAME" in word:
            word = word.replace("NAME", next(names))
        third = word == "-z"
        out.append(word)
    further = {
        "norm": ["r", "y"],
        "locus": ["--range", f"{loop.point['K'] / 2}..{loop.point['K'] * 2}"],
        "map": ["--undecided", "1/10"],
    }.get(words[0], [])
    head = [words[0], "-"] + (further if words[0] == "norm" else [])
    return head + out + (further if words[0] != "norm" else []), required, region


def floats(point):
    return {name: float(value) for name, value in point.items()}


def number(end):
    """The value of an end, or None where there is none."""
    return None if end is None else float(end["decimal"])


def agree(known, said, what):
    """A known truth and what the document says."""
    if known is not None and bool(known) != bool(said):
        raise Wrong(f"{what}: said {said}, true is {known}")


class Judge:
    """Compares documents about one loop."""

    def __init__(self, loop, r, required, region):
        self.loop, self.r, self.required, self.region = loop, r, required, region

    def good(self, point):
        p = floats({**self.loop.point, **point})
        if self.required:
            return truth.met(self.loop, p, self.required[0], self.required[3])
        return truth.stable(self.loop, p, **self.region)

    def verdict(self, document, _command):
        p = floats(self.loop.point)
        if document["verdict"] in ("stable", "unstable"):
            agree(truth.stable(self.loop, p, **self.region), document["verdict"] == "stable", "verdict")
        for found in document.get("requirements", []):
            if document["verdict"] == "stable":
                agree(truth.met(self.loop, p, self.required[0], self.required[3]), found["met"], found["name"])
        return None

    def intervals(self, document, _command):
        name = document["parameter"]
        if name in ("radius", "decay"):
            return self.bound(document)
        low, high = (float(Fraction(document["domain"][side])) for side in ("lower", "upper"))
        inside = [(number(i["lower"]), number(i["upper"])) for i in document["stable"]]
        inside = [(low if a is None else a, high if b is None else b) for a, b in inside]
        open_ = [[x and float(Fraction(x["exact"] if isinstance(x, dict) else x)) for x in u["enclosure"]] for u in document.get("undecided", [])]
        open_ = [(low if a is None else a, high if b is None else b) for a, b in open_]
        points = [self.r.uniform(low, high) for _ in range(POINTS)]
        # Beside the ends.
        points += [end * (1 + d) for pair in inside for end in pair for d in (-3e-3, 3e-3)]
        for x in points:
            near = any(abs(x - end) < 1e-6 * (1 + abs(x)) for pair in inside + open_ for end in pair)
            if low < x < high and not near and not any(a <= x <= b for a, b in open_):
                agree(self.good({name: x}), any(a < x < b for a, b in inside), f"{name} = {x!r}")
        width = sum(max(min(b, high) - max(a, low), 0) for a, b in open_)
        return "undecided" if width > 1e-3 * (high - low) else None

    def bound(self, document):
        """The least radius, or the greatest decay."""
        ends = [number(end) for i in document["stable"] for end in (i["lower"], i["upper"]) if end]
        p = floats(self.loop.point)
        for end in ends:
            for d in (-1e-3, 1e-3):
                x = end * (1 + d)
                region = {document["parameter"]: x}
                said = any((number(i["lower"]) is None or number(i["lower"]) < x) and (number(i["upper"]) is None or x < number(i["upper"])) for i in document["stable"])
                if x > 0:
                    agree(truth.stable(self.loop, p, **region), said, f"{document['parameter']} = {x!r}")

    def analyze(self, document, command):
        found = [self.verdict(document["verdict"], command)] if document["verdict"] else []
        found += [self.intervals(d, command) for d in document["parameters"] if d.get("stable") is not None]
        return "undecided" if "undecided" in found else None

    def map(self, document, _command):
        if document["schema"].startswith("jurist/map-boxes"):
            return self.boxes(document)
        if document["schema"] != "jurist/map/1":
            return "no truth"
        what = document.get("required") or document
        for strip in what.get("strips") or []:
            for cell in strip["cells"]:
                said = bool(cell["met"]) and cell["outside"] == 0 if self.required else cell["verdict"] == "stable"
                point = {document["x"]: Fraction(strip["sample"]), document["y"]: Fraction(cell["sample"])}
                if self.r.random() < 0.5 and cell.get("verdict") != "undefined":
                    agree(self.good(point), said, f"cell {floats(point)}")
        return None

    def boxes(self, document):
        required = document.get("required")
        boxes = [(b["x"], b["y"], b["verdict"] == "stable") for b in document["boxes"] if b["verdict"] in ("stable", "unstable")]
        if required:
            boxes = [(b["x"], b["y"], b["met"]) for b in required["boxes"] if b["met"] is not None]
        for x, y, said in self.r.sample(boxes, min(POINTS, len(boxes))):
            point = {}
            for name, (low, high) in ((document["x"], x), (document["y"], y)):
                low, high = Fraction(low), Fraction(high)
                point[name] = low + (high - low) * Fraction(self.r.randint(1, 99), 100)
            agree(self.good(point), said, f"box at {floats(point)}")
        return "undecided" if document["stopped"] or (required and required["stopped"]) else None

    def tolerance(self, document, command):
        box = {name: [Fraction(x) for x in side] for name, side in document["box"].items()}
        if "--limit" in command:
            return "no truth"
        factor = document.get("factor")
        lower = Fraction(factor["lower"]) if factor and factor.get("lower") else None
        if document["verdict"] is None or document["verdict"] == "undecided":
            return "undecided"
        is_met = all(r["met"] for r in document.get("requirements") or [])
        scale = Fraction(1) if document["verdict"] == "stable" and is_met else None
        for scale in [s for s in (scale, lower) if s is not None and s > 0]:
            for _ in range(POINTS // 2):
                point = {}
                for name, (low, high) in box.items():
                    middle, half = (low + high) / 2, (high - low) / 2 * scale
                    point[name] = middle + half * Fraction(self.r.choice([-999, 999, self.r.randint(-999, 999)]), 1000)
                agree(self.good(point), True, f"in {float(scale)} boxes at {floats(point)}")
        witness = document.get("witness")
        if witness and witness["verdict"] == "unstable" and not self.required:
            agree(self.good({name: Fraction(x) for name, x in witness["point"].items()}), False, "witness")
        if factor and lower is not None and factor.get("upper"):
            upper = Fraction(factor["upper"])
            return "undecided" if upper > lower * Fraction(101, 100) and upper < 100 and not factor.get("domain") else None
        return None

    def margins(self, document, _command):
        if not document["stable"]:
            return self.verdict(document, _command)
        p, found = floats(self.loop.point), []
        for name, at in [
            ("modulus_margin", lambda d: d["modulus"]["value"]["decimal"]),
            ("complementary_peak", lambda d: d["complementary"]["peak"]["decimal"]),
            ("disk_margin", lambda d: d["disk"]["alpha"]["decimal"]),
            ("phase_margin", lambda d: d["phase"]["degrees"]),
            ("delay_margin", lambda d: d["delay"]["seconds"]),
        ]:
            try:
                said = float(at(document))
            except (TypeError, KeyError):
                continue
            true = truth.margin(self.loop, p, name)
            if true is not None and np.isfinite(true) and abs(said - true) > 1e-4 * (abs(true) + 1e-3):
                raise Wrong(f"{name}: said {said}, true is {true}")
        return None

    def norm(self, document, command):
        if "--l1" in command or not document.get("stable") or not document.get("norm"):
            return "no truth"
        true = truth.margin(self.loop, floats(self.loop.point), "complementary_peak")
        said = float(document["norm"]["value"]["decimal"])
        if abs(said - true) > 1e-4 * (true + 1e-3):
            raise Wrong(f"norm: said {said}, true is {true}")
        return None

    def response(self, document, _command):
        n = self.loop.at(floats(self.loop.point))
        scale = 2 * np.pi if document["hertz"] else 1 / (n.T or 1)
        for w, (re, im) in list(zip(document["frequency"], document["response"]))[::37]:
            value = truth.open_loop(n, np.array([w * scale]))[0]
            if abs(value - complex(re, im)) > 1e-6 * (1 + abs(value)):
                raise Wrong(f"response at {w}: said {complex(re, im)}, true is {value}")
        return None

    def roots(self, document, _command):
        n = self.loop.at(floats(self.loop.point))
        for root in document["roots"]:
            s = complex(float(root["re"]), float(root["im"]))
            f = [np.polyval(n.den, s), np.polyval(n.num, s) * np.exp(-n.tau * s)]
            size = sum(abs(c) * abs(s) ** k for k, c in enumerate(n.den[::-1])) + abs(f[1])
            if root["multiplicity"] == 1 and abs(f[0] + f[1]) > 1e-6 * size:
                raise Wrong(f"no root at {s}")
        return None

    def jury(self, document, command):
        if document["parameter"] is None:
            agree(self.good({}), document["holds"], "jury")
        return "no truth" if document["parameter"] else None

    def charpoly(self, document, command):
        if document["schema"] != "jurist/charpoly/1" or document.get("symbols"):
            return "no truth"
        point = {**self.loop.point, "j": 1j}
        values = [point[name] for name in document["parameters"] if name in point]

        def poly(terms):
            return sum(complex(float(Fraction(c))) * np.prod([complex(v) ** e for v, e in zip(values, powers)]) for powers, c in terms)

        if len(values) != len(document["parameters"]) or self.loop.is_complex:
            return "no truth"
        found = np.array([poly(c["numerator"]) / poly(c["denominator"]) for c in document["coefficients"]][::-1])
        n = self.loop.at(floats(self.loop.point))
        true = np.polyadd(n.den, n.num)
        if len(found) == len(true) and np.max(np.abs(found / found[0] - true / true[0])) > 1e-8 * np.max(np.abs(true / true[0])):
            raise Wrong(f"polynomial {found / found[0]}, true is {true / true[0]}")
        return None

    bode = nyquist = response
