"""Curves and lookup tables in a line."""

import pytest
from icc_luts import CURVES, staged_lut, table_lut
from icc_profiles import printer

from brdfc.calc.samples import Storage
from brdfc.icc.summaries import summary
from brdfc.icc.types import LocalizedText


@pytest.mark.parametrize(
    ("tag", "text"),
    [
        (CURVES[0], "identity"),
        (CURVES[1], "gamma 2.5"),
        (CURVES[2], "3 samples"),
        (CURVES[4], "function 1 of 2.5 1 -0.25"),
        (table_lut(8, 3, 4, 2), "3 -> 4: curves of 256, 2 x 2 x 2 points of uint8, curves of 256"),
        (
            table_lut(16, 1, 3, 5, 17),
            "1 -> 3: curves of 17, 5 points of uint16, curves of 17",
        ),
        (staged_lut("mAB ", 3, "B"), "3 -> 3: B curves (3 different)"),
        (
            staged_lut("mAB ", 2, "AC3MB"),
            "2 -> 3: A curves (2 different), 2 x 3 points of uint16, M curves (3 different), "
            "matrix, B curves (3 different)",
        ),
        (
            staged_lut("mBA ", 1, "ACB", Storage.UINT8),
            "3 -> 1: B curves (3 different), 2 x 3 x 4 points of uint8, A curves (identity)",
        ),
        (LocalizedText.english("x"), ""),
    ],
)
def test_in_a_line(tag, text):
    assert summary(tag) == text


def test_an_inspection_shows_them(tmp_path):
    from click.testing import CliRunner

    from brdfc.cli.main import cli

    printer().save(tmp_path / "p.icc")
    result = CliRunner().invoke(cli, ["inspect", "--no-engine", str(tmp_path / "p.icc")])
    (line,) = (line for line in result.output.splitlines() if line.startswith("A2B0"))
    assert "AToB0, 4 -> 3: A curves (4 different), 2 x 3 x 4 x 5 points of uint16" in line
    assert "A2B0" not in result.output.partition("other tags")[2]
