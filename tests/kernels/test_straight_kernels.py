"""Fewest turns against a slow twin that tries every order of the moves between every two cells of a path."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

import antnav as an
from antnav.kernels import straight_kernels
from antnav.world.moves import STEPS

#: Moves in the order of the compass, each beside its neighbours.
COMPASS = [STEPS[k] for k in (0, 1, 2, 4, 7, 6, 5, 3)]
Cell = tuple[int, int]


def winding_path(seed: int) -> tuple[an.Problem, list[int]]:
    """A random path whose bearing changes now and then, between random obstacles; and the numbers of its moves."""
    rng = np.random.default_rng(seed)
    bearing, word = int(rng.integers(8)), []
    for _ in range(rng.integers(1, 4)):
        word += [(bearing + int(aside)) % 8 for aside in rng.integers(0, 2, rng.integers(1, 7))]
        bearing += int(rng.integers(-2, 3))
    places = np.cumsum([(0, 0), *(COMPASS[k] for k in word)], axis=0)
    places -= places.min(axis=0) - 2
    cells = (rng.random(places.max(axis=0) + 3) < rng.choice([0, 0.2, 0.5])).astype(np.uint8)
    cells[tuple(places.T)] = 0
    ends = tuple(places[0].tolist()), tuple(places[-1].tolist())
    return an.Problem.from_cells(an.GridMap(cells), *ends, corner_rule="allow"), word


def walked(problem: an.Problem, start: Cell, word: list[int] | tuple[int, ...]) -> list[Cell] | None:
    """The cells that moves lead through; None where one of them is not legal."""
    cells = [start]
    for k in word:
        row, col = cells[-1]
        if not problem.moves[row + 1, col + 1] >> STEPS.index(COMPASS[k]) & 1:
            return None
        cells.append((row + COMPASS[k][0], col + COMPASS[k][1]))
    return cells


def turns_of(word: list[int] | tuple[int, ...]) -> int:
    return sum(a != b for a, b in itertools.pairwise(word))


def is_stretch(word: list[int]) -> bool:
    """Whether all moves are in one direction or in two neighbouring ones."""
    kinds = sorted(set(word))
    return len(kinds) == 1 or (len(kinds) == 2 and kinds[1] - kinds[0] in (1, 7))


def orders(word: list[int]) -> set[tuple[int, ...]]:
    """Every order of the moves of a stretch."""
    kinds = sorted(set(word))
    places = itertools.combinations(range(len(word)), word.count(kinds[0]))
    return {tuple(kinds[0] if i in chosen else kinds[-1] for i in range(len(word))) for chosen in places}


def fewest(problem: an.Problem, word: list[int]) -> int:
    """Fewest turns with which the path's end is reached, from each cell of the path to each later one in any order."""
    cells = walked(problem, problem.start_cell, word)
    least: list[dict[int, int]] = [dict.fromkeys(range(8), 0), *({} for _ in word)]  # by the direction of arrival
    for i, j in itertools.combinations(range(len(cells)), 2):
        for order in orders(word[i:j]) if is_stretch(word[i:j]) else ():
            if walked(problem, cells[i], order):
                turns = turns_of(order) + min(t + (k != order[0]) for k, t in least[i].items())
                least[j][order[-1]] = min(turns, least[j].get(order[-1], turns))
    return min(least[-1].values())


def flat(problem: an.Problem, cells: list[Cell]) -> np.ndarray:
    return np.array([problem.to_flat(cell) for cell in cells], np.int32)


def word_of(problem: an.Problem, path: np.ndarray) -> list[int]:
    return [COMPASS.index(tuple(move)) for move in np.diff(problem.from_flat(path), axis=0).tolist()]


def bent_once(problem: an.Problem, word: list[int]) -> list[int]:
    """One stretch after the other, as long as can be: sorted where it turns more than once and the map allows it."""
    bent: list[int] = []
    cell, first = problem.start_cell, 0
    while first < len(word):
        last = max(j for j in range(first + 1, len(word) + 1) if is_stretch(word[first:j]))
        piece = word[first:last]
        if turns_of(piece) > 1:
            one, other = piece[0], next(k for k in piece if k != piece[0])
            sortings = [sorted(piece, key=lambda k: k != one), sorted(piece, key=lambda k: k != other)]
            sortings = sortings[::-1] if bent[-1:] == [other] else sortings
            piece = next((each for each in sortings if walked(problem, cell, each)), piece)
        bent += piece
        cell, first = walked(problem, cell, piece)[-1], last
    return bent


@settings(max_examples=200, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1))
@example(seed=367)  # a row of a lattice in which nothing leads on
def test_fewest_turns_equal_the_twins(seed: int) -> None:
    problem, word = winding_path(seed)
    path = flat(problem, walked(problem, problem.start_cell, word))
    straight = straight_kernels.fewest_turns(path, problem.flat_moves, problem.width)
    found = word_of(problem, straight)
    assert walked(problem, problem.start_cell, found)
    assert (sorted(found), straight[0], straight[-1]) == (sorted(word), path[0], path[-1])

    bearing = straight_kernels._bearings(path, problem.width)
    assert bearing.tolist() == word
    steps = np.array([row * problem.width + col for row, col in STEPS])
    straight_kernels._bent_once(path, bearing, problem.flat_moves, steps)
    assert bearing.tolist() == word_of(problem, path) == bent_once(problem, word)
    assert turns_of(found) == fewest(problem, bearing.tolist()) <= fewest(problem, word)
