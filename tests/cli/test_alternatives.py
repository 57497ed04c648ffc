"""`antnav plan --alternatives`: exit codes, the table, JSON and files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import antnav as an
from tests.cli.conftest import Run

MAP = "..........\n....##....\n....##....\n..........\n..........\n"
ENDS = ("--cells", "--start", "2,0", "--goal", "2,9")


@pytest.fixture
def block(tmp_path: Path) -> str:
    path = tmp_path / "block.txt"
    path.write_text(MAP.replace(".", "0").replace("#", "1"))
    return str(path)


def test_routes_are_told(cli: Run, block: str) -> None:
    code, out, err = cli("plan", block, *ENDS, "--alternatives", "2", "--check")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].split() == ["status", "found,", "2", "of", "2", "routes"]
    assert [line.split("  ")[0] for line in lines] == [
        *("status", "route 1", "route 2", "asked", "seconds", "method", "checked"),
    ]


def test_fewer_routes_are_no_failure_and_said(cli: Run, block: str) -> None:
    code, out, _ = cli("plan", block, *ENDS, "--alternatives", "4")
    assert code == 0
    assert "found, 2 of 4 routes" in out
    assert "2 of 4 routes: no other side has one that is cheap enough" in out


def test_json_and_files(cli: Run, block: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    files = [str(tmp_path / "routes.json"), str(tmp_path / "routes.png")]
    options = ("--alternatives", "2", "--least-difference", "0.4", "--longest", "1.2", "--json")
    code, out, _ = cli("plan", block, *ENDS, *options, "-o", files[0], "-o", files[1])
    told = json.loads(out)
    assert code == 0
    assert (told["least_difference"], told["longest"], told["checked"], told["robot_radius"]) == (0.4, 1.2, False, 0)
    found = an.Alternatives.load(files[0])
    assert [route["cost"] for route in told["routes"]] == [route.cost for route in found]
    assert Path(files[1]).stat().st_size > 1000


def test_with_ants(cli: Run, block: str) -> None:
    options = ("--alternatives", "2", "--algorithm", "npaco", "--ants", "9", "--iterations", "9", "--seed", "3")
    runs = [cli("plan", block, *ENDS, *options, "--json", "--workers", str(n)) for n in (1, 2)]
    told = [json.loads(out) for _, out, _ in runs]
    assert told[0]["algorithm"]["name"] == "npaco"
    assert told[0]["routes"] == told[1]["routes"]
    assert len(told[0]["routes"]) == 2
    named = cli("plan", block, *ENDS, "--alternatives", "2", "--ants", "9", "--iterations", "9", "--json")
    assert json.loads(named[1])["algorithm"]["name"] == "paco"


def test_no_way(cli: Run, tmp_path: Path) -> None:
    path = tmp_path / "wall.txt"
    path.write_text("00100\n00100\n")
    code, out, _ = cli("plan", str(path), "--cells", "--start", "0,0", "--goal", "0,4", "--alternatives", "3")
    assert code == 1
    assert "unreachable, 0 of 3 routes" in out
    assert "no path exists from start to goal" in out


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--alternatives", "0"), "--alternatives 0: it is a whole number from 1 to 100"),
        (("--alternatives", "2", "--longest", "0.5"), "--longest 0.5: it is a number from 1"),
        (("--alternatives", "2", "--least-difference", "2"), "--least-difference 2.0: it is a number from 0 to 1"),
        (("--alternatives", "2", "-o", "routes.csv"), "its ending must be one of .json"),
    ],
)
def test_bad_input(cli: Run, block: str, options: tuple[str, ...], told: str) -> None:
    code, out, err = cli("plan", block, *ENDS, *options)
    assert (code, out) == (2, "")
    assert told in err
