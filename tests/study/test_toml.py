"""Studies from TOML: what is read, and what is refused."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import antnav as an
from antnav import errors, maps
from antnav.study.model import AlgorithmEntry
from antnav.study.toml import StudyFormatError, load_study
from tests.conftest import grid_of

ROOT = Path(__file__).parents[2]


HEAD = 'seeds = 2\n[[maps]]\nbuiltin = "equiv20"\n'


ALGORITHM = '[[algorithms]]\npreset = "npaco"\n'


def write(folder: Path, text: str) -> Path:
    path = folder / "example.toml"
    path.write_text(text)
    return path


def test_a_whole_study(tmp_path: Path) -> None:
    maps.save_map(grid_of("....", ".##.", "...."), tmp_path / "yard.yaml")
    text = """
        title = "How greedy?"
        seeds = [3, 5]
        [[maps]]
        builtin = "equiv20"
        corner_rule = "allow"
        [[maps]]
        label = "metres"
        file = "yard.yaml"
        start = [0.5, 2.5]
        goal = [3.5, 0.5]
        [[maps]]
        generate = { kind = "rooms", rows = 20, cols = 30, seed = 4, door = 3 }
        robot_radius = 0.5
        allow_unknown = true
        start_cell = [1, 1]
        goal_cell = [18, 28]
        [[algorithms]]
        preset = "npaco"
        label = "one colony"
        ants = 12
        [sweep]
        preset = "paco"
        ants = 8
        rho = [0.1, 0.2]
        axis = ["row", "column"]
        """
    found = load_study(write(tmp_path, text))
    assert found.title == "How greedy?"
    assert found.seeds == (3, 5)
    assert [entry.label for entry in found.maps] == ["equiv20", "metres", "rooms 20x30 seed 4"]
    first, second, third = (entry.problem for entry in found.maps)
    assert (first.start_cell, first.goal_cell) == maps.builtin_query("equiv20")
    assert first.corner_rule is an.CornerRule.ALLOW
    assert (second.start_cell, second.goal_cell) == ((0, 0), (2, 3))
    assert second.corner_rule is an.CornerRule.FORBID
    assert third.allow_unknown
    assert third.goal_cell == (18, 28)
    assert {entry.label: entry.algorithm for entry in found.algorithms} == {
        "one colony": an.npaco(ants=12),
        "paco rho=0.1 axis=row": an.paco(ants=8, rho=0.1, axis="row"),
        "paco rho=0.1 axis=column": an.paco(ants=8, rho=0.1, axis="column"),
        "paco rho=0.2 axis=row": an.paco(ants=8, rho=0.2, axis="row"),
        "paco rho=0.2 axis=column": an.paco(ants=8, rho=0.2, axis="column"),
    }
    (sweep,) = found.sweeps
    assert (sweep.name, len(sweep.points)) == ("paco", 4)
    assert sweep.points["paco rho=0.2 axis=row"] == {"rho": 0.2, "axis": "row"}


def test_each_sweep_stands_by_itself(tmp_path: Path) -> None:
    text = '[[sweep]]\npreset = "npaco"\nrho = [0.1, 0.2]\n[[sweep]]\npreset = "npaco"\nlabel = "b"\nbeta = [5, 7]\n'
    one, other = load_study(write(tmp_path, HEAD + text)).sweeps
    assert (one.name, list(one.points)) == ("npaco", ["npaco rho=0.1", "npaco rho=0.2"])
    assert (other.name, list(other.points)) == ("b", ["b beta=5", "b beta=7"])


def test_defaults(tmp_path: Path) -> None:
    text = 'seeds = 3\n[[maps]]\ngenerate = { kind = "maze", rows = 9, cols = 9 }\n' + ALGORITHM
    found = load_study(write(tmp_path, text))
    assert found.title == "example"
    assert found.seeds == (0, 1, 2)
    assert found.maps[0].problem.connected
    assert found.algorithms == (AlgorithmEntry("npaco", an.npaco()),)


def test_the_documented_example_and_the_shipped_ones_are_read(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
    maps.save_map(an.GridMap(np.zeros((30, 80), np.uint8), 0.1), tmp_path / "office.yaml")
    found = load_study(write(tmp_path, page.split("```toml\n")[1].split("```")[0]))
    assert [entry.label for entry in found.maps] == ["office", "equiv40", "rooms 40x40 seed 3"]
    assert [entry.label for entry in found.algorithms][:4] == [
        "paco",
        "npaco, few ants",
        "woa-exact",
        "paco rho=0.1 beta=5",
    ]
    for path in (ROOT / "examples").glob("*.toml"):
        shipped = load_study(path)
        compared = len(shipped.algorithms) - 1
        assert compared * 2.0 ** (1 - len(shipped.seeds)) < 0.05, f"{path.name} cannot show a difference"


def test_baseline_limit_and_text_are_kept(tmp_path: Path) -> None:
    text = 'baseline = "npaco"\nseconds = 0.5\n' + HEAD + ALGORITHM
    found = load_study(write(tmp_path, text))
    assert (found.baseline, found.seconds, found.text) == ("npaco", 0.5, text)
    assert found.maps[0].source == {"builtin": "equiv20"}
    assert found.jobs()[0].seconds == 0.5
    assert found.jobs()[0].key not in {job.key for job in replace(found, seconds=None).jobs()}


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ("seeds = ]", StudyFormatError, "line 1"),
        ("sedes = 2\n", StudyFormatError, "'sedes'.*title, seeds, baseline, seconds, equal_budget, maps"),
        ("seeds = 0\n" + HEAD[10:] + ALGORITHM, StudyFormatError, "seeds = 0.*1000000"),
        ("seeds = 1.5\n" + HEAD[10:] + ALGORITHM, StudyFormatError, "seeds = 1.5.*whole number"),
        ("seeds = [1, -1]\n" + HEAD[10:] + ALGORITHM, errors.ParameterError, "seed -1"),
        ("seeds = [1, 1]\n" + HEAD[10:] + ALGORITHM, errors.ParameterError, "seed 1 twice"),
        (HEAD[10:] + ALGORITHM, StudyFormatError, "seeds is missing"),
        ("seeds = 2\n" + ALGORITHM, errors.ParameterError, "no maps"),
        ("seeds = 2\nmaps = 3\n" + ALGORITHM, StudyFormatError, r"begin each with \[\[maps\]\]"),
        (HEAD, errors.ParameterError, "no algorithms"),
        (HEAD + ALGORITHM + ALGORITHM, errors.ParameterError, "label 'npaco' twice.* give one of them label = "),
        ('baseline = "x"\n' + HEAD + ALGORITHM, errors.ParameterError, "baseline 'x'.*such as 'npaco'"),
        ("seconds = 0\n" + HEAD + ALGORITHM, errors.ParameterError, "seconds 0"),
        ('seconds = "1"\n' + HEAD + ALGORITHM, StudyFormatError, "seconds = '1'"),
        (
            'equal_budget = "time"\n' + HEAD + ALGORITHM,
            errors.ParameterError,
            "equal_budget 'time'.*walks, steps, seconds",
        ),
        (
            'equal_budget = "steps"\n' + HEAD + ALGORITHM + '[[algorithms]]\nrival = "woa-exact"\n',
            errors.ParameterError,
            "'woa-exact' with equal_budget steps",
        ),
        (
            'equal_budget = "walks"\n'
            + HEAD
            + ALGORITHM
            + 'ants = 5\niterations = 2\n[[algorithms]]\npreset = "paco"\n',
            errors.ParameterError,
            "paco with 10 ant walks: stage one alone has 300",
        ),
        (HEAD + 'file = "x.map"\n' + ALGORITHM, StudyFormatError, "maps 1, file and builtin"),
        (HEAD + "start = [1, 1]\n" + ALGORITHM, StudyFormatError, "maps 1, start: "),
        (HEAD + "start = [1]\ngoal = [2, 2]\n" + ALGORITHM, StudyFormatError, r"start = \[1\]"),
        (HEAD + "start_cell = [0.5, 1]\ngoal_cell = [2, 2]\n" + ALGORITHM, StudyFormatError, "start_cell = 0.5"),
        (HEAD + "start_cell = [0, 0]\ngoal_cell = [20, 2]\n" + ALGORITHM, errors.OutsideMapError, "maps 1, goal cell"),
        (HEAD + 'corner_rule = "cut"\n' + ALGORITHM, errors.ParameterError, "maps 1, corner rule 'cut'"),
        (HEAD + "robot_radius = -1\n" + ALGORITHM, errors.ParameterError, "maps 1, radius -1"),
        (HEAD + "allow_unknown = 1\n" + ALGORITHM, StudyFormatError, "true or false"),
        (HEAD + "colour = 1\n" + ALGORITHM, StudyFormatError, "maps 1, key 'colour'.*corner_rule"),
        ('seeds = 1\n[[maps]]\nbuiltin = "x"\n' + ALGORITHM, errors.ParameterError, "maps 1, built-in map 'x'"),
        ('seeds = 1\n[[maps]]\nfile = "x.map"\n' + ALGORITHM, errors.MapFileError, "maps 1, cannot read .*x.map"),
        ('seeds = 1\n[[maps]]\ngenerate = { kind = "maze" }\n', StudyFormatError, "maps 1, generate: rows is missing"),
        (
            'seeds = 1\n[[maps]]\ngenerate = { kind = "maze", rows = 9, cols = 9, seed = "x" }\n',
            errors.ParameterError,
            "maps 1, seed 'x'",
        ),
        (
            'seeds = 1\n[[maps]]\ngenerate = { kind = "maze", rows = 9, cols = 9, walls = 2 }\n',
            errors.ParameterError,
            "'walls' of maze",
        ),
        ("seeds = 1\n[[maps]]\ngenerate = []\n", StudyFormatError, "generate"),
        (HEAD + "[[algorithms]]\n", StudyFormatError, "algorithms 1: preset is missing"),
        (HEAD + '[[algorithms]]\npreset = "ant"\n', errors.ParameterError, "algorithms 1, algorithm 'ant'"),
        (HEAD + ALGORITHM + "stage_one = 2\n", StudyFormatError, "'stage_one'.*preset, label, alpha"),
        (HEAD + ALGORITHM + 'name = "x"\n', StudyFormatError, "key 'name'"),
        (HEAD + ALGORITHM + "rho = 1.5\n", errors.ParameterError, "algorithms 1, rho 1.5"),
        (HEAD + ALGORITHM + "rho = [0.1]\n", StudyFormatError, r"rho = \[0.1\]: it is a number; .* in \[\[sweep\]\]"),
        (HEAD + ALGORITHM + "rhoo = 0.1\n", StudyFormatError, "key 'rhoo': did you mean rho.*\\? the keys are preset"),
        (HEAD + ALGORITHM + 'rho = "much"\n', StudyFormatError, "rho = 'much'"),
        (HEAD + ALGORITHM + "ants = 2.5\n", errors.ParameterError, "ants 2.5"),
        (
            HEAD + '[[algorithms]]\npreset = "astar"\nmethod = "dijkstra"\n',
            StudyFormatError,
            "algorithms 1, key 'method': the keys are preset, label;",
        ),
        (
            HEAD + '[[algorithms]]\npreset = "potential-field"\nwalk = 2.5\n',
            errors.ParameterError,
            "algorithms 1, walk 2.5",
        ),
        (HEAD + ALGORITHM + "decomposition = { stage_one = 2 }\n", StudyFormatError, "'decomposition'"),
        (HEAD + '[sweep]\npreset = "paco"\nrho = 0.1\n', StudyFormatError, "sweep 1, a sweep of nothing"),
        (HEAD + '[sweep]\npreset = "paco"\nrho = []\n', StudyFormatError, "a sweep of 0"),
        (HEAD + '[sweep]\npreset = "paco"\nrho = [0.1, 7]\n', errors.ParameterError, "sweep 1, rho 7"),
        (HEAD + '[sweep]\npreset = "paco"\nroh = [0.1]\n', StudyFormatError, "sweep 1, key 'roh'"),
        (HEAD + '[sweep]\npreset = "paco"\nrho = [0.1, 0.1]\n', StudyFormatError, "sweep 1, a value twice"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, kind: type[errors.AntnavError], words: str) -> None:
    with pytest.raises(errors.AntnavError, match=words) as caught:
        load_study(write(tmp_path, text))
    assert type(caught.value) is kind
    assert str(caught.value).count("example.toml") == 1
    assert caught.value.rule
    assert caught.value.remedy


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    deep = write(tmp_path, "seeds = " + "[" * 100_000)
    for path in (tmp_path / "missing.toml", tmp_path, binary, deep, Path("a\0b")):
        with pytest.raises(StudyFormatError):
            load_study(path)


@pytest.mark.skipif(os.name != "posix", reason="needs named pipes")
def test_pipes_devices_and_no_names_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "study.toml")
    for path in (tmp_path / "study.toml", os.devnull, tmp_path, "a\0b", None, 5, b"study.toml"):
        with pytest.raises(errors.ParameterError, match=r"a pipe or a device|null|path-like"):
            load_study(path)


@pytest.mark.parametrize("value", ["true", '"five"', "[5]", "nan", "inf", "-1", "99999999999999999999", "1979-05-27"])
@pytest.mark.parametrize(
    ("kind", "option"),
    [("rooms", "rows"), ("rooms", "seed"), ("random", "block"), ("u_traps", "traps"), ("caves", "steps")],
)
def test_options_of_generators_have_types_and_limits(tmp_path: Path, kind: str, option: str, value: str) -> None:
    options = {"kind": f'"{kind}"', "rows": "20", "cols": "20"} | {option: value}
    table = ", ".join(f"{key} = {text}" for key, text in options.items())
    path = tmp_path / "study.toml"
    path.write_text(f'seeds = 1\n[[maps]]\ngenerate = {{ {table} }}\n[[algorithms]]\npreset = "npaco"\n')
    if (option, value) == ("seed", "99999999999999999999"):
        load_study(path)  # a seed may be as large
    else:
        with pytest.raises(errors.AntnavError, match=r"study\.toml, maps 1"):
            load_study(path)
