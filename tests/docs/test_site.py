"""What builds and checks the site."""

from __future__ import annotations

import re
import sys
from importlib import import_module
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def module(monkeypatch, request):
    """A module of docs/ or docs/_ext/."""
    pytest.importorskip("sphinx", reason="Sphinx is not installed: antnav[docs]")
    monkeypatch.syspath_prepend(str(DOCS / "_ext"))
    monkeypatch.syspath_prepend(str(DOCS))
    yield import_module(request.param)
    sys.modules.pop(request.param, None)


@pytest.fixture
def site(tmp_path):
    """A small site in which all is well."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "index.html").write_text(
        '<h1 id="top">A</h1><a href="sub/b.html#there">b</a><a href="https://x.org">x</a>'
    )
    (tmp_path / "sub" / "b.html").write_text('<p id="there"></p><a href="../index.html#top">a</a><img src="p.png">')
    (tmp_path / "sub" / "p.png").write_bytes(b"")
    (tmp_path / "site.css").write_text("body { background: url(sub/p.png) }")
    return tmp_path


@pytest.mark.parametrize("module", ["check_site"], indirect=True)
def test_a_site_in_which_all_is_well(module, site):
    assert list(module.complaints(site)) == []


@pytest.mark.parametrize("module", ["check_site"], indirect=True)
@pytest.mark.parametrize(
    ("page", "said"),
    [
        ('<a href="none.html">', "none.html leads to no file"),
        ('<a href="sub/b.html#nowhere">', "sub/b.html#nowhere leads to no place on that page"),
        ('<a href="#nowhere">', "#nowhere leads to no place on that page"),
        ('<img src="sub/q.png">', "sub/q.png leads to no file"),
        ('<script src="https://cdn.example/x.js">', "fetches https://cdn.example/x.js"),
        ('<script src="//cdn.example/x.js">', "fetches //cdn.example/x.js"),
        ('<link rel="stylesheet" href="https://cdn.example/x.css">', "fetches https://cdn.example/x.css"),
        ("<style>@import 'https://fonts.example/f'</style>", "fetches https://fonts.example/f"),
    ],
)
def test_what_is_wrong_is_said(module, site, page, said):
    (site / "index.html").write_text(page)
    complaints = list(module.complaints(site))
    assert f"index.html: {said}" in complaints


@pytest.mark.parametrize("module", ["check_site"], indirect=True)
def test_styles_fetch_nothing_and_an_empty_folder_is_no_site(module, site, tmp_path):
    (site / "site.css").write_text("a { background: url('https://cdn.example/p.png') }")
    assert list(module.complaints(site)) == ["site.css: fetches https://cdn.example/p.png"]
    (tmp_path / "empty").mkdir()
    assert "no pages there" in next(module.complaints(tmp_path / "empty"))


@pytest.mark.parametrize("module", ["citation"], indirect=True)
def test_the_citation_has_software_and_paper(module):
    said = module.yaml.safe_load(module.FILE.read_text(encoding="utf-8"))
    software, paper = module.bibtex(said), module.bibtex(said["references"][0])
    assert software.startswith("@software{antnav2026,")
    assert f"version = {{{said['version']}}}" in software
    assert paper.startswith("@article{si2024,")
    assert "author = {Si and Bao}" in paper
    assert "doi = {10.3934/mbe.2024113}" in paper


@pytest.mark.parametrize("module", ["commands"], indirect=True)
def test_help_becomes_text_with_its_commands_and_kept_lines(module):
    assert list(module.prose("A *b*.\n\n\b\n0 done\n1 not\n\nantnav plan x --y")) == [
        *("A \\*b\\*.", ""),
        *("| 0 done", "| 1 not", ""),
        *(".. code-block:: text", "", "   antnav plan x --y", ""),
    ]


@pytest.mark.parametrize("module", ["gallery"], indirect=True)
@pytest.mark.parametrize("script", sorted((DOCS / "gallery").glob("*.py")), ids=lambda script: script.stem)
def test_scripts_of_the_gallery_say_what_they_show_and_are_shown(module, script):
    words, code = module.explanation_and_code(script.read_text(encoding="utf-8"))
    title, blank, text = words.split("\n", maxsplit=2)
    assert title.endswith(".")
    assert not blank
    assert text
    assert code.startswith("import")
    assert f"{{picture}} {script.name}\n" in (DOCS / "gallery" / "index.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("module", ["rules"], indirect=True)
def test_the_rules_have_small_pictures_that_are_shown(module):
    drawn = {f"{draw.__name__}.svg" for draw in module.DRAWN}
    page = (DOCS / "how-paco-works.md").read_text(encoding="utf-8")
    assert set(re.findall(r"images/rules/(\w+\.svg)", page)) == drawn == {file.name for file in module.FOLDER.iterdir()}
    assert all(file.stat().st_size < 30_000 for file in module.FOLDER.iterdir())
