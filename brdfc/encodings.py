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

LAYOUTS = ("mcs", "ncolour", "brdf-function", "brdf-struct")
"""How a program is laid out in profiles: see layouts.py."""


@dataclass(frozen=True)
class Encoding:
    """kind: "calc", "clut" (a lookup table of everything) or "curve" (a calculator with sampled
    curves for what depends on one channel); points: of the table or of each curve. layout: of
    LAYOUTS."""

    kind: str = "calc"
    points: int = 0
    layout: str = LAYOUTS[0]

    def __str__(self) -> str:
        return f"{self.kind}:{self.points}" if self.points else self.kind


def encoding(text: str) -> Encoding:
    """The encoding of --encode: "calc", "clut:17", "curve:1024", a layout such as "ncolour", or
    both, "ncolour,clut:17"."""
    form, layout = "", ""
    for word in (part.strip() for part in text.split(",")):
        if word in LAYOUTS and not layout:
            layout = word
        elif word not in LAYOUTS and not form:
            form = word
        else:
            raise ValueGivenError(f"'{text}' says two things", hint="one layout, and one form")
    found = re.fullmatch(r"(calc)|(clut|curve):(\d{1,5})", form or "calc")
    if not found:
        near = did_you_mean(form.partition(":")[0], ("calc", "clut", "curve", *LAYOUTS))
        hint = near or f"calc, clut:17 or curve:1024; and {', '.join(LAYOUTS)}"
        raise ValueGivenError(f"'{form}' is no encoding", hint=hint)
    layout = layout or LAYOUTS[0]
    if found[1]:
        return Encoding(layout=layout)
    return Encoding(found[2], int(found[3]), layout)


def encoded(how: Encoding, problem: Problem, safe: Expression) -> Program:
    """The program of a form, guarded."""
    if how.kind == "calc":
        return schedule(select(safe, problem.bindings), problem.inputs)
    make = clut_program if how.kind == "clut" else curve_program
    return make(safe, problem.ranges.domain, problem.bindings, how.points)
