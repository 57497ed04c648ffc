"""Runs the notebooks of `examples/notebooks`.

`python -m tests.examples.notebooks [FILE ...]` renews the outputs that they keep: pictures with few colours, films with
few frames, nothing of when and where. Outputs of a cell with the tag "varies", such as times, stay as they are until
its source is another.
"""

from __future__ import annotations

import base64
import io
import json
import os
import re
import sys
import tempfile
from itertools import pairwise
from pathlib import Path

import nbformat
from jupyter_client.kernelspec import KernelSpec, KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbformat import NotebookNode
from PIL import Image

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: The tag of cells whose outputs differ from run to run.
VARIES = "varies"
DPI = 72
#: Of kept pictures, colours; of kept films, frames and pixels of the width at most.
COLOURS, FRAMES, WIDTH = 200, 40, 300


class ThisPython(KernelSpecManager):
    """The interpreter that runs the tests, whatever kernels the machine has."""

    def get_kernel_spec(self, kernel_name: str) -> KernelSpec:
        argv = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        return KernelSpec(argv=argv, display_name="Python 3", language="python")


def executed(file: Path, folder: Path) -> NotebookNode:
    """The notebook after all its cells have run in `folder`; raises what the first bad cell raised."""
    notebook = nbformat.read(file, as_version=4)
    settings = folder / "settings"
    settings.mkdir()
    (settings / "matplotlibrc").write_text(f"figure.dpi: {DPI}\n")
    manager = AsyncKernelManager(kernel_spec_manager=ThisPython(), connection_file=str(settings / "kernel.json"))
    client = NotebookClient(notebook, km=manager, timeout=900, coalesce_streams=True, store_widget_state=False)
    client.resources = {"metadata": {"path": str(folder)}}
    client.execute(env=os.environ | {"IPYTHONDIR": str(settings), "MATPLOTLIBRC": str(settings)})
    return notebook


def varies(cell: NotebookNode) -> bool:
    """Whether its outputs differ from run to run."""
    return VARIES in cell.metadata.get("tags", ())


def tidied(notebook: NotebookNode, before: NotebookNode) -> NotebookNode:
    """The notebook as it is kept; `before` has what was kept so far."""
    kept = {cell.source: cell.outputs for cell in before.cells if cell.cell_type == "code" and cell.outputs}
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in notebook.cells:
        tags = cell.metadata.get("tags")
        cell.metadata = {"tags": tags} if tags else {}
        if cell.cell_type == "code":
            fresh = [_small(output) for output in cell.outputs if output.get("name") != "stderr"]
            cell.outputs = kept.get(cell.source, fresh) if varies(cell) else fresh
    return notebook


def _small(output: NotebookNode) -> NotebookNode:
    data = output.get("data", {})
    if "application/vnd.jupyter.widget-view+json" in data:  # nothing without its kernel
        output.data = {"text/plain": "a widget: run the notebook to see it"}
    elif "data-antnav-film" in data.get("text/html", ""):
        script = re.search(r'<script type="application/json">(.*?)</script>', data["text/html"], re.DOTALL)
        film = json.loads(script.group(1))
        frames = [Image.open(io.BytesIO(base64.b64decode(frame))) for frame in film["frames"]]
        output.data = {"text/html": _moving(frames, film["times"])}
    elif "image/gif" in data:
        film = Image.open(io.BytesIO(base64.b64decode(data["image/gif"])))
        frames, times = [], []
        for number in range(film.n_frames):
            film.seek(number)
            frames.append(film.convert("RGB"))
            times.append(film.info["duration"])
        output.data = {"text/html": _moving(frames, times)}
    elif "image/png" in data:
        picture = Image.open(io.BytesIO(base64.b64decode(data["image/png"]))).convert("RGB")
        data["image/png"] = _encoded([picture.quantize(COLOURS, dither=Image.Dither.NONE)], "PNG", optimize=True)
        data.pop("text/plain", None)
    return output


def _moving(frames: list[Image.Image], times: list[float]) -> str:
    """A small film of some of the frames, as an image in HTML."""
    every = -(-len(frames) // FRAMES)
    shown = [*range(0, len(frames) - 1, every), len(frames) - 1]
    spans = [sum(times[here:there]) for here, there in pairwise([*shown, len(frames)])]
    small = []
    for number in shown:
        frame = frames[number].convert("RGB")
        size = WIDTH, round(frame.height * WIDTH / frame.width)
        small.append(frame.resize(size, Image.Resampling.LANCZOS) if frame.width > WIDTH else frame)
    picture = _encoded(small, "WEBP", save_all=True, duration=spans, loop=0, quality=40, method=6)
    return f'<img alt="film" src="data:image/webp;base64,{picture}">'


def _encoded(pictures: list[Image.Image], kind: str, **options: object) -> str:
    content = io.BytesIO()
    more = {"append_images": pictures[1:]} if len(pictures) > 1 else {}
    pictures[0].save(content, kind, **more, **options)
    return base64.b64encode(content.getvalue()).decode()


def main(files: list[Path]) -> None:
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            notebook = tidied(executed(file, Path(folder)), nbformat.read(file, as_version=4))
        nbformat.write(notebook, file)
        print(f"{file.name}: {file.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]] or NOTEBOOKS)
