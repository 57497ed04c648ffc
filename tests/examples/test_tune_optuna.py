"""Tuning by optuna: runs that can be left off, and trials that are."""

from __future__ import annotations

from shutil import copy

import numpy as np
import pytest

import antnav as an
from antnav.study.toml import load_study

pytest.importorskip("optuna", reason='needs pip install "antnav[tune]"')


@pytest.fixture(scope="module")
def tuner(example):
    return example("tune_optuna")


@pytest.fixture(scope="module")
def tuning(example):
    return example("tuning")


@pytest.fixture
def task(tuner, tuning):
    """Of so many workers: npaco with few walks on three maps under two seeds."""

    def made(workers: int = 1, seed: int = 0):
        given = tuning.parser(None).parse_args(["--seed", str(seed)])
        where = tuning.instances(given.training, maps=3, seeds=2)
        space = tuning.Space("npaco", ["beta", "rho"])
        return tuning.Task(space, where, where, an.spmd.executor_for(workers), given)

    return made


class Asked:
    """A trial of given choices, that is to end after so many reports."""

    def __init__(self, params, most):
        self.params, self.reported, self._most = params, {}, most

    def report(self, value, step):
        self.reported[step] = value

    def should_prune(self):
        return len(self.reported) >= self._most


@pytest.mark.parametrize("algorithm", [an.npaco(iterations=20), an.paco(iterations=20), an.two_ended(iterations=20)])
def test_a_run_in_parts_ends_where_solve_ends_and_never_gets_worse(tuner, task, tuning, algorithm):
    instance = task().training[0]
    run = tuner.Run(instance, algorithm)
    gaps = [run.advance(more) for more in (1, 4, 10, None)]
    assert gaps == sorted(gaps, reverse=True)
    assert gaps[-1] == tuning.final_gap((instance, algorithm))


def test_a_trial_reports_its_mean_gap_after_each_tenth(tuner, task, tuning):
    one = task()
    trial = Asked({"beta": 7.0, "rho": 0.2}, 99)
    value = tuner.value_of(trial, one)
    assert list(trial.reported) == list(range(1, 11))
    assert value == trial.reported[10]
    assert value == np.mean(tuning.final_gaps(an.npaco(rho=0.2), one.training, one.executor))


def test_a_pruned_trial_walks_no_further(tuner, task, monkeypatch):
    steps = []
    whole = tuner.Run.advance
    monkeypatch.setattr(tuner.Run, "advance", lambda run, count: steps.append(count) or whole(run, count))
    assert tuner.value_of(Asked({"beta": 7.0, "rho": 0.2}, 2), task()) is None
    assert steps == [5] * 12  # two tenths of 50 iterations, six runs


@pytest.mark.slow
def test_the_first_trial_is_the_default_and_the_search_repeats_whatever_the_workers(tuner, task):
    (choices, study), (again, _) = (tuner.tuned(task(workers), 7) for workers in (1, 2))
    assert choices == again
    assert study.trials[0].params == {"beta": 7.0, "rho": 0.1}
    assert study.best_value <= study.trials[0].value
    assert tuner.tuned(task(seed=1), 7)[1].trials[1].params != study.trials[1].params


def test_trials_that_contradict_themselves_are_pruned_before_they_walk(tuner, tuning, task, monkeypatch):
    monkeypatch.setattr(tuning.Space, "allows", lambda _, choices: choices["rho"] < 0.2)
    study = tuner.tuned(task(), 7)[1]
    assert {trial.params["rho"] < 0.2 for trial in study.trials if trial.intermediate_values} == {True}
    assert any(trial.params["rho"] >= 0.2 and not trial.intermediate_values for trial in study.trials)


@pytest.mark.slow
def test_quick_tunes_judges_and_saves(tuner, tmp_path, capsys):
    output = tmp_path / "tuned.toml"
    assert tuner.main(["--quick", "--parameters", "ants,rho", "-o", str(output)]) == 0
    out = capsys.readouterr().out
    assert "8 trials" in out
    assert "judged on 4 other maps x 3 seeds" in out
    assert repr(load_study(output).algorithms[-1].algorithm.ants) in out


@pytest.mark.slow
def test_quick_tunes_an_own_rule(tuner, tuning, tmp_path, capsys):
    argv = ["--plugin", str(copy(tuning.HERE / "near_best.py", tmp_path)), "--set", "pheromone=near_best"]
    assert tuner.main([*argv, "--preset", "npaco", "--parameters", "wide,narrow,gain", "--quick"]) == 0
    out = capsys.readouterr().out
    assert "wide, narrow, gain of npaco" in out
    assert "an.npaco(pheromone='near_best', " in out


def test_a_missing_file_is_told_in_one_line(tuner, capsys):
    assert tuner.main(["--training", "none.toml"]) == 2
    assert capsys.readouterr().err.startswith("error: ")
