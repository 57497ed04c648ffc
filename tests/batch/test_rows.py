"""Queries from files: what is read, with which line, and what is refused."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from antnav.batch import rows as module
from antnav.batch.rows import read_rows
from antnav.errors import ParameterError

HEADS = "start_x,start_y,goal_x,goal_y"


def read(folder: Path, name: str, text: str | bytes) -> list[tuple[object, ...]]:
    """(line, id, ends or what is wrong) of each row."""
    file = folder / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return [(line, name, ends if isinstance(ends, tuple) else str(ends)) for line, name, ends in read_rows(file).rows]


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_csv_in_any_order_of_columns(tmp_path: Path, mark: str) -> None:
    text = "\ufeffGoal_X,goal_y, start_x ,start_y,note,id\r\n1,2,3.5,-4e1,x,7\r\n\r\n5,6,7,8,y,\r\n".replace(",", mark)
    assert read(tmp_path, "a.csv", text) == [(2, "7", ((3.5, -40.0), (1.0, 2.0))), (4, None, ((7.0, 8.0), (5.0, 6.0)))]


def test_cells_are_whole(tmp_path: Path) -> None:
    text = "start_row,start_col,goal_row,goal_col\n1,2,3,4\n1,2,3,4.5\n"
    first, second = read(tmp_path, "a.CSV", text)
    assert first == (2, None, ((1, 2), (3, 4)))
    assert second[2] == "goal_col '4.5': it is a whole number; mend the row"
    assert read_rows(tmp_path / "a.CSV").cells


def test_lines_of_csv_that_are_no_queries(tmp_path: Path) -> None:
    text = f'{HEADS}\n1,2,3\n1,2,3,4,5\n1,,3,4\n"1\n",2,3,x\n{"9" * 200_000},2,3,4\n1,2,3,4\n'
    found = read(tmp_path, "a.csv", text)
    assert [line for line, _, _ in found] == [2, 3, 4, 6, 7, 8]
    assert [isinstance(ends, tuple) for _, _, ends in found] == [False] * 5 + [True]
    assert found[0][2] == "a line of 3 fields: the heads are 4; mend the row"
    assert "field larger than field limit" in str(found[4][2])


def test_bytes_that_are_no_text_spoil_one_line(tmp_path: Path) -> None:
    found = read(tmp_path, "a.csv", HEADS.encode() + b"\n\xff,2,3,4\n1,2,3,4\n")
    assert [isinstance(ends, tuple) for _, _, ends in found] == [False, True]


def test_json_lines(tmp_path: Path) -> None:
    lines = [
        '{"start": [1, 2.5], "goal": [3, 4], "id": 7, "note": "x"}',
        "",
        '{"start": [1, 2]}',
        '{"start": [1, 2, 3], "goal": [3, 4]}',
        '{"start": ["1", 2], "goal": [3, 4]}',
        "{",
        "[" * 100_000,
        '{"start_cell": [1, 2], "goal_cell": [3, 4], "id": "a"}',
    ]
    found = read(tmp_path, "a.jsonl", "\n".join(lines))
    assert [line for line, _, _ in found] == [1, 3, 4, 5, 6, 7, 8]
    assert found[0] == (1, "7", ((1.0, 2.5), (3.0, 4.0)))
    assert found[1][2] == "the line: it has no goal; mend the row"
    assert found[6][1:] == ("a", "the line: it has no start; mend the row")
    assert all("the line" in str(ends) for _, _, ends in found[1:])
    assert read(tmp_path, "b.jsonl", lines[-1]) == [(1, "a", ((1, 2), (3, 4)))]
    assert read_rows(tmp_path / "b.jsonl").cells


def test_parquet(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow", reason="the extra antnav[parquet] is not installed")
    from pyarrow import parquet

    columns = {"goal_x": [1.0, None], "goal_y": [2.0, 1], "start_x": [3.0, 1], "start_y": [4, 1], "id": [5, None]}
    parquet.write_table(pyarrow.table(columns), tmp_path / "a.parquet")
    first, second = read_rows(tmp_path / "a.parquet").rows
    assert first == (1, "5", ((3.0, 4.0), (1.0, 2.0)))
    assert str(second.ends) == "goal_x None: it is a number; mend the row"
    (tmp_path / "b.parquet").write_bytes(b"no")
    with pytest.raises(ParameterError, match=r"b\.parquet"):
        read_rows(tmp_path / "b.parquet")


def test_without_pyarrow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    with pytest.raises(ParameterError, match=r'pip install "antnav\[parquet\]"'):
        read_rows(tmp_path / "a.parquet")


@pytest.mark.parametrize(
    ("name", "text", "rule"),
    [
        ("a.txt", "", "its ending is one of"),
        ("a.csv", "1,2,3,4\n", "its columns are start_x"),
        ("a.csv", "", "its columns are start_x"),
        ("a.csv", "start_x,start_y,goal_row,goal_col\n", "its columns are start_x"),
    ],
)
def test_files_that_are_none(tmp_path: Path, name: str, text: str, rule: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ParameterError, match=rule):
        read_rows(tmp_path / name)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "b.csv")
    (tmp_path / "c.csv").mkdir()
    for name in ("a.csv", "a.jsonl", "b.csv", "c.csv", "\0.csv"):
        with pytest.raises(ParameterError, match="name a file that can be read"):
            read_rows(tmp_path / name)
    with pytest.raises(ParameterError, match="path"):
        read_rows(7)
