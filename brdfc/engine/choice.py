"""Which engine a run is worth, from what they were measured to take."""

from __future__ import annotations

import os
import sys
from enum import Enum

from brdfc.engine.functions import FUNCTIONS
from brdfc.engine.straight import Straight
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError


class Engine(Enum):
    """How chains are run: machine code, NumPy on blocks, one operator at a time, or what takes the
    least time for the pixels at hand."""

    AUTO = "auto"
    COMPILED = "compiled"
    BLOCKS = "blocks"
    INTERPRETER = "interpreter"


def engine_named(given: Engine | str) -> Engine:
    """The engine a user means; ValueGivenError, with the nearest, for another text."""
    known = [e.value for e in Engine]
    if isinstance(given, str) and given not in known:
        raise ValueGivenError(
            f"there is no engine '{given}'", hint=did_you_mean(given, known) or ", ".join(known)
        )
    return Engine(given)


LOADING, COMPILING, COMPILING_STEP, LIKE_STEPS = 0.03, 0.004, 0.00014, 12
"""Seconds: to load the compiler, to compile a chain, and for each of its steps; a function is like
so many steps."""
BLOCKS_STEP, BLOCKS_FUNCTION = 0.25e-9, 4e-9
COMPILED_STEP, COMPILED_FUNCTION = 0.05e-9, 1.0e-9
"""Seconds a pixel on one thread; `benchmarks/engine.py` and `benchmarks/scaling.py` show them."""


def compiled_is_quicker(straight: Straight, pixels: int, kept: bool) -> bool:
    """Whether machine code is done sooner, with what it takes to make it where it is not kept."""
    functions = sum(
        step.name in FUNCTIONS or step.name.startswith("lab") for step in straight.steps
    )
    plain = len(straight.steps) + len(straight.read) + len(straight.outputs) - functions
    saved = plain * (BLOCKS_STEP - COMPILED_STEP) + functions * (
        BLOCKS_FUNCTION - COMPILED_FUNCTION
    )
    making = 0.0
    if not kept:
        making = COMPILING + COMPILING_STEP * (len(straight.steps) + LIKE_STEPS * functions)
        making += 0.0 if "llvmlite" in sys.modules else LOADING
    return pixels * saved > making


def threads_at_hand() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
