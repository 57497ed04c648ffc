"""Who may speak to the server: pages that it served itself, and nobody else."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from urllib.parse import urlsplit

#: Names of this machine that a browser may use.
_LOCAL = {"localhost", "127.0.0.1", "::1"}


class Guard:
    """Decides on hosts, origins and the token.

    A page of another site can open a connection to a server on this machine: so the origin counts. A name of another
    site may lead to this machine (DNS rebinding): so the host counts. Where others can reach the server, a token that
    only the person who started it knows stands in the address.

    Parameters
    ----------
    host : str
        The address that the server listens on.
    port : int

    Attributes
    ----------
    token : str
        "" on the loopback address, which only this machine reaches.
    """

    def __init__(self, host: str, port: int) -> None:
        self.host, self.port = host, port
        self.local = is_loopback(host)
        self.token = "" if self.local else secrets.token_urlsafe(16)

    @property
    def url(self) -> str:
        """The address for a browser."""
        host = self.host if self.local else _reachable(self.host)
        host = f"[{host}]" if ":" in host else host
        return f"http://{host}:{self.port}/" + (f"?token={self.token}" if self.token else "")

    def admits(self, host: str | None, token: str) -> bool:
        """Whether a request that names this host and token is answered."""
        named = _name(f"//{host}" if host else "")
        known = named in (*_LOCAL, self.host) if self.local else bool(named)
        return known and secrets.compare_digest(token.encode(), self.token.encode())

    def admits_origin(self, origin: str | None, host: str | None) -> bool:
        """Whether a connection from a page of that origin is taken: the page must have come from here."""
        return bool(origin and host) and (origin or "").partition("://")[2] == host


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches an address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _reachable(host: str) -> str:
    """What other machines call this one where it listens on all its addresses."""
    if host not in ("", "0.0.0.0", "::"):
        return host
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.connect(("192.0.2.1", 9))  # of documentation (RFC 5737); nothing is sent
            return str(probe.getsockname()[0])
    except OSError:
        return "127.0.0.1"


def _name(address: str) -> str:
    try:
        return urlsplit(address).hostname or ""
    except ValueError:
        return ""
