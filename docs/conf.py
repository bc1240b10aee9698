"""The documentation site: Sphinx with MyST. `docs/build` makes it."""

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "_ext"))

project = "jurist"
author = "the jurist team"
copyright = "the jurist team"
release = tomllib.loads((HERE.parent / "Cargo.toml").read_text())["workspace"]["package"]["version"]
version = release

extensions = ["myst_parser", "jurist_docs"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "README.md"]
html_theme = "furo"
html_title = f"jurist {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_copyright = False
# The made pages have no source of their own to show.
html_show_sourcelink = False
linkcheck_timeout = 5
