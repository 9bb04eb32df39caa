"""A model made ready to compile: its formula, exactly, and the same prepared for a program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from brdfc.lang.model import Model, Role
from brdfc.symbolic.build import Simpler, build, simpler_parts
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.expression import Expression, constant_vector, quantity, substituted
from brdfc.symbolic.guards import Guard, guarded
from brdfc.symbolic.intervals import Interval
from brdfc.symbolic.products import tidy_products
from brdfc.symbolic.ranges import Ranges, domain
from brdfc.symbolic.rewrite import rewrite
from brdfc.symbolic.simplify import simplified
from brdfc.symbolic.white import under_white

NO_WHITE = (1.0, 1.0, 1.0)
"""The white of a formula that is taken as it is written."""


@dataclass(frozen=True)
class Formula:
    """exact: the radiance as the model writes it, every function inlined, constants put in, for
    colours under a white; the truth a program is judged by. domain: the ranges of the quantities
    left in it.

    The rest is made when it is asked for, as SymPy takes its time: simple, the same function
    simplified by its ranges, which equivalent forms start from; and prepared, that one guarded
    where its domain reaches a break.
    """

    exact: Expression
    domain: Mapping[str, Interval]
    white: Sequence[float] = NO_WHITE

    @cached_property
    def simple(self) -> Expression:
        return simplest(self.exact, self.domain)

    @cached_property
    def prepared(self) -> Expression:
        return fold_constants(guarded(self.simple, Ranges(self.domain))[0])

    @property
    def width(self) -> int:
        """Components of the result: 3 for XYZ."""
        return self.exact.width


def formula(
    model: Model, values: Mapping[str, tuple[float, ...]], white: Sequence[float] = NO_WHITE
) -> Formula:
    """A model's radiance with some quantities fixed, for colours under a white (see white.py).

    values: one number a component (angles in radians) for what is fixed at compile time.
    """
    left = tuple(q.under(white) for q in model.quantities if q.name not in values)
    colours = {q.name: q for q in model.quantities if q.type.is_colour}
    # Fixed colours are under the white as well, so they are put in afterwards.
    plain = {n: v for n, v in values.items() if n not in colours}
    written = build(model.radiance, plain, leave=colours.keys())
    if written.width == len(white):
        written = under_white(written, {n: q.high for n, q in colours.items()}, white)
    fixed = {
        quantity(n, q.type.value.width): constant_vector(values.get(n, q.default))
        for n, q in colours.items()
        if n in values or q.role is Role.CONSTANT
    }
    return Formula(substituted(written, fixed), domain(left), white)


def simpler_in(model: Model, values: Mapping[str, tuple[float, ...]]) -> tuple[Simpler, ...]:
    """What the model's own definitions, and those it imports, say is simpler than parts of the
    formula; values: as for formula. Parts that read colours under a white are not among them."""
    colours = {q.name for q in model.quantities if q.type.is_colour}
    plain = {n: v for n, v in values.items() if n not in colours}
    return simpler_parts(model.radiance, plain, leave=colours)


def simplest(exact: Expression, domain: Mapping[str, Interval]) -> Expression:
    """An expression with its constants folded, simplified by its ranges, its products tidy."""
    simple = rewrite(fold_constants(exact), Ranges(domain), simplified)
    tidy = fold_constants(tidy_products(simple, Ranges(domain)))
    return rewrite(tidy, Ranges(domain), simplified)


def prepared(
    exact: Expression, domain: Mapping[str, Interval]
) -> tuple[Expression, tuple[Guard, ...]]:
    """An expression simplified by its ranges and guarded, and the guards that were needed.

    Inside its own domain the value is the same, up to the rounding of constants to 50 digits.
    """
    safe, guards = guarded(simplest(exact, domain), Ranges(domain))
    return fold_constants(safe), guards
