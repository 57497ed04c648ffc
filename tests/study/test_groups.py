"""Groups: their order, and what one group says."""

from __future__ import annotations

from antnav.study import groups
from antnav.study.groups import grouped
from tests.study.made_up import made_up


def test_groups_keep_the_order_of_maps_and_algorithms_and_sort_seeds() -> None:
    records = [made_up("b", 2, 9.0), made_up("a", 1, 9.0, label="m"), made_up("b", 0, 9.0)]
    groups = grouped(records)
    assert list(groups) == ["equiv20", "m"]
    assert [run.seed for run in groups["equiv20"]["b"]] == [0, 2]


def test_equally_frequent_cells_are_settled_by_map_order() -> None:
    runs = [made_up("paco", seed, 40.0, auxiliary_cell=cell) for seed, cell in enumerate([(5, 5), (2, 9)])]
    assert groups.most_frequent(runs) == ((2, 9), 1)
