"""How good a form is: its price, and its error in bits and in colour at points of every stratum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.price import price
from brdfc.calc.program import Program
from brdfc.codegen.estimate import estimated_price
from brdfc.codegen.nodes import Node
from brdfc.codegen.select import Binding, ChannelBinding, VariableBinding
from brdfc.engine.interpreter import run
from brdfc.judge.directions import directions
from brdfc.judge.graphs import Graphs
from brdfc.judge.problem import Problem
from brdfc.judge.strata import Points
from brdfc.lang.model import Quantity
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.intervals import LARGEST
from brdfc.symbolic.precise import PreciseEvaluation

SEEN = 1e-4
"""Errors in bits count where a value is at least this share of the peak at the same coefficients;
below that they cannot matter to anyone who can see the peak."""
TRIED, AGREEMENT = 64, 1e-8
"""The truth is computed in float64 where that agrees with 40 digits to a tenth of a float32's
unit, at so many of the points; else with 40 digits at all of them."""
FALSE_ZERO = 2.0**-100
"""A result of 0 where the value is larger than this is a false zero."""


@dataclass(frozen=True)
class Measured:
    """bits: log2(1 + units in the last place) at worst and in the mean, where values count; de:
    worst CIEDE2000; price: nanoseconds a pixel; worst_at: the point of worst bits."""

    bits: float
    mean_bits: float
    de: float
    price: float
    worst_at: int


class Judge:
    """Measures forms of one formula. truth: its exact values in high precision; quick: whether
    float64 is good enough for them, found out where it is not said (see float64_suffices)."""

    def __init__(self, problem: Problem, points: Points, quick: bool | None = None) -> None:
        exact = problem.exact
        self.exact, self.points, self.colorimetry = exact, points, problem.colorimetry
        self.quick = float64_suffices(exact, points) if quick is None else quick
        every = range(points.count)
        at = points.values
        self.truth = _quickly(exact, at) if self.quick else _precise(exact, points, every)
        peaks = [evaluate(exact, at) for at in _at_peak(points, problem.quantities)]
        peak = np.nanmax(np.abs(np.concatenate(peaks, axis=-1)), axis=-1, initial=0.0)
        self.seen = SEEN * np.minimum(peak, LARGEST)[:, None]
        self._weigh()
        self.graphs = _graphs(points, problem.bindings)
        self.usual = self.graphs.only(np.array([s == "uniform" for s in points.strata]))

    def _weigh(self) -> None:
        """Where the truth is known, where its digits count, and the unit in their last place."""
        size = np.abs(self.truth)
        self.known = np.asarray((size < LARGEST).all(axis=-1))
        self.counted = self.known[:, None] & (size >= self.seen) & (size > FALSE_ZERO)
        with np.errstate(over="ignore", invalid="ignore"):
            self.unit = np.spacing(size.astype(np.float32)).astype(np.float64)

    def confirm(self, index: int) -> None:
        """Replace the truth at a point by its value in high precision."""
        self.truth[index] = _precise(self.exact, self.points, range(index, index + 1))[0]
        self._weigh()

    def shared_out(self, node: Node) -> Node:
        """A form's graph, with the share of the domain's pixels (uniform ones) in each branch."""
        return self.usual.shared_out(node)

    def measure(self, node: Node) -> Measured | None:
        """The figures of a form's graph; None if it gives NaN, infinity or a false zero."""
        return self.figures(self.graphs.values(node), estimated_price(node))

    def errors(self, node: Node) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The error of a form's graph at every point: in bits, and in CIEDE2000."""
        bits, de = self.errors_of(self.graphs.values(node).astype(np.float64))
        return bits.max(axis=-1), de

    def measure_program(self, program: Program, channels: NDArray[np.float32]) -> Measured | None:
        """The figures of a program on channels that stand for the points', each point with its
        own variables."""
        result = np.empty((len(channels), self.truth.shape[1]), dtype=np.float32)
        names = list(self.graphs.variables)
        runs: dict[tuple[float, ...], list[int]] = {}
        for i in range(len(channels)):
            key = tuple(float(self.graphs.variables[n][i]) for n in names)
            runs.setdefault(key, []).append(i)
        for key, which in runs.items():
            result[which] = run(program, channels[which], dict(zip(names, key, strict=True)))
        return self.figures(result, price(program))

    def figures(self, result: NDArray[np.float32], price: float) -> Measured | None:
        """The figures of values (points, components) that cost so much."""
        if not np.isfinite(result).all():
            return None
        wide = result.astype(np.float64)
        if (self.known[:, None] & (wide == 0) & (np.abs(self.truth) > FALSE_ZERO)).any():
            return None
        bits, de = self.errors_of(wide)
        counted = max(int(self.counted.sum()), 1)
        return Measured(
            float(bits.max()),
            float(bits.sum() / counted),
            float(de.max()),
            price,
            int(bits.max(axis=-1).argmax()),
        )

    def errors_of(
        self, result: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(points, components) in bits, 0 where values do not count; (points,) in CIEDE2000."""
        ulps = np.where(self.counted, np.abs(result - self.truth) / self.unit, 0.0)
        truth = np.where(self.known[:, None], self.truth, 0.0)
        differences = self.colorimetry.difference(result, truth)
        return np.log2(1 + ulps), np.where(self.known, differences, 0.0)


def float64_suffices(exact: Expression, points: Points) -> bool:
    """Whether float64 agrees with high precision to AGREEMENT at TRIED of the points."""
    some = range(0, points.count, max(1, points.count // TRIED))
    truth = _precise(exact, points, some)
    at = {name: v[some.start :: some.step] for name, v in points.values.items()}
    known = _quickly(exact, at)
    with np.errstate(all="ignore"):
        near = np.abs(known - truth) <= AGREEMENT * np.abs(truth)
    return bool(np.all(near | ~np.isfinite(truth) | (np.abs(truth) < FALSE_ZERO)))


def _quickly(exact: Expression, values: Mapping[str, NDArray[np.float32]]) -> NDArray[np.float64]:
    return evaluate(exact, {name: v.astype(np.float64) for name, v in values.items()})


def _precise(exact: Expression, points: Points, which: range) -> NDArray[np.float64]:
    columns = {name: values.tolist() for name, values in points.values.items()}
    precise = PreciseEvaluation(exact)
    rows = [precise({name: rows[i] for name, rows in columns.items()}) for i in which]
    return np.array(rows, dtype=np.float64).reshape(len(which), exact.width)


def _at_peak(
    points: Points, quantities: tuple[Quantity, ...]
) -> list[dict[str, NDArray[np.float64]]]:
    """The same points with the directions each other's mirror, where a specular lobe is highest: at
    the point's own angle, and halfway to grazing."""
    values = {name: v.astype(np.float64) for name, v in points.values.items()}
    of = directions(quantities)
    if not of.zeniths:
        return [values]
    if of.full:
        first, second = of.azimuths
        values[second] = values[first] + np.pi
    own = values[of.zeniths[0]]
    angles = (own, np.full_like(own, np.pi / 4))
    return [{**values, **dict.fromkeys(of.zeniths, at)} for at in angles]


def _graphs(points: Points, bindings: Mapping[str, Binding]) -> Graphs:
    variables = {}
    channels: list[tuple[int, NDArray[np.float32]]] = []
    for name, binding in bindings.items():
        if isinstance(binding, VariableBinding):
            variables[binding.signature] = points.values[name][:, 0]
        else:
            assert isinstance(binding, ChannelBinding)
            channels.append((binding.start, points.values[name]))
    ordered = [values for _, values in sorted(channels, key=lambda c: c[0])]
    return Graphs(np.concatenate(ordered, axis=1), variables)
