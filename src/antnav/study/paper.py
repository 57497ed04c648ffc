"""The paper's own study: its systems on stand-ins for its three maps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from antnav import maps
from antnav.ants.presets import dai, luo, npaco, paco, traditional
from antnav.errors import MapFileError
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.world.problem import Problem

#: Runs of each algorithm on each map in the paper.
PAPER_RUNS = 10
NAMES = ("equiv20", "equiv30", "equiv40")
#: npaco with the two rules of Luo's that the paper's Figures 5 and 6 put in place of its own, and nothing else.
SWAPPED = "npaco with Luo's rules"

#: Endings of maps. A description names its image, and adds resolution and thresholds to it.
_DESCRIPTIONS, _CELLS = (".yaml", ".yml"), (".map", ".txt", ".npy")
_IMAGES = (".pgm", ".ppm", ".pbm", ".png", ".bmp")


def paper_algorithms() -> tuple[AlgorithmEntry, ...]:
    """The systems of Tables 2-4, and of Figures 5 and 6 npaco with Luo's two rules; beside it the whole of Luo's.

    PACO divides at the middle row, and paths stay as the ants found them, through its auxiliary cell: as in figures.
    """
    others = (choose(straighten=False) for choose in (npaco, traditional, dai, luo))
    choices = (paco(axis="row", straighten=False), *others)
    swapped = AlgorithmEntry(SWAPPED, npaco(pheromone="best_and_worst", deadlock="luo", straighten=False))
    return (*(AlgorithmEntry(choice.name, choice) for choice in choices), swapped)


def paper_study(runs: int, folder: Path | None = None) -> Study:
    """The study of `antnav reproduce`.

    Parameters
    ----------
    runs : int
        Seeds 0, 1, ..., runs - 1.
    folder : path, optional
        Where the three maps are, as NAME.txt (or another format that `load_map` reads) of 20, 30 and 40 rows with the
        paper's starts and goals; default: the built-in stand-ins. A YAML file goes before the image that it describes.

    Raises
    ------
    MapFileError
        The folder lacks a map, or has two of one name.
    """
    return Study("Reproduction of Si & Bao 2024", _maps(folder), paper_algorithms(), range(runs))


def _maps(folder: Path | None) -> Sequence[MapEntry]:
    entries = []
    for name in NAMES:
        start, goal = maps.builtin_query(name)
        grid = maps.builtin(name)
        source: dict[str, object] = {"builtin": name}
        if folder is not None:
            file = _file(folder, name)
            grid = replace(maps.load_map(file), name=name)
            source = {"file": str(file), "start_cell": start, "goal_cell": goal}
        problem = Problem.from_cells(grid, start, goal, corner_rule="allow")
        entries.append(MapEntry(name, problem, source))
    return entries


def _file(folder: Path, name: str) -> Path:
    """The folder's one map of that name."""
    files = sorted(path for path in folder.glob(f"{name}.*") if path.stem == name)
    described = [path for path in files if path.suffix.lower() in _DESCRIPTIONS]
    found = [path for path in files if path.suffix.lower() in (*_DESCRIPTIONS, *_CELLS, *_IMAGES * (not described))]
    if not found:
        rule = f"the folder has to hold {', '.join(f'{name}.txt' for name in NAMES)}, or these in another format"
        raise MapFileError(f"no map {name} in {folder}", rule, "add it, or leave the folder out")
    if len(found) > 1:
        rule = "each map is there once"
        raise MapFileError(f"{' and '.join(path.name for path in found)} in {folder}", rule, "move all but one away")
    return found[0]
