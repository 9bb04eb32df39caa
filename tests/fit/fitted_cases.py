"""Measurements made up from a model: generated, with noise that grows with the signal."""

from __future__ import annotations

import numpy as np

from brdfc.fit.fit import response_to
from brdfc.fit.measurements import Kind, Measurements, checked
from brdfc.lang.load import load
from brdfc.symbolic.formula import NO_WHITE

D50 = (0.9642, 1.0, 0.8249)
TRUTH = {
    "lambert": (0.1, 0.2, 0.6),
    "ward": (0.1, 0.2, 0.6, 0.05, 0.15),
    "ggx": (0.1, 0.2, 0.6, 0.5, 0.2, 0.05),
}


def directions(count: int = 200, seed: int = 0, incidences: tuple[float, ...] = ()) -> np.ndarray:
    """(count, 4): at several incidences, half of them near the mirror direction."""
    random = np.random.default_rng(seed)
    wanted = np.radians(incidences or (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0))
    incident = random.choice(wanted, count)
    near = random.random(count) < 0.5
    zenith = np.where(
        near, np.abs(incident + random.normal(0, 0.15, count)), random.uniform(0, 1.3, count)
    )
    azimuth = np.where(near, np.pi + random.normal(0, 0.15, count), random.uniform(-3, 3, count))
    return np.stack([incident, np.minimum(zenith, 1.35), 0 * incident, azimuth], axis=1)


def made(
    name: str,
    truth: tuple[float, ...],
    at: np.ndarray,
    noise: float = 0.0,
    seed: int = 1,
    kind: Kind = Kind.XYZ,
) -> Measurements:
    """What a model reflects at directions, with noise."""
    white = D50 if kind is Kind.XYZ else None
    empty = checked(at, np.ones((len(at), 3)), kind, white=white, name="generated")
    assert (empty.white or NO_WHITE) is not None
    values = response_to(load(name, "full"), empty).values(np.array(truth))
    random = np.random.default_rng(seed)
    values = values * np.maximum(1 + noise * random.standard_normal(values.shape), 0.01)
    return checked(at, values, kind, white=white, name="generated")
