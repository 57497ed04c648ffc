"""Formats that antnav does not read but that files named as maps turn out to have: each is called by its name."""

from __future__ import annotations

import re
from pathlib import Path

from antnav.errors import MapFormatError

_ARRAY = "take the array out of it and save that with numpy.save"
_CELLS = "save its cells with numpy.save, or as lines of 0 (free) and 1 (occupied)"
#: What the first bytes look like, what the file then is, and what helps.
_FORMATS = (
    (rb"version https://git-lfs\.", "a Git LFS pointer that stands for the file", "fetch the file: git lfs pull"),
    (rb"\xff\xfe|\xfe\xff", "text in UTF-16", "save it in UTF-8"),
    (rb"PK\x03\x04", "a ZIP archive, as .npz files are", _ARRAY),
    (rb"\x89HDF|MATLAB 5", "an HDF5 or MATLAB file", _ARRAY),
    (rb"%PDF|%!PS", "a PDF or PostScript file", "save the map as PNG"),
    (rb"\s*(?:<\?xml[^>]*>\s*)?(?:<!--.*?-->\s*)?<svg", "an SVG drawing", "save it as PNG, a pixel a cell"),
    (rb"\s*<", "an XML or HTML file", _CELLS),
    (rb"\s*ncols\s", "an Esri ASCII grid", _CELLS),
    (rb"\s*[\[{]", "a JSON file or a printed list", _CELLS),
    (rb"voxel\s", "a voxel map in three dimensions", "save one layer as a grid"),
    (rb"(?:.*\n)?(?:image|resolution|origin)\s*:", "a map_server YAML file", "let `image:` name the image"),
)
_MARK = rb"(?:\xef\xbb\xbf)?"  # the byte order mark of UTF-8


def refuse_foreign(head: bytes, path: Path) -> None:
    """Refuse a file whose first bytes are those of a known format that is not a map's.

    Raises
    ------
    MapFormatError
        With the name of the format.
    """
    for pattern, name, remedy in _FORMATS:
        if re.match(_MARK + rb"(?:" + pattern + rb")", head, re.DOTALL | re.IGNORECASE):
            raise MapFormatError(f"{path} is {name}", "antnav reads no cells from such a file", remedy)
