"""Literal values: exact numbers, their units, and the float a quantity of a given type holds."""

from __future__ import annotations

import math
import re
from fractions import Fraction

from brdfc.lang.types import TYPES, DeclaredType, spectrum
from brdfc.source.errors import ValueGivenError

UNITS = ("deg", "rad", "nm")

_NUMBER = re.compile(r"((?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)([A-Za-z_]*)", re.ASCII)
_LONGEST = 100
_SMALLEST, _LARGEST = 1e-300, 1e300
_MOST_WAVELENGTHS = 1000
_WAVELENGTHS = re.compile(r"(\d{1,5})(?:nm)?\s*\.\.\s*(\d{1,5})(?:nm)?\s*,\s*(\d{1,5})(?:nm)?")


class BadValue(Exception):
    """A literal that is no value for the place it stands in: what is wrong, and what to do."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def split_number(text: str) -> tuple[Fraction, str]:
    """`40deg` to its exact value and its unit ("" where it has none); raises BadValue."""
    match = _NUMBER.fullmatch(text)
    if match is None:
        raise BadValue(f"'{text[:_LONGEST]}' is not a number")
    digits, unit = match.groups()
    # Checked before it becomes a Fraction, which would hold every digit of 1e999999999.
    if len(digits) > _LONGEST:
        raise BadValue(f"a number of more than {_LONGEST} characters")
    size = float(digits)
    if size > _LARGEST or (size < _SMALLEST and re.match(r"[0.]*[1-9]", digits)):
        raise BadValue(f"{digits} is beyond what can be computed with (1e-300 to 1e300)")
    if unit and unit not in UNITS:
        raise BadValue(
            f"'{unit}' is not a unit (deg, rad and nm are)", f"to multiply, write {digits}*{unit}"
        )
    return Fraction(digits) if size else Fraction(0), unit


def in_own_unit(value: Fraction, unit: str, declared: DeclaredType) -> float:
    """The float a quantity of that type holds for a literal: radians for angles.

    Raises BadValue for a unit that is missing or wrong; 1 for an angle is neither 1deg nor 1rad.
    """
    shown = f"{float(value):g}"
    if declared.is_angle:
        if unit == "deg":
            return float(value) * math.pi / 180
        if unit == "rad":
            return float(value)
        radians = f" or {shown}rad" if abs(value) <= 7 else ""  # nobody writes 45 radians
        raise BadValue("an angle needs its unit", f"write {shown}deg{radians}")
    if unit:
        raise BadValue(f"a value of type {declared.name} has no unit", f"write {shown}")
    return float(value)


def bounds(declared: DeclaredType) -> str:
    """What values a type can have, in words."""
    if declared.high == math.inf:
        return f"at least {declared.low:g}"
    return f"within {declared.low:g}..{declared.high:g}"


def checked_spectrum(first: int, last: int, step: int) -> DeclaredType:
    """A spectrum from the first wavelength to the last in whole steps of nanometres; BadValue where
    they do not lead there, or are too many."""
    if first <= 0 or step <= 0 or first >= last or (last - first) % step:
        raise BadValue(f"{step}nm steps do not lead from {first}nm to {last}nm")
    if (last - first) // step >= _MOST_WAVELENGTHS:
        raise BadValue(f"a spectrum has at most {_MOST_WAVELENGTHS} wavelengths")
    return spectrum(first, last, step)


def parse_spectrum(text: str) -> DeclaredType:
    """The spectrum of `400nm..700nm,10nm`, as on the command line; ValueGivenError for any other
    text."""
    found = _WAVELENGTHS.fullmatch(text.strip())
    try:
        if not found:
            raise BadValue(f"'{text[:_LONGEST]}' is no range of wavelengths and a step")
        return checked_spectrum(*(int(number) for number in found.groups()))
    except BadValue as bad:
        raise ValueGivenError(bad.message, hint=bad.hint or "write 400nm..700nm,10nm") from None


def declared_type(name: str) -> DeclaredType | None:
    """The type of that name, a spectrum with its wavelengths in brackets among them; None where
    there is none."""
    if name in TYPES or not (name.startswith("spectrum(") and name.endswith(")")):
        return TYPES.get(name)
    try:
        return parse_spectrum(name[len("spectrum(") : -1])
    except ValueGivenError:
        return None


def parse_value(text: str, declared: DeclaredType, name: str) -> tuple[float, ...]:
    """A value given on the command line: one float a component, angles in radians.

    text: `40deg`, `0.7rad`, `0.15`; for several components `(0.1, 0.2, 0.3)`, with or without the
    brackets, or one number for all. Raises ValueGivenError for anything else, for a unit that is
    missing or wrong, and for what the type cannot hold; name is only for the message.
    """
    inner = text.strip()
    if inner.startswith("(") and inner.endswith(")"):
        inner = inner[1:-1]
    width = declared.value.width
    try:
        values = tuple(_given(part.strip(), declared) for part in inner.split(","))
        if len(values) not in (1, width):
            needs = "one number" if width == 1 else f"{width} numbers, or one for all"
            raise BadValue(f"{len(values)} numbers are given and it takes {needs}")
    except BadValue as bad:
        raise ValueGivenError(f"{name}={text}: {bad.message}", hint=bad.hint) from None
    return values if len(values) == width else values * width


def _given(text: str, declared: DeclaredType) -> float:
    """One number of a command-line value, sign included."""
    digits = text.removeprefix("-") if text.startswith("-") else text.removeprefix("+")
    if not digits[:1].isdigit() and not digits.startswith("."):
        example = "40deg" if declared.is_angle else "0.15"
        raise BadValue(f"'{text[:_LONGEST]}' is not a finite number", f"write, say, {example}")
    value, unit = split_number(digits)
    if text.startswith("-"):
        value = -value
    result = in_own_unit(value, unit, declared)
    if not declared.low <= result <= declared.high:
        raise BadValue(f"type {declared.name} is {bounds(declared)}")
    return result
