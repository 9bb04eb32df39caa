"""What a model claims about itself: its laws and its examples."""

from __future__ import annotations

from collections.abc import Mapping

from brdfc.lang import tree
from brdfc.lang.declarations import component_values, value
from brdfc.lang.model import Example, Law, Quantity
from brdfc.lang.report import Report
from brdfc.lang.types import TYPES
from brdfc.source.span import Span

DEFAULT_WITHIN = 1e-5
"""The relative difference that an example allows where it does not say."""

LAWS = {
    "reciprocal": "law reciprocal",
    "positive": "law positive",
    "energy": "law energy <= 1",
}
"""The laws a model can claim, each as it is written."""


def law(statement: tree.Law, report: Report) -> Law | None:
    """A law, or None where it is reported as wrong."""
    written = LAWS.get(statement.name)
    if written is None:
        hint = report.suggestion(statement.name, LAWS)
        message = f"'{statement.name}' is not a law"
        report.error(statement.span, message, expected=", ".join(LAWS), hint=hint)
        return None
    if (statement.bound is not None) != ("<=" in written):
        verb = "needs a bound" if statement.bound is None else "has no bound"
        message = f"'{statement.name}' {verb}"
        report.error(statement.span, message, hint=f"write: {written}")
        return None
    if statement.bound is None:
        return Law(statement.name, None, statement.span)
    bound = value(statement.bound, TYPES["number"], report)
    if bound is not None and bound <= 0:
        report.error(statement.bound.span, "a bound is above 0")
    return None if bound is None else Law(statement.name, bound, statement.span)


def example(
    statement: tree.Example,
    quantities: Mapping[str, Quantity],
    width: int | None,
    report: Report,
) -> Example | None:
    """An example with all quantities given, or None where it is reported as wrong.

    width: the number of components of the radiance, None where that is unknown.
    """
    given = {name: found.default for name, found in quantities.items()}
    seen: set[str] = set()
    good = True
    for item in statement.given:
        found = quantities.get(item.name)
        if found is None:
            if not report.excuses(item.name):
                hint = report.suggestion(item.name, quantities)
                message = f"this model has no quantity '{item.name}'"
                report.error(item.span, message, hint=hint)
            good = False
            continue
        if item.name in seen:
            report.error(item.span, f"'{item.name}' is given twice")
        seen.add(item.name)
        limits = (found.low, found.high)
        values = component_values(item.values, found.type, limits, f"'{item.name}'", report)
        if values is None:
            good = False
        else:
            given[item.name] = values
    result = [value(number, TYPES["number"], report) for number in statement.result]
    within = _within(statement.within, report)
    if width is not None and len(result) != width:
        first, last = statement.result[0].span, statement.result[-1].span
        message = f"the radiance has {width} components, and here are {len(result)}"
        report.error(Span(first.source, first.start, last.end), message)
        return None
    known = tuple(number for number in result if number is not None)
    if not good or within is None or len(known) < len(result):
        return None
    return Example(given, known, within, statement.span)


def _within(number: tree.Number | None, report: Report) -> float | None:
    """The relative difference an example allows."""
    if number is None:
        return DEFAULT_WITHIN
    within = value(number, TYPES["number"], report)
    if within is not None and not 0 < within < 1:
        report.error(number.span, "the difference allowed is relative, between 0 and 1")
        return None
    return within
