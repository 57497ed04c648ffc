"""`antnav check` and `antnav new`: exit codes, tables, JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run

BAD = '''
import antnav as an


@an.register.initial
def bare(ground):
    return 1.0


@an.register.initial
def dressed(ground):
    """The same everywhere."""
    return 1.0
'''


def test_new_then_check(cli: Run, tmp_path: Path) -> None:
    code, out, err = cli("new", "rule", "elite_share", "--kind", "initial")
    assert (code, err) == (0, "")
    assert [line.split()[0] for line in out.splitlines()] == ["change", "check", "use"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["elite_share.py", "test_elite_share.py"]
    code, out, err = cli("check", "elite_share.py", "--quick")
    assert (code, err) == (0, "")
    assert "initial elite_share   legal paths" in out
    assert out.splitlines()[-1] == "12 checks: 8 passed, 0 failed, 4 skipped"
    code, out, err = cli("new", "rule", "elite_share", "--kind", "initial")
    assert (code, out) == (2, "")
    assert err == "antnav: error: file elite_share.py: it is there already; choose another name or folder\n"


@pytest.mark.parametrize("arguments", [("algorithm", "mine"), ("planner", "mine"), ("rule", "mine", "--jit")])
def test_new_files_elsewhere(cli: Run, tmp_path: Path, arguments: tuple[str, ...]) -> None:
    code, out, _ = cli("new", *arguments, "-o", "there")
    assert code == 0
    assert "antnav check there/mine.py, and pytest there/test_mine.py" in out
    assert (tmp_path / "there" / "test_mine.py").is_file()


def test_a_check_that_fails_and_json(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "bad.py").write_text(BAD)
    code, out, err = cli("check", "bad.py", "bare", "--quick", "--json")
    assert (code, err) == (1, "")
    document = json.loads(out)
    assert document["passed"] is False
    assert {one["name"] for one in document["findings"]} == {"bare"}
    assert [one["check"] for one in document["findings"] if one["verdict"] == "failed"] == ["documented"]
    assert cli("check", "bad.py", "dressed", "--quick", "-q") == (0, "", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("check", "none.py"), "plugin none.py: No such file"),
        (("check", "bad.py", "naked"), "rule 'naked': there are bare, dressed"),
        (("check", "bad.py", "--time-limit", "0"), "--time-limit 0.0: it is a number of seconds above 0"),
        (("check", "empty.py"), "it registers nothing"),
        (("check", "nobody"), "rules of 'nobody': it is neither a file nor a name that is registered"),
        (("check",), "Missing argument 'FILE'"),
        (("new", "rule", "Odd"), "small letters"),
        (("new", "rule", "odd", "--kind", "wing"), "the kinds are heuristic"),
        (("new", "rule", "odd", "--kind", "initial", "--jit"), "can be compiled"),
        (("new", "algorithm", "paco"), "of that name"),
        (("new", "sauce", "odd"), "No such command"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    cli: Run, tmp_path: Path, arguments: tuple[str, ...], words: str
) -> None:
    (tmp_path / "bad.py").write_text(BAD)
    (tmp_path / "empty.py").write_text("")
    code, out, err = cli(*arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert words in err
