"""Runs the notebooks; with a second folder, writes them there with their outputs, and their pictures beside them."""

import base64
import os
import sys
import time
from pathlib import Path

import jupytext
import nbclient
import nbformat


# A kernel begins in this folder and imports what is installed.
os.environ["PYTHONSAFEPATH"] = "1"
# Pictures go into the notebook.
os.environ.pop("MPLBACKEND", None)


def main(folder, out=None):
    for path in sorted(Path(folder).glob("*.py")):
        begun = time.perf_counter()
        notebook = jupytext.read(path)
        nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
        pictures = [
            output["data"]["image/png"]
            for cell in notebook.cells
            for output in cell.get("outputs", [])
            if "image/png" in output.get("data", {})
        ]
        assert pictures, f"{path}: no picture"
        print(f"{path.name}: {len(notebook.cells)} cells, {len(pictures)} pictures, {time.perf_counter() - begun:.1f} s")
        if out:
            target = Path(out)
            target.mkdir(parents=True, exist_ok=True)
            nbformat.write(notebook, target / f"{path.stem}.ipynb")
            for k, picture in enumerate(pictures):
                (target / f"{path.stem}-{k}.png").write_bytes(base64.b64decode(picture))


main(*sys.argv[1:])
