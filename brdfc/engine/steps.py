"""The steps of a straight program, on registers: planar blocks that stay in the processor's cache.

They round as the interpreter's kernels do. The common ones write into a register; all others go
through the kernels themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from brdfc.engine.kernels import Values, compute
from brdfc.engine.straight import Straight

Buffer = NDArray[np.float32]


class Machine:
    """Registers for blocks of at most so many pixels, and the steps on them."""

    def __init__(self, registers: int, pixels: int) -> None:
        self.registers = [np.empty(pixels, np.float32) for _ in range(registers)]
        self.wide = np.empty(pixels, np.float64)
        self.mask = np.empty(pixels, np.bool_)

    def run(self, straight: Straight, inputs: Sequence[Values], count: int) -> list[Values]:
        """Outputs, each (count,) or a constant, of inputs (count,); of the registers, so that they
        are good until the next run."""
        registers = [r[:count] for r in self.registers]
        for place in straight.read:
            registers[place][:] = inputs[place]
        for step in straight.steps:
            arguments = [registers[a] if isinstance(a, int) else a for a in step.arguments]
            if step.function is not None:
                found = step.function([np.asarray(a) for a in arguments])
                for target, values in zip(step.targets, found, strict=True):
                    registers[target][:] = values
                continue
            out = registers[step.targets[0]]
            operation = _WRITTEN.get(step.name)
            if operation is not None:
                operation(self, out, *arguments)
            else:
                out[:] = compute(step.name, *(np.asarray(a) for a in arguments))
        return [registers[o] if isinstance(o, int) else np.asarray(o) for o in straight.outputs]


Operation = Callable[..., None]


def _plain(function: np.ufunc) -> Operation:
    return lambda _machine, out, *arguments: function(*arguments, out=out)


def _in_float64(function: np.ufunc) -> Operation:
    """Computed in float64 and rounded once, as the interpreter does."""

    def operation(machine: Machine, out: Buffer, *arguments: Buffer) -> None:
        wide = machine.wide[: len(out)]
        function(*arguments, out=wide, dtype=np.float64)
        np.copyto(out, wide, casting="same_kind")

    return operation


def _turned(machine: Machine, out: Buffer, x: Buffer, y: Buffer) -> None:
    """The angle of (x, y), y nearer the top of the stack."""
    _in_float64(np.arctan2)(machine, out, y, x)


def _divide(machine: Machine, out: Buffer, x: Buffer, y: Buffer) -> None:
    np.divide(x, y, out=out)
    if np.ndim(y) == 0:
        if y == 0:
            out[:] = 0
        return
    mask = np.equal(y, 0, out=machine.mask[: len(out)])
    if mask.any():
        out[mask] = 0


def _square(_machine: Machine, out: Buffer, x: Buffer) -> None:
    np.multiply(x, x, out=out)


def _cube(_machine: Machine, out: Buffer, x: Buffer) -> None:
    np.multiply(x, x, out=out)
    np.multiply(out, x, out=out)


def _lesser(machine: Machine, out: Buffer, x: Buffer, y: Buffer) -> None:
    mask = np.less(x, y, out=machine.mask[: len(out)])
    np.copyto(out, y)
    np.copyto(out, x, where=mask)


def _greater(machine: Machine, out: Buffer, x: Buffer, y: Buffer) -> None:
    mask = np.greater(x, y, out=machine.mask[: len(out)])
    np.copyto(out, y)
    np.copyto(out, x, where=mask)


def _choose(machine: Machine, out: Buffer, condition: Buffer, a: Buffer, b: Buffer) -> None:
    mask = np.greater_equal(condition, np.float32(0.5), out=machine.mask[: len(out)])
    np.copyto(out, b)
    np.copyto(out, a, where=mask)


def _repeated(function: np.ufunc) -> Operation:
    """Left to right, rounding after each."""

    def operation(_machine: Machine, out: Buffer, first: Buffer, *others: Buffer) -> None:
        np.copyto(out, first)
        for other in others:
            function(out, other, out=out)

    return operation


_WRITTEN: dict[str, Operation] = {
    "add": _plain(np.add),
    "sub": _plain(np.subtract),
    "mul": _plain(np.multiply),
    "div": _divide,
    "neg": _plain(np.negative),
    "sqrt": _plain(np.sqrt),
    "sq": _square,
    "cb": _cube,
    "exp": _in_float64(np.exp),
    "ln": _in_float64(np.log),
    "log": _in_float64(np.log10),
    "sin": _in_float64(np.sin),
    "cos": _in_float64(np.cos),
    "tan": _in_float64(np.tan),
    "asin": _in_float64(np.arcsin),
    "acos": _in_float64(np.arccos),
    "atan": _in_float64(np.arctan),
    "cbrt": _in_float64(np.cbrt),
    "atn2": _turned,
    "vmin": _lesser,
    "vmax": _greater,
    "sum": _repeated(np.add),
    "prod": _repeated(np.multiply),
    "choose": _choose,
}
"""Operations that write into a register; all others go through the interpreter's kernels."""
