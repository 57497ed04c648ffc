"""Shards and merging: every run in one part, evenly; the same records as of one process."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

import antnav as an
from antnav.errors import ParameterError
from antnav.study.budget import Budget
from antnav.study.front_record import FrontRecord
from antnav.study.merge import ConflictError, merged
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.record import Mark, Record, without_times
from antnav.study.runner import run_study
from antnav.study.shard import Shard, absent
from antnav.study.store import VERSION, Store, StoreError
from tests.conftest import grid_of
from tests.study.made_up import made_up


def study(maps: int = 3, algorithms: int = 4, seeds: int = 5, **more) -> Study:
    problem = an.Problem.from_cells(grid_of("....", ".##.", "...."), (0, 0), (2, 3))
    places = [MapEntry(f"map {n}", replace(problem, goal=(1.5 + n % 3, 0.5))) for n in range(maps)]
    entries = [AlgorithmEntry(f"ants {n}", an.npaco(ants=2 + n, iterations=2)) for n in range(algorithms)]
    return Study("", places, entries, range(seeds), **more)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 7, 10, 60, 200])
@pytest.mark.parametrize("sizes", [(3, 4, 5), (1, 10, 20), (10, 1, 20), (10, 10, 1), (2, 2, 10)])
def test_each_run_is_in_one_part_and_parts_are_even(sizes: tuple[int, int, int], count: int) -> None:
    plan = replace(study(*sizes), maps=[MapEntry(str(n), problem_of(n)) for n in range(sizes[0])])
    parts = [Shard(number, count).jobs(plan) for number in range(1, count + 1)]
    keys = [job.key for jobs in parts for job in jobs]
    assert sorted(keys) == sorted(job.key for job in plan.jobs())
    assert max(map(len, parts)) - min(map(len, parts)) <= 1
    order = [job.key for job in plan.jobs()]
    assert all([job.key for job in jobs] == [key for key in order if key in {j.key for j in jobs}] for jobs in parts)


def problem_of(number: int) -> an.Problem:
    cells = [list("." * 12) for _ in range(3)]
    cells[1][number] = "#"
    return an.Problem.from_cells(grid_of(*("".join(row) for row in cells)), (0, 0), (2, 11))


@pytest.mark.parametrize(
    ("sizes", "count"), [((1, 10, 20), 10), ((10, 1, 20), 10), ((2, 2, 10), 2), ((10, 10, 10), 10)]
)
def test_a_part_has_all_maps_and_algorithms(sizes: tuple[int, int, int], count: int) -> None:
    """Where their number is that of the parts, or a factor of it, too."""
    plan = replace(study(*sizes), maps=[MapEntry(str(n), problem_of(n)) for n in range(sizes[0])])
    for number in range(1, count + 1):
        jobs = Shard(number, count).jobs(plan)
        for kinds, many in (
            (Counter(job.map_label for job in jobs), sizes[0]),
            (Counter(job.algorithm_label for job in jobs), sizes[1]),
        ):
            assert len(kinds) == many
            assert max(kinds.values()) - min(kinds.values()) <= 1 + len(jobs) // many // 2


def test_more_seeds_leave_the_others_where_they_are() -> None:
    few, many = ({job.key for job in Shard(2, 3).jobs(study(seeds=seeds))} for seeds in (4, 9))
    assert few < many


@pytest.mark.parametrize("budget", [Budget.STEPS, Budget.SECONDS])
def test_runs_of_one_budget_stay_together(budget: Budget) -> None:
    for number in range(1, 5):
        jobs = Shard(number, 4).jobs(study(equal_budget=budget))
        keys = {job.key for job in jobs}
        assert all(job.reference in keys for job in jobs if job.reference)


def test_names_for_one_thing_are_in_one_part() -> None:
    plan = study(maps=1, algorithms=1, seeds=4)
    twice = replace(plan, algorithms=[*plan.algorithms, AlgorithmEntry("again", plan.algorithms[0].algorithm)])
    parts = [{job.key for job in Shard(number, 3).jobs(twice)} for number in (1, 2, 3)]
    assert sum(map(len, parts)) == len(set.union(*parts)) == 4


@pytest.mark.parametrize("text", ["", "3", "0/3", "4/3", "-1/3", "1/0", "a/b", "1/2/3", "1.5/2", " 1/2", "1/99999999"])
def test_texts_that_are_no_shards(text: str) -> None:
    with pytest.raises(ParameterError, match=r"shard"):
        Shard.of(text)


def test_two_shards_merged_are_what_one_process_gives(tmp_path: Path) -> None:
    plan = study(equal_budget=Budget.STEPS)
    with Store(tmp_path / "one.sqlite") as store:
        alone = run_study(plan, store)
    paths = [tmp_path / f"{number}.sqlite" for number in (1, 2)]
    for number, path in enumerate(paths, 1):
        with Store(path) as store:
            assert len(run_study(plan, store, shard=Shard(number, 2))) < len(alone)
    stamps = [path.read_bytes() for path in paths]
    assert merged(paths, tmp_path / "both.sqlite") == (len({record.key for record in alone}), 0)
    assert [path.read_bytes() for path in paths] == stamps, "only read"
    done: list[int] = []
    with Store(tmp_path / "both.sqlite") as store:
        together = run_study(plan, store, progress=lambda count, *_: done.append(count))
    assert len(done) == 1, "nothing was left to run"
    assert [without_times(record) for record in together] == [without_times(record) for record in alone]
    assert merged(paths, tmp_path / "both.sqlite") == (0, done[0])


def stored(path: Path, *records: Record) -> Path:
    with Store(path) as store:
        store.add_all(records)
    return path


def test_of_what_both_have_the_first_is_kept(tmp_path: Path) -> None:
    one = made_up("paco", 1, 30.0, key="k")
    again = replace(one, seconds=9.0, environment={}, marks=(Mark.LOADED,), algorithm="another name")
    sources = [stored(tmp_path / "a", one), stored(tmp_path / "b", again, made_up("paco", 2, 31.0))]
    assert merged(sources, tmp_path / "c") == (2, 1)
    with Store(tmp_path / "c") as store:
        assert store.record("k") == one
        assert store.record("none") is None


def test_what_differs_is_refused_and_nothing_is_added(tmp_path: Path) -> None:
    one, other = made_up("paco", 1, 30.0, key="abc"), made_up("paco", 1, 31.0, key="abc")
    sources = [stored(tmp_path / "a", one), stored(tmp_path / "b", other, made_up("paco", 2, 31.0))]
    with pytest.raises(ConflictError, match=r"run abc: .*b tells another outcome"):
        merged(sources, tmp_path / "c")
    assert not (tmp_path / "c").exists()
    with pytest.raises(ConflictError):
        merged(sources[1:], sources[0])
    with Store(sources[0]) as store:
        assert store.records() == [one]
    limited = stored(tmp_path / "d", replace(other, marks=(Mark.LIMITED,)))
    assert merged([sources[0], limited], tmp_path / "c") == (1, 1)


def test_what_is_no_store_is_refused(tmp_path: Path) -> None:
    good = stored(tmp_path / "a", made_up("paco", 1, 30.0))
    with pytest.raises(StoreError, match="no such file"):
        merged([good, tmp_path / "b"], tmp_path / "c")
    old = stored(tmp_path / "old", made_up("paco", 1, 30.0))
    with Store(old) as store:
        store._db.execute(f"PRAGMA user_version = {VERSION - 1}")
    with pytest.raises(StoreError, match=f"version {VERSION - 1}"):
        merged([good, old], tmp_path / "c")
    with pytest.raises(ParameterError, match="added to"):
        merged([good], good)
    assert not (tmp_path / "b").exists()
    assert not (tmp_path / "c").exists()


def test_all_kinds_of_records_are_merged(tmp_path: Path) -> None:
    path = stored(tmp_path / "a", made_up("paco", 1, 30.0))
    front = FrontRecord(
        key="f", map="m", algorithm="exact", seed=0, status="found", complete=True, objectives=("length",),
        counted=(1.0,), values=((1.0,),), work={}, seconds=0.1, certainty=made_up("paco", 1, 1.0).certainty, notes=(),
        environment={},
    )  # fmt: skip
    with Store(path) as store:
        assert not store.holds(FrontRecord)
        store.beside(FrontRecord).add(front)
    assert merged([path], tmp_path / "c") == (2, 0)
    with Store(tmp_path / "c", FrontRecord) as store:
        assert store.records() == [front]


@pytest.mark.parametrize(
    ("numbers", "count", "told"),
    [
        ((1, 2), 3, "part 3 of 3 is missing"),
        ((1,), 3, "parts 2, 3 of 3 are missing"),
        ((2, 1), 2, ""),
        ((50,), 50, f"parts {', '.join(map(str, range(1, 21)))} and 29 more of 50 are missing"),
    ],
)
def test_parts_that_lack_are_named(numbers: tuple[int, ...], count: int, told: str) -> None:
    names = [Shard(number, count).file_name for number in numbers]
    assert absent(names) == told
    assert absent([*names, "runs.sqlite", "other.db", "runs-1-of-1.sqlite"]) == told
