"""The usual way to run an element: without jumps where that can be, in blocks that fit the cache.

The results are the interpreter's, to the last bit (straight.py); only the time differs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from brdfc.calc.program import Element, Program
from brdfc.calc.verify import verify
from brdfc.engine import interpreter
from brdfc.engine.kernels import Values
from brdfc.engine.straight import Crooked, Machine, straighten
from brdfc.source.errors import ProgramError


def run(element: Element, pixels: ArrayLike, environment: Mapping[str, ArrayLike]) -> Values:
    """Apply an element to pixels; arguments, result and errors as for interpreter.run."""
    array = np.asarray(pixels, dtype=np.float32)
    if not isinstance(element, Program) or array.ndim == 0:
        return interpreter.run(element, array, environment)
    shape = array.shape[:-1]
    variables = {name: interpreter.variable(v, shape) for name, v in environment.items()}
    verify(element)
    try:
        straight = straighten(element, variables)
    except Crooked:
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
