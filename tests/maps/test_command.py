"""What `antnav maps` and `antnav plan` are told about map files, and the options of the generators."""

import numpy as np
import pytest

from antnav import maps
from antnav.cli import main

from . import samples


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run a command line in an empty folder; exit code, stdout and stderr."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        code = main([str(one) for one in arguments])
        return code, *capsys.readouterr()

    return run


@pytest.mark.parametrize(
    "option, reason",
    [
        ("rows=5", "option 'rows' of u_traps: its options are traps=0, size=0"),
        ("cols=5", "option 'cols'"),
        ("seed=1", "option 'seed'"),
        ("kind=1", "option 'kind'"),
        ("=1", "option ''"),
        ("rng=1", "option 'rng'"),
        ("traps=1000000000", "traps is a whole number from 1 to 625"),
        ("traps=99999999999999999999", "traps is a whole number"),
        ("traps=" + "9" * 5000, "a name and a number"),
        ("size=99999999999999999999", "size is a whole number"),
    ],
)
def test_wrong_options_of_a_generator(run, tmp_path, option, reason):
    code, out, err = run("maps", "generate", "u_traps", "--option", option, "-o", "new.txt")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert reason in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", maps.generator_names())
def test_no_option_is_too_large_to_be_refused(run, tmp_path, kind):
    for name in ("block", "room", "door", "passage", "wall", "steps", "traps", "size", "aisle"):
        code, _, err = run("maps", "generate", kind, "--option", f"{name}={10**20}", "-o", "new.txt")
        assert (code, err.count("\n")) == (2, 1)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("options", ["traps = 1000000000", "size = 99999999999999999999", "colour = 1", "seed = -1"])
def test_wrong_options_of_a_generator_in_a_study(run, tmp_path, options):
    (tmp_path / "study.toml").write_text(
        'title = "a"\nseeds = 2\n[[algorithms]]\npreset = "npaco"\n'
        f'[[maps]]\ngenerate = {{kind = "u_traps", rows = 9, cols = 9, {options}}}\n'
    )
    code, _, err = run("study", "study.toml", "-o", "out")
    assert (code, err.count("\n")) == (2, 1)
    assert options.split()[0] in err


def show(run, *arguments):
    """Kinds of cells that `maps show` counts."""
    code, out, err = run("maps", "show", *arguments)
    assert code == 0, err
    rows = (line.split(None, 2) for line in out.splitlines() if " cells, " in line)
    return {kind: int(count) for kind, count, _ in rows}


def test_rules(run, tmp_path):
    colours = np.array([[[0, 255, 0], [255, 255, 0], [255, 255, 255]]], np.uint8)
    (tmp_path / "a.png").write_bytes(samples.encode(colours, "PNG"))
    assert show(run, "a.png") == {"free": 2, "occupied": 0, "unknown": 1}  # green 149, yellow 225
    assert show(run, "a.png", "--rules", "humble") == {"free": 1, "occupied": 1, "unknown": 1}
    assert show(run, "a.png", "--rules", "ros1") == {"free": 1, "occupied": 1, "unknown": 1}


def test_values_and_invert(run, tmp_path):
    (tmp_path / "a.csv").write_text("0,100\n-1,0\n")
    code, _, err = run("maps", "show", "a.csv")
    assert (code, err.count("\n")) == (2, 1)
    assert "line 1, column 3" in err
    assert "--values occupancy" in err
    assert show(run, "a.csv", "--values", "occupancy") == {"free": 2, "occupied": 1, "unknown": 1}
    assert show(run, "a.csv", "--values", "occupancy", "--invert") == {"free": 1, "occupied": 2, "unknown": 1}
    assert run("maps", "convert", "a.csv", "b.npy", "--values", "occupancy")[0] == 0
    assert np.load("b.npy").tolist() == [[0, 1], [2, 0]]
    (tmp_path / "c.txt").write_text("111\n")
    query = ("--cells", "--start", "0,0", "--goal", "0,2", "--quiet", "--ants", "2", "--iterations", "5")
    assert run("plan", "c.txt", *query)[0] == 2
    code, _, err = run("plan", "c.txt", "--invert", *query)
    assert (code, err) == (0, "")


@pytest.mark.parametrize("options", [["--rules", "ros2"], ["--values", "costs"], ["--rules", ""]])
def test_wrong_choices(run, tmp_path, options):
    (tmp_path / "c.txt").write_text("000\n")
    code, _, err = run("maps", "show", "c.txt", *options)
    assert (code, err.count("\n")) == (2, 1)


@pytest.mark.parametrize("options", [["--rules", "ros1"], ["--values", "occupancy"], ["--invert"]])
def test_options_of_files_are_of_no_use_for_a_built_in_map(run, options):
    code, _, err = run("maps", "show", "equiv20", *options)
    assert (code, err.count("\n")) == (2, 1)
    assert "leave them out" in err
