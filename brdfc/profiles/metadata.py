"""What a profile says of itself: model, citation, quantities, compile options, in the `meta` tag.

Entries are short texts under dotted names, so that any tool that lists metadata shows them:

    model               ward
    env.1               incident
    env.1.signature     inci
    env.1.type          angle
    env.1.range         -90deg..90deg
    env.1.default       45deg

Texts over the format's safe length are split over name, name.2, name.3 and so on.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from xml.sax.saxutils import escape

from brdfc.icc.profile import Profile
from brdfc.icc.texts import DICTIONARY_TEXT_LIMIT, Dictionary
from brdfc.lang.model import Model, Quantity
from brdfc.lang.types import TYPES, DeclaredType
from brdfc.lang.values import declared_type, parse_value
from brdfc.source.errors import ValueGivenError

_TEXT_LOSES = 2.0**-22
"""Relative: nine digits of degrees hold an angle to less than two units of a float32."""


@dataclass(frozen=True)
class Described:
    """A quantity as a profile describes it. Numbers are radians for angles, but of samples that
    stand for angles otherwise: an angle is then origin + step times the sample."""

    name: str
    type: DeclaredType
    low: float
    high: float
    default: tuple[float, ...]
    signature: str
    description: str
    origin: float = 0.0
    step: float = 1.0

    @property
    def component_names(self) -> tuple[str, ...]:
        """The names of its channels: Rdx, Rdy, Rdz."""
        return tuple(self.name + suffix for suffix in self.type.suffixes)

    @property
    def range_text(self) -> str:
        return range_text(self.low, self.high, self.type)

    @property
    def reach(self) -> tuple[float, float]:
        """The ends of its range, with what their text may have lost of a float32."""
        slack = _TEXT_LOSES * max(abs(self.low), abs(self.high))
        return self.low - slack, self.high + slack


def value_text(values: Sequence[float], declared: DeclaredType, digits: int = 9) -> str:
    """Numbers as a user writes them: `45deg`, `0.15`, `(0.1,0.2,0.3)`."""
    unit = "deg" if declared.is_angle else ""
    numbers = [math.degrees(v) if declared.is_angle else v for v in values]
    texts = [f"{number:.{digits}g}{unit}" for number in numbers]
    return texts[0] if len(set(texts)) == 1 else f"({','.join(texts)})"


def range_text(low: float, high: float, declared: DeclaredType) -> str:
    """A range as the language writes it: `-90deg..90deg`."""
    return f"{value_text((low,), declared)}..{value_text((high,), declared)}"


def metadata(
    model: Model,
    channels: Sequence[Quantity],
    variables: Sequence[Quantity],
    constants: Mapping[str, str],
    facts: Mapping[str, str],
    unread: Sequence[Quantity] = (),
) -> Dictionary:
    """The `meta` tag of a compiled model. constants: values as text by name; facts: what else the
    compilation has to say; unread: variables that no longer change anything, within their ranges.
    """
    entries: list[tuple[str, str]] = [("model", model.name), ("title", model.title)]
    entries += [(f"citation.{i}", text) for i, text in enumerate(model.citations, 1)]
    entries += [(f"note.{i}", text) for i, text in enumerate(model.notes, 1)]
    entries += [("geometry", model.geometry)] if model.geometry else []
    for role, quantities in (("channel", channels), ("env", variables), ("unread", unread)):
        for i, quantity in enumerate(quantities, 1):
            entries += _quantity_entries(f"{role}.{i}", quantity)
    for i, (name, value) in enumerate(constants.items(), 1):
        entries += [(f"constant.{i}", name), (f"constant.{i}.value", value)]
    entries += facts.items()
    return Dictionary(tuple(piece for name, text in entries for piece in _split(name, text)))


def _quantity_entries(key: str, q: Quantity) -> list[tuple[str, str]]:
    entries = [
        (key, q.name),
        (f"{key}.type", q.type.name),
        (f"{key}.range", range_text(q.low, q.high, q.type)),
        (f"{key}.default", value_text(q.default, q.type)),
        (f"{key}.description", q.description),
    ]
    named = q.signature and key.startswith(("env", "unread"))
    return entries + ([(f"{key}.signature", q.signature)] if named else [])


def _split(name: str, text: str) -> list[tuple[str, str]]:
    pieces = [""]
    for character in text:
        longer = pieces[-1] + character
        if len(escape(longer, {'"': "&quot;", "'": "&apos;"}).encode()) > DICTIONARY_TEXT_LIMIT:
            pieces.append("")
        pieces[-1] += character
    return [(name if i == 1 else f"{name}.{i}", piece) for i, piece in enumerate(pieces, 1)]


def describe(profile: Profile, role: str) -> tuple[Described, ...]:
    """The quantities of a role ("channel", "env" or "unread") a profile describes; none if it does
    not.

    Entries from outside that make no sense are passed over: they are a comment, not a rule.
    """
    meta = profile.tags.get("meta")
    if not isinstance(meta, Dictionary):
        return ()
    found = []
    index = 1
    unit = meta.get("angles") if role == "channel" else None
    while (name := meta.get(f"{role}.{index}")) is not None:
        described = _described(meta, f"{role}.{index}", name)
        if described is not None:
            found.append(_as_sample(described, unit))
        index += 1
    return tuple(found)


def describe_constants(profile: Profile) -> dict[str, str]:
    """The quantities that a profile says were fixed, with their values as text."""
    meta = profile.tags.get("meta")
    found: dict[str, str] = {}
    if isinstance(meta, Dictionary):
        while (name := meta.get(f"constant.{len(found) + 1}")) is not None and name not in found:
            found[name] = meta.get(f"constant.{len(found) + 1}.value") or ""
    return found


def _as_sample(described: Described, unit: str | None) -> Described:
    """A channel as the image has it: an angle may be one in degrees, or 0..1 for its range."""
    if not described.type.is_angle or unit not in ("degrees", "unit"):
        return described
    low, high = described.low, described.high
    if unit == "unit" and low == high:
        return described
    origin, step = (low, high - low) if unit == "unit" else (0.0, math.pi / 180)
    low, high, default = ((v - origin) / step for v in (low, high, described.default[0]))
    sample = replace(described, type=TYPES["number"], low=low, high=high, default=(default,))
    return replace(sample, origin=origin, step=step)


def _described(meta: Dictionary, key: str, name: str) -> Described | None:
    declared = declared_type(meta.get(f"{key}.type") or "")
    low, separator, high = (meta.get(f"{key}.range") or "").partition("..")
    if declared is None or not separator:
        return None
    try:
        ends = [parse_value(end, _free(declared), name)[0] for end in (low, high)]
        default = parse_value(meta.get(f"{key}.default") or "", declared, name)
    except ValueGivenError:
        return None
    signature = meta.get(f"{key}.signature") or ""
    description = meta.get(f"{key}.description") or ""
    return Described(name, declared, ends[0], ends[1], default, signature, description)


def _free(declared: DeclaredType) -> DeclaredType:
    """The same unit, one component: the ends of a range."""
    return TYPES["angle" if declared.is_angle else "number"]
