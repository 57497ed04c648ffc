"""Odd files with the traits of public bug reports: what each of them should do, and that none is forgotten."""

import warnings

import numpy as np
import pytest

from antnav import maps
from antnav.errors import MapError, MapFileError, MapFormatError

from .conftest import SHARED_DATA

ODD = SHARED_DATA / "odd_files"
#: Free, occupied and unknown cells of the room that most files hold, and of the same room where unknown is free.
ROOM, OPEN = (164, 67, 9), (173, 67, 0)
LOADED = {
    # loaded alike by map_server, or meant so plainly that nothing else can be
    **dict.fromkeys(
        [
            "ascii.pgm",
            "ascii.yaml",
            "bom.yaml",
            "cr_only.yaml",
            "crlf.pgm",
            "crlf.yaml",
            "deep.png",
            "deep.yaml",
            "dummy_l1.pgm",
            "long.pgm",
            "long.yaml",
            "maxval100.pgm",
            "maxval100.yaml",
            "misnamed.yaml",
            "mode_caps.yaml",
            "negate_quoted.yaml",
            "occ_one.yaml",
            "oneline.pgm",
            "oneline.yaml",
            "origin_block.yaml",
            "p16.pgm",
            "p16.yaml",
            "palette_negate.yaml",
            "pgm_crlf.yaml",
            "photoshop.pgm",
            "photoshop.yaml",
            "pngname.pgm",
            "res_quoted.yaml",
            "rgba.png",
            "rgba.yaml",
            "room.pgm",
            "room.tif",
            "room.webp",
            "tabs.yaml",
            "tif.yaml",
            "utf16.yaml",
            "vacuum.ppm",
            "webp.yaml",
            "yaw.yaml",
        ],
        ROOM,
    ),
    **dict.fromkeys(["big.npy", "bool.npy", "fastsim.pbm", "free25.yaml", "pbm.yaml"], OPEN),
    "bits.png": (172, 68, 0),
    "bits.yaml": (172, 68, 0),
    "colour.png": (142, 79, 19),
    "colour.yaml": (142, 79, 19),
    "equal_thresh.yaml": (164, 76, 0),
    "jpg.yaml": (168, 67, 5),
    "room.jpg": (168, 67, 5),
    "palette.png": (67, 164, 9),
    "raw.yaml": (6, 3, 9),
    "rawlevels.png": (3, 6, 9),
    "valetudo.png": (0, 67, 173),
    "walkable1.npy": (67, 173, 0),
    "hash.txt": (7, 2, 0),
    "semi_small.csv": (5, 1, 0),
    "trailing.txt": (7, 2, 0),
    **dict.fromkeys(["crlast.map", "tabhead.map", "trail.map"], (8, 1, 0)),
    "same_cell.map": (25, 0, 0),
    "swamp.map": (6, 3, 0),
    "widthfirst.map": (10, 2, 0),
}
#: What the error has to say.
REFUSED = {
    # would be another map than was meant
    "occ_same.csv": r"line 1, column 1: '100'.*occupancy",
    "tens.csv": r"line 1, column 5: '10'",
    "two_digit.txt": r"line 1, column 1: '00'.*separator",
    "dup.yaml": r"resolution on lines 2 and 7",
    # the image lies elsewhere
    "windows_absolute.yaml": r"write `image: room\.pgm`",
    "backslash.yaml": r"write `image: images/room\.pgm`",
    "cwd_relative.yaml": r"write `image: room\.pgm`",
    "home_tilde.yaml": r"write `image: room\.pgm`",
    "package_uri.yaml": r"write `image: room\.pgm`",
    "file_uri.yaml": r"write `image: room\.pgm`",
    "latin1.yaml": r"named by .*latin1\.yaml",
    "windows_absolute_names_yaml.yaml": r"is a map_server YAML file.*`image:`",
    "lfs.yaml": r"Git LFS pointer.*git lfs pull",
    "lfs.pgm": r"Git LFS pointer.*git lfs pull",
    "svg.yaml": r"SVG",
    "room.svg": r"SVG",
    "comment_first.pgm": r"first two bytes are '# ', not P1 to P6",
    "comment_first.yaml": r"first two bytes are '# ', not P1 to P6",
    "link.pgm": r"first two bytes are 'ro'",
    "symlink.yaml": r"first two bytes are 'ro'",
    "empty.pgm": r"it is empty",
    "emptyimg.yaml": r"it is empty",
    "short.pgm": r"truncated",
    "short.yaml": r"truncated",
    # wrong values
    "yaw_nan.yaml": r"write 0 as its yaw",
    "comma_decimal.yaml": r"resolution '0,05'.*0\.05",
    "key_caps.yaml": r"without the key resolution.*Resolution",
    "mode_missing_value.yaml": r"mode ''",
    "negate_float.yaml": r"negate '0\.0'",
    "nested.yaml": r"without the key image",
    "no_thresh.yaml": r"without the key occupied_thresh",
    "origin2.yaml": r"three numbers",
    "origin4.yaml": r"three numbers",
    "origin_dict.yaml": r"three numbers",
    "origin_str.yaml": r"three numbers",
    "percent.yaml": r"between 0 and 1",
    "mapf.yaml": r"without the key image.*agents",
    "mapf_plain.yaml": r"without the key image.*agents",
    "ros2_params.yaml": r"without the key image.*map_server",
    # arrays and text
    "image.npy": r"gray image save it as a PNG",
    "occ.npy": r"to_cells\(array",
    "prob.npy": r"probabilities of being occupied",
    "float01.npy": r"astype\('uint8'\), if 0 is free",
    "three.npy": r"two dimensions.*PNG",
    "str.npy": r"whole numbers or booleans",
    "pandas.csv": r"line 1: '0,1,2.*header=False, index=False",
    "pandas_index.csv": r"line 1: ',0,1.*header=False, index=False",
    "float.csv": r"line 1, column 1: '1\.0.*fmt='%d'",
    "float1.csv": r"line 1, column 1: '1\.0'.*fmt='%d'",
    "csv_header.csv": r"line 1, column 1: 'width'",
    "occ.csv": r"line 1, column 1: '100'.*occupancy",
    "utf16.txt": r"UTF-16",
    "comment.txt": r"line 1, column 3: 'grid'",
    "matlab.txt": r"printed list",
    "python.txt": r"printed list",
    "ragged.txt": r"line 2 of 3 cells",
    "size_line.txt": r"line 1, column 1: '2'",
    "size_line2.txt": r"line 1, column 1: '3'",
    "tab_gap.tsv": r"line 1, column 3: ''",
    # formats that are not read
    "esri.asc": r"Esri ASCII grid",
    "voxel.map": r"voxel map in three dimensions",
    "xml.map": r"XML",
    "grid.json": r"JSON",
    "list.json": r"JSON",
    "grid.npz": r"\.npz.*numpy\.save",
    "lower.map": r"line 5, column 3: 't'",
    "hash.map": r"line 6, column 2: '#'",
    "extrahead.map": r"line 4: 'resolution 0\.05'",
    "noheader.map": r"begins with `type octile`.*before the cells",
    "quad.map": r"'type quad'",
    "weighted.map": r"'type tile'",
    "upper.map": r"'Type Octile'",
    "short.map": r"2 rows of cells",
    "spaced.map": r"width 3",
}


def read(name, **choices):
    if not ODD.is_dir():
        pytest.skip(f"no odd files at {ODD}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", maps.MapWarning)
        return maps.load_map(ODD / name, **choices)


def counts(grid):
    return tuple(grid.counts()[kind] for kind in ("free", "occupied", "unknown"))


def test_every_file_has_an_expectation():
    if not ODD.is_dir():
        pytest.skip(f"no odd files at {ODD}")
    found = {path.name for path in ODD.iterdir() if path.is_file()} - {"README.md"}
    assert found == {*LOADED, *REFUSED}


@pytest.mark.parametrize("name", LOADED)
def test_loaded(name):
    assert counts(read(name)) == LOADED[name]


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_the_cause(name):
    with pytest.raises(MapError, match=REFUSED[name]) as caught:
        read(name)
    assert isinstance(caught.value, MapFileError | MapFormatError)
    assert "its header is damaged" not in str(caught.value)
    assert ">= 100" not in caught.value.remedy
    if name in ("xml.map", "voxel.map"):
        assert "movingai.com" not in str(caught.value)


def test_occupancy_values_where_asked_for():
    assert counts(read("occ.csv", values="occupancy")) == ROOM
    assert counts(read("occ.npy", values="occupancy")) == ROOM
    diagonal = read("occ_same.csv", values="occupancy")
    assert np.array_equal(diagonal.cells, np.eye(6))
    with pytest.raises(MapFormatError, match="line 1"):
        read("pandas.csv", values="occupancy")


def test_maps_where_1_is_passable():
    assert counts(read("walkable1.npy", invert=True)) == OPEN
    assert counts(read("palette.png", invert=True)) == ROOM


def test_colours_as_before_jazzy():
    assert counts(read("colour.yaml", rules="humble")) == (132, 89, 19)
    assert counts(read("colour.yaml", rules="ros1")) == (132, 89, 19)


def test_places_in_the_world():
    assert read("tabs.yaml").resolution == read("utf16.yaml").resolution == read("res_quoted.yaml").resolution == 0.05
    assert read("yaw.yaml").origin == (-1.0, -2.0, 1.56)


@pytest.mark.parametrize(
    "name, warning",
    [
        ("free25.yaml", "9 pixels of gray 205"),
        ("jpg.yaml", "4 pixels near gray 205"),
        ("raw.yaml", "3 cells of occupancy 1 to 99"),
    ],
)
def test_warnings(name, warning):
    if not ODD.is_dir():
        pytest.skip(f"no odd files at {ODD}")
    with pytest.warns(maps.MapWarning, match=warning):
        maps.load_map(ODD / name)
