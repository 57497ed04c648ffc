from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from antnav.errors import MapError, ParameterError
from antnav.maps.occupancy import MapMeta, luma, occupancy, to_cells
from antnav.world.grid import Cell

META = MapMeta(Path("map.pgm"))
LEVELS = np.arange(256, dtype=np.uint8).reshape(16, 16)


def naive_nav2(gray: int, meta: MapMeta) -> int:
    """nav2's rule in single precision, a pixel at a time."""
    if meta.mode == "raw":
        return gray if gray <= 100 else -1
    single = np.float32
    n = single(gray) / single(255)
    n = n if meta.negate else single(1) - n
    if n <= single(meta.free_thresh):
        return 0
    if n >= single(meta.occupied_thresh):
        return 100
    if meta.mode == "trinary":
        return -1
    part = (n - single(meta.free_thresh)) / single(meta.occupied_thresh - meta.free_thresh) * single(100)
    return int(part) + (1 if part - int(part) >= 0.5 else 0)


def naive_humble(gray: int, meta: MapMeta) -> int:
    """The rule of nav2 up to humble, in double precision, a pixel at a time."""
    if meta.mode == "raw":
        return gray if gray <= 100 else -1
    n = gray / 255 if meta.negate else 1.0 - gray / 255
    if n > meta.occupied_thresh:
        return 100
    if n < meta.free_thresh:
        return 0
    if meta.mode == "trinary":
        return -1
    return round((n - meta.free_thresh) / (meta.occupied_thresh - meta.free_thresh) * 100)  # halves to even


def naive_ros1(gray: int, meta: MapMeta) -> int:
    """ROS 1's rule in double precision, a pixel at a time."""
    level = 255 - gray if meta.negate else gray
    if meta.mode == "raw":
        return level if level < 128 else level - 256
    n = (255 - level) / 255.0
    if n > meta.occupied_thresh:
        return 100
    if n < meta.free_thresh:
        return 0
    if meta.mode == "trinary":
        return -1
    return int(1 + 98 * (n - meta.free_thresh) / (meta.occupied_thresh - meta.free_thresh))


@pytest.mark.parametrize("rules", ["nav2", "humble", "ros1"])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
@pytest.mark.parametrize("negate", [False, True])
@pytest.mark.parametrize("thresholds", [(0.65, 0.196), (0.65, 0.25), (1.0, 0.0), (0.99, 0.01), (0.4, 0.1), (0.6, 0.4)])
def test_every_gray_level_as_the_map_server_reads_it(rules, mode, negate, thresholds):
    meta = replace(META, mode=mode, negate=negate, occupied_thresh=thresholds[0], free_thresh=thresholds[1])
    naive = {"nav2": naive_nav2, "humble": naive_humble, "ros1": naive_ros1}[rules]
    values = occupancy(LEVELS, None, meta, rules)
    assert values.dtype == np.int8
    assert values.ravel().tolist() == [naive(gray, meta) for gray in range(256)]
    if mode != "trinary" or negate:
        return
    colour = np.repeat(LEVELS[..., None], 3, axis=2)  # equal channels average to the gray itself
    assert np.array_equal(occupancy(colour, None, meta, rules), values)


def test_the_rules_differ_where_a_level_meets_a_threshold():
    level = 102  # n = 153 / 255 = 0.6
    meta = replace(META, occupied_thresh=0.6, free_thresh=0.4)
    pixels = np.full((1, 1), level, dtype=np.uint8)
    assert occupancy(pixels, None, meta, "nav2") == 100
    assert occupancy(pixels, None, meta, "humble") == -1
    assert occupancy(pixels, None, meta, "ros1") == -1


def test_equal_thresholds_in_scale_mode_leave_nothing_between():
    meta = replace(META, occupied_thresh=0.5, free_thresh=0.5, mode="scale")
    assert set(np.unique(occupancy(LEVELS, None, meta))) == {0, 100}


RED, GREEN, BLUE, YELLOW, WHITE = [255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], [255, 255, 255]
COLOURS = np.array([[RED, GREEN, BLUE, YELLOW, WHITE]], dtype=np.uint8)


def test_colours_have_the_brightness_that_graphicsmagick_gives_them():
    assert luma(COLOURS).tolist() == [[76, 149, 29, 225, 255]]
    gray = np.repeat(np.arange(256, dtype=np.uint8)[None, :, None], 3, axis=2)
    assert luma(gray).tolist() == [list(range(256))]
    # seen in GraphicsMagick 1.3.40, where sums of 8-bit levels would round the other way
    odd = np.array([[[90, 155, 36], [87, 248, 65], [69, 26, 229], [209, 64, 210]]], dtype=np.uint8)
    assert luma(odd).tolist() == [[122, 179, 62, 124]]
    assert occupancy(COLOURS, None, META).tolist() == [[100, -1, 100, 0, 0]]
    assert occupancy(COLOURS, None, replace(META, mode="raw")).tolist() == [[76, -1, 29, -1, -1]]


@pytest.mark.parametrize("rules", ["humble", "ros1"])
def test_colour_channels_were_averaged_before(rules):  # n = 0.667, 0.667, 0.667, 0.333, 0
    assert occupancy(COLOURS, None, META, rules).tolist() == [[100, 100, 100, -1, 0]]


def test_a_large_colour_image_is_read_band_by_band():
    pixels = np.zeros((3, 2**20, 3), dtype=np.uint8)
    pixels[1] = 255
    assert occupancy(pixels, None, META)[:, 0].tolist() == [100, 0, 100]


def test_transparency():
    gray = np.array([[254, 254, 0, 128, 128, 200]], dtype=np.uint8)
    alpha = np.array([[255, 254, 0, 0, 200, 255]], dtype=np.uint8)
    scale = replace(META, mode="scale")
    assert occupancy(gray, alpha, META).tolist() == [[0, -1, -1, -1, -1, -1]]
    assert occupancy(gray, alpha, scale).tolist() == [[0, -1, -1, -1, -1, 4]]
    assert occupancy(gray, alpha, replace(META, mode="raw")).tolist() == [[-1, -1, 0, -1, -1, -1]]
    # ROS 1 averages alpha with the channels: 200 becomes (3 * 200 + 255) / 4 = 213.75, which is free
    assert occupancy(gray, alpha, META, "ros1").tolist() == [[0, 0, 100, -1, -1, 0]]
    assert occupancy(gray, alpha, scale, "ros1").tolist() == [[0, 0, 100, -1, 66, 5]]
    assert occupancy(gray, alpha, META, "humble").tolist() == [[0, 0, 100, -1, -1, 0]]
    assert occupancy(gray, alpha, scale, "humble").tolist() == [[0, -1, -1, -1, -1, 4]]


def test_cells_follow_navs_static_layer():
    values = np.array([[0, 1, 50, 99, 100, -1]], dtype=np.int8)
    assert to_cells(values).tolist() == [[Cell.FREE] * 4 + [Cell.OCCUPIED, Cell.UNKNOWN]]
    assert to_cells(values, 50).tolist() == [[0, 0, 1, 1, 1, 2]]
    assert to_cells(np.array([[101, 127, -128, -2]], dtype=np.int8)).tolist() == [[1, 1, 1, 1]]  # ROS 1's raw bytes


def test_cells_of_an_array_of_any_whole_type():
    for dtype in (int, np.int16, ">i4", np.uint8):
        assert to_cells(np.array([[0, 100]], dtype=dtype)).tolist() == [[0, 1]]
    assert to_cells([[-1, 0, 100]], np.int64(50)).tolist() == [[2, 0, 1]]
    assert to_cells(np.ma.masked_equal([[0, 100, 7]], 7)).tolist() == [[0, 1, 2]]
    assert to_cells(np.ma.masked_equal(np.array([[0, 100, 7]], np.uint8), 7)).tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("values", [[[0.0]], [[200]], [[-200]], [0, 1], [["0"]], [[None]], [[True]]], ids=str)
def test_other_arrays_are_no_occupancy(values):
    with pytest.raises(MapError):
        to_cells(values)


@pytest.mark.parametrize("value", [0, 101, True, 50.0, "50", None])
def test_occupied_from_is_checked(value):
    with pytest.raises(ParameterError, match="occupied_from"):
        to_cells(np.zeros((1, 1), dtype=np.int8), value)


def test_rules_are_checked():
    with pytest.raises(ParameterError, match="nav2, humble or ros1"):
        occupancy(LEVELS, None, META, "ros2")
