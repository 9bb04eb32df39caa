"""Variables that are given as several values: a sweep, a page for each."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import click

from brdfc.cli.options import pairs
from brdfc.lang.values import BadValue, split_number

MOST_PAGES = 10_000


def swept(environment: Sequence[str]) -> list[tuple[str, ...]]:
    """The variables of each page, as --env takes them: one page where no variable has several
    values.

    `a=1,2,3` are three values, `a=-60deg..60deg:5deg` those from one end to the other in steps.
    Variables with several run side by side. Wrong usage for texts that cannot be, and for variables
    with different numbers of values.
    """
    given = {name: _values(name, text) for name, text in pairs(environment, "--env").items()}
    lengths = {name: len(values) for name, values in given.items() if len(values) > 1}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} has {count}" for name, count in lengths.items())
        raise click.UsageError(
            f"variables that run side by side have as many values each: {listed}"
        )
    pages = max(lengths.values(), default=1)
    return [
        tuple(f"{name}={values[page % len(values)]}" for name, values in given.items())
        for page in range(pages)
    ]


def _values(name: str, text: str) -> list[str]:
    if ".." not in text:
        return [part.strip() for part in text.split(",")] if "(" not in text else [text]
    try:
        first, _, rest = text.partition("..")
        last, separator, step = rest.partition(":")
        if not separator:
            raise BadValue("a range needs its step", f"{name}={text}:5deg")
        return _steps(*(_signed(part.strip()) for part in (first, last, step)))
    except BadValue as bad:
        raise click.UsageError(
            f"--env {name}={text}: {bad.message}; write {name}=-60deg..60deg:5deg"
        ) from None


def _steps(*given: tuple[Fraction, str]) -> list[str]:
    (first, unit), (last, _), (step, _) = given
    if len({u for _, u in given}) > 1:
        raise BadValue("its ends and its step have different units")
    if step <= 0 or last < first:
        raise BadValue("it leads nowhere")
    count = (last - first) / step
    if count.denominator != 1:
        raise BadValue("its steps do not end where it does")
    if count >= MOST_PAGES:
        raise BadValue(f"it has {count + 1} values, and a sweep at most {MOST_PAGES:,}")
    return [f"{float(first + i * step)!r}{unit}" for i in range(int(count) + 1)]


def _signed(text: str) -> tuple[Fraction, str]:
    value, unit = split_number(text.removeprefix("-").removeprefix("+"))
    return (-value if text.startswith("-") else value), unit
