"""The whole way from a checked model to a pair of profiles, one stage after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from brdfc import __version__
from brdfc.calc.price import operations, price
from brdfc.calc.prices import prices_in_use
from brdfc.calc.program import Program
from brdfc.colour.conditions import ViewingConditions
from brdfc.colours import colours_of
from brdfc.compiled import Compiled
from brdfc.encodings import Encoding, encoded, encoding
from brdfc.icc.types import Dictionary
from brdfc.judge.cache import Remembered, key, recall, remember, steps_text, summary
from brdfc.judge.explore import Explored, explore
from brdfc.judge.goals import Goal, goal
from brdfc.judge.problem import Problem
from brdfc.judge.samples import sample
from brdfc.judge.selfcheck import LIMIT, Verdict, check_finite, self_check
from brdfc.lang.model import Model, Quantity
from brdfc.layouts import device_quantities, layout, pixel_quantities, profiles
from brdfc.prepared import prepare, problem_of
from brdfc.profiles.content import Content
from brdfc.profiles.metadata import metadata, value_text
from brdfc.roles import Roles, Value
from brdfc.sceneplan import Plan, in_scene, plan_for
from brdfc.scenes.scene import Scene
from brdfc.source.errors import BrdfcError, SelfCheckError, ValueGivenError
from brdfc.symbolic.guards import guarded

Progress = Callable[[int, int], None]


def _silent(_done: int, _total: int) -> None:
    """No progress shown."""


def compile_model(
    model: Model,
    set: Mapping[str, Value] | None = None,
    channels: Iterable[str] = (),
    *,
    optimize: str = "balanced",
    max_error: str | None = None,
    effort: int | None = None,
    encode: str = "calc",
    scene: Scene | None = None,
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
    parameters are explained too. scene: that the profiles are for: what cannot be seen in it is
    left out, and its light and tolerance count (then neither optimize nor max_error is given).
    conditions: the light and the observer of the model's colours (None: D50, and the profile says
    no more). highlight: "light", where a highlight without colour has the light's, or "equal",
    where it adds the same to X, Y and Z (None: as the model says, most say the light's). cache: use
    and keep searches on disk. progress gets forms measured and the effort.

    Raises ModelError, ValueGivenError, SceneError, or SelfCheckError when the program does not
    agree with the model.
    """
    aim, how = goal(optimize, max_error), encoding(encode)
    arrangement = layout(how.layout, model, angles, parameters)
    if scene is not None:
        _refuse_beside(scene, how, optimize, max_error)
        conditions = scene.conditions if conditions is None else conditions
        highlight = scene.highlight if highlight is None else highlight
    colours = colours_of(model, conditions, highlight)
    fixed = set or {}
    named = {q.name for name in fixed if (q := model.quantity(name)) is not None}
    pixel = (*channels, *(n for n in pixel_quantities(arrangement, model) if n not in named))
    planned = None
    if scene is not None:
        at = in_scene(model, scene, colours, fixed, pixel, cache)
        planned = plan_for(at)
        ready, roles, problem = at.ready, planned.roles, planned.problem
        aim, limit, samples = planned.goal, scene.tolerance, planned.inside
    else:
        roles, ready = prepare(model, fixed, pixel, cache, colours.formula_white)
        problem = problem_of(roles, ready, colours.colorimetry)
        limit = max(LIMIT, aim.limit if aim.kind == "de" else 0.0)
        samples = sample(ready.domain, roles.channels, roles.variables)
    form = _search(problem, aim, effort, cache, progress)
    if form is not None and how.kind == "calc":
        program, guards = form.program, form.guards
        cost = form.derivation[-1].price
    else:
        start = form.expression if form else problem.start
        safe, guards = guarded(start, problem.safe_ranges)
        program = encoded(how, problem, safe)
        cost = price(program)
    try:
        verdict = self_check(
            program, ready.exact, problem.bindings, samples, limit, problem.colorimetry
        )
    except SelfCheckError as error:
        if planned is not None:
            raise planned.unreachable(error, form) from None
        if how.kind == "calc":
            raise
        hint = "take more points, or allow more with --max-error 0.1dE"
        raise SelfCheckError(error.message, hint=hint) from None
    stated = {**colours.facts(), **arrangement.facts()}
    if planned is not None:
        check_finite(program, problem.bindings, planned.outside, "the model's own ranges")
        stated |= planned.facts()
    own = device_quantities(arrangement, roles)
    unread = planned.unread if planned is not None else ()
    meta = _metadata(model, roles, own, stated, program, cost, verdict, form, limit, how, unread)
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
        model, roles, ready, aim, form, guards, program, cost, verdict, arrangement, made, planned
    )


def _refuse_beside(scene: Scene, how: Encoding, optimize: str, max_error: str | None) -> None:
    """What a scene leaves no choice about."""
    if optimize != "balanced" or max_error is not None:
        raise ValueGivenError(
            "how exact the program has to be is said by the scene",
            hint=f"tolerance = {scene.tolerance:g} in {scene.path}",
        )
    if how.layout != "mcs":
        raise ValueGivenError(f"a scene is compiled to a MID and an MVIS, not to '{how.layout}'")


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
    planned: Plan | None = None,
) -> Explored:
    """Every form of a model that a search finds, measured; arguments as for compile_model.

    planned: for a scene, the forms of what is left of the model there; all that says how exact and
    under which light is the scene's then. Raises BrdfcError where every form fails.
    """
    if planned is not None:
        problem, aim = planned.problem, planned.goal
    else:
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
    unread: Sequence[Quantity],
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
    return metadata(model, channels, roles.variables, constants, facts, unread)
