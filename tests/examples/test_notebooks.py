"""Notebooks run from top to bottom, and what they keep is what they print."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("nbclient", reason="needs nbclient and ipykernel, see the extra dev")
pytest.importorskip("ipykernel", reason="needs nbclient and ipykernel, see the extra dev")

import nbformat

from tests.examples import notebooks

EACH = pytest.mark.parametrize("file", notebooks.NOTEBOOKS, ids=lambda file: file.stem)


def told(cell):
    """What a cell tells that is the same on every machine: kinds of outputs, and their texts without pictures."""
    outputs = []
    for output in cell.outputs:
        texts = output.get("data", {"stream": output.get("text", "")})
        for kind, text in sorted(texts.items()):
            outputs.append((kind, "" if kind.startswith("image/") else re.sub(r"base64,[^\"']*", "", text)))
    return [kind for kind, _ in outputs] if notebooks.varies(cell) else outputs


@pytest.mark.slow
@EACH
def test_no_cell_raises_and_all_print_what_is_kept(file, tmp_path):
    for module in ("matplotlib", "anywidget", "rosbags", "moocore", "distributed"):
        pytest.importorskip(module, reason="notebooks need the extras plot, notebook, ros, fronts and cluster")
    kept = nbformat.read(file, as_version=4)
    fresh = notebooks.tidied(notebooks.executed(file, tmp_path), nbformat.v4.new_notebook())
    for before, after in zip(kept.cells, fresh.cells, strict=True):
        if before.cell_type == "code":
            assert told(after) == told(before), before.source


@EACH
def test_what_is_kept_is_small_and_tells_nothing_of_a_machine(file):
    text = file.read_text(encoding="utf-8")
    assert file.stat().st_size <= 300_000
    assert not re.search(r"/(tmp|home|work|root)/|0x[0-9a-f]{6}|Traceback", re.sub(r"base64,[^\"]*", "", text))
    notebook = nbformat.read(file, as_version=4)
    nbformat.validate(notebook)
    assert set(notebook.metadata) == {"kernelspec", "language_info"}
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    assert sum(bool(cell.outputs) for cell in code) >= len(code) / 2
    assert all(set(cell.metadata) <= {"tags"} for cell in notebook.cells)


@EACH
def test_links_between_notebooks_and_pages_lead_somewhere(file):
    notebook = nbformat.read(file, as_version=4)
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    links = [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if not link.startswith("https://")]
    assert [link for link in links if not (file.parent / link).exists()] == []


def test_the_page_and_the_folder_name_the_same_notebooks():
    page = (notebooks.FOLDER.parents[1] / "docs" / "notebooks.md").read_text(encoding="utf-8")
    assert re.findall(r"notebooks/(\w+\.ipynb)", page) == [file.name for file in notebooks.NOTEBOOKS]
