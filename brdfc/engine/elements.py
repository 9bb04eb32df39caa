"""Elements that are no programs, on blocks of pixels; each kind has a module of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from brdfc.calc.appearance import AppearanceTransform
from brdfc.calc.calculator_curves import CalculatorCurve
from brdfc.calc.curves import Curve, CurveSet
from brdfc.calc.program import Element, Matrix, Program
from brdfc.calc.tables import LookupTable
from brdfc.calc.tints import TintArray
from brdfc.engine.appearance import apply_appearance
from brdfc.engine.calculator_curves import apply_calculator_curve
from brdfc.engine.curves import apply_curve
from brdfc.engine.kernels import Kernel, Values, compute
from brdfc.engine.linear import apply_matrix
from brdfc.engine.tables import Interpolation, apply_table
from brdfc.engine.tints import apply_tint
from brdfc.source.errors import ProgramError

MARKERS = ("bACS", "eACS")
"""Elements that say where alternatives begin and end, and change nothing."""


@dataclass(frozen=True)
class Setting:
    """What a run computes with. environment: variables by signature, a number each or one for each
    pixel. binary: the arithmetic of two values. interpolation: of tables of three inputs."""

    environment: Mapping[str, Values]
    binary: Mapping[str, Kernel]
    interpolation: Interpolation


Calculate = Callable[[Program, Sequence[Values], Setting], Sequence[Values]]
"""What runs the program that a curve is sampled from."""


def apply_element(
    element: Element, inputs: Sequence[Values], setting: Setting, calculate: Calculate
) -> list[Values]:
    """An element on a list of channels; ProgramError for a kind that is only carried."""
    if isinstance(element, Matrix):
        return [np.asarray(v) for v in apply_matrix(element, inputs, compute)]
    if isinstance(element, CurveSet):
        pairs = zip(element.curves, inputs, strict=True)
        return [_curve(curve, x, setting, calculate) for curve, x in pairs]
    if isinstance(element, LookupTable):
        return apply_table(element, inputs, setting.interpolation)
    if isinstance(element, TintArray):
        return apply_tint(element, inputs)
    if isinstance(element, AppearanceTransform):
        return apply_appearance(element, inputs)
    if changes_nothing(element):
        return list(inputs)
    raise ProgramError(f"elements of kind '{element.signature}' cannot be run")


def changes_nothing(element: Element) -> bool:
    """Whether an element is a marker only."""
    return element.signature in MARKERS and element.inputs == element.outputs


def _curve(curve: Curve, x: Values, setting: Setting, calculate: Calculate) -> Values:
    if not isinstance(curve, CalculatorCurve):
        return apply_curve(curve, x)
    program, variables = curve.calculator, setting.environment
    differing = [variable for variable in variables.values() if variable.ndim]
    (pixels,) = np.broadcast_shapes((1,), x.shape, *(v.shape for v in differing))

    def values(places: Values) -> Values:
        rows = len(places)
        here = {name: np.tile(v, rows) if v.ndim else v for name, v in variables.items()}
        (found,) = calculate(program, [places.ravel()], replace(setting, environment=here))
        return np.broadcast_to(found, places.size).reshape(places.shape)

    found = apply_calculator_curve(curve, np.broadcast_to(x, pixels), values, not differing)
    return found if x.ndim or differing else found[0]
