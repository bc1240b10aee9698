"""What the release is told, in a copy of the sources.

    release/stage.py FOLDER      addresses of release/settings.toml go into the manifests, licence texts beside those of packages
    release/stage.py --labels    the same as labels of an image, `key=value`
"""

import json
import shutil
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
KEYS = ("repository", "homepage", "documentation")
PACKAGES = (
    "crates/algebra", "crates/check", "crates/model", "crates/stability", "crates/engine", "crates/show", "crates/tune", "crates/prove", "crates/draw", "studies/drive", "crates/ship", ".",
)
"""What is published, each after those that it needs."""


def settings():
    """The addresses that are set."""
    found = tomllib.loads((ROOT / "release/settings.toml").read_text())
    found.pop("published", None)
    unknown = set(found) - set(KEYS)
    if unknown:
        raise SystemExit(f"release/settings.toml: unknown: {', '.join(sorted(unknown))}")
    return found


def after(path, line, added):
    """Adds lines after the only line that is as given."""
    text = path.read_text()
    assert text.count(f"\n{line}\n") == 1, f"{path}: {line}"
    lines = "".join(f"{new}\n" for new in (line, *added))
    path.write_text(text.replace(f"\n{line}\n", f"\n{lines}"))


def stage(folder, found):
    """Changes the copy of the sources."""
    manifests = [folder / package / "Cargo.toml" for package in PACKAGES]
    after(folder / "Cargo.toml", 'license = "MIT OR Apache-2.0"', [f"{key} = {json.dumps(value)}" for key, value in found.items()])
    for manifest in manifests:
        after(manifest, "license.workspace = true", [f"{key}.workspace = true" for key in found])
        for text in ("LICENSE-APACHE", "LICENSE-MIT"):
            if manifest.parent != folder:
                shutil.copy(folder / text, manifest.parent)
    if found:
        urls = [f"{key.capitalize()} = {json.dumps(value)}" for key, value in found.items()]
        after(folder / "python/pyproject.toml", 'dynamic = ["version"]', ["", "[project.urls]", *urls])


def labels(found):
    """Labels as the Open Container Initiative names them."""
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    names = {"repository": "source", "homepage": "url", "documentation": "documentation"}
    known = {"version": version, "licenses": "(MIT OR Apache-2.0) AND LGPL-3.0-only"}
    return known | {names[key]: value for key, value in found.items()}


if __name__ == "__main__":
    if sys.argv[1:] == ["--labels"]:
        print(*(f"{key}={value}" for key, value in labels(settings()).items()), sep="\n")
    else:
        stage(Path(sys.argv[1]), settings())
