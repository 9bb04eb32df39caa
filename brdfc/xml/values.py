"""Numbers from attributes and texts; ProfileError shows the place of what is none."""

from __future__ import annotations

import math
import re
import warnings
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from brdfc.source.diagnostics import Diagnostic
from brdfc.source.errors import ProfileError
from brdfc.xml.document import Node


def integer(node: Node, name: str, default: int | None = None, high: int = 0xFFFF) -> int:
    """An attribute that is a whole number from 0 to high."""
    text = node.attributes.get(name)
    if text is None and default is not None:
        return default
    if text is None or not re.fullmatch(r"\s*[0-9]{1,10}\s*", text) or int(text) > high:
        node.fail(f"{name} is a whole number from 0 to {high}, not '{text or ''}'")
    return int(text)


def real(node: Node, name: str) -> float:
    """An attribute that is a finite number."""
    text = node.attributes[name]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        node.fail(f"{name} is a number, not '{text}'")
    return value


def fixed_xyz(node: Node) -> tuple[float, float, float]:
    """X, Y and Z, each the nearest s15Fixed16, as a file has them."""
    x, y, z = (round(real(node, axis) * 65536) / 65536 for axis in "XYZ")
    return x, y, z


def channels(node: Node) -> tuple[int, int]:
    """InputChannels and OutputChannels."""
    return integer(node, "InputChannels"), integer(node, "OutputChannels")


def only_number(node: Node) -> float:
    """The one number that is the text of a node."""
    return float(numbers(node, 1)[0])


def numbers(node: Node, count: int | None = None) -> NDArray[np.float64]:
    """The numbers that are the text of a node, finite, as many as there must be."""
    values = parse_numbers(node.text)
    if values is None or not np.isfinite(values).all():
        _refuse(node)
    if count is not None and len(values) != count:
        node.fail(f"{len(values)} numbers, where {count} are needed")
    return values


def parse_numbers(text: str) -> NDArray[np.float64] | None:
    """The numbers of a text, separated by white space; None where something is none."""
    if not text or text.isspace():
        return np.empty(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # which older NumPy says it with
        try:
            return np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            return None


_NUMBERS = re.compile(
    r"\s*+(?:[+-]?(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE](?:-[0-9]++|\+?[0-9]{1,2}+))?"
    r"(?:\s++|$))*+",
    re.ASCII,
)
"""As many numbers as stand one after the other, none near the end of what floats can hold."""


def _refuse(node: Node) -> NoReturn:
    """Show the first word that is no number, or no finite one."""
    begin, text = node.content()
    found = _NUMBERS.match(text)
    first = begin + (found.end() if found else 0)
    word = re.compile(r"\S*").match(text, first - begin)
    assert node.source is not None
    assert word is not None
    span = node.source.span(first, first + len(word.group()))
    raise ProfileError(str(Diagnostic(span, f"'{word.group()[:40]}' is not a finite number")))


def to_float32(values: NDArray[np.float64] | list[float]) -> tuple[float, ...]:
    """Numbers as a file holds them; too large a number becomes infinite, and is then refused."""
    with np.errstate(over="ignore"):
        return tuple(np.asarray(values, np.float64).astype(np.float32).tolist())


def hexadecimal(node: Node) -> bytes:
    """The bytes that the text of a node spells."""
    try:
        return bytes.fromhex(node.text)
    except ValueError:
        node.fail("this is not hexadecimal, two digits a byte")
