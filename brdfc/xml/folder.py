"""Files that a document names: beside it or in folders below, and never elsewhere."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.calc.samples import Storage
from brdfc.files import read_file
from brdfc.source.errors import BrdfcError
from brdfc.xml.document import SIZE_LIMIT, Node
from brdfc.xml.values import numbers, parse_numbers

_ENCODINGS = {
    "int8": Storage.UINT8,
    "int16": Storage.UINT16,
    "float16": Storage.FLOAT16,
    "float": Storage.FLOAT32,
}
"""Values of FileEncoding."""


_MOST_FILES = 1000
"""Files read for one document, each as often as it is named."""


class Folder:
    """The folder of a document, how much may still be read from it, and the documents that are
    being imported."""

    def __init__(self, path: Path) -> None:
        self.root = path.resolve()
        self.left = 2 * SIZE_LIMIT
        self.files = 0
        self.open: list[Path] = []

    def read(self, node: Node, name: str) -> tuple[Path, bytes]:
        """The file that a node names, relative to the node's own file; its path and bytes."""
        assert node.source is not None
        shown = Path(node.source.name).parent / name
        try:
            path = shown.resolve()
            inside = path.is_relative_to(self.root) and not Path(name).is_absolute()
            if not inside:
                node.fail(f"'{name}' lies outside the folder of the document")
            if not path.is_file():
                node.fail(f"there is no file '{name}'")
            data = read_file(path, limit=self.left)
        except (OSError, RuntimeError, ValueError) as error:
            node.fail(f"'{name[:80]}' cannot be read: {error}")
        except BrdfcError as error:
            if error.where is None:  # it has its place already
                raise
            node.fail(f"'{name}' cannot be read: {error.message}")
        self.left -= len(data)
        self.files += 1
        if self.files > _MOST_FILES:
            node.fail(f"more than {_MOST_FILES:,} files are read for one document")
        return shown, data

    def samples(
        self, node: Node, count: int | None = None, storage: Storage = Storage.FLOAT32
    ) -> NDArray[np.float64]:
        """The numbers of a node, or of the file it names: text, or binary as Format says.

        storage: how numbers in a file are stored, where FileEncoding does not say; whole numbers
        stand for 0 to 1.
        """
        name = node.attributes.get("Filename") or node.attributes.get("File")
        if not name:
            return numbers(node, count)
        encoding = node.attributes.get("FileEncoding")
        if encoding is not None:
            if encoding not in _ENCODINGS:
                node.fail(f"FileEncoding is {', '.join(_ENCODINGS)}, not '{encoding}'")
            storage = _ENCODINGS[encoding]
        _, data = self.read(node, name)
        form = node.attributes.get("Format", "text")
        if form == "text":
            values = parse_numbers(data.decode("latin-1"))
        elif form == "binary":
            values = _binary(data, storage, node.attributes.get("Endian") == "little")
        else:
            node.fail(f"Format is text or binary, not '{form}'")
        if values is None or not np.isfinite(values).all():
            node.fail(f"'{name}' does not hold finite numbers, as {form}")
        if count is not None and len(values) != count:
            node.fail(f"'{name}' holds {len(values)} numbers, where {count} are needed")
        return values / storage.one


def _binary(data: bytes, storage: Storage, little: bool) -> NDArray[np.float64] | None:
    """The numbers of a binary file; None where it ends within one."""
    dtype = storage.dtype.newbyteorder("<" if little else ">")
    if len(data) % dtype.itemsize:
        return None
    return np.frombuffer(data, dtype).astype(np.float64)
