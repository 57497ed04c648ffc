"""Real maps of ROS packages and benchmarks, against values that others published or that were computed apart."""

import json
import warnings

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError
from antnav.maps import image, map_server
from antnav.maps.occupancy import MapMeta, occupancy

from .conftest import SHARED_DATA

ROS = SHARED_DATA / "ros"
BROKEN = {
    "flatland/map_invalid_A/map.yaml": (MapFormatError, "without the key origin: .*origins"),
    "flatland/map_invalid_B/map.yaml": (MapFileError, "random_map.png"),
    "nav2_tests/invalid_image.yaml": (MapFileError, "invalid.png"),
    "nav2_tests/empty_room.yaml": (MapFileError, "empty.pgm"),
    "patrolling_sim/ctcv.yaml": (MapFileError, "ctcv_map.pgm"),
}


def read_queries():
    path = SHARED_DATA / "queries" / "ros_map_queries.json"
    return json.loads(path.read_text())["maps"] if path.is_file() else {}


def ros1_occupancy(name):
    path = ROS / name
    meta = MapMeta(path) if path.suffix != ".yaml" else map_server.read_meta(path)
    picture = image.read_image(meta.image)
    return occupancy(picture.pixels, picture.alpha, meta, "ros1")


@pytest.mark.parametrize("name", sorted(set(read_queries()) - set(BROKEN)))
def test_counts_of_every_ros_map(name):
    expected = read_queries()[name]
    values = ros1_occupancy(name.split(" (")[0])
    between = np.count_nonzero((values > 0) & (values < 100))
    assert list(values.shape) == expected["shape_rows_cols"]
    assert np.count_nonzero(values == 0) == expected["free"]
    assert np.count_nonzero(values == 100) == expected["occupied"]
    assert np.count_nonzero(values == -1) == expected["unknown"]
    assert between == expected["mid"]


def test_the_map_whose_yaml_names_another_image(shared_data):
    expected = read_queries()["patrolling_sim/ctcv.yaml"]
    grid = maps.load_map(shared_data / "ros" / "patrolling_sim" / "ctcv.pgm")
    assert grid.counts() == {kind: expected.get(kind, 0) for kind in ("free", "occupied", "unknown", "inflated")}


@pytest.mark.parametrize("rules", ["nav2", "ros1"])
def test_every_yaml_file_loads_or_fails_as_it_should(shared_data, rules):
    found = sorted((shared_data / "ros").rglob("*.yaml"))
    assert len(found) > 20
    for path in found:
        name = path.relative_to(shared_data / "ros").as_posix()
        if name in BROKEN:
            error, match = BROKEN[name]
            with pytest.raises(error, match=match):
                maps.load_map(path, rules=rules)
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", maps.MapWarning)
            grid = maps.load_map(path, rules=rules)
        assert list(grid.shape) == read_queries()[name]["shape_rows_cols"]
        assert grid.counts()["free"] > 0


def test_every_image_loads_bare(shared_data):
    found = [path for path in (shared_data / "ros").rglob("*") if path.suffix in (".pgm", ".png", ".bmp")]
    assert len(found) > 25
    for path in found:
        assert maps.load_map(path).shape[0] > 0


@pytest.mark.parametrize("rules", ["nav2", "ros1"])
@pytest.mark.parametrize(
    "name, key",
    [
        ("ros1_map_server/testmap.yaml", "testmap_10x10"),
        ("nav2_tests/testmap.yaml", "testmap_10x10"),
        ("ros1_map_server/testmap2.yaml", "testmap2_12x12_negate1"),
    ],
)
def test_unit_test_maps_of_map_server(shared_data, name, key, rules):
    expected = json.loads((shared_data / "queries" / "map_server_expected.json").read_text())[key]
    meta = map_server.read_meta(shared_data / "ros" / name)
    picture = image.read_image(meta.image)
    assert occupancy(picture.pixels, picture.alpha, meta, rules)[::-1].tolist() == expected  # bottom row first
    grid = maps.load_map(shared_data / "ros" / name, rules=rules)
    assert (grid.cells == 1).astype(int)[::-1].tolist() == (np.array(expected) // 100).tolist()


@pytest.mark.parametrize("name", ["ros1_map_server/testmap.bmp", "nav2_tests/testmap.bmp", "nav2_tests/testmap.pgm"])
def test_the_same_map_in_other_image_formats(shared_data, name):
    grid = maps.load_map(shared_data / "ros" / name)
    assert np.array_equal(grid.cells, maps.load_map(shared_data / "ros" / "ros1_map_server" / "testmap.yaml").cells)


def test_spectrum(shared_data):
    expected = json.loads((shared_data / "queries" / "map_server_expected.json").read_text())
    expected = expected["spectrum_png_occ0.65_free0.1"]
    path = shared_data / "ros" / "ros1_map_server" / "spectrum.png"
    pixels = image.read_image(path).pixels
    for mode in ("trinary", "scale"):
        values = occupancy(pixels, None, MapMeta(path, free_thresh=0.1, mode=mode), "ros1")
        ends = {str(value): int(np.count_nonzero(values == value)) for value in (100, 0)}
        assert ends == {key: expected[mode][key] for key in ("100", "0")}
        rest = values[(values != 0) & (values != 100)]
        assert rest.size == expected[mode].get("-1", expected[mode].get("between"))
        assert set(rest.tolist()) == {-1} if mode == "trinary" else (rest.min() >= 1 and rest.max() <= 99)
    raw = occupancy(pixels, None, MapMeta(path, mode="raw"), "ros1")
    assert sorted(raw.view(np.uint8).ravel().tolist()) == list(range(256))


def test_places_in_the_world(shared_data):
    ros = shared_data / "ros"
    assert maps.load_map(ros / "ros1_map_server" / "testmap.yaml").origin == (2.0, 3.0, 1.0)
    assert maps.load_map(ros / "ros1_map_server" / "testmap2.yaml").origin == (-2.0, -3.0, -1.0)
    assert maps.load_map(ros / "flatland" / "simple_test_A" / "map.yaml").origin == (0.05, -0.05, 1.57)
    assert maps.load_map(ros / "patrolling_sim" / "example.yaml").resolution == 0.15


def test_navs_own_depot_loads_unknown_as_free(shared_data):
    with pytest.warns(maps.MapWarning, match="8894 pixels of gray 205"):
        grid = maps.load_map(shared_data / "ros" / "nav2_bringup" / "depot.yaml")
    assert grid.counts()["unknown"] == 0


def test_speed_limits_are_free_unless_asked_for(shared_data):
    path = shared_data / "ros" / "nav2_bringup" / "depot_speed.yaml"
    assert maps.load_map(path).counts()["occupied"] == 3735  # black: n >= 1.0
    assert maps.load_map(path, rules="ros1").counts()["occupied"] == 0  # but never n > 1.0
    assert maps.load_map(path, occupied_from=1).counts()["occupied"] > 60_000


def test_every_movingai_map_and_scenario(shared_data):
    found = sorted((shared_data / "movingai").rglob("*.scen"))
    assert len(found) == 20
    count = 0
    for path in found:
        scenarios = maps.load_scenarios(path)
        stem = path.name.removesuffix(".scen").removesuffix("-even-1").removesuffix("-random-1").removesuffix(".map")
        grid = maps.load_map(path.with_name(f"{stem}.map"))
        for scenario in scenarios:
            assert (scenario.rows, scenario.cols) == grid.shape
            assert grid.cells[scenario.start] == grid.cells[scenario.goal] == 0
        count += len(scenarios)
    assert count > 30_000


@pytest.mark.parametrize(
    "name, shape, free",
    [
        ("dao/arena.map", (49, 49), 2054),
        ("dao/den312d.map", (81, 65), 2445),
        ("cities/Berlin_0_256.map", (256, 256), 48147),
        ("mapf/warehouse-10-20-10-2-1.map", (63, 161), 5699),
        ("format_only/divideandconquer.map", (512, 512), 115600),
    ],
)
def test_movingai_cells(shared_data, name, shape, free):
    grid = maps.load_map(shared_data / "movingai" / name)
    assert grid.shape == shape
    assert grid.counts() == {"free": free, "occupied": shape[0] * shape[1] - free, "unknown": 0, "inflated": 0}


def test_text_maps_of_the_literature(shared_data):
    found = sorted((shared_data / "aco_grids").glob("*.txt"))
    assert len(found) == 6
    for path in found:
        side = int(path.stem.rsplit("_", 1)[1])
        assert maps.load_map(path).shape == (side, side)
