"""Angles as samples of an image: how numbers stand for directions, and a program that reads them.

ICC.2 has numbers for azimuths and zeniths whose ranges we could not verify, and whoever makes an
image of device values has reasons of their own; so the numbers are a choice:

    radians   as calculators take them
    degrees   azimuths from 0 to 360
    unit      0..1 for all that a quantity is declared for; zeniths 0..1 for 0 to 90 degrees,
              azimuths 0..1 for 0 to 360
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brdfc.calc.program import Instruction, Op, Program
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError

UNITS = ("radians", "degrees", "unit")


def angle_unit(text: str) -> str:
    """A name of UNITS; ValueGivenError, with the nearest, for another."""
    if text not in UNITS:
        hint = did_you_mean(text, UNITS) or ", ".join(UNITS)
        raise ValueGivenError(f"'{text}' is no unit of angles", hint=hint)
    return text


@dataclass(frozen=True)
class Sample:
    """What a program's channel comes from: an image's sample, times scale, plus offset; round: of
    an azimuth, the sample that stands for half a turn: from there on a whole turn less. Or, where
    sample is None, the offset alone."""

    sample: int | None
    scale: float = 1.0
    offset: float = 0.0
    round: float | None = None


def plain(sample: int) -> Sample:
    """A sample as it is."""
    return Sample(sample)


def fixed(value: float) -> Sample:
    """A value that does not come from the image."""
    return Sample(None, offset=value)


def ranged(sample: int, low: float, high: float, unit: str) -> Sample:
    """An angle declared for low..high, in radians, both ends included."""
    if unit == "unit":
        return Sample(sample, high - low, low)
    return Sample(sample, math.pi / 180 if unit == "degrees" else 1.0)


def zenith(sample: int, unit: str) -> Sample:
    """A zenith angle."""
    return Sample(sample, {"unit": math.pi / 2, "degrees": math.pi / 180, "radians": 1.0}[unit])


def azimuth(sample: int, unit: str) -> Sample:
    """An azimuth from 0 to a whole turn, for a program that takes half a turn either way."""
    scale = {"unit": 2 * math.pi, "degrees": math.pi / 180, "radians": 1.0}[unit]
    return Sample(sample, scale, round=math.pi / scale)


def reading(samples: Sequence[Sample], inputs: int) -> Program:
    """A program that makes channels of an image's samples: one output for each of samples."""
    body: list[Instruction] = []
    for s in samples:
        if s.sample is None:
            body.append(_data(s.offset))
            continue
        body.append(Op("in", s.sample, 1))
        body += [_data(s.scale), Op("mul", 1)] if s.scale != 1 else []
        body += [_data(s.offset), Op("add", 1)] if s.offset else []
        if s.round is not None:
            body += [Op("in", s.sample, 1), _data(s.round), Op("gt", 1)]
            body += [_data(2 * math.pi), Op("mul", 1), Op("sub", 1)]
    body.append(Op("out", 0, len(samples)))
    return Program(inputs, len(samples), tuple(body))


def is_identity(samples: Sequence[Sample], inputs: int) -> bool:
    """Whether reading would change nothing."""
    return inputs == len(samples) and all(s == plain(i) for i, s in enumerate(samples))


def _data(value: float) -> Op:
    return Op("data", value=float(np.float32(value)))
