"""Number arrays as XML, and back."""

from __future__ import annotations

import numpy as np

from brdfc.calc.samples import Storage
from brdfc.icc.layout import MAX_ENTRIES
from brdfc.icc.numbers import NumberArray
from brdfc.xml.document import Node
from brdfc.xml.folder import Folder
from brdfc.xml.names import TYPE_SIGNATURES
from brdfc.xml.writing import rows

_DIGITS = {"fl64": 17}
_STORAGE = {"fl16": Storage.FLOAT16, "fl32": Storage.FLOAT32}


def array_node(tag: NumberArray) -> Node:
    """What stands in the element of the array's type."""
    if tag.kind.startswith("ui"):
        lines = [" ".join(map(str, tag.values[i : i + 16])) for i in range(0, len(tag.values), 16)]
        return Node("Array", lines=lines)
    return Node("Data", lines=rows(tag.values, 8, _DIGITS.get(tag.kind, 9)))


def read_array(node: Node, folder: Folder) -> NumberArray:
    """The array of a type's node."""
    kind = TYPE_SIGNATURES[node.tag]
    whole = kind.startswith("ui")
    child = node.child("Array") or node.child("Data")
    if child is None:
        node.fail(f"<{node.tag}> needs <{'Array' if whole else 'Data'}>")
    if whole:
        words = child.text.split(None, MAX_ENTRIES) if "Filename" not in child.attributes else [""]
        if not all(word.isdecimal() and len(word) <= 20 for word in words):
            child.fail("this holds whole numbers, and names no file")
        return NumberArray(kind, tuple(map(int, words)))
    storage = _STORAGE.get(kind, Storage.FLOAT32)
    values = folder.samples(child, storage=storage)
    if len(values) > MAX_ENTRIES:
        child.fail(f"{len(values):,} numbers are more than {MAX_ENTRIES:,}")
    if kind != "fl64":
        with np.errstate(over="ignore"):
            values = values.astype(storage.dtype).astype(np.float64)
    return NumberArray(kind, tuple(values.tolist()))
