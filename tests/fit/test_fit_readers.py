"""Every format, on files that are generated: what is read, and what of a bad file is said."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path

import numpy as np
import pytest
from generated import WAVELENGTHS, degrees_of, generated, reflected, same

from brdfc.fit.formats import read_measurements
from brdfc.fit.measurements import Kind, Measurements
from brdfc.fit.readers import merl
from brdfc.fit.writing import write_csv
from brdfc.source.errors import MeasurementError


def rows(*columns: np.ndarray, separator: str = ",") -> str:
    table = np.column_stack(columns)
    return "".join(separator.join(map(repr, row)) + "\n" for row in table.tolist())


def cornell(m: Measurements) -> str:
    directions = m.directions[:, [0, 2, 1, 3]]
    words = " ".join(f"{w:g}" for w in m.wavelengths)
    table = rows(directions, m.values, separator=" ")
    return f"# generated, not measured\n{len(m.wavelengths)}\n# wls\n{words}\n\n{table}"


def nist(m: Measurements) -> str:
    incident, reflection, light, viewer = degrees_of(m.directions).T
    names = "lambda,thetai,phi,thetar,phir,f_r11,f_r12/f_r11\n"
    for i, wavelength in enumerate(m.wavelengths):
        flat = np.full(len(m), wavelength / 1000)
        # Light at a negative zenith is at the opposite azimuth.
        names += rows(flat, -incident, light + 180, reflection, viewer, m.values[:, i], 0 * flat)
    return names


def zenith_azimuth(m: Measurements) -> str:
    incident, reflection, light, viewer = degrees_of(m.directions).T
    head = "# generated, lambda = 532 nm\n#\n# phi_i theta_i phi_o theta_o brdf\n"
    values = np.where(np.arange(len(m)) == 0, 1e-4, m.values[:, 0])
    return head + rows(incident, light, reflection, viewer, values, separator="     ")


def astm(m: Measurements) -> str:
    head = f"TITLE generated\nNUM_POINTS {len(m)}\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\n"
    return head + rows(degrees_of(m.directions)[:, [0, 2, 1, 3]], m.values)


def cgats(m: Measurements) -> str:
    names = "SAMPLE_ID SAMPLE_NAME GEOM_I GEOM_R PHI_I PHI_R XYZ_X XYZ_Y XYZ_Z"
    table = np.hstack([degrees_of(m.directions), m.values * 100 * math.pi])
    data = "".join(
        f'{i} "a red, 45" ' + "\t".join(map(repr, row)) + "\n"
        for i, row in enumerate(table.tolist())
    )
    return (
        f'CGATS.17\nORIGINATOR "generated"\nBEGIN_DATA_FORMAT\n{names}\nEND_DATA_FORMAT\n'
        f"NUMBER_OF_SETS {len(m)}\nBEGIN_DATA\n{data}END_DATA\n"
    )


CGATS_COLUMNS = {"columns": {"incident": "GEOM_I", "reflection": "GEOM_R"}}
FORMATS = {
    "cornell": (cornell, generated(Kind.SPECTRAL), {}),
    "nist": (nist, generated(Kind.SPECTRAL), {}),
    "zenith-azimuth": (zenith_azimuth, generated(Kind.SPECTRAL, (532.0,)), {}),
    "astm": (astm, generated(Kind.RGB), {}),
    "cgats": (cgats, generated(Kind.XYZ), CGATS_COLUMNS),
}


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_written_in_a_format_is_read(name: str, tmp_path: Path) -> None:
    write, m, said = FORMATS[name]
    path = tmp_path / "data.txt"
    path.write_text(write(m))
    found = read_measurements(path, **said)
    if name == "zenith-azimuth":  # its first row is the floor
        m = m.selected(np.arange(len(m)) > 0)
        assert "1 rows are below the floor of 0.0002" in found.remarks[0]
    same(found, m, close=1e-12)
    same(read_measurements(path, name, **said), m, close=1e-12)


@pytest.mark.parametrize(
    "m",
    [
        generated(Kind.XYZ),
        generated(Kind.RGB),
        generated(Kind.SPECTRAL),
        generated(Kind.SPECTRAL, ()),
    ],
    ids=lambda m: f"{m.kind.value}-{len(m.wavelengths)}",
)
def test_the_plain_table_is_read_back_equal(m: Measurements, tmp_path: Path) -> None:
    values = m.values.copy()
    values[3, 0] = np.nan if values.shape[1] > 1 else -0.25
    weights = np.linspace(0, 1, len(m))
    turned = m.directions + np.array([0.01, 0.02, 1.0 / 3, -0.1])
    for directions in (m.directions, turned):
        fields = {**vars(m), "values": values, "weights": weights, "directions": directions}
        other = Measurements(**fields)
        write_csv(other, tmp_path / "a.csv")
        again = read_measurements(tmp_path / "a.csv")
        same(again, other)
        assert again.name == "generated"
        first = (tmp_path / "a.csv").read_bytes()
        write_csv(again, tmp_path / "a.csv")
        assert (tmp_path / "a.csv").read_bytes() == first


def plain(text: str, tmp_path: Path, **said: object) -> Measurements:
    path = tmp_path / "plain.csv"
    path.write_text(text)
    return read_measurements(path, **said)


@pytest.mark.parametrize(
    ("unit", "value"),
    [
        ("brdf", 0.25),
        ("1/sr", 0.25),
        ("radiance factor", 0.25 * math.pi),
        ("percent", 25 * math.pi),
        ("brdf-cos-incident", 0.25 * math.cos(math.radians(60))),
        ("brdf-cos-reflection", 0.25 * math.cos(math.radians(20))),
    ],
)
def test_units_of_values(unit: str, value: float, tmp_path: Path) -> None:
    m = plain(f"# unit: {unit}\nincident;reflection;550nm\n60;-20;{value!r}\n", tmp_path)
    assert m.values[0, 0] == pytest.approx(0.25)
    # Without azimuths a negative angle is on the light's own side.
    np.testing.assert_allclose(np.degrees(m.azimuth_differences), [0], atol=1e-9)


@pytest.mark.parametrize(("mirror", "sign"), [("+", 1), ("-", -1)])
def test_the_side_of_the_mirror(mirror: str, sign: int, tmp_path: Path) -> None:
    text = "# unit: brdf\nincident,reflection,value\n"
    for incident in (45, -45):
        m = plain(f"{text}{incident},{sign * incident},1\n", tmp_path, mirror=mirror)
        assert m.azimuth_differences[0] == pytest.approx(math.pi)
        np.testing.assert_allclose(np.degrees(m.directions[0, :2]), [45, 45])


def test_degrees_that_look_like_radians_are_suspected(tmp_path: Path) -> None:
    text = "# unit: brdf\nincident,reflection,value\n0.7,1.2,1\n"
    assert "--angles radians" in plain(text, tmp_path).remarks[0]
    assert plain(text, tmp_path, angles="radians").remarks == ()
    with pytest.raises(MeasurementError, match="a zenith of 70 radians"):
        plain(text.replace("0.7", "70"), tmp_path, angles="radians")


HEAD = "# unit: brdf\nincident,reflection,X,Y,Z\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "the file is empty"),
        ("what is this", "no format of measurements"),
        ("incident,reflection,value\n45,0,1\n", "unit of the values is not declared"),
        (f"{HEAD}45,0,1,1\n", "line 3: 4 values where 5 columns"),
        (f"{HEAD}45,0,1,1,1\n45,zero,1,1,1\n", "line 4: 'zero' where a number belongs"),
        (f"{HEAD}45,,1,1,1\n", "line 3: an angle is missing"),
        (f"{HEAD}45,0,1,inf,1\n", "line 3: a value that is infinite"),
        (f"{HEAD}45,0,,,\n", "no row has a value"),
        (HEAD, "no directions"),
        ("# units: brdf\nincident,reflection,value\n1,1,1\n", "did you mean 'unit'"),
        ("# unit: brd\nincident,reflection,value\n1,1,1\n", "did you mean 'brdf'"),
        ("# unit: brdf\nincident,theta_i,reflection,value\n1,1,1,1\n", "mean the same"),
        ("# unit: brdf\nincident,reflection,colour\n1,1,1\n", "no columns have values"),
        ("# unit: brdf\n# white: 1,2\nincident,reflection,X,Y,Z\n1,1,1,1,1\n", "white is X,Y,Z"),
        (
            "# unit: brdf\nincident,reflection," + ",".join(f"{i}nm" for i in range(100, 6000)),
            "columns; 4,200",
        ),
        ("# unit: brdf\nincident,reflection,phi_i,value\n1,1,1,1\n", "the viewer has none"),
        ("# unit: brdf\n# white: 1,0,1\nincident,reflection,X,Y,Z\n1,1,1,1,1\n", "luminance"),
        ("analytic\n::begin parameters\n", "Disney's BRDF Explorer"),
        ('# ours\nmodel gloss "A model"\n', "a model of brdfc"),
        ("# fits\ngold = Aggregate(Lambertian(albedo=[1,1,1]))", "published parameters"),
    ],
)
def test_bad_tables(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=said) as raised:
        plain(text, tmp_path)
    assert "plain.csv" in str(raised.value)


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("cornell", "\n16\n", "\n15\n", "the last record has 5 of 19 numbers"),
        ("cornell", "\n16\n", "\n99999999\n", "no format|number of wavelengths"),
        ("cornell", "\n16\n", f"\n000001{'0' * 5000}\n", "number of wavelengths|no format"),
        ("cornell", "\n400 ", "\n4000000 ", "no format"),
        ("cornell", " 0.0 ", " x ", "'x' where a number belongs"),
        ("nist", "0.4,", "0.4,one,", "values where 7 columns|where a number belongs"),
        ("zenith-azimuth", "10.0", "ten", "where a number belongs"),
        ("zenith-azimuth", "     0.0     ", "     ", "values where 5 columns"),
        ("astm", "NUM_POINTS 80", "NUM_POINTS 81", "NUM_POINTS is 81, and there are 80 rows"),
        ("astm", "VARS theta_i", "VARS what", "no column has the zenith 'incident'"),
        ("cgats", "SETS 80", "SETS 79", "NUMBER_OF_SETS is 79"),
        ("cgats", "END_DATA\n", "", "BEGIN_DATA has no END_DATA"),
        ("cgats", "GEOM_R", "GEOM_S", "there is no column 'GEOM_R'"),
        ("cgats", "XYZ_X XYZ_Y XYZ_Z", "LAB_L LAB_A LAB_B", "no columns have values"),
    ],
)
def test_bad_files(name: str, old: str, new: str, said: str, tmp_path: Path) -> None:
    write, m, declared = FORMATS[name]
    text = write(m)
    assert old in text
    path = tmp_path / "bad.txt"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(MeasurementError, match=said):
        read_measurements(path, **declared)


@pytest.mark.parametrize("name", FORMATS)
def test_files_that_are_cut_short(name: str, tmp_path: Path) -> None:
    """What is left of a file is read, or refused in words: never anything else."""
    write, m, said = FORMATS[name]
    whole = write(m).encode()
    path = tmp_path / "cut.txt"
    for end in range(0, len(whole), max(1, len(whole) // 60)):
        path.write_bytes(whole[:end])
        with contextlib.suppress(MeasurementError):
            assert len(read_measurements(path, **said)) <= len(m)


def test_what_a_format_states_cannot_be_said(tmp_path: Path) -> None:
    path = tmp_path / "c.brdf"
    path.write_text(cornell(generated(Kind.SPECTRAL)))
    with pytest.raises(MeasurementError, match="takes no 'angles'"):
        read_measurements(path, angles="degrees")
    with pytest.raises(MeasurementError, match="did you mean 'angles'"):
        read_measurements(path, angle="degrees")
    with pytest.raises(MeasurementError, match="did you mean 'cornell'"):
        read_measurements(path, "cornel")
    one = read_measurements(path, wavelength=500)
    assert one.wavelengths == (500.0,)
    with pytest.raises(MeasurementError, match="no values at 505 nm"):
        read_measurements(path, wavelength=505)


def test_rows_of_one_wavelength_are_gathered(tmp_path: Path) -> None:
    for wrong in ("0.532", "", "inf"):
        text = f"# unit: brdf\nincident,reflection,wavelength,value\n45,0,{wrong},1\n"
        with pytest.raises(MeasurementError, match="is no wavelength"):
            plain(text, tmp_path)
    text = "# unit: brdf\nincident,reflection,wavelength,value\n"
    text += "45,0,500,1\n45,0,400,2\n45,10,400,3\n45,0,400,4\n"
    m = plain(text, tmp_path)
    assert m.wavelengths == (400.0, 500.0)
    np.testing.assert_array_equal(m.values, [[2, 1], [3, np.nan], [4, np.nan]])


@pytest.fixture(scope="module")
def merl_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """MERL's layout, of a generated surface; one cell is missing."""
    cells = np.indices(merl.SHAPE).reshape(3, -1).T
    values = reflected(merl._from_cells(cells.astype(float)))
    colours = (values / merl.SCALES[:, None]).astype("<f8")
    colours[1, merl.indices(np.radians([[45.0, 45.0, 0.0, 180.0]]))] = -1
    path = tmp_path_factory.mktemp("merl") / "generated.binary"
    path.write_bytes(np.array(merl.SHAPE, "<i4").tobytes() + colours.tobytes())
    return path


def test_merl_evenly(merl_file: Path) -> None:
    m = read_measurements(merl_file, directions="even", count=3000)
    assert m.kind is Kind.RGB
    assert len(m) == 3000
    np.testing.assert_allclose(m.values, np.tile(reflected(m.directions)[:, None], 3), rtol=1e-9)


def test_merl_in_the_plane(merl_file: Path) -> None:
    m = read_measurements(merl_file)
    assert m.in_plane.all()
    np.testing.assert_allclose(np.degrees(m.incidences), np.arange(5, 86, 5))
    # Cells are a degree wide, and the surface is what it is at their middles.
    assert np.median(np.abs(m.values[:, 0] / reflected(m.directions) - 1)) < 0.02
    assert np.isfinite(m.values).all()


def test_bad_merl(merl_file: Path, tmp_path: Path) -> None:
    short = tmp_path / "short.binary"
    with merl_file.open("rb") as whole:
        short.write_bytes(whole.read(100000))
    with pytest.raises(MeasurementError, match="its size 100,000 bytes"):
        read_measurements(short)
    hostile = tmp_path / "hostile.binary"
    hostile.write_bytes(np.array([2**30, 2**30, 2**30], "<i4").tobytes())
    with pytest.raises(MeasurementError, match="1073741824"):
        read_measurements(hostile, "merl")
    with pytest.raises(MeasurementError, match="1 to 1,000,000"):
        read_measurements(merl_file, count=10**9)
    assert WAVELENGTHS[0] == 400.0
