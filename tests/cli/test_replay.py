"""`antnav replay`: the table, files, saved scenarios, exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import antnav as an
from antnav.live.methods import METHODS
from antnav.scenarios.comparison import HEADS
from antnav.scenarios.replay import prepare
from tests.cli.conftest import Run

ENDS = ("--cells", "--start", "2,0", "--goal", "2,19")


@pytest.fixture
def hall(tmp_path: Path) -> str:
    path = tmp_path / "hall.txt"
    path.write_text(("0" * 20 + "\n") * 2 + "0" * 9 + "11" + "0" * 9 + "\n" + ("0" * 20 + "\n") * 2)
    return str(path)


@pytest.fixture(scope="module", autouse=True)
def _compiled() -> None:
    """What compiles is told, which these tests do not want to hear."""
    for name in METHODS:
        prepare(name)


def test_a_row_for_each_replanner(cli: Run, hall: str) -> None:
    choices = ("--scenario", "people:3+obstacles:4:1", "--seed", "2", "--algorithm", "regions,astar", "--check")
    code, out, err = cli("replay", hall, *ENDS, *choices)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    table = [line.split() for line in lines if line.split() and line.split()[0] in ("regions", "astar")]
    assert [row[0] for row in table] == ["regions", "astar"]
    assert [len(row) for row in table] == [len(HEADS)] * 2
    assert [row[-1] for row in table] == ["0", "0"]
    assert table[1][HEADS.index("way / astar")] == "1.0000"


def test_side_by_side_they_are_the_same(cli: Run, hall: str) -> None:
    choices = ("--scenario", "people:3", "--seed", "2", "--algorithm", "regions,astar,lpa_star", "-q")
    files = []
    for workers in ("1", "2"):
        assert cli("replay", hall, *ENDS, *choices, "--workers", workers, "-o", f"{workers}.csv") == (0, "", "")
        lines = Path(f"{workers}.csv").read_text().splitlines()
        files.append([line.rsplit(",", 2)[0] for line in lines])
    assert files[0] == files[1]


def test_a_saved_scenario_is_the_same_again(cli: Run, hall: str) -> None:
    ticks = ("-o", "one.csv", "--save-scenario", "drawn.json", "--algorithm", "astar", "-q")
    drawn = cli(
        "replay", hall, *ENDS, "--scenario", "obstacles:2:1+people:2", "--robot-radius", "0.4", "--speed", "2", *ticks
    )
    assert drawn == (0, "", "")
    again = cli("replay", hall, "--scenario", "drawn.json", "-o", "two.csv", "-o", "again.json", "--algorithm", "astar")
    assert again[1].splitlines()[-2:] == ["saved two.csv", "saved again.json"]
    assert Path("drawn.json").read_bytes() == Path("again.json").read_bytes()
    one, two = (
        [line.rsplit(",", 2)[0] for line in Path(name).read_text().splitlines()] for name in ("one.csv", "two.csv")
    )
    assert one == two
    scenario = an.Scenario.load("drawn.json")
    assert (scenario.name, scenario.radius, scenario.speed) == ("obstacles:2:1+people:2", 0.4, 2)


def test_json_and_a_robot_that_does_not_arrive(cli: Run, hall: str) -> None:
    code, out, err = cli(
        "replay", hall, *ENDS, "--scenario", "unknown:3", "--ticks", "9", "--algorithm", "astar", "--json"
    )
    assert "astar did not arrive: the scenario ended before; give more --ticks" in err
    (told,) = json.loads(out)
    assert code == 1
    assert (told["arrived"], told["ticks"], told["detour"], told["failures"]) == (False, 9, None, None)
    assert told["travelled"] > 8


def test_costs_at_rest_go_along(cli: Run, hall: str) -> None:
    code, _, err = cli(
        "replay",
        hall,
        *ENDS,
        "--scenario",
        "people:2",
        "--cost",
        "clearance:3",
        "--save-scenario",
        "s.json",
        "-q",
        "--check",
    )
    assert (code, err) == (0, "")
    assert an.Scenario.load("s.json").problem().cost is not None
    assert cli("replay", hall, "--scenario", "s.json", "-q", "--check")[0] == 0
    for option in (
        ("--seed", "5"),
        ("--speed", "2"),
        ("--corner-rule", "allow"),
        ("--ticks", "9"),
        ("--robot-radius", "0.3"),
        ("--start", "1,1"),
    ):
        code, _, err = cli("replay", hall, "--scenario", "s.json", *option)
        assert (code, f"{option[0]}: a saved scenario has its own" in err) == (2, True)


def test_tolerances_are_for_the_robots_radius(cli: Run, hall: str) -> None:
    given = ("--cells", "--start", "2,8", "--goal", "2,19", "--robot-radius", "1", "--scenario", "people:0", "-q")
    assert cli("replay", hall, *given)[0] == 2
    assert cli("replay", hall, *given, "--start-tolerance", "2", "--save-scenario", "s.json")[0] == 0
    assert an.Scenario.load("s.json").problem().start_cell == (1, 8)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ((*ENDS, "--scenario", "crowd:3"), "--scenario 'crowd:3': it is doors:K"),
        ((*ENDS, "--scenario", "doors:9"), "ask for fewer"),
        ((*ENDS, "--algorithm", "ants"), "--algorithm 'ants': the replanners are"),
        ((*ENDS, "--ticks", "0"), "--ticks 0"),
        ((*ENDS, "--speed", "0"), "--speed 0"),
        ((*ENDS, "--improve", "-1"), "--improve -1"),
        ((*ENDS, "--seed", "-1"), "--seed -1"),
        ((*ENDS, "-o", "film.mp4"), "its ending must be one of"),
        ((*ENDS, "--save-scenario", "s.csv"), "its ending must be one of .json"),
        (("--scenario", "none.json"), "No such file"),
        ((*ENDS, "--scenario", "none.json"), "No such file"),
        ((), "no --start"),
    ],
)
def test_bad_input(cli: Run, hall: str, options: tuple[str, ...], told: str) -> None:
    code, out, err = cli("replay", hall, *options)
    assert (code, out) == (2, "")
    assert told in err


def test_another_map_than_the_scenarios_is_refused(cli: Run, hall: str) -> None:
    for cost in ((), ("--cost", "clearance:3")):
        assert cli("replay", hall, *ENDS, *cost, "--scenario", "people:2", "--save-scenario", "s.json", "-q")[0] == 0
        code, _, err = cli("replay", "equiv20", "--scenario", "s.json")
        assert code == 2
        assert "the scenario is of map 'hall'" in err


def test_films_and_pictures(cli: Run, hall: str) -> None:
    names = [f"film.{ending}" for ending in ("html", "gif", "png")]
    outputs = [part for name in names for part in ("-o", name)]
    code, out, err = cli(
        "replay", hall, *ENDS, "--scenario", "people:3", "--algorithm", "astar,lpa_star", "--seed", "2", *outputs
    )
    assert (code, err) == (0, "")
    assert out.splitlines()[-3:] == [f"saved {name}" for name in names]
    text = Path("film.html").read_text()
    assert json.loads(text.split('id="film">')[1].split("</script>")[0])["drives"][1]["name"] == "lpa_star"
    assert Path("film.gif").read_bytes()[:6] == b"GIF89a"
    assert Path("film.png").read_bytes()[1:4] == b"PNG"


def test_ctrl_c_inside_a_kernel_is_ctrl_c(cli: Run, hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The interpreter makes a SystemError of an exception that compiled code leaves behind."""

    def interrupted(*_: object, **__: object) -> None:
        raise SystemError("CPUDispatcher(search) returned a result with an exception set") from KeyboardInterrupt()

    monkeypatch.setattr("antnav.cli.replay.named", interrupted)
    code, _, err = cli("replay", hall, *ENDS)
    assert (code, err.splitlines()[-1]) == (130, "antnav: interrupted")
