"""The notebook of the documents drives, plots and explains."""

import os
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(os.environ["SAPHIRA_SOURCE_DIR"]) / "docs" / "a-drive.ipynb"


def test_the_notebook_runs(programs: None) -> None:
    """To a room of the small office: that of the page is the demo's."""
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook: Any = nbformat.reads(NOTEBOOK.read_text().replace("N2", "C"), as_version=4)
    nbclient.NotebookClient(notebook, timeout=200, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert not [output for output in outputs if output.output_type == "error"]
    assert "GOAL_SUCCEEDED" in str(outputs)
    assert [output for output in outputs if "image/png" in output.get("data", {})]
    assert "".join(output.get("text", "") for output in outputs).count("\n") > 2
