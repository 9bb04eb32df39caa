from __future__ import annotations

import click

from brdfc.cli.options import geometry_option, pairs, whole_number
from brdfc.cli.search_options import end_progress, search_options, shown_progress


@click.command("stability")
@click.argument("model")
@click.option(
    "-o", "output", required=True, metavar="REPORT", help="A .html, .csv, .svg or .png file."
)
@click.option(
    "--against",
    metavar="FILE|NAME",
    help="A model with the same quantities to compare with, as it is written; default: the "
    "textbook form, where the library has one.",
)
@click.option("--set", "fixed", multiple=True, metavar="NAME=VALUE", help="Fix a quantity first.")
@click.option(
    "--points",
    default="1e6",
    callback=whole_number(1, 10**10),
    metavar="N",
    help="Points where NaN, infinities and negative results are counted: 1e6 (default), 1e9.",
)
@click.option(
    "--judged",
    default="20000",
    callback=whole_number(100, 10**7),
    metavar="N",
    help="Points whose error is measured: 20000 (default).",
)
@geometry_option
@search_options
def command(
    model: str,
    output: str,
    against: str | None,
    fixed: tuple[str, ...],
    points: int,
    judged: int,
    geometry: str | None,
    optimize: str,
    max_error: str | None,
    effort: int | None,
) -> None:
    """Show where MODEL fails in float32: worst errors, and what cannot be computed.

    The compiled program is measured against the exact formula in high precision where methods
    fail: at the mirror direction, at grazing angles, at the horizon, at the ends of all ranges.
    Beside it stands the formula as textbooks write it. The page (.html) has a picture over the
    angles and a table; a .csv has the table alone, .svg and .png the picture.

    \b
    Example:
      brdfc stability ward -o ward.html
      brdfc stability ward -o ward.csv --geometry full --points 1e8
      brdfc stability mine.brdf -o mine.html --against theirs.brdf
    """
    import time

    from brdfc.charts.draw import chart_kind
    from brdfc.charts.stability import Report, draw_report
    from brdfc.compiler import compile_model
    from brdfc.judge.error_map import error_map
    from brdfc.judge.failures import overall
    from brdfc.judge.rival import as_written, subject
    from brdfc.judge.stability import count_failures, judge_strata
    from brdfc.lang.load import load, textbook_form
    from brdfc.prepared import problem_of

    kind = chart_kind(output)  # a report that cannot be written is refused before the search
    loaded = load(model, geometry)
    rival = load(against, geometry) if against else textbook_form(model, geometry)
    compiled = compile_model(
        loaded,
        pairs(fixed, "--set"),
        optimize=optimize,
        max_error=max_error,
        effort=effort,
        progress=shown_progress,
    )
    end_progress()
    problem = problem_of(compiled.roles, compiled.formula)
    subjects = [subject("compiled", compiled.program, problem)]
    methods = [("compiled", f"{loaded.name}, as brdfc compiles it")]
    note = "There is no textbook form to compare with; give one with --against."
    if rival is not None:
        program = as_written(rival, problem, compiled.roles.constants)
        subjects.append(subject("as written", program, problem))
        methods.append(("as written", f"{rival.title}: operator by operator, without guards"))
        note = ""
    rows = judge_strata(problem, subjects, judged)
    start = time.perf_counter()
    counted = count_failures(problem, subjects, points)
    seconds = time.perf_counter() - start
    picture = None if kind == ".csv" else error_map(problem, subjects)
    draw_report(Report(loaded.title, tuple(methods), note, rows, counted, picture), output)
    for name, _ in methods:
        worst = overall(rows, name)
        click.echo(
            f"{name:<12} worst {worst.bits:.1f} bits ({worst.ulp.value:.3g} ulp), "
            f"CIEDE2000 {worst.de.value:.1e} at {worst.points:,} points; "
            f"{worst.jumps} discontinuities on {worst.lines} lines"
        )
        click.echo(f"             worst where {worst.ulp.at or 'nothing is wrong'}")
    for c in counted:
        f = c.failures
        click.echo(
            f"{c.method:<12} {f.nan:,} NaN, {f.infinite:,} infinite, {f.negative:,} negative "
            f"of {c.points:,} points"
        )
    click.echo(f"counted      {points * len(subjects) / seconds / 1e6:.1f} million points a second")
    if note:
        click.echo(f"note: {note[0].lower()}{note[1:]}", err=True)
    click.echo(f"wrote        {output}")
