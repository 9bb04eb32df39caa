"""What one file takes from another: finding it, and fitting it to the file that imports it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from brdfc.data import data_dir
from brdfc.lang.model import Definition, Symbol
from brdfc.lang.values import BadValue
from brdfc.source.diagnostics import did_you_mean

SUFFIX = ".brdf"
GEOMETRY = "geometry"
"""The import that stands for the geometry a model is read with."""
DEFAULT_GEOMETRY = "plane"
"""The geometry where none is chosen: signed angles in the plane of incidence."""
GEOMETRIES = (DEFAULT_GEOMETRY, "full")
"""The library's geometries."""


def library_folder() -> Path:
    """The folder of the model library."""
    return Path(str(data_dir("models")))


def library_files() -> dict[str, Path]:
    """The library's files by name, in the order of the names."""
    return {path.stem: path for path in sorted(library_folder().glob(f"*{SUFFIX}"))}


def textbook_files() -> dict[str, Path]:
    """The library's models as textbooks write them, by the name of the model."""
    return {path.stem: path for path in sorted(library_folder().glob(f"textbook/*{SUFFIX}"))}


def found_file(target: str, is_path: bool, folder: Path) -> Path:
    """The file that an import statement in a file of `folder` means.

    A path is relative to that folder; a name is looked for in that folder, then in the library.
    Raises BadValue where there is none, or one in both.
    """
    if is_path:
        path = folder / target
        if not is_file(path):
            raise BadValue(f"there is no file '{target}'", "a path starts from this file's folder")
        return path
    own, library = folder / f"{target}{SUFFIX}", library_files().get(target)
    if not is_file(own):
        if library is None:
            near = {path.stem for path in folder.glob(f"*{SUFFIX}")} | library_files().keys()
            message = f"there is no '{target}{SUFFIX}' beside this file, nor in the library"
            raise BadValue(message, did_you_mean(target, near))
        return library
    if library is not None and not own.samefile(library):
        message = f"'{target}' is ambiguous: it is a file beside this one and in the library"
        raise BadValue(message, f"rename your {target}{SUFFIX}")
    return own


def is_file(path: Path) -> bool:
    """Whether a file is there; also for names that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def standing_for(definition: Definition, given: Mapping[str, Symbol]) -> Definition:
    """The definition, resting on what is given instead of its own quantities of those names."""
    copies: dict[int, dict[str, Symbol]] = {}

    def copied(scope: Mapping[str, Symbol]) -> Mapping[str, Symbol]:
        # All definitions of a file share one scope; their copies share its one copy.
        if id(scope) not in copies:
            copy: dict[str, Symbol] = {}
            copies[id(scope)] = copy
            for name, symbol in scope.items():
                if isinstance(symbol, Definition):
                    copy[name] = replace(symbol, scope=copied(symbol.scope))
                else:
                    copy[name] = given.get(symbol.name, symbol)
        return copies[id(scope)]

    return replace(definition, scope=copied(definition.scope))
