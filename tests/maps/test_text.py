import pytest

from antnav import maps
from antnav.errors import MapFormatError, MapSizeError
from antnav.maps import source
from antnav.maps.text import parse
from antnav.world.grid import GridMap

from . import samples


@pytest.mark.parametrize("separator", [b"", b" ", b",", b", ", b" ,", b";", b"; ", b"\t", b" \t", b"  "])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b" \n", b"\n\n", None])
@pytest.mark.parametrize("letters", [b"01", b".#", b".@"])
def test_separators(separator, end, letters):
    end = separator.strip(b" ") + b"\n" if end is None else end  # one more after the last cell
    rows = (b"010", b"110")
    data = b"".join(separator.join(row[at : at + 1] for at in range(3)) + end for row in rows)
    data = data.translate(bytes.maketrans(b"01", letters))
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
        (b"01:0\n", "line 1, column 3: ':'"),
        (b"01\0\n", "line 1, column 3"),
        (b"  102\n", "line 1, column 5: '2'"),
        (b"0,1\n0,  x\n", "line 2, column 5: 'x'"),
        (b"0,100\n", "line 1, column 3: '100'.*--values occupancy"),
        (b"0,1,10\n", "line 1, column 5: '10'"),
        (b"0,-1\n", "line 1, column 3: '-1'.*--values occupancy"),
        (b"0,,1\n", "line 1, column 3: ''.*fill the empty field"),
        (b"0,1,,\n", "line 1, column 5: ''.*fill the empty field"),
        (b"0\t\t1\n", "line 1, column 3: ''"),
        (b"00 01\n", "line 1, column 1: '00'.*a separator between all cells"),
        (b"0 1,0\n", "line 1, column 1: '0 1'"),
        (b"01,0\n", "line 1, column 1: '01'"),
        (b"1.0,0.0\n", "line 1, column 1: '1.0'.*fmt='%d'"),
        (b"0,1.000e+00\n", "line 1, column 3: '1.000e.00'.*fmt='%d'"),
        (b"x,y\n0,1\n", "line 1, column 1: 'x'.*take out"),
        (b"0,1,2\n1,0,1\n", "line 1.*header=False"),
        (b",0,1\n0,1,0\n", "line 1.*header=False"),
        (b"0.1\n1.0\n", "line 1, column 2: '[.]'"),
        (b".#1\n", "line 1, column 3: '1'"),
        (b"# 3 x 2\n010\n", "line 1, column 3: '3'.*a text map has none, # is an occupied cell"),
        (b"# 3 3\n010\n", "line 1, column 3: '3'.*if the line is a comment"),
        (b"#\n0\n", "line 2, column 1: '0'.*if the first line is a comment"),
        (b"###\n010\n", "line 2, column 1: '0'.*if the first line is a comment"),
        (b"010\n# 1 0\n", "line 2, column 1: '#'.*if the line is a comment"),
    ],
)
def test_errors_name_the_line(data, match):
    with pytest.raises(MapFormatError, match=match):
        parse(data, "it")


def test_occupancy_values(tmp_path):
    (tmp_path / "a.csv").write_bytes(b"100,0,-1\n 99, 50,1\n")
    with pytest.warns(maps.MapWarning, match="3 cells of occupancy 1 to 99 load as free") as caught:
        grid = maps.load_map(tmp_path / "a.csv", values="occupancy")
    assert caught[0].filename == __file__
    assert grid.cells.tolist() == [[1, 0, 2], [0, 0, 0]]
    with pytest.warns(maps.MapWarning, match="1 cells of occupancy 1 to 49"):
        grid = maps.load_map(tmp_path / "a.csv", values="occupancy", occupied_from=50)
    assert grid.cells.tolist() == [[1, 0, 2], [1, 1, 0]]
    (tmp_path / "column.txt").write_bytes(b"100\n0\n")
    assert maps.load_map(tmp_path / "column.txt", values="occupancy").cells.tolist() == [[1], [0]]


@pytest.mark.parametrize("data", [b"0,101\n", b"0,-2\n", b"0,1.0\n", b"0,,100\n", b"00100\n", b"0,1,2,3\n0,0,0,100\n"])
def test_what_is_no_occupancy(data):
    with pytest.raises(MapFormatError, match="line 1"):
        parse(data, "it", "occupancy")


def test_hashes_are_cells():
    assert parse(b"#\n.\n", "it").tolist() == [[1], [0]]
    assert parse(b"# # .\n# . .\n", "it").tolist() == [[1, 1, 0], [1, 0, 0]]
    with pytest.raises(MapFormatError, match="if the line is a comment"):
        parse(b"# 3 3\n0 100 0\n", "it", "occupancy")


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_row_that_may_be_a_header_is_refused_unless_blanks_say_that_it_is_none(separator):
    row = separator.join("0123")
    with pytest.raises(MapFormatError, match=r"it could be a header.*put blanks between those of this line"):
        parse(f"{row}\n0,0,0,100\n".encode(), "it", "occupancy")
    assert parse(b"0 1 2 3\n0,0,0,100\n", "it", "occupancy").tolist() == [[0, 1, 2, 3], [0, 0, 0, 100]]
    assert parse(f"0,0,0,100\n{row}\n".encode(), "it", "occupancy").tolist() == [[0, 0, 0, 100], [0, 1, 2, 3]]
    assert parse(f"0{separator}1\n1{separator}1\n".encode(), "it").tolist() == [[0, 1], [1, 1]]  # two columns


@pytest.mark.parametrize("data", [b"", b"\n\n", b" \n", b"0\n" * source.MAX_LINES])
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


def test_tabs_at_the_end_are_empty_fields(tmp_path):
    (tmp_path / "a.tsv").write_text("0\t1\t\t\n0\t0\t\t\n")
    with pytest.raises(MapFormatError):
        maps.load_map(tmp_path / "a.tsv")
