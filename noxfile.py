"""Every chore by name: `nox -l` lists them. Sessions use the environment that nox itself runs in."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import nox

nox.options.default_venv_backend = "none"
nox.options.sessions = ["lint", "types", "contracts", "tests"]


@nox.session
def tests(session: nox.Session) -> None:
    """All tests; further arguments go to pytest."""
    session.run("pytest", *session.posargs)


@nox.session
def lint(session: nox.Session) -> None:
    """Style and format."""
    session.run("ruff", "check", ".")
    session.run("ruff", "format", "--check", ".")


@nox.session
def docs(session: nox.Session) -> None:
    """The documentation site, into docs/_build/html; warnings and links that lead nowhere are errors."""
    site = "docs/_build/html"
    shutil.rmtree(site, ignore_errors=True)
    session.run(
        sys.executable, "-m", "sphinx", "--fresh-env", "--fail-on-warning", "--keep-going", "--quiet", "docs", site
    )
    session.run(sys.executable, "docs/check_site.py", site)


@nox.session
def pictures(session: nox.Session) -> None:
    """The pictures of the rules, which are kept in docs/images/rules."""
    session.run(sys.executable, "docs/rules.py")


@nox.session(name="format")
def reformat(session: nox.Session) -> None:
    """Mend style and format where a program can."""
    session.run("ruff", "check", "--fix", ".")
    session.run("ruff", "format", ".")


@nox.session
def types(session: nox.Session) -> None:
    """Types."""
    session.run("mypy")


@nox.session
def contracts(session: nox.Session) -> None:
    """Who may import whom."""
    session.run("lint-imports")


@nox.session
def uncompiled(session: nox.Session) -> None:
    """The kernels as plain Python: what a debugger steps through."""
    session.run("pytest", "-n", "0", "tests/kernels/test_uncompiled.py", env={"NUMBA_DISABLE_JIT": "1"})


@nox.session
def walk(session: nox.Session) -> None:
    """The ants' walk against its twin in C: the same paths to the last cell."""
    session.run("python", "benchmarks/bench_walk.py", "--rounds", "3")


@nox.session
def notebooks(session: nox.Session) -> None:
    """Run the notebooks, or those that are named, and renew the outputs that they keep."""
    session.run("python", "-m", "tests.examples.notebooks", *session.posargs)


#: Versions that must work; those that a machine lacks are skipped.
PYTHONS = ("3.11", "3.12", "3.13")


@nox.session(python=PYTHONS, venv_backend="venv")
def supported(session: nox.Session) -> None:
    """All tests on each supported Python, in environments of their own."""
    session.install("-c", "constraints.txt", "-e", ".[dev]")
    session.run("pytest", *session.posargs)


@nox.session(python=PYTHONS[0], venv_backend="venv")
def lowest(session: nox.Session) -> None:
    """The quick tests with the lowest versions that pyproject.toml allows."""
    project = nox.project.load_toml("pyproject.toml")["project"]
    lowest = [requirement.replace(">=", "==") for requirement in project["dependencies"]]
    session.install("-e", ".[dev]", *lowest)
    session.run("pytest", "-m", "not slow", *session.posargs)


@nox.session
def constraints(session: nox.Session) -> None:
    """Renew constraints.txt: the newest versions that work together, from a fresh environment."""
    folder = session.create_tmp()
    session.run("python", "-m", "venv", "--clear", folder)
    session.run(f"{folder}/bin/pip", "install", "--quiet", ".[dev]", external=True)
    frozen = session.run(f"{folder}/bin/pip", "freeze", "--exclude", "antnav", silent=True, external=True)
    Path("constraints.txt").write_text(str(frozen), encoding="utf-8")


@nox.session
def coverage(session: nox.Session) -> None:
    """Line coverage, kernels included: the compiler is off, which takes a few minutes."""
    session.run("pytest", "--cov", "--cov-report=term-missing", *session.posargs, env={"NUMBA_DISABLE_JIT": "1"})


@nox.session
def bench(session: nox.Session) -> None:
    """The benchmarks of docs/benchmarks.md that need nothing else."""
    for script in ("walk", "paco", "heuristics", "startup", "large"):
        session.run("python", f"benchmarks/bench_{script}.py")
    session.run("pytest", "-n", "0", "benchmarks/micro")
