"""Two rivals of a calculator program: a lookup table of everything, and curves for parts of it.

They trade accuracy for time, or for engines that are quicker with tables than with arithmetic. Both
need every environment variable fixed: a table has no place for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Instruction, Op, Program
from brdfc.calc.samples import Samples
from brdfc.calc.tables import MAX_INPUTS, LookupTable
from brdfc.codegen.curves import Curves
from brdfc.codegen.emit import push_span
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import Binding, ChannelBinding, select
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.evaluate import evaluate
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.intervals import LARGEST, Interval, single

LARGEST_TABLE = 64 << 20
"""Bytes of a lookup table at most."""
MOST_SAMPLES = 65535
"""Points of a curve: the newest reference engine refuses one with more."""

Domain = Mapping[str, Interval]
_Channels = list[tuple[str, ChannelBinding]]


def clut_program(
    expression: Expression, domain: Domain, bindings: Mapping[str, Binding], points: int
) -> Program:
    """The formula as a lookup table over all channels, each with so many points over its range."""
    channels = _channels(expression, bindings)
    inputs = _count(channels)
    if not (2 <= points <= 255 and 1 <= inputs <= MAX_INPUTS):
        raise BrdfcError(
            f"a lookup table has 2 to 255 points for each of 1 to {MAX_INPUTS} channels, not "
            f"{points} for each of {inputs}"
        )
    size = 4 * expression.width * points**inputs
    if size > LARGEST_TABLE:
        raise BrdfcError(
            f"a table of {points} points for each of {inputs} channels takes {size / 2**20:,.0f} "
            f"MiB; {LARGEST_TABLE >> 20} MiB is the most",
            hint="take fewer points, or fix channels with --set",
        )
    values = _grid_values(expression, domain, channels, points)
    if not (np.abs(values) <= LARGEST).all():
        raise BrdfcError(
            "the formula is not finite at every point of the grid",
            hint="narrow the declared ranges, or use the calculator",
        )
    table = LookupTable(inputs, expression.width, (points,) * inputs, Samples.of(values))
    code = _unit_inputs(domain, channels)
    code += [Op("clut", 0), Op("out", 0, expression.width)]
    return Program(inputs, expression.width, tuple(code), (table,))


def _grid_values(
    expression: Expression, domain: Domain, channels: _Channels, points: int
) -> NDArray[np.float32]:
    """The table in its order, one step of the first channel at a time to keep memory small."""
    inputs = _count(channels)
    lines = []
    for name, binding in channels:
        interval = domain[name]
        lines += [np.linspace(interval.low, interval.high, points)] * binding.width
    table = np.empty((points,) * inputs + (expression.width,), dtype=np.float32)
    for step in range(points):
        axes = np.ix_(lines[0][step : step + 1], *lines[1:])
        quantities = {
            name: np.stack(np.broadcast_arrays(*axes[b.start : b.start + b.width]), axis=-1)
            for name, b in channels
        }
        with np.errstate(over="ignore"):
            table[step] = evaluate(expression, quantities)[0]
    return table


def _unit_inputs(domain: Domain, channels: _Channels) -> list[Instruction]:
    """Every channel from its range to 0..1, held there: engines read outside the table otherwise.

    `x 0 vmax` gives 0 where x is NaN, so that the maximum has to come first.
    """
    code: list[Instruction] = []
    for name, binding in channels:
        interval = domain[name]
        push_span(code, "in", binding.start, binding.width)
        scale = 0.0 if interval.single else single(1 / (interval.high - interval.low))
        if interval.low != 0:
            code += [Op("data", value=single(interval.low)), Op("ssub", binding.width)]
        if scale != 1:
            code += [Op("data", value=scale), Op("smul", binding.width)]
    inputs = _count(channels)
    for bound, operator in ((0.0, "vmax"), (1.0, "vmin")):
        code.append(Op("data", value=bound))
        if inputs > 1:
            code.append(Op("copy", 1, inputs - 1))
        code.append(Op(operator, inputs))
    return code


def curve_program(
    expression: Expression, domain: Domain, bindings: Mapping[str, Binding], points: int
) -> Program:
    """The formula with its dear functions of one channel looked up in curves of so many points."""
    inputs = _count(_channels(expression, bindings))
    if not 2 <= points <= MOST_SAMPLES:
        raise BrdfcError(f"a curve has 2 to {MOST_SAMPLES} points, not {points}")
    curves = Curves(bindings, domain, points, inputs)
    expression = curves.replaced(expression)
    program = schedule(select(expression, {**bindings, **curves.found}), inputs)
    return replace(program, elements=tuple(curves.elements))


def _channels(expression: Expression, bindings: Mapping[str, Binding]) -> _Channels:
    """The channels in the order of the pixel; BrdfcError where a variable is left."""
    channels, variables = [], []
    used = {e.name for e in walk(expression) if e.operator == "quantity"}
    for name, binding in bindings.items():
        if isinstance(binding, ChannelBinding):
            channels.append((name, binding))
        elif name in used:
            variables.append(name)
    if variables:
        raise BrdfcError(
            f"a table cannot follow {', '.join(variables)}, which each run may set",
            hint="fix it: " + " ".join(f"--set {name}=..." for name in variables),
        )
    return sorted(channels, key=lambda channel: channel[1].start)


def _count(channels: _Channels) -> int:
    return sum(binding.width for _, binding in channels)
