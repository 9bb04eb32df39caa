"""The table of prices: what every operator costs on the reference engine, measured, as data.

The shipped table is prices.toml beside this file. A table measured on this machine (`brdfc
calibrate`) replaces it: the file BRDFC_PRICES names, else prices.toml in the user's config folder.
"""

from __future__ import annotations

import math
import os
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from brdfc.files import read_file
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import BrdfcError

VARIABLE = "BRDFC_PRICES"
CONTROL = ("if", "if_else", "sel")
"""A plain `if`, one with `else`, and `sel`: what they cost beside the block that runs."""
SHIPPED = Path(__file__).with_name("prices.toml")
_LARGEST = 1e9
_LIMIT = 1 << 20


@dataclass(frozen=True)
class Price:
    """Nanoseconds beyond a dispatch: for the first component, and for each further one."""

    first: float
    more: float


@dataclass(frozen=True)
class Prices:
    """pixel: what a pixel costs before any operator, in MID and MVIS together. dispatch: what any
    operator costs. operators: by name, those of CONTROL too. path: the file, or None for the
    shipped table."""

    pixel: float
    dispatch: float
    operators: Mapping[str, Price]
    path: Path | None = None


def user_file() -> Path:
    """Where `brdfc calibrate` writes, and later compilations look."""
    base = os.environ.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    return Path(base) / "brdfc" / "prices.toml"


@cache
def prices() -> Prices:
    """The table in use, read once a process."""
    named = os.environ.get(VARIABLE)
    if named:
        return read_prices(Path(named))
    own = user_file()
    return read_prices(own) if own.is_file() else shipped()


def prices_in_use() -> Path | None:
    """The file that replaces the shipped table, if any."""
    return prices().path


@cache
def shipped() -> Prices:
    """The table that travels with brdfc."""
    return parse_prices(SHIPPED.read_text(encoding="utf-8"), None)


def read_prices(path: Path) -> Prices:
    """A table from a file; BrdfcError names what is wrong in it."""
    data = read_file(path, _LIMIT)
    try:
        return parse_prices(data.decode("utf-8"), path)
    except UnicodeDecodeError:
        raise _fault(path, "the table of prices is not UTF-8 text") from None


def parse_prices(text: str, path: Path | None) -> Prices:
    """A table from its text. Every operator has its price, and nothing else stands there."""
    from brdfc.calc.operators import OPERATORS

    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _fault(path, f"the table of prices is not TOML: {error}") from None
    sections = ("pixel", "dispatch", "operators", "control")
    _exact(data, sections, "", path)
    found: dict[str, Price] = {}
    for section, names in (("operators", tuple(OPERATORS)), ("control", CONTROL)):
        rows = data[section]
        if not isinstance(rows, dict):
            raise _fault(path, f"'{section}' is not a section of prices")
        _exact(rows, names, f"{section}.", path)
        for name in names:
            pair = rows[name]
            if not isinstance(pair, list) or len(pair) != 2:
                raise _fault(path, f"'{section}.{name}' is not a pair [first, each further]")
            found[name] = Price(*(_number(v, f"{section}.{name}", path) for v in pair))
    pixel, dispatch = (_number(data[key], key, path) for key in sections[:2])
    if dispatch == 0:
        raise _fault(path, "'dispatch' is 0")
    return Prices(pixel, dispatch, found, path)


def prices_text(table: Prices, comment: Iterable[str]) -> str:
    """The text of a table; comment: lines that say how it came about."""
    lines = [f"# {line}".rstrip() for line in comment]
    lines += ["", f"pixel = {table.pixel:.2f}", f"dispatch = {table.dispatch:.2f}"]
    control = {name: table.operators[name] for name in CONTROL}
    operators = {n: p for n, p in table.operators.items() if n not in CONTROL}
    for section, rows in (("control", control), ("operators", operators)):
        lines += ["", f"[{section}]"]
        for name, price in rows.items():
            key = name if name.replace("_", "").isalnum() else f'"{name}"'
            lines.append(f"{key} = [{price.first:.2f}, {price.more:.2f}]")
    return "\n".join(lines) + "\n"


def _exact(rows: Mapping[str, Any], names: Iterable[str], prefix: str, path: Path | None) -> None:
    """Refuse a key that is missing or unknown."""
    expected = tuple(names)
    for name in rows:
        if name not in expected:
            raise _fault(path, f"'{prefix}{name}' is no price", did_you_mean(name, expected))
    for name in expected:
        if name not in rows:
            raise _fault(path, f"'{prefix}{name}' has no price")


def _number(value: Any, key: str, path: Path | None) -> float:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not number or not math.isfinite(value) or not 0 <= value < _LARGEST:
        raise _fault(path, f"'{key}' is not a number of nanoseconds, 0 or more")
    return float(value)


def _fault(path: Path | None, message: str, hint: str | None = None) -> BrdfcError:
    advice = f"`brdfc calibrate` writes a table; without {path}, the shipped one is used"
    return BrdfcError(message, where=str(path or SHIPPED.name), hint=hint or advice)
