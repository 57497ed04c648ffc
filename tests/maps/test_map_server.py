import warnings
from itertools import pairwise

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, MapSizeError, OutputError, ParameterError
from antnav.grid import GridMap
from antnav.maps import map_server

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
        {"resolution": "0x" + "f" * 5000},
        {"origin": "[1, 2]"},
        {"origin": "[1, 2, 3, 4]"},
        {"origin": "0"},
        {"origin": "[0, 0, .inf]"},
        {"origin": "[0, 0, [1]]"},
        {"negate": "0.0"},
        {"negate": "maybe"},
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
    "word, negated", [("0", 0), ("false", 0), ("no", 0), ("n", 0), ("1", 1), ("true", 1), ("Y", 1)]
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


@pytest.mark.parametrize("name", ["gone.pgm", "x" * 300, "."])
def test_a_missing_image_is_named(pair, name):
    with pytest.raises(MapFileError, match=r"image .* named by .*map\.yaml"):
        maps.load_map(pair(image=name))


def test_unknown_gray_that_loads_as_free_is_warned_of(pair):
    path = pair(free_thresh="0.25")
    for rules in ("nav2", "ros1"):
        with pytest.warns(maps.MapWarning, match="2 pixels of gray 205.*free_thresh is 0.25") as caught:
            grid = maps.load_map(path, rules=rules)
        assert caught[0].filename == __file__  # points at the caller
        assert grid.counts()["unknown"] == 0


@pytest.mark.parametrize(
    "changes", [{}, {"negate": "1", "free_thresh": "0.25"}, {"mode": "raw", "free_thresh": "0.25"}]
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
        ("image: map.pgm\nresolution: !!timestamp x", "must be YAML"),
        ("image: map.pgm\nresolution: 2001-99-99", "must be YAML"),
        ("image: map.pgm\nresolution: " + "9" * 5000, "must be YAML"),
        ("image: map.pgm\nextra: !!python/object/apply:os.getcwd []", "must be YAML"),
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
    grid = GridMap(samples.CELLS, resolution=0.05000000000000001, origin=(-1e-5, 1e22, -3.0))
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
