"""The MovingAI benchmark: answers by generated files, statistics by numbers worked out by hand."""

from __future__ import annotations

import math
import threading
from pathlib import Path

import pytest

from antnav.bench import movingai
from antnav.bench.movingai import Answer, gap_of, raw_table, scores, summary
from antnav.bench.scenarios import Query, read_queries
from antnav.errors import MapFormatError, ParameterError
from antnav.report import to_csv
from tests.bench.files import write_map, write_scenarios
from tests.conftest import grid_of

OPEN = grid_of("...", "...", "...")


@pytest.fixture(scope="module")
def queries(tmp_path_factory: pytest.TempPathFactory) -> list[Query]:
    """Four queries on each of two maps."""
    folder = tmp_path_factory.mktemp("movingai")
    for kind in ("rooms", "random"):
        write_scenarios(folder / f"{kind}.map.scen", write_map(folder, kind, kind))
    return read_queries(folder, 4, 0.5)


def answered(label: str, algorithm: str, length: float, milliseconds: float, published: float = 10.0) -> Answer:
    query = Query(OPEN, label, f"{label}.map.scen", 1, (0, 0), (2, 2), published)
    return Answer(query, algorithm, 0, length, milliseconds / 1000)


@pytest.mark.slow
def test_every_algorithm_answers_every_query_in_turn(queries: list[Query]) -> None:
    seen = []
    answers = movingai.run(queries, ["astar", "npaco", "dijkstra"], progress=lambda *done: seen.append(done))
    assert [answer.algorithm for answer in answers] == ["astar", "npaco", "dijkstra"] * 8
    assert [answer.query for answer in answers[::3]] == queries
    assert seen == [(done, 24) for done in range(1, 25)]
    for answer in answers:
        assert answer.seconds > 0
        assert answer.gap >= 0
        if answer.algorithm != "npaco":
            assert answer.gap == 0


def test_workers_and_repetition_change_times_only(queries: list[Query]) -> None:
    alone, again, beside = (
        [(answer.query, answer.algorithm, answer.length) for answer in answers]
        for answers in (movingai.run(queries, ["paco"], seed=3, workers=workers) for workers in (1, 1, 3))
    )
    assert alone == again == beside


def test_a_time_limit_ends_the_ants(queries: list[Query]) -> None:
    answers = movingai.run(queries[:1], ["npaco", "astar"], time_limit=1e-9)
    assert [answer.stopped_by.value for answer in answers] == ["criterion", "schedule"]


def test_cancelling_drops_the_query_under_way(queries: list[Query]) -> None:
    cancel = threading.Event()

    def stop(done: int, _total: int) -> None:
        if done == 5:
            cancel.set()

    answers = movingai.run(queries, ["astar", "npaco"], cancel=cancel, progress=stop)
    assert len(answers) == 4
    assert movingai.run(queries, ["astar"], cancel=cancel) == []


def test_wrong_lengths_and_names_are_refused(queries: list[Query], tmp_path: Path) -> None:
    for names in ([], ["ants"], ["astar", "astar"]):
        with pytest.raises(ParameterError):
            movingai.run(queries, names)
    with pytest.raises(ParameterError, match="workers"):
        movingai.run(queries, ["astar"], workers=0)
    write_scenarios(tmp_path / "rooms.map.scen", write_map(tmp_path, "rooms"), off=1.0)
    with pytest.raises(MapFormatError, match="corner rule forbid"):
        movingai.run(read_queries(tmp_path, 1, 1.0), ["astar"])


def test_gap() -> None:
    assert gap_of(12.0, 10.0, 0.0) == pytest.approx(0.2)
    assert gap_of(10.005, 10.0, 5.1e-3) == 0
    assert gap_of(10.006, 10.0, 5.1e-3) == pytest.approx(6e-4)
    assert gap_of(math.inf, 10.0, 5.1e-3) == math.inf
    assert gap_of(0.0, 0.0, 5.1e-3) == 0


def test_scores_by_hand() -> None:
    ants = [
        answered("m", "npaco", length, ms) for length, ms in ((10.0, 4), (10.0, 6), (11.0, 8), (12.0, 10), (15.0, 12))
    ]
    exact = [answered("m", "astar", 10.0, ms) for ms in (1, 2, 3, 4, 5)]
    ant, star = scores([answer for pair in zip(ants, exact, strict=True) for answer in pair])
    assert (ant.map_label, ant.algorithm, ant.queries) == ("m", "npaco", 5)
    assert (ant.solved, ant.optimal) == (100, 40)
    # gaps 0, 0, 10, 20, 50: the 95th percentile lies at place 3.8 of 0..4
    assert (ant.gap_median, ant.gap_95, ant.gap_max) == pytest.approx((10, 44, 50))
    assert (ant.ms_median, ant.ms_95, ant.ratio) == pytest.approx((8, 11.6, 8 / 3))
    assert (star.optimal, star.gap_max, star.ms_median, star.ratio) == pytest.approx((100, 0, 3, 1))


def test_a_query_without_a_path_counts_as_the_worst() -> None:
    (score,) = scores([answered("m", "npaco", length, 1) for length in (10.0, 10.0, math.inf)])
    assert score.solved == score.optimal == pytest.approx(200 / 3)
    assert (score.gap_median, score.gap_95, score.gap_max) == (0, math.inf, math.inf)
    assert math.isnan(score.ratio), "A* did not run"
    assert summary([score]).texts[0][-4:] == ["no path", "1.00", "1.00", "-"]


def test_several_maps_are_summed_up() -> None:
    found = scores([answered("a", "astar", 10.0, 1), answered("b", "astar", 11.0, 3)])
    assert [(score.map_label, score.queries, score.optimal) for score in found] == [
        ("a", 1, 100),
        ("b", 1, 0),
        ("all maps", 2, 50),
    ]
    assert found[2].ms_median == pytest.approx(2)


def test_raw_rows_say_what_was_asked_and_found() -> None:
    table = raw_table([answered("m", "npaco", 12.0, 5)])
    head, row = to_csv.table(table).splitlines()
    assert dict(zip(head.split(","), row.split(","), strict=True)) == {
        "map": "m",
        "scenarios": "m.map.scen",
        "number": "1",
        "start row": "0",
        "start col": "0",
        "goal row": "2",
        "goal col": "2",
        "published length": "10.0",
        "algorithm": "npaco",
        "seed": "0",
        "length": "12.0",
        "gap %": "19.999999999999996",
        "seconds": "0.005",
        "stopped by": "schedule",
    }


def test_default_is_the_preset_for_large_maps() -> None:
    assert movingai.default_algorithms() == ("paco_large", "astar")
    movingai.check_algorithms(movingai.default_algorithms())
