"""The check every compiled program passes before it may be written.

It is disassembled and assembled again, verified, run in the interpreter over its domain, and
compared with the model in high precision. A program that gives NaN or infinity inside its domain,
or a colour that differs by more than LIMIT, is refused, and the message says where.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.facts import Facts
from brdfc.calc.program import Program
from brdfc.calc.text import assemble, disassemble
from brdfc.calc.verify import verify
from brdfc.codegen.select import Binding, ChannelBinding, VariableBinding
from brdfc.colour.colorimetry import XYZ_UNDER_D50, Colorimetry
from brdfc.engine.interpreter import run
from brdfc.judge.samples import Samples
from brdfc.source.errors import SelfCheckError
from brdfc.symbolic.expression import Expression
from brdfc.symbolic.intervals import LARGEST
from brdfc.symbolic.precise import PreciseEvaluation

LIMIT = 0.002
"""CIEDE2000 that a program may differ from its model: far below what anyone can see,
and ten times what good float32 forms differ by."""


@dataclass(frozen=True)
class Verdict:
    """What the check found: points compared, the worst difference and where it is, and how many
    points the model leaves undefined (there the program is only required to be finite)."""

    facts: Facts
    points: int
    undefined: int
    worst: float
    worst_at: str


def self_check(
    program: Program,
    exact: Expression,
    bindings: Mapping[str, Binding],
    samples: Samples,
    limit: float = LIMIT,
    colorimetry: Colorimetry = XYZ_UNDER_D50,
) -> Verdict:
    """Judge a program by the model's exact expression; SelfCheckError when it fails, or differs by
    more than limit CIEDE2000 anywhere. samples: of all quantities of both, bindings: of those that
    the program reads. colorimetry: what its results look like."""
    _check_encodings(program)
    facts = verify(program)
    precise = PreciseEvaluation(exact)
    points, undefined, worst, worst_at = 0, 0, 0.0, ""
    for variables, columns in zip(samples.runs, samples.pixels, strict=True):
        environment = _environment(variables, bindings)
        result = run(program, _pixels(program, columns, bindings), environment)
        truth = _truth(precise, variables, columns, len(result))
        broken = np.flatnonzero(~np.isfinite(result).all(axis=-1))
        if len(broken):
            first = int(broken[0])
            raise SelfCheckError(
                f"the program gives {result[first]} where {_place(variables, columns, first)}",
                hint="narrow the declared range, or add `where ... else` to the formula",
            )
        known = _known(truth)
        difference = _differences(result, truth, colorimetry)
        for i in np.flatnonzero(difference > limit):
            near = _nearby_truths(precise, variables, columns, int(i))
            difference[i] = np.min([difference[i], *_differences(result[i], near, colorimetry)])
        index = int(np.argmax(difference))
        if difference[index] > worst or not worst_at:
            worst, worst_at = float(difference[index]), _place(variables, columns, index)
        points += len(result)
        undefined += int((~known).sum())
    if undefined == points:
        raise SelfCheckError(
            f"the formula has no finite value at any of {points} points of its domain",
            hint="look for roots of negative numbers, divisions by 0, and constants that overflow",
        )
    if worst > limit:
        raise SelfCheckError(
            f"the program differs from the model by {worst:.3g} CIEDE2000 (limit {limit:g}) where "
            f"{worst_at}",
            hint="a difference of nearly equal numbers loses the digits: 1 - cos(x), sec(x)^2 - 1;"
            " write it as 2 sin(x/2)^2 or tan(x)^2, or narrow the range",
        )
    return Verdict(facts, points, undefined, worst, worst_at)


def check_finite(
    program: Program, bindings: Mapping[str, Binding], samples: Samples, where: str
) -> None:
    """Refuse a program that gives NaN or infinity at samples of a wider domain, of this name."""
    for variables, columns in zip(samples.runs, samples.pixels, strict=True):
        result = run(
            program, _pixels(program, columns, bindings), _environment(variables, bindings)
        )
        broken = np.flatnonzero(~np.isfinite(result).all(axis=-1))
        if len(broken):
            first = int(broken[0])
            raise SelfCheckError(
                f"the program gives {result[first]} in {where}, where "
                f"{_place(variables, columns, first)}",
                hint="narrow the ranges that the model declares",
            )


def _check_encodings(program: Program) -> None:
    """Text and bytes stand for the same program; anything else is a fault of ours."""
    if assemble(disassemble(program.body)) != program.body:
        raise AssertionError("the program changes when disassembled and assembled again")
    if decode_element(encode_element(program), "the program") != program:
        raise AssertionError("the program changes when encoded and decoded again")


def _pixels(
    program: Program,
    columns: Mapping[str, NDArray[np.float32]],
    bindings: Mapping[str, Binding],
) -> NDArray[np.float32]:
    count = max((len(values) for values in columns.values()), default=1)
    pixels = np.zeros((count, program.inputs), dtype=np.float32)
    for name, binding in bindings.items():
        if isinstance(binding, ChannelBinding):
            pixels[:, binding.start : binding.start + binding.width] = columns[name]
    return pixels


def _environment(
    variables: Mapping[str, float], bindings: Mapping[str, Binding]
) -> dict[str, float]:
    return {
        binding.signature: variables[name]
        for name, binding in bindings.items()
        if isinstance(binding, VariableBinding)
    }


def _truth(
    precise: PreciseEvaluation,
    variables: Mapping[str, float],
    columns: Mapping[str, NDArray[np.float32]],
    count: int,
) -> NDArray[np.float64]:
    fixed = {name: (value,) for name, value in variables.items()}
    rows = []
    for i in range(count):
        point = {name: tuple(values[i].tolist()) for name, values in columns.items()}
        rows.append(precise({**fixed, **point}))
    return np.array(rows, dtype=np.float64)


def _known(truth: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where the model has a value that float32 can hold; NaN compares as false."""
    return np.asarray((np.abs(truth) < LARGEST).all(axis=-1))


def _differences(
    result: NDArray[np.float32], truth: NDArray[np.float64], colorimetry: Colorimetry
) -> NDArray[np.float64]:
    known = _known(truth)
    comparable = np.where(known[..., None], truth, 0)
    return np.where(known, colorimetry.difference(result, comparable), 0.0)


def _nearby_truths(
    precise: PreciseEvaluation,
    variables: Mapping[str, float],
    columns: Mapping[str, NDArray[np.float32]],
    index: int,
) -> NDArray[np.float64]:
    """The model one float32 to either side of a point, in each quantity alone.

    At a jump the formula may take one side and the program the other: `x >= 0.7` is false for the
    float32 nearest to 0.7. A program that is right beside the point is right.
    """
    point = {name: np.array([value], np.float32) for name, value in variables.items()}
    point |= {name: values[index] for name, values in columns.items()}
    truths = []
    for name, values in point.items():
        for side in (-np.inf, np.inf):
            moved = {**point, name: np.nextafter(values, np.float32(side))}
            given = {n: tuple(v.tolist()) for n, v in moved.items()}
            truths.append(precise(given))
    nearby: NDArray[np.float64] = np.array(truths, dtype=np.float64)
    return nearby[_known(nearby)]


def _place(
    variables: Mapping[str, float], columns: Mapping[str, NDArray[np.float32]], index: int
) -> str:
    """The point in words: `incident=0.7 m=0.001 ...`."""
    parts = [f"{name}={value:.9g}" for name, value in variables.items()]
    for name, values in columns.items():
        numbers = [f"{v:.9g}" for v in values[index]]
        parts.append(f"{name}={numbers[0] if len(numbers) == 1 else '(' + ','.join(numbers) + ')'}")
    return " ".join(parts)
