"""Check the built site without a network: every link inside it leads somewhere, and no page asks another machine.

`python docs/check_site.py docs/_build/html`, behind Sphinx in `nox -s docs`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

#: What a browser fetches by itself, by element; a link that a reader clicks is none of it.
FETCHED = {
    **dict.fromkeys(("img", "script", "iframe", "source", "audio", "video", "embed", "input"), ("src", "srcset")),
    "link": ("href",),
    "object": ("data",),
}
#: Relations of `link` that tell browsers and search engines something, but fetch nothing.
TOLD = {"canonical", "next", "prev", "index", "search", "author", "help"}
IN_STYLES = re.compile(r"(?:@import|url\()\s*[\"']?\s*((?:https?:)?//[^\"')\s]+)")


class Page(HTMLParser):
    """The links, the anchors and the fetched addresses of one page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors = {""}
        self.links: list[str] = []
        self.fetched: list[str] = IN_STYLES.findall(text)
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Take note of an element."""
        given = {name: value for name, value in attributes if value is not None}
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if tag in FETCHED and not (tag == "link" and TOLD & set(given.get("rel", "").split())):
            self.fetched += [given[name] for name in FETCHED[tag] if name in given]


def complaints(site: Path) -> Iterator[str]:
    """What is wrong with a built site, a line each."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    if not pages:
        yield f"{site}: no pages there"
    for path, page in pages.items():
        place = path.relative_to(site)
        for address in page.fetched:
            if urlsplit(address).netloc:
                yield f"{place}: fetches {address}"
        for link in [*page.links, *page.fetched]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                yield f"{place}: {link} leads to no file"
            elif target in pages and unquote(parts.fragment) not in pages[target].anchors:
                yield f"{place}: {link} leads to no place on that page"
    for path in sorted(site.rglob("*.css")):
        for address in IN_STYLES.findall(path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(site)}: fetches {address}"


def main(folder: str) -> int:
    """Print the complaints about a folder; 1 where there are any."""
    found = list(complaints(Path(folder).resolve()))
    print("\n".join(found) or f"{folder}: every link inside leads somewhere, nothing is fetched from elsewhere")
    return bool(found)


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
