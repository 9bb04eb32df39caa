"""Tables of spectra as people keep them, and every way one can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brdfc.colour.spectrum import Grid, Spectra, interpolation, read_spectra
from brdfc.source.errors import BrdfcError, SpectrumError

GOOD = "400, 1\n500, 2\n600, 4\n700, 3\n"


def table(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "table.csv"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "text",
    [
        GOOD,
        "# a lamp\nwavelength [nm], power\n" + GOOD,
        GOOD.replace(",", ";"),
        GOOD.replace(",", "\t"),
        GOOD.replace(",", " "),
        "\ufeff" + GOOD,
        GOOD.replace("\n", "   # as measured\n\n"),
        GOOD.replace("\n", "\r\n"),
    ],
)
def test_tables_that_people_write(text: str, tmp_path: Path) -> None:
    found = read_spectra(table(tmp_path, text), 1, "illuminant")
    assert found.grid == Grid(400, 700, 4)
    assert found.values.tolist() == [[1, 2, 4, 3]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("600, 4\n", ""), "table.csv, line 3: a gap: 700 nm follows 500 nm"),
        (GOOD.replace("4", "nan", 2).replace("nan00", "400"), "no finite number at 600 nm"),
        (GOOD.replace(", 4", ", inf"), "line 3: no finite number at 600 nm"),
        (GOOD.replace(", 4", ", -4"), "the illuminant is negative at 600 nm"),
        (GOOD.replace(", 4", ", four"), "line 3: not all numbers: '600, four'"),
        (GOOD.replace(", 4", ", 4, 5"), "3 numbers where a wavelength and a value are needed"),
        (GOOD.replace("700", "500"), "500 nm comes after 600 nm; wavelengths have to rise"),
        ("400, 1\n500, 1\n", "2 wavelengths; a spectrum has 3 at least"),
        ("", "0 wavelengths"),
        ("400, 0\n500, 0\n600, 0\n", "the illuminant is 0 everywhere"),
    ],
)
def test_tables_that_are_none(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(SpectrumError) as caught:
        read_spectra(table(tmp_path, text), 1, "illuminant")
    assert message in str(caught.value)


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes(b"\xff\xfe\x00binary")
    with pytest.raises(SpectrumError, match="no text"):
        read_spectra(path, 1, "illuminant")
    with pytest.raises(BrdfcError, match="cannot be read"):
        read_spectra(tmp_path / "absent.csv", 1, "illuminant")


def test_interpolation_is_linear_and_holds_its_ends() -> None:
    grid = Grid(400, 700, 4)
    matrix = interpolation(grid, np.array([300.0, 400, 450, 600, 699, 800]))
    values = matrix @ np.array([1.0, 2, 4, 3])
    np.testing.assert_allclose(values, [1, 1, 1.5, 4, 3.01, 3])
    np.testing.assert_array_equal(matrix.sum(axis=1), 1)


def test_a_cut_keeps_whole_wavelengths() -> None:
    cut = Spectra(Grid(380, 780, 81), np.arange(81.0)[None]).cut(401, 700)
    assert cut.grid == Grid(405, 700, 60)
    assert cut.values[0, 0] == 5
