"""The report of a study: one HTML file that needs nothing else, Markdown, tables, figures, and the raw runs."""

from __future__ import annotations

import base64
import os
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from antnav.colony.parameters import Algorithm
from antnav.errors import OutputError, ParameterError
from antnav.files import write_whole
from antnav.markup import escaped
from antnav.plan.result import versions
from antnav.study import claims, contents, figures, published, series, setup, statistics
from antnav.study.budget import Budget
from antnav.study.config import Study, Sweep
from antnav.study.drawings import (
    Drawing,
    file_name,
    gap_figure,
    paper_figures,
    rank_figure,
    study_figures,
    sweep_figures,
)
from antnav.study.environment import machine_name
from antnav.study.groups import Groups, busy, certainty, grouped, lengths, loaded, most_frequent, optimum_of
from antnav.study.record import LIMITED, Record
from antnav.study.tables import Column, Table, Value, plain
from antnav.world.problem import Problem


@dataclass(frozen=True)
class Section:
    """Part of a report: a heading, and what stands below it in this order."""

    title: str
    text: tuple[str, ...] = ()
    items: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    drawings: tuple[Drawing, ...] = ()


@dataclass
class _Files:
    """What a report consists of, by name."""

    contents: dict[str, bytes] = field(default_factory=dict)
    pictures: dict[str, bytes] = field(default_factory=dict)  #: SVG by name of the drawing


def write_report(
    records: Sequence[Record],
    out_dir: str | os.PathLike[str],
    *,
    title: str,
    paper: bool,
    problems: Mapping[str, Problem],
    sweeps: Sequence[Sweep] = (),
    study: Study | None = None,
    notes: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Write a report of these runs, each file whole or not at all, and return the path of its HTML.

    The same records give the same bytes on the same machine: nothing in the files depends on when they were written.

    Parameters
    ----------
    records : sequence of Record
        At least one. Order decides the order of maps and algorithms.
    out_dir : path-like
        Made where it is missing. Gets report.html (self-contained), report.md, runs.csv, tables/ and figures/, and with
        a study parameters.json and as_run.toml, the file that it was read from. Loses those tables and figures of its
        last report, named in files.txt, that this one does not have.
    title : str
    paper : bool
        Whether the records repeat Si & Bao 2024: its tables and figures by number, its printed figures beside ours.
    problems : mapping of str to Problem
        By map label, for the pictures of maps; a map that is missing here gets none.
    sweeps : sequence of Sweep
        Those of the study, for heat maps.
    study : Study, optional
        What was run: its parameters and problems are shown and, with the file that it was read from, kept beside the
        results, so that they can be repeated.
    notes : sequence of str
        What a reader must know, shown first.
    environment : mapping, optional
        Versions and machine that the report is written with; default: those here and now. Those of the runs are in
        the records.

    Raises
    ------
    ParameterError
        No records, or matplotlib is not installed.
    OutputError
        A file cannot be written.
    """
    if not records:
        raise ParameterError("a report", "there are no runs to report", "run the study first")
    groups = grouped(records)
    here = machine() if environment is None else environment
    facts = _facts(groups, {} if study else problems) | {f"report: {name}": value for name, value in here.items()}
    baseline = study.baseline if study else None
    sections = [
        Section("At a glance", items=(*_glance(groups), *_warnings(records, groups, study), *notes)),
        *_results(groups, problems, paper, _rivals(study)),
        *_sweeps(groups, sweeps),
        _tests(groups, baseline),
        *(_paper_sections(groups, problems, study) if paper else []),
        *([Section("What was run", tables=tuple(setup.tables(study)))] if study else []),
        Section("Environment", tables=(_environment(facts),)),
    ]
    files = _Files({"runs.csv": contents.runs_csv(records).encode()})
    if study:
        files.contents["parameters.json"] = setup.document(study).encode()
        if study.text:
            files.contents["as_run.toml"] = study.text.encode()
    for section in sections:
        _add(files, section)
    files.contents["report.md"] = _markdown(title, sections).encode()
    files.contents["report.html"] = _html(title, sections, files.pictures).encode()
    return _write(files.contents, Path(out_dir))


def machine() -> dict[str, str]:
    """Versions and machine, as the report states them."""
    from importlib.metadata import version

    names = {**versions(), "scipy": version("scipy"), "matplotlib": version("matplotlib")}
    return {
        "versions": ", ".join(f"{name} {number}" for name, number in names.items()),
        "machine": machine_name(),
    }


# Sections


def _glance(groups: Groups) -> list[str]:
    """One sentence a map; of many algorithms, on the best of them."""
    sentences = []
    for label, group in groups.items():
        parts = []
        for name in series.leaders(group):
            runs = group[name]
            found = statistics.summary(lengths(runs), optimum_of(runs))
            gaps = [100 * run.gap for run in runs if run.gap is not None]
            said = f"mean gap {sum(gaps) / len(gaps):.2f} %" if gaps else "no path"
            if 0 < found.arrived < found.runs:
                said += f", path in {found.arrived} of {found.runs} runs"
            parts.append(f"{name} {said}")
        choice = series.choice_of_leaders(group)
        sentences.append(f"{label}{f' ({choice})' if choice else ''}: {'; '.join(parts)}.")
    return sentences


def _warnings(records: Sequence[Record], groups: Groups, study: Study | None) -> list[str]:
    """What a reader has to know before the figures."""
    told = contents.too_few_seeds(groups, study.baseline if study else None)
    if study and study.seconds is not None:
        ended = sum(LIMITED in run.notes for run in records)
        told.append(
            f"Each run had {study.seconds:g} s at most; this ended {ended} of {len(records)} runs, whose lengths "
            "depend on the machine."
        )
    told += _budgets(groups, study)
    if count := loaded(records):
        told.append(
            f"Wall seconds are left out where runs had company ({count} of {len(records)} runs): they would be no "
            "measure; those of one worker are."
        )
    if count := busy(records):
        told.append(
            f"The machine was busy: in {count} of {len(records)} runs its load average was above its number of cores, "
            "so that their wall seconds are too many."
        )
    return told


def _budgets(groups: Groups, study: Study | None) -> list[str]:
    """In what the algorithms were made equal, and where they are not."""
    budget = study.equal_budget if study else None
    unequal = contents.unequal_budgets(groups, budget or Budget.WALKS)
    if study is None or budget is None:
        hint = "A study's key equal_budget gives all algorithms the same."
        return [*unequal, *([hint] if unequal else [])]
    how = (
        "by their iterations"
        if budget is Budget.WALKS
        else "each run ending with what that algorithm's of the same seed spent"
    )
    return [f"All algorithms got the {budget} of {study.reference.label}, {how}.", *unequal]


def _rivals(study: Study | None) -> list[str]:
    """Labels of the planners without ants."""
    return [entry.label for entry in study.algorithms if not isinstance(entry.algorithm, Algorithm)] if study else []


def _results(groups: Groups, problems: Mapping[str, Problem], paper: bool, rivals: Sequence[str]) -> list[Section]:
    found = []
    for number, (label, group) in enumerate(groups.items(), 2):
        title = f"Table {number}. Results on {label}" if paper else f"Results on {label}"
        name = f"table_{number}_{file_name(label)}" if paper else f"results_{number - 1}_{file_name(label)}"
        found.append(contents.outcomes(label, group, paper=paper, name=name, title=title, rivals=rivals))
    extra = [contents.saved_time(groups, paper=paper), contents.auxiliary_cells(groups, paper=paper)]
    drawings = paper_figures(groups, problems) if paper else study_figures(groups, problems, rivals)
    return [
        Section("Results", tables=(*found, *(table for table in extra if table))),
        Section("Figures", drawings=tuple(drawings)),
    ]


def _sweeps(groups: Groups, sweeps: Sequence[Sweep]) -> list[Section]:
    drawings = sweep_figures(groups, [plane for sweep in sweeps for plane in series.planes(sweep)])
    return [Section("Sensitivity to parameters", drawings=tuple(drawings))] if drawings else []


def _tests(groups: Groups, baseline: str | None) -> Section:
    """Statistics, with a word on each test that could not be done."""
    text, shown, drawings = [], [], [gap_figure(groups)]
    pairs = contents.comparisons(groups, baseline)
    if pairs:
        shown.append(pairs)
    else:
        text.append("Paired comparisons need two algorithms with a seed in common.")
    found, block, blocks = contents.ranks(groups)
    if found is None:
        text.append("Friedman's test needs three algorithms and two blocks that all of them have.")
    else:
        shown.append(contents.mean_ranks(found, block))
        drawings.append(rank_figure(found, list(blocks)))
    return Section("Statistics", tuple(text), tables=tuple(shown), drawings=tuple(drawings))


def _paper_sections(groups: Groups, problems: Mapping[str, Problem], study: Study | None) -> list[Section]:
    reached, examined = contents.reached(groups), claims.examined(groups, problems, study)
    one_by_one = Section("The paper's claims", (claims.tally(examined),), tables=(claims.table(examined),))
    return [
        *([one_by_one] if examined else []),
        Section(
            "What differs from the paper, and why",
            text=(
                f"Written by the program from the runs above. The paper's figures are of {published.RUNS} runs each "
                f"({published.PAPER}).",
            ),
            items=tuple(_differences(groups, reached)),
            tables=(reached,) if reached else (),
        ),
        Section(
            "What the paper leaves undefined, and what we chose",
            text=("Formulas, sources and measurements: docs/algorithms and docs/reproduction.md of antnav.",),
            items=published.CHOICES,
        ),
    ]


def _differences(groups: Groups, reached: Table | None) -> list[str]:
    """What is reached and what is not, in sentences, with the likely cause."""
    rows = reached.rows if reached else ()
    told = [f"{len(rows)} printed lengths have a counterpart here."] if rows else []
    for figure, meaning in (
        ("reached", "Reached"),
        ("as printed: no path", "No path, as printed"),
        ("shorter than printed", "Shorter than printed"),
        ("path, none printed", "A path where the paper prints none"),
        ("not reached", "Not reached (longer)"),
        ("no path", "No path where the paper prints one"),
    ):
        cases = [_case(row) for row in rows if row[6] == figure]
        if cases:
            told.append(f"{meaning} ({len(cases)}): {', '.join(cases)}.")
    missed = dict.fromkeys(str(row[1]) for row in rows if row[6] in ("not reached", "no path"))
    told += [_cause(name, groups) for name in missed]
    return told + _time_differences(groups) + _cell_differences(groups)


def _case(row: tuple[Value, ...]) -> str:
    label, algorithm, figure, _, _, off, verdict, *_ = row
    by = f" ({off:+.2f} %)" if isinstance(off, float) and verdict != "reached" else ""
    return f"{label} {algorithm} {figure}{by}"


def _cause(algorithm: str, groups: Groups) -> str:
    """Why an algorithm may miss printed lengths: what its certainty says it rests on."""
    said = "; ".join(dict.fromkeys(certainty(group[algorithm]) for group in groups.values() if algorithm in group))
    causes = ["the built-in maps are stand-ins with the same optimum but other walls"]
    if "reconstruction" in said:
        causes.insert(0, "the algorithm is a reconstruction, not its authors' code")
    elif "calibrated" in said:
        causes.insert(0, "the paper does not print all parameters")
    return f"Why {algorithm} may miss them: {', and '.join(causes)} (certainty: {said})."


def _time_differences(groups: Groups) -> list[str]:
    """Time saved by PACO, ours beside the printed."""
    table = contents.saved_time(groups, paper=True)
    told = [
        f"{row[0]}: PACO needs {claims.saved_words(row)} than NPACO; the paper prints {row[-1]:.2f} % less time."
        for row in (table.rows if table else ())
        if isinstance(row[-1], float)
    ]
    if told:
        told.append(
            "Why the savings differ: stage two takes as long as its longer half, and early iterations wander over the "
            "whole map in both halves; runs here last milliseconds, of which starting two threads is a part, and "
            "need two free cores."
        )
    return told


def _cell_differences(groups: Groups) -> list[str]:
    """Auxiliary cells, ours beside the printed."""
    told = []
    for label, group in groups.items():
        side, favourite = published.side_of(label), most_frequent(group.get("paco", []))
        if side is None or favourite is None:
            continue
        printed, runs = published.AUXILIARY[side][0], group["paco"]
        share = sum(run.auxiliary_cell == printed for run in runs)
        which = "is the printed one" if favourite[0] == printed else f"is not the printed {printed}"
        told.append(
            f"{label}: PACO's most frequent auxiliary cell {favourite[0]} {which}; {share} of {len(runs)} runs "
            "choose the printed one."
        )
    return told


def _facts(groups: Groups, problems: Mapping[str, Problem]) -> dict[str, str]:
    runs = [run for group in groups.values() for runs in group.values() for run in runs]
    facts = {"runs": str(len(runs)), "seeds": _ranges(sorted({run.seed for run in runs}))}
    for label in groups:
        if label in problems:
            problem = problems[label]
            grid = problem.grid
            facts[f"map {label}"] = (
                f"{grid.rows} x {grid.cols} cells, {problem.start_cell} to {problem.goal_cell} (row, col), corner rule "
                f"{problem.corner_rule}, digest {grid.digest[:16]}"
            )
    places = Counter(", ".join(f"{name} {value}" for name, value in run.environment.items()) for run in runs)
    facts |= {f"runs of environment {number}": f"{places[place]}: {place}" for number, place in enumerate(places, 1)}
    said = Counter(note for run in runs for note in run.notes)
    facts |= {f"note: {note}": f"in {said[note]} of {len(runs)} runs" for note in sorted(said)}
    return facts


def _ranges(seeds: Sequence[int]) -> str:
    """1, 2, 3, 7 as "1-3, 7"."""
    parts: list[list[int]] = []
    for seed in seeds:
        if parts and seed == parts[-1][-1] + 1:
            parts[-1][1:] = [seed]
        else:
            parts.append([seed])
    return ", ".join("-".join(map(str, part)) for part in parts)


def _environment(facts: Mapping[str, str]) -> Table:
    columns = (Column("what"), Column("value"))
    return Table("environment", "Runs, maps, versions and machine", columns, tuple(facts.items()))


# Files


def _add(files: _Files, section: Section) -> None:
    for table in section.tables:
        files.contents[f"tables/{table.name}.csv"] = table.csv().encode()
        files.contents[f"tables/{table.name}.tex"] = table.latex().encode()
    for drawing in section.drawings:
        files.pictures[drawing.name] = figures.render(drawing.draw, "svg")
        files.contents[f"figures/{drawing.name}.svg"] = files.pictures[drawing.name]
        files.contents[f"figures/{drawing.name}.png"] = figures.render(drawing.draw, "png")


def _write(files: Mapping[str, bytes], out: Path) -> Path:
    """The report itself last: where it is, the rest is too."""
    try:
        for folder in (out, out / "tables", out / "figures"):
            folder.mkdir(parents=True, exist_ok=True)
        for name in _written_before(out) - files.keys():
            (out / name).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot make or clear {error.filename}", error.strerror or str(error), "name a folder that can be made"
        ) from error
    write_whole(out / _MANIFEST, "".join(f"{name}\n" for name in sorted(files)).encode())
    for name, content in files.items():
        write_whole(out / name, content)
    return out / "report.html"


_MANIFEST = "files.txt"  #: Names of the files of a report, so that the next one in that folder can remove them.


def _written_before(out: Path) -> set[str]:
    """Tables and figures that the folder's last report wrote, whatever else its list may say."""
    try:
        lines = (out / _MANIFEST).read_text(encoding="ascii").splitlines()
    except (OSError, UnicodeError):
        return set()
    return {line for line in lines if re.fullmatch(r"(tables|figures)/\w+\.(csv|tex|svg|png)", line, re.ASCII)}


def _markdown(title: str, sections: Sequence[Section]) -> str:
    parts = [f"# {plain(title)}\n"]
    for section in sections:
        parts.append(f"## {plain(section.title)}\n")
        parts += [f"{plain(text)}\n" for text in section.text]
        if section.items:
            parts.append("".join(f"- {plain(item)}\n" for item in section.items))
        for table in section.tables:
            note = [f"{plain(table.note)}\n"] if table.note else []
            parts += [f"### {plain(table.title)}\n", table.markdown(), *note]
        for drawing in section.drawings:
            name = plain(drawing.title)
            parts += [f"### {name}\n", f"![{name}](figures/{drawing.name}.svg)\n", f"{plain(drawing.caption)}\n"]
    return "\n".join(parts)


_CSS = """
:root { color-scheme: light dark; --ink: #26292e; --faint: #5b6169; --paper: #fff; --line: #d5d8dc; --band: #f3f4f6; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e6e9; --faint: #a3a9b1; --paper: #16181b; --line: #3a3e44; --band: #202327; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 86rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; overflow-wrap: break-word; }
p, ul, figure { max-width: 72rem; }
h1 { font-size: 1.6rem; line-height: 1.25; } h2 { margin-top: 2.5rem; border-bottom: 1px solid var(--line); }
nav ul { padding: 0; display: flex; flex-wrap: wrap; gap: .25rem 1.2rem; list-style: none; }
a { color: inherit; }
.scroll { overflow-x: auto; margin: 1.5rem 0 .5rem; }
table { border-collapse: collapse; font-size: .78rem; line-height: 1.3; overflow-wrap: normal; }
caption { text-align: left; font-weight: 600; font-size: 1rem; padding-bottom: .4rem; white-space: nowrap; }
th, td { padding: .3rem .4rem; text-align: left; vertical-align: top; }
thead th { border-bottom: 2px solid var(--line); vertical-align: bottom; font-weight: 600; }
tbody tr:nth-child(odd) { background: var(--band); }
tbody th { position: sticky; left: 0; background: inherit; background-color: var(--paper); }
tbody tr:nth-child(odd) th { background-color: var(--band); }
thead th:first-child { position: sticky; left: 0; background: var(--paper); }
.scroll::-webkit-scrollbar { height: .6rem; }
.scroll::-webkit-scrollbar-thumb { background: var(--faint); border-radius: .3rem; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
td.number { white-space: nowrap; }
.published { color: var(--faint); font-style: italic; }
td.prose { min-width: 9rem; }
.note, figcaption { color: var(--faint); font-size: .85rem; }
figure { margin: 2rem 0; } figcaption b { color: var(--ink); }
figure img { display: block; background: #fff; border-radius: 4px; max-width: 100%; height: auto; margin: .5rem 0; }
@media (max-width: 40rem) { figure .scroll img.wide { max-width: none; width: 52rem; } }
"""

_WIDE = 600  #: Points from which a figure scrolls sideways on a phone instead of shrinking beyond reading.


def _html(title: str, sections: Sequence[Section], pictures: Mapping[str, bytes]) -> str:
    links = "".join(f'<li><a href="#s{i}">{escaped(section.title)}</a></li>' for i, section in enumerate(sections))
    body = "\n".join(_html_section(f"s{i}", section, pictures) for i, section in enumerate(sections))
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escaped(title)}</title>\n<style>{_CSS}</style>\n</head>\n<body>\n"
        f'<h1>{escaped(title)}</h1>\n<nav aria-label="Sections"><ul>{links}</ul></nav>\n'
        f"<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _html_section(anchor: str, section: Section, pictures: Mapping[str, bytes]) -> str:
    parts = [f'<section id="{anchor}">\n<h2>{escaped(section.title)}</h2>']
    parts += [f"<p>{_text(text)}</p>" for text in section.text]
    if section.items:
        parts.append("<ul>\n" + "\n".join(f"<li>{_text(item)}</li>" for item in section.items) + "\n</ul>")
    parts += [table.html() for table in section.tables]
    parts += [_html_figure(drawing, pictures[drawing.name]) for drawing in section.drawings]
    return "\n".join([*parts, "</section>"])


def _text(text: str) -> str:
    """Escaped; no line ends between a number and its per cent."""
    return escaped(text).replace(" %", "&nbsp;%")


def _html_figure(drawing: Drawing, svg: bytes) -> str:
    """The picture as data: its ids cannot clash with those of another."""
    width = float(svg.split(b'width="', 1)[1].split(b"pt", 1)[0])
    look = ' class="wide"' if width > _WIDE else ""
    source = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
    return (
        f'<figure id="{drawing.name}">\n<div class="scroll" tabindex="0">'
        f'<img{look} src="{source}" alt="{escaped(drawing.title)}"></div>\n'
        f"<figcaption><b>{escaped(drawing.title)}.</b> {escaped(drawing.caption)}</figcaption>\n</figure>"
    )
