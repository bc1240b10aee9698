"""What the program prints, in the pages: every number in prose comes from a run at build time.

* ``{jurist}`` (directive): a command line as in a shell, with what it prints; ``:status:`` names the exit status (0).
* ``{jurist-picture}``: a command line whose ``-o FILE`` is a picture; the text of the directive is its caption.
* ``{model} NAME``: a model file, shown and kept for the commands after it on the page.
* ``{jurist}`` (role): one value of a JSON document, ``intervals --param K_pwm | stable.0.upper.decimal``.
* ``{live-page}``: the page in the browser itself, where ``web/build`` has made it (``PAGE``, else ``target/page``).
* ``build_reference``: pages made of the program, its schemas and its examples.

A command that does not end as expected stops the build.
"""

import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective, SphinxRole

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("JURIST", str(ROOT / "target" / "release" / "jurist"))
PAGE = Path(os.environ.get("PAGE", ROOT / "target" / "page"))
KEPT = Path(__file__).resolve().parents[1] / "_build" / "models"
PICTURES = Path(__file__).resolve().parents[1] / "_generated"


def run(arguments, status=0):
    """The program's answer, run where the examples, the files of the tests and the models of the pages are found."""
    KEPT.mkdir(parents=True, exist_ok=True)
    for name in ("examples", "tests"):
        if not (KEPT / name).exists():
            (KEPT / name).symlink_to(ROOT / name)
    done = subprocess.run([PROGRAM, *arguments], cwd=KEPT, capture_output=True, text=True, timeout=300)
    if done.returncode != status:
        shown = shlex.join(["jurist", *arguments])
        raise ExtensionError(f"{shown}: status {done.returncode}, not {status}\n{done.stdout}{done.stderr}")
    return done


class Jurist(SphinxDirective):
    """A command with its answer."""

    has_content = True
    option_spec = {"status": int}

    def run(self):
        shown = []
        for line in self.content:
            arguments = shlex.split(line)
            if arguments[:1] != ["jurist"]:
                raise self.error(f"a command begins with 'jurist': {line}")
            done = run(arguments[1:], self.options.get("status", 0))
            shown.append(f"$ {line}\n{done.stderr}{done.stdout}".rstrip())
        block = nodes.literal_block("", "\n\n".join(shown))
        block["language"] = "text"
        return [block]


class JuristPicture(SphinxDirective):
    """A picture that a command draws."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True
    option_spec = {"alt": directives.unchanged_required}

    def run(self):
        line = self.arguments[0]
        arguments = shlex.split(line)
        ending = Path(arguments[arguments.index("-o") + 1]).suffix
        name = hashlib.sha256(line.encode()).hexdigest()[:16] + ending
        PICTURES.mkdir(exist_ok=True)
        actual = [str(PICTURES / name) if before == "-o" else a for before, a in zip([""] + arguments, arguments)]
        run(actual[1:])
        image = nodes.image(uri=f"/_generated/{name}", alt=self.options.get("alt", line), width="100%")
        figure = nodes.figure("", image)
        caption = nodes.caption("", "")
        text, _ = self.state.inline_text(" ".join(self.content), self.lineno) if self.content else ([], [])
        caption += text + [nodes.Text(" " if text else ""), nodes.literal(line, line)]
        figure += caption
        return [figure]


class Model(SphinxDirective):
    """A model file that the commands below can use."""

    required_arguments = 1
    has_content = True

    def run(self):
        text = "\n".join(self.content) + "\n"
        KEPT.mkdir(parents=True, exist_ok=True)
        (KEPT / self.arguments[0]).write_text(text)
        run(["check", self.arguments[0]])
        block = nodes.literal_block("", text.rstrip())
        block["language"] = "toml"
        wrapper = nodes.container("", literal_block=True, classes=["literal-block-wrapper"])
        wrapper += [nodes.caption("", self.arguments[0]), block]
        return [wrapper]


class JuristValue(SphinxRole):
    """One value of a document."""

    def run(self):
        line, _, path = self.text.partition("|")
        value = json.loads(run([*shlex.split(line), "--json"]).stdout)
        for key in path.strip().split("."):
            value = value[int(key)] if key.lstrip("-").isdigit() else value[key]
        return [nodes.Text(str(value))], []


class LivePage(SphinxDirective):
    """The page in a frame, and a link to it; nothing where it is not built."""

    def run(self):
        if not (PAGE / "index.html").exists() or self.env.app.builder.format != "html":
            return []
        place = "../" * self.env.docname.count("/") + "live/index.html"
        frame = f'<iframe class="live" src="{place}" title="jurist in the browser" loading="lazy"></iframe>'
        link = f'<p><a href="{place}">The page alone</a></p>'
        return [nodes.raw("", frame + link, format="html")]


def copy_page(app, error):
    """Puts the page beside the others."""
    if error is None and app.builder.format == "html" and (PAGE / "index.html").exists():
        shutil.copytree(PAGE, Path(app.outdir) / "live", dirs_exist_ok=True)


def heading(text, mark="="):
    return f"{text}\n{mark * len(text)}\n\n"


def commands_page():
    """Every command with its help, from the program."""
    out = ["# Commands\n", "As the program prints them.\n", "```text", run(["--help"]).stdout.rstrip(), "```\n"]
    listed = run(["--help"]).stdout.split("Commands:\n")[1].split("\n\n")[0]
    for line in listed.splitlines():
        if line.startswith("  ") and line[2] != " ":
            name = line.split()[0]
            out += [f"## jurist {name}\n", "```text", run([name, "--help"]).stdout.rstrip(), "```\n"]
    return "\n".join(out)


def type_of(schema):
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[-1]
        return f"[{name}](#{name.lower()})"
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(v)}`" for v in schema["enum"])
    for key in ("anyOf", "oneOf", "allOf"):
        if key in schema:
            return " or ".join(dict.fromkeys(type_of(s) for s in schema[key]))
    kind = schema.get("type", "")
    if kind == "array" or (isinstance(kind, list) and "array" in kind and "items" in schema):
        items = schema.get("items")
        return "list of " + type_of(items) if isinstance(items, dict) else "list"
    return " or ".join(kind) if isinstance(kind, list) else kind or "any"


def cell(text):
    return " ".join(str(text).split()).replace("|", "\\|").replace("*", "\\*")


def properties_of(schema):
    found, required = dict(schema.get("properties", {})), set(schema.get("required", []))
    for part in schema.get("allOf", []):
        more, needed = properties_of(part)
        found |= more
        required |= needed
    return found, required


def table_of(schema):
    """The keys of one object."""
    properties, required = properties_of(schema)
    if not properties:
        return []
    out = ["| key | | type | meaning |", "|---|---|---|---|"]
    for key, value in properties.items():
        must = "required" if key in required else ""
        out.append(f"| `{key}` | {must} | {cell(type_of(value))} | {cell(value.get('description', ''))} |")
    return [*out, ""]


def inner_objects(schema, path=""):
    """Objects that are written where they are used, with the path to them."""
    for key, value in properties_of(schema)[0].items():
        for part, suffix in [(value, ""), (value.get("items"), "[]"), (value.get("additionalProperties"), ".NAME")]:
            if isinstance(part, dict) and part.get("properties"):
                name = f"{path}{key}{suffix}"
                yield name, value.get("description", ""), part
                yield from inner_objects(part, name + ".")


def schema_tables(schema, level):
    """A table for the document and one for each type that it uses."""
    out = []
    for name, part in [(None, schema), *schema.get("$defs", {}).items()]:
        if name:
            out += [f"({name.lower()})=", f"{'#' * level} {name}\n"]
        if part.get("description"):
            out.append(part["description"].strip() + "\n")
        table = table_of(part)
        out += table if table or not name else [cell(type_of(part)) + "\n"]
        for path, meaning, inner in inner_objects(part):
            out += [f"{'#' * level} `{path}`\n", meaning + "\n", *table_of(inner)]
    return out


def model_page():
    schema = json.loads((ROOT / "schema" / "model.schema.json").read_text())
    out = ["# Model files\n", "Made of the JSON schema that the reader's own lists of keys give; editors use it with a first line"]
    out.append("`#:schema PATH`. Strings that stand for numbers are expressions: names, exact numbers, `+ - * / ^`.\n")
    return "\n".join(out + schema_tables(schema, 2))


def documents_pages():
    pages = {}
    for path in sorted((ROOT / "schema").glob("*.schema.json")):
        if path.name == "model.schema.json":
            continue
        schema = json.loads(path.read_text())
        tables = "\n".join(schema_tables(schema, 2))
        # Names of types are labels; each page has its own.
        stem = path.name.removesuffix(".schema.json")
        for name in schema.get("$defs", {}):
            tables = tables.replace(f"(#{name.lower()})", f"(#{stem}-{name.lower()})")
            tables = tables.replace(f"\n({name.lower()})=\n", f"\n({stem}-{name.lower()})=\n")
            tables = tables.replace(f"({name.lower()})=\n", f"({stem}-{name.lower()})=\n") if tables.startswith("(") else tables
        pages[stem] = f"# {schema['title']}\n\n{tables}"
    return pages


def gallery_page():
    """Every example: what its file says, what the program says, one picture."""
    out = ["# Examples\n", "The model files of the folder `examples`, each with its answer and a picture made when this page was built.\n"]
    PICTURES.mkdir(exist_ok=True)
    for path in sorted((ROOT / "examples").glob("*.toml")):
        text = path.read_text()
        lines = text.splitlines()
        first = next(i for i, l in enumerate(lines) if l and not l.startswith("#"))
        comment = [l[1:].rstrip() for l in lines[:first] if l.startswith("#") and not l.startswith("#:")]
        title = next((l.split("=", 1)[1].strip().strip('"') for l in lines if l.startswith("title")), path.stem)
        name = f"examples/{path.name}"
        done = subprocess.run([PROGRAM, "analyze", name, "-q", "--timeout", "20"], cwd=ROOT, capture_output=True, text=True)
        out += [f"## {title}\n", "\n".join(comment).strip().replace("*", "\\*") + "\n", f"`{name}`\n"]
        out += ["```text", f"$ jurist {name}", done.stdout.rstrip(), "```\n"]
        picture = PICTURES / f"gallery-{path.stem}.svg"
        drawn = picture_of(name, text, picture)
        if drawn:
            out += [f"```{{figure}} /_generated/{picture.name}", f":alt: {title}", "", f"`{drawn}`", "```\n"]
    return "\n".join(out)


def picture_of(name, text, picture):
    """The map of the first two parameters, or the locus of the first; the command line, or None."""
    document = subprocess.run([PROGRAM, "analyze", name, "--json", "-q", "--timeout", "20"], cwd=ROOT, capture_output=True, text=True)
    try:
        names = [p["parameter"] for p in json.loads(document.stdout)["parameters"]]
    except (ValueError, KeyError):
        return None
    tries = []
    if len(names) >= 2:
        tries.append(["map", name, "-x", names[0], "-y", names[1], "--timeout", "20", "-q"])
    if names:
        tries.append(["locus", name, "--param", names[0], "--timeout", "20", "-q"])
    for arguments in tries:
        done = subprocess.run([PROGRAM, *arguments, "-o", str(picture)], cwd=ROOT, capture_output=True, text=True)
        if done.returncode == 0 and picture.exists():
            kept = [a for a in arguments if a not in ("--timeout", "20", "-q")]
            return shlex.join(["jurist", *kept, "-o", f"{arguments[0]}.svg"])
    return None


def page_of(title, *files):
    """Pages that the code's own documentation shows as well: headings one level down, links into the code as plain text."""
    out = [f"# {title}\n"]
    for file in files:
        fenced = False
        for line in (ROOT / file).read_text().splitlines():
            fenced ^= line.startswith("```")
            if not fenced:
                line = re.sub(r"^#(#*) ", r"#\1# ", line)
                line = re.sub(r"\[([^\]]+)\]\((?:crate|jurist_\w+|super|Self)::[^)]*\)", r"\1", line)
            out.append(line)
        out.append("")
    return "\n".join(out)


def build_reference(app):
    """Writes the pages that are made of the program."""
    if not Path(PROGRAM).exists():
        raise ExtensionError(f"{PROGRAM} is not there: cargo build --release, or set JURIST")
    folder = Path(app.srcdir) / "_made"
    folder.mkdir(exist_ok=True)

    def write(name, text):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)

    write("commands.md", commands_page())
    write("model.md", model_page())
    write("errors.md", page_of("Errors and warnings", "crates/model/src/error/codes.md").replace("\n#### ", "\n## "))
    write("words.md", page_of("Words of the answers", "crates/show/src/words.md").replace("\n#### ", "\n## "))
    write("certificates.md", page_of("Certificates", "crates/check/src/grammar.md", "crates/check/src/proved.md"))
    write("speed.md", page_of("How long answers take", "src/performance.md"))
    write("gallery.md", gallery_page())
    pages = documents_pages()
    for name, text in pages.items():
        write(f"documents/{name}.md", text)
    listed = "\n".join(f"documents/{name}" for name in pages)
    write("documents.md", f"# JSON documents\n\nWhat `--json` writes; exact numbers are texts.\n\n```{{toctree}}\n:maxdepth: 1\n\n{listed}\n```\n")


def setup(app):
    app.add_directive("jurist", Jurist)
    app.add_directive("jurist-picture", JuristPicture)
    app.add_directive("model", Model)
    app.add_role("jurist", JuristValue())
    app.add_directive("live-page", LivePage)
    app.connect("builder-inited", build_reference)
    app.connect("build-finished", copy_page)
    return {"version": "1", "parallel_read_safe": True}
