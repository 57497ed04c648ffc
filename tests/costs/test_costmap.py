from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from antnav import costs
from antnav.errors import MapFileError, MapFormatError, ParameterError

VALUES = np.array([[0, 63, 126, 252], [253, 254, 255, 1]], np.uint8)


def test_values_are_shares_of_252_and_the_rest_blocks() -> None:
    field = costs.costmap(VALUES, weight=4.0)
    np.testing.assert_allclose(field.values, [[0.0, 1.0, 2.0, 4.0], [0.0, 0.0, 0.0, 4 / 252]])
    assert field.blocked.tolist() == [[False] * 4, [True, True, True, False]]


def test_unknown_cells_may_be_the_dearest() -> None:
    field = costs.costmap(VALUES, weight=4.0, allow_unknown=True)
    assert field.blocked.tolist() == [[False] * 4, [True, True, False, False]]
    assert field.values[1, 2] == 4.0


def test_253_may_be_open() -> None:
    field = costs.costmap(VALUES, blocked_from=254)
    assert field.blocked.tolist() == [[False] * 4, [False, True, True, False]]
    assert field.values[1, 0] == 1.0


@pytest.mark.parametrize("suffix", [".pgm", ".png"])
def test_an_image_holds_the_values(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"costs{suffix}"
    Image.fromarray(VALUES).save(path)
    assert costs.costmap(path).digest == costs.costmap(str(path)).digest == costs.costmap(VALUES).digest


def test_images_of_another_kind_are_refused(tmp_path: Path) -> None:
    Image.fromarray(VALUES).save(tmp_path / "costs.jpg")
    Image.fromarray(np.arange(12, dtype=np.uint8).reshape(2, 2, 3)).save(tmp_path / "colour.png")
    for name in ("costs.jpg", "colour.png"):
        with pytest.raises(MapFormatError, match="gray"):
            costs.costmap(tmp_path / name)
    with pytest.raises(MapFileError):
        costs.costmap(tmp_path / "none.pgm")


@pytest.mark.parametrize(
    "values", [[[-1, 0]], [[256]], [[0.5]], [[math.nan]], [[True]], [1, 2], [[1], [1, 2]], None, b"ab"]
)
def test_what_is_no_costmap_is_refused(values: object) -> None:
    with pytest.raises(ParameterError, match="costmap"):
        costs.costmap(values)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "wrong", [{"weight": 1e308}, {"weight": -1}, {"weight": math.nan}, {"blocked_from": 252}, {"blocked_from": "254"}]
)
def test_other_numbers_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        costs.costmap(VALUES, **wrong)  # type: ignore[arg-type]


def test_navfn_willow_garage(data: Path) -> None:
    path = data / "ros" / "ros1_navfn" / "willow_costmap.pgm"
    field = costs.costmap(path)
    assert field.values.shape == (1217, 1132)
    assert np.unique(field.values).tolist() == [0.0, 50 / 252]
    assert np.count_nonzero(~field.blocked) == 149258  # the pixels of 50
    assert np.count_nonzero(~costs.costmap(path, blocked_from=254).blocked) == 149258 + 96919  # and those of 253
