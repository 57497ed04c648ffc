import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, MapSizeError
from antnav.world.grid import GridMap

from . import samples


@pytest.fixture
def load(tmp_path):
    def run(data, name="a.map"):
        path = tmp_path / name
        path.write_bytes(data)
        return maps.load_scenarios(path) if name.endswith(".scen") else maps.load_map(path)

    return run


def test_letters(load):
    assert load(samples.MOVINGAI).cells.tolist() == [[0, 0, 1, 1], [0, 0, 1, 1], [0, 1, 0, 0]]


@pytest.mark.parametrize(
    "data",
    [
        samples.MOVINGAI.replace(b"\n", b"\r\n"),
        samples.MOVINGAI.rstrip(),
        samples.MOVINGAI + b"\n\r\n",
        samples.MOVINGAI.replace(b"@T\n", b"@T  \n"),
        samples.MOVINGAI.replace(b"height 3\nwidth 4", b"width 4\nheight 3"),
        b"\xef\xbb\xbf" + samples.MOVINGAI,
    ],
    ids=["CRLF", "no final newline", "empty lines at the end", "blanks", "width first", "byte order mark"],
)
def test_harmless_variants(load, data):
    assert load(data) == load(samples.MOVINGAI)


@pytest.mark.parametrize(
    "old, new, match",
    [
        (b"type octile", b"type hex", "line 1: 'type hex'"),
        (b"height 3", b"height three", "line 2: 'height three'"),
        (b"height 3", b"height -3", "line 2"),
        (b"height 3", b"height " + b"3" * 5000, "line 2"),
        (b"height 3", b"height 3 3", "line 2"),
        (b"width 4", b"height 4", "line 3: 'height 4'"),
        (b"width 4\n", b"", "line 3: 'map'"),
        (b"map\n", b"", "line 4"),
        (b"map\n.", b"", "line 4"),
        (b"height 3", b"height 4", "3 rows of cells.*height 4"),
        (b"height 3", b"height 2", "3 rows of cells.*height 2"),
        (b"G.OS", b"G.O", "line 6 of 3 cells.*width 4"),
        (b"G.OS", b"G.OS.", "line 6 of 5 cells"),
        (b"G.OS", b"G.xS", "line 6, column 3: 'x'"),
        (b"G.OS", b"G.\xffS", "line 6, column 3: 'ÿ'"),
        (b"\nG.OS\n", b"\n\nG.OS", "3 rows|line 6 of 0 cells"),
    ],
)
def test_errors_name_the_line(load, old, new, match):
    with pytest.raises(MapFormatError, match=match):
        load(samples.MOVINGAI.replace(old, new))


def test_header_alone(load):
    for data in (b"type octile", b"type octile\n", b"type octile\nheight 3\nwidth 4"):
        with pytest.raises(MapFormatError, match="header"):
            load(data)


@pytest.mark.parametrize("rows, cols", [(0, 4), (3, 0), (10**9, 1), (31_623, 31_623)])
def test_sizes_are_refused_by_the_header(load, rows, cols):
    with pytest.raises(MapSizeError):
        load(b"type octile\nheight %d\nwidth %d\nmap\n....\n" % (rows, cols))


def test_scenarios(load):
    first, second = load(samples.SCENARIOS, "a.scen")
    assert first == maps.Scenario(0, "maps/a.map", 4, 3, start=(0, 0), goal=(2, 1), optimal=2.41421356)
    assert second == maps.Scenario(7, "maps/a.map", 4, 3, start=(2, 3), goal=(1, 0), optimal=3.41)
    assert load(b"version 1.0\r\n", "a.scen") == []
    spaced = samples.SCENARIOS.replace(b"\tmaps/a.map", b"\tmy maps/a.map").replace(b"\n", b"\r\n")
    assert load(spaced, "a.scen")[0].map_name == "my maps/a.map"


@pytest.mark.parametrize(
    "line",
    [
        b"0\ta.map\t4\t3\t0\t0\t1\t2",
        b"0\ta.map\t4\t3\t0\t0\t1\t2\t2\t2",
        b"0\ta.map\t4\t3\t4\t0\t1\t2\t2",
        b"0\ta.map\t4\t3\t0\t0\t1\t3\t2",
        b"0\ta.map\t4\t3\t0\t-1\t1\t2\t2",
        b"0\ta.map\t4\t3\t0\t0\t1\t2\tnan",
        b"0\ta.map\t4\t3\t0\t0\t1\t2\t-1",
        b"0\ta.map\t4\t3\t0\t0\t1\t2\tfar",
        b"0\ta.map\t0\t3\t0\t0\t1\t2\t2",
        b"0\ta.map\t40000\t40000\t0\t0\t1\t2\t2",
        b"x\ta.map\t4\t3\t0\t0\t1\t2\t2",
        b"0\ta.map\t4\t3\t0\t0\t1\t" + b"1" * 5000 + b"\t2",
        b"\xff\xfe",
    ],
)
def test_a_wrong_scenario_names_its_line(load, line):
    with pytest.raises(MapFormatError, match="line 4"):
        load(samples.SCENARIOS + line, "a.scen")


def test_scenarios_and_maps_taken_for_each_other(load):
    with pytest.raises(MapFormatError, match="load_scenarios"):
        load(samples.SCENARIOS)
    with pytest.raises(MapFormatError, match="version 1"):
        load(samples.MOVINGAI, "a.scen")
    with pytest.raises(MapFileError):
        maps.load_scenarios("none.scen")


def test_round_trip(tmp_path):
    grid = GridMap(np.array([[0, 1, 0], [1, 0, 3]]))
    maps.save_map(grid, tmp_path / "a.map")
    assert maps.load_map(tmp_path / "a.map").cells.tolist() == [[0, 1, 0], [1, 0, 1]]
    with pytest.warns(maps.MapWarning, match="2 unknown cells") as caught:
        maps.save_map(GridMap([[0, 2, 2]]), tmp_path / "a.map")
    assert caught[0].filename == __file__
    assert maps.load_map(tmp_path / "a.map").cells.tolist() == [[0, 1, 1]]
