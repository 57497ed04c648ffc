"""The server as pages, strangers and broken programs meet it."""

from __future__ import annotations

import http.client
import random
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import urlsplit

import msgspec
import pytest

import antnav as an

pytest.importorskip("starlette", reason="the extra antnav[view] is not installed")
websockets = pytest.importorskip("websockets.sync.client")

from websockets.exceptions import ConnectionClosed, InvalidStatus  # noqa: E402

from antnav.view.server import MOST_WEIGHT  # noqa: E402


class Served:
    """`antnav view` in a process of its own."""

    def __init__(self, *options):
        command = [sys.executable, "-m", "antnav", "view", "--no-browser", "--port", "0", "--quiet", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise AssertionError(self.process.communicate()[1])
        self.host = urlsplit(self.url).netloc

    def page(self, origin=None, query=None):
        query = urlsplit(self.url).query if query is None else query
        origin = f"http://{self.host}" if origin is None else origin
        return websockets.connect(f"ws://{self.host}/ws?{query}", origin=origin or None, max_size=None)

    def get(self, path="/", host=None):
        connection = http.client.HTTPConnection(*self.host.rsplit(":", 1), timeout=10)
        connection.request("GET", path, headers={"Host": host or self.host})
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()

    @property
    def megabytes(self):
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.partition("VmRSS:")[2].split()[0]) / 1024

    def end(self, sent=signal.SIGINT):
        begin = time.monotonic()
        self.process.send_signal(sent)
        try:
            output = self.process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        return self.process.returncode, time.monotonic() - begin, output


@pytest.fixture(scope="module")
def served():
    made = Served("equiv20", "--algorithm", "npaco")
    yield made
    made.process.kill()
    made.process.wait()
    made.process.stdout.close()
    made.process.stderr.close()


def said(connection, **message):
    connection.send(msgspec.json.encode(message).decode())


def heard(connection, kind, timeout=20):
    """The next message of a kind, acknowledging frames on the way."""
    while True:
        data = connection.recv(timeout=timeout)
        if isinstance(data, bytes):
            length = int.from_bytes(data[:4], "little")
            data = data[4 : 4 + length]
        message = msgspec.json.decode(data)
        if message["is"] == "state":
            said(connection, do="ack")
        if message["is"] == kind:
            return message


def test_a_page_opens_plays_and_hears_of_its_end(served):
    with served.page() as page:
        said(page, do="open")
        assert {one["name"] for one in heard(page, "menu")["algorithms"]} >= {"paco", "npaco", "astar"}
        assert heard(page, "scene")["name"] == "equiv20"
        said(page, do="speed", speed=0)
        said(page, do="play")
        while not heard(page, "state")["done"]:
            pass


def test_everything_comes_from_here_and_strangers_hear_nothing(served):
    status, headers, content = served.get()
    assert status == 200
    assert b"view.js" in content or b"page.js" in content
    assert "default-src 'self'" in headers["Content-Security-Policy"]
    for name in ("view.js", "page.js", "page.css", "view.css", "icon.svg"):
        status, _, content = served.get(f"/{name}")
        assert status == 200
        assert b"http://" not in content.replace(b"http://www.w3.org/2000/svg", b"")
        assert b"https://" not in content
    assert served.get("/../server.py")[0] == 404
    assert served.get(host="evil.example")[0] == 403  # a name of another site that leads to this machine
    for origin in ("http://evil.example", f"http://localhost.evil.example:{served.host.rsplit(':', 1)[1]}", ""):
        with pytest.raises(InvalidStatus), served.page(origin=origin):
            pass


def test_where_others_reach_it_only_those_with_the_token_are_heard():
    served = Served("equiv20", "--algorithm", "npaco", "--host", "0.0.0.0")
    try:
        assert "token=" in served.url
        assert served.host.rsplit(":", 1)[0] != "0.0.0.0"  # no name that another machine could use
        with served.page() as page:
            said(page, do="open")
            assert heard(page, "menu")
        port = served.host.rsplit(":", 1)[1]
        served.host = f"127.0.0.1:{port}"
        assert served.get("/")[0] == 403
        assert served.get("/?token=wrong")[0] == 403
        assert served.get("/?" + urlsplit(served.url).query)[0] == 200
        for query in ("", "token=wrong"):
            with pytest.raises(InvalidStatus), served.page(query=query):
                pass
        with served.page() as page:
            said(page, do="open")
            assert heard(page, "menu")
    finally:
        _, _, (_, errors) = served.end()
    assert "can be reached from other machines" in errors


def nonsense(chance):
    """A message that is none, or asks for what cannot be."""
    names = ["open", "ack", "play", "step", "speed", "choose", "draw", "ends", "load", "save", "drop", "fly", ""]
    values = [
        None,
        -1,
        10**30,
        1e308,
        "",
        "a" * 3000,
        [],
        {},
        [[1, 2]],
        [[10**9, -5]],
        True,
        "paco",
        "wall",
        {"x": [1]},
    ]
    keys = ["cells", "kind", "cost", "start", "goal", "name", "rows", "cols", "seed", "panels", "what", "speed", "link"]
    fields = {chance.choice(keys): chance.choice(values) for _ in range(chance.randrange(4))}
    text = msgspec.json.encode({"do": chance.choice(names), **fields})
    kind = chance.randrange(5)
    if kind == 0:
        return bytes(chance.randrange(256) for _ in range(chance.randrange(40)))
    if kind == 1:
        return text[: chance.randrange(len(text))].decode()
    if kind == 2:
        return len(text).to_bytes(4, "little") + text + b"x" * chance.randrange(30)
    if kind == 3:
        return "[" * chance.randrange(5000)
    return text.decode()


def test_ten_thousand_malformed_messages_change_nothing(served):
    chance = random.Random(5)
    before, left = served.megabytes, 10_000
    while left > 0:
        try:
            with served.page() as page:
                for _ in range(min(left, 60)):
                    page.send(nonsense(chance))
                    left -= 1
                while True:
                    page.recv(timeout=0.05)
        except (TimeoutError, ConnectionClosed):
            pass
    assert served.process.poll() is None
    assert served.megabytes < before + 100
    test_a_page_opens_plays_and_hears_of_its_end(served)


def test_half_open_connections_and_a_page_that_stops_reading(served):
    with ExitStack() as opened:
        address = served.host.rsplit(":", 1)
        for number in range(150):
            made = opened.enter_context(socket.create_connection((address[0], int(address[1])), timeout=10))
            if number % 2:
                made.sendall(b"GET /ws HTTP/1.1\r\nHost: " + served.host.encode() + b"\r\nUpgr")
        deaf = opened.enter_context(served.page())
        said(deaf, do="open")
        said(deaf, do="load", name="random", rows=500, cols=500)
        said(deaf, do="speed", speed=0)
        said(deaf, do="play")
        before = served.megabytes
        for _ in range(3000):  # it says that it has drawn what it never reads
            try:
                deaf.socket.settimeout(1)
                said(deaf, do="ack")
            except (TimeoutError, ConnectionClosed, OSError):
                break
        test_a_page_opens_plays_and_hears_of_its_end(served)
        assert served.megabytes < before + 300


def test_fifty_pages_at_once_and_the_next_is_told(served):
    with ExitStack() as opened:
        time.sleep(0.5)  # pages of other tests leave
        pages = [opened.enter_context(served.page()) for _ in range(50)]
        for page in pages:
            said(page, do="open")
            said(page, do="speed", speed=0)
            said(page, do="play")
        with served.page() as late:
            assert "full" in heard(late, "note")["given"]
        for page in pages:
            assert heard(page, "frame", timeout=60)["panel"] == 0
        assert served.megabytes < 1500


@pytest.mark.parametrize("pages", [0, 3])
def test_ctrl_c_ends_it_at_once(pages):
    served = Served("equiv20", "--algorithm", "npaco")
    with ExitStack() as opened:
        for _ in range(pages):
            page = opened.enter_context(served.page())
            said(page, do="open")
            said(page, do="play")
            heard(page, "frame")
        code, seconds, (_, errors) = served.end()
    assert code == 130
    assert "Traceback" not in errors
    assert seconds < 5  # one on a machine that is not busy with other tests


def test_an_address_that_is_taken_is_told_in_a_line(served):
    port = served.host.rsplit(":", 1)[1]
    command = [sys.executable, "-m", "antnav", "view", "--no-browser", "--port", port]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "--port" in done.stderr


def test_any_address_of_this_machine_can_be_listened_on():
    served = Served("equiv20", "--algorithm", "npaco", "--host", "127.0.0.2")
    try:
        assert served.get("/")[0] == 200
        assert served.get("/", host="evil.example")[0] == 403
        with pytest.raises(InvalidStatus), served.page(origin="http://[::1"):  # no URL at all
            pass
    finally:
        served.end()


def test_a_page_that_would_be_one_too_many_leaves_those_at_work(tmp_path):
    an.maps.save_map(an.maps.generate("random", 512, 512, seed=1, density=0.1), tmp_path / "large.npy")
    served = Served(str(tmp_path / "large.npy"), "--algorithm", "npaco")
    try:
        with ExitStack() as opened:
            pages = [opened.enter_context(served.page()) for _ in range(MOST_WEIGHT // 512**2)]
            for page in pages:
                said(page, do="open")
                heard(page, "scene")
            with served.page() as late:
                assert "full" in heard(late, "note")["given"]
            said(pages[0], do="restart")
            assert heard(pages[0], "began")
    finally:
        served.end()
