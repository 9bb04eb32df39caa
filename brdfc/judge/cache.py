"""Searches remembered on disk, by content: the same formula, domain and goal are searched once.

Entries are small JSON files in the user's cache folder ($XDG_CACHE_HOME or ~/.cache, brdfc/forms).
A broken entry counts as none; a folder that cannot be written is no error.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeVar

from brdfc import __version__
from brdfc.calc.binary import decode_element, encode_element
from brdfc.calc.prices import prices
from brdfc.calc.program import Program
from brdfc.files import read_file, write_whole
from brdfc.forms.rules import RULES
from brdfc.judge.explore import Explored
from brdfc.judge.goals import Goal
from brdfc.judge.measure import Measured
from brdfc.judge.problem import Problem
from brdfc.source.errors import BrdfcError
from brdfc.symbolic.expression import Expression, walk
from brdfc.symbolic.guards import Guard, guarded
from brdfc.symbolic.serial import from_data, to_data

_LIMIT = 1 << 20
"""Bytes of an entry; a usual one has ten thousand."""


@dataclass(frozen=True)
class Derived:
    """One form on the way to the chosen one; rule is "" for the formula as written."""

    rule: str
    before: str
    after: str
    price: float
    measured: Measured


@dataclass(frozen=True)
class Remembered:
    """The chosen form, the calculator program it became and the guards that took, its derivation
    (rule, price and figures of each step, the formula as written first), how many forms were
    measured, and whether the search came to its end."""

    expression: Expression
    program: Program
    guards: tuple[Guard, ...]
    derivation: tuple[Derived, ...]
    forms: int
    finished: bool
    points: int


def summary(problem: Problem, explored: Explored) -> Remembered:
    """What of a search is worth keeping."""
    chosen = explored.chosen
    assert chosen.program is not None
    guards = guarded(chosen.form.expression, problem.safe_ranges)[1]
    derivation = tuple(
        Derived(
            c.form.step.rule if c.form.step else "",
            c.form.step.before if c.form.step else "",
            c.form.step.after if c.form.step else "",
            c.price,
            c.measured,
        )
        for c in explored.derivation()
    )
    return Remembered(
        chosen.form.expression,
        chosen.program,
        guards,
        derivation,
        len(explored.candidates),
        explored.finished,
        explored.points,
    )


def key(problem: Problem, goal: Goal, effort: int | None) -> str:
    """A digest of all that a search depends on; effort is None for the default."""
    domain = [[name, i.low, i.high] for name, i in problem.ranges.domain.items()]
    declared = [[name, i.low, i.high] for name, i in (problem.declared or {}).items()]
    quantities = [[q.name, q.type.name] for q in problem.quantities]
    table = prices()
    costs = [[name, p.first, p.more] for name, p in table.operators.items()]
    rules = [[r.name, r.left, r.right, dict(r.needs), r.both] for r in RULES]
    bindings = [[name, repr(b)] for name, b in problem.bindings.items()]
    judged_at = hashlib.sha256()
    for values in problem.final_points(1).values.values():  # a few of each stratum stand for all
        judged_at.update(values.tobytes())
    content = {
        "version": [__version__, rules, judged_at.hexdigest()],
        "formula": to_data(problem.exact),
        "domain": [domain, quantities, bindings, declared],
        "colours": repr(problem.colorimetry),
        "aim": [goal.kind, goal.limit, effort, table.dispatch, costs],
    }
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


def folder() -> Path:
    """Where searches are remembered."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "brdfc" / "forms"


def recall(name: str, problem: Problem) -> Remembered | None:
    """What was found under a problem's key, or None where that is not a form of its quantities."""
    try:
        found = _remembered(json.loads(read_file(folder() / f"{name}.json", _LIMIT)))
    # RuntimeError: no home folder, or brackets nested without end.
    except (BrdfcError, ValueError, LookupError, TypeError, RuntimeError):
        return None
    known = {(q.name, q.type.value.width) for q in problem.quantities}
    used = {(e.name, e.width) for e in walk(found.expression) if e.operator == "quantity"}
    fits = (found.program.inputs, found.program.outputs) == (problem.inputs, problem.exact.width)
    if not used <= known or found.expression.width != problem.exact.width or not fits:
        return None
    return found


def _remembered(data: Any) -> Remembered:
    """What `remember` wrote; an error for anything else."""
    derivation = tuple(_derived(d) for d in data["derivation"])
    return Remembered(
        from_data(data["expression"]),
        _program(data["program"]),
        tuple(Guard(_a(str, o), _a(str, r)) for o, r in data["guards"]),
        (derivation[0], *derivation[1:]),  # never empty
        _a(int, data["forms"]),
        _a(bool, data["finished"]),
        _a(int, data["points"]),
    )


def _program(text: Any) -> Program:
    element = decode_element(bytes.fromhex(_a(str, text)), "remembered program")
    return _a(Program, element)


def _derived(data: Any) -> Derived:
    of = data["measured"]
    bits, mean_bits, de, price = (_a(float, of[k]) for k in ("bits", "mean_bits", "de", "price"))
    rule, before, after = (_a(str, data[k]) for k in ("rule", "before", "after"))
    measured = Measured(bits, mean_bits, de, price, _a(int, of["worst_at"]))
    return Derived(rule, before, after, _a(float, data["price"]), measured)


_Kind = TypeVar("_Kind")


def _a(kind: type[_Kind], value: Any) -> _Kind:
    if type(value) is not kind:
        raise TypeError(f"{value!r} is no {kind.__name__}")
    return value


def remember(name: str, found: Remembered) -> None:
    """Keep what a search found."""
    data = {
        "expression": to_data(found.expression),
        "program": encode_element(found.program).hex(),
        "guards": [[g.operation, g.reason] for g in found.guards],
        "derivation": [asdict(d) for d in found.derivation],
        "forms": found.forms,
        "finished": found.finished,
        "points": found.points,
    }
    with suppress(OSError, BrdfcError, RuntimeError):
        folder().mkdir(parents=True, exist_ok=True)
        write_whole(folder() / f"{name}.json", json.dumps(data).encode())


def holds(name: str) -> bool:
    """Whether something, by its digest, is remembered to be true."""
    try:
        return (folder() / f"{name}.true").exists()
    except (OSError, RuntimeError):  # no home folder, or none that may be read
        return False


def note(name: str) -> None:
    """Remember that something, by its digest, is true."""
    with suppress(OSError, BrdfcError, RuntimeError):
        folder().mkdir(parents=True, exist_ok=True)
        write_whole(folder() / f"{name}.true", b"")


def steps_text(derivation: Sequence[Derived]) -> str:
    """The rules of a derivation in one line."""
    return "; ".join(d.rule for d in derivation if d.rule) or "as written"
