"""The paper's study: which file of a folder is taken for a map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from antnav import maps
from antnav.errors import MapFileError
from antnav.study.paper import NAMES, paper_study


def saved(folder: Path, ending: str) -> Path:
    for name in NAMES:
        maps.save_map(replace(maps.builtin(name), resolution=0.25), folder / f"{name}{ending}")
    return folder


def test_the_description_goes_before_its_image(tmp_path: Path) -> None:
    study = paper_study(1, saved(tmp_path, ".yaml"))
    assert [entry.problem.grid.resolution for entry in study.maps] == [0.25] * 3
    assert [entry.problem.grid.name for entry in study.maps] == list(NAMES)


def test_images_alone_are_taken(tmp_path: Path) -> None:
    for path in saved(tmp_path, ".yaml").glob("*.yaml"):
        path.unlink()
    assert [entry.problem.grid.resolution for entry in paper_study(1, tmp_path).maps] == [1.0] * 3


def test_other_files_are_passed_over(tmp_path: Path) -> None:
    for name in ("equiv20.bak", "equiv20.json", "equiv20.old.txt", "equiv200.txt"):
        (saved(tmp_path, ".txt") / name).write_text("junk")
    assert paper_study(1, tmp_path).maps[0].problem.grid.digest == maps.builtin("equiv20").digest


def test_two_maps_of_one_name_and_none(tmp_path: Path) -> None:
    with pytest.raises(MapFileError, match="no map equiv20"):
        paper_study(1, tmp_path)
    saved(saved(tmp_path, ".txt"), ".map")
    with pytest.raises(MapFileError, match=r"equiv20\.map and equiv20\.txt"):
        paper_study(1, tmp_path)
