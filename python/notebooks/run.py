"""Executes notebooks in their folder and fails with the traceback of the first cell that fails.

usage: python run.py [--write] NOTEBOOK...    (--write keeps the outputs in the files)
"""

from __future__ import annotations

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def main(arguments: list[str]) -> None:
    """Executes each, in order."""
    keeps = "--write" in arguments
    for path in [Path(argument) for argument in arguments if argument != "--write"]:
        notebook = nbformat.read(path, as_version=4)
        NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}).execute()
        pictures = sum("image/png" in output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", []))
        if keeps:
            for cell in notebook.cells:
                cell.metadata.pop("execution", None)
            nbformat.write(notebook, path)
        print(f"{path.name}: {len(notebook.cells)} cells, {pictures} pictures")


if __name__ == "__main__":
    main(sys.argv[1:])
