"""Sources: one digest of all code that decides what a run comes out as, so that other code runs anew."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

#: What of the package has no say in that: it reads, asks, shows, compares or keeps. Map and costs are part of a key ...
WITHOUT_SAY = frozenset({"__init__.py", "__main__.py", "bench", "cli", "costs", "maps", "plot", "report", "study"})
#: ... but these of a study do the runs, limit them, and make records of them.
WITH_SAY = frozenset(
    f"study/{name}.py" for name in ("budget", "front_model", "front_record", "model", "record", "runner")
)


@cache
def sources() -> str:
    """Digest of the code that runs here: worked out once a process, in some 5 ms."""
    return digest_of(Path(__file__).parents[1])


def digest_of(package: Path) -> str:
    """Digest of the package in that folder; a room that nobody thought of counts."""
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py"), key=lambda file: file.relative_to(package).as_posix()):
        name, content = file.relative_to(package).as_posix(), file.read_bytes()
        if name in WITH_SAY or name.partition("/")[0] not in WITHOUT_SAY:
            digest.update(f"{name} {len(content)}\n".encode() + content)
    return digest.hexdigest()
