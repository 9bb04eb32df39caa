"""A scene: the angles, coefficients, light and tolerance that a profile is wanted for.

tolerance = 0.1                # CIEDE2000, from the model's own formula
output = "sRGB"                # XYZ (the default), Lab or sRGB
geometry = "plane"             # of models that import one

[light]                        # as the options of brdfc compile
white = [0.97, 1.0, 0.484]

[variables]
incident = "40deg"             # a value
reflection = "-20deg..20deg"   # a range

[channels]
from = "coefficients.tif"      # ranges measured from an image, samples in the model's order
ks = "0.02..0.1"               # or said
Rd = ["0.1..0.2", "0.15..0.3", "0.3..0.6"]   # of each component

[constants]
intensity = 3.14159265
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from brdfc.colour.conditions import ViewingConditions, viewing_conditions
from brdfc.files import read_file
from brdfc.lang.model import HIGHLIGHTS
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import BrdfcError, SceneError

TOLERANCE = 0.01
"""CIEDE2000, where a scene does not say: a hundredth of what a trained observer sees."""
OUTPUTS = ("XYZ", "Lab", "sRGB")
_LONGEST = 1 << 20
_TOP = ("model", "geometry", "tolerance", "output", "share", "light", "variables", "channels")
_LIGHT = ("white", "illuminant", "observer", "surround", "luminance", "adaptation", "highlight")


@dataclass(frozen=True)
class Scene:
    """path: of its file, for messages. variables, channels, constants: by the name of a quantity
    what the file says of it. image: that the other channels are measured from, whose samples are
    those quantities, or the model's channels where there are none. share: of the image's pixels
    that may be farther off than the tolerance."""

    path: str = "scene"
    variables: Mapping[str, Any] = field(default_factory=dict)
    channels: Mapping[str, Any] = field(default_factory=dict)
    constants: Mapping[str, Any] = field(default_factory=dict)
    image: Path | None = None
    samples: tuple[str, ...] = ()
    conditions: ViewingConditions | None = None
    highlight: str | None = None
    model: str | None = None
    geometry: str | None = None
    tolerance: float = TOLERANCE
    output: str = "XYZ"
    share: float = 0.0

    def error(self, key: str, message: str, hint: str | None = None) -> SceneError:
        """An error about what a key says."""
        return SceneError(message, where=f"{self.path}: {key}", hint=hint)


def read_scene(path: str | Path) -> Scene:
    """The scene of a file. Raises SceneError, with the key, for what no scene says; files it names
    are relative to its own folder."""
    name = str(path)
    try:
        data = tomllib.loads(read_file(path, limit=_LONGEST).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise SceneError("this is no text", where=name) from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"not a TOML file: {error}", where=name) from None
    return _scene(data, Scene(name), Path(path).parent)


def _scene(data: Mapping[str, Any], empty: Scene, folder: Path) -> Scene:
    _known(empty, data, (*_TOP, "constants"), "")
    light = _table(empty, data, "light")
    _known(empty, light, _LIGHT, "light.")
    channels = dict(_table(empty, data, "channels"))
    image, samples = channels.pop("from", None), channels.pop("samples", [])
    if image is not None and not isinstance(image, str):
        raise empty.error("channels.from", "the name of a TIFF image is needed")
    if not (isinstance(samples, list) and all(isinstance(s, str) for s in samples)):
        raise empty.error("channels.samples", "a list of names of quantities is needed")
    if samples and image is None:
        raise empty.error("channels.samples", "there is no image whose samples these are")
    highlight = _text(empty, light, "highlight", "light.")
    if highlight is not None and highlight not in HIGHLIGHTS:
        hint = did_you_mean(highlight, HIGHLIGHTS) or " or ".join(HIGHLIGHTS)
        raise empty.error("light.highlight", f"'{highlight}' is no colour of highlights", hint)
    share = _number(empty, data, "share", 0.0)
    if not 0 <= share < 1:
        raise empty.error("share", f"{share:g} is no share of pixels: 0 to less than 1")
    if share > 0 and image is None:
        raise empty.error(
            "share", "pixels are those of an image, and there is none", "channels.from"
        )
    return Scene(
        empty.path,
        _table(empty, data, "variables"),
        channels,
        _table(empty, data, "constants"),
        folder / image if image is not None else None,
        tuple(samples),
        _conditions(empty, light, folder),
        highlight,
        _text(empty, data, "model"),
        _text(empty, data, "geometry"),
        checked_tolerance(_number(empty, data, "tolerance", TOLERANCE), f"{empty.path}: tolerance"),
        _output(empty, _text(empty, data, "output") or "XYZ"),
        share,
    )


def checked_tolerance(value: float, where: str | None = None) -> float:
    """A tolerance in CIEDE2000; SceneError for what none can be."""
    if not 0 < value <= 100:
        raise SceneError(
            f"a tolerance of {value:g} CIEDE2000: it has to be above 0, and 100 at most",
            where=where,
            hint="32-bit floats alone differ by some 0.0003; with 0.001 hardly anything is left "
            "out that changes a colour",
        )
    return value


def _output(empty: Scene, text: str) -> str:
    for known in OUTPUTS:
        if known.lower() == text.lower():
            return known
    hint = did_you_mean(text, OUTPUTS) or ", ".join(OUTPUTS)
    raise empty.error("output", f"'{text}' is nothing to render to", hint)


def _conditions(empty: Scene, light: Mapping[str, Any], folder: Path) -> ViewingConditions | None:
    if not set(light) - {"highlight"}:
        return None
    white = light.get("white")
    if white is not None:
        good = isinstance(white, list) and len(white) == 3 and all(map(_is_number, white))
        if not good:
            raise empty.error("light.white", "three numbers [X, Y, Z] are needed")
    named = {n: _text(empty, light, n, "light.") for n in ("illuminant", "observer")}
    for name, text in named.items():
        if text is not None and (folder / text).is_file():
            named[name] = str(folder / text)
    luminance = _number(empty, light, "luminance", -1.0, "light.") if "luminance" in light else None
    try:
        return viewing_conditions(
            named["illuminant"],
            named["observer"],
            white,
            _text(empty, light, "surround", "light."),
            luminance,
            _text(empty, light, "adaptation", "light."),
        )
    except BrdfcError as error:
        raise empty.error("light", str(error)) from None


def _known(empty: Scene, data: Mapping[str, Any], known: tuple[str, ...], prefix: str) -> None:
    for key in data:
        if key not in known:
            hint = did_you_mean(key, known) or f"there is {', '.join(known)}"
            raise empty.error(f"{prefix}{key}", "a scene has no such key", hint)


def _table(empty: Scene, data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = data.get(key, {})
    if not isinstance(found, dict):
        raise empty.error(key, f"a section [{key}] is needed")
    return found


def _text(empty: Scene, data: Mapping[str, Any], key: str, prefix: str = "") -> str | None:
    found = data.get(key)
    if found is not None and not isinstance(found, str):
        raise empty.error(f"{prefix}{key}", "a text in quotes is needed")
    return found


def _number(
    empty: Scene, data: Mapping[str, Any], key: str, usual: float, prefix: str = ""
) -> float:
    found = data.get(key, usual)
    if not _is_number(found):
        raise empty.error(f"{prefix}{key}", "a number is needed")
    return float(found)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
