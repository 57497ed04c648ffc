"""Tables of a study: rows from records, and writers for Markdown, CSV, LaTeX and HTML."""

from __future__ import annotations

import csv
import html
import io
import json
import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, dataclass, fields
from itertools import combinations

import numpy as np

from antnav.problem import CellIndex
from antnav.study import published, statistics
from antnav.study.record import LOADED, Record

Value = str | float | int | None
Groups = dict[str, dict[str, list[Record]]]

ALL_PAIRS = 6  #: Up to so many algorithms, each is compared with each; beyond, the first with each other.
PROSE = 30  #: Letters from which a text gets a wider column in HTML.
MANY_MAPS = 10  #: From so many maps on, Friedman's blocks are maps; below, runs of one seed on one map.


@dataclass(frozen=True)
class Column:
    """A column: its head, how its numbers are written (a format specification), whether others published them."""

    head: str
    spec: str = ""
    published: bool = False

    def text(self, value: Value) -> str:
        """A value for readers: a dash for what does not exist, "no path" for an infinite length."""
        if value is None or (isinstance(value, float) and math.isnan(value)):
            return "-"
        if isinstance(value, float) and math.isinf(value):
            return "no path"
        return value if isinstance(value, str) else format(value, self.spec)


@dataclass(frozen=True)
class Table:
    """A table with its name (of its files), its title, and a note on how to read it."""

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Value, ...], ...]
    note: str = ""

    @property
    def texts(self) -> list[list[str]]:
        """All cells as readers see them."""
        return [[column.text(value) for column, value in zip(self.columns, row, strict=True)] for row in self.rows]

    def right(self, index: int) -> bool:
        """Whether a column holds numbers, which are set flush right."""
        return bool(self.columns[index].spec)

    def markdown(self) -> str:
        """A pipe table."""
        lines = [[column.head for column in self.columns], *self.texts]
        rule = ["---:" if self.right(index) else "---" for index in range(len(self.columns))]
        escaped = [[plain(cell).replace("|", "\\|") for cell in line] for line in lines]
        return "\n".join("| " + " | ".join(line) + " |" for line in [escaped[0], rule, *escaped[1:]]) + "\n"

    def csv(self) -> str:
        """Full precision; empty for what does not exist, inf for no path."""
        return _csv([column.head for column in self.columns], self.rows)

    def latex(self) -> str:
        """A floating table of the packages booktabs and graphicx."""
        shape = "".join("r" if self.right(index) else "l" for index in range(len(self.columns)))
        lines = [
            "% needs \\usepackage{booktabs,graphicx}",
            "\\begin{table*}",
            "\\centering",
            f"\\caption{{{_tex(' '.join((self.title + '.', self.note)).strip())}}}",
            f"\\label{{tab:{self.name}}}",
            "\\resizebox{\\textwidth}{!}{%",
            f"\\begin{{tabular}}{{{shape}}}",
            "\\toprule",
            _tex_row([column.head for column in self.columns]),
            "\\midrule",
            *(_tex_row(row) for row in self.texts),
            "\\bottomrule",
            "\\end{tabular}}",
            "\\end{table*}",
        ]
        return "\n".join(lines) + "\n"

    def html(self) -> str:
        """A table in a box that scrolls sideways on a narrow screen."""
        looks = self._looks()
        heads = "".join(
            f'<th scope="col"{look}>{html.escape(column.head)}</th>'
            for column, look in zip(self.columns, looks, strict=True)
        )
        body = "\n".join(f"<tr>{_html_row(row, looks)}</tr>" for row in self.texts)
        return (
            f'<div class="scroll" tabindex="0"><table id="{self.name}">\n<caption>{html.escape(self.title)}</caption>\n'
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>\n"
            + (f'<p class="note">{html.escape(self.note)}</p>\n' if self.note else "")
        )

    def _looks(self) -> list[str]:
        """The class attribute of each column's cells in HTML."""
        widths = [max(map(len, column), default=0) for column in zip(*self.texts, strict=True)]
        looks = []
        for index, (column, width) in enumerate(zip(self.columns, widths, strict=True)):
            number = self.right(index)
            classes = (
                ["number"] * number + ["published"] * column.published + ["prose"] * (not number and width > PROSE)
            )
            looks.append(f' class="{" ".join(classes)}"' if classes else "")
        return looks


def _html_row(row: list[str], looks: list[str]) -> str:
    cells = zip(row[1:], looks[1:], strict=True)
    return f'<th scope="row">{html.escape(row[0])}</th>' + "".join(
        f"<td{look}>{html.escape(cell)}</td>" for cell, look in cells
    )


_TEX = {"\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}"} | {
    letter: f"\\{letter}" for letter in "&%$#_{}"
}


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in _one_line(text))


def _tex_row(cells: Sequence[str]) -> str:
    """After a rule or a line's end, LaTeX would read a bracket or a star as an option of these."""
    row = " & ".join(_tex(cell) for cell in cells) + " \\\\"
    return "{}" * row.startswith(("[", "*")) + row


def plain(text: str) -> str:
    """Text for Markdown: on one line, and no HTML."""
    return html.escape(_one_line(text), quote=False)


def _one_line(text: str) -> str:
    return " ".join(text.splitlines())


def _csv(head: Sequence[str], rows: Sequence[Sequence[Value]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(
        [["" if isinstance(value, float) and math.isnan(value) else value for value in row] for row in rows]
    )
    return text.getvalue()


# What the records say


def grouped(records: Sequence[Record]) -> Groups:
    """Records by map and algorithm, both in the order of their first appearance, each group by seed."""
    algorithms = dict.fromkeys(record.algorithm for record in records)
    groups: Groups = {}
    for record in records:
        groups.setdefault(record.map, {}).setdefault(record.algorithm, []).append(record)
    return {
        label: {name: sorted(group[name], key=lambda run: run.seed) for name in algorithms if name in group}
        for label, group in groups.items()
    }


def lengths(runs: Sequence[Record]) -> list[float]:
    """Lengths in cells, inf without a path."""
    return [math.inf if run.length is None else run.length for run in runs]


def optimum_of(runs: Sequence[Record]) -> float:
    """The optimum of a group's problem; inf where no path exists."""
    return next((run.optimum for run in runs if run.optimum is not None), math.inf)


def median(values: Sequence[float]) -> float:
    """Median of times and counts."""
    return float(np.median(values)) if values else math.nan


def loaded(runs: Iterable[Record]) -> int:
    """How many of the runs shared the machine with others, so that their wall seconds are no measure."""
    return sum(LOADED in run.notes for run in runs)


def wall_seconds(runs: Sequence[Record]) -> float:
    """Median; nan where a run had company."""
    return math.nan if loaded(runs) else median([run.seconds for run in runs])


def percent_saved(ours: float, theirs: float) -> float:
    """By how much ours is below theirs, in per cent."""
    return 100 * (1 - ours / theirs) if theirs else math.nan


# The tables

_OUTCOMES = (
    Column("algorithm"),
    Column("certainty"),
    Column("runs", "d"),
    Column("time (median wall s)", ".4f"),
    Column("best", ".4f"),
    Column("mean", ".4f"),
)
_PUBLISHED = tuple(
    Column(f"{figure}: {published.LABEL}", spec, published=True)
    for figure, spec in (("time s", "g"), ("best", ".4f"), ("mean", ".4f"))
)
_BEYOND = (
    Column("optimum", ".4f"),
    Column("gap of mean (%)", ".2f"),
    Column("gap, 95 % from (%)", ".2f"),
    Column("gap, 95 % to (%)", ".2f"),
    Column("success (%)", ".0f"),
    Column("optimal (%)", ".0f"),
    Column("median", ".4f"),
    Column("spread (IQR)", ".4f"),
    Column("std", ".4f"),
    Column("ant steps", ".0f"),
    Column("steps on the critical path", ".0f"),
    Column("CPU s", ".4f"),
)

OUTCOMES_NOTE = (
    "Lengths in cells. Best, mean, std and gap are of the runs with a path; median and spread (interquartile range) of "
    "all runs, a missing path counting as infinitely long. Seconds and steps are medians; steps are the moves of all "
    "ants. The 95 % interval is a BCa bootstrap of the mean gap with a fixed seed."
)


def outcomes(label: str, group: dict[str, list[Record]], *, paper: bool, name: str, title: str) -> Table:
    """One map's table: a row for each algorithm; with `paper`, the printed figures in columns of their own."""
    columns = (*_OUTCOMES, *(_PUBLISHED if paper else ()), *_BEYOND)
    rows = tuple(_outcome(label, algorithm, runs, paper) for algorithm, runs in group.items())
    note = OUTCOMES_NOTE + _company(run for runs in group.values() for run in runs)
    if paper:
        note += f" Columns headed “{published.LABEL}” are from {published.PAPER}: never to be mixed with ours."
    return Table(name, title, columns, rows, note)


def _company(runs: Iterable[Record]) -> str:
    return " Wall seconds are missing where other runs ran beside them: they would be no measure." * (loaded(runs) > 0)


def _outcome(label: str, algorithm: str, runs: list[Record], paper: bool) -> tuple[Value, ...]:
    found, optimum = statistics.summary(lengths(runs), optimum_of(runs)), optimum_of(runs)
    gaps = [100 * run.gap for run in runs if run.gap is not None]
    low, high = statistics.interval(gaps)
    row: tuple[Value, ...] = (
        algorithm,
        certainty(runs),
        found.runs,
        wall_seconds(runs),
        found.best if found.arrived else math.inf,
        found.mean if found.arrived else math.inf,
    )
    beyond: tuple[Value, ...] = (
        optimum,
        sum(gaps) / len(gaps) if gaps else None,
        low,
        high,
        100 * found.success_rate,
        100 * found.optimal_rate,
        found.median,
        found.iqr,
        found.std,
        median([run.steps for run in runs]),
        median([run.critical_steps for run in runs]),
        median([run.cpu_seconds for run in runs]),
    )
    return (*row, *(_printed(label, algorithm) if paper else ()), *beyond)


def certainty(runs: Sequence[Record]) -> str:
    """Certainty of a group, as its records state it."""
    return "; ".join(dict.fromkeys(run.certainty for run in runs))


def _printed(label: str, algorithm: str) -> tuple[Value, ...]:
    key = (published.side_of(label) or 0, algorithm)
    if key not in published.PRINTED:
        return (None, None, None)
    printed = published.PRINTED[key]
    return astuple(printed) if printed else (math.inf, math.inf, math.inf)


def saved_time(groups: Groups, *, paper: bool) -> Table | None:
    """Per cent that PACO saves over NPACO; None where no map has both."""
    measures: dict[str, Callable[[Sequence[Record]], float]] = {
        "wall s": wall_seconds,
        "steps on the critical path": lambda runs: median([run.critical_steps for run in runs]),
        "CPU s": lambda runs: median([run.cpu_seconds for run in runs]),
    }
    rows: list[tuple[Value, ...]] = []
    compared: list[Record] = []
    for label, group in groups.items():
        if "paco" not in group or "npaco" not in group:
            continue
        compared += [*group["paco"], *group["npaco"]]
        paco, npaco = ([measure(group[name]) for measure in measures.values()] for name in ("paco", "npaco"))
        saved = [percent_saved(ours, theirs) for ours, theirs in zip(paco, npaco, strict=True)]
        printed = (published.TIME_SAVED.get(published.side_of(label) or 0),) if paper else ()
        rows.append((label, paco[0], npaco[0], *saved, *printed))
    if not rows:
        return None
    columns = [Column("map"), Column("PACO wall s", ".4f"), Column("NPACO wall s", ".4f")]
    columns += [Column(f"saved, {measure} (%)", ".2f") for measure in measures]
    if paper:
        columns.append(Column(f"saved (%): {published.LABEL}", ".2f", published=True))
    note = (
        "Medians over runs. Wall time depends on free cores and on the cost of starting two threads; the steps on the "
        "critical path (the longer colony of each stage) are what does not depend on the machine."
    ) + _company(compared)
    return Table("saved_time", "Time that PACO saves over NPACO", tuple(columns), tuple(rows), note)


def most_frequent(runs: Sequence[Record]) -> tuple[CellIndex, int] | None:
    """The auxiliary cell that most runs chose, the first in map order among equals, with its count."""
    counts = Counter(run.auxiliary_cell for run in runs if run.auxiliary_cell is not None)
    return min(counts.items(), key=lambda item: (-item[1], item[0])) if counts else None


def auxiliary_cells(groups: Groups, *, paper: bool) -> Table | None:
    """Auxiliary cells of the algorithms that have one; None where none has."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        for algorithm, runs in group.items():
            favourite = most_frequent(runs)
            if favourite is None:
                continue
            cell, count = favourite
            row: tuple[Value, ...] = (label, algorithm, str(cell), 100 * count / len(runs))
            row += (len({run.auxiliary_cell for run in runs if run.auxiliary_cell}),)
            if paper:
                row += _printed_cell(label, runs)
            rows.append(row)
    if not rows:
        return None
    columns = [Column("map"), Column("algorithm"), Column("most frequent (row, col)"), Column("share (%)", ".0f")]
    columns.append(Column("different cells", "d"))
    if paper:
        columns += [
            Column("printed (row, col)", published=True),
            Column("printed (x, y)", published=True),
            Column("runs with the printed one (%)", ".0f"),
        ]
    note = "Rows and columns from 0 at the top left. Shares are of all runs."
    return Table("auxiliary_cells", "Auxiliary cells", tuple(columns), tuple(rows), note)


def _printed_cell(label: str, runs: Sequence[Record]) -> tuple[Value, ...]:
    side = published.side_of(label)
    if side is None:
        return (None, None, None)
    cell, point = published.AUXILIARY[side]
    return str(cell), f"({point[0]}, {point[1]})", 100 * sum(run.auxiliary_cell == cell for run in runs) / len(runs)


def comparisons(groups: Groups) -> Table | None:
    """Paired comparisons of algorithms on each map; None where there is nothing to pair."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        found = {}
        for one, other in _pairs(list(group)):
            left, right = _by_seed(group[one], group[other])
            if left:
                found[one, other] = statistics.paired(left, right)
        corrected = statistics.holm([outcome.p for outcome in found.values()])
        for ((one, other), outcome), p in zip(found.items(), corrected, strict=True):
            shorter = one if outcome.favours_first else other
            verdict = f"{shorter} shorter" if p < statistics.ALPHA else "no difference shown"
            size = statistics.magnitude(outcome.a12)
            tally = (outcome.shorter, outcome.equal, outcome.longer)
            rows.append((label, one, other, outcome.pairs, *tally, outcome.a12, size, outcome.p, p, verdict))
    if not rows:
        return None
    columns = (
        Column("map"),
        Column("first"),
        Column("second"),
        Column("seeds", "d"),
        Column("first shorter", "d"),
        Column("equal", "d"),
        Column("first longer", "d"),
        Column("A12", ".3f"),
        Column("effect"),
        Column("p", ".2g"),
        Column("p (Holm)", ".2g"),
        Column(f"at {100 * statistics.ALPHA:.0f} %"),
    )
    note = (
        "Lengths of runs of the same seed; Wilcoxon's signed-rank test, two-sided, corrected after Holm over the pairs "
        "of a map. A run without a path ranks last, equal to other such runs. A12 (Vargha & Delaney): the probability "
        "that a run of the first is shorter than one of the second, ties half."
    )
    if any(len(group) > ALL_PAIRS for group in groups.values()):
        note += f" Of more than {ALL_PAIRS} algorithms on a map, only the first is compared, with each other one."
    return Table("comparisons", "Paired comparisons", columns, tuple(rows), note)


def _pairs(names: list[str]) -> list[tuple[str, str]]:
    return list(combinations(names, 2)) if len(names) <= ALL_PAIRS else [(names[0], other) for other in names[1:]]


def _by_seed(one: list[Record], other: list[Record]) -> tuple[list[float], list[float]]:
    """Lengths of both in the seeds that both have."""
    left, right = ({run.seed: run for run in runs} for runs in (one, other))
    seeds = sorted(left.keys() & right.keys())
    return lengths([left[seed] for seed in seeds]), lengths([right[seed] for seed in seeds])


def ranks(groups: Groups) -> tuple[statistics.Ranks | None, str, dict[str, list[float]]]:
    """Friedman's test over the blocks that all algorithms have, what a block is, and the blocks themselves.

    With ten maps or more a block is a map, its value the median length; with fewer, the runs of one seed on one
    map, and the answer concerns these maps only.
    """
    names = list(dict.fromkeys(name for group in groups.values() for name in group))
    table: dict[str, list[float]] = {name: [] for name in names}
    maps = [group for group in groups.values() if len(group) == len(names)]
    by_map = len(maps) >= MANY_MAPS
    for group in maps:
        if by_map:
            for name in names:
                table[name].append(float(statistics.quantiles(lengths(group[name]), (0.5,))[0]))
            continue
        runs = {name: {run.seed: run for run in group[name]} for name in names}
        for seed in sorted(set.intersection(*(set(by_seed) for by_seed in runs.values()))):
            for name in names:
                table[name] += lengths([runs[name][seed]])
    block = (
        "a block is a map, its value the median length"
        if by_map
        else "a block is one seed on one map, so that the answer concerns these maps and not maps at large"
    )
    return statistics.friedman(table), block, table


def mean_ranks(found: statistics.Ranks, block: str) -> Table:
    """The mean ranks of Friedman's test."""
    note = (
        f"Friedman's test over {found.blocks} blocks ({block}): chi-squared {found.statistic:.2f}, p {found.p:.2g}. "
        f"Mean ranks further apart than {found.critical_difference:.3f} differ at "
        f"{100 * statistics.ALPHA:.0f} % (Nemenyi). A run without a path ranks last."
    )
    columns = (Column("algorithm"), Column("mean rank", ".3f"))
    return Table("mean_ranks", "Mean ranks", columns, tuple(found.mean_ranks.items()), note)


BEST_TOLERANCE = 5e-4  #: Cells: the paper prints 29.2132 and 29.2133 for one length.
MEAN_TOLERANCE = 0.5  #: Per cent.


def reached(groups: Groups) -> Table | None:
    """Each printed length beside ours, and whether it is reached; None where nothing printed has a counterpart."""
    rows: list[tuple[Value, ...]] = []
    for label, group in groups.items():
        for algorithm, runs in group.items():
            key = (published.side_of(label) or 0, algorithm)
            if key not in published.PRINTED:
                continue
            found = statistics.summary(lengths(runs), optimum_of(runs))
            printed = published.PRINTED[key]
            for figure in ("best", "mean"):
                ours = getattr(found, figure) if found.arrived else math.inf
                theirs = getattr(printed, figure) if printed else math.inf
                off = 100 * (ours / theirs - 1) if math.isfinite(ours) and math.isfinite(theirs) else None
                row = (label, algorithm, figure, theirs, ours, off, verdict(figure, ours, theirs))
                rows.append((*row, f"{found.arrived} of {found.runs}"))
    if not rows:
        return None
    columns = (
        Column("map"),
        Column("algorithm"),
        Column("figure"),
        Column(published.LABEL, ".4f", published=True),
        Column("ours", ".4f"),
        Column("ours longer by (%)", "+z.2f"),
        Column("verdict"),
        Column("runs with a path"),
    )
    note = (
        f"Best: reached within {BEST_TOLERANCE} cells, which is the paper's own rounding. Mean: reached within "
        f"{MEAN_TOLERANCE} %; ours is of the runs with a path. Seconds are not compared: other machines, other code."
    )
    return Table("reached", "Printed lengths, and ours", columns, tuple(rows), note)


def verdict(figure: str, ours: float, theirs: float) -> str:
    """Whether a printed "best" or "mean" is reached; inf means "no path"."""
    if math.isinf(ours) or math.isinf(theirs):
        return "as printed: no path" if ours == theirs else "path, none printed" if math.isinf(theirs) else "no path"
    tolerance = BEST_TOLERANCE if figure == "best" else MEAN_TOLERANCE / 100 * theirs
    if abs(ours - theirs) <= tolerance:
        return "reached"
    return "shorter than printed" if ours < theirs else "not reached"


def runs_csv(records: Sequence[Record]) -> str:
    """All records as one table, nothing left out: tuples and mappings as JSON, empty for None."""
    names = [field.name for field in fields(Record)]
    rows = [[_plain(getattr(record, name)) for name in names] for record in records]
    return _csv(names, rows)


def _plain(value: object) -> Value:
    if isinstance(value, tuple | dict):
        return json.dumps(value, separators=(",", ":"))
    return value if value is None or isinstance(value, str | int | float) else str(value)
