#!/usr/bin/env python3
"""Counts the project's own Rust: lines without blank ones, comments and tests, for each crate, and what is too long.

    benches/lines.py            prints the counts beside those recorded in benches/lines.txt
    benches/lines.py record     writes the record
    benches/lines.py long       names functions over 60 lines, files over 400, functions of more than six arguments

Tests are folders and files named `tests`, `tests_*.rs`, `tests.rs`, and everything under `#[cfg(test)]`. Python 3, nothing else.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLACES = ["crates/algebra", "crates/check", "crates/draw", "crates/engine", "crates/fuzzing", "crates/model", "crates/prove",
          "crates/ship", "crates/show", "crates/stability", "crates/tune", "python", "src", "studies", "web"]
LONG_FUNCTION, LONG_FILE, MANY_ARGUMENTS = 60, 400, 6
# A comment or a literal, whichever begins first.
TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\.[^\']*|[^\'\\\n])\'', re.DOTALL)


def code(text):
    """The text without comments, and with literals as blanks between quotes; lines stay where they are."""
    def replace(match):
        token = match[0]
        if token.startswith(("//", "/*")):
            return re.sub(r"[^\n]", " ", token)
        # A literal is code: each of its lines counts.
        return '"' + "\n".join("x" * len(line) for line in token[1:-1].split("\n")) + '"'
    return TOKEN.sub(replace, text)


def closing(text, start):
    """Where the bracket that opens at `start` is closed, or the end."""
    pairs, depth = {"{": "}", "(": ")", "[": "]"}, 0
    opening, end = text[start], pairs[text[start]]
    for place in range(start, len(text)):
        depth += (text[place] == opening) - (text[place] == end)
        if depth == 0:
            return place
    return len(text)


def without_tests(text):
    """The code without items under `#[cfg(test)]`."""
    while match := re.search(r"#\[cfg\((?:all\()?test\b[^\]]*\]", text):
        rest = re.compile(r"[;{]").search(text, match.end())
        if rest is None:
            break
        end = rest.start() if rest[0] == ";" else closing(text, rest.start())
        text = text[: match.start()] + re.sub(r"[^\n]", " ", text[match.start() : end + 1]) + text[end + 1 :]
    return text


def lines(text):
    return sum(1 for line in text.split("\n") if line.strip())


def arguments(text, start):
    """The number of arguments in the list that opens at `start`."""
    depth, count, item = 0, 0, ""
    inner = text[start + 1 : closing(text, start)].replace("->", "  ")
    for letter in inner + ",":
        depth += (letter in "([{<") - (letter in ")]}>")
        if letter == "," and depth == 0:
            count += bool(item.strip())
            item = ""
        else:
            item += letter
    return count


def of_traits(text):
    """Where implementations of traits stand: the arguments of their functions are the trait's."""
    for match in re.finditer(r"\bimpl\b[^{};]*\bfor\b[^{};]*{", text):
        yield range(match.start(), closing(text, match.end() - 1))


def functions(text):
    """Name, line, code lines and number of arguments of each function with a body."""
    given = list(of_traits(text))
    for match in re.finditer(r"\bfn\s+(\w+)", text):
        start = text.find("(", match.end())
        rest = re.compile(r"[;{]").search(text, closing(text, start)) if start >= 0 else None
        if rest is None or rest[0] == ";":
            continue
        body = text[match.start() : closing(text, rest.start()) + 1]
        number = 0 if any(match.start() in place for place in given) else arguments(text, start)
        yield match[1], text.count("\n", 0, match.start()) + 1, lines(body), number


def sources(place):
    for path in sorted((ROOT / place).rglob("*.rs")):
        parts = path.relative_to(ROOT / place).parts
        if "tests" in parts or "target" in parts or "examples" in parts or re.fullmatch(r"tests(_\w+)?\.rs", path.name):
            continue
        yield path


def main():
    counts, long = {}, []
    for place in PLACES:
        for path in sources(place):
            text = without_tests(code(path.read_text()))
            count = lines(text)
            counts[place] = counts.get(place, 0) + count
            name = path.relative_to(ROOT)
            if count > LONG_FILE:
                long.append(("file", f"{name}: {count} lines"))
            for function, line, length, number in functions(text):
                if length > LONG_FUNCTION:
                    long.append(("function", f"{name}:{line}: {function}: {length} lines"))
                if number > MANY_ARGUMENTS:
                    long.append(("arguments", f"{name}:{line}: {function}: {number} arguments"))
    counts["all"] = sum(counts.values())
    counts["functions over 60 lines"] = sum(kind == "function" for kind, _ in long)
    counts["files over 400 lines"] = sum(kind == "file" for kind, _ in long)
    counts["functions of more than six arguments"] = sum(kind == "arguments" for kind, _ in long)
    record = ROOT / "benches/lines.txt"
    if sys.argv[1:] == ["long"]:
        print("\n".join(text for _, text in long))
        return
    before = dict(line.rsplit(" ", 1) for line in record.read_text().splitlines()) if record.exists() else {}
    for name, count in counts.items():
        print(f"{name:40} {count:7}  recorded {before.get(name, '-'):>7}")
    if sys.argv[1:] == ["record"]:
        record.write_text("".join(f"{name} {count}\n" for name, count in counts.items()))


if __name__ == "__main__":
    main()
