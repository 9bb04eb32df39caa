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
MOST_COMPILED, MOST_REGISTERS = 8000, 500
"""Steps, functions counted as LIKE_STEPS, and registers that are compiled at most. Beyond them the
compiler's time grows as the square, and what does not fit registers needs a deep stack."""


def _counts(straight: Straight) -> tuple[int, int]:
    """Steps, inputs and outputs counted, and functions among them."""
    functions = sum(s.name in FUNCTIONS or s.name.startswith("lab") for s in straight.steps)
    return len(straight.steps) + len(straight.read) + len(straight.outputs), functions


def can_be_compiled(straight: Straight) -> bool:
    """Whether machine code is made of it at all: not of chains with curves or tables."""
    if any(step.function is not None for step in straight.steps):
        return False
    steps, functions = _counts(straight)
    heavy = steps + LIKE_STEPS * functions > MOST_COMPILED
    return not heavy and straight.registers <= MOST_REGISTERS


def saved(straight: Straight) -> float:
    """Seconds a pixel by which machine code is quicker than NumPy."""
    steps, functions = _counts(straight)
    plain = (steps - functions) * (BLOCKS_STEP - COMPILED_STEP)
    return plain + functions * (BLOCKS_FUNCTION - COMPILED_FUNCTION)


def making(straight: Straight) -> float:
    """Seconds that it takes to make machine code."""
    steps, functions = _counts(straight)
    loading = 0.0 if "llvmlite" in sys.modules else LOADING
    return loading + COMPILING + COMPILING_STEP * (steps + LIKE_STEPS * functions)


def threads_at_hand() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
