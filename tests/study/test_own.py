"""Studies of users' own rules: by name or file, in files, stores, reports, workers."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

from antnav.errors import AntnavError, ParameterError
from antnav.study import setup
from antnav.study.runner import run_study
from antnav.study.store import Store
from antnav.study.toml import load_study

MINE = '''
from dataclasses import dataclass
import antnav as an

@an.register.heuristic(version="1.2")
def homing(ground, reach=an.parameter(2.0, least=0, most=9)):
    """1 / (reach + the straight distance to the goal)."""
    rows, cols = (ground.cells - ground.cells[ground.goal]).T
    return 1 / (reach + (rows**2 + cols**2) ** 0.5)

@an.register.cuts
def halves(ground, paths, pieces, shift=0):
    return [paths[0][len(paths[0]) // 2 + shift]]

@an.register.algorithm
def drawn(pull=1.0, **choices):
    """npaco drawn home."""
    return an.npaco(**({"heuristic": homing(reach=pull), "ants": 9, "iterations": 3} | choices))

@an.register.planner
@dataclass(frozen=True)
class Stair(an.Planner):
    name: str = "stair"
    wait: float = 0.5
    def plan(self, problem, call):
        return an.Plan(cells=an.exact.shortest_path(problem).path.cells)

@an.register.objective
class Middle(an.objectives.Objective):
    name = "middle"
    def edges(self, terrain, graph):
        columns = graph.cells[:, 1]
        return abs(columns - columns.max() / 2)[:, None] + 0.0 * graph.graph.lengths
'''
HEAD = 'seeds = 2\n[[maps]]\nbuiltin = "equiv20"\n'
STUDY = f'plugins = ["../mine.py"]\n{HEAD}' + dedent("""
    [[algorithms]]
    preset = "drawn"
    pull = 2.0
    [[algorithms]]
    preset = "npaco"
    label = "ruled"
    heuristic = "homing"
    reach = 3.0
    ants = 9
    iterations = 3
    [[algorithms]]
    rival = "stair"
    [sweep]
    preset = "drawn"
    pull = [0.5, 4.0]
    """)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path) -> Path:
    (tmp_path / "mine.py").write_text(MINE)
    (tmp_path / "studies").mkdir()
    return tmp_path / "studies"


def loaded(folder: Path, text: str) -> Any:
    (folder / "own.toml").write_text(text)
    return load_study(folder / "own.toml")


def test_a_study_of_own_rules(folder: Path) -> None:
    study = loaded(folder, STUDY)
    chosen = {entry.label: entry.algorithm for entry in study.algorithms}
    assert list(chosen) == ["drawn", "ruled", "stair", "drawn pull=0.5", "drawn pull=4.0"]
    assert [one.heuristic.reach for one in chosen.values() if one.ants] == [2.0, 3.0, 0.5, 4.0]
    with Store(folder / "runs.sqlite", study.keeps) as store:
        records = run_study(study, store)
    assert len(records) == 10
    assert {record.status for record in records} == {"found"}
    (table, *_) = setup.tables(study)
    words = str(table)
    assert "own rule homing (mine.py, 1.2)" in words
    assert '"file": "mine.py"' in setup.document(study)
    assert "own rule homing (mine.py, 1.2)" in str({str(record.certainty) for record in records})
    # again: nothing to do; with an edited file: all that is the user's
    keys = {job.key for job in study.jobs()}
    assert {job.key for job in loaded(folder, STUDY).jobs()} == keys
    (folder.parent / "mine.py").write_text(MINE + "# edited\n")
    assert not {job.key for job in loaded(folder, STUDY).jobs()} & keys


def test_names_with_files_are_found_from_the_study(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir("/")
    text = HEAD + dedent("""
        [[algorithms]]
        preset = "../mine.py:drawn"
        [[algorithms]]
        preset = "paco"
        cuts = "../mine.py:halves"
        shift = 1
        [sweep]
        preset = "npaco"
        heuristic = ["target", "../mine.py:homing"]
        """)
    study = loaded(folder, text)
    assert [entry.label for entry in study.algorithms] == [
        "drawn",
        "paco",
        "npaco heuristic=target",
        "npaco heuristic=homing",
    ]
    assert study.algorithms[1].algorithm.decomposition.cuts.shift == 1
    assert study.text == text


def test_fronts_and_changes_take_them(folder: Path) -> None:
    fronts = loaded(
        folder, 'objectives = ["length", "../mine.py:middle"]\n' + HEAD + '[[algorithms]]\nmethod = "exact"\n'
    )
    assert [objective.name for objective in fronts.objectives["equiv20"]] == ["length", "middle"]
    changes = loaded(
        folder, 'plugins = "../mine.py"\nchanges = { count = 1 }\n' + HEAD + '[[algorithms]]\npreset = "drawn"\n'
    )
    assert changes.algorithms[0].algorithm.name == "drawn"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('plugins = ["no.py"]\n' + STUDY[STUDY.index("\n") + 1 :], r"own.toml, plugin .*no.py: No such file"),
        (HEAD + '[[algorithms]]\npreset = "nobody"\n', "algorithms 1, algorithm 'nobody'"),
        (HEAD + '[[algorithms]]\npreset = "../mine.py:nobody"\n', "registers nothing of that name"),
        (HEAD + '[[algorithms]]\npreset = "npaco"\nheuristic = "../mine.py:homing"\ntop = 3\n', "key 'top'"),
        (
            HEAD + '[[algorithms]]\npreset = "npaco"\nheuristic = "../mine.py:homing"\nreach = 10\n',
            "reach lies in 0..9",
        ),
        (HEAD + '[[algorithms]]\npreset = "npaco"\nheuristic = "../mine.py:homing"\nreach = "far"\n', "it is a number"),
        ("plugins = 3\n" + HEAD, "plugins = 3: it is a text"),
    ],
)
def test_what_a_study_gets_wrong(folder: Path, text: str, words: str) -> None:
    with pytest.raises((ParameterError, AntnavError), match=words):
        loaded(folder, text)
