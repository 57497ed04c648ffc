import pytest

from antnav import maps
from antnav.errors import MapFormatError, MapSizeError
from antnav.grid import GridMap
from antnav.maps import source
from antnav.maps.text import parse

from . import samples


@pytest.mark.parametrize("separator", [b"", b" ", b",", b", ", b"\t", b"  "])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b" \n", b",\n", b"\n\n"])
def test_separators(separator, end):
    rows = (b"010", b"110")
    data = b"".join(separator.join(row[at : at + 1] for at in range(3)) + end for row in rows)
    assert parse(data, "it").tolist() == [[0, 1, 0], [1, 1, 0]]


def test_separators_may_change_from_line_to_line_and_the_last_newline_may_be_missing():
    assert parse(samples.TEXT.rstrip(), "it").tolist() == [[0, 0, 1, 0], [0, 1, 1, 0], [0, 0, 0, 1]]
    assert parse(b"\xef\xbb\xbf\n 01\n", "it").tolist() == [[0, 1]]


@pytest.mark.parametrize(
    "data, match",
    [
        (b"010\n0 1\n", "it, line 2 of 2 cells.*3"),
        (b"010\n\n0 1 1 1\n", "line 3 of 4 cells"),
        (b"010\n0 2 0\n", "line 2, column 3: '2'"),
        (b"01;0\n", "line 1, column 3: ';'"),
        (b"01\0\n", "line 1, column 3"),
    ],
)
def test_errors_name_the_line(data, match):
    with pytest.raises(MapFormatError, match=match):
        parse(data, "it")


@pytest.mark.parametrize("data", [b"", b"\n\n", b" ,\n", b"0\n" * source.MAX_LINES])
def test_sizes(data):
    with pytest.raises(MapSizeError):
        parse(data, "it")


def test_a_file_that_is_too_long_is_not_read(tmp_path):
    path = tmp_path / "a.txt"
    with path.open("wb") as stream:
        stream.write(b"01\n")
        stream.truncate(source.MAX_TEXT_BYTES + 1)  # sparse: takes no room
    with pytest.raises(MapSizeError, match="at most"):
        maps.load_map(path)


def test_round_trip(tmp_path):
    maps.save_map(GridMap([[0, 1], [3, 0]]), tmp_path / "a.txt")
    assert (tmp_path / "a.txt").read_bytes() == b"01\n10\n"
    assert maps.load_map(tmp_path / "a.txt") == GridMap([[0, 1], [1, 0]])
    with pytest.warns(maps.MapWarning, match="1 unknown cells"):
        maps.save_map(GridMap([[0, 2]]), tmp_path / "a.txt")
    assert maps.load_map(tmp_path / "a.txt").cells.tolist() == [[0, 1]]
