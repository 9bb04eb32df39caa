"""Forms one step away: every rule at every place of a formula."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from math import pi

from brdfc.forms.patterns import Bindings, instantiate, match, match_product
from brdfc.forms.products import factors, is_product, joined, product
from brdfc.forms.rules import RULES, VALUE, Rule
from brdfc.symbolic.expression import PI, ZERO, Expression, describe, make, rebuild
from brdfc.symbolic.intervals import Interval, single
from brdfc.symbolic.ranges import Ranges
from brdfc.symbolic.rewrite import rewrite
from brdfc.symbolic.simplify import simplified


@dataclass(frozen=True)
class Step:
    """One rule applied: its name, and the part before and after."""

    rule: str
    before: str
    after: str


Proposal = tuple[str, Expression, Expression]
"""A name, a part of a formula, and what may stand for it."""


@dataclass(frozen=True)
class Direction:
    """A rule read one way, its sides as patterns.

    heads: the operators that the left side cannot do without, for passing over most places
    quickly; late: to be tried after all others.
    """

    rule: Rule
    name: str
    left: Expression
    right: Expression
    heads: frozenset[str]
    late: bool = False


@cache
def directions() -> tuple[Direction, ...]:
    """Every rule, and the reverse of those that go both ways."""
    from brdfc.forms.texts import pattern

    found = []
    for rule in RULES:
        left, right = pattern(rule.left), pattern(rule.right)
        found.append(Direction(rule, rule.name, left, right, _heads(left)))
        if rule.both:
            name, late = f"{rule.name}, back", rule.multiplies_out
            found.append(Direction(rule, name, right, left, _heads(right), late))
    return tuple(found)


def _heads(e: Expression) -> frozenset[str]:
    """The operator of an expression, or those of a product's factors."""
    if not is_product(e):
        return frozenset({e.operator})
    of = factors(e)
    return frozenset(base.operator for base, _ in (*of.above, *of.below)) - {"quantity"}


def places(expression: Expression, ranges: Ranges) -> list[tuple[Expression, Ranges]]:
    """Every part of an expression, with what is known where it stands.

    Of a product only the whole is a place: rules find their factors in it. A part that stands in
    several branches is a place where the least is known, so that a rule holds in all of them.
    """
    found: dict[Expression, Ranges] = {}
    within: set[Expression] = {expression}  # those that stand outside any product, too
    done: set[tuple[Expression, Ranges, bool]] = set()

    def visit(e: Expression, known: Ranges, inside_product: bool) -> None:
        if (e, known, inside_product) in done:
            return
        done.add((e, known, inside_product))
        found[e] = known if found.get(e, known) is known else ranges
        if not (inside_product and is_product(e)):
            within.add(e)
        if e.operator == "where":
            condition, value, otherwise = e.arguments
            visit(condition, known, False)
            visit(value, known.assuming(condition, True), False)
            visit(otherwise, known.assuming(condition, False), False)
            return
        for argument in e.arguments:
            visit(argument, known, is_product(e) and e.operator != "pow")

    visit(expression, ranges, False)
    return [(e, known) for e, known in found.items() if e in within]


class Neighbours:
    """Forms one step away. Forms of one formula share most of their parts, so what the rules make
    of a part is kept.

    regimes: where the ranges leave open whether a rule holds, use it on the part of the domain
    where it does, `new where condition else old`.
    """

    def __init__(self, ranges: Ranges, regimes: bool = False) -> None:
        self.ranges = ranges
        self.regimes = regimes
        self._known: dict[tuple[Expression, Ranges], list[tuple[Direction, Expression]]] = {}

    def proposed(
        self, expression: Expression, proposals: Iterable[Proposal]
    ) -> Iterator[tuple[Step, Expression]]:
        """The forms that proposals make of this one."""
        for name, part, replacement in proposals:
            whole = rewrite(_with(expression, part, replacement), self.ranges, simplified)
            yield Step(name, describe(part), describe(replacement)), whole

    def of(self, expression: Expression) -> Iterator[tuple[Step, Expression]]:
        """Every form one step from this one, in a fixed order; the same may come twice."""
        every = places(expression, self.ranges)
        for late in (False, True):
            for place, known in every:
                for direction, replacement in self._replacements(place, known):
                    if direction.late is not late:
                        continue
                    whole = _with(expression, place, replacement)
                    tidy = rewrite(whole, self.ranges, simplified)
                    if tidy is not expression:
                        step = Step(direction.name, describe(place), describe(replacement))
                        yield step, tidy

    def _replacements(self, place: Expression, known: Ranges) -> list[tuple[Direction, Expression]]:
        key = (place, known)
        if key not in self._known:
            found: dict[Expression, Direction] = {}
            heads = _heads(place)
            for direction in directions():
                if direction.heads <= heads:
                    for new, where in _replacements(place, direction, known, self.regimes):
                        inside = known.assuming(where, True) if where else known
                        if new is not place and _fits(new, place, inside):
                            split = make("where", where, new, place) if where else new
                            found.setdefault(split, direction)
            self._known[key] = [(direction, new) for new, direction in found.items()]
        return self._known[key]


def _replacements(
    place: Expression, direction: Direction, known: Ranges, regimes: bool
) -> Iterator[tuple[Expression, Expression | None]]:
    """What a rule makes of a part, and the condition under which it may stand there (None: always;
    any other only with regimes)."""
    left, right, rule = direction.left, direction.right, direction.rule
    if is_product(left):
        for bound, rest in match_product(left, place, {}, whole=False):
            for condition in _conditions(rule, bound, known, regimes):
                new = instantiate(right, bound)
                yield product(joined(rest, factors(new)), place.width), condition
    else:
        for bound in match(left, place, {}):
            for condition in _conditions(rule, {**bound, VALUE: place}, known, regimes):
                yield instantiate(right, bound), condition


def _fits(new: Expression, old: Expression, known: Ranges) -> bool:
    """Whether a form of a part has its width, and no pole that it does not have."""
    pole = known.of(new).undefined and not known.of(old).undefined
    return new.width == old.width and not pole


_HOLDS: dict[str, Callable[[Interval], bool]] = {
    ">= 0": lambda of: of.low >= 0,
    "> 0": lambda of: of.low >= 0 and not of.has_zero,
    "within pi": lambda of: -single(pi) <= of.low and of.high <= single(pi),
}
_CONDITION: dict[str, Callable[[Expression], Expression]] = {
    ">= 0": lambda e: make("ge", e, ZERO),
    "> 0": lambda e: make("gt", e, ZERO),
    "within pi": lambda e: make("le", make("abs", e), PI),
}
"""The same as conditions of the language."""


def _conditions(
    rule: Rule, bound: Bindings, known: Ranges, regimes: bool
) -> tuple[Expression | None, ...]:
    """The condition under which a rule holds: None where the ranges prove what it needs; with
    regimes, the one need that they leave open; nothing where the rule cannot be used."""
    open_needs = []
    for name, relation in rule.needs.items():
        of = known.of(bound[name])
        if of.undefined:
            return ()
        if not _HOLDS[relation](of):
            open_needs.append((name, relation))
    if not open_needs:
        return (None,)
    ((name, relation), *others) = open_needs
    e = bound[name]
    if not regimes or others or name == VALUE or e.width > 1:
        return ()
    condition = _CONDITION[relation](e)
    return (condition,) if known.of(condition).high >= 1 else ()


def _with(expression: Expression, place: Expression, replacement: Expression) -> Expression:
    """The expression with a part replaced wherever it stands; products above it stay flat."""
    done: dict[Expression, Expression] = {place: replacement}

    def visit(e: Expression) -> Expression:
        if e not in done:
            new = rebuild(e, [visit(a) for a in e.arguments])
            changed = new is not e and is_product(new)
            done[e] = product(factors(new), new.width) if changed else new
        return done[e]

    return visit(expression)
