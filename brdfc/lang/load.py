"""The way into the language: a path, a library model's name or a text to a checked Model."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from brdfc.files import read_file
from brdfc.lang import tree
from brdfc.lang.imports import (
    DEFAULT_GEOMETRY,
    GEOMETRIES,
    GEOMETRY,
    SUFFIX,
    found_file,
    is_file,
    library_files,
    textbook_files,
)
from brdfc.lang.limits import MAX_IMPORTS, MAX_TEXT
from brdfc.lang.model import Model, Module
from brdfc.lang.report import Report
from brdfc.lang.values import BadValue, parse_spectrum, parse_value
from brdfc.source.diagnostics import Diagnostic, did_you_mean
from brdfc.source.errors import BrdfcError, ModelError
from brdfc.source.span import Source

__all__ = [
    "LibraryEntry",
    "library",
    "load",
    "load_file",
    "load_text",
    "parse_value",
    "textbook_form",
]


_HEADER = re.compile(r'^(model|module)\s+\w+\s+"([^"\n]*)"', re.MULTILINE)


@dataclass(frozen=True)
class LibraryEntry:
    """A file of the library: kind is "model" or "module"."""

    kind: str
    title: str
    path: Path


def load(
    reference: str | Path, geometry: str | Path | None = None, spectral: str | None = None
) -> Model:
    """The checked model of a `.brdf` file, or of the library by its name.

    reference: a path (it exists, ends in .brdf or has a separator in it), else a library name.
    geometry: "plane" (where None), "full", or the reference of another module of angles and
    cosines: what `import geometry` stands for in the model. spectral: wavelengths, such as
    "400nm..700nm,10nm": what is X, Y, Z in the model becomes one value for each of them.
    Raises ModelError with all that is wrong in the text, or BrdfcError where there is none, or
    where a geometry is chosen for a model that imports none.
    """
    found = load_file(reference, geometry, spectral)
    if isinstance(found, Module):
        raise BrdfcError(
            f"'{found.name}' is a module of functions, not a model",
            where=found.origin,
            hint=f"import it into a model: import {found.name} (...)",
        )
    return found


def textbook_form(name: str | Path, geometry: str | Path | None = None) -> Model | None:
    """A library model as textbooks write it, where the library has that: the same quantities, and
    a formula whose digits nobody looked after."""
    path = textbook_files().get(str(name))
    return load(path, geometry) if path else None


def load_file(
    reference: str | Path, geometry: str | Path | None = None, spectral: str | None = None
) -> Model | Module:
    """Like load, but also for modules."""
    path = _path(reference)
    found = _Loader(geometry, spectral).whole(_source(path, str(path)), path, str(reference))
    if geometry is not None and isinstance(found, Model) and not found.geometry:
        raise BrdfcError(
            f"'{found.name}' imports no geometry: its angles are its own",
            where=found.origin,
            hint=f"leave out the geometry, or write the model with: import {GEOMETRY} (...)",
        )
    return found


def load_text(
    text: str, name: str = "<text>", folder: str | Path = ".", geometry: str | None = None
) -> Model | Module:
    """The checked model or module of a text; its imports start from the folder."""
    return _Loader(geometry).whole(Source(name, text), Path(folder) / name, name)


def library() -> dict[str, LibraryEntry]:
    """The library's models and modules by name, from their headers alone."""
    found = {}
    for name, path in library_files().items():
        text = _source(path, str(path)).text
        header = _HEADER.search(text)
        if header:
            found[name] = LibraryEntry(header[1], header[2], path)
    return found


def _geometry_path(reference: str | Path) -> Path:
    """The file of the geometry a user means; BrdfcError where it is none."""
    path = _path(reference, "geometry", GEOMETRIES)
    header = _HEADER.search(_source(path, str(path)).text)
    if header and header[1] == "model":
        message = "this is a model, not a geometry"
        hint = f"the library has the geometries {', '.join(GEOMETRIES)}"
        raise BrdfcError(message, where=str(reference), hint=hint)
    return path


def _path(
    reference: str | Path, what: str = "model", expected: tuple[str, ...] | None = None
) -> Path:
    """The file a user means. expected: the names to suggest, where those are not all."""
    path = Path(reference)
    named = isinstance(reference, str) and not (
        reference.endswith(SUFFIX) or "/" in reference or "\\" in reference
    )
    if is_file(path) or not named:
        return path
    known = library_files()
    if str(reference) in known:
        return known[str(reference)]
    names = expected or tuple(known)
    listed = f"the library has: {', '.join(names)}" if names else None
    raise BrdfcError(
        f"there is no library {what} '{reference}'",
        hint=did_you_mean(str(reference), names) or listed,
    )


def _source(path: Path, shown: str) -> Source:
    """The text of a file; BrdfcError where it is none, or too long."""
    data = read_file(path, limit=MAX_TEXT)
    if data[36:40] == b"acsp":
        raise BrdfcError("this is an ICC profile, not a model's text", where=shown)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise BrdfcError("this is UTF-16 text", where=shown, hint="save it as UTF-8")
    if b"\0" in data:
        raise BrdfcError("this is a binary file, not a model's text", where=shown)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        message = f"this is not UTF-8 text: byte 0x{data[error.start]:02X} in line {line}"
        raise BrdfcError(message, where=shown, hint="save it as UTF-8") from None
    return Source(shown, text.replace("\r\n", "\n").replace("\r", "\n"))


class _Loader:
    """One load: the file asked for and all that it imports, each read and checked once."""

    def __init__(self, geometry: str | Path | None, spectral: str | None = None) -> None:
        self._spectral = parse_spectrum(spectral) if spectral is not None else None
        self._geometry = library_files().get(DEFAULT_GEOMETRY)
        if geometry is not None:
            self._geometry = _geometry_path(geometry)
        self._diagnostics: list[Diagnostic] = []
        self._checked: dict[Path, Model | Module | None] = {}
        # The files being read, the outermost first: as they are found, and as they are shown.
        self._open: dict[Path, str] = {}

    def whole(self, source: Source, path: Path, origin: str) -> Model | Module:
        """The checked file; raises ModelError with the findings of all files."""
        found = self._file(source, path, origin)
        if found is None or self._diagnostics:
            raise ModelError(self._diagnostics)
        return found

    def _file(self, source: Source, path: Path, origin: str) -> Model | Module | None:
        # Here and not above: Lark takes longer to import than all else in this folder together.
        from brdfc.lang.check import check
        from brdfc.lang.parse import parse

        report = Report(source)
        with self._opened(path, source.name):
            imported = partial(self._imported, folder=path.parent, report=report)
            found = check(parse(source), origin, report, imported, self._spectral)
        self._diagnostics += report.diagnostics
        return found

    @contextmanager
    def _opened(self, path: Path, shown: str) -> Iterator[None]:
        self._open[path.resolve()] = shown
        try:
            yield
        finally:
            del self._open[path.resolve()]

    def _imported(
        self, statement: tree.Import, folder: Path, report: Report
    ) -> Model | Module | None:
        """The file an import names; None where it has errors, or where there is none."""
        try:
            stands_for_geometry = statement.target == GEOMETRY and not statement.is_path
            if stands_for_geometry and self._geometry is not None:
                path = self._geometry
            else:
                path = found_file(statement.target, statement.is_path, folder)
            resolved = path.resolve()
            if resolved in self._open:
                shown = list(self._open.values())[list(self._open).index(resolved) :]
                chain = " -> ".join([*shown, shown[0]])
                raise BadValue(f"these files import one another in a circle: {chain}")
            if len(self._open) > MAX_IMPORTS:
                raise BadValue(f"more than {MAX_IMPORTS} files import one another in a row")
            if resolved not in self._checked:
                source = _source(path, str(path))
                found = self._file(source, path, str(path))
                if stands_for_geometry and found is not None:
                    found = replace(found, geometry=found.name)
                self._checked[resolved] = found
        except BadValue as bad:
            report.error(statement.span, bad.message, hint=bad.hint)
            return None
        except BrdfcError as error:
            report.error(statement.span, f"'{statement.target}': {error.message}", hint=error.hint)
            return None
        return self._checked[resolved]
