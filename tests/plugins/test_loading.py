"""Files and packages of users: loaded once, whatever the working directory, and errors that say where."""

from __future__ import annotations

import importlib
import json
import sys
from pathlib import Path

import numba
import pytest

from antnav.errors import ParameterError
from antnav.plugins import loading
from antnav.plugins.loading import beside, divided, load, said_by_compiler, sought


def test_a_file_is_executed_once_and_again_after_a_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "counted.py"
    file.write_text(
        "import builtins\nbuiltins.counted = getattr(builtins, 'counted', 0) + 1\ncount = builtins.counted\n"
    )
    first = load(file)
    monkeypatch.chdir(tmp_path)
    assert load("counted.py") is first
    assert load("./counted.py") is first
    assert sys.modules[first.__name__] is first
    file.write_text(file.read_text() + "# edited\n")
    assert load(file).count == first.count + 1
    assert load(file).__name__ == first.__name__


def test_files_of_one_name_are_modules_of_their_own(tmp_path: Path) -> None:
    made = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "json.py").write_text(f"where = {folder!r}\n")
        made.append(load(tmp_path / folder / "json.py"))
    assert [module.where for module in made] == ["a", "b"]
    assert not hasattr(sys.modules["json"], "where")


def test_files_may_load_each_other(tmp_path: Path) -> None:
    for one, other in (("a", "b"), ("b", "a")):
        file = f"{tmp_path / other}.py"
        (tmp_path / f"{one}.py").write_text(f"from antnav.plugins.loading import load\nother = load({file!r})\n")
    first = load(tmp_path / "a.py")
    assert first.other.other is first


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = 1\n1 / 0\n", "plugin bad.py, line 2: it raised ZeroDivisionError: division by zero; mend it"),
        ("def f(:\n", "plugin bad.py, line 1: it raised SyntaxError: "),
        (
            "\n\nimport nowhere_at_all\n",
            "bad.py, line 3: it raised ModuleNotFoundError: No module named 'nowhere_at_all'",
        ),
        ("raise SystemExit(2)\n", "bad.py, line 1: it raised SystemExit: 2"),
        ("def f():\n    raise KeyError\n\nf()\n", "bad.py, line 2: it raised KeyError"),
        ("import antnav as an\n\nan.npaco(rho=2)\n", "bad.py, line 3, rho 2: rho lies in 0..1"),
        ("\0", "bad.py.* it raised "),
    ],
)
def test_what_a_file_raises_is_told_with_its_line(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "bad.py"
    file.write_text(text)
    modules = set(sys.modules)
    with pytest.raises(ParameterError, match=words):
        load(file)
    assert not [name for name in set(sys.modules) - modules if "plugin_bad" in name]
    file.write_text("fine = True\n")
    assert load(file).fine


def test_a_file_that_is_none(tmp_path: Path) -> None:
    for missing in ("no.py", tmp_path, "a\0b"):
        with pytest.raises(ParameterError, match="name a Python file that can be read"):
            load(missing)


def test_names_with_their_files() -> None:
    assert divided("share") == ("", "share")
    assert divided("mine.py:share") == ("mine.py", "share")
    assert divided("C:/my files/mine.py:share") == ("C:/my files/mine.py", "share")
    assert divided("risk:clearance:0.5") == ("", "risk:clearance:0.5")
    assert divided("mine.py:") == ("", "mine.py:")
    assert beside("share", "folder") == "share"
    assert beside("../mine.py:share", "folder") == str(Path("folder/../mine.py")) + ":share"
    assert beside("/abs/mine.py:share", "folder") == "/abs/mine.py:share"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("y = 1\n    return x.nothing", "rules.py, line 3: Unknown attribute 'nothing' of type float64"),
        ("return helper(x)", "rules.py, line 2: Untyped global name 'helper': Cannot determine Numba type of <class "),
        ("import os\n    return os", "rules.py, line 2: Use of unsupported opcode (IMPORT_NAME) found"),
        ("return nowhere", "rules.py: NameError: name 'nowhere' is not defined"),
        ("return x + 's'", "rules.py, line 2: No implementation of function Function(<built-in function add>)"),
    ],
)
def test_what_numba_says_in_one_sentence(tmp_path: Path, body: str, words: str) -> None:
    file = tmp_path / "rules.py"
    file.write_text(f"def rule(x):\n    {body}\n\ndef helper(x):\n    pass\n")
    rule = load(file).rule
    with pytest.raises(Exception, match=r".") as caught:
        numba.njit("float64(float64)")(rule)
    told = said_by_compiler(caught.value, rule)
    assert told.startswith(words)
    assert told == said_by_compiler(caught.value, numba.njit(rule))
    assert "\n" not in told
    assert str(tmp_path) not in told


DISTRIBUTION = {
    "swarmlib.py": '''
import antnav as an

@an.register.heuristic
def swarm(ground):
    """All alike."""
    return [1.0] * len(ground)

@an.register.algorithm
def swarming(**choices):
    """npaco by `swarm`."""
    return an.npaco(heuristic=swarm, **choices)
''',
    "broken_swarm.py": "raise RuntimeError('out of order')\n",
    "leaving_swarm.py": "raise SystemExit(4)\n",
    "swarmlib-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: swarmlib\nVersion: 1.0\n",
    "swarmlib-1.0.dist-info/entry_points.txt": """[antnav.parts]
swarm = swarmlib:swarm
broken = broken_swarm:broken
leaving = leaving_swarm
[antnav.algorithms]
swarming = swarmlib:swarming
""",
}


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in DISTRIBUTION.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("swarmlib", "broken_swarm"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    return tmp_path


def test_an_installed_package_announces_rules_and_algorithms(installed: Path) -> None:
    import antnav as an

    assert "swarmlib" not in sys.modules
    assert str(an.npaco(heuristic="swarm").heuristic) == "swarm"
    assert an.algorithm("swarming", ants=7).ants == 7
    with pytest.raises(ParameterError, match=r"entry point broken_swarm:broken: it raised RuntimeError: out of order"):
        an.npaco(heuristic="broken")
    with pytest.raises(ParameterError, match=r"entry point leaving_swarm: it raised SystemExit: 4"):
        an.npaco(heuristic="leaving")
    with pytest.raises(ParameterError, match=r"it is one of auto, .*, swarm; choose swarm or astar, or load the file"):
        an.npaco(heuristic="swarn")


def test_installed_rules_are_listed(
    installed: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from antnav.cli import main

    assert main(["algorithms", "--json"]) == 0
    out, err = capsys.readouterr()
    listed = json.loads(out)
    assert listed["swarm"]["own"]["file"] == "swarmlib.py"
    assert listed["swarming"]["summary"] == "npaco by `swarm`."
    assert "warning: broken, entry point broken_swarm:broken: it raised RuntimeError" in err
    assert main(["algorithms", "swarm"]) == 0
    assert "your own heuristic rule: swarm (swarmlib.py)" in capsys.readouterr().out


def test_an_installed_rule_is_found_by_its_name_alone(installed: Path) -> None:
    from antnav.conformance.subject import subjects_of

    assert [(one.kind, one.name) for one in subjects_of("swarm")] == [("heuristic", "swarm")]
    assert [(one.kind, one.name) for one in subjects_of("swarming")] == [("algorithm", "swarming")]
    with pytest.raises(ParameterError, match="rules of 'swarms': it is neither a file nor a name that is registered"):
        subjects_of("swarms")


def test_what_is_installed_is_told_by_its_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import antnav as an

    folder = tmp_path / "site-packages" / "sweets"
    folder.mkdir(parents=True)
    (folder / "__init__.py").touch()
    (folder / "rules.py").write_text(DISTRIBUTION["swarmlib.py"])
    monkeypatch.syspath_prepend(folder.parent)
    rules = importlib.import_module("sweets.rules")
    assert "own rule swarm (sweets: rules.py)" in str(an.npaco(heuristic=rules.swarm).certainty)
    assert str(tmp_path) not in str(an.npaco(heuristic=rules.swarm).document())


def test_packages_are_asked_for_unknown_names_only(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(loading, "_from_package", lambda name, group: asked.append((name, group)))
    assert sought("known", {"known": 1}.get, "antnav.parts") == 1
    assert asked == []
    assert sought("other", {"known": 1}.get, "antnav.parts") is None
    assert asked == [("other", "antnav.parts")]
