"""Files, library names and command-line values; and that no text is too strange."""

from __future__ import annotations

import contextlib
import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from brdfc.lang import imports, load
from brdfc.lang.load import library, load_text, parse_value
from brdfc.lang.types import TYPES, spectrum
from brdfc.lang.words import KEYWORDS
from brdfc.source.errors import BrdfcError, ValueGivenError

MODEL = 'model flat "Flat"\nchannel k : reflectance\nradiance = k\n'
MODULE = '# first a comment\nmodule shapes "Shapes"\nlet f(x) = x\n'


@pytest.fixture
def models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A library with one model and one module."""
    (tmp_path / "flat.brdf").write_text(MODEL)
    (tmp_path / "shapes.brdf").write_text(MODULE)
    monkeypatch.setattr(imports, "library_folder", lambda: tmp_path)
    return tmp_path


def test_by_name_and_by_path(models: Path) -> None:
    assert load.load("flat").origin == "flat"
    path = models / "flat.brdf"
    assert load.load(path).origin == str(path)
    assert load.load(str(path)).quantities[0].span.source.name == str(path)


def test_the_library_lists_itself(models: Path) -> None:
    assert models.is_dir()
    assert [(n, e.kind, e.title) for n, e in library().items()] == [
        ("flat", "model", "Flat"),
        ("shapes", "module", "Shapes"),
    ]


def test_the_textbook_form_of_a_library_model_is_no_model_of_its_own(models: Path) -> None:
    assert load.textbook_form("flat") is None
    (models / "textbook").mkdir()
    (models / "textbook" / "flat.brdf").write_text(MODEL.replace('"Flat"', '"As printed"'))
    found = load.textbook_form("flat")
    assert found is not None
    assert found.title == "As printed"
    assert list(library()) == ["flat", "shapes"]
    assert load.textbook_form(models / "flat.brdf") is None


@pytest.mark.parametrize(
    ("reference", "said"),
    [
        ("flta", "there is no library model 'flta'\nhint: did you mean 'flat'?"),
        ("zzz", "hint: the library has: flat, shapes"),
        ("shapes", "'shapes' is a module of functions"),
        ("missing.brdf", "missing.brdf: cannot be read: No such file"),
        ("some/where", "some/where: cannot be read"),
    ],
)
def test_what_is_not_there(models: Path, reference: str, said: str) -> None:
    assert models.is_dir()
    with pytest.raises(BrdfcError) as caught:
        load.load(reference)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (bytes(36) + b"acsp" + bytes(88), "an ICC profile"),
        (MODEL.encode("utf-16"), "UTF-16"),
        (b"\x89PNG\r\n\0\0", "binary"),
        (b"model flat\n\xff\xfe\n", "byte 0xFF in line 2"),
        (b"#" * (1 << 18), "262,144 bytes are more than 131,072"),
    ],
)
def test_files_that_are_no_text(tmp_path: Path, data: bytes, said: str) -> None:
    path = tmp_path / "odd.brdf"
    path.write_bytes(data)
    with pytest.raises(BrdfcError, match=said):
        load.load(path)


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_line_endings_and_byte_order_marks(tmp_path: Path, ending: str, mark: bytes) -> None:
    path = tmp_path / "ends.brdf"
    path.write_bytes(mark + MODEL.replace("\n", ending).encode())
    assert load.load(path).name == "flat"


def test_importing_it_is_cheap() -> None:
    check = "import sys, brdfc.lang.load; sys.exit('lark' in sys.modules or 'numpy' in sys.modules)"
    subprocess.run([sys.executable, "-c", check], check=True)


# ---------------------------------------------------------------- values from the command line


@pytest.mark.parametrize(
    ("text", "type_", "value"),
    [
        ("40deg", "angle", (40 * math.pi / 180,)),
        ("-90deg", "angle", (-math.pi / 2,)),
        ("0.7rad", "angle", (0.7,)),
        ("0.15", "number", (0.15,)),
        (" +1e-3 ", "number", (0.001,)),
        ("(0.1,0.2, 0.3)", "XYZ", (0.1, 0.2, 0.3)),
        ("0.1,0.2,0.3", "XYZ", (0.1, 0.2, 0.3)),
        ("0.5", "XYZ", (0.5, 0.5, 0.5)),
    ],
)
def test_values(text: str, type_: str, value: tuple[float, ...]) -> None:
    assert parse_value(text, TYPES[type_], "q") == value


def test_a_value_for_a_spectrum() -> None:
    assert parse_value("1,2", spectrum(400, 500, 100), "S") == (1.0, 2.0)


@pytest.mark.parametrize(
    ("text", "type_", "said"),
    [
        ("40", "angle", "an angle needs its unit\nhint: write 40deg"),
        ("0", "angle", "an angle needs its unit"),
        ("4nm", "angle", "an angle needs its unit"),
        ("4deg", "number", "a value of type number has no unit\nhint: write 4"),
        ("4grad", "angle", "'grad' is not a unit"),
        ("nan", "number", "not a finite number"),
        ("inf", "number", "not a finite number"),
        ("-inf", "number", "not a finite number"),
        ("1e999", "number", "beyond what can be computed with"),
        ("1e-999", "number", "beyond what can be computed with"),
        ("", "number", "not a finite number"),
        ("abc", "angle", "write, say, 40deg"),
        ("--1", "number", "not a finite number"),
        ("1 2", "number", "is not a number"),
        ("٣", "number", "is not a number"),
        ("1_000", "number", "is not a number"),
        ("9" * 5000, "number", "more than 100 characters"),
        ("1,2", "XYZ", "2 numbers are given and it takes 3 numbers, or one for all"),
        ("1,2", "number", "2 numbers are given and it takes one number"),
        ("1,,2", "XYZ", "not a finite number"),
        ("-1", "roughness", "type roughness is at least 0"),
        ("2", "reflectance", "type reflectance is within 0..1"),
    ],
)
def test_values_that_are_none(text: str, type_: str, said: str) -> None:
    with pytest.raises(ValueGivenError) as caught:
        parse_value(text, TYPES[type_], "q")
    assert said in str(caught.value)


# ---------------------------------------------------------------- strange texts

WORDS = [*sorted(KEYWORDS), "m", "f", "cos", "pi", "number", "angle", "XYZ", "spectrum", "1", "0.5",
         "40deg", "400nm", "..", "+", "-", "*", "/", "^", "(", ")", ",", "=", "<", "==", ":", ".",
         ".x", "->", '"text"', '"', "#", "\n", "\n  ", "\t", "é", "\x00", "\u2028"]  # fmt: skip
TEXTS = st.one_of(
    st.text(max_size=200),
    st.lists(st.sampled_from(WORDS), max_size=60).map(" ".join),
    st.lists(st.sampled_from(WORDS), max_size=60).map("".join),
)
GOOD = """\
model ward "Ward"
channel Rd : XYZ in 0..1
channel m : roughness in 0.001..1 = 0.15
env t : angle in -90deg..90deg = 45deg as inci
let lobe(x) = let q = tan(x)^2/m^2 in exp(-q) / (4*pi*m^2)
radiance = Rd*cos(t)/pi + lobe(t)
  where cos(t) > 0 and t < 80deg else 0
law energy <= 1
example t=40deg m=0.2 -> (1, 2, 3) within 1e-4
"""


def only_clean_errors(text: str) -> None:
    with contextlib.suppress(BrdfcError):
        load_text(text)


@settings(deadline=2000, max_examples=300)
@given(TEXTS)
def test_no_text_is_too_strange(text: str) -> None:
    only_clean_errors(text)


@settings(deadline=2000, max_examples=300)
@given(st.data())
def test_no_damage_to_a_good_text_is_too_strange(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(GOOD)))
    end = data.draw(st.integers(start, min(len(GOOD), start + 20)))
    only_clean_errors(GOOD[:start] + data.draw(TEXTS) + GOOD[end:])


@settings(deadline=2000)
@given(st.binary(max_size=200))
def test_no_file_is_too_strange(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.mktemp("any") / "any.brdf"
    path.write_bytes(data)
    with pytest.raises(BrdfcError):
        load.load(path)
