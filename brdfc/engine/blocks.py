"""The usual way to run an element: without jumps where that can be, in blocks that fit the cache.

The results are the interpreter's, to the last bit (straight.py); only the time differs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike

from brdfc.calc.program import Element, Program
from brdfc.calc.verify import verify
from brdfc.engine import interpreter
from brdfc.engine.kernels import Values
from brdfc.engine.steps import Machine
from brdfc.engine.straight import Crooked, Straight, straighten
from brdfc.source.errors import ProgramError

_RECENT = 16
"""Straight forms kept: an image comes in bands, and each is a run of the same program."""
_Key = tuple[int, tuple[tuple[str, bytes | None], ...]]
_recent: dict[_Key, tuple[Program, Straight | None]] = {}
_one_at_a_time = Lock()


def _straight(program: Program, variables: Mapping[str, Values]) -> Straight | None:
    """The straight form of a program in a run, None where it has none; made once for runs alike.

    Raises ProgramError when the program cannot be proven safe.
    """
    same = tuple(sorted((n, None if v.ndim else v.tobytes()) for n, v in variables.items()))
    key = (id(program), same)
    known = _recent.get(key)
    if known is not None and known[0] is program:
        return known[1]
    verify(program)
    try:
        found: Straight | None = straighten(program, variables)
    except Crooked:
        found = None
    with _one_at_a_time:
        if len(_recent) >= _RECENT:
            del _recent[next(iter(_recent))]
        _recent[key] = program, found
    return found


def run(element: Element, pixels: ArrayLike, environment: Mapping[str, ArrayLike]) -> Values:
    """Apply an element to pixels; arguments, result and errors as for interpreter.run."""
    array = np.asarray(pixels, dtype=np.float32)
    if not isinstance(element, Program) or array.ndim == 0:
        return interpreter.run(element, array, environment)
    shape = array.shape[:-1]
    variables = {name: interpreter.variable(v, shape) for name, v in environment.items()}
    straight = _straight(element, variables)
    if straight is None:
        return interpreter.run(element, array, environment)
    if array.shape[-1] != element.inputs:
        raise ProgramError(f"{element.inputs} channels are needed, the array is {array.shape}")
    flat = array.reshape(math.prod(shape), element.inputs)
    result = np.empty((len(flat), element.outputs), dtype=np.float32)
    most = max(1, min(interpreter.BLOCK, interpreter.HELD // max(1, straight.registers)))
    step = min(most, max(1, len(flat)))
    machine = Machine(straight, step)
    differing = [variables[name] for name in straight.variables]
    with np.errstate(all="ignore"):
        for start in range(0, len(flat), step):
            block = flat[start : start + step]
            inputs = [block[:, channel] for channel in range(element.inputs)]
            inputs += [values[start : start + step] for values in differing]
            for channel, values in enumerate(machine.run(inputs, len(block))):
                result[start : start + step, channel] = values
    return result.reshape(*shape, element.outputs)
