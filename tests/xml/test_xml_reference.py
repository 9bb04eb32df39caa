"""The ICC's own tools read what brdfc writes, and make the same programs of a document."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

import brdfc
from brdfc.icc.profile import Profile
from brdfc.xml.profile import load_xml, to_xml

TOOLS = ("iccFromXml", "iccToXml")
EXAMPLES = Path(__file__).parents[2] / "examples" / "xml"

pytestmark = pytest.mark.skipif(
    not all(map(shutil.which, TOOLS)), reason="iccFromXml and iccToXml are not installed"
)


def tool(name: str, *paths: Path) -> None:
    # Files that a document names are looked for where the tool runs.
    subprocess.run([name, *map(str, paths)], cwd=paths[0].parent, check=True, capture_output=True)


@pytest.fixture(params=[{}, {"spectral": "400nm..700nm,50nm"}, {"encode": "ncolour"}], ids=str)
def profiles(request: pytest.FixtureRequest, tmp_path: Path) -> list[Path]:
    options = dict(request.param)
    model = brdfc.load("ward", None, options.pop("spectral", None))
    return list(brdfc.compile(model, effort=1, **options).save(tmp_path / "x_mvis.icc"))


def test_they_read_what_is_written(profiles: list[Path], tmp_path: Path) -> None:
    for path in profiles:
        written = Profile.load(path)
        (tmp_path / "x.xml").write_text(to_xml(written))
        tool("iccFromXml", tmp_path / "x.xml", tmp_path / "again.icc")
        again = Profile.load(tmp_path / "again.icc")
        assert dict(again.tags) == dict(written.tags)
        assert replace(again.header, profile_id=written.header.profile_id) == written.header


def test_what_they_write_is_read(profiles: list[Path], tmp_path: Path) -> None:
    """They lose digits and escape metadata twice; structure and names come through."""
    for path in profiles:
        tool("iccToXml", path, tmp_path / "x.xml")
        again, written = load_xml(tmp_path / "x.xml"), Profile.load(path)
        assert list(again.tags) == list(written.tags)
        assert again.tags.get("mcta") == written.tags.get("mcta")
        assert replace(again.header, profile_id=written.header.profile_id) == written.header


@pytest.mark.parametrize("name", ["inks", "display"])
def test_both_make_the_same_of_a_document(name: str, tmp_path: Path) -> None:
    tool("iccFromXml", EXAMPLES / f"{name}.xml", tmp_path / "x.icc")
    assert dict(Profile.load(tmp_path / "x.icc").tags) == dict(
        load_xml(EXAMPLES / f"{name}.xml").tags
    )
