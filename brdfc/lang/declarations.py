"""`channel`, `env` and `constant` declarations to Quantities: types, ranges, defaults, units."""

from __future__ import annotations

from collections.abc import Sequence

from brdfc.lang.model import Quantity, Role
from brdfc.lang.report import Report
from brdfc.lang.tree import Declaration, Number
from brdfc.lang.types import TYPES, DeclaredType, in_bands_of
from brdfc.lang.values import BadValue, bounds, checked_spectrum, in_own_unit
from brdfc.source.span import Span

SPECTRUM = "spectrum"
_GRID = "spectrum(400nm..700nm, 10nm)"

# A profile's calculator gives these two a meaning of its own.
_RESERVED_SIGNATURES = ("true", "ndef")


def quantity(
    declaration: Declaration, report: Report, spectral: DeclaredType | None = None
) -> Quantity | None:
    """The quantity a statement declares, or None where its type or range is wrong.

    spectral: the spectrum that stands for X, Y, Z, see in_bands_of.
    """
    written = _type(declaration, report)
    type_ = None if written is None else in_bands_of(written, spectral)
    _check_signature(declaration, type_, report)
    if type_ is None:
        return None
    limits = _range(declaration, type_, report)
    if limits is None:
        return None
    low, high = limits
    role = Role(declaration.role)
    if declaration.default is not None:
        default = component_values(
            declaration.default, type_, limits, f"the default of '{declaration.name}'", report
        )
    elif role is Role.CHANNEL:
        default = (min(max(0.0, low), high),) * type_.value.width
    else:
        message = f"'{declaration.name}' needs a default: it is not a channel"
        example = "= 45deg" if type_.is_angle else "= 0.5"
        report.error(declaration.name_span, message, hint=f"write it after the range: {example}")
        default = None
    return Quantity(
        name=declaration.name,
        role=role,
        type=type_,
        low=low,
        high=high,
        # A wrong default is reported; what else is wrong in the file can be found all the same.
        default=default or (low,) * type_.value.width,
        signature=declaration.signature or "",
        description=declaration.description,
        span=declaration.name_span,
    )


def value(number: Number, type_: DeclaredType, report: Report) -> float | None:
    """A literal in a type's own unit, or None where its unit is reported as wrong."""
    try:
        return in_own_unit(number.value, number.unit, type_)
    except BadValue as bad:
        report.error(number.span, bad.message, hint=bad.hint)
        return None


def component_values(
    numbers: Sequence[Number],
    type_: DeclaredType,
    limits: tuple[float, float],
    what: str,
    report: Report,
) -> tuple[float, ...] | None:
    """One value a component, each within the limits: from one literal for all, or one for each."""
    width = type_.value.width
    if len(numbers) not in (1, width):
        takes = "one number" if width == 1 else f"{width} numbers, or one for all"
        place = Span(numbers[0].span.source, numbers[0].span.start, numbers[-1].span.end)
        report.error(place, f"{what} takes {takes}, and here are {len(numbers)}")
        return None
    found = [value(number, type_, report) for number in numbers]
    for number, given in zip(numbers, found, strict=True):
        if given is not None and not limits[0] <= given <= limits[1]:
            report.error(number.span, f"{what} is outside its range")
            return None
    values = tuple(given for given in found if given is not None)
    if len(values) < len(numbers):
        return None
    return values if len(values) == width else values * width


def _type(declaration: Declaration, report: Report) -> DeclaredType | None:
    name, arguments = declaration.type_name, declaration.type_arguments
    if name == SPECTRUM:
        return _spectrum(declaration, report)
    type_ = TYPES.get(name)
    if type_ is None:
        known = (*TYPES, SPECTRUM)
        hint = report.suggestion(name, known)
        report.error(
            declaration.type_span, f"'{name}' is not a type", expected=", ".join(known), hint=hint
        )
    elif arguments:
        report.error(declaration.type_span, f"only a spectrum has a grid, not type {name}")
    return type_


def _spectrum(declaration: Declaration, report: Report) -> DeclaredType | None:
    """The spectrum over a grid: whole nanometres, from first to last in equal steps."""
    grid = declaration.type_arguments
    if not grid:
        message = "a spectrum needs its wavelengths"
        report.error(declaration.type_span, message, hint=f"write {_GRID}")
        return None
    for number in grid:
        if number.unit != "nm" or number.value.denominator != 1 or number.value <= 0:
            message = "a wavelength is a whole number of nm, above 0"
            report.error(number.span, message, hint=f"as in {_GRID}")
            return None
    first, last, step = (int(number.value) for number in grid)
    try:
        return checked_spectrum(first, last, step)
    except BadValue as bad:
        report.error(declaration.type_span, bad.message, hint=bad.hint)
        return None


def _range(
    declaration: Declaration, type_: DeclaredType, report: Report
) -> tuple[float, float] | None:
    """The declared range in the type's own unit; a reflectance may leave out 0..1."""
    if declaration.low is None or declaration.high is None:
        if type_ is TYPES["reflectance"]:
            return type_.low, type_.high
        example = "in -90deg..90deg" if type_.is_angle else "in 0..1"
        message = f"'{declaration.name}' needs a range"
        hint = f"write it after the type: {example}"
        report.error(declaration.name_span, message, hint=hint)
        return None
    low, high = (value(n, type_, report) for n in (declaration.low, declaration.high))
    if low is None or high is None:
        return None
    place = Span(declaration.low.span.source, declaration.low.span.start, declaration.high.span.end)
    if not low < high:
        report.error(place, "a range goes from its lower end to its higher one")
        return None
    if low < type_.low or high > type_.high:
        report.error(place, f"type {type_.name} is {bounds(type_)}")
        return None
    return low, high


def _check_signature(declaration: Declaration, type_: DeclaredType | None, report: Report) -> None:
    """What a declaration says about the name it has as an environment variable."""
    signature, env = declaration.signature, declaration.role == Role.ENV.value
    if env and type_ is not None and type_.value.width > 1:
        message = f"an env is one value, and type {type_.name} has {type_.value.width}"
        report.error(declaration.type_span, message, hint="declare it as a channel or a constant")
    if signature is None or declaration.signature_span is None:
        if env:
            message = f"'{declaration.name}' needs the signature it has in a profile"
            hint = f"write it after the default: as {declaration.name[:4]}"
            report.error(declaration.name_span, message, hint=hint)
        return
    if not 1 <= len(signature) <= 4 or not all("!" <= c <= "~" for c in signature):
        message = f"'{signature}' is not a signature"
        report.error(declaration.signature_span, message, expected="1 to 4 ASCII characters")
    elif signature in _RESERVED_SIGNATURES:
        message = f"the signature '{signature}' has a meaning of its own in a profile"
        report.error(declaration.signature_span, message, hint="choose another one")


def check_unique(quantities: Sequence[Quantity], report: Report) -> None:
    """Report component names and signatures that two quantities share."""
    names: dict[str, Quantity] = {}
    for found in quantities:
        # A quantity that is itself a name twice is reported as a duplicate, not here.
        for name in dict.fromkeys((found.name, *found.component_names)):
            other = names.setdefault(name, found)
            if other is not found:
                message = f"'{name}' would be the name of two channels"
                note = f"'{other.name}' has a component or the name '{name}'"
                report.error(found.span, message, notes=((other.span, note),))
    signatures: dict[str, Quantity] = {}
    for found in quantities:
        other = signatures.setdefault(found.signature, found) if found.signature else found
        named = names.get(found.signature, found)
        if other is not found:
            message = f"the signature '{found.signature}' of '{found.name}' is taken"
            report.error(found.span, message, notes=((other.span, "it is used here"),))
        elif named is not found:
            message = f"the signature '{found.signature}' of '{found.name}' is another's name"
            report.error(found.span, message, notes=((named.span, "which is declared here"),))
