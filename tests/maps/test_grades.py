"""Occupancy values that a map does not keep."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, ParameterError

META = """\
image: mask.pgm
resolution: 0.5
origin: [1, 2, 0]
negate: 0
occupied_thresh: 1.0
free_thresh: 0.0
mode: """


def written(folder: Path, mode: str, pixels: list[int]) -> Path:
    (folder / "mask.pgm").write_bytes(b"P5\n%d 1\n255\n" % len(pixels) + bytes(pixels))
    path = folder / "mask.yaml"
    path.write_text(META + mode)
    return path


@pytest.mark.parametrize(
    ("mode", "values"),
    [("scale", [0, 20, 50, 75, 100]), ("raw", [-1, -1, -1, 64, 0]), ("trinary", [0, -1, -1, -1, 100])],
)
def test_values_are_what_the_map_server_publishes(mode: str, values: list[int], tmp_path: Path) -> None:
    path = written(tmp_path, mode, [255, 204, 127, 64, 0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # nothing is lost
        grades = maps.load_grades(path)
    assert grades.values.tolist() == [values]
    assert (grades.values.dtype, grades.values.flags.writeable) == (np.int8, False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert grades.grid == maps.load_map(path)
    assert repr(grades) == f"Grades({grades.grid!r}, {min(values)}..{max(values)})"


def test_rules_of_ros1(tmp_path: Path) -> None:
    assert maps.load_grades(written(tmp_path, "scale", [204]), rules="ros1").values.tolist() == [[20]]  # 1 + 98 / 5


def test_files_without_meaning_of_gray_are_refused(tmp_path: Path) -> None:
    written(tmp_path, "scale", [0])
    with pytest.raises(MapFormatError, match="map_server YAML"):
        maps.load_grades(tmp_path / "mask.pgm")
    with pytest.raises(MapFileError):
        maps.load_grades(tmp_path / "none.yaml")
    with pytest.raises(ParameterError, match="rules"):
        maps.load_grades(tmp_path / "mask.yaml", rules="ros2")  # type: ignore[arg-type]
    (tmp_path / "mask.pgm").unlink()
    with pytest.raises(MapFileError, match="named by"):
        maps.load_grades(tmp_path / "mask.yaml")
