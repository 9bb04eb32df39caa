"""Programs side by side: one that was compiled, and a formula emitted as it is written.

Both are run with every quantity in its own channel, so that each point has its own angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.program import Block, If, Op, Program, Select
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import VariableBinding, select
from brdfc.engine.interpreter import run
from brdfc.judge.problem import Problem
from brdfc.judge.strata import Points
from brdfc.lang.model import Model
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.formula import formula


@dataclass(frozen=True)
class Subject:
    """A program to be judged: name, and the program with the problem's quantities side by side as
    its channels."""

    name: str
    program: Program

    def values(self, pixels: NDArray[np.float32]) -> NDArray[np.float32]:
        """(points, channels) to (points, 3). Division by zero gives infinity or NaN here: engines
        differ, and a program that gets there has failed on one of them."""
        return run(self.program, pixels, {}, ieee=True)


def subject(name: str, program: Program, problem: Problem) -> Subject:
    """A program of a problem, its variables turned into channels after the others."""
    places: dict[str, int] = {}
    for binding in problem.bindings.values():
        if isinstance(binding, VariableBinding):
            places[binding.signature] = problem.inputs + len(places)
    body = _with_channels(program.body, places)
    return Subject(name, replace(program, inputs=problem.inputs + len(places), body=body))


def pixels(points: Points, problem: Problem) -> NDArray[np.float32]:
    """The channels of a subject at some points: the quantities in their order."""
    return np.concatenate([points.values[q.name] for q in problem.quantities], axis=1)


def as_written(
    model: Model, problem: Problem, constants: Mapping[str, tuple[float, ...]]
) -> Program:
    """A model's formula as a program: operators in its own order, no other form searched, no
    guards.

    constants: what the problem's own model has fixed. BrdfcError where the model has other
    quantities than the problem.
    """
    wanted = {q.name: q.type.name for q in problem.quantities} | dict.fromkeys(constants, "")
    given = {q.name: q.type.name for q in model.quantities}
    if wanted.keys() != given.keys():
        differing = sorted(wanted.keys() ^ given.keys())
        raise BrdfcError(
            f"'{model.name}' cannot be compared: only one of the models has {', '.join(differing)}",
            where=model.origin,
            hint=f"it needs the quantities {', '.join(sorted(wanted))}",
        )
    for q in problem.quantities:
        if given[q.name] != q.type.name:
            message = f"{q.name} is of type {given[q.name]} here, and {q.type.name} there"
            raise BrdfcError(f"'{model.name}' cannot be compared: {message}", where=model.origin)
    exact = formula(model, constants, problem.formula.white).exact
    if exact.width != problem.exact.width:
        message = f"its radiance has {exact.width} components, not {problem.exact.width}"
        raise BrdfcError(f"'{model.name}' cannot be compared: {message}", where=model.origin)
    return schedule(select(fold_constants(exact), problem.bindings), problem.inputs)


def _with_channels(block: Block, places: Mapping[str, int]) -> Block:
    """`env`, which pushes a value and whether it is defined, as a channel and `true`."""
    found: list[Op | If | Select] = []
    for i in block:
        if isinstance(i, If):
            otherwise = None if i.otherwise is None else _with_channels(i.otherwise, places)
            found.append(If(_with_channels(i.then, places), otherwise, i.share))
        elif isinstance(i, Select):
            cases = tuple(_with_channels(case, places) for case in i.cases)
            default = None if i.default is None else _with_channels(i.default, places)
            found.append(Select(cases, default))
        elif i.name == "env":
            found += [Op("in", places[i.signature], 1), Op("data", value=1.0)]
        else:
            found.append(i)
    return tuple(found)
