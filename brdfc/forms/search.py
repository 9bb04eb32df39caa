"""The search: from a formula to equivalent forms, one rule at one place at a time.

Every form keeps the steps that led to it. What is worth following is not known here: the caller
measures each form (cost and error), and the search goes on from the forms on the front of the two.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import chain
from math import pi

from brdfc.forms.patterns import Bindings, instantiate, match, match_product
from brdfc.forms.products import factors, is_product, joined, product
from brdfc.forms.rules import RULES, VALUE, Rule
from brdfc.symbolic.expression import Expression, describe, rebuild
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
    quickly.
    """

    rule: Rule
    name: str
    left: Expression
    right: Expression
    heads: frozenset[str]


@cache
def directions() -> tuple[Direction, ...]:
    """Every rule, and the reverse of those that go both ways."""
    from brdfc.forms.texts import pattern

    found = []
    for rule in RULES:
        left, right = pattern(rule.left), pattern(rule.right)
        found.append(Direction(rule, rule.name, left, right, _heads(left)))
        if rule.both:
            back = Direction(rule, f"{rule.name}, back", right, left, _heads(right))
            found.append(back)
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
    of a part is kept."""

    def __init__(self, ranges: Ranges) -> None:
        self.ranges = ranges
        self._known: dict[tuple[Expression, Ranges], list[tuple[str, Expression]]] = {}

    def proposed(
        self, expression: Expression, proposals: Iterable[Proposal]
    ) -> Iterator[tuple[Step, Expression]]:
        """The forms that proposals make of this one."""
        for name, part, replacement in proposals:
            whole = rewrite(_with(expression, part, replacement), self.ranges, simplified)
            yield Step(name, describe(part), describe(replacement)), whole

    def of(self, expression: Expression) -> Iterator[tuple[Step, Expression]]:
        """Every form one step from this one, in a fixed order; the same may come twice."""
        for place, known in places(expression, self.ranges):
            for name, replacement in self._replacements(place, known):
                whole = _with(expression, place, replacement)
                tidy = rewrite(whole, self.ranges, simplified)
                if tidy is not expression:
                    yield Step(name, describe(place), describe(replacement)), tidy

    def _replacements(self, place: Expression, known: Ranges) -> list[tuple[str, Expression]]:
        key = (place, known)
        if key not in self._known:
            found: dict[Expression, str] = {}
            heads = _heads(place)
            for direction in directions():
                if direction.heads <= heads:
                    for replacement in _replacements(place, direction, known):
                        if replacement is not place and _fits(replacement, place, known):
                            found.setdefault(replacement, direction.name)
            self._known[key] = [(name, replacement) for replacement, name in found.items()]
        return self._known[key]


def _replacements(place: Expression, direction: Direction, known: Ranges) -> Iterator[Expression]:
    left, right = direction.left, direction.right
    if is_product(left):
        for bound, rest in match_product(left, place, {}, whole=False):
            if _proved(direction.rule, bound, known):
                new = instantiate(right, bound)
                yield product(joined(rest, factors(new)), place.width)
    else:
        for bound in match(left, place, {}):
            if _proved(direction.rule, {**bound, VALUE: place}, known):
                yield instantiate(right, bound)


def _fits(new: Expression, old: Expression, known: Ranges) -> bool:
    """Whether a form of a part has its width, and no pole that it does not have."""
    pole = known.of(new).undefined and not known.of(old).undefined
    return new.width == old.width and not pole


_HOLDS: dict[str, Callable[[Interval], bool]] = {
    ">= 0": lambda of: of.low >= 0,
    "> 0": lambda of: of.low >= 0 and not of.has_zero,
    "within pi": lambda of: -single(pi) <= of.low and of.high <= single(pi),
}


def _proved(rule: Rule, bound: Bindings, known: Ranges) -> bool:
    for name, relation in rule.needs.items():
        of = known.of(bound[name])
        if of.undefined or not _HOLDS[relation](of):
            return False
    return True


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


@dataclass(frozen=True)
class Score:
    """What a form is worth: price (ns a pixel) and error (whatever the caller minimises)."""

    price: float
    error: float


@dataclass(frozen=True)
class Form:
    """A form with its score, the form it came from (None: as written), and the step between."""

    expression: Expression
    score: Score
    previous: Form | None = None
    step: Step | None = None

    @property
    def path(self) -> tuple[Form, ...]:
        """The forms from the formula as written to this one."""
        return (*self.previous.path, self) if self.previous else (self,)

    @property
    def steps(self) -> tuple[Step, ...]:
        """Every step from the formula as written."""
        return tuple(form.step for form in self.path if form.step)


@dataclass(frozen=True)
class Found:
    """The forms that do not fail, in the order found. finished: there were no more; stopped:
    `stop` said so; neither: the effort was spent."""

    forms: tuple[Form, ...]
    finished: bool
    stopped: bool


def search(
    expression: Expression,
    ranges: Ranges,
    score: Callable[[Expression], Score | None],
    effort: int,
    stop: Callable[[], bool] = lambda: False,
    proposals: Callable[[Expression], Iterable[Proposal]] = lambda _e: (),
) -> Found:
    """Forms of an expression, at most `effort` of them measured.

    score: gives a form's worth, None for one that fails (NaN, infinity, a false zero). stop: asked
    before each; True ends the search with what there is. proposals: other forms of parts of the
    formula as written, measured first. Deterministic unless stopped.
    """
    # A formula that fails as it is written may have forms that do not.
    first = score(expression) or Score(float("inf"), float("inf"))
    neighbours = Neighbours(ranges)
    forms = [Form(expression, first)]
    seen = {expression}
    opened: set[Expression] = set()
    measured = 1
    while True:
        form = _next(forms, opened)
        if form is None:
            return Found(tuple(forms), True, False)
        opened.add(form.expression)
        others = () if form.previous else proposals(expression)
        near = chain(neighbours.proposed(expression, others), neighbours.of(form.expression))
        for step, new in near:
            if new in seen:
                continue
            if measured >= effort or stop():
                return Found(tuple(forms), False, measured < effort)
            seen.add(new)
            measured += 1
            worth = score(new)
            if worth is not None:
                forms.append(Form(new, worth, form, step))


def _next(forms: list[Form], opened: set[Expression]) -> Form | None:
    """The form to go on from: the cheapest not yet opened on the front of price and error, then
    the cheapest near it."""
    best = float("inf")
    candidates = sorted(forms, key=lambda f: (f.score.price, f.score.error, len(f.steps)))
    for form in candidates:
        if form.score.error < best:
            best = form.score.error
            if form.expression not in opened:
                return form
    for form in candidates:
        if form.expression not in opened:
            return form
    return None
