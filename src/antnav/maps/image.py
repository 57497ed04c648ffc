"""PGM, PNG and BMP pixels as plain arrays of gray or colour and alpha."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from antnav.errors import AntnavError, MapFormatError, MapSizeError
from antnav.grid import MAX_CELLS, check_size
from antnav.maps.source import open_binary

if TYPE_CHECKING:
    from PIL.Image import Image

#: Pillow's names; PPM covers PBM, PGM and PPM. Other formats (JPEG) blur the edges of walls.
_FORMATS = ("PPM", "PNG", "BMP")
_WIDE_MODES = ("I", "I;16", "I;16B", "I;16L", "I;16N")
#: Pixels that a byte of a file can hold at most: 8 a byte, and deflate packs 1032 to 1.
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
    """

    pixels: NDArray[np.uint8]
    alpha: NDArray[np.uint8] | None = None


def read_image(path: Path) -> Picture:
    """Decode an image once its size has been accepted.

    Pixels of 16 bits become 8 as in ImageMagick, round(v / 257); palettes and single bits become gray or colour.
    The largest value of a PGM header counts as white.

    Raises
    ------
    MapFileError, MapFormatError, MapSizeError
        Missing; damaged, truncated or of another format; more than `antnav.grid.MAX_CELLS` pixels.
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
        except Image.DecompressionBombError as error:
            raise MapSizeError(
                f"{path}: {error}", f"at most {MAX_CELLS} cells are accepted", "crop the image"
            ) from error
        except UnidentifiedImageError as error:
            raise _damaged(path, "its header is damaged or of another format") from error
        except Exception as error:  # damaged files make Pillow raise a dozen types, from struct.error to SyntaxError
            raise _damaged(path, str(error) or type(error).__name__) from error


def _damaged(path: Path, reason: str) -> MapFormatError:
    return MapFormatError(
        f"{path}: {reason}", "an image must be a whole PGM, PNG or BMP file", "save it again in one of these formats"
    )


def _check_length(image: Image, size: int) -> None:
    if image.width * image.height > _PIXELS_PER_BYTE[str(image.format)] * size:
        raise ValueError(f"{size} bytes cannot hold {image.width} x {image.height} pixels, so the file is truncated")


def _decode(image: Image) -> Picture:
    key = image.info.get("transparency")
    if image.mode in _WIDE_MODES:  # convert("L") would clip these at 255
        deep = np.asarray(image).astype(np.uint32)
        opaque = None if key is None else np.where(deep == key, 0, 255).astype(np.uint8)
        return Picture(((deep + 128) // 257).astype(np.uint8), opaque)
    if key is not None or image.mode in ("P", "PA", "LA", "RGBA"):
        solid = image.mode == "P" and key is None
        return _from_channels(np.asarray(image.convert("RGB" if solid else "RGBA")))
    if image.mode in ("1", "L"):
        return Picture(np.asarray(image.convert("L")))
    if image.mode == "RGB":
        return _from_channels(np.asarray(image))
    raise ValueError(f"pixels of type {image.mode} are neither gray nor colour")


def _from_channels(channels: NDArray[np.uint8]) -> Picture:
    colour = channels[..., :3]
    alpha = channels[..., 3].copy() if channels.shape[2] == 4 else None
    red = colour[..., 0]
    if np.array_equal(red, colour[..., 1]) and np.array_equal(red, colour[..., 2]):
        return Picture(red.copy(), alpha)
    return Picture(colour, alpha)
