"""A formula's colours as luminance and two opponent signals, as expressions of their own.

Relative to the white, with x = X/Xn and so on, CIELAB needs y, x - y and y - z. Written out of the
formula, terms that have the white's colour cancel in the opponent signals exactly; enclosures of
x and of y apart would not know that.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from brdfc.colour.colorimetry import Colorimetry
from brdfc.symbolic.expression import ONE, ZERO, Expression, component, const, make, rebuild, vector

Weights = Sequence[Fraction]


def opponent(formula: Expression, colorimetry: Colorimetry) -> tuple[Expression, ...]:
    """y, x, z, x - y and y - z of a formula's values, relative to the white."""
    rows, white, display = _exact(colorimetry.rows or _SAME), colorimetry.white, colorimetry.display
    if display is not None:
        to_primaries = _product(_exact(display.to_primaries), rows)
        formula = vector([_clipped(weighted(formula, row)) for row in to_primaries])
        rows, white = _exact(display.to_xyz), display.white
    x, y, z = (
        [value / Fraction(str(float(w))) for value in row]
        for row, w in zip(rows, white, strict=True)
    )
    signals = (y, x, z, _less(x, y), _less(y, z))
    return tuple(weighted(formula, weights) for weights in signals)


_SAME = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _exact(rows: Sequence[Sequence[float]]) -> list[list[Fraction]]:
    return [[Fraction(value) for value in row] for row in rows]


def _product(a: list[list[Fraction]], b: list[list[Fraction]]) -> list[list[Fraction]]:
    columns = list(zip(*b, strict=True))
    return [
        [sum((p * q for p, q in zip(row, column, strict=True)), Fraction(0)) for column in columns]
        for row in a
    ]


def _clipped(primary: Expression) -> Expression:
    return make("min", make("max", primary, ZERO), ONE)


def _less(a: Weights, b: Weights) -> Weights:
    return [u - v for u, v in zip(a, b, strict=True)]


def weighted(e: Expression, weights: Weights) -> Expression:
    """The sum of an expression's components, each times its weight, taken as far inside as it
    goes: to the constants where it may vanish."""
    if e.width == 1:
        return _times(e, sum(weights, Fraction(0)))
    match e.operator:
        case "add" | "sub":
            return rebuild(e, [weighted(a, weights) for a in e.arguments])
        case "neg":
            return make("neg", weighted(e.arguments[0], weights))
        case "where":
            condition, *branches = e.arguments
            return make("where", condition, *(weighted(b, weights) for b in branches))
        case "mul" | "div":
            a, b = e.arguments
            if b.width == 1:
                return _scaled(e.operator, weighted(a, weights), b)
            if e.operator == "mul" and a.width == 1:
                return _scaled("mul", weighted(b, weights), a)
            numbers = _numbers(b)
            if numbers and e.operator == "mul":
                return weighted(a, [w * n for w, n in zip(weights, numbers, strict=True)])
            if numbers and all(numbers):
                return weighted(a, [w / n for w, n in zip(weights, numbers, strict=True)])
            if e.operator == "mul" and (numbers := _numbers(a)):
                return weighted(b, [w * n for w, n in zip(weights, numbers, strict=True)])
    parts = [_times(part(e, i), w) for i, w in enumerate(weights) if w]
    if e.operator == "vector" and all(p.operator == "const" for p in parts):
        return const(sum((p.value for p in parts), Fraction(0)))
    total = parts[0] if parts else ZERO
    for p in parts[1:]:
        total = make("add", total, p)
    return total


def part(e: Expression, index: int) -> Expression:
    """One component of an expression, taken inside to its quantities."""
    if e.width == 1:
        return e
    if e.operator in ("quantity", "vector"):
        return component(e, index)
    return rebuild(e, [part(a, index) for a in e.arguments])


def _numbers(e: Expression) -> list[Fraction] | None:
    """The components of a constant vector."""
    constant = e.operator == "vector" and all(a.operator == "const" for a in e.arguments)
    return [a.value for a in e.arguments] if constant else None


def _scaled(operator: str, e: Expression, by: Expression) -> Expression:
    return ZERO if e is ZERO else make(operator, e, by)


def _times(e: Expression, weight: Fraction) -> Expression:
    if weight == 0:
        return ZERO
    if e.operator == "const":
        return const(e.value * weight)
    return e if weight == 1 else make("mul", e, const(weight))
