"""The files of a query: what a command writes beside what it prints."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from antnav.cli.inputs import check_output, files_of_map
from antnav.errors import AntnavError, OutputError, ParameterError
from antnav.exchange import bag
from antnav.planner.planner import Planner
from antnav.planner.result import Result
from antnav.trajectories.files import LINE_ENDINGS

if TYPE_CHECKING:
    from antnav.fronts.front import Front
    from antnav.plot.figure import Panels
    from antnav.trajectories.model import Trajectory

PICTURES = (".png", ".svg", ".pdf")
FILMS = (".gif", ".webp", ".mp4", ".html")
ENDINGS = (".json", ".csv", *PICTURES)
PATH_ENDINGS = (*ENDINGS, *LINE_ENDINGS, *FILMS)


def check_outputs(outputs: Sequence[Path], map_name: str, endings: Sequence[str] = ENDINGS) -> None:
    """Refuse files that could not be written later, also for want of a library, before any work is done.

    Raises
    ------
    ParameterError, OutputError
    """
    sources = files_of_map(map_name) if outputs else []
    for path in outputs:
        check_output(path, endings, sources, folder=path.suffix.lower() == ".rosbag2")
        if path.suffix.lower() in bag.ENDINGS:
            bag.require_rosbags()
        if _is_picture(path) and find_spec("matplotlib") is None:
            raise ParameterError(f"output {path}", "a picture needs matplotlib", 'run: pip install "antnav[plot]"')


def import_for_pictures(outputs: Sequence[Path]) -> None:
    """Import what pictures need, if there are any, while kernels run: these do without the interpreter's lock."""
    if any(map(_is_picture, outputs)):
        # no daemon: a library in C++ may abort where Python ends in the midst of its import
        threading.Thread(target=_import_for_pictures).start()


def _import_for_pictures() -> None:
    with contextlib.suppress(Exception):  # that is told where the picture is drawn
        from antnav.plot.style import require_matplotlib

        require_matplotlib()
        import matplotlib.backends.backend_agg
        import matplotlib.figure
        import matplotlib.style  # noqa: F401


def save_all(
    result: Result | Front, outputs: Sequence[Path], trajectory: Trajectory | None = None, panels: Panels = "both"
) -> tuple[list[Path], BaseException | None]:
    """Write the files of a result or a front; see `write_all`."""
    return write_all(outputs, partial(_save, result), partial(_picture, result, trajectory, panels))


def check_films(outputs: Sequence[Path], algorithm: Planner) -> None:
    """Refuse films of what cannot be filmed, before any work is done.

    Raises
    ------
    ParameterError
    """
    for path in outputs:
        if path.suffix.lower() in FILMS:
            from antnav.plot.animation import check_ending

            check_ending(path)
            if not algorithm.ants:
                rule = f"films are of ants, and {algorithm.name} has none"
                raise ParameterError(f"output {path}", rule, "choose a preset, or a picture")


def _save(result: Result | Front, path: Path) -> None:
    if path.suffix.lower() in FILMS and isinstance(result, Result):
        from antnav.plot.animation import animate

        animate(result.problem, result.algorithm, seed=result.seed).save(path)
    else:
        result.save(path)


def write_all(
    outputs: Sequence[Path], save: Callable[[Path], None], draw: Callable[[Path], None]
) -> tuple[list[Path], BaseException | None]:
    """Write the files, pictures last. No failure must cost the user the answer: the first comes back with the rest."""
    saved: list[Path] = []
    failure: BaseException | None = None
    for path in sorted(outputs, key=_is_picture):
        try:
            if _is_picture(path):
                _draw(draw, path)
            else:
                save(path)
            saved.append(path)
        except Exception as error:
            failure = failure or error
        except KeyboardInterrupt as interrupt:  # of a picture that takes long
            return saved, interrupt
    return saved, failure


def _is_picture(path: Path) -> bool:
    return path.suffix.lower() in PICTURES


def _picture(result: Result | Front, trajectory: Trajectory | None, panels: Panels, path: Path) -> None:
    from antnav.plot import save_picture

    save_picture(result, path, trajectory=trajectory, panels=panels)


def _draw(draw: Callable[[Path], None], path: Path) -> None:
    try:
        draw(path)
    except AntnavError:
        raise
    except Exception as error:  # matplotlib has many settings, fonts and versions
        remedy = "the path itself is found: save it as .json, and draw that"
        raise OutputError(f"picture {path}", f"{type(error).__name__}: {error}", remedy) from error
