"""The store: what was added stays, whatever happens to the process, the disk or the file."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from antnav.errors import OutputError
from antnav.planner.facts import Certainty
from antnav.study import store as store_module
from antnav.study.record import Record
from antnav.study.store import Store, StoreError, StoreLockedError
from tests.study.made_up import made_up

RECORD = Record(
    key="00",
    map="map",
    algorithm="paco, \N{GREEK SMALL LETTER RHO} 0.1",
    seed=2**64 - 1,
    status="found",
    length=1 + 2**0.5,
    cost=1 + 2**0.5,
    optimum=2.0,
    gap=0.1 + 0.2,
    turns=3,
    clearance=None,
    iterations=2,
    walks=100,
    steps=40,
    critical_steps=30,
    seconds=1e-9,
    cpu_seconds=0.25,
    auxiliary_cell=(1, 2),
    path=((0, 0), (0, 1), (1, 2)),
    best=(None, 1 + 2**0.5),
    lost=(2, 0),
    certainty=Certainty.of("paper"),
    notes=("a note",),
    environment={"python": "3.12.1", "machine": "a machine, 4 cores"},
)

#: Adds records until it is killed, telling the number of each once it is stored.
WRITER = """
import sys
from dataclasses import replace
from antnav.study.store import Store
from tests.study.test_store import RECORD
with Store(sys.argv[1]) as store:
    number = len(store.keys())
    while True:
        store.add(replace(RECORD, key=f"{number:08}", best=(number / 7,) * 2000))
        print(number, flush=True)
        number += 1
"""


def filled(path: Path, count: int = 30) -> list[Record]:
    records = [replace(RECORD, key=f"{number:02}", best=(number / 7,) * 100) for number in range(count)]
    with Store(path) as store:
        for record in records:
            store.add(record)
    return records


def test_records_come_back_in_order(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    records = filled(path)
    with Store(path) as store:
        assert store.records() == records
        assert store.keys() == {record.key for record in records}
        changed = replace(records[3], notes=())
        store.add(changed)
        assert store.records() == [*records[:3], *records[4:], changed]
    assert list(tmp_path.iterdir()) == [path]


def test_a_second_store_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    script = "import sys; from antnav.study.store import Store; Store(sys.argv[1])"
    with Store(path) as store:
        begin = time.perf_counter()
        with pytest.raises(StoreLockedError, match=r"runs\.db.*in use"):
            Store(path)
        assert time.perf_counter() - begin < 0.5
        other = subprocess.run([sys.executable, "-c", script, path], capture_output=True, text=True, check=False)
        assert "StoreLockedError" in other.stderr
        assert "runs.db: it is in use by another run" in other.stderr
        store.add(RECORD)
    Store(path).close()


@pytest.mark.parametrize("delay", [0.0, 0.013, 0.037])
def test_killed_while_it_writes(tmp_path: Path, delay: float) -> None:
    path = tmp_path / "runs.db"
    command = [sys.executable, "-c", WRITER, str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=Path(__file__).parents[2]) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(delay)
        process.send_signal(signal.SIGKILL)
        told = 1 + len(process.stdout.readlines())
    with Store(path) as store:  # the lock died with the process
        numbers = [int(record.key) for record in store.records()]
    assert numbers == list(range(len(numbers)))
    assert told <= len(numbers) <= told + 1


def test_a_torn_write_is_undone(tmp_path: Path) -> None:
    """Pages that were being written when the power failed, and the journal that was on the disk before them."""
    path, journal, page = tmp_path / "runs.db", tmp_path / "runs.db-journal", 4096
    records = filled(path)
    before = path.read_bytes()
    database = sqlite3.connect(path, isolation_level=None)
    database.execute("PRAGMA cache_size = 1")  # so that changed pages reach the file before the transaction ends
    database.execute("BEGIN")
    database.execute("UPDATE records SET record = x'00'")
    torn, undo = bytearray(path.read_bytes()), journal.read_bytes()
    database.close()
    written = [start for start in range(0, len(before), page) if torn[start : start + page] != before[start:][:page]]
    assert len(written) > 2
    for start in written:
        torn[start + page // 2 : start + page] = b"\xa5" * (page // 2)
    path.write_bytes(torn)
    with pytest.raises(StoreError):
        Store(path)
    journal.write_bytes(undo)
    with Store(path) as store:
        assert store.records() == records


@pytest.mark.parametrize("content", [b"hello", b"x" * 5000, b'{"schema": "antnav/result"}\n' * 400])
def test_another_file_is_left_alone(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "notes.txt"
    path.write_bytes(content)
    with pytest.raises(StoreError, match=r"notes\.txt: it is no store.*move it away"):
        Store(path)
    assert path.read_bytes() == content
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("mode", ["delete", "wal"])
def test_another_database_is_left_alone(tmp_path: Path, mode: str) -> None:
    path = tmp_path / "other.db"
    with sqlite3.connect(path) as database:
        database.execute(f"PRAGMA journal_mode = {mode}")
        database.execute("CREATE TABLE records (key, value)")
    database.close()
    content = path.read_bytes()
    with pytest.raises(StoreError, match="no store of antnav"):
        Store(path)
    assert path.read_bytes() == content


def test_another_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    filled(tmp_path / "runs.db", 1)
    monkeypatch.setattr(store_module, "VERSION", store_module.VERSION + 1)
    with pytest.raises(StoreError, match=r"version 4, not 5.*move it away"):
        Store(tmp_path / "runs.db")


def test_garbled_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    filled(path)
    content = path.read_bytes()
    page = 4096
    for start, end in ((0, 100), (page, page + 200), (5 * page, 7 * page), (page, len(content))):
        path.write_bytes(content[:start] + b"\xa5" * (end - start) + content[end:])
        with pytest.raises(StoreError), Store(path) as store:
            store.records()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(StoreError, match="damaged"):
        Store(path)


def test_no_flipped_bit_gives_another_record(tmp_path: Path) -> None:
    path = tmp_path / "runs.db"
    records = filled(path, 12)
    content = path.read_bytes()
    refused = 0
    for bit in np.random.default_rng(8).choice(8 * len(content), 400, replace=False).tolist():
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        path.write_bytes(damaged)
        try:
            with Store(path) as store:
                assert store.records() == records
                assert store.keys() == {record.key for record in records}
        except StoreError:
            refused += 1
    assert refused > 100


@pytest.mark.parametrize("record", [b"\xff", b"{}", b'{"key": 3}', 7])
def test_a_garbled_record_is_refused(tmp_path: Path, record: object) -> None:
    path = tmp_path / "runs.db"
    filled(path, 2)
    with sqlite3.connect(path) as database:
        database.execute("UPDATE records SET record = ? WHERE key = '01'", (record,))
    database.close()
    with Store(path) as store, pytest.raises(StoreError, match="damaged"):
        store.records()


def test_places_where_nothing_can_be_written(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "missing" / "runs.db", Path("a\0b")):
        with pytest.raises(OutputError):
            Store(path)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="file size limits are POSIX")
def test_a_file_that_may_not_grow(tmp_path: Path) -> None:
    """The same store takes records again as soon as there is room; the full disk itself is in test_runner."""
    import resource

    path = tmp_path / "runs.db"
    records = filled(path)
    more = [replace(RECORD, key=f"more {number}", best=(0.1,) * 3000) for number in range(9)]
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    with Store(path) as store:
        resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + 60_000, hard))
        try:
            with pytest.raises(OutputError, match=r"runs\.db.*untouched; see to that, and start again"):
                for record in more:
                    store.add(record)
            kept = store.records()
            assert kept == [*records, *more][: len(kept)]
            assert len(records) < len(kept) < len(records) + len(more)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        for record in more[len(kept) - len(records) :]:
            store.add(record)
        assert store.records() == [*records, *more]
    with Store(path) as store:
        assert store.records() == [*records, *more]


def test_records_that_are_added_together_are_stored_together_or_not_at_all(tmp_path: Path) -> None:
    first, second = made_up("paco", 0, 30.0), made_up("paco", 1, 31.0)
    with Store(tmp_path / "runs.db") as store:
        with pytest.raises(RuntimeError), store.transaction():
            store.add_all([first, second])
            raise RuntimeError
        assert store.keys() == set()
        store.add_all([first, second])
        assert list(store.each()) == store.records() == [first, second]
        assert (store.record(second.key), store.record("another")) == (second, None)


def test_a_store_that_must_be_there(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="no such file"):
        Store(tmp_path / "runs.db", new=False)
    assert not (tmp_path / "runs.db").exists()
