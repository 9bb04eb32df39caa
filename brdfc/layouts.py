"""How a compiled program is laid out in profiles: one option, four encodings of the same model.

mcs            a MID and an MVIS, joined in the multiplex connection space; angles are variables
ncolour        one profile of n-colour device values, the angles among them (`A2B1`)
brdf-function  one profile with four angles before the device values (`bABx`), and `A2B1`
brdf-struct    one profile with the model's name and parameters for a renderer (`bcpx`), and `A2B1`
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from brdfc.colours import Colours
from brdfc.icc.profile import Profile
from brdfc.icc.types import Tag
from brdfc.lang.model import Model, Quantity, Role
from brdfc.laws.reflectance import in_full_geometry
from brdfc.profiles.angles import Sample, angle_unit, plain, ranged
from brdfc.profiles.brdf_function import ANGLES, brdf_function_profile
from brdfc.profiles.brdf_structure import (
    Parameter,
    RegisteredModel,
    parameter_order,
    registered,
    structure,
)
from brdfc.profiles.content import Content
from brdfc.profiles.device import device_profile
from brdfc.profiles.multiplex import profile_pair
from brdfc.roles import Roles
from brdfc.source.errors import ValueGivenError

USUAL_ANGLES = {"ncolour": "radians", "brdf-function": "unit"}
"""The layouts with angles among their device values, and the usual unit of those."""


@dataclass(frozen=True)
class Layout:
    """name: of encodings.LAYOUTS. angles: the unit of angles among device values (angles.UNITS),
    where the layout has some. parameters: how a structure's go (brdf_structure.ORDERS)."""

    name: str
    angles: str = ""
    parameters: str = ""

    def facts(self) -> dict[str, str]:
        """What a profile's metadata says of it."""
        facts = {} if self.name == "mcs" else {"layout": self.name}
        facts |= {"angles": self.angles} if self.angles else {}
        return facts | ({"parameters": f"by {self.parameters}"} if self.parameters else {})


def layout(
    name: str, model: Model, angles: str | None = None, parameters: str | None = None
) -> Layout:
    """The layout of a model; ValueGivenError where the model has none of that name, or where a
    choice is made that it does not have."""
    if angles is not None and name not in USUAL_ANGLES:
        raise ValueGivenError(f"'{name}' has no angles among its device values")
    if parameters is not None and name != "brdf-struct":
        raise ValueGivenError(f"'{name}' has no parameters in an order")
    if name == "brdf-function" and not in_full_geometry(model):
        raise ValueGivenError(
            f"'{model.name}' has its angles in the plane of incidence; a BRDF function takes "
            "zeniths and azimuths",
            hint="compile it with --geometry full",
        )
    if name == "brdf-struct":
        registered(model)
        return Layout(name, parameters=parameter_order(parameters or "channel"))
    usual = USUAL_ANGLES.get(name)
    return Layout(name, angle_unit(angles or usual) if usual else "")


def pixel_quantities(how: Layout, model: Model) -> tuple[str, ...]:
    """The variables that come with the pixel in this layout: all, where angles are samples."""
    if how.name not in USUAL_ANGLES:
        return ()
    return tuple(q.name for q in model.quantities if q.role is Role.ENV)


def device_quantities(how: Layout, roles: Roles) -> tuple[Quantity, ...]:
    """The quantities whose components are device values, in their order."""
    if how.name != "brdf-function":
        return roles.channels
    return tuple(q for q in roles.channels if q.name not in ANGLES)


def profiles(
    how: Layout, model: Model, roles: Roles, content: Content, colours: Colours
) -> tuple[Profile, ...]:
    """The profiles of a compiled model: a MID and an MVIS, or one."""
    if how.name == "mcs":
        pair = profile_pair(content)
        return pair.mid, pair.mvis
    if how.name == "ncolour":
        samples = _samples(roles.channels, how.angles)
        return (device_profile(content, samples, len(samples)),)
    if how.name == "brdf-function":
        places = _places(roles)
        angles = {name: places[name].start for name in ANGLES if name in places}
        still = {q.name: q.default[0] for q in roles.channels if q.name in angles}
        read = _samples(device_quantities(how, roles), how.angles)
        return (brdf_function_profile(content, angles, still, how.angles, read),)
    count = len(roles.channel_names)
    more = _structures(registered(model), how, roles, content, colours)
    return (device_profile(content, [plain(i) for i in range(count)], count, more),)


def _places(roles: Roles) -> dict[str, Parameter]:
    """The device values of each channel quantity."""
    found, start = {}, 0
    for q in roles.channels:
        found[q.name] = Parameter(start, q.type.value.width)
        start += q.type.value.width
    return found


def _samples(quantities: Sequence[Quantity], unit: str) -> list[Sample]:
    """How quantities come from an image that has their components in this order."""
    found: list[Sample] = []
    for q in quantities:
        if q.type.is_angle:
            found.append(ranged(len(found), q.low, q.high, unit))
        else:
            found += [plain(len(found) + i) for i in range(q.type.value.width)]
    return found


def _structures(
    kind: RegisteredModel, how: Layout, roles: Roles, content: Content, colours: Colours
) -> Mapping[str, Tag]:
    """`bcp0` and `bcp1`, or of spectra `bsp0` and `bsp1`."""
    places = _places(roles)
    for name in kind.parameters:
        if name not in places and name not in roles.constants:
            raise ValueGivenError(
                f"the parameter '{name}' is a variable, and a structure has none",
                hint=f"fix it with --set, or take it from the pixel: --channel {name}",
            )
    parameters = {
        name: places[name] if name in places else Parameter(values=roles.constants[name])
        for name in kind.parameters
    }
    white = colours.formula_white if colours.grid is None else (1.0,) * colours.grid.steps
    tag = structure(kind, parameters, content.program.inputs, white, how.parameters)
    name = "bcp" if colours.grid is None else "bsp"
    return {f"{name}0": tag, f"{name}1": tag}
