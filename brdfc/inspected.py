"""What an inspection of a profile finds: values to be shown, or printed as JSON."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Calculator:
    """A program: operators in all and by kind, nanoseconds a pixel on the reference engine along
    the dearest path, stack, temporaries, variables it reads; refused: why it cannot be run."""

    operators: int
    kinds: dict[str, int]
    nanoseconds: float | None = None
    stack: int | None = None
    temporaries: int | None = None
    variables: tuple[str, ...] = ()
    refused: str | None = None
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True)
class Part:
    """An element: its kind, channels, bytes, size in its own terms; inside: how many elements of
    each kind a calculator calls."""

    kind: str
    inputs: int
    outputs: int
    bytes: int
    size: str = ""
    calculator: Calculator | None = None
    inside: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Transform:
    """A tag of elements; same: the tag that it shares them with."""

    tag: str
    name: str
    inputs: int
    outputs: int
    elements: tuple[Part, ...]
    same: str | None = None


@dataclass(frozen=True)
class OtherTag:
    """A tag of no elements: its name and type; summary: what a curve or lookup table does."""

    name: str
    type: str
    summary: str = ""


@dataclass(frozen=True)
class Channel:
    """A multiplex channel; default is None where the profile has none."""

    name: str
    default: float | None


@dataclass(frozen=True)
class Variable:
    """An environment variable that a program reads, and what the profile says of it."""

    signature: str
    name: str = ""
    range: str = ""
    default: str = ""


@dataclass(frozen=True)
class Inspection:
    """A profile at a glance; see the fields' own types. verdicts: what is wrong, by who says it."""

    path: str
    bytes: int
    device_class: str
    class_name: str
    version: str
    title: str
    spaces: dict[str, str]
    channels: tuple[Channel, ...]
    variables: tuple[Variable, ...]
    transforms: tuple[Transform, ...]
    other_tags: dict[str, OtherTag]
    metadata: dict[str, str]
    verdicts: dict[str, tuple[str, ...]]
