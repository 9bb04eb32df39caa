"""`brdfc xml`, `brdfc compile FILE.xml` and `brdfc inspect`, as a user runs them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from cli_process import run

EXAMPLES = Path(__file__).parents[2] / "examples" / "xml"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Holds a pair of profiles, compiled from a small model."""
    path = tmp_path_factory.mktemp("xml")
    (path / "gloss.brdf").write_text(
        'model gloss "A gloss"\n  cite "our own"\n'
        'channel Rd : XYZ in 0..1 = 0.5 "diffuse reflectance"\n'
        'env incident : angle in -80deg..80deg = 45deg as inci "incidence"\n'
        "radiance = cos(incident)*Rd/pi\n"
    )
    done = run("compile", "gloss.brdf", "-o", "gloss_mvis.icc", cwd=path)
    assert done.returncode == 0, done.stderr
    return path


def test_a_profile_and_its_xml_are_the_same(folder: Path) -> None:
    for name in ("gloss_mid", "gloss_mvis"):
        written = run("xml", f"{name}.icc", "-o", f"{name}.xml", cwd=folder)
        assert written.stdout == f"wrote        {name}.xml\n"
        made = run("compile", f"{name}.xml", "-o", "again.icc", cwd=folder)
        assert made.returncode == 0, made.stderr
        assert made.stderr == ""
        assert (folder / "again.icc").read_bytes() == (folder / f"{name}.icc").read_bytes()
    text = run("xml", "gloss_mvis.icc", cwd=folder).stdout
    assert text == (folder / "gloss_mvis.xml").read_text()
    assert "<!-- env(inci): incident in -80deg..80deg, incidence -->" in text
    assert 'InputNames="Rd[3]" OutputNames="XYZ[3]"' in text


def test_a_document_written_by_hand(tmp_path: Path) -> None:
    made = run("compile", EXAMPLES / "inks.xml", "-o", "inks.icc", cwd=tmp_path)
    assert made.stdout.startswith("wrote        inks.icc, 1,0")
    assert made.stderr == ""
    run("xml", "inks.icc", "-o", "flat.xml", cwd=tmp_path)
    run("compile", "flat.xml", "-o", "flat.icc", cwd=tmp_path)
    pixel = ("--pixel", "0.2,0.5,0.1")
    values = run("eval", "inks.icc", *pixel, cwd=tmp_path).stdout
    assert values == "0.29924804 0.261880338 0.272829175\n"
    assert run("eval", "flat.icc", *pixel, cwd=tmp_path).stdout == values


def test_mistakes_in_a_document(tmp_path: Path) -> None:
    text = (EXAMPLES / "display.xml").read_text()
    for old, new, message in (
        ("#gain mul", "#gian mul", "x.xml:47:17: error: no macro is called 'gian'"),
        ("<GridPoints>2 2 2<", "<GridPoints>2 2 3<", "24 numbers, where 36 are needed"),
        ("out{Z}", "out{Y}", "x.xml, tag 'A2B1', element 0: output 2 is not written on every path"),
        ("clut{crosstalk}", "clut(0)", "element 0, op 41: 'clut' needs a 'clut' element"),
    ):
        assert old in text
        (tmp_path / "x.xml").write_text(text.replace(old, new))
        done = run("compile", "x.xml", "-o", "x.icc", cwd=tmp_path)
        assert (done.returncode, done.stdout) == (1, "")
        assert message in done.stderr
        assert "Traceback" not in done.stderr
        assert not (tmp_path / "x.icc").exists()


def test_options_of_models_are_refused(tmp_path: Path) -> None:
    done = run("compile", EXAMPLES / "inks.xml", "-o", "x.icc", "--set", "m=2", cwd=tmp_path)
    assert done.returncode == 2
    assert "--set is for models; an XML file is compiled as it is" in done.stderr


def test_what_is_wrong_with_a_document_s_profile_is_said(tmp_path: Path) -> None:
    text = (EXAMPLES / "inks.xml").read_text().replace("mediaWhitePointTag", "luminanceTag")
    for name in ("kubelka_munk.xml", "tone.txt"):
        (tmp_path / name).write_text((EXAMPLES / name).read_text())
    (tmp_path / "x.xml").write_text(text)
    done = run("compile", "x.xml", "-o", "x.icc", cwd=tmp_path)
    assert done.returncode == 0
    assert "error: tag 'wtpt': required: wtpt" in done.stderr


def test_inspect(folder: Path) -> None:
    done = run("inspect", "gloss_mvis.icc", "--no-engine", cwd=folder)
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert lines[0].startswith("class         mvis, multiplex visualization; version 5.00, ")
    assert lines[1:5] == [
        "title         A gloss (appearance)",
        "spaces        PCS XYZ; MCS mc0003 (3 channels)",
        "channels      Rdx = 0.4821, Rdy = 0.5, Rdz = 0.41245",
        "variables     inci (incident, -80deg..80deg = 45deg)",
    ]
    assert lines[5] == "M2B0          MToB0, 3 -> 3"
    assert "operators, at most" in done.stdout
    assert lines[-3:] == ["rules         ok", "programs      ok", "portability   ok"]
    assert len(lines) < 25
    assert all(len(line) <= 100 for line in lines)


def test_inspect_for_programs(folder: Path) -> None:
    found = json.loads(run("inspect", "gloss_mvis.icc", "--json", cwd=folder).stdout)
    assert found["channels"][0] == {"name": "Rdx", "default": pytest.approx(0.4821)}
    assert found["variables"] == [
        {
            "signature": "inci",
            "name": "incident",
            "range": "-80deg..80deg",
            "default": "45deg",
        }
    ]
    (transform,) = found["transforms"]
    (element,) = transform["elements"]
    assert element["kind"] == "calculator"
    assert element["calculator"]["operators"] >= sum(element["calculator"]["kinds"].values()) - 1
    assert element["calculator"]["nanoseconds"] > 0
    assert found["metadata"]["model"] == "gloss"
    assert found["verdicts"]["rules"] == []


def test_inspect_of_what_is_no_profile(tmp_path: Path) -> None:
    (tmp_path / "x.icc").write_text("<xml/>")
    done = run("inspect", "x.icc", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr == "error: x.icc: not an ICC profile: it looks like text\n"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"cos \0\0\0\0", b"soc \0\0\0\0", "main function, op 6: no operator has the signature"),
        (b"fl32\0\0\0\0", b"fl32\0\0\0\0\x7f\xc0\0\0", "tag 'mdv ' at byte "),
        (b"utf8\0\0\0\0Rdx", b"utf8\0\0\0\0R\xffx", "name 0 at byte "),
        (
            b"mpet\0\0\0\0\0\3\0\3\0\0\0\1",
            b"mpet\0\0\0\0\0\3\0\3\xff\xff\xff\xff",
            "tag 'M2B0' at byte",
        ),
        (
            b"calc\0\0\0\0\0\3\0\3\0\0\0\0",
            b"calc\0\0\0\0\0\3\0\3\0\1\0\0",
            "65536 sub-elements are",
        ),
    ],
    ids=["operator", "NaN", "UTF-8", "elements", "sub-elements"],
)
def test_profiles_that_are_not_well_formed(
    old: bytes, new: bytes, message: str, folder: Path
) -> None:
    data = (folder / "gloss_mvis.icc").read_bytes()
    at = data.index(old)
    (folder / "bad.icc").write_bytes(data[:at] + new + data[at + len(new) :])
    for command in ("inspect", "xml"):
        done = run(command, "bad.icc", cwd=folder)
        assert (done.returncode, done.stdout) == (1, "")
        assert done.stderr.startswith("error: bad.icc, tag '")
        assert message in done.stderr
        assert done.stderr.count("\n") == 1
