"""Maps that somebody dropped on the page."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from antnav.errors import AntnavError
from antnav.view.dropped import coarser, map_of
from antnav.world.grid import GridMap

META = b"resolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"


def png(rows, cols):
    stream = io.BytesIO()
    pixels = np.full((rows, cols), 255, np.uint8)
    pixels[0] = 0
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def test_an_image_and_a_yaml_file_with_its_image():
    assert map_of({"room.png": png(5, 7)}).shape == (5, 7)
    grid = map_of({"room.png": png(5, 7), "room.yaml": b"image: room.png\n" + META})
    assert grid.resolution == 0.1
    assert grid.cells[0].all()


def bomb():
    """A PNG that tells of 100,000 x 100,000 pixels."""
    head = struct.pack(">IIBBBBB", 100_000, 100_000, 8, 0, 0, 0, 0)
    chunk = b"IHDR" + head
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk + struct.pack(">I", zlib.crc32(chunk))


def npy(shape):
    header = f"{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}, }}".encode().ljust(118) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header


@pytest.mark.parametrize(
    "files",
    [
        {"a.png": bomb()},
        {"a.png": b"no image"},
        {"a.npy": npy((10**9, 10**9))},
        {"a.npy": b"\x93NUMPY\x01\x00"},
        {"a.exe": b"MZ"},
        {"../a.png": png(2, 2)},
        {"a\0.png": png(2, 2)},
        {"": b""},
        {"a.map": b"type octile\nheight 3\nwidth 3\nmap\n..."},
        {"a.yaml": b"image: /etc/hostname\n" + META},
        {"a.yaml": b"image: other.png\n" + META},
        {"a.png": png(2100, 2100)},
        {"a.mcap": b"\x89MCAP0\r\n"},
    ],
)
def test_what_is_no_map_or_too_large_is_refused_in_words(files):
    with pytest.raises(AntnavError) as caught:
        map_of(files)
    assert "antnav-view-" not in str(caught.value)


def test_an_image_counts_wherever_its_yaml_file_says_that_it_lay():
    for place in (b"/home/robot/maps/room.png", b"maps/room.png"):
        assert map_of({"room.png": png(5, 7), "room.yaml": b"image: " + place + b"\n" + META}).resolution == 0.1


def test_what_is_no_image_is_told_as_anywhere_else():
    for content, word in ((b"# made by hand\nP2\n3 2\n255\n", "P1 to P6"), (b"no image", "a.pgm")):
        with pytest.raises(AntnavError, match=word) as caught:
            map_of({"a.pgm": content})
        assert "object at" not in str(caught.value)


def test_a_large_map_is_shown_with_fewer_cells_and_keeps_its_walls_and_its_corner():
    cells = np.zeros((1001, 700), np.uint8)
    cells[501] = 1
    cells[0, :3], cells[0, 3:6], cells[-1, -1] = 2, 3, 2
    whole = GridMap(cells, 0.05, (1.0, 2.0, 0.0), name="hall")
    grid = coarser(whole)
    assert grid.shape == (501, 350)
    assert grid.resolution == 0.1
    assert grid.origin == whole.origin
    assert grid.cells[:, 100].sum() == 1
    assert grid.cells[251].all()  # the row that is missing lies at the top, for the corner below stays
    assert grid.cells[0, :3].tolist() == [2, 3, 3]
    assert grid.cells[-1, -1] == 2
    for point in ((1.02, 2.02), (30.0, 27.03)):  # places stay
        row, col = whole.cell_at(point)
        assert (whole.cells[row, col] == 1) <= (grid.cells[grid.cell_at(point)] == 1)
    assert coarser(grid) is grid
