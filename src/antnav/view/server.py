"""The server: pages, and a connection for each that carries messages in and packets out."""

from __future__ import annotations

import asyncio
import contextlib
import math
import socket
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from importlib.resources import files
from typing import Any

from antnav.errors import AntnavError, OutputError, ParameterError
from antnav.view.guard import Guard
from antnav.view.messages import MOST_BYTES, decoded, encoded
from antnav.view.packet import Packet
from antnav.view.session import Session, Start

try:
    import uvicorn
    from starlette.applications import Starlette
    from starlette.requests import Request
    from starlette.responses import PlainTextResponse, Response
    from starlette.routing import Route, WebSocketRoute
    from starlette.websockets import WebSocket, WebSocketDisconnect
except ImportError as error:
    raise ParameterError("the view", f"{error.name} is not installed", 'pip install "antnav[view]"') from error

#: Pages at once, and cells that they may keep together.
MOST_PAGES, MOST_WEIGHT = 50, 4_000_000
#: Connections that may wait to be taken.
BACKLOG = 256
#: Seconds that a page may take for a packet, and without an answer to a ping.
PATIENCE, PING = 20.0, 10.0
#: Messages in a row that are no messages; then the page is sent away.
MOST_NONSENSE = 20
#: What a browser may load, and from where: all of it from here.
HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
_TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
#: Codes of closing: unwelcome, nonsense, full.
_REFUSED, _NONSENSE, _FULL = 1008, 1003, 1013
_HEAVY = "the pages that are open hold too many cells"


class Server:
    """All pages that look at one map, each with a session of its own.

    Parameters
    ----------
    start : Start
    guard : Guard
    """

    def __init__(self, start: Start, guard: Guard) -> None:
        self._start, self._guard = start, guard
        self._sessions: set[Session] = set()
        self._workers = ThreadPoolExecutor(2, "antnav-view")
        pages = {path.name: path.read_bytes() for path in files(__package__).joinpath("page").iterdir()}
        routes: list[Any] = [
            Route("/" if name == "index.html" else f"/{name}", _page(guard, name, content))
            for name, content in pages.items()
        ]
        self.app = Starlette(routes=[*routes, WebSocketRoute("/ws", self._serve)], lifespan=self._lifespan)

    @contextlib.asynccontextmanager
    async def _lifespan(self, _app: Starlette) -> AsyncIterator[None]:
        yield
        self._workers.shutdown(wait=False, cancel_futures=True)

    async def _serve(self, socket: WebSocket) -> None:
        host, origin = socket.headers.get("host"), socket.headers.get("origin")
        admitted = self._guard.admits(host, socket.query_params.get("token", ""))
        if not (admitted and self._guard.admits_origin(origin, host)):
            await socket.close(_REFUSED)
            return
        await socket.accept()
        if len(self._sessions) >= MOST_PAGES:
            await _say_full(socket, f"{MOST_PAGES} pages are open")
            return
        session = await self._work(Session, self._start)
        self._sessions.add(session)
        try:
            if self._overweight():  # this page, and not one that is at work
                await _say_full(socket, _HEAVY)
                return
            await _Page(socket, session, self._work, self._overweight).run()
        finally:
            self._sessions.discard(session)

    def _overweight(self) -> bool:
        return sum(session.weight for session in self._sessions) > MOST_WEIGHT

    async def _work(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """What takes longer than a moment: beside the loop that answers."""
        return await asyncio.get_running_loop().run_in_executor(self._workers, function, *arguments)


class _Page:
    """A connection: one task listens, another sends; the session is used by one of them at a time."""

    def __init__(
        self, socket: WebSocket, session: Session, work: Callable[..., Any], overweight: Callable[[], bool]
    ) -> None:
        self._socket, self._session, self._work, self._overweight = socket, session, work, overweight
        self._lock, self._heard = asyncio.Lock(), asyncio.Event()

    async def run(self) -> None:
        """Until the page is closed, is silent for too long or talks nonsense."""
        tasks = [asyncio.create_task(self._listen()), asyncio.create_task(self._send())]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            done = await asyncio.gather(*tasks, return_exceptions=True)
        for error in done:
            if isinstance(error, Exception) and not isinstance(
                error, WebSocketDisconnect | TimeoutError | RuntimeError | OSError
            ):
                raise error

    async def _listen(self) -> None:
        nonsense = 0
        while True:
            received = await self._socket.receive()
            if received["type"] == "websocket.disconnect":
                return
            data = received.get("bytes") if received.get("bytes") is not None else received.get("text", "")
            try:
                message, content = decoded(data or "")
            except AntnavError as error:
                nonsense += 1
                if nonsense > MOST_NONSENSE:
                    await self._socket.close(_NONSENSE)
                    return
                async with self._lock:
                    if len(self._session.outbox) < MOST_NONSENSE:
                        self._session.outbox.append(
                            {"is": "note", "given": error.given, "rule": error.rule, "remedy": error.remedy}
                        )
            else:
                nonsense = 0
                async with self._lock:
                    await self._work(self._session.do, message, content)
                if self._overweight():
                    await _say_full(self._socket, _HEAVY)
                    return
            self._heard.set()

    async def _send(self) -> None:
        while True:
            self._heard.clear()
            async with self._lock:
                wait = self._session.due()
                packets = [] if wait > 0 else await self._work(self._session.frames)
            for packet in packets:
                sending = (
                    self._socket.send_bytes(bytes(packet))
                    if isinstance(packet, Packet)
                    else self._socket.send_text(encoded(packet))
                )
                await asyncio.wait_for(sending, PATIENCE)
            if wait > 0:
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self._heard.wait(), None if math.isinf(wait) else wait)


async def _say_full(socket: WebSocket, why: str) -> None:
    note = {"is": "note", "given": "the server is full", "rule": why, "remedy": "close a page, or try again later"}
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await socket.send_text(encoded(note))
        await socket.close(_FULL)


def _page(guard: Guard, name: str, content: bytes) -> Callable[[Request], Any]:
    kind = _TYPES["." + name.rpartition(".")[2]]
    open_to_all = name != "index.html"  # scripts and styles hold nothing of the user's

    async def answer(request: Request) -> Response:
        token = guard.token if open_to_all else request.query_params.get("token", "")
        if not guard.admits(request.headers.get("host"), token):
            return PlainTextResponse("antnav view: open the address that the program printed\n", 403, HEADERS)
        return Response(content, media_type=kind, headers=HEADERS)

    return answer


def bound(host: str, port: int) -> socket.socket:
    """A socket that listens there; port 0: any that is free.

    Raises
    ------
    OutputError
        The address is taken, or none of this machine's.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((host, port))
        made.listen(BACKLOG)  # from now on pages wait, not fail
    except (OSError, OverflowError) as error:
        made.close()
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise OutputError(
            f"--port {port} on {host}", reason, "give another --port, or 0 for any that is free"
        ) from None
    return made


def serve(start: Start, listening: socket.socket, guard: Guard) -> None:
    """Answer until Ctrl-C."""
    config = uvicorn.Config(
        Server(start, guard).app,
        log_level="warning",
        access_log=False,
        ws="websockets-sansio",
        ws_max_size=MOST_BYTES + 1000,
        ws_max_queue=8,
        ws_ping_interval=PING,
        ws_ping_timeout=PING,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=1,
        timeout_keep_alive=5,
        limit_concurrency=4 * MOST_PAGES,
        server_header=False,
    )
    uvicorn.Server(config).run(sockets=[listening])
