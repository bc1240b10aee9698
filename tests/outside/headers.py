#!/usr/bin/env python3
"""Whether numbers of C headers are those that a compiler makes of them.

    tests/outside/headers.py PROGRAM [COUNT]

Random literals, as macros and as constants of several types, in one header: a C program prints each as the compiler holds it, and
`jurist check --resolved` writes each as the program reads it. Needs cc.
"""
import pathlib
import random
import re
import subprocess
import sys
import tempfile
from fractions import Fraction

program = pathlib.Path(sys.argv[1]).resolve()
count = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
draw = random.Random(39)


def literal():
    """A literal of C that is no octal number, and whether it is a whole one."""
    kind = draw.randrange(6)
    if kind == 0:
        return draw.choice(["0", str(draw.randrange(1, 2**31))]) + draw.choice(["", "u", "L", "UL", "ll", "ULL"]), True
    if kind == 1:
        return hex(draw.randrange(2**31)) + draw.choice(["", "u", "L"]), True
    if kind == 2:
        digits = "".join(draw.choice("0123456789abcdef") for _ in range(draw.randrange(1, 14)))
        return f"0x{draw.randrange(16):x}.{digits}p{draw.randrange(-140, 100)}" + draw.choice(["", "f"]), False
    whole = str(draw.randrange(10 ** draw.randrange(1, 20)))
    part = "".join(draw.choice("0123456789") for _ in range(draw.randrange(0, 25)))
    exponent = draw.choice(["", f"e{draw.randrange(-44, 38 - len(whole))}", f"E+{draw.randrange(0, 38 - len(whole))}"])
    if kind == 3:
        whole = ""
        part = part or "5"
    text = f"{whole}.{part}{exponent}"
    return text + draw.choice(["", "f", "F"]), False


def written():
    """A line of the header without its name, and whether it is a macro."""
    text, is_whole = literal()
    # The negative of an unsigned number is not read.
    is_large = text.startswith("0x") and is_whole and int(text.rstrip("uULl"), 16) >= 2**31
    sign = draw.choice(["", "", "+"] if "u" in text.lower() or is_large else ["", "", "-", "+"])
    text = draw.choice(["{}", "({})", "(({}))"]).format(sign + text)
    comment = draw.choice(["", " // a gain, 1.5", " /* 2.5f */", "\t/* over\n two lines */"])
    if draw.randrange(2):
        return f"#define {{}} {text}{comment}"
    types = ["float", "double"] + (["int64_t"] if is_whole else [])
    place = draw.choice(["static const {}", "const {}", "static {} const"])
    return f"{place.format(draw.choice(types))} {{}} = {text};{comment}"


lines = [written() for _ in range(count)]
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    end = draw.choice(["\n", "\r\n"])
    header = "#ifndef G_H\n#define G_H\n#include <stdint.h>\n" + "\n".join(line.format(f"G{k}") for k, line in enumerate(lines)) + "\n#endif\n"
    (folder / "gains.h").write_text(header.replace("\n", end), newline="")
    prints = "\n".join(f'    printf("%La\\n", (long double)(G{k}));' for k in range(count))
    (folder / "main.c").write_text(f'#include <stdio.h>\n#include "gains.h"\nint main(void) {{\n{prints}\n    return 0;\n}}\n')
    subprocess.run(["cc", "-std=c11", "-w", "-o", "main", "main.c"], cwd=folder, check=True)
    held = subprocess.run(["./main"], cwd=folder, check=True, capture_output=True, text=True).stdout.split()
    constants = "\n".join(f'G{k} = {{ from = "gains.h#G{k}" }}' for k in range(count))
    sum_of_all = "+".join(f"G{k}" for k in range(count))
    (folder / "loop.toml").write_text(
        f"time = 'discrete'\n[constants]\n{constants}\n[parameters]\nK = 1\n[loop]\ncharacteristic = 'z - K'\n"
    )
    run = subprocess.run([program, "check", "loop.toml", "--resolved", "whole.toml", "-q"], cwd=folder, capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr[:3000])
    text = (folder / "whole.toml").read_text()


def of_hexadecimal(text):
    sign, whole, part, exponent = re.fullmatch(r"(-?)0x([0-9a-f]+)\.?([0-9a-f]*)p([+-]\d+)", text).groups()
    value = Fraction(int(whole + part, 16)) * Fraction(2) ** (int(exponent) - 4 * len(part))
    return -value if sign else value


taken = {name: Fraction(value) for name, value in re.findall(r'^(G\d+) = { value = "([^"]+)" }$', text, re.M)}
wrong = [k for k in range(count) if taken.get(f"G{k}") != of_hexadecimal(held[k])]
for k in wrong[:10]:
    print(f"{lines[k]!r}: the compiler holds {held[k]}, jurist takes {taken.get(f'G{k}')}")
print(f"{count} numbers, {len(wrong)} differ")
sys.exit(1 if wrong else 0)
