"""Pages do what they print: Python as doctests, the tutorial's commands with their output."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pytest

from antnav import cli

DOCS = Path(__file__).parents[2] / "docs"
TUTORIAL = DOCS / "tutorial.md"
SAME = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def blocks(language: str, page: Path = TUTORIAL) -> list[str]:
    """What stands in a page's fences of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


#: Pages with Python and what it prints.
PRINTED = [page for page in sorted(DOCS.rglob("*.md")) if blocks("pycon", page)]


@pytest.fixture
def files(tmp_path, monkeypatch):
    """The two files that a reader saves, in a folder of their own."""
    (drawing,), (study,) = blocks("text"), blocks("toml")
    (tmp_path / "room.txt").write_text(drawing, encoding="utf-8")
    (tmp_path / "mine.toml").write_text(study, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize("page", PRINTED, ids=lambda page: page.name)
def test_python_prints_what_the_page_says(page):
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks("pycon", page)), {}, page.name, str(page), 0)
    told: list[str] = []
    failed = doctest.DocTestRunner(optionflags=SAME).run(examples, out=told.append).failed
    assert not failed, "".join(told)


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize("block", blocks("console"), ids=lambda block: block.split("\n")[0][2:])
def test_commands_print_what_the_page_says(block, capsys):
    line, wanted = block.removeprefix("$ antnav ").split("\n", maxsplit=1)
    assert cli.main(shlex.split(line)) == 0
    printed = capsys.readouterr().out
    assert doctest.OutputChecker().check_output(wanted, printed, SAME), printed
