"""Studies: in which order they run, what is refused, and which runs share a key."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import errors
from antnav.rivals import RIVALS, PotentialField, Rival
from antnav.study.model import AlgorithmEntry, MapEntry, Study
from antnav.study.toml import load_study
from antnav.world.cost import CostField
from tests.conftest import grid_of
from tests.study.test_toml import HEAD, write


def problem() -> an.Problem:
    return an.Problem.from_cells(grid_of("...", "...", "..."), (0, 0), (2, 2))


def study(*algorithms: an.Algorithm | Rival) -> Study:
    entries = [AlgorithmEntry(f"number {number}", algorithm) for number, algorithm in enumerate(algorithms)]
    return Study("", [MapEntry("map", problem())], entries, [0])


def test_equal_budgets_are_part_of_the_key_and_of_none_of_the_baselines() -> None:
    own = study(an.npaco(), an.paco())
    keys = {job.key for job in own.jobs()}
    for unit in ("steps", "seconds"):
        first, second = replace(own, equal_budget=unit).jobs()
        assert (first.key, first.budget) == (own.jobs()[0].key, None)
        assert (second.budget, second.reference) == (unit, first.key)
        keys.add(second.key)
    turned = replace(own, equal_budget="steps", baseline="number 1").jobs()
    assert (turned[1].budget, turned[0].reference) == (None, turned[1].key)
    assert len(keys | {turned[0].key}) == 5


def test_jobs_are_interleaved_by_seed_and_map() -> None:
    found = replace(
        study(an.npaco(), an.paco()), maps=[MapEntry("a", problem()), MapEntry("b", problem())], seeds=(4, 2)
    )
    order = [(job.seed, job.map_label, job.algorithm_label) for job in found.jobs()]
    pairs = [("a", "number 0"), ("a", "number 1"), ("b", "number 0"), ("b", "number 1")]
    assert order == [(seed, *pair) for seed in (4, 2) for pair in pairs]


def test_one_key_for_one_outcome() -> None:
    same = [an.npaco(), an.npaco(beta=7), an.npaco(name="x", certainty="y"), an.npaco(switch=0.6, heuristic="target")]
    assert len({job.key for job in study(*same).jobs()}) == 1
    others = [an.npaco(), an.paco(), an.npaco(beta=6), an.paco(stage_one=4), an.npaco(local_rate=0.1)]
    keys = {job.key for job in study(*others).jobs()}
    base = study(an.npaco())
    one = base.maps[0].problem
    for entry in (
        replace(one, corner_rule="allow"),
        replace(one, allow_unknown=True),
        an.Problem.from_cells(one.grid, (0, 1), (2, 2)),
        an.Problem.from_cells(one.grid, (0, 0), (2, 1)),
        an.Problem.from_cells(grid_of("...", ".#.", "..."), (0, 0), (2, 2)),
        an.Problem.from_cells(one.grid, one.start_cell, one.goal_cell, cost=CostField(np.ones(one.grid.shape))),
        an.Problem.from_cells(one.grid, one.start_cell, one.goal_cell, turning=1.0),
    ):
        keys |= {job.key for job in replace(base, maps=[MapEntry("map", entry)]).jobs()}
    keys |= {job.key for job in replace(base, seeds=[1]).jobs()}
    assert len(keys) == 13


@dataclass(frozen=True)
class Straight(Rival):
    """A rival of somebody's own."""

    library: str = "1.0"
    tries: object = 3
    name = "straight"
    certainty = "ours"

    def versions(self) -> dict[str, str]:
        return {"lib": self.library}

    def search(self, problem: an.Problem, seed: int, watch: object) -> str:
        raise NotImplementedError


class Opaque(Rival):
    """A rival that is no dataclass: its repr holds an address."""

    name, certainty = "straight", "ours"


def key_of(rival: Rival) -> str:
    return study(rival).jobs()[0].key


def test_the_key_of_a_rival_holds_its_fields_and_the_versions_of_its_libraries() -> None:
    assert key_of(Straight()) == key_of(Straight(tries=3.0))
    keys = {key_of(Straight()), key_of(Straight(tries=4)), key_of(Straight("2.0")), key_of(PotentialField())}
    assert len(keys) == 4


def test_the_version_of_pygmo_is_part_of_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    pygmo = pytest.importorskip("pygmo")
    before = key_of(RIVALS["ga-straight"])
    monkeypatch.setattr(pygmo, "__version__", "0")
    assert key_of(RIVALS["ga-straight"]) != before


def test_a_rival_whose_runs_would_never_be_found_again_is_refused() -> None:
    for rival in (Straight(tries=object()), Opaque()):
        with pytest.raises(errors.ParameterError, match="planner 'straight': its class is a dataclass"):
            key_of(rival)


def test_too_many_runs(tmp_path: Path) -> None:
    values = str(list(range(1, 1100)))
    with pytest.raises(errors.ParameterError, match="a sweep of 1207801"):
        load_study(write(tmp_path, HEAD + f'[sweep]\npreset = "paco"\nants = {values}\niterations = {values}\n'))
    with pytest.raises(errors.ParameterError, match="a study of 2000000 runs"):
        replace(study(an.npaco(), an.paco()), seeds=range(1_000_000))
