"""Straight forms of chains, kept: an image comes in bands, and each is a run of the same chain."""

from __future__ import annotations

import os
from collections.abc import Mapping
from threading import Lock

from brdfc.calc.verify import verify
from brdfc.engine.kernels import Values
from brdfc.engine.straight import Straight, straighten
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Chain, Crooked, Route
from brdfc.source.errors import ProgramError

RECENT, RECENT_STEPS = 512, 200_000
"""Forms kept, those used last, and how many steps they have in all."""

_Key = tuple[tuple[int, ...], int, Interpolation, tuple[tuple[str, bytes | None], ...]]
_recent: dict[_Key, tuple[Chain, Straight | None]] = {}
"""By the elements themselves, which are kept with the form so that no other takes their place."""
_lock = Lock()


def straight_form(
    chain: Chain, channels: int, variables: Mapping[str, Values], interpolation: Interpolation
) -> Straight | None:
    """The straight form of a chain in a run, None where it has none; made once for runs alike.

    Raises ProgramError where a program cannot be proven safe or channels do not fit.
    """
    same = tuple(sorted((n, None if v.ndim else v.tobytes()) for n, v in variables.items()))
    key = (tuple(map(id, chain)), channels, interpolation, same)
    with _lock:
        if key in _recent:
            _recent[key] = _recent.pop(key)
            return _recent[key][1]
    _check(chain, channels)
    try:
        found: Straight | None = straighten(chain, channels, variables, interpolation)
    except Crooked:
        found = None
    with _lock:
        _recent[key] = chain, found
        while len(_recent) > 1 and (len(_recent) > RECENT or _held() > RECENT_STEPS):
            del _recent[next(iter(_recent))]
    return found


def _held() -> int:
    return sum(len(form.steps) for _, form in _recent.values() if form is not None)


def _check(chain: Chain, channels: int) -> None:
    for step in chain:
        wanted = (
            max((s for s in step.sources if s is not None), default=-1) + 1
            if isinstance(step, Route)
            else step.inputs
        )
        if wanted > channels or (not isinstance(step, Route) and wanted != channels):
            raise ProgramError(f"an element that takes {wanted} channels is given {channels}")
        channels = len(step.sources) if isinstance(step, Route) else step.outputs
        if not isinstance(step, Route):
            verify(step)


def _after_fork() -> None:
    """Another thread may have held the lock."""
    global _lock
    _lock = Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
