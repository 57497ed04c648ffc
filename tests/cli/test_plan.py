"""The command line: exit codes, what stands on stdout and stderr, files, Ctrl-C, and bad input of every kind."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import math
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.cli import main, plan, query, running, terminal
from antnav.cli.sketch import framed, sketch
from antnav.errors import OutputError, PathError
from antnav.fronts.pareto import METHODS
from antnav.plan.algorithms import EXACT, names
from antnav.planner.events import Improved, Iterated
from antnav.planner.planner import parameters
from tests.cli.conftest import Run

COMMANDS = ("plan", "algorithms", "warmup", "maps list", "maps show", "maps generate", "maps convert")
SMALL = ("--ants", "10", "--iterations", "8")
WALL = "00100\n00100\n00100\n"
UNIX = pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals and pipes")


@pytest.fixture
def wall(tmp_path: Path) -> Path:
    """Two rooms without a door."""
    path = tmp_path / "wall.txt"
    path.write_text(WALL)
    return path


def rows(out: str) -> dict[str, str]:
    """The table that goes to a pipe."""
    return dict(line.split("  ", 1) for line in out.splitlines() if "  " in line)


# ------------------------------------------------------------------------------------------------------------ plan


def test_found(cli: Run) -> None:
    code, out, err = cli("plan", "equiv20", *SMALL)
    assert (code, err) == (0, "")
    assert rows(out)["status"].strip() == "found"
    assert {"length", "optimum", "gap", "turns", "clearance", "iterations", "seconds"} <= set(rows(out))


def test_json_is_one_object_and_nothing_else(cli: Run) -> None:
    code, out, err = cli("plan", "equiv20", "--seed", 3, "--check", "--json", *SMALL)
    assert (code, err) == (0, "")
    assert out.count("\n") == 1
    plan_ = json.loads(out)
    wanted = {"status", "length", "length_m", "optimum", "gap", "seconds_run", "seconds_compile", "seed", "path"}
    assert wanted <= set(plan_)
    assert "history" not in plan_
    assert "cells" not in plan_["problem"]["map"]
    assert (plan_["status"], plan_["seed"], plan_["checked"]) == ("found", 3, True)
    assert plan_["gap"] == pytest.approx(plan_["length"] / plan_["optimum"] - 1)
    assert (plan_["path"][0], plan_["path"][-1]) == ([0, 0], [19, 19])


def test_json_without_a_path_has_null_for_infinity(cli: Run, wall: Path) -> None:
    code, out, err = cli("plan", wall, "--cells", "--start", "0,0", "--goal", "0,4", "--json")
    assert (code, err) == (1, "")
    plan_ = json.loads(out, parse_constant=pytest.fail)
    assert (plan_["status"], plan_["length"], plan_["path"], plan_["gap"]) == ("unreachable", None, None, None)
    assert plan_["notes"][0].startswith("no path exists")
    assert plan_["checked"] is False


def test_quiet_says_nothing(cli: Run, wall: Path) -> None:
    assert cli("plan", "equiv20", "-q", *SMALL) == (0, "", "")
    assert cli("plan", wall, "--cells", "--start", "0,0", "--goal", "0,4", "--quiet") == (1, "", "")


def test_quiet_does_not_silence_json(cli: Run) -> None:
    assert json.loads(cli("plan", "equiv20", "-q", "--json", *SMALL)[1])["status"] == "found"


def test_unreachable_is_told_in_plain_words_with_what_helps(cli: Run, wall: Path) -> None:
    code, out, err = cli("plan", wall, "--cells", "--start", "0,0", "--goal", "0,4")
    assert (code, err) == (1, "")
    table = rows(out)
    assert table["status"].strip() == "unreachable"
    assert "no path exists from start to goal under corner rule forbid" in table["why"]
    assert "cells can be reached from the start" in table["why"]
    assert table["remedy"].strip() == "move the start or the goal, or mend the map"  # a tolerance of 3 of 4 m is no way
    code, out, _ = cli("plan", wall, "--cells", "--start", "0,0", "--goal", "0,4", "--goal-tolerance", "3.01", *SMALL)
    assert code == 0


def test_remedy_for_a_corner(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "map.txt").write_text("010\n101\n010\n")
    arguments = ("plan", "map.txt", "--cells", "--start", "0,0", "--goal", "2,2", "--corner-rule")
    for rule in ("forbid", "graze"):
        code, out, _ = cli(*arguments, rule)
        assert (code, "a way opens with --corner-rule allow" in rows(out)["remedy"]) == (1, True)
    assert cli(*arguments, "allow", *SMALL)[0] == 0


def hall(tmp_path: Path) -> Path:
    """Two rooms of 0.1 m cells joined by a gap 0.7 m wide, across which a strip is unknown."""
    cells = np.ones((60, 60), np.uint8)
    cells[2:20, 2:58] = cells[40:58, 2:58] = cells[20:40, 28:35] = 0
    an.save_map(an.GridMap(cells, 0.1, (-3.0, -3.0, 0.0)), tmp_path / "gap.yaml")
    cells[30, 28:35] = 2
    an.save_map(an.GridMap(cells, 0.1, (-3.0, -3.0, 0.0)), tmp_path / "strip.yaml")
    return tmp_path


def test_remedy_for_a_robot_that_is_too_wide(cli: Run, tmp_path: Path) -> None:
    ends = ("--start", "-2,2", "--goal", "2,-2")  # negative numbers are values, not options
    code, out, _ = cli("plan", hall(tmp_path) / "gap.yaml", *ends, "--robot-radius", 0.5)
    assert code == 1
    assert "robot of radius 0.5 m" in rows(out)["why"]
    assert "--robot-radius 0.375" in rows(out)["remedy"]
    assert cli("plan", tmp_path / "gap.yaml", *ends, "--robot-radius", 0.375, "--check", *SMALL)[0] == 0


def test_remedy_for_unknown_cells(cli: Run, tmp_path: Path) -> None:
    ends = ("--start=-2,2", "--goal=2,-2")
    code, out, _ = cli("plan", hall(tmp_path) / "strip.yaml", *ends)
    assert code == 1
    assert "unknown cells closed" in rows(out)["why"]
    assert "--allow-unknown" in rows(out)["remedy"]
    assert cli("plan", tmp_path / "strip.yaml", *ends, "--allow-unknown", "--check", *SMALL)[0] == 0


def test_no_ant_arrived(cli: Run) -> None:
    code, out, err = cli("plan", "equiv40", "--algorithm", "traditional", "--ants", 1, "--iterations", 1)
    assert (code, err) == (1, "")
    assert rows(out)["status"].strip() == "no ant arrived"
    assert "in 1 iteration of 1 ant, though a path of 56.9706 cells exists" in rows(out)["why"]


def test_cells_and_metres_mean_the_same(cli: Run) -> None:
    _, by_cells, _ = cli("plan", "warehouse", "--cells", "--start", "375,45", "--goal", "376,90", "--json", *SMALL)
    first = json.loads(by_cells)
    x, y = first["problem"]["start"]
    assert x < 1 and y < 0
    _, by_metres, _ = cli("plan", "warehouse", "--start", f"{x},{y}", "--goal",
                          ",".join(map(str, first["problem"]["goal"])), "--json", *SMALL)  # fmt: skip
    assert json.loads(by_metres)["path"] == first["path"]


@pytest.mark.parametrize("algorithm", ["npaco", "paco", "paco_extended"])
def test_same_seed_same_path_for_any_number_of_workers(cli: Run, algorithm: str) -> None:
    arguments = ("plan", "equiv30", "--corner-rule", "allow", "--json", "--algorithm", algorithm)

    def path(*options: object) -> Any:
        return json.loads(cli(*arguments, *options, *SMALL)[1])["path"]

    assert path("--seed", 5)
    assert path("--seed", 5, "--workers", 1) == path("--seed", 5, "--workers", 2) == path("--seed", 5)
    assert path("--seed", 6) != path("--seed", 5)


def test_options_reach_the_algorithm(cli: Run) -> None:
    _, out, _ = cli("plan", "equiv20", "--json", "--algorithm", "paco_extended", "--heuristic", "sum",
                    "--axis", "column", "--corner-rule", "graze", *SMALL)  # fmt: skip
    plan_ = json.loads(out)
    algorithm = plan_["algorithm"]
    assert (algorithm["name"], algorithm["heuristic"], algorithm["ants"], algorithm["iterations"]) == (
        "paco_extended", "sum", 10, 8,
    )  # fmt: skip
    assert algorithm["decomposition"]["axis"] == "column"
    assert plan_["problem"]["corner_rule"] == "graze"


def test_any_parameter_can_be_set(cli: Run) -> None:
    given = ["pheromone=rank_based", "elite=4", "rho=0.2", "graft=true", "rho_last=none", "iterations=6"]
    settings = [word for one in given for word in ("--set", one)]
    _, out, _ = cli("plan", "equiv20", "--json", "--algorithm", "npaco", "--ants", 9, *settings)
    algorithm = json.loads(out)["algorithm"]
    found = [algorithm[name] for name in ("pheromone", "elite", "rho", "graft", "rho_last", "iterations", "ants")]
    assert found == ["rank_based", 4, 0.2, True, None, 6, 9]


def test_time_limit(cli: Run) -> None:
    begin = time.perf_counter()
    code, out, _ = cli("plan", "equiv40", "--iterations", 10**6, "--time-limit", 0.3)
    assert (code, time.perf_counter() - begin < 10) == (0, True)
    assert "Seconds(limit=" in rows(out)["status"]


def test_check_is_told(cli: Run) -> None:
    _, out, _ = cli("plan", "equiv20", "--check", *SMALL)
    assert "legal" in rows(out)["checked"]


def test_a_path_that_fails_the_check_is_an_internal_error(cli: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> float:
        raise PathError("move (0, 0) -> (5, 5)", "the cells are not neighbours", "report this")

    monkeypatch.setattr(plan, "check_path", fail)
    code, out, err = cli("plan", "equiv20", "--check", *SMALL)
    assert (code, out) == (70, "")
    assert err == "antnav: internal error: move (0, 0) -> (5, 5): the cells are not neighbours; report this\n"


def test_start_tolerance(cli: Run, tmp_path: Path) -> None:
    path = tmp_path / "corner.txt"
    path.write_text("00000\n00000\n00001\n")
    ends = ("--start", "4.5,1.5", "--goal", "0.5,0.5", "--robot-radius", 1)
    code, _, err = cli("plan", path, *ends)
    assert (code, err.count("\n")) == (2, 1)
    assert "or give --start-tolerance" in err
    code, out, _ = cli("plan", path, *ends, "--start-tolerance", 1.5)
    assert code == 0
    assert "the start (4.5, 1.5) m was moved by 1 m to" in rows(out)["note"]


def test_the_margin_that_is_kept(cli: Run, tmp_path: Path) -> None:
    """A wall of one cell in the middle of a map of 10 x 10 m, and a robot of 1.4 m radius."""
    cells = np.zeros((20, 20), np.uint8)
    cells[9, 9] = 1
    an.save_map(an.GridMap(cells, 0.5), tmp_path / "pillar.yaml")
    arguments = ("plan", tmp_path / "pillar.yaml", "--start", "1,5.25", "--goal", "9,5.25", "--robot-radius", 1.4)
    code, out, _ = cli(*arguments, "--json")
    loose = json.loads(out)
    assert code == 0
    assert loose["margin_m"] == pytest.approx(loose["wall_distance_m"] - 1.4)
    assert loose["margin_m"] < 0
    assert "--strict-radius keeps the whole radius" in rows(cli(*arguments)[1])["margin"]
    code, out, _ = cli(*arguments, "--strict-radius", "--json")
    strict = json.loads(out)
    assert code == 0
    assert 0 <= strict["margin_m"] < 0.5
    assert strict["length"] > loose["length"]
    assert "margin" not in rows(cli("plan", "equiv20", *SMALL)[1])


def test_a_margin_that_a_strict_radius_does_not_keep_is_explained(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "wall.txt").write_text("\n".join(["1" * 20, *["0" * 20] * 18, "1" * 20]) + "\n")
    ends = ("--start", "2.5,17.95", "--goal", "17.5,17.95")  # by the upper edge of their cells
    code, out, _ = cli("plan", "wall.txt", *ends, "--robot-radius", "1.3", "--strict-radius", *SMALL)
    assert code == 0
    assert "an end lies off the centre" in rows(out)["margin"]


def test_the_raw_path(cli: Run) -> None:
    raw, straight = (
        json.loads(cli("plan", "equiv20", *SMALL, "--json", f"--{option}")[1])
        for option in ("no-straighten", "straighten")
    )
    assert raw["length"] == straight["length"]
    assert raw["turns"] > straight["turns"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            "plan wall.txt --cells --start 0,2 --goal 0,0",
            "an obstacle is there; choose a free cell, or give --start-tol",
        ),
        (
            "plan wall.txt --cells --start 0,0 --goal 0,1 --robot-radius 1",
            "cell or give a smaller --robot-radius or margin, or give",
        ),
        (
            "plan wall.txt --cells --start 0,0 --goal 0,2 --goal-tolerance 0.5",
            "choose a free cell, or give a larger --goal-tolerance",
        ),
        ("plan warehouse --cells --start 0,0 --goal 3,3", "cell, or give --allow-unknown, or give --start-tolerance"),
        ("plan warehouse --robot-radius -1", "error: --robot-radius -1.0: "),
        ("plan warehouse --start-tolerance -1", "error: --start-tolerance -1.0: "),
        ("plan warehouse --time-limit 0", "error: --time-limit 0.0: "),
        ("plan warehouse --ants 0", "error: --ants 0: "),
        ("plan wall.map --values occupancy --cells --start 0,0 --goal 0,1", "error: --values occupancy for wall.map: "),
        ("maps show wall.map --invert", "error: --invert for wall.map: "),
        ("maps show grades.csv", "OccupancyGrid values are read with --values occupancy;"),
        ("maps show grades.npy", "for OccupancyGrid values give --values occupancy\n"),
        ("study it.toml -o out", "seconds 0"),
    ],
)
def test_errors_name_options(cli: Run, wall: Path, arguments: str, words: str) -> None:
    an.save_map(an.load_map(wall), wall.with_suffix(".map"))
    wall.with_name("grades.csv").write_text("0,100\n0,0\n")
    np.save(wall.with_name("grades.npy"), [[0, 100]])
    table = "[[maps]]\nbuiltin = 'equiv20'\n[[algorithms]]\npreset = 'npaco'\n"
    wall.with_name("it.toml").write_text(f"title = 'it'\nseeds = 1\nseconds = 0\n{table}")
    code, _, err = cli(*arguments.split())
    assert code == 2
    assert words in err
    assert "--time-limit" not in err or "study" not in arguments, "it has no such option"


def test_a_strict_radius_needs_a_radius(cli: Run) -> None:
    code, _, err = cli("plan", "equiv20", "--strict-radius", *SMALL)
    assert code == 2
    assert "--strict-radius: it says how the robot's radius is measured; give a --robot-radius" in err


def test_goal_tolerance(cli: Run) -> None:
    code, out, _ = cli("plan", "equiv20", "--cells", "--goal", "2,15", "--json", "--goal-tolerance", 3, *SMALL)
    plan_ = json.loads(out)
    assert code == 0
    assert 0 < math.dist(plan_["problem"]["goal_cell"], (2, 15)) <= 3


# --------------------------------------------------------------------------------------------------------- outputs


def test_outputs_are_valid(cli: Run, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    names = ["plan.json", "plan.csv", "plan.png", "plan.svg", "plan.pdf"]
    code, out, err = cli("plan", "equiv20", *SMALL, *(part for name in names for part in ("-o", name)))
    assert (code, err) == (0, "")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    assert out.count("saved") == len(names)
    result = an.Result.load(tmp_path / "plan.json")
    assert result.path is not None
    assert an.check_path(result.path, result.problem) == pytest.approx(result.length)
    with (tmp_path / "plan.csv").open(newline="") as stream:
        lines = list(csv.DictReader(stream))
    assert [[int(line["row"]), int(line["col"])] for line in lines] == result.path.cells.tolist()
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (tmp_path / "plan.svg").read_bytes()
    assert (tmp_path / "plan.pdf").read_bytes().startswith(b"%PDF")


def test_outputs_are_written_without_a_path_too(cli: Run, wall: Path, tmp_path: Path) -> None:
    code, _, err = cli("plan", wall, "--cells", "--start", "0,0", "--goal", "0,4", "-o", "no.json", "-o", "no.csv")
    assert (code, err) == (1, "")
    result = an.Result.load(tmp_path / "no.json")
    assert result.status is an.Status.UNREACHABLE
    assert any("mend the map" in note for note in result.notes)
    assert (tmp_path / "no.csv").read_text().count("\n") == 1


def test_a_failed_write_does_not_cost_the_answer(cli: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def full(*_: object) -> None:
        raise OutputError("cannot write plan.csv", "No space left on device", "make room")

    monkeypatch.setattr("antnav.planner.result.write_whole", full)
    code, out, err = cli("plan", "equiv20", "-o", "plan.csv", *SMALL)
    assert code == 2
    assert rows(out)["status"].strip() == "found"
    assert "saved" not in out
    assert err == "antnav: error: cannot write plan.csv: No space left on device; make room\n"
    assert not list(tmp_path.iterdir())


def test_a_failed_file_does_not_cost_the_others(cli: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("no such font")

    monkeypatch.setattr("antnav.plot.save_picture", fail)
    code, out, err = cli("plan", "equiv20", "-o", "plan.png", "-o", "plan.json", "--json", *SMALL)
    assert code == 2
    assert json.loads(out)["status"] == "found"
    assert err.startswith("antnav: error: picture plan.png: RuntimeError: no such font;")
    assert an.Result.load(tmp_path / "plan.json").path is not None


def test_ctrl_c_while_drawing_costs_the_picture_only(cli: Run, tmp_path: Path, monkeypatch) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("antnav.plot.save_picture", interrupt)
    code, out, err = cli("plan", "equiv20", "-o", "plan.png", "-o", "plan.csv", *SMALL)
    assert (code, err) == (130, "antnav: interrupted\n")
    assert rows(out)["saved"].strip() == "plan.csv"


@pytest.mark.parametrize("backend", ["module://matplotlib_inline.backend_inline", "module://not.there", "odd", "tkagg"])
def test_pictures_need_no_window_system(tmp_path: Path, backend: str) -> None:
    pytest.importorskip("matplotlib")
    script = (
        "import antnav as an; from antnav import maps, plot\n"
        "problem = an.Problem.from_cells(maps.builtin('equiv20'), *maps.builtin_query('equiv20'))\n"
        "plot.save_picture(an.solve(problem, an.npaco(ants=5, iterations=5)), 'plan.png')\n"
    )
    command = [sys.executable, "-c", script]
    environment = os.environ | {"MPLBACKEND": backend}
    run = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    assert (tmp_path / "plan.png").stat().st_size > 10_000


# ------------------------------------------------------------------------------------------------------- bad input

BAD_PLANS: dict[str, list[str]] = {
    "no map": [],
    "two maps": ["equiv20", "equiv30"],
    "missing file": ["missing.yaml"],
    "misspelt built-in": ["equiv21"],
    "directory": ["."],
    "empty name": [""],
    "device": [os.devnull, "--start", "1,1", "--goal", "2,2"],
    "empty file": ["empty.txt", "--start", "1,1", "--goal", "2,2"],
    "not a map": ["noise.bin", "--start", "1,1", "--goal", "2,2"],
    "malformed YAML": ["broken.yaml", "--start", "1,1", "--goal", "2,2"],
    "YAML without keys": ["keyless.yaml", "--start", "1,1", "--goal", "2,2"],
    "YAML without its image": ["imageless.yaml", "--start", "1,1", "--goal", "2,2"],
    "truncated PGM": ["truncated.pgm", "--start", "1,1", "--goal", "2,2"],
    "no start": ["wall.txt", "--goal", "1,1"],
    "no goal": ["wall.txt", "--start", "1,1"],
    "start outside": ["equiv20", "--start", "-1,3"],
    "start far outside": ["equiv20", "--start", "1e300,3"],
    "start cell outside": ["equiv20", "--cells", "--start", "20,0"],
    "start cell enormous": ["equiv20", "--cells", "--start", f"{10**40},0"],
    "start occupied": ["wall.txt", "--cells", "--start", "0,2", "--goal", "0,0"],
    "goal occupied": ["wall.txt", "--cells", "--start", "0,0", "--goal", "0,2"],
    "start inflated": ["wall.txt", "--cells", "--start", "0,1", "--goal", "0,0", "--robot-radius", "1"],
    "NaN": ["equiv20", "--start", "nan,3"],
    "infinity": ["equiv20", "--start", "3,inf"],
    "one number": ["equiv20", "--start", "3"],
    "three numbers": ["equiv20", "--start", "3,4,5"],
    "words": ["equiv20", "--goal", "here,there"],
    "fractions of cells": ["equiv20", "--cells", "--start", "0.5,0"],
    "5000 digits": ["equiv20", "--cells", "--start", "9" * 5000 + ",0"],
    "line break": ["equiv20", "--start", "1\n2"],
    "unknown algorithm": ["equiv20", "--algorithm", "magic"],
    "unknown corner rule": ["equiv20", "--corner-rule", "maybe"],
    "unknown heuristic": ["equiv20", "--heuristic", "luck"],
    "a setting without a value": ["equiv20", "--set", "ants"],
    "a setting without a name": ["equiv20", "--set", "=4"],
    "a setting twice": ["equiv20", "--set", "rho=0.1", "--set", "rho=0.2"],
    "a setting that is an option, too": ["equiv20", "--ants", "5", "--set", "ants=6"],
    "a setting out of range": ["equiv20", "--set", "rho=nan"],
    "a setting of another algorithm": ["equiv20", "--algorithm", "astar", "--set", "rho=0.1"],
    "unknown axis": ["equiv20", "--axis", "z"],
    "axis without a division": ["equiv20", "--algorithm", "npaco", "--axis", "row"],
    "no ants": ["equiv20", "--ants", "0"],
    "half an ant": ["equiv20", "--ants", "1.5"],
    "no iterations": ["equiv20", "--iterations", "0"],
    "fewer iterations than stage one": ["equiv20", "--iterations", "2"],
    "negative seed": ["equiv20", "--seed", "-1"],
    "seed too large": ["equiv20", "--seed", str(2**64)],
    "negative radius": ["equiv20", "--robot-radius", "-0.1"],
    "radius NaN": ["equiv20", "--robot-radius", "nan"],
    "radius a word": ["equiv20", "--robot-radius", "wide"],
    "tolerance negative": ["equiv20", "--goal-tolerance", "-1"],
    "time limit zero": ["equiv20", "--time-limit", "0"],
    "no workers": ["equiv20", "--workers", "0"],
    "unknown option": ["equiv20", "--fly"],
    "option without value": ["equiv20", "--seed"],
    "bad ending": ["equiv20", "-o", "plan.jpg"],
    "no ending": ["equiv20", "-o", "plan"],
    "second output bad": ["equiv20", "-o", "plan.json", "-o", "plan.doc"],
    "missing folder": ["equiv20", "-o", "missing/plan.json"],
    "output is a folder": ["equiv20", "-o", "folder.json"],
    "output below a file": ["equiv20", "-o", "wall.txt/plan.json"],
    "output name too long": ["equiv20", "-o", "x" * 300 + ".json"],
    "output with a NUL": ["equiv20", "-o", "a\0b.json"],
    "output is the map": ["map.png", "--start", "1,1", "--goal", "2,2", "-o", "map.png"],
    "output is the map's image": ["map.yaml", "--start", "1,1", "--goal", "2,2", "-o", "map.png"],
    "more than fits in memory": ["equiv20", "--ants", str(10**9)],
}


@pytest.fixture
def junk(tmp_path: Path) -> Path:
    """A folder of files that are no maps, or only just."""
    from PIL import Image

    (tmp_path / "wall.txt").write_text(WALL)
    (tmp_path / "empty.txt").touch()
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)))
    (tmp_path / "broken.yaml").write_text("image: [1, 2\nresolution: {")
    (tmp_path / "keyless.yaml").write_text("image: map.png\n")
    meta = "resolution: 1.0\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    (tmp_path / "imageless.yaml").write_text("image: gone.pgm\n" + meta)
    (tmp_path / "map.yaml").write_text("image: map.png\n" + meta)
    (tmp_path / "truncated.pgm").write_bytes(b"P5\n100 100\n255\nabc")
    (tmp_path / "folder.json").mkdir()
    Image.fromarray(np.full((5, 5), 254, np.uint8)).save(tmp_path / "map.png")
    return tmp_path


def snapshot(folder: Path) -> dict[str, bytes | None]:
    return {path.name: path.read_bytes() if path.is_file() else None for path in folder.iterdir()}


@pytest.mark.parametrize("arguments", BAD_PLANS.values(), ids=BAD_PLANS)
def test_bad_input_is_one_line_and_exit_code_2(cli: Run, junk: Path, arguments: list[str]) -> None:
    before = snapshot(junk)
    code, out, err = cli("plan", *arguments)
    assert (code, out) == (2, "")
    assert err.startswith("antnav: error: ")
    assert err.endswith("\n")
    assert len(err.splitlines()) == 1
    assert len(err) < 1200
    assert snapshot(junk) == before


@pytest.mark.skipif(not Path("/proc/self/mem").exists(), reason="needs /proc")
def test_a_file_that_cannot_be_read(cli: Run) -> None:
    code, out, err = cli("plan", "/proc/self/mem", "--start", "1,1", "--goal", "2,2")
    assert (code, out, err.count("\n")) == (2, "", 1)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may read and write everything")
def test_no_permission(cli: Run, wall: Path, tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o500)
    wall.chmod(0)
    assert cli("plan", wall, "--start", "1,1", "--goal", "2,2")[0] == 2
    assert cli("plan", "equiv20", "-o", closed / "plan.json")[0] == 2


def test_errors_say_what_helps(cli: Run, junk: Path) -> None:
    assert "did you mean equiv20?" in cli("plan", "equiv21")[2]
    assert "0 <= x < 20 m" in cli("plan", "equiv20", "--start", "99,99")[2]
    assert "smaller --robot-radius" in cli("plan", *BAD_PLANS["start inflated"])[2]
    assert ".json, .csv, .png, .svg, .pdf" in cli("plan", "equiv20", "-o", "plan.jpg")[2]
    assert "`antnav plan --help` explains" in cli("plan", "equiv20", "--fly")[2]
    assert "ROW,COL" in cli("plan", "equiv20", "--cells", "--start", "0.5,1")[2]
    assert "overwrite the map" in cli("plan", *BAD_PLANS["output is the map's image"])[2]


def test_a_file_named_like_a_built_in_map_can_be_read(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "equiv20").write_text("000\n000\n")
    _, out, _ = cli("plan", "./equiv20", "--cells", "--start", "0,0", "--goal", "1,2", "--json", *SMALL)
    assert json.loads(out)["problem"]["map"]["rows"] == 2


@pytest.mark.skipif(sys.platform != "linux", reason="file names are bytes only there")
def test_file_names_that_are_not_text(cli: Run, tmp_path: Path) -> None:
    name = os.fsdecode(b"\xff\x1b[31m.txt")
    (tmp_path / name).write_text("000\n000\n")
    code, out, err = cli(
        "plan", name, "--cells", "--start", "0,0", "--goal", "1,2", "--json", "-o", "plan.json", *SMALL
    )
    assert (code, err) == (0, "")
    assert json.loads(out)["status"] == "found"
    code, _, err = cli("plan", name, "--cells", "--start", "0,0", "--goal", "9,9")
    assert code == 2
    code, _, err = cli("plan", name[:-4] + ".yaml")
    assert (code, err.isascii(), "\x1b" in err) == (2, True, False)


def test_errors_of_our_own_are_one_line_with_exit_code_70(cli: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("first\nsecond")

    monkeypatch.setattr(query, "read_map", fail)
    code, out, err = cli("plan", "equiv20")
    assert (code, out, err.count("\n")) == (70, "", 1)
    assert "RuntimeError: first\\nsecond" in err
    monkeypatch.setenv("ANTNAV_DEBUG", "1")
    assert "Traceback" in cli("plan", "equiv20")[2]


def test_warnings_of_maps_are_lines(cli: Run, junk: Path) -> None:
    meta = "image: gray.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
    (junk / "gray.yaml").write_text(meta)
    (junk / "gray.pgm").write_bytes(b"P5\n3 2\n255\n" + bytes([205] * 6))
    code, _, err = cli("plan", "gray.yaml", "--cells", "--start", "0,0", "--goal", "1,2", *SMALL)
    assert code == 0
    assert err.startswith("antnav: warning: ")
    assert err.count("\n") == 1


# ---------------------------------------------------------------------------------------------------------- fuzzing

TEXT = st.text(st.characters(exclude_categories=()), max_size=20)
NUMBERS = st.one_of(st.floats().map(repr), st.integers(-30, 30).map(str))
POINTS = st.one_of(TEXT, st.tuples(NUMBERS, NUMBERS).map(",".join))
FLAGS = ("--cells", "--allow-unknown", "--check", "--json", "--quiet", "-q", "--invert")
VALUED = {
    "--start": POINTS,
    "--goal": POINTS,
    "--corner-rule": st.one_of(TEXT, st.sampled_from(["allow", "graze", "forbid"])),
    "--algorithm": st.one_of(TEXT, st.sampled_from(["traditional", "npaco", "paco", "paco_extended"])),
    "--heuristic": st.one_of(TEXT, st.sampled_from(["edge", "target", "geodesic"])),
    "--rules": st.one_of(TEXT, st.sampled_from(["nav2", "humble", "ros1"])),
    "--values": st.one_of(TEXT, st.sampled_from(["cells", "occupancy"])),
    "--axis": st.one_of(TEXT, st.sampled_from(["auto", "row", "column"])),
    "--robot-radius": st.one_of(TEXT, NUMBERS),
    "--goal-tolerance": st.one_of(TEXT, NUMBERS),
    "--time-limit": st.one_of(TEXT, NUMBERS),
    "--seed": st.one_of(TEXT, NUMBERS, st.integers().map(str)),
    "--ants": st.one_of(TEXT, st.integers(-2, 9).map(str)),
    "--iterations": st.one_of(TEXT, st.integers(-2, 9).map(str)),
    "--workers": st.one_of(TEXT, st.integers(-2, 3).map(str)),
    "-o": st.one_of(TEXT, TEXT.map(lambda text: text + ".csv"), TEXT.map(lambda text: text + ".json")),
}
OPTIONS = st.one_of(
    st.sampled_from(FLAGS).map(lambda flag: [flag]),
    st.sampled_from(sorted(VALUED)).flatmap(lambda name: VALUED[name].map(lambda value: [name, value])),
    st.sampled_from(sorted(VALUED)).flatmap(lambda name: VALUED[name].map(lambda value: [f"{name}={value}"])),
    TEXT.map(lambda text: [text]),
)


@pytest.fixture(scope="module")
def fuzz_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("fuzz")
    (folder / "wall.txt").write_text(WALL)
    with contextlib.chdir(folder):
        yield folder


def run_quietly(arguments: Sequence[str]) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(arguments)
    return code, out.getvalue(), err.getvalue()


def assert_well_behaved(arguments: Sequence[str]) -> None:
    code, out, err = run_quietly(arguments)
    assert code in {0, 1, 2}, (arguments, err)
    assert "Traceback" not in err
    errors = [line for line in err.splitlines() if not line.startswith("antnav: warning: ")]
    assert len(errors) == (code == 2), (arguments, err)
    assert not (code == 2 and out), (arguments, out)


@given(maps=st.sampled_from(["equiv20", "wall.txt"]), options=st.lists(OPTIONS, max_size=5))
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_fuzzed_plan(fuzz_folder: Path, maps: str, options: list[list[str]]) -> None:
    assert_well_behaved(
        ["plan", maps, "--ants", "2", "--iterations", "5", *(part for option in options for part in option)]
    )
    assert not [path for path in fuzz_folder.iterdir() if path.name.startswith(".") and "." in path.name[1:] and
                path.suffix not in {".csv", ".json"}]  # fmt: skip


@given(st.lists(st.one_of(TEXT, st.sampled_from([*" ".join(COMMANDS).split(), "equiv20", "-o", "--help"])), max_size=5))
@settings(max_examples=200, deadline=None)
def test_fuzzed_commands(fuzz_folder: Path, arguments: list[str]) -> None:
    assert_well_behaved(arguments)


@given(
    kind=st.one_of(TEXT, st.sampled_from(an.maps.generator_names())),
    size=st.tuples(st.integers(-1, 30), st.integers(-1, 30)),
    options=st.lists(
        st.one_of(TEXT, st.tuples(st.sampled_from(["density", "room", "door", "wall"]), NUMBERS).map("=".join))
    ),
)
@settings(max_examples=100, deadline=None)
def test_fuzzed_generate(fuzz_folder: Path, kind: str, size: tuple[int, int], options: list[str]) -> None:
    chosen = [part for option in options for part in ("--option", option)]
    assert_well_behaved(
        ["maps", "generate", kind, "--rows", str(size[0]), "--cols", str(size[1]), "-o", "fuzz.txt", *chosen]
    )


# ------------------------------------------------------------------------------------------------------- maps, etc.


def test_maps_list(cli: Run) -> None:
    code, out, err = cli("maps", "list")
    assert (code, err) == (0, "")
    for name in (*an.maps.builtin_names(), *an.maps.generator_names()):
        assert name in out


@pytest.mark.parametrize("name", ["equiv20", "equiv40", "warehouse"])
def test_maps_show(cli: Run, name: str) -> None:
    code, out, err = cli("maps", "show", name)
    assert (code, err) == (0, "")
    table, drawing = out.split("\n\n", 1)
    grid = an.maps.builtin(name)
    assert rows(table)["cells"].strip().startswith(f"{grid.rows} rows x {grid.cols} columns")
    assert drawing.count("S") == drawing.count("G") == 1
    assert max(map(len, drawing.splitlines())) <= terminal.PIPE_WIDTH


@pytest.mark.parametrize("ending", [".yaml", ".yml", ".map", ".txt", ".npy"])
def test_maps_generate_convert_and_show(cli: Run, tmp_path: Path, ending: str) -> None:
    code, out, err = cli("maps", "generate", "rooms", "--rows", 30, "--cols", 40, "--seed", 4, "-o", f"rooms{ending}")
    assert (code, err) == (0, "")
    grid = an.load_map(tmp_path / f"rooms{ending}")
    assert np.array_equal(grid.cells, an.maps.generate("rooms", 30, 40, seed=4).cells)
    hint = out.splitlines()[-1].removeprefix("try: antnav ").split()
    assert cli(*hint, "--check", *SMALL)[0] == 0
    assert cli("maps", "convert", f"rooms{ending}", "copy.yaml")[0] == 0
    assert np.array_equal(an.load_map(tmp_path / "copy.yaml").cells, grid.cells)
    assert cli("maps", "show", f"rooms{ending}")[0] == 0


@pytest.mark.parametrize("command", ["generate random --rows 9 --cols 9 -o x.yaml", "convert equiv20 x.yaml"])
def test_an_image_of_another_map_is_not_overwritten(cli: Run, tmp_path: Path, command: str) -> None:
    arguments = ("maps", *command.split())
    (tmp_path / "x.pgm").write_bytes(b"a picture of mine")
    code, out, err = cli(*arguments)
    assert (code, out) == (2, "")
    assert err.startswith("antnav: error: image x.pgm: it exists, and is not known to belong to x.yaml; choose another")
    assert (tmp_path / "x.pgm").read_bytes() == b"a picture of mine"
    (tmp_path / "x.pgm").unlink()
    assert cli(*arguments)[0] == 0
    assert cli(*arguments)[0] == 0  # its own
    (tmp_path / "x.yaml").write_text((tmp_path / "x.yaml").read_text().replace("x.pgm", "y.pgm"))
    with pytest.raises(OutputError, match=r"x\.pgm"):
        an.save_map(an.maps.builtin("equiv20"), "x.yaml")


def test_generator_options(cli: Run, tmp_path: Path) -> None:
    arguments = ("maps", "generate", "random", "--rows", 9, "--cols", 9, "-o", "open.txt", "--option", "density=0")
    assert cli(*arguments)[0] == 0
    assert an.load_map(tmp_path / "open.txt").counts()["occupied"] == 0
    code, _, err = cli("maps", "generate", "rooms", "-o", "rooms.txt", "--option", "doors=1")
    assert (code, "door=2" in err) == (2, True)


def test_convert_warns_of_what_is_lost(cli: Run) -> None:
    code, _, err = cli("maps", "convert", "warehouse", "warehouse.map")
    assert code == 0
    assert "neither resolution nor origin" in err
    assert all(line.startswith("antnav: warning: ") for line in err.splitlines())


@pytest.mark.parametrize(
    "arguments",
    [
        ["convert", "wall.txt", "wall.txt"],
        ["convert", "wall.pgm", "wall.yaml"],  # which would write wall.pgm beside it
        ["convert", "wall.txt", "wall.png"],
        ["convert", "wall.txt", "missing/wall.map"],
        ["convert", "missing.txt", "wall.map"],
        ["convert", "wall.txt"],
        ["generate", "castle", "-o", "new.txt"],
        ["generate", "rooms"],
        ["generate", "rooms", "-o", "new.pgm"],
        ["generate", "rooms", "--rows", "0", "-o", "new.txt"],
        ["generate", "rooms", "--rows", "100000", "--cols", "100000", "-o", "new.txt"],
        ["generate", "rooms", "--seed", "-1", "-o", "new.txt"],
        ["generate", "rooms", "--option", "door", "-o", "new.txt"],
        ["generate", "rooms", "--option", "door=wide", "-o", "new.txt"],
        ["generate", "rooms", "--option", "density=nan", "-o", "new.txt"],
        ["generate", "random", "--option", "density=nan", "-o", "new.txt"],
        ["show", "missing"],
        ["show", "."],
        ["sing"],
    ],
)
def test_bad_maps_commands(cli: Run, wall: Path, arguments: list[str]) -> None:
    wall.with_suffix(".pgm").write_bytes(b"P5\n2 1\n255\n\xfe\xfe")
    before = snapshot(wall.parent)
    code, out, err = cli("maps", *arguments)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert err.startswith("antnav: error: ")
    assert snapshot(wall.parent) == before


def test_mmas_is_listed_with_the_iterations_that_it_needs(cli: Run) -> None:
    _, out, _ = cli("algorithms", "--json")
    assert "50 iterations are too few" in json.loads(out)["mmas"]["summary"]


def test_algorithms(cli: Run) -> None:
    code, out, err = cli("algorithms")
    assert (code, err) == (0, "")
    code, document, err = cli("algorithms", "--json")
    assert (code, err) == (0, "")
    planners = json.loads(document)
    assert list(planners) == [*names(), *METHODS]
    for name, choices in planners.items():
        assert name in out
        known = METHODS[name]() if name in METHODS else an.algorithm(name)
        assert choices["certainty"] == str(known.certainty)
        assert choices["summary"]
    presets = {name: planners[name] for name in an.PRESETS}
    for choices in presets.values():
        assert {"heuristic", "pheromone", "deadlock", "ants", "rho"} <= set(choices)
    assert presets["traditional"]["decomposition"] is None
    assert presets["paco"]["decomposition"]["stage_one"] == 3


def test_one_algorithm_with_its_parts_and_ranges(cli: Run) -> None:
    code, out, err = cli("algorithms", "rank_as")
    assert (code, err) == (0, "")
    assert "pheromone rank_based: The best w - 1 by rank" in out
    (line,) = [line.split() for line in out.splitlines() if " elite " in line]
    assert line == ["pheromone", "rank_based", "elite", "w", "6", "1", "or", "more", "3", "to", "10", "source"]
    assert "best_every" not in out
    assert "by map size" in cli("algorithms", "paco")[1]
    ended = cli("algorithms", "two_ended")[1]
    assert "local_search taut: Merge; then the best goes straight between two of its cells" in ended
    assert "deposit forward: the one in which the ant went" in ended
    assert "deposit both" not in cli("algorithms", "npaco")[1]
    assert list(json.loads(cli("algorithms", "luo", "--json")[1])) == ["luo"]
    code, _, err = cli("algorithms", "nobody")
    assert code == 2
    assert "the planners are" in err


@pytest.mark.parametrize("name", ["astar", "dijkstra", "jps", "pso-exact", "woa-straight", "potential-field"])
def test_one_planner_without_ants(cli: Run, name: str) -> None:
    chosen = an.algorithm(name)
    code, out, err = cli("algorithms", name)
    assert (code, err) == (0, "")
    assert f"certainty: {chosen.certainty}\n" in out
    rows = [line.split() for line in out.splitlines()]
    if name in EXACT:
        assert "no parameters" in out
    else:
        for parameter, value in parameters(chosen).items():
            assert [parameter, f"{value:g}" if isinstance(value, float) else str(value)] in rows
    (document,) = json.loads(cli("algorithms", name, "--json")[1]).values()
    assert document == json.loads(json.dumps({"summary": document["summary"], **chosen.document()}))


@pytest.mark.parametrize("name", METHODS)
def test_one_method_of_fronts(cli: Run, name: str) -> None:
    method = METHODS[name]()
    code, out, err = cli("algorithms", name)
    assert (code, err) == (0, "")
    assert f"certainty: {method.certainty}\n" in out
    rows = [line.split() for line in out.splitlines()]
    for parameter, value in vars(method).items():
        assert [parameter, f"{value:g}" if isinstance(value, float) else str(value)] in rows
    assert json.loads(cli("algorithms", name, "--json")[1])[name].items() >= method.document().items()


def test_warmup_and_version(cli: Run) -> None:
    assert cli("warmup", "--all")[0] == 0
    code, out, _ = cli("warmup")
    assert code == 0
    assert out.startswith("kernels ready in ")
    assert cli("--version") == (0, f"antnav {an.__version__}\n", "")


@pytest.mark.parametrize(
    "arguments", [[], ["maps"], ["--help"], ["-h"], *([*name.split(), "--help"] for name in COMMANDS)]
)
def test_help(cli: Run, arguments: list[str]) -> None:
    code, out, err = cli(*arguments)
    assert (code, err) == (0, "")
    assert out.startswith("Usage: antnav")
    if arguments in (["--help"], ["plan", "--help"]):
        for line in ("0    done", "1    no path", "2    bad input", "130  interrupted"):
            assert line in out


def test_sketch_of_a_small_map_is_exact() -> None:
    cells = np.array([[0, 1, 2], [3, 0, 0]], np.uint8)
    assert sketch(an.GridMap(cells), 80, 24, {(1, 2): "G"}) == ["  ██░░", "▒▒  G "]
    assert sketch(an.GridMap(cells), 80, 24, unicode=False) == ["..##??", "++...."]
    assert framed(["ab"], unicode=False) == ["+--+", "|ab|", "+--+"]


def test_sketch_shows_halves() -> None:
    cells = np.array([[1, 0, 1, 0, 2], [0, 1, 1, 0, 1]], np.uint8)
    assert sketch(an.GridMap(cells), 5, 5) == ["▀▄█ ▄"]


@pytest.mark.parametrize("unicode", [True, False])
@pytest.mark.parametrize(("height", "width"), [(1, 1), (3, 7), (24, 80), (50, 10)])
@pytest.mark.parametrize("shape", [(1, 1), (7, 3), (401, 599), (3, 2000), (2000, 3)])
def test_sketch_fits(shape: tuple[int, int], height: int, width: int, unicode: bool) -> None:
    cells = np.random.default_rng(1).integers(0, 4, shape).astype(np.uint8)
    lines = sketch(an.GridMap(cells), width, height, {(shape[0] - 1, shape[1] - 1): "G"}, unicode=unicode)
    assert 1 <= len(lines) <= height
    assert {len(line) for line in lines} == {len(lines[0])}
    assert 1 <= len(lines[0]) <= width
    assert "G" in lines[-1][-2:]


def test_thin_walls_stay_and_specks_go() -> None:
    cells = np.zeros((200, 200), np.uint8)
    cells[:, 77] = 1
    cells[20, 150] = 1
    lines = sketch(an.GridMap(cells), 20, 10)
    assert {line.count("█") for line in lines} == {1}
    assert {line.index("█") for line in lines} == {7}


# ------------------------------------------------------------------------------------------- progress, compiling


class Terminal(io.StringIO):
    """A stderr that claims that a person looks at it."""

    encoding = "utf-8"

    def isatty(self) -> bool:
        return True


def test_progress_shows_length_and_gap(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(running, "PATIENCE", 0.0)
    monkeypatch.setenv("TERM", "xterm")
    watch = running.Watch("paco", None, quiet=False)
    watch.optimum = 100.0
    watch.hear(Iterated("stage one", 0, 1, 0.1, math.inf, None))
    watch.tick()
    watch.hear(Improved("stage two", 101.5))
    watch.tick()
    watch.close()
    shown = screen.getvalue()
    assert "stage one: no path yet" in shown
    assert "stage two: 101.50 cells, gap 1.50 %" in shown
    assert shown.count("\x1b[?25l") == shown.count("\x1b[?25h") == 1  # the cursor is hidden, and comes back
    watch.tick()
    assert screen.getvalue() == shown


@pytest.mark.parametrize("quiet", [True, False])
def test_no_progress_without_a_terminal_or_for_quick_runs(monkeypatch: pytest.MonkeyPatch, quiet: bool) -> None:
    stream = io.StringIO() if not quiet else Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(running, "PATIENCE", 0.0)
    watch = running.Watch("paco", None, quiet)
    watch.hear(Iterated("whole map", 0, 1, 0.5, 10.0, None))
    watch.tick()
    watch.close()
    assert stream.getvalue() == ""


def test_compiling_is_announced_where_nothing_is_kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def announced(quiet: bool = False, seconds: float = 0.1) -> str:
        with running.compilation_announced(quiet):
            time.sleep(seconds)
        return capsys.readouterr().err

    monkeypatch.setattr(running, "cache_folder", lambda: tmp_path)
    plain = "antnav: compiling the kernels (once per machine; `antnav warmup` does it ahead of time)...\n"
    monkeypatch.setattr(running, "COUNTING", 0.03)
    assert announced() == plain, "no figures where nobody looks"
    assert announced(quiet=True) == ""
    (tmp_path / "ant_kernels.advance-1.py311.1.nbc").touch()
    assert announced() == ""
    monkeypatch.setattr(running, "LONGEST_LOADING", 0.01)  # there, but of another version: compiling after all
    assert "compiling" in announced()
    monkeypatch.setattr(running, "cache_folder", lambda: None)
    assert "NUMBA_CACHE_DIR" in announced()


def test_seconds_of_compiling_are_counted_on_a_terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(running, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(running, "COUNTING", 0.03)
    with pytest.raises(KeyboardInterrupt), running.compilation_announced(quiet=False):
        time.sleep(0.2)
        raise KeyboardInterrupt
    line, counted = screen.getvalue().split("\n")
    assert line.endswith("...")
    assert counted.count("\r0 s") >= 2
    assert counted.endswith("\r\x1b[K"), "the figure is taken away"


# -------------------------------------------------------------------------------------------- processes and Ctrl-C


#: Hears SIGINT even where the test run, as a background job of a shell, does not.
ANTNAV = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
from antnav.cli import main, plan
sys.exit(main(sys.argv[1:]))
"""
#: The same with a search that does not listen.
ENDLESS = ANTNAV.replace(
    "sys.exit",
    """
import time
plan.solve = lambda *_, **__: (print("solving", flush=True), time.sleep(600))
sys.exit""",
)


def command(*arguments: object, program: str = ANTNAV) -> list[str]:
    return [sys.executable, "-c", program, *map(str, arguments)]


def read_until(descriptor: int, wanted: bytes, seconds: float = 60.0) -> bytes:
    """What arrives on a descriptor up to some text."""
    text, end = b"", time.monotonic() + seconds
    while wanted not in text:
        ready, _, _ = select.select([descriptor], [], [], max(0.0, end - time.monotonic()))
        assert ready, f"{wanted!r} did not come within {seconds} s; only {text!r}"
        try:
            chunk = os.read(descriptor, 4096)
        except OSError:  # the other side of a pseudo-terminal is gone
            chunk = b""
        assert chunk, f"{wanted!r} did not come; only {text!r}"
        text += chunk
    return text


@UNIX
@pytest.mark.parametrize("workers", [2, 1])
def test_ctrl_c_gives_the_best_so_far(tmp_path: Path, workers: int) -> None:
    screen, stderr = os.openpty()
    arguments = command(
        "plan", "warehouse", "--robot-radius", 0.25, "--iterations", 100_000, "-o", "best.json", "--workers", workers
    )
    process = subprocess.Popen(
        arguments, stdout=subprocess.PIPE, stderr=stderr, cwd=tmp_path, env={**os.environ, "TERM": "xterm"}
    )
    os.close(stderr)
    try:
        read_until(screen, b"gap ")  # the progress bar, once a path is known
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        shown = read_until(screen, b"(Ctrl-C again leaves at once)\r\n")
    finally:
        process.kill()
        os.close(screen)
    assert process.returncode == 130, shown
    assert "found (stopped: cancelled)" in out.decode()
    assert [path.name for path in tmp_path.iterdir()] == ["best.json"]
    result = an.Result.load(tmp_path / "best.json")
    assert result.path is not None
    assert result.iterations < 100_000
    an.check_path(result.path, result.problem)


@UNIX
def test_a_second_ctrl_c_leaves_at_once(tmp_path: Path) -> None:
    arguments = command("plan", "equiv20", "-o", "plan.json", program=ENDLESS)
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path)
    assert process.stdout and process.stderr
    try:
        read_until(process.stdout.fileno(), b"solving\n")
        process.send_signal(signal.SIGINT)
        read_until(process.stderr.fileno(), b"leaves at once")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
    finally:
        process.kill()
    assert (process.returncode, out) == (130, b"")
    assert err.strip() == b"antnav: interrupted"
    assert not list(tmp_path.iterdir())


def test_ctrl_c_outside_of_the_search(cli: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(query, "read_map", interrupt)
    assert cli("plan", "equiv20", "-o", "plan.json") == (130, "", "antnav: interrupted\n")


def test_the_handler_of_the_caller_comes_back(cli: Run) -> None:
    before = signal.getsignal(signal.SIGINT)
    cli("plan", "equiv20", *SMALL)
    assert signal.getsignal(signal.SIGINT) is before


def test_errors_of_the_search_come_through(cli: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr(plan, "solve", fail)
    code, out, err = cli("plan", "equiv20")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert "not enough memory" in err


@UNIX
@pytest.mark.parametrize(
    "arguments", [["plan", "equiv20", "--json", "-q", *SMALL], ["maps", "show", "warehouse"], ["--help"]]
)
def test_a_reader_that_leaves_is_no_error(arguments: list[str], tmp_path: Path) -> None:
    process = subprocess.Popen(command(*arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path)
    assert process.stdout
    process.stdout.close()
    assert process.stderr
    assert process.stderr.read() == b""
    assert process.wait(timeout=60) == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    "arguments", [["plan", "equiv20", "--json", "-q", *SMALL], ["--help"], ["algorithms", "--json"]]
)
def test_a_full_disk_behind_stdout(arguments: list[str]) -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(command(*arguments), stdout=full, stderr=subprocess.PIPE, check=False, timeout=60)
    assert done.returncode == 2
    assert done.stderr.decode() == ("antnav: error: standard output: no space is left; send it where there is room\n")


@UNIX
def test_closed_streams() -> None:
    shell = f"{sys.executable} -m antnav plan equiv20 --json --ants 5 --iterations 5"
    assert subprocess.run(f"{shell} >&-", shell=True, check=False, timeout=60).returncode == 0
    silent = subprocess.run(f"{shell} --fly 2>&-", shell=True, check=False, timeout=60, stdout=subprocess.PIPE)
    assert (silent.returncode, silent.stdout) == (2, b"")


def test_ascii_terminals(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    for arguments in (["algorithms"], ["maps", "list"], ["maps", "show", "warehouse"]):
        done = subprocess.run(command(*arguments), capture_output=True, env=environment, check=False, timeout=60)
        assert (done.returncode, done.stderr, done.stdout.isascii()) == (0, b"", True)
        assert b"\\u" not in done.stdout


@pytest.mark.parametrize(("module", "light"), [("antnav", ("typer", "rich")), ("antnav.cli", ())])
def test_imports_stay_light(module: str, light: tuple[str, ...]) -> None:
    absent = (*light, "matplotlib", "scipy.ndimage", "scipy.sparse", "PIL", "distributed", "dask")
    code = f"import sys, {module}; print([name for name in {absent} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "[]"


def test_resolution_is_given_to_maps_that_do_not_say_it(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "map.txt").write_text("0000\n0000\n")
    code, out, _ = cli(
        "plan", tmp_path / "map.txt", "--resolution", 0.5, "--start", "0.25,0.25", "--goal", "1.75,0.25", "--json"
    )
    assert code == 0
    assert json.loads(out)["length_m"] == 1.5
    code, _, err = cli("plan", tmp_path / "map.txt", "--resolution", 0, "--start", "0,0", "--goal", "1,0")
    assert (code, len(err.splitlines())) == (2, 1)


def test_the_hint_for_a_large_map_names_its_algorithm(cli: Run, tmp_path: Path) -> None:
    for side, large in ((20, False), (600, True)):
        code, out, _ = cli("maps", "generate", "caves", "--rows", str(side), "--cols", str(side), "-o", "caves.map")
        assert (code, "--algorithm paco_large" in out) == (0, large)
        words = out[out.index("try: antnav") :].split()[2:]
        assert cli(*words, "--quiet")[0] == 0


def test_films_of_ants_and_none_of_what_has_none(cli: Run) -> None:
    code, _, errors = cli(
        "plan", "equiv20", "--corner-rule", "allow", "--iterations", 4, "-o", "film.gif", "-o", "film.html"
    )
    assert (code, errors) == (0, "")
    assert Path("film.gif").read_bytes().startswith(b"GIF89a")
    assert "antnav-film" in Path("film.html").read_text()
    code, _, errors = cli("plan", "equiv20", "--algorithm", "astar", "-o", "other.gif")
    assert code == 2
    assert "films are of ants" in errors
    assert not Path("other.gif").exists()
