"""Files that travel with the package: grammars and the model library."""

from __future__ import annotations

from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path


def data_dir(name: str) -> Traversable:
    """The folder `grammars` or `models`: inside an installed wheel, else beside the checkout."""
    packaged = files("brdfc") / "_data" / name
    return packaged if packaged.is_dir() else Path(__file__).resolve().parents[1] / name
