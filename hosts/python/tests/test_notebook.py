"""The notebook, run as Jupyter runs it: pictures are shown, and what is not valid is told."""

import base64
from pathlib import Path

import nbformat
from nbconvert.preprocessors import ExecutePreprocessor

PNG = b"\x89PNG\r\n\x1a\n"


def test_the_notebook_shows_its_pictures():
    notebook = nbformat.read(Path(__file__).parent.parent / "bowl.ipynb", as_version=4)
    ExecutePreprocessor(timeout=120, kernel_name="python3").preprocess(notebook)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    shown = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    pictures = [base64.b64decode(picture) for picture in shown]
    assert len(pictures) == 2 and pictures[0] != pictures[1]
    assert all(picture.startswith(PNG) for picture in pictures)
    told = [output["text"] for output in outputs if output.output_type == "stream"]
    assert len(told) == 1 and told[0].startswith("objects[1].material.roughness: error[VA020]")
