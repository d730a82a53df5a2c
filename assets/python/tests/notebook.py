"""Runs the notebook on the simulated hand: notebook.py [FOLDER], which its pictures are written to."""

import base64
import pathlib
import sys

import nbformat
from nbclient import NotebookClient

place = pathlib.Path(__file__).parent.parent / "first_grasp.ipynb"
notebook = nbformat.read(place, as_version=4)
assert not any(cell.get("outputs") for cell in notebook.cells), "committed without what it printed"
NotebookClient(notebook, timeout=600).execute()
outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
words = "".join(output.get("text", "") for output in outputs)
print(words)
assert len(pictures) == 2, len(pictures)
assert "holding" in words and " 0 lost" in words and "closes in" in words, words
for number, picture in enumerate(pictures):
    if len(sys.argv) > 1:
        (pathlib.Path(sys.argv[1]) / f"notebook-{number}.png").write_bytes(base64.b64decode(picture))
