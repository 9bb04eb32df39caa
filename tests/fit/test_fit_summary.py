"""The figures of a summary, on generated measurements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from generated import generated

from brdfc.fit.summary import duplicates, floor, lines, reciprocity


def test_reciprocity_is_seen_and_its_breach() -> None:
    m = generated()
    found = reciprocity(m)
    assert found is not None
    assert (found.pairs, round(found.worst, 9)) == (6 * 5, 0)
    incident, reflection = np.degrees(m.directions[:, :2].T)
    breach = (np.round(incident) == 60) & (np.round(reflection) == 10)
    values = np.where(breach[:, None], m.values * 1.5, m.values)
    worse = reciprocity(replace(m, values=values))
    assert worse is not None
    assert worse.worst == pytest.approx(0.5 / 1.25)
    assert worse.worst_at[:2] == (10, 60)


def test_duplicates_floor_and_lines() -> None:
    m = generated()
    twice = replace(
        m,
        directions=np.concatenate([m.directions, m.directions[:7]]),
        values=np.concatenate([m.values, np.zeros((7, 3))]),
        weights=np.ones(len(m) + 7),
    )
    assert duplicates(m) == 0
    assert duplicates(twice) == 7
    assert floor(twice) == (0.0, 7)
    text = "\n".join(lines(twice))
    assert "duplicate    7 rows" in text
    assert "zero         21 values" in text
    assert "incidences   10, 30, 45, 60 degrees" in text
    assert "7 rows have the smallest value 0" in text
