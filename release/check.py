"""What has to agree before a release is built; prints what does not, and exits 1.

- the version of Cargo.toml is that of all packages, of all lock files and of the first section of CHANGELOG.md;
- that section begins with three lines for those who read no more, and the documentation has a page on what changed;
- texts that say how to install it promise no registry before `published` is set in release/settings.toml;
- hosts of registries are named by recipes and workflows alone;
- each command of a workflow is a script of the repository.

`--self-test` shows that each of these is found where it is missing; `--tag NAME` also asks whether a tag is that of the version and nothing is left to
be completed.
"""

import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCKS = ("Cargo.lock", "fuzz/Cargo.lock", "tests/wasm/Cargo.lock")
HOSTS = re.compile(r"crates\.io|pypi\.org|npmjs\.|rustup\.rs|ghcr\.io|docker\.io|quay\.io|anaconda\.org", re.I)
RECIPES = ("release/", ".github/", "Dockerfile", "NOTICE.md")
"""Where hosts may be named, beside lock files."""
PROMISES = re.compile(r"(?:pip install|uv add|pipx install) (?:-\S+ )*[\"']?jurist(?![\w.-])|cargo (?:install|add) jurist(?![\w-])", re.I)
INSTALLATION = ("README.md", "docs", "python/README.md", "src", "crates", "python/jurist", "web/app/src", "web/app/index.html")


def tracked(root):
    """All files that git tracks; all files where there is no git."""
    done = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, text=True)
    if done.returncode or not done.stdout:
        return [p.relative_to(root).as_posix() for p in sorted(root.rglob("*")) if p.is_file()]
    return [name for name in done.stdout.split("\0") if name and (root / name).is_file()]


def text_of(path):
    """The text of a file, nothing where it is none."""
    try:
        return path.read_text()
    except UnicodeDecodeError:
        return ""


def versions(root):
    """Places where another version stands than that of the workspace."""
    manifest = tomllib.loads((root / "Cargo.toml").read_text())["workspace"]
    version, wrong = manifest["package"]["version"], []
    for name, entry in manifest["dependencies"].items():
        if isinstance(entry, dict) and "path" in entry and entry.get("version", version) != version:
            wrong.append(f"Cargo.toml: {name} is asked for in version {entry['version']}, not {version}")
    for lock in LOCKS:
        for package in tomllib.loads((root / lock).read_text())["package"]:
            own = package["name"].startswith("jurist") and "source" not in package and package["version"] != "0.0.0"
            if own and package["version"] != version:
                wrong.append(f"{lock}: {package['name']} has version {package['version']}, not {version}")
    return version, wrong


def changelog(root, version):
    """What the first section of the changelog lacks."""
    sections = re.split(r"^## ", (root / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1:]
    title, _, body = sections[0].partition("\n")
    if title.split()[0] != version:
        return [f"CHANGELOG.md: the first section is {title.split()[0]}, not {version}"]
    head = body.split("\n###")[0]
    found = len(re.findall(r"^- ", head, re.MULTILINE))
    return [] if found == 3 else [f"CHANGELOG.md: {version} begins with {found} lines for all readers, not 3"]


def guide(root, version):
    """Whether the documentation says what changed since the version before."""
    major, minor = version.split(".")[:2]
    name = f"from-{major}-{int(minor) - 1}-to-{major}-{minor}"
    index = (root / "docs/index.md").read_text()
    return [] if (root / f"docs/{name}.md").exists() and f"\n{name}\n" in index else [f"docs/{name}.md: not there, or not in the index"]


def promises(root, files):
    """Texts that install it from a registry which has it not."""
    if tomllib.loads((root / "release/settings.toml").read_text()).get("published"):
        return []
    out = []
    for name in files:
        if name.endswith((".md", ".rs", ".py", ".ts", ".html")) and any(name == place or name.startswith(f"{place}/") for place in INSTALLATION):
            for k, line in enumerate(text_of(root / name).splitlines(), 1):
                if PROMISES.search(line):
                    out.append(f"{name}:{k}: there is no registry that has it: {line.strip()}")
    return out


def hosts(root, files):
    """Files that name the host of a registry."""
    out = []
    for name in files:
        if name.endswith((".lock", "package-lock.json")) or name.startswith(RECIPES):
            continue
        for k, line in enumerate(text_of(root / name).splitlines(), 1):
            if found := HOSTS.search(line):
                out.append(f"{name}:{k}: names {found[0]}")
    return out


def workflows(root, files):
    """Commands of workflows that nobody can run elsewhere."""
    out = []
    for name in files:
        if name.startswith(".github/workflows/"):
            for k, line in enumerate(text_of(root / name).splitlines(), 1):
                command = re.match(r"\s*(?:- )?run: (\S+)", line)
                if command and command[1] not in files:
                    out.append(f"{name}:{k}: {command[1]} is no script of the repository")
    return out


def unfinished(root, tag, version):
    """What stands in the way of a tag."""
    out = [] if tag == f"v{version}" else [f"the tag {tag} is not v{version}"]
    for page in sorted((root / "docs").glob("from-*.md")):
        lines = page.read_text().splitlines()
        out += [f"docs/{page.name}:{k}: to complete" for k, line in enumerate(lines, 1) if line.startswith("% To complete")]
    if re.search(r"^## \S+ .*unreleased", (root / "CHANGELOG.md").read_text(), re.MULTILINE | re.IGNORECASE):
        out.append("CHANGELOG.md: the first section has no date")
    return out


def check(root):
    """All that does not agree."""
    files = tracked(root)
    version, wrong = versions(root)
    return version, wrong + changelog(root, version) + guide(root, version) + promises(root, files) + hosts(root, files) + workflows(root, files)


COPIED = ("Cargo.toml", *LOCKS, "CHANGELOG.md", "README.md", "release/settings.toml", "docs/index.md", ".github/workflows/tests.yml", ".ci/run", "release/machine")
CONTROLS = [
    ("Cargo.toml", 'crates/check", version = "', 'crates/check", version = "9', "Cargo.toml: jurist-check is asked for"),
    ("fuzz/Cargo.lock", 'name = "jurist-engine"\nversion = "', 'name = "jurist-engine"\nversion = "9', "fuzz/Cargo.lock: jurist-engine"),
    ("CHANGELOG.md", "\n## ", "\n## 9", "the first section is 9"),
    ("CHANGELOG.md", "\n- ", "\n- one more\n- ", "begins with 4 lines"),
    ("docs/index.md", "\nfrom-", "\nto-", "not in the index"),
    ("README.md", "\n", "\npip install jurist\n", "README.md:2: there is no registry"),
    ("README.md", "\n", "\ncargo install jurist\n", "README.md:2: there is no registry"),
    ("README.md", "\n", "\nhttps://pypi" + ".org\n", "README.md:2: names"),
    (".github/workflows/tests.yml", "run: .ci/run", "run: make", "make is no script"),
]
"""A file, a text that is there, what stands in its place, what has to be said."""


def self_test():
    """Controls whose mistake is not found."""
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        version = versions(ROOT)[0]
        guides = [p.relative_to(ROOT).as_posix() for p in (ROOT / "docs").glob("from-*.md")]
        for name in (*COPIED, *guides):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, copy / name)
        for name, there, instead, said in CONTROLS:
            before = (copy / name).read_text()
            assert there in before, f"{name}: nothing to change: {there!r}"
            (copy / name).write_text(before.replace(there, instead, 1))
            if not any(said in line for line in check(copy)[1]):
                missed.append(f"{name}: not found: {said}")
            (copy / name).write_text(before)
        missed += [f"whole, but: {line}" for line in check(copy)[1]]
    return version, missed


def main(arguments):
    version, wrong = self_test() if arguments == ["--self-test"] else check(ROOT)
    if arguments[:1] == ["--tag"]:
        wrong += unfinished(ROOT, arguments[1], version)
    print("\n".join(wrong) or f"{version}: {f'{len(CONTROLS)} mistakes are found' if arguments == ['--self-test'] else 'all places agree'}")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
