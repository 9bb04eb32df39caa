"""Names beside points: none over another, none outside, none over a mark where there is room."""

from __future__ import annotations

import random

import numpy as np

from brdfc.charts.labels import Box, Placed, place

FRAME = Box(0, 0, 400, 300)
SIZE = (50.0, 10.0)


def box(placed: Placed) -> Box:
    width, height = SIZE
    x, y = placed.x, placed.y
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def test_names_of_a_crowd_do_not_overlap() -> None:
    chance = random.Random(3)
    anchors = [(chance.uniform(100, 200), chance.uniform(20, 60)) for _ in range(15)]
    taken = [Box(x - 4, y - 4, x + 4, y + 4) for x, y in anchors]
    found = [p for p in place(anchors, [SIZE] * 15, anchors, taken, FRAME) if p]
    boxes = [box(p) for p in found]
    assert len(boxes) >= 12
    assert all(b.inside(FRAME) for b in boxes)
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert not any(b.overlaps(t) for b in boxes for t in taken)


def test_a_name_goes_where_it_covers_nothing() -> None:
    marks = [(x, y) for x in range(200, 270, 5) for y in range(100, 200, 5)]
    (placed,) = place([(195.0, 150.0)], [SIZE], marks, [], FRAME)
    assert placed is not None
    assert box(placed).holds(np.array(marks, dtype=float)) == 0


def test_a_name_without_room_is_left_out() -> None:
    assert place([(5.0, 5.0)], [SIZE], [], [], Box(0, 0, 20, 20)) == [None]


def test_a_name_far_away_gets_a_line() -> None:
    crowded = [Box(150, 100, 250, 200)]
    (placed,) = place([(200.0, 185.0)], [SIZE], [], crowded, FRAME)
    assert placed is not None
    assert placed.far
