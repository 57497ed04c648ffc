"""Fewest turns at the same length, compiled: a path's moves are put into another order where the map allows it.

Of moves in two neighbouring directions, one straight and one diagonal, every order leads to the same cell and is as
short as can be. So a stretch of a path that has only such moves spans a lattice, a moves one way and b the other, and
each way through the lattice may take its place. Stretches overlap where the path keeps one direction.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from antnav.kernels.jit import jit

#: Moves of `moves.STEPS` in the order of the compass, and where each of them stands in it.
_COMPASS = np.array([0, 1, 2, 4, 7, 6, 5, 3], np.int64)
_BEARING = np.array([0, 1, 2, 7, 3, 6, 5, 4], np.int64)
_NEVER = 1 << 30
#: How a point of a lattice was reached with the fewest turns by a last move of either direction, in two bits each: the
#: move before had the same direction, the stretch's other one, or none of both; and whether the path was there already.
_SAME, _TURNED, _ELSEWHERE, _GIVEN = 0, 1, 2, 16


class _Program(NamedTuple):
    """The tables of a dynamic program over the places of a path."""

    stretches: np.ndarray  #: int64 (n, 4), first and last place, the two directions
    wide: np.ndarray  #: int64 (n,), columns of the stretch's lattice
    begins: np.ndarray  #: int64 (n + 1,), where the lattice begins in `how`
    how: np.ndarray  #: uint8, of each point of the lattices
    turns: np.ndarray  #: int32 (k, 8), fewest turns to a place, by the direction of arrival
    by: np.ndarray  #: int32 (k, 8), the stretch that brought them


@jit
def _bearings(path, width):
    """Compass bearing of each move."""
    bearing = np.empty(path.size - 1, np.int64)
    for i in range(path.size - 1):
        step = path[i + 1] - path[i]
        row = 1 if step > 1 else -1 if step < -1 else 0
        k = 3 * (row + 1) + step - row * width + 1
        bearing[i] = _BEARING[k if k < 4 else k - 1]
    return bearing


@jit
def _stretch(bearing, first):
    """The longest stretch from a place on with moves in two neighbouring directions.

    Returns
    -------
    (last, one, other, following)
        Its last place; its directions; where the next stretch begins.
    """
    one = other = bearing[first]
    last = tail = first  # since `tail` the direction is that of the last move
    while last < bearing.size:
        now = bearing[last]
        if now not in (one, other):
            if one != other or (now - one) % 8 not in (1, 7):
                break
            other = now
        if last > first and now != bearing[last - 1]:
            tail = last
        last += 1
    following = last
    if last < bearing.size and (bearing[last] - bearing[last - 1]) % 8 in (1, 7):
        following = tail
    return last, one, other if other != one else (one + 1) % 8, following


@jit
def _stretches(bearing):
    """Every stretch: first and last place, the two directions."""
    found = np.empty((bearing.size, 4), np.int64)
    count = 0
    first = 0
    while first < bearing.size:
        last, one, other, following = _stretch(bearing, first)
        found[count, 0], found[count, 1], found[count, 2], found[count, 3] = first, last, one, other
        count += 1
        first = bearing.size if last == bearing.size else following
    return found[:count]


@jit
def _bent_once(path, bearing, moves, steps):
    """Replace, in place, stretches by the same moves sorted by direction, where that is legal: one turn each."""
    first = 0
    while first < bearing.size:
        last, one, other, _ = _stretch(bearing, first)
        inner = a = 0
        for i in range(first, last):
            a += bearing[i] == one
            inner += i > first and bearing[i] != bearing[i - 1]
        for attempt in range(2 if inner > 1 else 0):
            begin, end = (one, other) if attempt == (first > 0 and bearing[first - 1] == other) else (other, one)
            count = a if begin == one else last - first - a
            cell = path[first]
            for i in range(first, last):
                k = _COMPASS[begin if i - first < count else end]
                if not moves[cell] >> k & 1:
                    break
                cell += steps[k]
            if cell == path[last]:
                for i in range(first, last):
                    bearing[i] = begin if i - first < count else end
                    path[i + 1] = path[i] + steps[_COMPASS[bearing[i]]]
                break
        first = last


@jit
def _elsewhere(turns, place, one, other):
    """Fewest turns with which a place is reached in any but two directions, and the direction."""
    best, way = _NEVER, -1
    for bearing in range(8):
        if bearing not in (one, other) and turns[place, bearing] < best:
            best, way = turns[place, bearing], bearing
    return best, way


@jit
def _along(turns, bearing, first, last, one, other, known):
    """Fewest turns with which the path, as it is, comes to the end of a stretch."""
    by_one, by_other = turns[first, one], turns[first, other]
    elsewhere = _elsewhere(turns, first, one, other)[0]
    for i in range(first, last):
        if bearing[i] == one:
            by_one, by_other = min(by_one, by_other + 1, elsewhere + 1), _NEVER
        else:
            by_one, by_other = _NEVER, min(by_other, by_one + 1, elsewhere + 1)
        by_one, by_other = min(by_one, turns[i + 1, one]), min(by_other, turns[i + 1, other])
        elsewhere = _elsewhere(turns, i + 1, one, other)[0] if i < known else _NEVER
    return by_one if bearing[last - 1] == one else by_other


@jit
def _cheapest(same, turned, elsewhere):
    """Turns after a further move in the direction `same`, and which of the three arrivals it follows."""
    if same <= turned + 1 and same <= elsewhere + 1:
        return same, _SAME
    return (turned + 1, _TURNED) if turned <= elsewhere else (elsewhere + 1, _ELSEWHERE)


@jit
def fewest_turns(path, moves, width):
    """The path with the fewest turns of those that put a path's moves in another order between cells that it keeps.

    A dynamic program over the places of the path and the direction of arrival, and within each stretch over its
    lattice. What cannot have fewer turns than the path itself is not followed.

    Parameters
    ----------
    path : int32 (k,)
        Flat cells, each next to the one before.

    Returns
    -------
    int32 (k,)
    """
    path = path.copy()
    if path.size < 3:
        return path
    steps = np.array([-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1], np.int64)
    bearing = _bearings(path, width)
    _bent_once(path, bearing, moves, steps)
    program = _new_program(path, bearing)
    for number in range(program.wide.size):
        _through(program, number, path, bearing, moves, steps)
    return _walked_back(program, path, bearing, steps)


@jit
def _new_program(path, bearing):
    stretches = _stretches(bearing)
    wide = np.ones(stretches.shape[0], np.int64)
    begins = np.zeros(stretches.shape[0] + 1, np.int64)
    for number in range(stretches.shape[0]):
        first, last, one, _ = stretches[number]
        for i in range(first, last):
            wide[number] += bearing[i] == one
        begins[number + 1] = begins[number] + wide[number] * (last - first - wide[number] + 2)
    turns = np.full((path.size, 8), _NEVER, np.int32)
    turns[0] = 0
    by = np.full((path.size, 8), -1, np.int32)
    return _Program(stretches, wide, begins, np.empty(begins[-1], np.uint8), turns, by)


@jit
def _noted(runs, count, begin, end):
    """Note columns of a row that lead on; returns the number of runs."""
    if count > 0 and runs[count - 1, 1] == begin:
        runs[count - 1, 1] = end
        return count
    runs[count, 0], runs[count, 1] = begin, end
    return count + 1


@jit
def _through(program, number, path, bearing, moves, steps):
    """Carry the program through the lattice of one stretch, row by row; only points that lead on are looked at.

    All in one: calls for each run of a row take a quarter of the time.
    """
    turns, by = program.turns, program.by
    first, last, one, other = program.stretches[number]
    wide = program.wide[number]
    a, b = wide - 1, last - first - wide + 1
    one_move, other_move = _COMPASS[one], _COMPASS[other]
    known = program.stretches[number - 1, 1] if number > 0 else 0  # last place that other stretches have been to
    one_bit, other_bit = 1 << one_move, 1 << other_move
    along, across = steps[one_move], steps[other_move]
    enough = _along(turns, bearing, first, last, one, other, known)
    costs = np.empty((2, wide, 2), np.int32)  # of two rows: arriving by the one move, by the other
    from_elsewhere = np.empty(wide, np.int32)  # of the path's places, in their columns
    runs = np.empty((2, wide + 1, 2), np.int32)  # of two rows: columns that lead on, first one and the one after
    count = 0
    place, column = first, 0  # where the path is in this row
    begun = 0  # where it was when the row before began; in this row from `onset` on
    for v in range(b + 1):
        now, before = costs[v & 1], costs[1 - (v & 1)]
        ours, above = runs[v & 1], runs[1 - (v & 1)]
        count_above, count, look = count, 0, 0
        onset = column
        u = 0
        elsewhere = _NEVER
        enough_one = enough - (v < b)
        row = path[first] + v * across
        marks = program.begins[number] + v * wide
        while True:
            while look < count_above and above[look, 1] <= u:
                look += 1
            near = above[look, 0] if look < count_above else wide
            beside = count > 0 and ours[count - 1, 1] == u
            if not beside:
                u = max(u, min(near, column if column >= u else wide))
            if u > a:
                break
            cell = row + u * along
            if u < begun or column + 1 < u < a:  # neither it nor what leads to it is of the path
                until = min(above[look, 1] if near <= u else near, begun if u < begun else a)
                by_one = by_other = _NEVER
                if beside:
                    by_one, by_other = now[u - 1, 0], now[u - 1, 1]
                since = u
                while u < until:
                    mark = by_one > by_other + 1
                    by_one = min(by_one, by_other + 1) if moves[cell - along] & one_bit else _NEVER
                    by_other = _NEVER
                    if near <= u and moves[cell - across] & other_bit:
                        by_other = min(before[u, 1], before[u, 0] + 1)
                        mark |= (before[u, 1] > before[u, 0] + 1) << 2
                    program.how[marks + u] = mark  # _SAME or _TURNED of either
                    now[u, 0], now[u, 1] = by_one, by_other
                    u += 1
                    cell += along
                    if by_one > enough_one and by_other >= enough:
                        by_one = by_other = _NEVER
                        if since < u - 1:
                            count = _noted(ours, count, since, u - 1)
                        since = u
                        if near >= u:
                            break
                if since < u:
                    count = _noted(ours, count, since, u)
                elsewhere = _NEVER
                continue
            by_one = by_other = _NEVER
            mark = 0
            if beside and moves[cell - along] & one_bit:
                by_one, mark = _cheapest(now[u - 1, 0], now[u - 1, 1], elsewhere)
            if near <= u and moves[cell - across] & other_bit:
                around = from_elsewhere[u] if begun <= u <= onset else _NEVER
                by_other, source = _cheapest(before[u, 1], before[u, 0], around)
                mark |= source << 2
            elsewhere = _NEVER
            if u == column:
                if by_one < turns[place, one]:
                    turns[place, one], by[place, one] = by_one, number
                else:
                    by_one, mark = turns[place, one], mark | _GIVEN
                if by_other < turns[place, other]:
                    turns[place, other], by[place, other] = by_other, number
                else:
                    by_other, mark = turns[place, other], mark | 2 * _GIVEN
                if place <= known:
                    elsewhere = _elsewhere(turns, place, one, other)[0]
                from_elsewhere[u] = elsewhere
                if place < last:
                    column += bearing[place] == one
                    place += 1
            program.how[marks + u] = mark
            if min(by_one + (v < b), by_other + (u < a), elsewhere + 1) <= enough:
                now[u, 0], now[u, 1] = by_one, by_other
                count = _noted(ours, count, u, u + 1)
            u += 1
        begun = onset


@jit
def _walked_back(program, path, bearing, steps):
    """The path that the program found, from its end to its start."""
    straight = path.copy()
    at = path.size - 1
    arrival = np.argmin(program.turns[at])
    while at > 0:
        number = program.by[at, arrival]
        first, _, one, other = program.stretches[number]
        u = v = 0
        for i in range(first, at):
            u += bearing[i] == one
            v += bearing[i] == other
        while True:
            mark = program.how[program.begins[number] + v * program.wide[number] + u]
            at_one = arrival == one
            if mark & (_GIVEN if at_one else 2 * _GIVEN):
                break
            source = mark & 3 if at_one else mark >> 2 & 3
            u, v = u - at_one, v - (not at_one)
            straight[at - 1] = straight[at] - steps[_COMPASS[arrival]]
            at -= 1
            if source == _ELSEWHERE:
                arrival = _elsewhere(program.turns, at, one, other)[1]
                break
            if source == _TURNED:
                arrival = other if at_one else one
    return straight
