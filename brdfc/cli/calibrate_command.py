from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from brdfc.cmm.calibrate import Calibration


@click.command("calibrate")
@click.option(
    "-o",
    "output",
    metavar="FILE",
    help="Where to write the table; default: prices.toml in the user's config folder.",
)
@click.option("--quick", is_flag=True, help="Fewer programs and passes: about 10 seconds.")
def command(output: str | None, quick: bool) -> None:
    """Measure what each calculator operator costs on the ICC's reference engine, on this machine.

    Later compilations find the table in the user's config folder ($XDG_CONFIG_HOME or ~/.config,
    brdfc/prices.toml) and use it instead of the shipped one; BRDFC_PRICES=FILE names another.
    Takes about half a minute, best on an idle machine.

    \b
    Example:
      brdfc calibrate
      brdfc calibrate --quick -o prices.toml
    """
    from brdfc.calc.prices import VARIABLE, prices_text, user_file
    from brdfc.cmm.calibrate import calibrate
    from brdfc.cmm.clock import ReferenceClock
    from brdfc.files import write_whole
    from brdfc.source.errors import BrdfcError

    clock = ReferenceClock(rounds=4, repeat=3) if quick else ReferenceClock()
    found = calibrate(clock, quick)
    text = prices_text(found.table, _comment(found, quick))
    click.echo(text, nl=False)
    _show_errors(found)
    path = Path(output) if output else user_file()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BrdfcError(f"cannot be made: {error.strerror}", where=str(path.parent)) from error
    write_whole(path, text.encode())
    used = "" if path == user_file() else f"; to use it: {VARIABLE}={path}"
    click.echo(f"wrote {path}{used}")


def _comment(found: Calibration, quick: bool) -> list[str]:
    import os
    import platform
    from datetime import date
    from importlib.metadata import version

    machine = f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors"
    how = "brdfc calibrate" + (" --quick" if quick else "")
    return [
        "Nanoseconds a pixel on the ICC's reference engine, fitted to times of whole programs.",
        f"Measured by `{how}` on {date.today()}: iccdev {version('iccdev')}, {machine}.",
        f"Predictions of other programs were {_summary(found.errors)} off.",
        "",
        "pixel: before any operator. dispatch: any operator. The pairs, beyond a dispatch: the",
        "first component, each further one. Components are the values that `in`, `out`, `tget`,",
        "`tput`, `tsav` and vectors hold, folded beyond the first, pushed by `copy` and `posd`, of",
        "a run of constants (`data`), or moved; of elements: curves, entries of a matrix, weights",
        "and values at the corners of a lookup table. elem, tint, tJab and fJab are not measured",
        "but priced like others.",
    ]


def _show_errors(found: Calibration) -> None:
    from brdfc.calc.prices import shipped

    click.echo(
        f"\nprediction error over {len(found.judges)} programs: {_summary(found.errors)}"
        f"\nshipped table, scaled to this machine: {_summary(found.errors_of(shipped()))}"
    )
    ratios = found.ratios_to(shipped())
    farthest = sorted(ratios, key=lambda name: -abs(ratios[name] - 1))[:5]
    listed = ", ".join(f"{name} {ratios[name]:.2f}" for name in farthest)
    click.echo(f"operators farthest from the shipped ratios: {listed}")


def _summary(errors: object) -> str:
    import numpy as np

    median, most, worst = np.percentile(np.asarray(errors), [50, 90, 100]) * 100
    return f"median {median:.1f} %, 90th percentile {most:.1f} %, worst {worst:.1f} %"
