"""Channel: what jobs in other processes tell while they run, and how they learn that they should end."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable
from multiprocessing.connection import Client, Connection, Listener
from types import TracebackType
from typing import Any, Protocol, Self

#: Seconds between two looks at whether the jobs should end, and the most that is waited for a last word.
LOOK, PATIENCE = 0.02, 2.0


class Asked(Protocol):
    """Something that can say stop."""

    def is_set(self) -> bool:
        """Whether to stop."""


class Sender:
    """The jobs' end: picklable; connects when it is first used. Where it cannot, nothing is told and nobody asks."""

    def __init__(self, address: Any, key: bytes) -> None:
        self._address, self._key = address, key
        self._connection: Any = None
        self._stopped = False

    def __reduce__(self) -> tuple[type[Sender], tuple[Any, bytes]]:
        return Sender, (self._address, self._key)

    def __enter__(self) -> Self:
        with contextlib.suppress(OSError, EOFError, ValueError):  # such as a worker on another machine
            self._connection = Client(self._address, authkey=self._key)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def send(self, told: object) -> None:
        """Tell."""
        if self._connection is not None:
            with contextlib.suppress(OSError):
                self._connection.send(told)

    def is_set(self) -> bool:
        """Whether to stop."""
        if self._connection is not None and not self._stopped:
            with contextlib.suppress(OSError, EOFError):
                self._stopped = self._connection.poll() and self._connection.recv() == "stop"
        return self._stopped


class Channel:
    """Our end, a context manager: calls `hear`, from a thread for each job, and passes on that somebody says stop.

    Parameters
    ----------
    hear : callable
        Gets what is told. Where it fails the error is raised at the end, and the jobs are told to stop.
    asked : object with is_set()
    """

    def __init__(self, hear: Callable[[Any], None], asked: Asked) -> None:
        self._hear, self._asked = hear, asked
        self._failure: BaseException | None = None
        self._closed = False
        self._readers: list[threading.Thread] = []

    def __enter__(self) -> Sender:
        key = os.urandom(32)
        self._listener = Listener(authkey=key, backlog=64)
        self._accepting = threading.Thread(target=self._accept, name="antnav-channel", daemon=True)
        self._accepting.start()
        self._key = key
        return Sender(self._listener.address, key)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._closed = True
        threading.Thread(target=self._wake, name="antnav-channel", daemon=True).start()
        self._accepting.join(PATIENCE)
        self._listener.close()  # and with it a waking call that came when nobody was asleep
        for reader in self._readers:
            reader.join(PATIENCE)
        if self._failure is not None and error is None:
            raise self._failure

    def _wake(self) -> None:
        """Wake the thread that accepts."""
        with contextlib.suppress(OSError, EOFError), Client(self._listener.address, authkey=self._key):
            pass

    def _accept(self) -> None:
        while not self._closed:
            try:
                connection = self._listener.accept()
            except Exception:  # somebody who has not the key, or left
                continue
            reader = threading.Thread(target=self._read, args=(connection,), name="antnav-channel", daemon=True)
            self._readers.append(reader)
            reader.start()

    def _read(self, connection: Connection[Any, Any]) -> None:
        told_to_stop = False
        with contextlib.suppress(OSError, EOFError), connection:
            while True:
                if not told_to_stop and (self._failure is not None or self._asked.is_set()):
                    connection.send("stop")
                    told_to_stop = True
                if connection.poll(LOOK):
                    self._heard(connection.recv())

    def _heard(self, told: object) -> None:
        if self._failure is None:
            try:
                self._hear(told)
            except BaseException as error:
                self._failure = error
