"""What stands between two profiles of a chain: one connection space brought to the other.

Colours are X, Y, Z there, white with Y = 1, under the light of the profile that gives them, as
real numbers; the encodings of the file format end at the profile.
"""

from __future__ import annotations

from brdfc.calc.program import Element, Matrix, Op, Program
from brdfc.colour.difference import D50
from brdfc.engine.trace import Chain, Route
from brdfc.icc.profile import Profile
from brdfc.icc.signatures import space_text
from brdfc.icc.types import NumberArray, Pipeline, Utf8Array
from brdfc.profiles.conditions import profile_white
from brdfc.source.errors import LinkError

Triple = tuple[float, float, float]

NEEDS_SUBSET = 1 << 2
"""The header's flag "MCS needs subset": each of the profile's channels must be one of the other's
(ICC.2, 7.2.11). The order is free; the reference's earlier releases compare by position."""


def from_lab(white: Triple) -> Program:
    """CIELAB to X, Y, Z under a white."""
    body = (Op("in", 0, 3), Op("tXYZ", 1), *_numbers(white), Op("mul", 3), Op("out", 0, 3))
    return Program(3, 3, body)


def to_lab(white: Triple) -> Program:
    """X, Y, Z under a white to CIELAB."""
    body = (Op("in", 0, 3), *_numbers(white), Op("div", 3), Op("tLab", 1), Op("out", 0, 3))
    return Program(3, 3, body)


def _numbers(values: Triple) -> tuple[Op, ...]:
    return tuple(Op("data", value=value) for value in values)


def scaling(factors: Triple, offsets: Triple = (0.0, 0.0, 0.0)) -> Matrix:
    """Each of X, Y, Z by its factor, then its offset."""
    x, y, z = factors
    return Matrix(3, 3, (x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z), offsets)


def inverse_scaling(factors: Triple, offsets: Triple) -> Matrix:
    """The inverse of scaling."""
    x, y, z = (1 / f for f in factors)
    a, b, c = (-o / f for o, f in zip(offsets, factors, strict=True))
    return scaling((x, y, z), (a, b, c))


def colours_joined(
    chain: Chain, source: Profile, destination: Profile, onward: tuple[Element, ...]
) -> Chain:
    """A chain that leads to the source's X, Y, Z, and on by elements that take the destination's.

    What only leads to X, Y, Z and back is left out: CIELAB would be clipped where they are 0.
    """
    between, white = colours_between(source, destination), profile_white(source)
    if between:
        return chain + between + onward
    while chain and onward and _undone(chain[-1], onward[0], white):
        chain, onward = chain[:-1], onward[1:]
    return chain + onward


def _undone(first: Element | Route, second: Element, white: Triple) -> bool:
    """Whether the second takes back what the first does."""
    if first == from_lab(white):
        return second == to_lab(white)
    if not isinstance(first, Matrix) or (first.inputs, first.outputs) != (3, 3):
        return False
    (x, y, z), (a, b, c) = first.values[::4], first.offsets
    factors, offsets = (x, y, z), (a, b, c)
    if not (x and y and z and first == scaling(factors, offsets)):
        return False
    return second == inverse_scaling(factors, offsets)


def colours_between(source: Profile, destination: Profile) -> tuple[Element, ...]:
    """From the source's X, Y, Z to the destination's, by way of D50 where their lights differ."""
    if profile_white(source) == profile_white(destination):
        return ()
    return (*_conversion(source, "c2sp"), *_conversion(destination, "s2cp"))


def _conversion(profile: Profile, signature: str) -> tuple[Element, ...]:
    """A profile's own way to D50 (`c2sp`) or from it (`s2cp`); none where D50 is its white."""
    return () if profile_white(profile) == D50 else custom_conversion(profile, signature).elements


def custom_conversion(profile: Profile, signature: str) -> Pipeline:
    """The tag `c2sp` or `s2cp` of a profile whose light is not D50; LinkError where it has none."""
    tag = profile.tags.get(signature)
    if not isinstance(tag, Pipeline):
        white = ", ".join(f"{v:.4g}" for v in profile_white(profile))
        raise LinkError(
            f"the profile's light has the white ({white}), and the profile does not say how its "
            f"colours come to another: it has no viewing conditions ('svcn', '{signature}')",
            hint="compile it with --white or --illuminant",
        )
    sizes = [(e.inputs, e.outputs) for e in tag.elements]
    if (tag.inputs, tag.outputs) != (3, 3) or any(size != (3, 3) for size in sizes):
        raise LinkError(f"'{signature}' takes {tag.inputs} values to {tag.outputs}, not 3 to 3")
    return tag


def channels_between(source: Profile, destination: Profile) -> tuple[Route, tuple[str, ...]]:
    """From the source's multiplex channels to the destination's, by their names; and the names of
    those that take their default (`mdv `), or 0.

    Raises LinkError where nothing has the same name, or a profile that needs it (NEEDS_SUBSET) does
    not find all of its channels in the other.
    """
    given, wanted = channel_names(source), channel_names(destination)
    sources = tuple(given.index(name) if name in given else None for name in wanted)
    if all(index is None for index in sources):
        raise LinkError(
            f"the profiles have no channel in common: {', '.join(given)} and {', '.join(wanted)}",
            hint="compile both from one model, or check that the names agree byte for byte",
        )
    _check_subset(source, given, wanted, "first")
    _check_subset(destination, wanted, given, "second")
    values = defaults(destination, len(wanted))
    missing = tuple(n for n, index in zip(wanted, sources, strict=True) if index is None)
    return Route(sources, values), missing


def _check_subset(
    profile: Profile, own: tuple[str, ...], others: tuple[str, ...], place: str
) -> None:
    missing = [name for name in own if name not in others]
    if profile.header.flags & NEEDS_SUBSET and missing:
        raise LinkError(
            f"the {place} profile asks that the other has all of its channels (flag 'MCS needs "
            f"subset'), and it has not: {', '.join(missing)}",
        )


def channel_names(profile: Profile) -> tuple[str, ...]:
    """The names of a profile's multiplex channels; LinkError where it has none."""
    tag = profile.tags.get("mcta")
    if not isinstance(tag, Utf8Array):
        raise LinkError("the profile names no channels ('mcta')")
    return tag.names


def defaults(profile: Profile, count: int) -> tuple[float, ...]:
    """The defaults of a profile's multiplex channels (`mdv `), zeros where it states none."""
    tag = profile.tags.get("mdv ")
    if not isinstance(tag, NumberArray):
        return (0.0,) * count
    if len(tag.values) != count:
        raise LinkError(f"{len(tag.values)} defaults ('mdv ') for {count} channels")
    return tag.scaled


_COMPONENTS: dict[bytes, tuple[str, ...]] = {
    b"GRAY": ("gray",),
    b"RGB ": ("R", "G", "B"),
    b"CMY ": ("C", "M", "Y"),
    b"CMYK": ("C", "M", "Y", "K"),
    b"XYZ ": ("X", "Y", "Z"),
    b"Lab ": ("L", "a", "b"),
    b"Luv ": ("L", "u", "v"),
    b"YCbr": ("Y", "Cb", "Cr"),
    b"Yxy ": ("Y", "x", "y"),
    b"HSV ": ("H", "S", "V"),
    b"HLS ": ("H", "L", "S"),
}


def component_names(space: bytes, count: int) -> tuple[str, ...]:
    """Names for the values of a device space of so many channels; numbers where it has none."""
    known = _COMPONENTS.get(space, ())
    return known if len(known) == count else tuple(map(str, range(count)))


def named_space(space: bytes) -> str:
    """A device space as messages name it."""
    return space_text(space).strip() or "no space"
