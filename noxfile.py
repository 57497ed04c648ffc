"""Every chore by name: `nox -l` lists them. Sessions use the environment that nox itself runs in."""

from __future__ import annotations

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
def coverage(session: nox.Session) -> None:
    """Line coverage, kernels included: the compiler is off, which takes a few minutes."""
    session.run("pytest", "--cov", "--cov-report=term-missing", *session.posargs, env={"NUMBA_DISABLE_JIT": "1"})


@nox.session
def bench(session: nox.Session) -> None:
    """The benchmarks of docs/benchmarks.md that need nothing else."""
    for script in ("walk", "paco", "heuristics", "startup", "large"):
        session.run("python", f"benchmarks/bench_{script}.py")
    session.run("pytest", "benchmarks/micro")
