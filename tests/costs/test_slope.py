"""Elevation from files: what is read, and what is refused. What slopes cost is tested in tests/world/test_slope.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from antnav import costs
from antnav.errors import MapFileError, MapFormatError, MapSizeError, ParameterError

HEIGHTS = np.array([[0.0, 3.0, 250.0], [4.0, 9.0, 1.0]])


def test_defaults_are_of_a_robot_that_brakes() -> None:
    field = costs.slope(HEIGHTS)
    assert (field.slope.up, field.slope.down) == (10.0, 0.0)
    assert field.name == "slope"
    assert not field.values.any()


@pytest.mark.parametrize("name", ["h.npy", "h.csv", "h.txt", "semi.csv", "h.png", "h.pgm"])
def test_files_hold_the_numbers(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    if path.suffix == ".npy":
        np.save(path, HEIGHTS)
    elif path.suffix in (".csv", ".txt"):
        np.savetxt(path, HEIGHTS, delimiter={"h.csv": ",", "semi.csv": ";"}.get(name, " "))
    else:
        Image.fromarray(HEIGHTS.astype(np.uint8)).save(path)
    for given in (path, str(path)):
        assert costs.slope(given, up=2.0).digest == costs.slope(HEIGHTS, up=2.0).digest


@pytest.mark.parametrize(
    ("name", "content", "error"),
    [
        ("absent.npy", None, MapFileError),
        ("h.npy", b"no array", MapFormatError),
        ("h.csv", b"1,2\n3", MapFormatError),
        ("h.csv", b"a,b", MapFormatError),
        ("h.txt", b"", MapSizeError),
        ("h.png", b"no image", MapFormatError),
        ("h.csv", b"1,nan", ParameterError),
    ],
)
def test_what_is_no_elevation_is_refused(name: str, content: bytes | None, error: type, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(error):
        costs.slope(tmp_path / name)


def test_colours_are_no_heights(tmp_path: Path) -> None:
    Image.fromarray(np.arange(18, dtype=np.uint8).reshape(2, 3, 3)).save(tmp_path / "h.png")
    with pytest.raises(MapFormatError, match="gray levels"):
        costs.slope(tmp_path / "h.png")
