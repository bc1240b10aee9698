"""What the binaries are made of, read from `cargo tree` and `cargo metadata`.

    release/parts.py --notice          write the list of parts into NOTICE.md
    release/parts.py --check           say whether NOTICE.md is current, and every licence one that is known
    release/parts.py --licences FILE   write the licence texts of all parts into one file
    release/parts.py --sbom FILE       write the list of parts of the program as CycloneDX JSON

Parts are what ends in a binary on any platform: neither tests nor tools of the build.
"""

import hashlib
import json
import os
import re
import subprocess
import sys
import tomllib
import uuid
from datetime import UTC, datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BINARIES = {
    "program": ["-p", "jurist", "--features", "page", "--target", "all"],
    "checker": ["-p", "jurist-check", "--target", "all"],
    "wheel": ["-p", "jurist-python", "--target", "all"],
    "page": ["-p", "jurist-web", "--target", "wasm32-unknown-unknown"],
}
"""Each binary with the package that it is built from."""
BEGIN, END = "<!-- parts: release/parts.py --notice -->\n", "<!-- end of parts -->\n"
PERMISSIVE = {"0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "MIT", "Unicode-3.0", "Unlicense", "Zlib"}
COPYLEFT = {"malachite-base": "LGPL-3.0-only", "malachite-nz": "LGPL-3.0-only"}
"""The only parts whose licence asks for more than a notice."""


def cargo(*arguments):
    """What a command of cargo prints."""
    return subprocess.run(["cargo", *arguments, "--locked"], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def expression(licence):
    """An SPDX expression; older packages write a slash for 'or'."""
    return licence.replace("/", " OR ")


def crates(options):
    """Name, version and licence of every crate that is linked, in order."""
    lines = cargo("tree", *options, "-e", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}|{l}").splitlines()
    found = set()
    for line in lines:
        package, licence = line.removesuffix(" (*)").split("|")
        name, version = package.split()[:2]
        if "(/" not in package and "path+file" not in package:
            found.add((name, version.removeprefix("v"), expression(licence)))
    return sorted(found)


def scripts():
    """Name, version and licence of every package that the page's script is bundled from."""
    lock = json.loads((ROOT / "web/app/package-lock.json").read_text())
    return sorted((k.removeprefix("node_modules/"), v["version"], v["license"]) for k, v in lock["packages"].items() if k and not v.get("dev"))


def parts():
    """Every part with the binaries that it is in."""
    where = {}
    for binary, options in BINARIES.items():
        for part in crates(options):
            where.setdefault(part, []).append(binary)
    for part in scripts():
        where.setdefault(part, []).append("page")
    return where


def refused(where):
    """Parts with a licence that nobody has looked at."""
    return [
        f"{name} {version}: {licence}"
        for name, version, licence in where
        if COPYLEFT.get(name) != licence and not set(re.split(r" OR | AND ", re.sub("[()]", "", licence))) <= PERMISSIVE
    ]


def table(where):
    """The list of parts as Markdown."""
    rows = [f"| {name} | {version} | {licence} | {', '.join(binaries)} |\n" for (name, version, licence), binaries in sorted(where.items())]
    return f"{BEGIN}\n| part | version | licence | in |\n|---|---|---|---|\n{''.join(rows)}\n{END}"


def with_table(text, where):
    """NOTICE.md with the list of today."""
    before, rest = text.split(BEGIN)
    return before + table(where) + rest.split(END)[1]


def metadata():
    """Every package of the workspace and below, by name and version."""
    return {(p["name"], p["version"]): p for p in everything()["packages"]}


def everything():
    """What cargo knows of the workspace, with all features."""
    return json.loads(cargo("metadata", "--format-version", "1", "--all-features"))


def texts(package):
    """The licence texts that a package brings along."""
    folder = Path(package["manifest_path"]).parent
    names = sorted(p for p in folder.iterdir() if re.match(r"(licen[cs]e|copying|notice|unlicense|copyright)", p.name, re.I))
    files = [f for name in names for f in (sorted(name.iterdir()) if name.is_dir() else [name]) if f.is_file()]
    return [f.read_text(errors="replace").replace("\r\n", "\n").strip() for f in files]


def licences(where):
    """All licence texts, each once, under the names of the parts that it is for."""
    known, grouped, silent = metadata(), {}, []
    for name, version, licence in sorted(where):
        package = known.get((name, version))
        if package is None:
            found = [text.read_text().strip() for text in sorted((ROOT / "web/app/node_modules" / name).glob("LICENSE*"))]
            authors = ""
        else:
            found, authors = texts(package), ", ".join(package["authors"])
        if not found:
            silent.append(f"{name} {version}: {licence}{f', by {authors}' if authors else ''}")
        for text in found:
            grouped.setdefault(text, []).append(f"{name} {version}")
    out = ["Licences of what is linked into jurist. NOTICE.md says which part is in which binary.\n"]
    if silent:
        out.append("These bring no text of their own; that of their licence is below, under the names of others:\n\n" + "\n".join(silent) + "\n")
    for text, names in sorted(grouped.items(), key=lambda item: item[1]):
        out.append("=" * 100 + f"\n{', '.join(names)}\n" + "-" * 100 + f"\n{text}\n")
    return "\n".join(out)


def checksums():
    """The checksum of each package in the lock file."""
    lock = tomllib.loads((ROOT / "Cargo.lock").read_text())
    return {(p["name"], p["version"]): p["checksum"] for p in lock["package"] if "checksum" in p}


def sbom():
    """The program's parts as CycloneDX 1.5, the same bytes for the same commit."""
    known, sums = metadata(), checksums()
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    linked = crates(BINARIES["program"])

    def reference(name, number):
        return f"pkg:cargo/{name}@{number}"

    own = sorted((p["name"], p["version"], p["license"]) for p in known.values() if p["source"] is None and p["name"] in OWN)
    components = []
    for name, number, licence in sorted([*linked, *own]):
        purl = reference(name, number)
        component = {"type": "library", "bom-ref": purl, "name": name, "version": number, "purl": purl, "licenses": [{"expression": licence}]}
        if (name, number) in sums:
            component["hashes"] = [{"alg": "SHA-256", "content": sums[name, number]}]
        if repository := known[name, number].get("repository"):
            component["externalReferences"] = [{"type": "vcs", "url": repository}]
        components.append(component)
    whole = [{"expression": "(MIT OR Apache-2.0) AND LGPL-3.0-only"}]
    main = {"type": "application", "bom-ref": f"jurist@{version}", "name": "jurist", "version": version, "licenses": whole}
    document = {
        "metadata": {"component": main},
        "components": components,
        "dependencies": dependencies({c["bom-ref"] for c in components}, main["bom-ref"]),
    }
    if "SOURCE_DATE_EPOCH" in os.environ:
        document["metadata"]["timestamp"] = datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), UTC).isoformat()
    number = uuid.UUID(hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()[:32], version=4)
    head = {"bomFormat": "CycloneDX", "specVersion": "1.5", "serialNumber": number.urn, "version": 1}
    return json.dumps({**head, **document}, indent=1, ensure_ascii=False) + "\n"


OWN = {"jurist-algebra", "jurist-check", "jurist-draw", "jurist-drive", "jurist-engine", "jurist-model", "jurist-prove", "jurist-ship", "jurist-show", "jurist-stability", "jurist-tune"}


def dependencies(listed, main):
    """Who depends on whom among the parts."""
    resolved = everything()
    identity = {p["id"]: f"pkg:cargo/{p['name']}@{p['version']}" for p in resolved["packages"]}
    out = []
    for node in resolved["resolve"]["nodes"]:
        me = identity[node["id"]]
        root = me.startswith("pkg:cargo/jurist@")
        if me not in listed and not root:
            continue
        below = {identity[d["pkg"]] for d in node["deps"] if any(kind["kind"] is None for kind in d["dep_kinds"])}
        out.append({"ref": main if root else me, "dependsOn": sorted(below & listed)})
    return sorted(out, key=lambda entry: entry["ref"])


def main(arguments):
    notice = ROOT / "NOTICE.md"
    match arguments:
        case ["--notice"]:
            notice.write_text(with_table(notice.read_text(), parts()))
        case ["--check"]:
            where = parts()
            wrong = refused(where)
            if with_table(notice.read_text(), where) != notice.read_text():
                wrong.append("NOTICE.md: the list of parts is not that of Cargo.lock: release/parts.py --notice")
            print("\n".join(wrong) or f"{len(where)} parts are in NOTICE.md, each with a licence that is known")
            return bool(wrong)
        case ["--licences", file]:
            Path(file).write_text(licences(parts()))
        case ["--sbom", file]:
            Path(file).write_text(sbom())
        case _:
            print(__doc__, file=sys.stderr)
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
