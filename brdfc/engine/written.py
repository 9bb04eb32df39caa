"""What a trace writes down: values of each pixel, and the operations that give them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from brdfc.engine.kernels import Values


@dataclass(frozen=True, eq=False)
class Source:
    """A value of each pixel: an input by its place, or what an operation gives."""

    place: int = 0


Value = Source | np.float32
Function = Callable[[Sequence[Values]], list[Values]]
"""An element on a list of channels."""


@dataclass(frozen=True, eq=False)
class Operation:
    """An operation of kernels.py by its name, of one result, or an element by its function."""

    name: str
    arguments: tuple[Value, ...]
    results: tuple[Source, ...]
    function: Function | None = None


ELEMENT = "element"
"""The name of an operation that is an element's function."""


def identity(value: Value) -> object:
    """What tells values apart; constants by their bits: 0 and -0 are two."""
    return value if isinstance(value, Source) else value.tobytes()
