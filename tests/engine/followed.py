"""Programs followed with intervals in place of values, or with an engine's errors.

A trace (engine/trace.py) takes both sides of every branch and chooses, so that whatever stands in
place of a value never has to decide anything.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from interval_elements import bound_element, values_of
from interval_functions import FIXED, moved
from interval_rules import bound
from intervals import Floats, Interval, at, exact, place

from brdfc.calc.curves import Curve, CurveSet, FormulaSegment, SegmentedCurve
from brdfc.calc.program import Element, Matrix, Program
from brdfc.engine.kernels import compute
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Source, Trace, Value


@dataclass
class Followed(Trace):
    """One run of a program. held: what stands for each value that depends on a pixel."""

    held: dict[Source, Any] = field(default_factory=dict)

    @classmethod
    def run(
        cls, program: Program, pixels: Floats, environment: Mapping[str, float], **more: Any
    ) -> list[Any]:
        """What stands for each output, for pixels (n, channels)."""
        variables = {name: np.asarray(v, np.float32) for name, v in environment.items()}
        self = cls(program.inputs, variables, Interpolation.LINEAR, **more)
        for channel, source in enumerate(self.inputs):
            self.held[source] = self.known_value(pixels[:, channel])
        return [self.of(value) for value in self.follow((program,))]

    def of(self, value: Value) -> Any:
        return self.held[value] if isinstance(value, Source) else self.known_value(value)

    def hold(self, result: Any) -> Source:
        source = Source()
        self.held[source] = result
        return source

    def apply(self, name: str, *arguments: Value) -> Value:
        self.follow_more(10)
        return self.hold(self.operation(name, *map(self.of, arguments)))

    def element(self, element: Element, values: Sequence[Value]) -> list[Value]:
        if isinstance(element, (Program, Matrix)):
            return super().element(element, values)
        found = self.called(element, [self.of(v) for v in values])
        return [self.hold(result) for result in found]

    def known_value(self, values: Any) -> Any:
        raise NotImplementedError

    def operation(self, name: str, *arguments: Any) -> Any:
        raise NotImplementedError

    def called(self, element: Any, inputs: list[Any]) -> list[Any]:
        raise NotImplementedError


@dataclass
class Bounds(Followed):
    """Intervals that hold the results of every engine with good functions."""

    def known_value(self, values: Any) -> Interval:
        return exact(values)

    def operation(self, name: str, *arguments: Interval) -> Interval:
        return bound(name, *arguments)

    def called(self, element: Any, inputs: list[Interval]) -> list[Interval]:
        return bound_element(element, inputs)


@dataclass
class Engine(Followed):
    """An engine that computes; what others build on that err."""

    def known_value(self, values: Any) -> Floats:
        return np.asarray(values, np.float32)

    def operation(self, name: str, *arguments: Floats) -> Floats:
        return np.asarray(compute(name, *arguments))

    def called(self, element: Any, inputs: list[Floats]) -> list[Floats]:
        return values_of(element, inputs)


@dataclass
class Nearby(Engine):
    """Its functions give the nearest float or one beside it, at random."""

    random: np.random.Generator = field(default_factory=lambda: np.random.default_rng(5))

    def operation(self, name: str, *arguments: Floats) -> Floats:
        if name not in FIXED:
            return super().operation(name, *arguments)
        shape = np.broadcast_shapes(*(a.shape for a in arguments))
        ulps = self.random.integers(-1, 2, shape)
        return moved(name, FIXED[name](*arguments), arguments, ulps)[0]

    def called(self, element: Any, inputs: list[Floats]) -> list[Floats]:
        found = super().called(element, inputs)
        if not isinstance(element, CurveSet):
            return found
        return [
            at(place(y) + self.random.integers(-1, 2, y.shape)) if _formulas(c) else y
            for c, y in zip(element.curves, found, strict=True)
        ]


def _formulas(curve: Curve) -> bool:
    """Whether nothing of a curve is sampled."""
    return isinstance(curve, SegmentedCurve) and all(
        isinstance(s, FormulaSegment) for s in curve.segments
    )


@dataclass
class Wrong(Engine):
    """Its sine is off by a millionth, or a sum of two by a float."""

    operator: str = "sin"

    def operation(self, name: str, *arguments: Floats) -> Floats:
        right = super().operation(name, *arguments)
        if name != self.operator:
            return right
        return right + np.float32(1e-6) if name == "sin" else at(place(right) + 1)
