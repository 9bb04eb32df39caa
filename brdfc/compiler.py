"""The whole way from a checked model to a pair of profiles, one stage after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from brdfc import __version__
from brdfc.calc.price import operations, price
from brdfc.calc.prices import prices_in_use
from brdfc.calc.program import Program
from brdfc.calc.text import disassemble
from brdfc.colour.colorimetry import XYZ_UNDER_D50, Colorimetry
from brdfc.colour.conditions import ViewingConditions
from brdfc.colours import bands, colours_of
from brdfc.encodings import Encoding, encoded, encoding
from brdfc.files import write_all
from brdfc.icc.profile import Profile
from brdfc.icc.types import Dictionary
from brdfc.judge.cache import Remembered, holds, key, note, recall, remember, steps_text, summary
from brdfc.judge.examples import check_examples, examples_digest
from brdfc.judge.explore import Explored, explore
from brdfc.judge.goals import Goal, goal
from brdfc.judge.problem import Problem
from brdfc.judge.samples import sample
from brdfc.judge.selfcheck import LIMIT, Verdict, self_check
from brdfc.lang.model import Model, Quantity
from brdfc.layouts import Layout, device_quantities, layout, pixel_quantities, profiles
from brdfc.profiles.content import Content
from brdfc.profiles.metadata import metadata, value_text
from brdfc.profiles.multiplex import ProfilePair
from brdfc.roles import Roles, Value, assign_roles
from brdfc.source.errors import BrdfcError, SelfCheckError, ValueGivenError
from brdfc.symbolic.formula import NO_WHITE, Formula, formula
from brdfc.symbolic.guards import Guard, guarded

Progress = Callable[[int, int], None]


def _silent(_done: int, _total: int) -> None:
    """No progress shown."""


@dataclass(frozen=True)
class Compiled:
    """A compiled model: its profiles, and everything worth knowing of how they came about.

    form: the form that was chosen and how it was derived; None where every form failed to be
    measured, and the formula stands as written. guards: what its domain made necessary. price:
    nanoseconds a pixel on the reference engine, by the price table.
    """

    model: Model
    roles: Roles
    formula: Formula
    goal: Goal
    form: Remembered | None
    guards: tuple[Guard, ...]
    program: Program
    price: float
    verdict: Verdict
    layout: Layout
    profiles: tuple[Profile, ...]

    @property
    def mid(self) -> Profile:
        """The profile that takes device values: the MID, or the only one."""
        return self.profiles[0]

    @property
    def mvis(self) -> Profile:
        """The profile that gives colours: the MVIS, or the only one."""
        return self.profiles[-1]

    @property
    def text(self) -> str:
        """The calculator text of the program."""
        return disassemble(self.program.body)

    def files(self, path: str | Path, mid: str | Path | None = None) -> list[tuple[Path, bytes]]:
        """Path and bytes of each profile, the MID first; beside the MVIS unless said where."""
        if len(self.profiles) == 2:
            return ProfilePair(self.mid, self.mvis).files(path, mid)
        if mid is not None:
            raise ValueGivenError(f"'{self.layout.name}' has one profile and no MID")
        return [(Path(path), self.mvis.to_bytes())]

    def save(self, path: str | Path, mid: str | Path | None = None) -> tuple[Path, ...]:
        """Write the profiles, all or none; see files. Returns their paths."""
        files = self.files(path, mid)
        write_all(*files)
        return tuple(place for place, _ in files)


def compile_model(
    model: Model,
    set: Mapping[str, Value] | None = None,
    channels: Iterable[str] = (),
    *,
    optimize: str = "balanced",
    max_error: str | None = None,
    effort: int | None = None,
    encode: str = "calc",
    conditions: ViewingConditions | None = None,
    highlight: str | None = None,
    angles: str | None = None,
    parameters: str | None = None,
    cache: bool = True,
    progress: Progress = _silent,
) -> Compiled:
    """Compile a model to a MID and an MVIS, or to one profile.

    set: quantities fixed now, by name or four-letter signature: numbers (radians for angles, one
    a component), or text as on the command line ("40deg"). channels: variables or constants that
    come with each pixel instead. optimize: "speed", "balanced" or "accuracy"; max_error ("0.01dE",
    "8ulp") overrides it. effort: equivalent forms measured at most (None: about 300); 1 keeps the
    formula as it is written. encode: "calc", or with every variable fixed "clut:17" (a lookup
    table) or "curve:1024" (a calculator with sampled curves); and a layout: "mcs" (the usual MID
    and MVIS), "ncolour", "brdf-function" or "brdf-struct", see layouts.py, where angles and
    parameters are explained too. conditions: the light and the
    observer of the model's colours (None: D50, and the profile says no more). highlight: "light",
    where a highlight without colour has the light's, or "equal", where it adds the same to X, Y
    and Z (None: as the model says, most say the light's). cache: use and keep searches on
    disk. progress gets forms measured and the effort.

    Raises ModelError, ValueGivenError, or SelfCheckError when the program does not agree with the
    model.
    """
    aim, how = goal(optimize, max_error), encoding(encode)
    arrangement = layout(how.layout, model, angles, parameters)
    fixed = set or {}
    named = {q.name for name in fixed if (q := model.quantity(name)) is not None}
    pixel = (*channels, *(n for n in pixel_quantities(arrangement, model) if n not in named))
    colours = colours_of(model, conditions, highlight)
    roles, ready = prepare(model, fixed, pixel, cache, colours.formula_white)
    problem = problem_of(roles, ready, colours.colorimetry)
    form = _search(problem, aim, effort, cache, progress)
    if form is not None and how.kind == "calc":
        program, guards = form.program, form.guards
        cost = form.derivation[-1].price
    else:
        safe, guards = guarded(form.expression if form else ready.simple, problem.ranges)
        program = encoded(how, problem, safe)
        cost = price(program)
    samples = sample(ready.domain, roles.channels, roles.variables)
    limit = max(LIMIT, aim.limit if aim.kind == "de" else 0.0)
    try:
        verdict = self_check(
            program, ready.exact, problem.bindings, samples, limit, colours.colorimetry
        )
    except SelfCheckError as error:
        if how.kind == "calc":
            raise
        hint = "take more points, or allow more with --max-error 0.1dE"
        raise SelfCheckError(error.message, hint=hint) from None
    stated = {**colours.facts(), **arrangement.facts()}
    own = device_quantities(arrangement, roles)
    meta = _metadata(model, roles, own, stated, program, cost, verdict, form, limit, how)
    content = Content(
        model.title,
        program,
        roles.channel_names,
        tuple(value for q in roles.channels for value in q.default),
        meta,
        colours.conditions,
        colours.grid,
    )
    made = profiles(arrangement, model, roles, content, colours)
    return Compiled(
        model, roles, ready, aim, form, guards, program, cost, verdict, arrangement, made
    )


def explore_model(
    model: Model,
    set: Mapping[str, Value] | None = None,
    channels: Iterable[str] = (),
    *,
    optimize: str = "balanced",
    max_error: str | None = None,
    effort: int | None = None,
    conditions: ViewingConditions | None = None,
    highlight: str | None = None,
    progress: Progress = _silent,
) -> Explored:
    """Every form of a model that a search finds, measured; arguments as for compile_model.

    Raises BrdfcError where every form fails.
    """
    colours = colours_of(model, conditions, highlight)
    roles, ready = prepare(model, set or {}, channels, white=colours.formula_white)
    problem = problem_of(roles, ready, colours.colorimetry)
    aim = goal(optimize, max_error)
    found = explore(problem, aim, effort or problem.default_effort, progress, thorough=True)
    if found is None:
        raise BrdfcError(
            f"every form of '{model.name}' gives NaN, infinity or a false zero in its domain",
            hint="narrow the declared ranges, or add `where ... else` to the formula",
        )
    return found


def prepare(
    model: Model,
    set: Mapping[str, Value],
    channels: Iterable[str],
    cache: bool = False,
    white: Sequence[float] = NO_WHITE,
) -> tuple[Roles, Formula]:
    """The roles of the quantities, and the formula with its constants in, examples checked.

    cache: examples that held before, of the same formula, are not evaluated again. white: that the
    model's colours are under (see symbolic/white.py).
    """
    roles = assign_roles(model, set, channels, white)
    if not roles.channels:
        raise ValueGivenError(
            "no channel is left: a profile needs one value a pixel at least",
            hint="leave one quantity out of --set",
        )
    name = examples_digest(model)
    if not (cache and holds(name)):
        check_examples(model)
        if cache:
            note(name)
    ready = formula(model, roles.constants, white)
    needed = bands(model)
    if ready.width != needed:
        raise BrdfcError(
            f"the radiance of '{model.name}' has {ready.width} components; {needed} are needed",
            where=str(model.radiance.span),
            hint="a colourless radiance y is written (y, y, y)" if ready.width == 1 else None,
        )
    return roles, ready


def problem_of(roles: Roles, ready: Formula, colorimetry: Colorimetry = XYZ_UNDER_D50) -> Problem:
    """What a search for forms needs to know."""
    quantities, count = roles.channels + roles.variables, len(roles.channel_names)
    return Problem(ready, quantities, roles.bindings(), count, colorimetry)


def _search(
    problem: Problem, aim: Goal, effort: int | None, cache: bool, progress: Progress
) -> Remembered | None:
    name = key(problem, aim, effort)
    known = recall(name, problem) if cache else None
    if known is not None:
        return known
    explored = explore(problem, aim, effort or problem.default_effort, progress)
    if explored is None:
        return None
    found = summary(problem, explored)
    if cache and not explored.stopped:
        remember(name, found)
    return found


def _metadata(
    model: Model,
    roles: Roles,
    channels: Sequence[Quantity],
    stated: Mapping[str, str],
    program: Program,
    cost: float,
    verdict: Verdict,
    form: Remembered | None,
    limit: float,
    how: Encoding,
) -> Dictionary:
    types = {q.name: q.type for q in model.quantities}
    constants = {n: value_text(v, types[n]) for n, v in roles.constants.items()}
    facts = {
        "program": f"{operations(program)} operators, {cost:.0f} ns a pixel by the price table",
        "selfcheck": f"CIEDE2000 below {limit:g} at {verdict.points} points of the domain",
        "encoding": str(how),
        "compiler": f"brdfc {__version__}",
        **stated,
    }
    table = prices_in_use()
    if table is not None:  # another table may choose another form, so the profile says so
        facts["prices"] = f"not the shipped table: {table.name}"
    if form is not None:
        last = form.derivation[-1].measured
        facts["form"] = steps_text(form.derivation)
        facts["form.error"] = (
            f"{last.bits:.1f} bits, CIEDE2000 {last.de:.0e} at worst of {form.points} points"
        )
    return metadata(model, channels, roles.variables, constants, facts)
