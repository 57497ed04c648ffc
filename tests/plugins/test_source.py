"""Where code comes from, and digests that change with it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from antnav.plugins.loading import load
from antnav.plugins.source import Source, digest_of, file_of

CODE = '''
import math
NEAR, TABLE = 0.1, [1, 2]

def helper(x):
    return x + NEAR

def rule(ground, top=3):
    """A rule."""
    return [helper(one) + math.pi for one in ground]

class Own:
    factor: float = 2.0

    def plan(self):
        return helper(self.factor)

    @property
    def size(self):
        return len(TABLE)
'''


def in_a_notebook(code: str) -> ModuleType:
    """A module without a file."""
    module = ModuleType("cell_of_a_notebook")
    sys.modules[module.__name__] = module
    exec(compile(code, "<cell>", "exec"), vars(module))
    return module


@pytest.fixture(autouse=True)
def _no_cell_is_left() -> Any:
    yield
    sys.modules.pop("cell_of_a_notebook", None)


@pytest.mark.parametrize("name", ["rule", "Own"])
@pytest.mark.parametrize(
    ("before", "after", "same"),
    [
        ("", "", True),
        ("import math", "\n# a remark\nimport math", True),
        ('"""A rule."""', '"""The rule."""', None),
        ("x + NEAR", "x - NEAR", False),
        ("NEAR, TABLE = 0.1", "NEAR, TABLE = 0.2", False),
    ],
)
def test_without_a_file_all_bytecode_counts_that_is_referred_to(
    name: str, before: str, after: str, same: bool | None
) -> None:
    one = digest_of(getattr(in_a_notebook(CODE), name))
    other = digest_of(getattr(in_a_notebook(CODE.replace(before, after)), name))
    assert len(one) == 64
    assert same is None or (one == other) == same


def test_defaults_fields_and_properties_count() -> None:
    rule, own = (digest_of(getattr(in_a_notebook(CODE), name)) for name in ("rule", "Own"))
    assert digest_of(in_a_notebook(CODE.replace("top=3", "top=4")).rule) != rule
    assert digest_of(in_a_notebook(CODE.replace("= 2.0", "= 3.0")).Own) != own
    assert digest_of(in_a_notebook(CODE.replace("[1, 2]", "[1, 2, 3]")).Own) != own
    assert digest_of(in_a_notebook(CODE.replace("[1, 2]", "[1, 2, 3]")).rule) == rule


def test_closures_recursion_and_compiled_functions_count() -> None:
    def made(step: int) -> Any:
        def rule(n: int) -> int:
            return step if n == 0 else rule(n - 1)

        rule.__module__ = "nowhere"
        return rule

    assert digest_of(made(1)) == digest_of(made(1)) != digest_of(made(2))
    cell = "import numba\n@numba.njit\ndef helper(x): return x + {}\ndef rule(x): return helper(x)\n"
    one, other = (digest_of(in_a_notebook(cell.format(number)).rule) for number in (1, 2))
    assert one != other


@pytest.mark.parametrize("value", ["Settings(k={})", "Kind({})", "numpy.arange(6).reshape({}, -1)"])
def test_values_that_a_function_refers_to_count(value: str) -> None:
    cell = """
import dataclasses, enum, numpy
@dataclasses.dataclass(frozen=True)
class Settings:
    k: float
Kind = enum.Enum("Kind", {"ONE": 1, "TWO": 2})
CHOSEN = VALUE
def rule(x): return x, CHOSEN
"""
    one, same, other = (
        digest_of(in_a_notebook(cell.replace("VALUE", value.format(number))).rule) for number in (1, 1, 2)
    )
    assert one == same != other


def test_a_digest_is_the_same_in_every_process() -> None:
    code = CODE + "\ndef pick(x):\n    return x in {'a', 'b', 'c'} or RULES\nRULES = {helper, rule, pick}\n"
    script = (
        "import sys, types; from antnav.plugins.source import digest_of\n"
        f"module = types.ModuleType('cell'); sys.modules['cell'] = module; exec({code!r}, vars(module))\n"
        "print(digest_of(module.pick), digest_of(module.rule), digest_of(module.Own))"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", script], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(found) == 1


def test_with_a_file_the_whole_file_counts(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    digests = []
    for code in (CODE, CODE, CODE + "# edited\n"):
        file.write_text(code)
        digests.append(digest_of(load(file).rule))
    assert digests[0] == digests[1] != digests[2]
    assert file_of(load(file).rule) == file


def test_how_a_source_is_named(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(CODE)
    source = Source.of(load(file).rule, "share", "1.2")
    assert str(source) == "share (mine.py, 1.2)"
    assert source.place == str(file.resolve())
    assert source.document() == {"name": "share", "version": "1.2", "source": source.digest, "file": "mine.py"}
    assert str(tmp_path) not in str(source.document())
    alone = Source.of(in_a_notebook(CODE).rule, "share")
    assert (str(alone), alone.place, alone.file) == ("share", "cell_of_a_notebook", "")


def test_what_a_function_will_only_refer_to_later_has_no_digest_yet() -> None:
    later = """
def made():
    def rule(ground): return after()
    global digest
    digest = digest_of(rule)
    def after(): return 1
made()
"""
    module = in_a_notebook("from antnav.plugins.source import digest_of\n" + later)
    assert len(module.digest) == 64
