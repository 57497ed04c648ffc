"""Small files of every format, made on the spot."""

import io
import struct
import zlib

import numpy as np
from PIL import Image

GRAY = np.array([[254, 254, 0, 205], [254, 0, 0, 205], [254, 254, 254, 254]], dtype=np.uint8)
#: What map_saver means by GRAY.
CELLS = np.array([[0, 0, 1, 2], [0, 1, 1, 2], [0, 0, 0, 0]], dtype=np.uint8)

YAML = b"""image: map.pgm
resolution: 0.05
origin: [-2.0, 3.5, 0.1]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
PGM = b"P5\n# CREATOR: a test\n4 3\n255\n" + GRAY.tobytes()
PLAIN_PGM = b"P2\n4 3 # columns, rows\n255\n254 254 0 205\n254 0 0 205\n254 254 254 254\n"
MOVINGAI = b"type octile\nheight 3\nwidth 4\nmap\n..@T\nG.OS\n.W..\n"
SCENARIOS = (
    b"version 1\n0\tmaps/a.map\t4\t3\t0\t0\t1\t2\t2.41421356\n7 maps/a.map 4 3 3 2 0 1 3.41\n"  # tabs and blanks
)
TEXT = b"0010\n0 1 1 0\n0,0,0,1\n"


def encode(pixels: np.ndarray, file_format: str, **options: object) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, file_format, **options)
    return stream.getvalue()


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def npy_header(text: str, version: int = 1) -> bytes:
    body = text.encode()
    return b"\x93NUMPY" + bytes((version, 0)) + struct.pack("<H" if version == 1 else "<I", len(body)) + body


def png_chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png_claiming(cols: int, rows: int) -> bytes:
    """A PNG file whose correct header claims any size."""
    header = png_chunk(b"IHDR", struct.pack(">IIBBBBB", cols, rows, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + png_chunk(b"IDAT", zlib.compress(bytes(64))) + png_chunk(b"IEND", b"")


def bmp_claiming(cols: int, rows: int) -> bytes:
    head = struct.pack("<IiiHHIIiiII", 40, cols, rows, 1, 24, 0, 0, 0, 0, 0, 0)
    return b"BM" + struct.pack("<IHHI", 54 + 64, 0, 0, 54) + head + bytes(64)
