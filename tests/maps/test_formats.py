"""load_map and save_map: which format a file has."""

import ast
import os
from pathlib import Path

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapFileError, MapFormatError, ParameterError
from antnav.grid import GridMap

from . import samples

SAMPLES = {
    "map.yaml": samples.YAML,
    "map.pgm": samples.PGM,
    "map.png": samples.encode(samples.GRAY, "PNG"),
    "map.bmp": samples.encode(samples.GRAY, "BMP"),
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
        ("a.PNG", "PGM, PNG or BMP"),
        ("a.pgm", "PGM, PNG or BMP"),
        ("a.bmp", "PGM, PNG or BMP"),
    ],
)
def test_the_extension_decides_where_the_content_tells_nothing(tmp_path, name, match):
    (tmp_path / name).write_bytes(b"\xd0\xcf[nothing")
    with pytest.raises(MapFormatError, match=match):
        maps.load_map(tmp_path / name)


@pytest.mark.parametrize("content", [b"", b"nothing", b"\xff\xd8\xff\xe0 a JPEG", b"%PDF-1.4"])
def test_other_formats_are_told_what_is_accepted(tmp_path, content):
    (tmp_path / "a.jpg").write_bytes(content)
    with pytest.raises(MapFormatError, match=r"\.yaml.*\.pgm.*\.png.*\.bmp.*\.map.*\.txt.*\.npy"):
        maps.load_map(tmp_path / "a.jpg")


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


@pytest.mark.parametrize("name", ["a.png", "a", "a.yaml.bak"])
def test_save_map_tells_the_extensions(tmp_path, name):
    with pytest.raises(ParameterError, match=r"\.yaml, \.yml, \.map, \.txt or \.npy"):
        maps.save_map(GridMap([[0]]), tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".yaml", ".npy", ".map", ".txt"])
def test_large_round_trip(tmp_path, suffix):
    cells = np.random.default_rng(3).integers(0, 2, (130, 1010))
    maps.save_map(GridMap(cells), tmp_path / f"a{suffix}")
    assert maps.load_map(tmp_path / f"a{suffix}") == GridMap(cells)


@pytest.mark.parametrize("path", sorted(Path(maps.__file__).parent.glob("*.py")), ids=lambda path: path.name)
def test_imports_keep_to_the_house_rules(path):
    allowed = {"antnav.errors", "antnav.grid", "antnav.files", "antnav.maps"}
    for node in ast.parse(path.read_text()).body:
        names = [node.module] if isinstance(node, ast.ImportFrom) else [one.name for one in getattr(node, "names", ())]
        for name in names:
            assert name.split(".")[0] not in ("PIL", "yaml", "scipy")  # heavy: imported where they are used
            assert not name.startswith("antnav") or any(name.startswith(room) for room in allowed)
