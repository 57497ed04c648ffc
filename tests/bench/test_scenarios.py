"""Which queries are asked, and which files are refused."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

import antnav as an
from antnav.bench.scenarios import check_published, chosen, read_queries
from antnav.errors import MapFileError, MapFormatError, ParameterError
from tests.bench.files import SIDE, write_map, write_scenarios


@pytest.mark.parametrize(
    ("count", "hardest", "expected"),
    [
        (3, 0.5, [50, 70, 90]),  # of 50, 60, 70, 80, 90
        (2, 1.0, [0, 90]),
        (1, 1.0, [90]),
        (9, 0.2, [80, 90]),  # no more than there are
        (5, 0.01, [90]),
    ],
)
def test_chosen_are_spread_over_the_longest(count: int, hardest: float, expected: list[int]) -> None:
    lengths = [30.0, 90.0, 0.0, 60.0, 10.0, 80.0, 20.0, 70.0, 40.0, 50.0]
    assert [lengths[index] for index in chosen(lengths, count, hardest)] == expected


def test_equal_lengths_keep_the_order_of_the_file() -> None:
    assert chosen([5.0] * 8, 2, 0.5) == [4, 7]


def test_files_are_found_at_any_depth_under_either_name(tmp_path: Path) -> None:
    rooms, maze = write_map(tmp_path / "a", "rooms"), write_map(tmp_path, "maze", "maze")
    lengths = write_scenarios(tmp_path / "a" / "rooms.map.scen", rooms)
    write_scenarios(tmp_path / "maze-even-1.scen", maze, map_field="maps/elsewhere/maze.map")
    write_scenarios(tmp_path / "maze-random-1.scen", maze, map_field="maze.map")
    queries = read_queries(tmp_path, 2, 0.5)
    assert Counter(query.map_label for query in queries) == {"rooms": 2, "maze": 4}
    of_rooms = [query for query in queries if query.map_label == "rooms"]
    assert [query.published for query in of_rooms] == pytest.approx([lengths[4], lengths[7]], abs=1e-5)
    assert [query.number for query in of_rooms] == [5, 8]
    for query in queries:
        check_published(query)
        assert query.problem().corner_rule is an.CornerRule.FORBID
    assert queries[0].problem() is not queries[0].problem(), "an algorithm must not profit from the one before"


def test_maps_of_one_name_are_told_apart(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        write_scenarios(tmp_path / folder / "same.map.scen", write_map(tmp_path / folder, "same"))
    assert {query.map_label for query in read_queries(tmp_path, 1, 1.0)} == {"a/same", "b/same"}


def test_a_length_of_other_rules_is_refused(tmp_path: Path) -> None:
    write_scenarios(tmp_path / "rooms.map.scen", write_map(tmp_path, "rooms"), off=-0.01)
    with pytest.raises(MapFormatError, match="leave this file out"):
        check_published(read_queries(tmp_path, 1, 1.0)[0])


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapFileError, match="no folder"):
        read_queries(tmp_path / "absent", 1, 1.0)
    with pytest.raises(MapFileError, match=r"no \.scen"):
        read_queries(tmp_path, 1, 1.0)
    grid = write_map(tmp_path, "rooms")
    scenarios = tmp_path / "rooms.map.scen"
    write_scenarios(scenarios, grid)
    with pytest.raises(ParameterError, match="hardest"):
        read_queries(tmp_path, 1, 0.0)
    with pytest.raises(ParameterError, match="queries"):
        read_queries(tmp_path, 0, 1.0)
    text = scenarios.read_text()
    scenarios.write_text(text.replace(f"\t{SIDE}\t{SIDE}\t", f"\t{SIDE + 1}\t{SIDE}\t"))
    with pytest.raises(MapFormatError, match="its map has"):
        read_queries(tmp_path, 1, 1.0)
    (tmp_path / "rooms.map").unlink()
    with pytest.raises(MapFileError, match="not beside it"):
        read_queries(tmp_path, 1, 1.0)


def test_the_sample_of_movingai_is_read(data: Path) -> None:
    queries = read_queries(data / "movingai" / "mapf", 2, 0.25)
    assert len(queries) == 16
    for query in queries:
        check_published(query)
