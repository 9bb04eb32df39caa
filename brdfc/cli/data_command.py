from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from brdfc.cli.measurement_options import measurement_options, read

if TYPE_CHECKING:
    from brdfc.fit.measurements import Measurements


@click.command("data")
@click.argument("file")
@measurement_options
@click.option(
    "-o", "output", metavar="COVERAGE.svg", help="Draw where it was measured (.svg, .png)."
)
@click.option("--csv", "table", metavar="DATA.csv", help="Write the measurements as plain CSV.")
def command(file: str, output: str | None, table: str | None, **said: Any) -> None:
    """Summarise measured reflectance: what it covers, and how far it can be trusted.

    FILE is of Cornell's, NIST's or MERL's formats, ASTM E2387 style, CGATS.17, or CSV that declares
    itself (docs/measuring.md).

    \b
    Example:
      brdfc data garnet_red.brdf -o coverage.svg
      brdfc data export.txt --column incident=GEOM_I --column reflection=GEOM_R --csv plain.csv
    """
    from brdfc.files import refuse_same, write_all
    from brdfc.fit.summary import lines
    from brdfc.fit.writing import csv_text
    from brdfc.pictures.draw import picture_kind

    kind = picture_kind(output) if output else ""
    refuse_same([output, table], [file])
    measurements = read(file, **said)
    for line in lines(measurements):
        click.echo(line)
    written: list[tuple[str, bytes]] = []
    if output:
        written.append((output, _coverage(measurements, kind)))
    if table:
        written.append((table, csv_text(measurements).encode()))
    write_all(*written)
    for path, _ in written:
        click.echo(f"{'wrote':<12} {path}")


def _coverage(measurements: Measurements, kind: str) -> bytes:
    import numpy as np

    from brdfc.charts.coverage import by_incidence, rendered_coverage

    incident, zenith, azimuth, reflected = np.degrees(measurements.directions).T
    values = np.nanmean(measurements.values, axis=1)
    panels = by_incidence(incident, zenith, reflected - azimuth, values)
    return rendered_coverage(panels, f"{measurements.name}: {len(measurements):,} directions", kind)
