import warnings
from itertools import pairwise

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, MapSizeError, OutputError, ParameterError
from antnav.maps import map_server
from antnav.world.grid import GridMap

from . import samples


@pytest.fixture
def pair(tmp_path):
    """Write map.yaml with some lines replaced, and map.pgm beside it."""

    def write(pixels=samples.PGM, drop=(), **changes):
        lines = dict(line.split(": ", 1) for line in samples.YAML.decode().splitlines())
        lines |= changes
        path = tmp_path / "map.yaml"
        path.write_text("".join(f"{key}: {value}\n" for key, value in lines.items() if key not in drop))
        (tmp_path / "map.pgm").write_bytes(pixels)
        return path

    return write


def test_a_map(pair):
    grid = maps.load_map(pair())
    assert np.array_equal(grid.cells, samples.CELLS)
    assert grid.resolution == 0.05
    assert grid.origin == (-2.0, 3.5, 0.1)
    assert grid.name == "map"


@pytest.mark.parametrize("key", ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"])
@pytest.mark.parametrize("rules", ["nav2", "ros1"])
def test_a_missing_key_is_named(pair, key, rules):
    with pytest.raises(MapFormatError, match=f"without the key {key}"):
        maps.load_map(pair(drop=[key]), rules=rules)


@pytest.mark.parametrize(
    "changes",
    [
        {"image": "[map.pgm]"},
        {"image": "''"},
        {"resolution": "0"},
        {"resolution": "-0.05"},
        {"resolution": "wide"},
        {"resolution": "true"},
        {"resolution": ".nan"},
        {"resolution": "1_0"},
        {"resolution": "1:30"},
        {"resolution": "0,05"},
        {"resolution": "0x" + "f" * 5000},
        {"origin": "[1, 2]"},
        {"origin": "[1, 2, 3, 4]"},
        {"origin": "0"},
        {"origin": "[0, 0, .inf]"},
        {"origin": "[0, 0, [1]]"},
        {"negate": "0.0"},
        {"negate": "maybe"},
        {"negate": "[0]"},
        {"mode": ""},
        {"occupied_thresh": "65"},
        {"occupied_thresh": "0.1"},
        {"free_thresh": "-0.1"},
        {"mode": "binary"},
        {"mode": "3"},
    ],
    ids=str,
)
def test_a_wrong_value_is_named(pair, changes):
    (key,) = changes
    with pytest.raises(MapFormatError, match=key if key != "occupied_thresh" else "_thresh"):
        maps.load_map(pair(**changes))


def test_exponents_that_pyyaml_leaves_as_strings(pair):
    grid = maps.load_map(pair(resolution="0.05e0", origin="[5e-2, -5e-2, '1.5'] # a comment"))
    assert (grid.resolution, grid.origin) == (0.05, (0.05, -0.05, 1.5))


@pytest.mark.parametrize(
    "word, negated",
    [(word, 0) for word in ("0", "-0", "00", "false", "no", "n", "Off", '"0"', "'false'")]
    + [(word, 1) for word in ("1", "2", "+1", "true", "Y", "ON", '"1"', "'yes'")],
)
def test_negate_as_number_or_word(pair, word, negated):
    counts = maps.load_map(pair(negate=word)).counts()
    assert counts["occupied"] == (9 if negated else 3)


def test_modes_and_unknown_keys(pair):
    image = b"P5\n4 1\n255\n" + bytes((254, 128, 50, 0))
    load = maps.load_map
    assert load(pair(image)).cells.tolist() == [[0, 2, 1, 1]]
    assert load(pair(image, mode="Scale", map_type="occupancy", occupied_thresh="0.9")).cells.tolist() == [[0, 0, 0, 1]]
    scale = pair(image, mode="scale", occupied_thresh="0.9")
    assert load(scale, occupied_from=80).cells.tolist() == [[0, 0, 1, 1]]
    assert load(pair(image, mode="raw")).cells.tolist() == [[2, 2, 0, 0]]
    assert load(pair(image, mode="raw"), occupied_from=50).cells.tolist() == [[2, 2, 1, 0]]
    assert load(pair(image, mode="raw"), rules="ros1").cells.tolist() == [[1, 1, 0, 0]]


def test_parameters_are_checked_before_the_file(tmp_path):
    for wrong in ({"rules": "ros3"}, {"occupied_from": 0}):
        with pytest.raises(ParameterError):
            maps.load_map(tmp_path / "none.yaml", **wrong)


def test_the_image_is_looked_for_beside_the_yaml_file(tmp_path, pair):
    folder = tmp_path / "images"
    folder.mkdir()
    path = pair()
    (tmp_path / "map.pgm").rename(folder / "far.pgm")
    for name in ("images/far.pgm", "./images/../images/far.pgm", str(folder / "far.pgm")):
        path.write_text(samples.YAML.decode().replace("map.pgm", name))
        assert maps.load_map(path).shape == (3, 4)


@pytest.mark.parametrize("name", ["gone.pgm", "x" * 300, ".", '"a\\0b"'])
def test_a_missing_image_is_named(pair, name):
    path = pair(image=name)
    path.with_suffix(".pgm").unlink()
    with pytest.raises(MapFileError, match=r"image .* named by .*map\.yaml.*counts from the folder"):
        maps.load_map(path)


@pytest.mark.parametrize(
    "name, there",
    [
        ("/home/someone/maps/room.pgm", "room.pgm"),
        ("C:/maps/room.pgm", "room.pgm"),
        (r"C:\maps\room.pgm", "room.pgm"),
        (r"images\far.pgm", "images/far.pgm"),
        ("/home/someone/images/far.pgm", "images/far.pgm"),
        ("maps/room.pgm", "room.pgm"),
        ("~/room.pgm", "room.pgm"),
        ("package://robot/maps/room.pgm", "room.pgm"),
        ("package://robot/images/far.pgm", "images/far.pgm"),
        ("file:///maps/room.pgm", "room.pgm"),
        ("renamed.pgm", "map.pgm"),  # called as the YAML file is
    ],
)
def test_a_missing_image_that_lies_elsewhere_is_found(pair, name, there):
    path = pair(image=name)
    (path.parent / "room.pgm").write_bytes(samples.PGM)
    (path.parent / "images").mkdir()
    (path.parent / "images" / "far.pgm").write_bytes(samples.PGM)
    with pytest.raises(MapFileError, match=f"write `image: {there}`"):
        maps.load_map(path)
    assert maps.load_map(pair(image=there)).shape == (3, 4)  # the remedy helps


def test_an_image_that_cannot_be_read_is_not_its_own_remedy(pair):
    path = pair()
    path.with_suffix(".pgm").unlink()
    path.with_suffix(".pgm").mkdir()
    with pytest.raises(MapFileError, match="counts from the folder"):
        maps.load_map(path)


def test_a_yaml_file_named_as_the_image(pair):
    with pytest.raises(MapFormatError, match=r"map\.yaml is a map_server YAML file.*`image:`"):
        maps.load_map(pair(image="map.yaml"))


def test_the_remedy_for_a_yaw_means_the_yaw(pair):
    with pytest.raises(MapFormatError, match="write 0 as its yaw"):
        maps.load_map(pair(origin="[1.0, 2.0, -nan]"))


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace(": ", ":\t"),
        lambda text: text.replace(": ", ": \t ").replace("\n", "\t# comment\n").replace(", ", ",\t"),
        lambda text: "%YAML:1.0\n---\n" + text,
        lambda text: "%YAML 1.2\n---\n" + text,
        lambda text: text.replace("0.05", '"0.05"').replace("0.65", "'0.65'").replace("-2.0", '"-2.0"'),
        lambda text: text.replace("\n", "\r"),
        lambda text: "extra: !!python/tuple [1, 2]\nextra: twice\n[a, b]: c\n" + text,
    ],
    ids=["tabs", "more tabs", "OpenCV", "directive", "quotes", "CR", "odd keys"],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_yaml_as_yaml_cpp_reads_it(pair, change, encoding):
    path = pair()
    expected = maps.load_map(path)
    path.write_bytes(change(samples.YAML.decode()).encode(encoding))
    assert maps.load_map(path) == expected


@pytest.mark.parametrize("key", ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"])
def test_a_key_that_stands_twice_is_refused(pair, key):
    path = pair(mode="trinary")
    lines = path.read_text().splitlines()
    first = next(number for number, line in enumerate(lines, 1) if line.startswith(key))
    path.write_text("\n".join([*lines, lines[first - 1]]))
    with pytest.raises(MapFormatError, match=f"{key} on lines {first} and 8.*take one out"):
        maps.load_map(path)


def test_unknown_gray_in_a_coloured_image(pair):
    colours = np.array([[[205, 205, 205], [205, 205, 0], [254, 254, 254]]], np.uint8)
    path = pair(image="map.png", free_thresh="0.25")
    path.with_suffix(".png").write_bytes(samples.encode(colours, "PNG"))
    with pytest.warns(maps.MapWarning, match="1 pixels of gray 205"):
        maps.load_map(path)


@pytest.mark.parametrize("mode, lost", [("scale", 3), ("raw", 1)])
def test_grades_that_are_lost_are_warned_of(pair, mode, lost):
    image = b"P5\n6 1\n255\n" + bytes((254, 160, 140, 100, 60, 0))
    path = pair(image, mode=mode, occupied_thresh="0.9")
    with pytest.warns(maps.MapWarning, match=f"{lost + (mode == 'scale')} cells of occupancy 1 to 99") as caught:
        maps.load_map(path)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        maps.load_map(path, occupied_from=1)  # all closed: none is lost


def test_unknown_that_jpeg_moved_to_free_is_warned_of(tmp_path):
    gray = np.full((32, 32), 207, np.uint8)  # 205 as JPEG may give it back; 0.188 is below free_thresh
    (tmp_path / "a.jpg").write_bytes(samples.encode(gray, "JPEG"))
    (tmp_path / "a.png").write_bytes(samples.encode(gray, "PNG"))
    with pytest.warns(maps.MapWarning, match="1024 pixels near gray 205.*lossy"):
        maps.load_map(tmp_path / "a.jpg")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        maps.load_map(tmp_path / "a.png")  # where it is exact, 207 means 207


def test_unknown_gray_that_loads_as_free_is_warned_of(pair):
    path = pair(free_thresh="0.25")
    for rules in ("nav2", "ros1"):
        with pytest.warns(maps.MapWarning, match="2 pixels of gray 205.*free_thresh is 0.25") as caught:
            grid = maps.load_map(path, rules=rules)
        assert caught[0].filename == __file__  # points at the caller
        assert grid.counts()["unknown"] == 0


@pytest.mark.parametrize(
    "changes", [{}, {"negate": "1", "free_thresh": "0.25"}, {"mode": "scale", "occupied_thresh": "0.196"}]
)
def test_no_warning_without_reason(pair, changes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        maps.load_map(pair(**changes))


def test_a_bare_image_has_map_savers_defaults(pair):
    grid = maps.load_map(pair().with_suffix(".pgm"))
    assert np.array_equal(grid.cells, samples.CELLS)
    assert (grid.resolution, grid.origin) == (1.0, (0.0, 0.0, 0.0))


#: Nine names that each merge nine times the one before: 9 ** 9 entries if it were expanded.
BOMB = "a: &a {k: v}\n" + "".join(
    f"{name}: &{name} {{<<: [{', '.join([f'*{before}'] * 9)}]}}\n" for before, name in pairwise("abcdefghij")
)


@pytest.mark.parametrize(
    "text, match",
    [
        ("image: [", "must be YAML"),
        ("image: map.pgm\norigin: [0, 0, 0]\nresolution: !!timestamp x", "resolution 'x'"),
        ("image: map.pgm\norigin: [0, 0, 0]\nresolution: 2001-99-99", "resolution '2001-99-99'"),
        ("image: map.pgm\norigin: [0, 0, 0]\nresolution: " + "9" * 5000, "a finite number"),
        ("image: map.pgm\nextra: !!python/object/apply:os.getcwd []", "without the key origin"),  # nothing is run
        ("image: map.pgm\nextra: " + "[" * 20_000, "20 levels"),
        ("- image: map.pgm", "key: value"),
        ("just words", "key: value"),
        ("", "key: value"),
        ("image: &a map.pgm\norigin: *a", "aliases"),
        (BOMB, "aliases"),
    ],
    ids=["syntax", "tag", "date", "digits", "python", "deep", "list", "scalar", "empty", "alias", "bomb"],
)
def test_bad_yaml(tmp_path, text, match):
    path = tmp_path / "map.yaml"
    path.write_text(text)
    with pytest.raises(MapFormatError, match=match):
        maps.load_map(path)


def test_a_huge_yaml_file_is_not_parsed(tmp_path):
    path = tmp_path / "map.yaml"
    path.write_bytes(samples.YAML + b"# " + b"x" * map_server.MAX_YAML_BYTES)
    with pytest.raises(MapSizeError, match="at most"):
        maps.load_map(path)


def test_comments_in_any_encoding_and_a_byte_order_mark(pair):
    path = pair()
    path.write_bytes(b"\xef\xbb\xbf# caf\xe9\n" + samples.YAML + b"---\nanother: document\n")
    assert maps.load_map(path).shape == (3, 4)


@pytest.mark.parametrize("rules", ["nav2", "ros1"])
@pytest.mark.parametrize("name", ["map.yaml", "a: b #c 'd'.yml", "käse.YAML"])
def test_round_trip(tmp_path, rules, name):
    grid = GridMap(samples.CELLS, resolution=0.05000000000000001, origin=(-1e-5, 1e10, -3.0))
    maps.save_map(grid, tmp_path / name)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert maps.load_map(tmp_path / name, rules=rules) == grid


def test_inflated_cells_are_written_as_occupied(tmp_path):
    maps.save_map(GridMap([[0, 1, 2, 3]]), tmp_path / "map.yaml")
    assert maps.load_map(tmp_path / "map.yaml").cells.tolist() == [[0, 1, 2, 1]]


def test_the_image_is_written_first(tmp_path):
    (tmp_path / "map.pgm").mkdir()  # in its way
    with pytest.raises(OutputError):
        maps.save_map(GridMap([[0]]), tmp_path / "map.yaml")
    assert [path.name for path in tmp_path.iterdir()] == ["map.pgm"]
