"""What a model claims about itself: its laws, those it breaks, and its examples."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from brdfc.lang import tree
from brdfc.lang.declarations import component_values, value
from brdfc.lang.imports import DEFAULT_GEOMETRY
from brdfc.lang.model import Breach, Definition, Example, Law, Quantity
from brdfc.lang.report import Report
from brdfc.lang.types import TYPES
from brdfc.source.span import Span

DEFAULT_WITHIN = 1e-5
"""The relative difference that an example allows where it does not say."""


class _Form(NamedTuple):
    """How a law is written, whether it has a bound, and whether it names quantities."""

    written: str
    bound: bool = False
    names: bool = False


LAWS = {
    "reciprocal": _Form("law reciprocal"),
    "positive": _Form("law positive"),
    "energy": _Form("law energy <= 1", bound=True),
    "bounded": _Form("law bounded <= 100", bound=True),
    "increasing": _Form("law increasing Rd", names=True),
}
"""The laws a model can claim."""

LAWS_GEOMETRY = "full"
"""The geometry that a breach is stated in where it does not say: albedos need all directions."""


def law(statement: tree.Law, quantities: Mapping[str, Quantity], report: Report) -> Law | None:
    """A law, or None where it is reported as wrong."""
    shaped = _shaped(statement, bool(statement.names), report)
    if shaped is None:
        return None
    for name in statement.names:
        if name.name not in quantities:
            _no_quantity(name.name, name.span, quantities, report)
            return None
    where = statement.condition
    condition = None
    if where is not None:
        condition = Definition("condition", None, where, "", where.span, quantities)
    names = tuple(name.name for name in statement.names)
    return Law(shaped.name, shaped.bound, statement.span, names, condition)


def _shaped(statement: tree.Law | tree.Breaks, has_names: bool, report: Report) -> Law | None:
    """The law's name and bound, or None where they are reported as wrong."""
    form = LAWS.get(statement.name)
    if form is None:
        hint = report.suggestion(statement.name, LAWS)
        message = f"'{statement.name}' is not a law"
        report.error(statement.span, message, expected=", ".join(LAWS), hint=hint)
        return None
    if (statement.bound is not None) != form.bound:
        verb = "needs a bound" if statement.bound is None else "has no bound"
        message = f"'{statement.name}' {verb}"
        report.error(statement.span, message, hint=f"write: {form.written}")
        return None
    if has_names != form.names:
        verb = "is about quantities" if form.names else "is not about single quantities"
        message = f"'{statement.name}' {verb}"
        report.error(statement.span, message, hint=f"write: {form.written}")
        return None
    if statement.bound is None:
        return Law(statement.name, None, statement.span)
    bound = value(statement.bound, TYPES["number"], report)
    if bound is not None and bound <= 0:
        report.error(statement.bound.span, "a bound is above 0")
    return None if bound is None else Law(statement.name, bound, statement.span)


class Facts:
    """The examples and breaches of one file, of those stated in the geometry it is read with.

    quantities: the file's, by name; geometry: "" where the file declares its own angles, and
    everything counts.
    """

    def __init__(self, quantities: Mapping[str, Quantity], geometry: str, report: Report) -> None:
        self._quantities = quantities
        self._geometry = geometry
        self._report = report

    def examples(
        self, statements: Iterable[tree.Statement], width: int | None
    ) -> tuple[Example, ...]:
        """The examples. width: the components of the radiance, None where that is unknown."""
        found = [
            self._example(statement, width)
            for statement in statements
            if isinstance(statement, tree.Example)
            and self._counts(statement.geometry or DEFAULT_GEOMETRY)
        ]
        return tuple(example for example in found if example is not None)

    def breaches(self, statements: Iterable[tree.Statement]) -> tuple[Breach, ...]:
        """The laws that the file says it breaks."""
        found = [
            self._breach(statement)
            for statement in statements
            if isinstance(statement, tree.Breaks)
            and self._counts(statement.geometry or LAWS_GEOMETRY)
        ]
        return tuple(breach for breach in found if breach is not None)

    def _counts(self, geometry: str) -> bool:
        return self._geometry in ("", geometry)

    def _example(self, statement: tree.Example, width: int | None) -> Example | None:
        given = self._given(statement.given)
        result = [value(number, TYPES["number"], self._report) for number in statement.result]
        within = self._within(statement.within)
        if width is not None and len(result) != width:
            first, last = statement.result[0].span, statement.result[-1].span
            message = f"the radiance has {width} components, and here are {len(result)}"
            self._report.error(Span(first.source, first.start, last.end), message)
            return None
        known = tuple(number for number in result if number is not None)
        if given is None or within is None or len(known) < len(result):
            return None
        return Example(given, known, within, statement.span)

    def _breach(self, statement: tree.Breaks) -> Breach | None:
        law = _shaped(statement, False, self._report)
        given = self._given(statement.given)
        figure = value(statement.figure, TYPES["number"], self._report)
        within = self._within(statement.within)
        if law is None or given is None or figure is None or within is None:
            return None
        return Breach(law, given, figure, within, statement.note, statement.span)

    def _given(self, items: Iterable[tree.Given]) -> dict[str, tuple[float, ...]] | None:
        """The value of every quantity, those not given at their defaults; None where one is
        reported as wrong."""
        given = {name: found.default for name, found in self._quantities.items()}
        seen: set[str] = set()
        good = True
        for item in items:
            found = self._quantities.get(item.name)
            if found is None:
                _no_quantity(item.name, item.span, self._quantities, self._report)
                good = False
                continue
            if item.name in seen:
                self._report.error(item.span, f"'{item.name}' is given twice")
            seen.add(item.name)
            limits, what = (found.low, found.high), f"'{item.name}'"
            values = component_values(item.values, found.type, limits, what, self._report)
            if values is None:
                good = False
            else:
                given[item.name] = values
        return given if good else None

    def _within(self, number: tree.Number | None) -> float | None:
        """The relative difference a fact allows."""
        if number is None:
            return DEFAULT_WITHIN
        within = value(number, TYPES["number"], self._report)
        if within is not None and not 0 < within < 1:
            message = "the difference allowed is relative, between 0 and 1"
            self._report.error(number.span, message)
            return None
        return within


def _no_quantity(name: str, span: Span, quantities: Mapping[str, Quantity], report: Report) -> None:
    if not report.excuses(name):
        hint = report.suggestion(name, quantities)
        report.error(span, f"this model has no quantity '{name}'", hint=hint)
