"""The cube of parameters and light with a viewing direction besides: one of three ways to say it.

Seen from one way alone, the lobe is a thin diagonal that a search loses; so each way is searched.
"""

from __future__ import annotations

from enum import Enum

import numpy as np

from brdfc.laws.charts import mirror, retro, within_turn
from brdfc.laws.claims import RAISED
from brdfc.laws.reflectance import (
    INCIDENT,
    INCIDENT_AZIMUTH,
    REFLECTION,
    REFLECTION_AZIMUTH,
    RIGHT,
    Array,
    Reflectance,
)
from brdfc.laws.space import Coordinate, Space
from brdfc.symbolic.expression import Expression

GRAZING = 1e-6
"""How near to the right angle directions come, in radians: at 90 degrees there is no BRDF."""


class View(Enum):
    """What a viewing direction is measured from."""

    MIRROR = "the half vector from the normal"
    RETRO = "the direction of the light"
    NORMAL = "the normal"


class Directed(Space):
    """Two more coordinates: the viewing direction, within the declared zeniths and azimuths.

    raised: a parameter that has a second value, not smaller, under its name and RAISED.
    """

    def __init__(
        self,
        reflectance: Reflectance,
        view: View,
        condition: Expression | None = None,
        raised: str = "",
    ) -> None:
        width = sum(q.type.value.width for q in reflectance.parameters if q.name == raised)
        super().__init__(reflectance, GRAZING, 2 + width, condition)
        self._view, self._raised = view, raised
        self._zenith = Coordinate("", *reflectance.limits[REFLECTION], grazing=GRAZING)
        self._azimuth = reflectance.limits[REFLECTION_AZIMUTH]

    def values(self, x: Array) -> dict[str, Array]:
        found = super().values(x)
        u, w = x[:, self.named], x[:, self.named + 1]
        incident, azimuth = found[INCIDENT][:, 0], found[INCIDENT_AZIMUTH][:, 0]
        if self._view is View.NORMAL:
            zenith = self._zenith.value(u)
            turned = self._azimuth[0] + w * (self._azimuth[1] - self._azimuth[0])
        else:
            chart = mirror if self._view is View.MIRROR else retro
            at = chart(incident, u, w)
            zenith, turned = at.zenith, within_turn(azimuth + at.azimuth)
        low, high = self._zenith.low, min(self._zenith.high, RIGHT - GRAZING)
        found[REFLECTION] = np.clip(zenith, low, high)[:, None]
        found[REFLECTION_AZIMUTH] = np.clip(turned, *self._azimuth)[:, None]
        if self._raised:
            columns = self.columns(self._raised)
            share = x[:, self.named + 2 :]
            raised = x[:, columns] + share * (1 - x[:, columns])
            parts = [self.axes[c].value(raised[:, i]) for i, c in enumerate(columns)]
            found[self._raised + RAISED] = np.stack(parts, axis=-1)
        return found
