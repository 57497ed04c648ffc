"""`import antnav` stays light: what is heavy is imported where it is used."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import antnav as an

HEAVY = ("matplotlib", "PIL", "rich", "typer", "scipy.ndimage", "scipy.stats", "distributed", "asyncio")
HEAVY += (
    "antnav.costs",
    "antnav.fronts",
    "antnav.maps",
    "antnav.plot",
    "antnav.scenarios",
    "concurrent.futures.process",
)


def test_import_brings_nothing_heavy_and_compiles_nothing() -> None:
    script = (
        "import sys, antnav\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules])\n"
        "from antnav.kernels import ant_kernels, grid_kernels\n"
        "print([kernel.signatures for kernel in (ant_kernels.advance, grid_kernels.search)])\n"
        "print(sorted(name for name in antnav.__all__ if not hasattr(antnav, name)))"
    )
    lines = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout.split(
        "\n"
    )
    assert lines[:3] == ["[]", "[[], []]", "[]"]


def test_what_is_imported_later_is_listed_and_is_the_same_thing() -> None:
    assert {*an.__all__, "__version__", "plot"} <= {*dir(an)}
    assert an.load_map is an.maps.load_map
    assert an.plot_result is an.plot.plot_result
    with pytest.raises(AttributeError, match="'antnav' has no attribute 'nothing'"):
        _ = an.nothing


@pytest.mark.slow
def test_a_command_imports_its_own_module_and_no_other(tmp_path: Path) -> None:
    script = (
        "import sys; from antnav import cli; code = cli.main(sys.argv[1:])\n"
        "print(code, sorted(name for name in cli.COMMANDS if f'antnav.cli.{name}' in sys.modules), file=sys.stderr)"
    )
    for arguments, loaded in (
        (["--version"], "0 []"),
        (["--help"], "0 []"),
        (["-h", "plan"], "0 ['plan']"),
        (["algorithms", "--help"], "0 ['algorithms']"),
        (["reproduce", "--help"], "0 ['study']"),
        (["plann"], "2 []"),
    ):
        ended = subprocess.run(
            [sys.executable, "-c", script, *arguments], check=True, capture_output=True, text=True, cwd=tmp_path
        )
        assert ended.stderr.splitlines()[-1] == loaded, arguments


def test_the_version_is_told_without_the_package() -> None:
    script = (
        "import sys, antnav_command; sys.argv = ['antnav', '--version']; code = antnav_command.main()\n"
        "print(code, [name for name in ('antnav', 'numba', 'numpy', 'typer') if name in sys.modules])"
    )
    ended = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert ended.stdout == f"antnav {an.__version__}\n0 []\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_version_that_cannot_be_printed_is_an_error() -> None:
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            [sys.executable, "-m", "antnav", "--version"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1)
