"""Store: the records of a study in one file that survives crashes, full disks and second writers."""

from __future__ import annotations

import contextlib
import copy
import os
import sqlite3
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, Self, TypeVar, overload

import msgspec

from antnav.errors import AntnavError, OutputError
from antnav.study.record import Kept, Record

R = TypeVar("R", bound=Kept)
Other = TypeVar("Other", bound=Kept)

#: Marks an SQLite file as a store: "antn".
APPLICATION_ID = 0x616E746E
#: Of the table and of the records in it.
VERSION = 4

_COLUMNS = "(key TEXT PRIMARY KEY, record BLOB NOT NULL, checksum INTEGER)"

#: What SQLite says when the file, not its surroundings, is at fault. ERROR: there is no such table or column.
_FAULTY = {sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR}


class StoreError(AntnavError, ValueError):
    """A file is no store of this version of antnav, or is damaged."""


class StoreLockedError(AntnavError, RuntimeError):
    """Another process, or another `Store` of this one, has the store open."""


class Store(Generic[R]):
    """Records in an SQLite file, each safe on the disk when `add` returns. A context manager.

    Parameters
    ----------
    path : path-like
    kind : type of record
        What is read and written here: `Record`, `FrontRecord` of studies of fronts, `DynamicRecord` of maps that
        change. One file may hold all.
    new : bool
        Whether it is made where it is missing.

    Raises
    ------
    StoreLockedError
        It is open elsewhere.
    StoreError
        The file is something else, of another version, damaged, or missing; it is left as it is.
    OutputError
        It cannot be written, or the disk is full.

    Notes
    -----
    The lock is SQLite's exclusive one, held until the store is closed. It belongs to the process, so it cannot outlive
    it, whatever ends it.

    Changes go through a rollback journal with full synchronisation: the old pages are on the disk before the new ones
    are written, and whoever opens the store after a crash puts them back, so a torn write costs no more than the record
    that was being added. A write-ahead log would spare a few milliseconds a run, but after a kill it would hold records
    that are missing from a copy of the file alone.

    SQLite looks at the frame of its pages only, and hands out a number in which a bit has flipped: so a checksum goes
    with each record.
    """

    @overload
    def __init__(self: Store[Record], path: str | os.PathLike[str], *, new: bool = True) -> None: ...

    @overload
    def __init__(self, path: str | os.PathLike[str], kind: type[R], *, new: bool = True) -> None: ...

    def __init__(self, path: str | os.PathLike[str], kind: type[Kept] = Record, *, new: bool = True) -> None:
        self.path = Path(path)
        self._kind: Any = kind
        if "\0" in os.fspath(self.path):
            raise OutputError(f"store {str(self.path)!r}", "a file name has no NUL", "choose another name")
        if not (new or self.path.is_file()):
            raise self._refused("there is no such file", "give a store, such as runs.sqlite of a study")
        with self._errors():
            # isolation_level None: a statement outside BEGIN is a transaction. timeout 0: refuse, don't wait.
            self._db = sqlite3.connect(self.path.absolute(), 0.0, isolation_level=None, check_same_thread=False)
        try:
            with self._errors():
                self._open()
        except BaseException:
            self._db.close()
            raise

    def _open(self) -> None:
        self._db.execute("PRAGMA locking_mode = EXCLUSIVE")
        self._db.execute("PRAGMA synchronous = FULL")
        self._db.execute("BEGIN EXCLUSIVE")
        mark, version = self._pragma("application_id"), self._pragma("user_version")
        if (mark, version) == (0, 0) and not self._db.execute("SELECT 1 FROM sqlite_master").fetchone():  # a new file
            self._db.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            self._db.execute(f"PRAGMA user_version = {VERSION}")
        elif mark != APPLICATION_ID:
            raise self._refused("it is a database, but no store of antnav", "choose another file name")
        elif version != VERSION:
            rule = f"it is a store of version {version}, not {VERSION}: another antnav wrote it"
            raise self._refused(rule, "move it away, or choose another place; its runs are then done anew")
        elif (state := self._pragma("integrity_check(1)")) != "ok":
            raise self._damaged(" ".join(str(state).split()))
        if not self.holds(self._kind):
            self._db.execute(f"CREATE TABLE {self._kind.table} {_COLUMNS}")
        self._db.execute("COMMIT")
        self._db.execute("PRAGMA journal_mode = DELETE")

    def _pragma(self, name: str) -> int | str:
        value: int | str = self._db.execute(f"PRAGMA {name}").fetchone()[0]
        return value

    def holds(self, kind: type[Kept]) -> bool:
        """Whether there may be records of that kind."""
        with self._errors():
            return bool(self._db.execute("SELECT 1 FROM sqlite_master WHERE name = ?", (kind.table,)).fetchone())

    def beside(self, kind: type[Other]) -> Store[Other]:
        """What the same open file holds of another kind."""
        other: Any = copy.copy(self)
        other._kind = kind
        if not self.holds(kind):
            with self._errors():
                self._db.execute(f"CREATE TABLE {kind.table} {_COLUMNS}")
        return other  # type: ignore[no-any-return]

    def keys(self) -> set[str]:
        """Keys of all records."""
        with self._errors():
            return {key for (key,) in self._db.execute(f"SELECT key FROM {self._kind.table}")}

    def add(self, record: R) -> None:
        """Store a record; one of the same key is replaced.

        Raises
        ------
        OutputError
            The disk is full or failed. What was stored before is untouched, and the store can be used again.
        """
        self.add_all([record])

    def add_all(self, records: Iterable[R]) -> None:
        """Store records in one transaction: all of them, or none; see `add`."""
        contents = [(record.key, msgspec.json.encode(record)) for record in records]
        with self.transaction(), self._errors():
            self._db.executemany(
                f"INSERT OR REPLACE INTO {self._kind.table} VALUES (?, ?, ?)",
                [(key, content, zlib.crc32(content)) for key, content in contents],
            )

    @contextlib.contextmanager
    def transaction(self) -> Iterator[None]:
        """What is added inside is stored as a whole, or where it fails not at all."""
        if self._db.in_transaction:
            yield
            return
        with self._errors():
            self._db.execute("BEGIN")
        try:
            yield
            with self._errors():
                self._db.execute("COMMIT")
        except BaseException:
            with contextlib.suppress(sqlite3.Error):  # a full disk has ended it
                self._db.execute("ROLLBACK")
            raise

    def record(self, key: str) -> R | None:
        """The record of a key, if there is one; see `records`."""
        return next(self._read("WHERE key = ?", key), None)

    def each(self) -> Iterator[R]:
        """All records in the order in which they were added, one by one; see `records`."""
        return self._read("ORDER BY rowid")

    def records(self) -> list[R]:
        """All records in the order in which they were added.

        Raises
        ------
        StoreError
            The file is damaged.
        """
        return list(self.each())

    def _read(self, which: str, *values: str) -> Iterator[R]:
        with self._errors():
            rows = self._db.execute(f"SELECT key, record, checksum FROM {self._kind.table} {which}", values)
            try:
                for row in rows:
                    yield self._verified(*row)
            except (msgspec.MsgspecError, UnicodeError, TypeError) as error:
                raise self._damaged(error) from error

    def _verified(self, key: str, content: bytes, checksum: int) -> R:
        record: R = msgspec.json.decode(content, type=self._kind)
        if record.key != key or zlib.crc32(content) != checksum:
            raise msgspec.ValidationError(f"the record {key} is not as it was written")
        return record

    def close(self) -> None:
        """Let go of the file."""
        self._db.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @contextlib.contextmanager
    def _errors(self) -> Iterator[None]:
        """Turn SQLite's errors into ours."""
        try:
            yield
        except sqlite3.ProgrammingError:  # such as a closed store: the caller's
            raise
        except sqlite3.Error as error:
            code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF  # without the extended part
            if code == sqlite3.SQLITE_BUSY:
                raise StoreLockedError(
                    f"store {self.path}", "it is in use by another run", "wait for its end, or choose another file"
                ) from error
            if code in _FAULTY:
                raise self._damaged(error) from error
            raise OutputError(
                f"store {self.path}: {error}",
                "it is a file in a folder that exists, is writable and has room; what was stored before is untouched",
                "see to that, and start again: it goes on where it stopped",
            ) from error

    def _damaged(self, reason: object) -> StoreError:
        return self._refused(f"it is no store, or is damaged ({reason})", "move it away, or choose another file name")

    def _refused(self, rule: str, remedy: str) -> StoreError:
        return StoreError(f"store {self.path}", rule, remedy)
