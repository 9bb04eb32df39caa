"""The syntax tree of a `.brdf` text: statements and expressions, each with its span.

The parser builds it, the checker reads it, and the symbolic stage walks the expressions. Nothing
here knows what a name refers to; that is the checked `Model`'s business (model.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from brdfc.source.span import Span

# ---------------------------------------------------------------- expressions


@dataclass(frozen=True)
class Number:
    """A literal. value is exact, as written; unit is "", "deg", "rad" or "nm"."""

    span: Span
    value: Fraction
    unit: str = ""


@dataclass(frozen=True)
class Name:
    """A name: a quantity, a `let`, a parameter, an imported name, or the constant `pi`."""

    span: Span
    name: str


@dataclass(frozen=True)
class Call:
    """A built-in or user function applied to arguments."""

    span: Span
    function: str
    arguments: tuple[Expr, ...]


@dataclass(frozen=True)
class Unary:
    """operator is "-" or "not"."""

    span: Span
    operator: str
    operand: Expr


@dataclass(frozen=True)
class Binary:
    """operator is one of + - * / ^ < <= > >= == != and or."""

    span: Span
    operator: str
    left: Expr
    right: Expr


@dataclass(frozen=True)
class Where:
    """`value where condition else otherwise`."""

    span: Span
    value: Expr
    condition: Expr
    otherwise: Expr


@dataclass(frozen=True)
class Vector:
    """`(a, b, c)`: two components or more, all scalars."""

    span: Span
    components: tuple[Expr, ...]


@dataclass(frozen=True)
class Component:
    """`v.x`, `v.y`, `v.z`: index 0, 1, 2."""

    span: Span
    vector: Expr
    index: int


@dataclass(frozen=True)
class LetIn:
    """`let name = value in body`, a name for one expression."""

    span: Span
    name: str
    value: Expr
    body: Expr


Expr = Number | Name | Call | Unary | Binary | Where | Vector | Component | LetIn

# ---------------------------------------------------------------- statements


@dataclass(frozen=True)
class Header:
    """`model ward "title"` or `module microfacet "title"`, with its `cite` and `note` clauses, and
    the name after `highlight` ("" where there is none)."""

    span: Span
    kind: str
    name: str
    title: str
    citations: tuple[str, ...]
    notes: tuple[str, ...]
    highlight: str = ""


@dataclass(frozen=True)
class Declaration:
    """`channel | env | constant NAME : TYPE in LOW..HIGH = DEFAULT as SIGNATURE "description"`.

    type_arguments holds what stands in brackets after the type (a spectrum's grid); default holds
    one Number, or one for each component; None where a clause is absent.
    """

    span: Span
    role: str
    name: str
    name_span: Span
    type_name: str
    type_span: Span
    type_arguments: tuple[Number, ...]
    low: Number | None
    high: Number | None
    default: tuple[Number, ...] | None
    signature: str | None
    signature_span: Span | None
    description: str


@dataclass(frozen=True)
class ImportName:
    """One name of an import list: `beckmann` or `beckmann as distribution`."""

    span: Span
    name: str
    alias: str


@dataclass(frozen=True)
class Binding:
    """`m = 0.05` of an import: what stands for a quantity of the imported file."""

    span: Span
    name: str
    value: Expr


@dataclass(frozen=True)
class Import:
    """`import target` (a whole model) or `import target (names)`, `with (bindings)`.

    target is a name or a "path"; alias is what a whole model is called here.
    """

    span: Span
    target: str
    is_path: bool
    alias: str | None
    names: tuple[ImportName, ...]
    bindings: tuple[Binding, ...]


@dataclass(frozen=True)
class Parameter:
    """A parameter of a user function, with the type it was declared with, if any."""

    span: Span
    name: str
    type_name: str | None


@dataclass(frozen=True)
class Let:
    """`let name = body` (parameters is None) or `let name(parameters) = body`; simpler: names of
    what is nearly the same and cheaper."""

    span: Span
    name: str
    name_span: Span
    parameters: tuple[Parameter, ...] | None
    body: Expr
    description: str
    simpler: tuple[Name, ...] = ()


@dataclass(frozen=True)
class Radiance:
    """`radiance = body`: what the model computes."""

    span: Span
    body: Expr


@dataclass(frozen=True)
class Law:
    """`law reciprocal`, `law increasing Rd ks`, `law energy <= 1 where ks <= 0.5`.

    names, bound and condition are empty or None where a law is written without them.
    """

    span: Span
    name: str
    names: tuple[Name, ...]
    bound: Number | None
    condition: Expr | None


@dataclass(frozen=True)
class Given:
    """`name=value` of an example; a vector gives several numbers."""

    span: Span
    name: str
    values: tuple[Number, ...]


@dataclass(frozen=True)
class Breaks:
    """`breaks energy <= 1 incident=85deg -> 1.128 within 1e-3 "why"`: a law the model breaks."""

    span: Span
    name: str
    bound: Number | None
    geometry: str | None
    given: tuple[Given, ...]
    figure: Number
    within: Number | None
    note: str


@dataclass(frozen=True)
class Example:
    """`example a=1 b=40deg -> (x, y, z) within 1e-6`: an executable fact of the model.

    geometry: the one it is stated in (`example in full ...`), None for the usual one.
    """

    span: Span
    geometry: str | None
    given: tuple[Given, ...]
    result: tuple[Number, ...]
    within: Number | None


Statement = Header | Declaration | Import | Let | Radiance | Law | Breaks | Example
