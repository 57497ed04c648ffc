"""What is tuned, on what, and how the winner is judged."""

from __future__ import annotations

import math
from shutil import copy

import numpy as np
import pytest

import antnav as an
from antnav.colony.parts import parameters_of
from antnav.errors import ParameterError
from antnav.study.toml import load_study

SERIAL = an.spmd.Serial()


@pytest.fixture(scope="module")
def tuning(example):
    return example("tuning")


@pytest.fixture(scope="module")
def small(tuning):
    """Three judging maps under two seeds."""
    return tuning.instances(tuning.HERE / "tuning_judging.toml", maps=3, seeds=2)


def test_a_range_goes_by_orders_of_magnitude_where_its_ends_differ_by_far(tuning):
    rho, alpha = tuning.Range(0.02, 0.5, False), tuning.Range(0.5, 3, False)
    assert (rho.log, alpha.log) == (True, False)
    assert [rho.at(0), rho.at(0.5), rho.at(1)] == [0.02, 0.1, 0.5]
    assert [alpha.at(0), alpha.at(0.5), alpha.at(1)] == [0.5, 1.75, 3]
    assert tuning.Range(10, 200, True).at(0.5) == 45  # 44.7
    for one in (rho, alpha):
        for value in (one.low, 0.5, one.high):
            assert one.at(one.share(value)) == value


def test_ranges_are_the_sane_ones_of_antnav(tuning):
    space = tuning.Space("npaco")
    known = parameters_of(an.Algorithm) | an.npaco().deadlock.parameters
    assert list(space.ranges) == ["ants", "alpha", "beta", "rho", "punish"]
    assert {name: (one.low, one.high) for name, one in space.ranges.items()} == {
        name: known[name].sane for name in space.ranges
    }
    assert "stage_one" in tuning.Space("paco").ranges
    assert "q0_min" in tuning.Space("acs").ranges
    assert list(tuning.Space("npaco", ["rho"]).ranges) == ["rho"]


@pytest.mark.parametrize("preset", an.PRESETS)
def test_every_preset_can_be_tuned_to_the_ends_of_its_ranges(tuning, preset):
    space = tuning.Space(preset)
    for share in (0, 1):
        choices = {name: one.at(share) for name, one in space.ranges.items()}
        if space.allows(choices):
            assert space.algorithm(choices).walks <= an.preset(preset).walks
        else:
            assert preset == "paco_taut"  # ten iterations of stage one are more than its 320 walks


@pytest.mark.parametrize(
    ("name", "rule"),
    [("antz", "no parameter of that name"), ("coarse", "no sane range"), ("iterations", "follow from")],
)
def test_what_cannot_be_tuned_is_refused(tuning, name, rule):
    with pytest.raises(SystemExit, match=rule):
        tuning.Space("npaco", [name])


def test_more_ants_get_fewer_iterations(tuning):
    space = tuning.Space("npaco")
    assert space.algorithm(space.default) == an.npaco()
    for ants in (10, 49, 106, 200):
        tuned = space.algorithm({"ants": ants, "rho": 0.123456})
        assert tuned.rho == 0.123
        assert 2500 - ants < tuned.ants * tuned.iterations <= 2500
    assert space.algorithm({"rho": 0.2}) == an.npaco(rho=0.2)


def test_training_and_judging_share_neither_a_map_nor_a_seed(tuning):
    training, judging = (load_study(tuning.HERE / f"tuning_{name}.toml") for name in ("training", "judging"))
    assert not {entry.problem.grid.digest for entry in training.maps} & {
        entry.problem.grid.digest for entry in judging.maps
    }
    assert not set(training.seeds) & set(judging.seeds)


def test_instances_are_all_maps_under_one_seed_then_under_the_next(tuning, small):
    labels = [entry.label for entry in load_study(tuning.HERE / "tuning_judging.toml").maps[:3]]
    assert [(one.map, one.seed) for one in small] == [(label, seed) for seed in (1000, 1001) for label in labels]


def test_a_map_without_a_way_is_refused(tuning, tmp_path):
    file = tmp_path / "study.toml"
    # it needs the paper's corner rule
    file.write_text('seeds = 1\nmaps = [{ builtin = "equiv30" }]\nalgorithms = [{ preset = "npaco" }]\n')
    with pytest.raises(SystemExit, match="map equiv30: there is no way"):
        tuning.instances(file)


def test_gaps_are_above_the_optimum_and_end_at_a_lost_run(tuning, small):
    best = an.exact.optimum(small[0].problem).cost
    assert small[0].gap(best) == 0
    assert small[0].gap(1.25 * best) == pytest.approx(0.25)
    assert [small[0].gap(cost) for cost in (3 * best, math.inf)] == [tuning.LOST, tuning.LOST]


def test_workers_change_no_gap(tuning, small):
    algorithm = an.paco(iterations=6)
    serial, threads = (tuning.final_gaps(algorithm, small, executor) for executor in (SERIAL, an.spmd.executor_for(2)))
    assert serial.tolist() == threads.tolist()
    assert (serial > 0).all()


def test_the_default_judged_against_itself_is_no_better(tuning, small):
    space = tuning.Space("npaco", ["ants", "rho"])
    text = tuning.judged(space, space.default, small, SERIAL)
    assert "judged on 3 other maps x 2 seeds" in text
    assert "+0.00 points (+0.00 to +0.00); better on 0 maps, worse on 0 (Wilcoxon p = 1)" in text


def test_judging_counts_a_map_once_and_sees_who_is_better(tuning, small, monkeypatch):
    space = tuning.Space("npaco", ["rho"])
    given = {0.1: [0.2, 0.4, 0.0, 0.4, 0.4, 1.0], 0.3: [0.1, 0.3, 0.2, 0.1, 0.3, 0.2]}  # maps by turns
    monkeypatch.setattr(tuning, "final_gaps", lambda algorithm, *_: np.array(given[algorithm.rho]))
    default, tuned, difference = tuning.judged(space, {"rho": 0.3}, small, SERIAL).splitlines()[1:]
    assert "mean gap 40.00 %" in default
    assert "optimal in 16.7 % of runs, lost 16.7 %" in default
    assert "mean gap 20.00 %" in tuned
    assert "-20.00 points" in difference
    assert "better on 3 maps, worse on 0" in difference


def test_the_winner_is_saved_as_a_study_of_the_judging_maps(tuning, tmp_path, capsys, small):
    output = tmp_path / "tuned.toml"
    given = tuning.parser(None).parse_args(["--preset", "paco", "--parameters", "ants,rho", "-o", str(output)])
    task = tuning.Task(tuning.Space("paco", ["ants", "rho"]), small, small, SERIAL, given)
    task.tell({"ants": 25, "rho": 0.25})
    assert "an.paco(ants=25, rho=0.25, iterations=100)" in capsys.readouterr().out
    study = load_study(output)
    assert len(study.maps) == len(load_study(given.judging).maps)
    assert study.algorithms[-1].label == "paco, tuned"
    assert study.algorithms[-1].algorithm == an.paco(ants=25, rho=0.25, iterations=100)


#: A rule of one's own in place of the preset's.
OWN = ["--set", "pheromone=near_best", "--parameters", "wide,narrow,gain"]


def test_an_own_rule_is_tuned_in_its_own_ranges_and_saved(tuning, tmp_path, capsys):
    plugin = copy(tuning.HERE / "near_best.py", tmp_path)
    output = tmp_path / "tuned.toml"
    given = tuning.parser(None).parse_args(["--plugin", str(plugin), *OWN, "--quick", "-o", str(output)])
    task = tuning.Task.of(given)
    assert {name: (one.low, one.high) for name, one in task.space.ranges.items()} == {
        "wide": (1, 10), "narrow": (0.1, 2), "gain": (1, 10)
    }  # fmt: skip
    task.tell({"wide": 5.0, "narrow": 0.25, "gain": 2.0})
    assert "an.npaco(pheromone='near_best', wide=5, narrow=0.25, gain=2)" in capsys.readouterr().out
    expected = an.npaco(pheromone="near_best", wide=5, narrow=0.25, gain=2)
    study = load_study(output)
    assert study.algorithms[-1].algorithm == expected
    assert 'plugins = ["near_best.py"]' in output.read_text()
    assert (study.algorithms[-1].label, len(study.maps)) == ("npaco, tuned", len(load_study(given.judging).maps))


def test_an_own_algorithm_is_tuned(tuning, tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(
        "import antnav as an\n@an.register.algorithm\ndef tuned_mine(**given):\n    return an.paco(**given)\n"
        "@an.register.algorithm\ndef only_rho(rho=0.3):\n    return an.paco(rho=rho)\n"
    )
    argv = ["--plugin", str(file), "--preset", "tuned_mine", "--set", "iterations=20", "--set", "beta=5", "--quick"]
    space = tuning.Task.of(tuning.parser(None).parse_args(argv)).space
    assert "stage_one" in space.ranges
    assert "beta" not in space.ranges
    assert (
        space.algorithm({"rho": 0.2}).document()
        == an.algorithm("tuned_mine", iterations=20, beta=5, rho=0.2).document()
    )
    assert space.algorithm({"ants": 100}).iterations == 10
    assert list(tuning.Space("only_rho", ["rho"]).ranges) == ["rho"]
    with pytest.raises(ParameterError, match="only_rho"):
        tuning.Space("only_rho", ["beta"])


@pytest.mark.parametrize(
    ("argv", "rule"),
    [
        (["--set", "beta=5", "--parameters", "beta"], "beta: either fixed by --set or tuned"),
        (["--preset", "astar"], "astar: it has no ants"),
        (["--set", "switch=none", "-o", "x.toml"], "study files cannot say that"),
    ],
)
def test_what_contradicts_itself_is_refused(tuning, argv, rule):
    with pytest.raises(SystemExit, match=rule):
        tuning.Task.of(tuning.parser(None).parse_args([*argv, "--quick"]))


@pytest.mark.parametrize("argv", [["--preset", "nobody"], ["--plugin", "none.py"], ["--set", "beta"]])
def test_names_and_files_that_are_none_are_told_in_one_line(example, argv, capsys):
    assert example("race").main([*argv, "--quick"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("error: ")
    assert len(told.splitlines()) == 1
