"""Documents for the tests of XML, made around what a test is about."""

from __future__ import annotations

from pathlib import Path

from brdfc.calc.program import Program
from brdfc.icc.profile import Profile
from brdfc.icc.types import Pipeline
from brdfc.xml.profile import from_xml

HEADER = """<Header>
    <ProfileVersion>5.00</ProfileVersion>
    <ProfileDeviceClass>scnr</ProfileDeviceClass>
    <DataColourSpace>nc0003</DataColourSpace>
    <PCS>XYZ </PCS>
  </Header>"""


def document(tags: str, header: str = HEADER) -> bytes:
    """A whole profile with these tags."""
    return f"<IccProfile>\n  {header}\n  <Tags>\n{tags}\n</Tags>\n</IccProfile>\n".encode()


def pipeline(elements: str, channels: int = 3) -> bytes:
    """A profile whose AToB1 has these elements."""
    return document(
        "<AToB1Tag><multiProcessElementType>"
        f'<MultiProcessElements InputChannels="{channels}" OutputChannels="{channels}">\n'
        f"{elements}\n</MultiProcessElements></multiProcessElementType></AToB1Tag>"
    )


def calculator(main: str, declarations: str = "", attributes: str = "", channels: int = 3) -> bytes:
    """A profile whose AToB1 is a calculator."""
    return pipeline(
        f'<CalculatorElement InputChannels="{channels}" OutputChannels="{channels}" {attributes}>\n'
        f"{declarations}\n<MainFunction>{main}</MainFunction>\n</CalculatorElement>",
        channels,
    )


def read(data: bytes, folder: Path | str = ".") -> Profile:
    return from_xml(data, Path(folder) / "x.xml")


def program(data: bytes, folder: Path | str = ".") -> Program:
    """The calculator of a profile made by `calculator`."""
    tag = read(data, folder).tags["A2B1"]
    assert isinstance(tag, Pipeline)
    (element,) = tag.elements
    assert isinstance(element, Program)
    return element
