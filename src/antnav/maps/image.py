"""Pixels of PGM, PNG, BMP, TIFF, WebP, GIF and JPEG files as plain arrays of gray or colour and alpha."""

from __future__ import annotations

import os
import re
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, MapFormatError, MapSizeError
from antnav.maps.foreign import refuse_foreign
from antnav.maps.source import HEAD_BYTES, open_binary
from antnav.world.grid import MAX_CELLS, check_size

if TYPE_CHECKING:
    from PIL.Image import Image

#: Pillow's names, the frequent ones first; PPM covers PBM, PGM and PPM.
_FORMATS = ("PPM", "PNG", "BMP", "JPEG", "GIF", "TIFF", "WEBP")
_NAMES = "PGM, PNG, BMP, TIFF, WebP, GIF or JPEG"
_PNM_SUFFIXES = (".pbm", ".pgm", ".ppm", ".pnm")
_WHITE_16 = 2**16 - 1
_WIDE_MODES = ("I", "I;16", "I;16B", "I;16L", "I;16N")
#: Pixels that a byte of a file can hold at most, where there is a bound: 8 a byte, and deflate packs 1032 to 1.
_PIXELS_PER_BYTE = {"PPM": 8, "PNG": 8 * 1032, "BMP": 8 * 1032}


@dataclass(frozen=True)
class Picture:
    """A decoded image, row 0 at the top.

    Attributes
    ----------
    pixels : ndarray of uint8, shape (rows, cols) or (rows, cols, 3)
        0 black to 255 white. Three channels only where they differ somewhere.
    alpha : ndarray of uint8, shape (rows, cols), or None
        255 opaque. None where the file has no transparency.
    blurred : bool
        The format is lossy, so gray levels may only be near the ones that were meant.
    """

    pixels: NDArray[np.uint8]
    alpha: NDArray[np.uint8] | None = None
    blurred: bool = False


def read_image(path: Path) -> Picture:
    """Decode an image once its size has been accepted.

    Pixels of 16 bits become 8 as in GraphicsMagick, floor(v / 257), and floats from 0 to 1 become 16 bits before;
    palettes and single bits become gray or colour. The largest value of a PGM header counts as white. Of an animation
    or of many pages, the first.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; damaged, truncated or of another format; more than `antnav.world.grid.MAX_CELLS` pixels.
    """
    from PIL import Image, UnidentifiedImageError

    with open_binary(path) as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Pillow's warnings on size and palettes: we check both ourselves
        try:
            with Image.open(stream, formats=_FORMATS) as image:
                check_size(image.height, image.width, str(path))
                _check_length(image, os.fstat(stream.fileno()).st_size)
                return _decode(image)
        except AntnavError:
            raise
        except Image.DecompressionBombError as error:  # its text names a limit of Pillow's
            raise MapSizeError(
                f"{path} of more than {MAX_CELLS} pixels", "a map has no more cells", "crop the image"
            ) from error
        except UnidentifiedImageError as error:
            stream.seek(0)
            head = stream.read(HEAD_BYTES)
            refuse_foreign(head, path)
            raise _damaged(path, _what_is_wrong(head, path)) from error
        except Exception as error:  # damaged files make Pillow raise a dozen types, from struct.error to SyntaxError
            raise _damaged(path, str(error) or type(error).__name__) from error


def read_gray(path: Path) -> NDArray[np.uint8]:
    """The gray levels of an image that means numbers, shape (rows, cols); see `read_image`.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        As `read_image`; it is coloured, or of a lossy format.
    """
    picture = read_image(path)
    if picture.pixels.ndim != 2 or picture.blurred:
        raise MapFormatError(f"{path}", "its numbers are gray levels of a lossless image", "save it as PGM or gray PNG")
    return picture.pixels


def _damaged(path: Path, reason: str) -> MapFormatError:
    return MapFormatError(
        f"{path}: {reason}", f"an image must be a whole {_NAMES} file", "save it again in one of these formats"
    )


def _what_is_wrong(head: bytes, path: Path) -> str:
    if not head:
        return "it is empty"
    if path.suffix.lower() in _PNM_SUFFIXES and not re.match(rb"P[1-6]", head):
        return f"its first two bytes are {head[:2].decode('latin-1')!a}, not P1 to P6"
    return "its header is damaged or of another format"


def _check_length(image: Image, size: int) -> None:
    if image.width * image.height > _PIXELS_PER_BYTE.get(str(image.format), MAX_CELLS) * size:
        raise ValueError(f"{size} bytes cannot hold {image.width} x {image.height} pixels, so the file is truncated")


def _decode(image: Image) -> Picture:
    key, blurred = image.info.get("transparency"), image.format in ("JPEG", "WEBP")
    if image.mode in _WIDE_MODES:  # convert("L") would clip these at 255
        deep = np.asarray(image)
        if deep.min() < 0 or deep.max() > _WHITE_16:
            raise ValueError("pixels of more than 16 bits are not read")
        opaque = None if key is None else np.where(deep == key, 0, 255).astype(np.uint8)
        return Picture((deep // 257).astype(np.uint8), opaque)
    if image.mode == "F" and image.format == "TIFF":
        shade = np.nan_to_num(np.asarray(image).clip(0, 1))
        return Picture((np.floor(shade * _WHITE_16 + 0.5) // 257).astype(np.uint8))
    if key is not None or image.mode in ("P", "PA", "LA", "RGBA"):
        solid = image.mode == "P" and key is None
        return _from_channels(np.asarray(image.convert("RGB" if solid else "RGBA")))
    if image.mode in ("1", "L"):
        return Picture(np.asarray(image.convert("L")), blurred=blurred)
    if image.mode == "RGB":
        return replace(_from_channels(np.asarray(image)), blurred=blurred)
    raise ValueError(f"pixels of type {image.mode} are neither gray nor colour")


def _from_channels(channels: NDArray[np.uint8]) -> Picture:
    colour = channels[..., :3]
    alpha = channels[..., 3].copy() if channels.shape[2] == 4 else None
    red = colour[..., 0]
    if np.array_equal(red, colour[..., 1]) and np.array_equal(red, colour[..., 2]):
        return Picture(red.copy(), alpha)
    return Picture(colour, alpha)
