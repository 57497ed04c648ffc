"""Iterated racing: who leaves, who stays, and what it costs."""

from __future__ import annotations

import math

import numpy as np
import pytest

import antnav as an


@pytest.fixture(scope="module")
def race(example):
    return example("race")


@pytest.fixture
def task(race, example):
    """Of npaco's beta and rho on made-up results: the nearer to beta 4, rho 0.2, the better, with noise by instance."""
    tuning = example("tuning")

    def made(workers: int = 1, seed: int = 0):
        given = tuning.parser(None).parse_args(["--seed", str(seed)])
        where = tuning.instances(given.training, maps=4, seeds=15)
        return tuning.Task(tuning.Space("npaco", ["beta", "rho"]), where, [], an.spmd.executor_for(workers), given)

    return made


def distance(algorithm) -> float:
    return abs(algorithm.beta - 4) / 8 + abs(math.log(algorithm.rho / 0.2))


@pytest.fixture
def runs(race, monkeypatch):
    """What was run, on made-up results."""
    made = []

    def gap(job):
        instance, algorithm = job
        made.append(job)
        noise = np.random.default_rng([instance.seed, len(instance.map), round(1000 * algorithm.rho)])
        return distance(algorithm) + 0.1 * noise.random()

    monkeypatch.setattr(race, "final_gap", gap)
    return made


def test_the_worst_leaves_and_those_that_share_the_victories_stay(race):
    even = np.array([[1, 2, 3], [2, 1, 3]] * 5, float)
    assert race.survivors(even).tolist() == [True, True, False]
    assert race.survivors(even[:, ::-1]).tolist() == [False, True, True]


def test_who_always_wins_stays_alone(race):
    assert race.survivors(np.tile([2.0, 1.0, 3.0], (8, 1))).tolist() == [False, True, False]


def test_nobody_leaves_without_a_difference(race):
    assert race.survivors(np.zeros((9, 3))).all()
    assert race.survivors(np.random.default_rng(0).random((5, 6))).all()
    assert race.survivors(np.array([[3.0, 1.0, 2.0], [1.0, 2.0, 3.0]])).all()


def test_conovers_comparison_worked_out_by_hand(race):
    # Ranks 1 to 4 in eight blocks; the last two change places twice, the second and third once: sums 8, 17, 25, 30.
    ranks = [[1, 2, 3, 4]] * 5 + [[1, 2, 4, 3]] * 2 + [[1, 3, 2, 4]]
    table = np.array(ranks, float)
    assert table.sum(axis=0).tolist() == [8, 17, 25, 30]
    # 2 (8 * 240 - 8^2 - 17^2 - 25^2 - 30^2) / 21 = 4; t(0.975, 21) = 2.0796: 4.16 apart is too far
    assert race.survivors(table).tolist() == [True, False, False, False]
    assert race.survivors(np.repeat(table, 1, axis=0)[:, 1:]).tolist() == [True, False, False]


def test_two_are_compared_in_pairs(race):
    better = np.array([[number, 2 * number + 1] for number in range(8)], float)
    assert race.survivors(better).tolist() == [True, False]
    assert race.survivors(better[:, ::-1]).tolist() == [False, True]
    assert race.survivors(better[:5]).all()  # five pairs cannot tell


@pytest.mark.parametrize("budget", [150, 400, 1000])
def test_the_budget_is_kept_and_no_run_is_made_twice(race, task, runs, budget):
    racing = race.Racing(task(), budget)
    assert len(list(racing.iterated())) == 3
    assert len(runs) == budget - racing.left <= budget
    assert len({(one.map, one.seed, algorithm.beta, algorithm.rho) for one, algorithm in runs}) == len(runs)


def test_it_comes_near_the_best_and_ranks_the_elites(race, task, runs):
    one = task()
    races = list(race.Racing(one, 1000).iterated())
    found = [distance(one.space.algorithm(race.choices_of(elites[0], one.space))) for elites in races]
    assert found[-1] < 0.1 < distance(an.npaco())
    assert all(len(elites) <= 3 for elites in races)


def test_an_elite_leaves_only_when_rivals_have_met_its_instances(race, task, runs, monkeypatch):
    racing = race.Racing(task(), 1000)
    tables = []
    monkeypatch.setattr(
        race, "survivors", lambda table: tables.append(len(table)) or np.arange(table.shape[1]) == table.shape[1] - 1
    )
    old, new = (0.9, 0.9), (0.1, 0.1)
    racing._gaps[old] = [0.0] * 8
    assert racing._race([old, new], 100) == [new]
    assert len(racing._gaps[new]) == 8
    assert tables == [5, 6, 7, 8]


def test_workers_change_nothing_and_seeds_do(race, task, runs):
    first, again, other = (
        list(race.Racing(task(workers, seed), 300).iterated()) for workers, seed in ((1, 0), (2, 0), (1, 1))
    )
    assert first == again != other


def test_too_few_runs_are_refused(race):
    with pytest.raises(SystemExit, match="too few for a race"):
        race.main(["--runs", "10"])


@pytest.mark.slow
def test_quick_races_judges_and_prints(race, capsys):
    assert race.main(["--quick", "--parameters", "beta,rho"]) == 0
    out = capsys.readouterr().out
    assert "runs left; the best has a mean gap of" in out
    assert "judged on 4 other maps x 3 seeds" in out


def test_candidates_that_contradict_themselves_are_drawn_again(race, task, example, runs):
    tuning = example("tuning")
    given = task().given
    space = tuning.Space("paco_taut", ["ants", "stage_one"])
    racing = race.Racing(tuning.Task(space, task().training, [], an.spmd.Serial(), given), 200)
    assert all(racing.iterated())
    assert {algorithm.walks <= 320 for _, algorithm in runs} == {True}
    assert len({algorithm.ants for _, algorithm in runs}) > 5


def test_a_search_in_which_nothing_fits_together_ends(race, task, monkeypatch):
    one = task()
    monkeypatch.setattr(type(one.space), "allows", lambda *_: False)
    with pytest.raises(SystemExit, match="hardly any choices of beta, rho"):
        next(race.Racing(one, 300).iterated())
