"""The way every pass walks an expression: arguments first, each place with what is known there."""

from __future__ import annotations

from collections.abc import Callable

from brdfc.symbolic.expression import Expression, rebuild
from brdfc.symbolic.ranges import Ranges

Rule = Callable[[Expression, Ranges], Expression]
"""From an expression whose arguments are done, and the ranges at its place, to its replacement."""


def rewrite(expression: Expression, ranges: Ranges, rule: Rule) -> Expression:
    """Apply a rule everywhere, from the leaves up.

    The branches of a `where` are done under its condition, so a rule may use there what the
    condition proves; the same expression may come out differently in two places.
    """
    done: dict[tuple[Expression, Ranges], Expression] = {}

    def visit(e: Expression, at: Ranges) -> Expression:
        key = (e, at)
        if key not in done:
            is_choice = e.operator == "where"
            new = branches(e, at) if is_choice else [visit(a, at) for a in e.arguments]
            done[key] = rule(rebuild(e, new), at)
        return done[key]

    def branches(e: Expression, at: Ranges) -> list[Expression]:
        condition, value, otherwise = e.arguments
        new = visit(condition, at)
        # Facts go by expression: those of the old condition fit what is not rewritten yet, those
        # of the new one what has been.
        inside = [at.assuming(condition, h).assuming(new, h) for h in (True, False)]
        return [new, visit(value, inside[0]), visit(otherwise, inside[1])]

    return visit(expression, ranges)
