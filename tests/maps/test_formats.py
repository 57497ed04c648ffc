"""load_map and save_map: which format a file has."""

import ast
import os
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, ParameterError
from antnav.world.grid import GridMap

from . import samples

SAMPLES = {
    "map.yaml": samples.YAML,
    "map.pgm": samples.PGM,
    "map.png": samples.encode(samples.GRAY, "PNG"),
    "map.bmp": samples.encode(samples.GRAY, "BMP"),
    "map.tif": samples.encode(samples.GRAY, "TIFF"),
    "map.webp": samples.encode(samples.GRAY, "WEBP", lossless=True),
    "map.gif": samples.encode(samples.GRAY, "GIF"),
    "map.jpg": samples.encode(samples.GRAY, "JPEG"),
    "map.map": samples.MOVINGAI,
    "map.txt": samples.TEXT,
    "map.npy": samples.npy(samples.CELLS),
}


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("suffix", ["", ".dat", ".txt", ".map", ".yaml", ".npy", ".png", None])
def test_the_content_decides(tmp_path, name, suffix):
    (tmp_path / "map.pgm").write_bytes(samples.PGM)
    path = tmp_path / (name if suffix is None else "other" + suffix)
    path.write_bytes(SAMPLES[name])
    assert maps.load_map(path).shape == (3, 4)
    assert maps.load_map(str(path)).shape == (3, 4)


@pytest.mark.parametrize(
    "name, match",
    [
        ("a.yaml", "YAML"),
        ("a.yml", "YAML"),
        ("a.map", "type octile"),
        ("a.txt", "only 0 .free. and 1"),
        ("a.npy", "NumPy header"),
        ("a.csv", "only 0 .free. and 1"),
        ("a.PNG", "whole PGM, PNG, BMP"),
        ("a.pgm", "not P1 to P6"),
        ("a.bmp", "whole PGM, PNG, BMP"),
        ("a.jpeg", "whole PGM, PNG, BMP"),
        ("a.TIF", "whole PGM, PNG, BMP"),
    ],
)
def test_the_extension_decides_where_the_content_tells_nothing(tmp_path, name, match):
    (tmp_path / name).write_bytes(b"\xd0\xcf[nothing")
    with pytest.raises(MapFormatError, match=match):
        maps.load_map(tmp_path / name)


@pytest.mark.parametrize("content", [b"", b"nothing", b"\0\1\2\3"])
def test_other_formats_are_told_what_is_accepted(tmp_path, content):
    (tmp_path / "a.raw").write_bytes(content)
    with pytest.raises(MapFormatError, match=r"\.yaml.*\.pgm.*\.png.*\.bmp.*\.jpg.*\.map.*\.txt.*\.csv.*\.npy"):
        maps.load_map(tmp_path / "a.raw")


@pytest.mark.parametrize("suffix", [".map", ".txt", ".pgm", ".dat", ""])
@pytest.mark.parametrize(
    "content, name",
    [
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", "Git LFS.*git lfs pull"),
        ("0 1\n1 0\n".encode("utf-16"), "UTF-16"),
        (b"PK\x03\x04 and so on", "ZIP archive, as .npz"),
        (b"%PDF-1.4", "PDF"),
        (b"<svg xmlns=''/>", "SVG"),
        (b"<?xml version='1.0'?><root/>", "XML"),
        (b"NCOLS 4\nnrows 3\n", "Esri ASCII"),
        (b'{"width": 2, "data": [0, 1]}', "JSON"),
        (b"[[0, 1], [1, 0]]", "JSON"),
        (b"voxel 3 3 3\n0 0 0\n", "three dimensions"),
    ],
)
def test_formats_that_are_not_read_are_called_by_their_names(tmp_path, content, name, suffix):
    (tmp_path / f"a{suffix}").write_bytes(content)
    with pytest.raises(MapFormatError, match=name) as caught:
        maps.load_map(tmp_path / f"a{suffix}")
    assert "movingai.com" not in str(caught.value)
    (tmp_path / "map.yaml").write_bytes(samples.YAML.replace(b"map.pgm", f"a{suffix}".encode()))
    with pytest.raises(MapFormatError, match=name):
        maps.load_map(tmp_path / "map.yaml")


@pytest.mark.parametrize("call", [maps.load_map, maps.load_scenarios, partial(maps.save_map, GridMap([[0]]))])
@pytest.mark.parametrize("path", [None, 5, b"a.txt", [], object()], ids=lambda each: type(each).__name__)
def test_what_is_no_path(call, path):
    with pytest.raises(ParameterError, match="path"):
        call(path)


@pytest.mark.parametrize("call", [maps.builtin, maps.builtin_query, maps.ends, lambda what: maps.generate(what, 5, 5)])
@pytest.mark.parametrize("what", [None, 5, [], {}, "none"])
def test_what_is_no_map(call, what, tmp_path):
    with pytest.raises(ParameterError):
        call(what)
    with pytest.raises(ParameterError):
        maps.save_map(what, tmp_path / "a.txt")


@pytest.mark.parametrize(
    "name, wrong, match",
    [
        ("map.yaml", {"invert": True}, "negate"),
        ("map.map", {"invert": True}, "leave it out"),
        ("map.map", {"values": "occupancy"}, r"text, CSV and \.npy"),
        ("map.pgm", {"values": "occupancy"}, r"text, CSV and \.npy"),
        ("map.txt", {"values": "costs"}, "cells or occupancy"),
        ("map.txt", {"values": []}, "cells or occupancy"),
        ("map.txt", {"invert": "yes"}, "True or False"),
        ("map.txt", {"rules": ["nav2"]}, "nav2, humble or ros1"),
        ("map.txt", {"occupied_from": "50"}, "1 to 100"),
    ],
)
def test_options_that_are_wrong_or_of_no_use(tmp_path, name, wrong, match):
    (tmp_path / name).write_bytes(SAMPLES[name])
    with pytest.raises(ParameterError, match=match):
        maps.load_map(tmp_path / name, **wrong)


def test_invert_swaps_free_and_occupied(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"01\n10\n")
    assert maps.load_map(tmp_path / "a.txt", invert=True).cells.tolist() == [[1, 0], [0, 1]]
    np.save(tmp_path / "a.npy", [[0, 1, 2, 3]])
    assert maps.load_map(tmp_path / "a.npy", invert=True).cells.tolist() == [[1, 0, 2, 3]]
    np.save(tmp_path / "o.npy", np.array([[0, 100, -1]], np.int8))
    assert maps.load_map(tmp_path / "o.npy", values="occupancy", invert=True).cells.tolist() == [[1, 0, 2]]
    (tmp_path / "a.pgm").write_bytes(b"P5 3 1 255 " + bytes((254, 128, 0)))
    assert maps.load_map(tmp_path / "a.pgm").cells.tolist() == [[0, 2, 1]]
    assert maps.load_map(tmp_path / "a.pgm", invert=True).cells.tolist() == [[1, 2, 0]]


def test_missing_files_folders_and_pipes(tmp_path):
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.yaml")  # opening it would block for ever
    for name in ("none.yaml", "", "pipe.yaml", "a\0.yaml", "x" * 300 + ".yaml"):
        with pytest.raises(MapFileError):
            maps.load_map(tmp_path / name)


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 0)() == 0, reason="root reads everything")
def test_unreadable_files(tmp_path):
    path = tmp_path / "a.txt"
    path.write_bytes(samples.TEXT)
    path.chmod(0)
    with pytest.raises(MapFileError, match="permissions"):
        maps.load_map(path)


@pytest.mark.parametrize("name", ["a.png", "a", "a.yaml.bak", "a.csv"])
def test_save_map_tells_the_extensions(tmp_path, name):
    with pytest.raises(ParameterError, match=r"\.yaml, \.yml, \.map, \.txt, \.npy, \.mcap or \.rosbag2"):
        maps.save_map(GridMap([[0]]), tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".yaml", ".npy", ".map", ".txt"])
def test_large_round_trip(tmp_path, suffix):
    cells = np.random.default_rng(3).integers(0, 2, (130, 1010))
    maps.save_map(GridMap(cells), tmp_path / f"a{suffix}")
    assert maps.load_map(tmp_path / f"a{suffix}") == GridMap(cells)


@pytest.mark.parametrize("path", sorted(Path(maps.__file__).parent.glob("*.py")), ids=lambda path: path.name)
def test_imports_keep_to_the_house_rules(path):
    allowed = {"antnav.errors", "antnav.values", "antnav.world.grid", "antnav.files", "antnav.maps", "antnav.exchange"}
    for node in ast.parse(path.read_text()).body:
        names = [node.module] if isinstance(node, ast.ImportFrom) else [one.name for one in getattr(node, "names", ())]
        for name in names:
            assert name.split(".")[0] not in ("PIL", "yaml", "scipy")  # heavy: imported where they are used
            assert not name.startswith("antnav") or any(name.startswith(room) for room in allowed)
