"""A checked model: what the rest of the compiler works on.

Every name in it is known, every type agrees, every range holds its default. Expressions are still
the syntax tree (tree.py); a name in one is looked up in the scope of the definition it stands in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

from brdfc.lang.tree import Expr, Parameter
from brdfc.lang.types import DeclaredType
from brdfc.source.span import Span

HIGHLIGHTS = ("light", "equal")
"""What a highlight without colour of its own looks like: the light, or equal X, Y and Z."""


class Role(Enum):
    """Where a quantity's value comes from: the pixel, the run, or the compilation."""

    CHANNEL = "channel"
    ENV = "env"
    CONSTANT = "constant"


@dataclass(frozen=True)
class Quantity:
    """A declared channel, environment variable or constant.

    low, high and default are in the quantity's own unit, angles in radians; default has one value
    a component. signature is the four-letter name an environment variable has in a profile.
    """

    name: str
    role: Role
    type: DeclaredType
    low: float
    high: float
    default: tuple[float, ...]
    signature: str
    description: str
    span: Span

    @property
    def component_names(self) -> tuple[str, ...]:
        """The names its components have as channels: ('Rdx', 'Rdy', 'Rdz') or ('ks',)."""
        return tuple(self.name + suffix for suffix in self.type.suffixes)

    def under(self, white: Sequence[float]) -> Quantity:
        """The quantity where colours are measured under a white: a reflectance in X, Y, Z is that
        share of the white. Only colours change; their range is one for all components."""
        if not self.type.is_colour:
            return self
        default = tuple(d * w for d, w in zip(self.default, white, strict=True))
        most = max(1.0, *white)
        return replace(self, low=self.low * most, high=self.high * most, default=default)


@dataclass(frozen=True)
class Definition:
    """A `let`, a user function, or a whole model's radiance under its name.

    parameters is None for a plain name. simpler: names in its scope of definitions that are nearly
    the same and cheaper. scope holds what the names in body refer to, besides
    parameters, `pi` and the built-in functions; it is shared by all definitions of a file.
    """

    name: str
    parameters: tuple[Parameter, ...] | None
    body: Expr
    description: str
    span: Span
    scope: Mapping[str, Symbol] = field(repr=False, compare=False)
    simpler: tuple[str, ...] = ()


Symbol = Quantity | Definition


@dataclass(frozen=True)
class Law:
    """A law the model claims, or says it breaks (facts.LAWS has them all).

    bound: of `energy` and `bounded`; quantities: the names that `increasing` is about; condition:
    where the law is claimed, if not everywhere (a truth value of the model's parameters).
    """

    name: str
    bound: float | None
    span: Span
    quantities: tuple[str, ...] = ()
    condition: Definition | None = None

    def __str__(self) -> str:
        text = " ".join((self.name, *self.quantities))
        text += "" if self.bound is None else f" <= {self.bound:g}"
        return f"{text} where {self.condition.body.span.text}" if self.condition else text


@dataclass(frozen=True)
class Breach:
    """A law that a model says it breaks, and by how much at one point.

    given: the value of every quantity by its name, as for an example. figure: the albedo
    (`energy`), the reflectance (`bounded`), the relative difference of both ways (`reciprocal`) or
    the value (`positive`) there; within: the relative difference allowed.
    """

    law: Law
    given: Mapping[str, tuple[float, ...]]
    figure: float
    within: float
    note: str
    span: Span


@dataclass(frozen=True)
class Example:
    """An executable fact of the model.

    given: the value of every quantity by its name, radians for angles; what the text does not give
    has its default. result: one value a component of the radiance. within: the relative difference
    allowed.
    """

    given: Mapping[str, tuple[float, ...]]
    result: tuple[float, ...]
    within: float
    span: Span


@dataclass(frozen=True)
class Model:
    """A model file, checked. quantities are in the order of their declaration."""

    name: str
    title: str
    citations: tuple[str, ...]
    notes: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    radiance: Definition
    definitions: tuple[Definition, ...]
    laws: tuple[Law, ...]
    breaches: tuple[Breach, ...]
    examples: tuple[Example, ...]
    origin: str
    """Where it was read from, as the user would write it: a path, or a library model's name."""
    geometry: str = ""
    """The name of the geometry it was read with; "" where it declares its own angles."""
    highlight: str = "light"
    """Of HIGHLIGHTS."""

    def quantity(self, name: str) -> Quantity | None:
        """The quantity of that name, or of that four-letter signature."""
        for found in self.quantities:
            if name in (found.name, found.signature):
                return found
        return None


@dataclass(frozen=True)
class Module:
    """A file of definitions to import, checked, with the quantities that they rest on."""

    name: str
    title: str
    citations: tuple[str, ...]
    notes: tuple[str, ...]
    definitions: tuple[Definition, ...]
    origin: str
    quantities: tuple[Quantity, ...] = ()
    geometry: str = ""
