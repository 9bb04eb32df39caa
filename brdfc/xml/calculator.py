"""Calculator elements from XML: declarations, imports, and the main function made of them."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from brdfc.calc.program import MAX_NESTING, MAX_TEMPORARIES, Element, Program
from brdfc.calc.text import Parsed, parse
from brdfc.xml.document import Node, read_document
from brdfc.xml.folder import Folder
from brdfc.xml.schema import check
from brdfc.xml.scope import Macro, Scope, Slice, Variable
from brdfc.xml.values import channels, integer

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_SIZED = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)(?:[\[(]([0-9]{1,6})[\])])?", re.ASCII)

ReadElement = Callable[[Node, int], Element]
"""What reads a sub-element, given how deep it stands in calculators."""


def read_calculator(node: Node, folder: Folder, element: ReadElement, depth: int) -> Program:
    """The program of a CalculatorElement; ProfileError or ProgramError shows what is wrong."""
    if depth > MAX_NESTING:
        node.fail(f"calculators nest deeper than {MAX_NESTING}")
    inputs, outputs = channels(node)
    scope = Scope(inputs, outputs)
    scope.input_names = _channel_names(node, "InputNames", inputs)
    scope.output_names = _channel_names(node, "OutputNames", outputs)
    _Declarations(scope, folder, lambda child: element(child, depth + 1)).read(node)
    main = node.child("MainFunction")
    if main is None:
        node.fail("a calculator needs a <MainFunction>")
    body = scope.function(_parsed(main))
    return Program(inputs, outputs, body, tuple(scope.elements))


def _channel_names(node: Node, attribute: str, count: int) -> dict[str, Slice]:
    """ "a b[2]": a is channel 0, b channels 1 and 2."""
    slices, end = _slices(node, node.attributes.get(attribute, ""), attribute)
    if end > count:
        node.fail(f"{attribute} names {end} channels; there are {count}")
    return slices


def _slices(node: Node, text: str, what: str) -> tuple[dict[str, Slice], int]:
    """Names with their sizes, one after the other, and where the last one ends."""
    slices: dict[str, Slice] = {}
    end = 0
    for word in text.split():
        found = _SIZED.fullmatch(word)
        if found is None:
            node.fail(f"{what}: '{word}' is no name, nor a name with [count]")
        if found[1] in slices:
            node.fail(f"{what}: '{found[1]}' stands there twice")
        size = int(found[2] or 1)
        if size < 1 or end + size > MAX_TEMPORARIES:
            node.fail(f"{what}: '{word}' has an impossible size")
        slices[found[1]] = end, size
        end += size
    return slices, end


def _parsed(node: Node, opening: str = "", closing: str = "") -> Parsed:
    begin, text = node.content()
    assert node.source is not None
    return parse(node.source, begin - len(opening), opening + text + closing)


class _Declarations:
    """Fills a scope from a calculator and from the documents it imports."""

    def __init__(self, scope: Scope, folder: Folder, element: Callable[[Node], Element]) -> None:
        self.scope, self.folder, self.element = scope, folder, element
        self.imported: set[Path] = set()

    def read(self, node: Node, imported: bool = False) -> None:
        for kind, read in (
            ("Imports", self.load),
            ("Variables", self.variable),
            ("Macros", self.macro),
            ("SubElements", self.sub_element),
        ):
            for group in node.named(kind):
                for child in group.children:
                    read(child, imported)

    def load(self, node: Node, _imported: bool) -> None:
        name = node.attributes["Filename"]
        path, data = self.folder.read(node, name)
        real = path.resolve()
        if real in self.folder.open:
            node.fail("imports in a circle: this file is being imported already")
        if len(self.folder.open) >= MAX_NESTING:
            node.fail(f"imports nest deeper than {MAX_NESTING}")
        if real in self.imported:
            return
        self.imported.add(real)
        root = read_document(data, str(path))
        if root.tag != "IccCalcImport":
            root.fail(f"an imported document is an <IccCalcImport>, not a <{root.tag}>")
        check(root)
        self.folder.open.append(real)
        self.read(root, imported=True)
        self.folder.open.pop()

    def variable(self, node: Node, imported: bool) -> None:
        name = _name(node)
        if name in self.scope.variables:
            node.fail(f"a variable '{name}' is declared already")
        members, end = _slices(node, node.text, "members")
        size = max(1, end, integer(node, "Size", 1, MAX_TEMPORARIES))
        position = integer(node, "Position") if "Position" in node.attributes else None
        if position and imported:
            node.fail("an imported variable has no Position")
        if (position or 0) + size > MAX_TEMPORARIES:
            node.fail(f"there are {MAX_TEMPORARIES} temporaries")
        self.scope.variables[name] = Variable(size, members, position)

    def macro(self, node: Node, _imported: bool) -> None:
        name = _name(node)
        known = self.scope.macros.get(name)
        if known is not None:
            if known.text.split() != node.text.split():
                node.fail(f"a macro '{name}' is declared already, with another text")
            return
        slices, size = _slices(node, node.attributes.get("Local", ""), "Local")
        # The brace closes on a line of its own, out of reach of a comment.
        self.scope.macros[name] = Macro(_parsed(node, "{", "\n}"), node.text, slices, size)

    def sub_element(self, node: Node, imported: bool) -> None:
        if "Name" not in node.attributes:
            if imported:
                node.fail("an imported sub-element needs a Name")
            self.scope.elements.append(self.element(node))
            return
        name = _name(node)
        if name in self.scope.named:
            node.fail(f"a sub-element '{name}' is declared already")
        self.scope.named[name] = self.element(node)


def _name(node: Node) -> str:
    name = node.attributes["Name"]
    if not _NAME.fullmatch(name):
        node.fail(f"'{name}' is no name: letters, digits and _, no digit first")
    return name
