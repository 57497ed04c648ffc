"""The whole report: every file, the HTML by itself, the same bytes for the same records."""

from __future__ import annotations

import base64
import csv
import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

import antnav as an
from antnav.errors import OutputError, ParameterError
from antnav.rivals import RIVALS
from antnav.study import results
from antnav.study.groups import grouped, most_frequent
from antnav.study.model import AlgorithmEntry, MapEntry, Study, Sweep
from antnav.study.record import Mark, Record
from antnav.study.report import write_report
from tests.study.made_up import OPTIMUM, made_up, paper_like, problems

pytest.importorskip("matplotlib")
VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """What a browser would load, which figures it shows, and whether every tag is closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.sources: list[str] = []
        self.tags: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            if name in ("src", "href", "srcset", "data"):
                (self.links if tag == "a" else self.sources).append(value or "")
            if name == "id":
                self.ids.append(value or "")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report")
    records = paper_like()
    write_report(records, out, title="A <paper>", paper=True, problems=problems(), notes=("Be warned: 5 < 6.",))
    return out


def page_of(out: Path) -> tuple[str, Page]:
    text = (out / "report.html").read_text()
    return text, Page(text)


def test_html_is_whole_and_needs_nothing_else(written: Path) -> None:
    text, page = page_of(written)
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)
    assert all(source.startswith("data:image/") for source in page.sources)
    assert {link.removeprefix("#") for link in page.links} <= set(page.ids)
    assert not page.tags & {"script", "link", "iframe", "object"}
    assert "url(" not in text
    assert "@import" not in text
    assert "A &lt;paper&gt;" in text
    assert "Be warned: 5 &lt; 6." in text


def test_every_figure_is_in_the_html_and_in_both_formats(written: Path) -> None:
    _, page = page_of(written)
    names = {path.stem for path in (written / "figures").glob("*.svg")}
    assert names == {path.stem for path in (written / "figures").glob("*.png")}
    assert {"figure_5_best_length", "figure_6_lost_ants", "figure_7_equiv20", "figure_8_equiv30", "gaps"} <= names
    embedded = [base64.b64decode(source.split(",", 1)[1]) for source in page.sources]
    assert sorted(embedded) == sorted(path.read_bytes() for path in (written / "figures").glob("*.svg"))
    markdown = (written / "report.md").read_text()
    assert all(f"(figures/{name}.svg)" in markdown for name in names)


def test_every_table_is_in_all_formats(written: Path) -> None:
    text, page = page_of(written)
    names = {path.stem for path in (written / "tables").glob("*.csv")}
    assert names == {path.stem for path in (written / "tables").glob("*.tex")}
    assert names <= set(page.ids)
    assert {"table_2_equiv20", "table_3_equiv30", "saved_time", "auxiliary_cells", "comparisons", "reached"} <= names
    assert "published (other machines, own maps)" in text
    assert "reconstruction of somebody" in text


def test_csv_says_what_the_table_says(written: Path) -> None:
    groups = grouped(paper_like())
    table = results.outcomes("equiv20", groups["equiv20"], paper=True, name="table_2_equiv20", title="t")
    with (written / "tables" / "table_2_equiv20.csv").open() as stream:
        head, *rows = csv.reader(stream)
    assert head == [column.head for column in table.columns]
    best = head.index("best")
    assert [float(row[best]) for row in rows] == [row[best] for row in table.rows]
    with (written / "runs.csv").open() as stream:
        assert len(list(csv.DictReader(stream))) == 60


def test_differences_are_told_from_the_runs(written: Path) -> None:
    text = (written / "report.md").read_text()
    assert "No path where the paper prints one (2): equiv30 traditional best, equiv30 traditional mean." in text
    assert "equiv20: against NPACO, PACO needs 0.0 % less work on the critical path (steps)" in text
    assert "50.0 % less wall time; the paper prints" in text
    assert "the paper prints 50.71 % less time" in text
    assert "auxiliary cell (9, 8) is the printed one; 4 of 5 runs" in text
    assert "stand-ins" in text


def test_wall_seconds_beside_other_runs_are_no_finding(tmp_path: Path) -> None:
    records = [replace(record, marks=(Mark.LOADED,)) for record in paper_like()]
    write_report(records, tmp_path, title="t", paper=True, problems={})
    text = (tmp_path / "report.md").read_text()
    assert "Wall seconds are left out where runs had company (60 of 60 runs)" in text
    assert "0.0 % less CPU time (wall seconds are no measure: runs had company)" in text
    assert "nan" not in text
    assert "wall time" not in text.split("What differs")[1].split("Why")[0]


def test_the_report_tells_where_the_runs_were_made(tmp_path: Path) -> None:
    runs = [made_up("a", seed, OPTIMUM) for seed in range(3)]
    runs[2] = replace(runs[2], environment={"python": "3.13.0", "machine": "another"})
    write_report(runs, tmp_path, title="t", paper=False, problems={}, environment={"machine": "a third"})
    text = (tmp_path / "report.md").read_text()
    assert "| runs of environment 1 | 2: python 3.12.1, antnav 0.1.0, machine a machine |" in text
    assert "| runs of environment 2 | 1: python 3.13.0, machine another |" in text
    assert "| report: machine | a third |" in text


def test_same_records_same_bytes(written: Path, tmp_path: Path) -> None:
    write_report(
        paper_like(), tmp_path, title="A <paper>", paper=True, problems=problems(), notes=("Be warned: 5 < 6.",)
    )
    before, after = (
        {path.relative_to(root): path.read_bytes() for path in root.rglob("*") if path.is_file()}
        for root in (written, tmp_path)
    )
    assert before == after


@pytest.mark.parametrize(
    ("records", "said"),
    [
        ([made_up("x", 0, OPTIMUM)], ("x mean gap 0.00 %", "need two algorithms", "needs three algorithms")),
        ([made_up("x", seed, None) for seed in range(3)], ("x no path", "| x | paper | 3 |", "| no path | no path |")),
        ([made_up(name, 0, OPTIMUM + 1) for name in "abc"], ("a mean gap 3.42 %", "| a | b | 1 |", "needs three")),
        ([made_up("x", 0, None, optimum=None, iterations=0, best=(), lost=()), made_up("y", 0, None)], ("y no path",)),
        ([made_up("x", 0, 0.0, optimum=0.0, gap=0.0, path=((0, 0),), best=(), lost=())], ("x mean gap 0.00 %",)),
    ],
    ids=["one run", "no path", "one seed", "unreachable", "no walk"],
)
@pytest.mark.parametrize("paper", [True, False])
def test_odd_studies_still_give_a_report(
    records: list[Record], said: tuple[str, ...], paper: bool, tmp_path: Path
) -> None:
    place = problems(("equiv20",)) if len(records) == 1 else {}
    report = write_report(records, tmp_path / "new" / "folder", title="t", paper=paper, problems=place)
    _, page = page_of(report.parent)
    assert page.open == []
    text = (report.parent / "report.md").read_text()
    assert [words for words in said if words not in text] == []
    assert ("comparisons" in page.ids) == (len({record.algorithm for record in records}) > 1)


def test_sweeps_get_a_heat_map_each(tmp_path: Path) -> None:
    sweeps = [Sweep(name, {f"{name} rho={rho}": {"rho": rho} for rho in (0.1, 0.2)}) for name in ("paco+", "paco-")]
    records = [made_up(label, 0, OPTIMUM) for sweep in sweeps for label in sweep.points]
    write_report(records, tmp_path, title="t", paper=False, problems={}, sweeps=sweeps)
    _, page = page_of(tmp_path)
    assert len(set(page.ids)) == len(page.ids)
    assert [name for name in page.ids if "sweep" in name] == ["sweep_1_equiv20_paco__rho", "sweep_2_equiv20_paco__rho"]
    assert "Mean gap of paco- on equiv20 over rho" in (tmp_path / "report.md").read_text()


def test_what_was_run_is_kept_beside_the_results(tmp_path: Path) -> None:
    place = problems(("equiv20",))["equiv20"]
    entries = [AlgorithmEntry("mine", an.npaco(rho=0.2)), AlgorithmEntry("ga", RIVALS["woa-exact"])]
    source = {"builtin": "equiv20", "robot_radius": 0.0}
    study = Study(
        "t", [MapEntry("equiv20", place, source)], entries, [0, 1], baseline="ga", seconds=0.5, text="x = 1\n"
    )
    records = [
        replace(made_up(name, seed, OPTIMUM), marks=(Mark.LIMITED, Mark.BUSY) if seed else (Mark.BUSY,))
        for name in ("mine", "ga")
        for seed in range(2)
    ]
    write_report(records, tmp_path, title="t", paper=False, problems={"equiv20": place}, study=study)
    text = (tmp_path / "report.md").read_text()
    assert (tmp_path / "as_run.toml").read_text() == "x = 1\n"
    kept = json.loads((tmp_path / "parameters.json").read_text())
    assert kept["algorithms"]["mine"]["parameters"]["rho"] == 0.2
    assert kept["algorithms"]["mine"]["changed"] == ["rho"]
    assert kept["algorithms"]["mine"]["on_maps"] == {"equiv20": {"heuristic": "target", "switch": 0.6}}
    assert kept["algorithms"]["ga"]["rival"] == "woa-exact"
    assert (kept["seeds"], kept["seconds"], kept["baseline"]) == ([0, 1], 0.5, "ga")
    assert kept["maps"]["equiv20"]["source"] == source
    assert "rho 0.2*" in text
    assert (
        "| equiv20 | builtin equiv20 | 20 | 20 | 1 | 0 | (0, 0) | (19, 19) | the map's own | allow | blocked |" in text
    )
    assert "ga is the study's baseline" in text
    assert "Each run had 0.5 s at most; this ended 2 of 4 runs" in text
    assert "The machine was busy: in 4 of 4 runs" in text
    assert "equiv20: no comparison could reach 5 %" in text
    assert "steps are cost evaluations" in text
    assert "compares ants with ants only" in text


def test_labels_become_safe_names(tmp_path: Path) -> None:
    records = [made_up("a", 0, OPTIMUM, label=label) for label in ("../x", "..\\x", "<b>", "m" * 260)]
    write_report(records, tmp_path, title="t", paper=False, problems={})
    _, page = page_of(tmp_path)
    assert len(set(page.ids)) == len(page.ids)
    assert len(list((tmp_path / "tables").glob("results_*.csv"))) == 4
    assert "<b>" not in (tmp_path / "report.html").read_text().split("<main>")[1].replace("<figcaption><b>", "")
    assert not (tmp_path.parent / "x").exists()


def test_a_new_report_removes_what_the_last_one_wrote_and_nothing_else(tmp_path: Path) -> None:
    records = [made_up("a", 0, OPTIMUM, label=label) for label in "mn"]
    write_report(records, tmp_path, title="t", paper=False, problems={})
    others = [tmp_path / "tables" / "mine.csv", tmp_path / "notes.txt", tmp_path.parent / f"{tmp_path.name}.csv"]
    for path in others:
        path.write_text("")
    names = ("tables/../notes.txt", f"../{others[2].name}", "notes.txt", str(others[2]), "tables/none.csv", "tables")
    with (tmp_path / "files.txt").open("a") as stream:
        stream.write("".join(f"{name}\n" for name in names))
    write_report(records[1:], tmp_path, title="t", paper=False, problems={})
    assert [path for path in others if not path.exists()] == []
    found = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()}
    listed = set((tmp_path / "files.txt").read_text().splitlines())
    assert found - listed == {"files.txt", "tables/mine.csv", "notes.txt"}
    assert listed <= found
    assert not any("_m." in name for name in found)


def test_control_characters_reach_neither_page_nor_markdown(tmp_path: Path) -> None:
    bad = "a\x1b[31m\x00\x07\u202eb\x85\u2028c"
    records = [
        made_up(f"{bad}{i}", seed, OPTIMUM, label=bad, notes=(bad,), certainty=bad) for i in "12" for seed in (0, 1)
    ]
    write_report(records, tmp_path, title=bad, paper=False, problems={}, notes=(bad,), environment={bad: bad})
    for name in ("report.html", "report.md"):
        text = (tmp_path / name).read_text(encoding="utf-8")
        assert [letter for letter in text if not letter.isprintable() and letter != "\n"] == []
        assert "a [31m b c" in text


def test_labels_that_look_like_formulas_are_texts_in_csv(tmp_path: Path) -> None:
    label = "=HYPERLINK(0)"
    write_report(
        [made_up(label, seed, OPTIMUM, label=label) for seed in (0, 1)], tmp_path, title="t", paper=False, problems={}
    )
    files = [tmp_path / "runs.csv", *(tmp_path / "tables").glob("*.csv")]
    assert any(f"'{label}" in path.read_text() for path in files)
    for path in files:
        with path.open(newline="") as stream:
            assert not [cell for row in csv.reader(stream) for cell in row if cell.startswith("=")]


def test_labels_bring_no_html_into_markdown(tmp_path: Path) -> None:
    records = [made_up("<img src=x>\ny", seed, OPTIMUM, label="<b>\n") for seed in range(2)]
    write_report(records, tmp_path, title="<i>", paper=False, problems={})
    text = (tmp_path / "report.md").read_text()
    assert "<" not in text
    assert "| &lt;img src=x> y | paper | 2 |" in text


def test_nothing_to_report_and_nowhere_to_write(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="no runs"):
        write_report([], tmp_path, title="t", paper=False, problems={})
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot make"):
        write_report([made_up("a", 0, OPTIMUM)], tmp_path / "file", title="t", paper=False, problems={})


def test_from_real_runs(tmp_path: Path) -> None:
    problem = problems(("equiv20",))["equiv20"]
    algorithms = [an.paco(ants=10, iterations=8, axis="row"), an.npaco(ants=10, iterations=8)]
    records = [
        Record.of(an.solve(problem, algorithm, seed=seed), key=str(seed), map_label="m", algorithm_label=algorithm.name)
        for algorithm in algorithms
        for seed in range(3)
    ]
    write_report(records, tmp_path, title="t", paper=False, problems={"m": problem})
    with (tmp_path / "tables" / "results_1_m.csv").open() as stream:
        rows = {row["algorithm"]: row for row in csv.DictReader(stream)}
    for algorithm in algorithms:
        lengths = [record.length for record in records if record.algorithm == algorithm.name and record.length]
        assert float(rows[algorithm.name]["best"]) == min(lengths)
        assert float(rows[algorithm.name]["optimum"]) == pytest.approx(OPTIMUM)
    cell = most_frequent(records[:3])
    assert cell is not None
    assert f"| m | paco | {cell[0]} |" in (tmp_path / "report.md").read_text()
