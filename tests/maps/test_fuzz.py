"""Damaged files: the answer is a map or a typed error, in bounded time and memory."""

import os
import tracemalloc
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from antnav import maps
from antnav.errors import AntnavError, MapSizeError
from antnav.world.grid import GridMap

from . import samples

COLOUR = np.dstack([samples.GRAY, samples.GRAY // 2, samples.GRAY, 255 - samples.GRAY])
SEEDS = {
    "map_server": [
        samples.YAML,
        b"image: map.png\nmode: scale\nresolution: 5e-2 # a comment\norigin: [0, 0, 0]\nnegate: true\n"
        b"occupied_thresh: 0.9\nfree_thresh: 0.1\nextra: {a: [1, 0x1f, 2001-01-01, ~, '\\n'], b: !!set {x}}\n",
        b"{image: map.pgm, resolution: 1:30, origin: &a [1.0, 2, .inf], negate: no, free_thresh: 0, <<: *a}\n",
        samples.YAML.replace(b": ", b":\t").decode().encode("utf-16"),
    ],
    "pgm": [
        samples.PGM,
        samples.PLAIN_PGM,
        b"P5\n4 3\n65535\n" + samples.GRAY.astype(">u2").tobytes(),
        b"P5 4 3 15 " + bytes(range(12)),
        b"P4\n4 3\n\xa0\x50\xa0",
        b"P6\n2 1\n255\n\0\1\2\3\4\5",
    ],
    "png": [
        samples.encode(samples.GRAY, "PNG"),
        samples.encode(samples.GRAY, "PNG", transparency=205),
        samples.encode(samples.GRAY.astype(np.uint16) * 257, "PNG"),
        samples.encode(COLOUR, "PNG"),
        samples.encode(samples.GRAY > 100, "PNG"),
    ],
    "bmp": [
        samples.encode(samples.GRAY, "BMP"),
        samples.encode(COLOUR[..., :3], "BMP"),
        samples.encode(samples.GRAY > 100, "BMP"),
    ],
    "tif": [
        samples.encode(samples.GRAY, "TIFF"),
        samples.encode(COLOUR, "TIFF", compression="tiff_lzw"),
        samples.encode(samples.GRAY.astype(np.uint16) * 257, "TIFF"),
        samples.encode(samples.GRAY / np.float32(255), "TIFF"),
    ],
    "gif": [samples.encode(samples.GRAY, "GIF"), samples.encode(samples.GRAY, "GIF", transparency=0)],
    "webp": [samples.encode(samples.GRAY, "WEBP"), samples.encode(COLOUR, "WEBP", lossless=True)],
    "jpg": [samples.encode(samples.GRAY, "JPEG"), samples.encode(COLOUR[..., :3], "JPEG", progressive=True)],
    "movingai": [samples.MOVINGAI, samples.MOVINGAI.replace(b"\n", b"\r\n")],
    "text": [samples.TEXT, b"01\n10\n", b"..#\n@ . .\n", b"0;1\r\n1;0\r\n"],
    "npy": [
        samples.npy(samples.CELLS),
        samples.npy(np.asfortranarray(samples.CELLS.astype(">i4"))),
        samples.npy(samples.CELLS > 0),
    ],
    "scenarios": [samples.SCENARIOS],
}
SUFFIXES = {"map_server": ".yaml", "movingai": ".map", "text": ".txt", "scenarios": ".scen"}
NUMBERS = [
    b"0",
    b"-1",
    b"1",
    b"3",
    b"7",
    b"255",
    b"65536",
    b"99999999999",
    b"1e9",
    b"nan",
    b".5",
    b"1" * 5000,
    b"\xff\xff",
]


@st.composite
def damaged(draw, seeds):
    """A seed with bytes flipped, numbers replaced, pieces cut out, doubled or taken from another seed."""
    data = bytearray(draw(st.sampled_from(seeds)))
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, max(0, len(data) - 1)))
        end = min(len(data), at + draw(st.integers(0, 12)))
        what = draw(st.sampled_from(["flip", "byte", "cut", "truncate", "double", "splice", "number"]))
        if what == "flip" and data:
            data[at] ^= 1 << draw(st.integers(0, 7))
        elif what == "byte" and data:
            data[at] = draw(st.integers(0, 255))
        elif what == "cut":
            del data[at:end]
        elif what == "truncate":
            del data[at:]
        elif what == "double":
            data[at:at] = data[at:end] * draw(st.integers(1, 40))
        elif what == "splice":
            other = draw(st.sampled_from(seeds))
            data[at:] = other[draw(st.integers(0, len(other) - 1)) :]
        else:  # a number from here on, or bytes of a binary header
            digits = [place for place in range(at, len(data)) if 48 <= data[place] <= 57]
            start = digits[0] if digits else at
            stop = start
            while stop < len(data) and 48 <= data[stop] <= 57:
                stop += 1
            data[start:stop] = draw(st.sampled_from(NUMBERS))
    return bytes(data)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fuzz")
    (folder / "map.pgm").write_bytes(samples.PGM)
    (folder / "map.png").write_bytes(samples.encode(COLOUR, "PNG"))
    return folder


def load_anything(path):
    """Load, and fail on any warning but ours and any error but ours."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", maps.MapWarning)
        try:
            return maps.load_scenarios(path) if path.suffix == ".scen" else maps.load_map(path)
        except AntnavError as error:
            assert error.given and error.rule and error.remedy
            assert len(str(error)) < 3000
            return None


@pytest.mark.parametrize("kind", SEEDS)
def test_damaged_files_give_a_map_or_a_typed_error(folder, kind):
    path = folder / ("fuzzed" + SUFFIXES.get(kind, f".{kind}"))
    outcomes = {"map": 0, "error": 0}

    @settings(max_examples=600, deadline=None, derandomize=True, database=None)
    @given(damaged(SEEDS[kind]))
    def run(data):
        path.write_bytes(data)
        loaded = load_anything(path)
        outcomes["error" if loaded is None else "map"] += 1
        if isinstance(loaded, GridMap):
            assert loaded.rows * loaded.cols <= max(10_000, 8256 * len(data)) or kind in ("tif", "gif", "webp", "jpg")

    run()
    assert min(outcomes.values()) > 20  # the damage is neither harmless nor always fatal


@settings(max_examples=300, deadline=None, derandomize=True, database=None)
@given(
    data=st.binary(max_size=200),
    name=st.sampled_from(
        ["a", "a.yaml", "a.pgm", "a.png", "a.bmp", "a.tif", "a.webp", "a.map", "a.txt", "a.csv", "a.npy"]
    ),
)
def test_any_bytes_under_any_name(folder, data, name):
    (folder / name).write_bytes(data)
    load_anything(folder / name)


@settings(max_examples=300, deadline=None, derandomize=True, database=None)
@given(damaged(SEEDS["pgm"] + SEEDS["png"] + SEEDS["bmp"]), st.sampled_from(["trinary", "scale", "raw"]), st.booleans())
def test_damaged_images_behind_a_yaml_file(folder, data, mode, negate):
    yaml = samples.YAML.replace(b"map.pgm", b"damaged.png").replace(b"negate: 0", b"negate: %d" % negate)
    (folder / "pair.yaml").write_bytes(yaml + b"mode: " + mode.encode())
    (folder / "damaged.png").write_bytes(data)
    load_anything(folder / "pair.yaml")


GIGA = {
    "a.pgm": b"P5\n40000 25000\n255\n" + bytes(64),
    "plain.pgm": b"P2\n40000 25000\n255\n0 0 0",
    "a.png": samples.png_claiming(40_000, 25_000),
    "a.bmp": samples.bmp_claiming(40_000, 25_000),
    "a.map": b"type octile\nheight 40000\nwidth 25000\nmap\n....",
    "a.npy": samples.npy_header("{'descr': '|u1', 'fortran_order': False, 'shape': (40000, 25000)}\n") + bytes(64),
}


@pytest.mark.parametrize("name", GIGA)
def test_a_header_that_claims_a_thousand_million_cells(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(GIGA[name])
    (tmp_path / "map.yaml").write_bytes(samples.YAML.replace(b"map.pgm", name.encode()))
    check_peak(path, MapSizeError)
    if name.endswith(("pgm", "png", "bmp")):
        check_peak(tmp_path / "map.yaml", MapSizeError)


@pytest.mark.parametrize("name", GIGA)
def test_a_header_that_claims_what_the_file_cannot_hold(tmp_path, name):
    path = tmp_path / name
    changed = GIGA[name].replace(b"40000", b"10000").replace(b"25000", b"10000")
    if name == "a.png":
        changed = samples.png_claiming(10_000, 10_000)
    if name == "a.bmp":
        changed = samples.bmp_claiming(10_000, 10_000)
    path.write_bytes(changed)
    check_peak(path, AntnavError)


def check_peak(path, error):
    with pytest.raises(AntnavError):  # once before: imports allocate too
        maps.load_map(path)
    resident = peak_resident()
    tracemalloc.start()
    try:
        with pytest.raises(error):
            maps.load_map(path)
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()
    assert peak_resident() - resident < 20_000_000  # Pillow's own memory is not traced


def peak_resident():
    resource = pytest.importorskip("resource")
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if os.uname().sysname == "Darwin" else 1024)
