"""Documentation names only what exists."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

import antnav as an
from antnav.plugins.loading import ALGORITHMS, PARTS

ROOT = Path(__file__).parents[1]
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]


def names_in(text: str) -> set[str]:
    """What code on a page takes from the package: an.x.y and antnav.x.y, but no file names and web addresses."""
    return set(re.findall(r"(?<![\w./-])(?:an|antnav)((?:\.[A-Za-z_]\w*)+)(?![\w/-])", text))


def exists(dotted: str) -> bool:
    thing: object = an
    place = "antnav"
    for part in dotted.strip(".").split("."):
        place += f".{part}"
        try:
            thing = getattr(thing, part) if hasattr(thing, part) else import_module(place)
        except ImportError:
            return False
    return True


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_pages_name_only_what_exists(page: Path) -> None:
    code = re.findall(r"```.*?```|`[^`]+`", page.read_text(encoding="utf-8"), re.DOTALL)
    named = names_in("\n".join(code)) - {f".{group.rpartition('.')[2]}" for group in (PARTS, ALGORITHMS)}
    assert [name for name in sorted(named) if not exists(name)] == []


def test_a_name_that_does_not_exist_would_be_found() -> None:
    assert names_in("an.solve(x, stop=an.Seconds(1)); https://antnav.org/a antnav.toml/x") == {".solve", ".Seconds"}
    assert [exists(name) for name in (".solve", ".stop.Seconds", ".rivals.RIVALS", ".Seconds", ".nothing.x")] == [
        *(True, True, True),
        *(False, False),
    ]
