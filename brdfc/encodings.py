"""How a formula is put into a profile: as a calculator program, or with tables in it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from brdfc.calc.program import Program
from brdfc.codegen.schedule import schedule
from brdfc.codegen.select import select
from brdfc.codegen.tables import clut_program, curve_program
from brdfc.judge.problem import Problem
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.expression import Expression


@dataclass(frozen=True)
class Encoding:
    """kind: "calc", "clut" (a lookup table of everything) or "curve" (a calculator with sampled
    curves for what depends on one channel); points: of the table or of each curve."""

    kind: str = "calc"
    points: int = 0

    def __str__(self) -> str:
        return f"{self.kind}:{self.points}" if self.points else self.kind


def encoding(text: str) -> Encoding:
    """The encoding of --encode: "calc", "clut:17", "curve:1024"."""
    found = re.fullmatch(r"(calc)|(clut|curve):(\d{1,5})", text.strip())
    if not found:
        kind = text.partition(":")[0]
        raise ValueGivenError(
            f"'{text}' is no encoding",
            hint=did_you_mean(kind, ("calc", "clut", "curve")) or "calc, clut:17 or curve:1024",
        )
    return Encoding() if found[1] else Encoding(found[2], int(found[3]))


def encoded(how: Encoding, problem: Problem, safe: Expression) -> Program:
    """The program of a form, guarded."""
    if how.kind == "calc":
        return schedule(select(safe, problem.bindings), problem.inputs)
    make = clut_program if how.kind == "clut" else curve_program
    return make(safe, problem.ranges.domain, problem.bindings, how.points)
