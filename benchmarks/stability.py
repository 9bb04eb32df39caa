"""Every library model in float32, as brdfc compiles it and as textbooks write it: worst errors.

    python benchmarks/stability.py                        the whole table, some twenty minutes
    python benchmarks/stability.py ward ggx               these models alone
    python benchmarks/stability.py --geometry full ward   in one geometry
    python benchmarks/stability.py --where ward           with the point of each worst error

bits      log2(1 + units in the last place), worst of 20,000 points where methods fail
dE        CIEDE2000, worst of the same points
NaN, inf, negative   results of a million points of the same kinds that are no colour
jumps     discontinuities that the formula does not have, on some 700 lines

`brdfc stability MODEL -o report.html` shows one model with its strata and a picture.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

from brdfc.compiler import compile_model
from brdfc.judge.failures import Counted, Row, overall
from brdfc.judge.rival import as_written, subject
from brdfc.judge.stability import COUNTED, JUDGED, count_failures, judge_strata
from brdfc.lang.load import library, load, textbook_form
from brdfc.prepared import problem_of

COMPILED, TEXTBOOK = "compiled", "as written"
GEOMETRIES = ("plane", "full")
HEADER = (
    f"{'':36}{'compiled by brdfc':^24}  {'as textbooks write it':^51}\n"
    f"{'model':<30}{'':6}{'bits':>5} {'dE':>8} {'failures':>9}"
    f"  {'bits':>5} {'dE':>8} {'NaN':>9} {'infinite':>8} {'negative':>8} {'jumps':>6}"
)


@dataclass(frozen=True)
class Figures:
    """A program's worst errors in all strata, and its failures among many points."""

    worst: Row
    counted: Counted

    @property
    def failures(self) -> int:
        """Results that are no colour, and jumps."""
        f = self.counted.failures
        return f.nan + f.infinite + f.negative + self.worst.jumps


def measured(name: str, geometry: str, judged: int, points: int) -> tuple[Figures, Figures]:
    """A library model as compiled, and its textbook form."""
    compiled = compile_model(load(name, geometry))
    rival = textbook_form(name, geometry)
    assert rival is not None, f"models/textbook has no {name}"
    problem = problem_of(compiled.roles, compiled.formula)
    written = as_written(rival, problem, compiled.roles.constants)
    subjects = [
        subject(COMPILED, compiled.program, problem),
        subject(TEXTBOOK, written, problem),
    ]
    rows = judge_strata(problem, subjects, judged)
    ours, theirs = (
        Figures(overall(rows, counted.method), counted)
        for counted in count_failures(problem, subjects, points)
    )
    return ours, theirs


def line(name: str, geometry: str, ours: Figures, theirs: Figures) -> str:
    failed, worst = theirs.counted.failures, theirs.worst
    return (
        f"{name:<30}{geometry:<6}"
        f"{ours.worst.bits:5.1f} {ours.worst.de.value:8.1e} {ours.failures:9,}"
        f"  {worst.bits:5.1f} {worst.de.value:8.1e}"
        f" {failed.nan:9,} {failed.infinite:8,} {failed.negative:8,} {worst.jumps:6,}"
    )


def places(figures: Figures) -> list[str]:
    worst = figures.worst
    return [
        f"    {worst.method}: {what} at {value.at}"
        for what, value in (("bits", worst.ulp), ("dE", worst.de), ("jump", worst.jump))
        if value.at
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    models = [name for name, entry in library().items() if entry.kind == "model"]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", metavar="MODEL", help="default: all of the library")
    parser.add_argument("--geometry", choices=GEOMETRIES, help="default: both")
    parser.add_argument("--judged", type=int, default=JUDGED, help="points whose error is measured")
    parser.add_argument("--points", type=int, default=COUNTED, help="points only counted")
    parser.add_argument("--where", action="store_true", help="show the points of worst errors")
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.models) - set(models))
    if unknown:
        parser.error(f"the library has no {', '.join(unknown)}")
    print(HEADER, flush=True)
    for name in chosen.models or models:
        for geometry in GEOMETRIES if chosen.geometry is None else (chosen.geometry,):
            ours, theirs = measured(name, geometry, chosen.judged, chosen.points)
            print(line(name, geometry, ours, theirs), flush=True)
            if chosen.where:
                print("\n".join(places(ours) + places(theirs)), flush=True)


if __name__ == "__main__":
    main()
