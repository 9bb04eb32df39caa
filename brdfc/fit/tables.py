"""Text files as rows of numbers, each with its line."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.files import read_file
from brdfc.fit.measurements import MOST_ROWS
from brdfc.source.errors import BrdfcError, MeasurementError

LARGEST = 1 << 26
"""Bytes of a text: 64 MiB, a spectrum in each of a quarter of a million directions."""
MOST_COLUMNS = 4200
"""A spectrum in steps of a tenth of a nanometre, and angles."""
_MISSING = {"", "nan", "na", "n/a", "-", "null"}


@dataclass(frozen=True, eq=False)
class Table:
    """names: of the columns; numbers: (n, columns) float64, NaN where one is missing; lines: of
    each row in the file; where: the file."""

    names: tuple[str, ...]
    numbers: NDArray[np.float64]
    lines: Sequence[int]
    where: str


def read_text(path: str | Path) -> str:
    """The text of a file; MeasurementError where it is too large or no text."""
    try:
        return read_file(path, limit=LARGEST).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise MeasurementError("this is no text", where=str(path)) from None
    except BrdfcError as error:
        raise MeasurementError(error.message, where=error.where) from None


def content_lines(text: str) -> Iterator[tuple[int, str]]:
    """(line, content) of the lines of a text that hold more than a # comment."""
    for line, content in enumerate(text.splitlines(), start=1):
        content = content.partition("#")[0].strip()
        if content:
            yield line, content


def split(content: str) -> list[str]:
    """The words of a line, between commas, semicolons, tabs or blanks."""
    for separator in ",;\t":
        if separator in content:
            return [word.strip(" \t\"'") for word in content.split(separator)]
    return [word.strip("\"'") for word in content.split()]


def table(names: Sequence[str], rows: Iterable[tuple[int, Sequence[str]]], where: str) -> Table:
    """The words of rows as numbers. rows: (line, words).

    Raises MeasurementError, with the line, for words that are no numbers, for rows that are longer
    or shorter than the names, and for too many of either.
    """
    if len(names) > MOST_COLUMNS:
        message = f"{len(names):,} columns; {MOST_COLUMNS:,} at most are read"
        raise MeasurementError(message, where=where)
    # A flat array: lists of lists would take five times the memory.
    numbers, lines = array("d"), array("q")
    for line, words in rows:
        place = f"{where}, line {line}"
        if len(words) != len(names):
            message = f"{len(words)} values where {len(names)} columns are named"
            raise MeasurementError(message, where=place)
        if len(lines) == MOST_ROWS:
            raise MeasurementError(f"more than {MOST_ROWS:,} rows", where=place)
        lines.append(line)
        numbers.extend(number(word, place) for word in words)
    shaped = np.array(numbers, dtype=np.float64).reshape(len(lines), len(names))
    return Table(tuple(names), shaped, lines.tolist(), where)


def number(word: str, where: str) -> float:
    """A number; NaN for what stands for a missing one."""
    try:
        return float(word)
    except ValueError:
        if word.lower() in _MISSING:
            return math.nan
        message = f"'{word[:40]}' where a number belongs"
        raise MeasurementError(message, where=where) from None
