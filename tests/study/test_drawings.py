"""The figures of a report: their names, captions and bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

from antnav.report import pictures
from antnav.study import comparison, drawings, series
from antnav.study.groups import grouped
from antnav.study.paper import SWAPPED
from tests.study.made_up import made_up, paper_like, problems, sweep_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

pytest.importorskip("matplotlib")


def test_a_dollar_in_a_label_is_no_formula() -> None:
    groups = grouped([made_up(name, seed, 30.0) for name in ("$\\no{$", "b", "c") for seed in (0, 1)])
    found, _, table = comparison.ranks(groups)
    assert found is not None
    shown = [*drawings.study_figures(groups, problems(("equiv20",))), drawings.gap_figure(groups)]
    for drawing in [*shown, drawings.rank_figure(found, list(table))]:
        assert "$\\no{$" in written_on(drawing.draw())


def written_on(figure: Figure) -> str:
    """All texts of a figure that are drawn as they stand."""
    from matplotlib.text import Text

    figure.draw_without_rendering()  # raises where a formula cannot be read
    return " ".join(text.get_text() for text in figure.findobj(Text) if not text.get_parse_math())


def test_what_is_averaged_over_is_said() -> None:
    sweep = sweep_of("paco", rho=(0.1, 0.2), beta=(5, 7), ants=(8, 9))
    shown = drawings.sweep_figures({"m": {}}, series.planes(sweep))
    assert [drawing.caption.split(".")[-2].strip() for drawing in shown] == [
        "Averaged over ants",
        "Averaged over beta",
        "Averaged over rho",
    ]


def test_names_of_sweeps_are_short_and_differ() -> None:
    planes = [plane for name in ("paco+", "paco-", "x" * 300) for plane in series.planes(sweep_of(name, rho=(1, 2)))]
    names = [drawing.name for drawing in drawings.sweep_figures({"m" * 260: {}, "n": {}}, planes)]
    assert len(set(names)) == 6
    assert max(map(len, names)) < 80


def test_paper_figures_5_to_9_and_their_bytes() -> None:
    groups = grouped(paper_like(labels=("equiv20", "equiv30", "equiv40")))
    found = drawings.paper_figures(groups, problems(("equiv20", "equiv30", "equiv40")))
    assert [drawing.title.split(".")[0] for drawing in found] == [f"Figure {number}" for number in range(5, 10)]
    once, again = (pictures.render(found[2].draw, "svg") for _ in range(2))
    assert once == again
    ElementTree.fromstring(once)
    assert pictures.render(found[0].draw, "png")[:4] == b"\x89PNG"


def test_figures_5_and_6_show_the_matched_swap_and_say_what_luo_is() -> None:
    five, six, *_ = drawings.paper_figures(grouped(paper_like()), {})
    for drawing in (five, six):
        words = written_on(drawing.draw())
        assert "npaco, Luo's two rules" in words
        assert "luo, the whole preset" in words
        assert "nothing else differs" in drawing.caption
        assert "it is not the paper's comparison" in drawing.caption
    swapped = [record for record in paper_like() if record.algorithm != "luo"]
    assert "preset" not in drawings.paper_figures(grouped(swapped), {})[0].caption
    preset_alone = [record for record in paper_like() if record.algorithm != SWAPPED]
    assert drawings.paper_figures(grouped(preset_alone), {})[0].title.startswith("Figure 7")


def test_drawing_leaves_the_users_pyplot_alone() -> None:
    from matplotlib import pyplot as plt

    before = plt.get_fignums()
    pictures.render(drawings.gap_figure(grouped(paper_like())).draw, "svg")
    assert plt.get_fignums() == before
