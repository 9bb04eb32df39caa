"""The ranges of a model's quantities in a scene: said, or measured from an image."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from brdfc.lang.model import Model, Quantity, Role
from brdfc.lang.types import TYPES
from brdfc.lang.values import parse_value
from brdfc.profiles.metadata import range_text, value_text
from brdfc.scenes.measure import Measured, measure
from brdfc.scenes.scene import Scene
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import SceneError, ValueGivenError
from brdfc.symbolic.intervals import Interval, single

Ends = tuple[float, float]


@dataclass(frozen=True)
class Narrowed:
    """The quantities of a model in a scene.

    fixed: those of one value; pixel: variables and constants that come with the pixel; ends: of
    every component of the others that the scene speaks of. measured: what was found in the image,
    where there is one.
    """

    fixed: Mapping[str, tuple[float, ...]]
    pixel: tuple[str, ...]
    ends: Mapping[str, tuple[Ends, ...]]
    measured: Measured | None = None

    @property
    def ranges(self) -> dict[str, tuple[Interval, ...]]:
        """The ends as float32 has them."""
        return {
            name: tuple(Interval(single(low), single(high)) for low, high in ends)
            for name, ends in self.ends.items()
        }

    def quantity(self, q: Quantity) -> Quantity:
        """A quantity with its range in the scene; its default lies in it."""
        ends = self.ends.get(q.name)
        if ends is None:
            return q
        default = tuple(
            min(max(value, low), high) for value, (low, high) in zip(q.default, ends, strict=True)
        )
        low, high = min(low for low, _ in ends), max(high for _, high in ends)
        return replace(q, low=low, high=high, default=default)


def narrowed(
    scene: Scene, model: Model, white: Sequence[float], fixed: Collection[str] = ()
) -> Narrowed:
    """What a scene says of a model whose colours are measured under a white. fixed: the names of
    quantities that someone else fixes; the scene may not speak of them.

    Raises SceneError, with the key, for what the model does not have, for ranges that are empty or
    leave the model's, and for an image that does not fit.
    """
    quantities = {q.name: q.under(white) for q in model.quantities}
    said: dict[str, list[Ends]] = {}
    pixel: list[str] = []
    for section, table in (
        ("variables", scene.variables),
        ("channels", scene.channels),
        ("constants", scene.constants),
    ):
        for name, value in table.items():
            key = f"{section}.{name}"
            q = _quantity(scene, model, quantities, name, key)
            if q.name in said or q.name in fixed:
                raise scene.error(key, f"'{q.name}' is spoken of twice")
            ends = _ends(scene, key, q, value)
            is_range = any(low != high for low, high in ends)
            if section == "channels" and is_range and q.role is not Role.CHANNEL:
                pixel.append(q.name)
            elif section != "channels" and is_range and q.role is Role.CHANNEL:
                raise scene.error(
                    key, f"'{q.name}' is a channel of '{model.name}'", "put it under [channels]"
                )
            elif section == "constants" and is_range:
                raise scene.error(key, "a constant has one value, not a range")
            said[q.name] = [_inside(scene, key, q, e) for e in ends]
    found = (
        _measured(scene, model, quantities, said, pixel, fixed) if scene.image is not None else None
    )
    channels = [q.name for q in quantities.values() if q.role is Role.CHANNEL]
    one = {n: tuple(e[0] for e in ends) for n, ends in said.items() if all(a == b for a, b in ends)}
    if channels and set(channels) <= one.keys() and not pixel:  # a profile has a channel at least
        del one[channels[0]]
    left = {name: tuple(ends) for name, ends in said.items() if name not in one}
    return Narrowed(one, tuple(pixel), left, found)


def _quantity(
    scene: Scene, model: Model, quantities: Mapping[str, Quantity], name: str, key: str
) -> Quantity:
    found = model.quantity(name)
    if found is None:
        hint = did_you_mean(name, quantities) or f"it has {', '.join(quantities)}"
        raise scene.error(key, f"'{model.name}' has no quantity '{name}'", hint)
    return quantities[found.name]


def _ends(scene: Scene, key: str, q: Quantity, value: Any) -> list[Ends]:
    """(low, high) of every component of what a file says of a quantity."""
    width = q.type.value.width
    if isinstance(value, list):
        if len(value) != width:
            needs = "is one number" if width == 1 else f"has {width} components"
            raise scene.error(key, f"{len(value)} values, and '{q.name}' {needs}")
        return [_end(scene, key, q, part) for part in value]
    if isinstance(value, str) and ".." not in value and width > 1:
        try:
            return [(v, v) for v in parse_value(value, q.type, q.name)]
        except ValueGivenError as error:
            raise scene.error(key, error.message, error.hint) from None
    return [_end(scene, key, q, value)] * width


def _end(scene: Scene, key: str, q: Quantity, value: Any) -> Ends:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise scene.error(key, "a value or a range is needed", 'write 0.15 or "0.1..0.2"')
    low, separator, high = str(value).partition("..")
    declared = TYPES["angle" if q.type.is_angle else "number"]
    try:
        ends = [
            parse_value(text, declared, q.name)[0] for text in (low, high if separator else low)
        ]
    except ValueGivenError as error:
        raise scene.error(key, error.message, error.hint) from None
    if ends[0] > ends[1]:
        raise scene.error(key, f"the range {value} is empty", "the lower end comes first")
    return ends[0], ends[1]


def _inside(scene: Scene, key: str, q: Quantity, ends: Ends) -> Ends:
    """A range within the model's own."""
    slack = 1e-9 * max(abs(q.low), abs(q.high))
    if ends[0] < q.low - slack or ends[1] > q.high + slack:
        shown = range_text(*ends, q.type) if ends[0] < ends[1] else value_text(ends[:1], q.type)
        raise scene.error(
            key, f"{shown} leaves the model's range {range_text(q.low, q.high, q.type)}"
        )
    return max(ends[0], q.low), min(ends[1], q.high)


def _measured(
    scene: Scene,
    model: Model,
    quantities: Mapping[str, Quantity],
    said: dict[str, list[Ends]],
    pixel: list[str],
    fixed: Collection[str],
) -> Measured:
    """Ranges of the image's samples, for the quantities the file does not speak of."""
    assert scene.image is not None
    if scene.samples:
        in_image = [
            _quantity(scene, model, quantities, n, "channels.samples") for n in scene.samples
        ]
        if len({q.name for q in in_image}) < len(in_image):
            raise scene.error("channels.samples", "a quantity is named twice")
    else:
        in_image = [q for q in quantities.values() if q.role is Role.CHANNEL or q.name in pixel]
    names = tuple(name for q in in_image for name in q.component_names)
    found = measure(scene.image, names, scene.share, f"{scene.path}: channels.from")
    start = 0
    for q in in_image:
        width = q.type.value.width
        ends = list(found.ranges[start : start + width])
        start += width
        if q.name in said or q.name in fixed:
            for (low, high), name, has in zip(
                said.get(q.name, ()), q.component_names, ends, strict=False
            ):
                if single(has[0]) < single(low) or single(has[1]) > single(high):
                    raise SceneError(
                        f"'{name}' goes from {has[0]:.6g} to {has[1]:.6g} in the image, and the "
                        f"scene says {low:.6g} to {high:.6g}",
                        where=str(scene.image),
                        hint="say nothing of it, or what the image has",
                    )
            if q.name in fixed:
                raise SceneError(
                    f"'{q.name}' is fixed, and comes with the image",
                    where=str(scene.image),
                    hint="leave one of the two out",
                )
            continue
        for (low, high), name in zip(ends, q.component_names, strict=True):
            if low < single(q.low) or high > single(q.high):
                raise SceneError(
                    f"'{name}' goes from {low:.6g} to {high:.6g}, beyond the model's range "
                    f"{range_text(q.low, q.high, q.type)}",
                    where=str(scene.image),
                    hint="correct the image, or give a share of pixels that may be off: share",
                )
        said[q.name] = ends
        if q.role is not Role.CHANNEL and any(a != b for a, b in ends):
            pixel.append(q.name)
    return found
