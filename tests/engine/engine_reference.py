"""The ICC's reference engine as a judge of many small programs at once.

They are sub-elements of one calculator that picks one by its first channel, so one pair of profiles
and one process judge them all. XYZ leaves the reference PCS-encoded, rounded to float32; ours is
encoded likewise before the comparison.
"""

import numpy as np

from brdfc.calc.program import Op, Program, Select
from brdfc.cmm import reference
from brdfc.profiles.content import Content
from brdfc.profiles.multiplex import profile_pair


def dispatcher(programs):
    """One program that runs the k-th on channels 1.. where channel 0 is k."""
    channels = programs[0].inputs
    cases = tuple(
        (Op("in", 1, channels), Op("calc", k), Op("out", 0, 3)) for k in range(len(programs))
    )
    default = (Op("data", value=0.0), Op("copy", 1, 2), Op("out", 0, 3))
    return Program(channels + 1, 3, (Op("in", 0, 1), Select(cases, default)), tuple(programs))


def judged(folder, programs, pixels, environments=({},)):
    """The reference's results, still encoded: (environments, programs, pixels, 3), float32."""
    count = programs[0].inputs + 1
    names = tuple(f"c{i}" for i in range(count))
    pair = profile_pair(Content("Judge", dispatcher(programs), names, (0.0,) * count))
    mid, mvis = pair.save(folder / "judge_mvis.icc")
    number = np.repeat(np.arange(len(programs), dtype=np.float32), len(pixels))
    every = np.column_stack([number, np.tile(pixels, (len(programs), 1))])
    xyz = reference.apply(mid, mvis, every, environments).xyz / reference.ENCODING
    return xyz.astype(np.float32).reshape(len(environments), len(programs), len(pixels), 3)


def encoded(values):
    with np.errstate(over="ignore"):
        return (values.astype(np.float64) * (32768 / 65535)).astype(np.float32)


def ulps(x, y):
    """Floats between two arrays of float32; NaN is 0 from NaN and far from all else."""

    def place(values):
        bits = values.view(np.int32).astype(np.int64)
        return np.where(bits < 0, -(bits & 0x7FFFFFFF), bits)

    apart = np.abs(place(x) - place(y))
    apart[np.isnan(x) & np.isnan(y)] = 0
    apart[np.isnan(x) != np.isnan(y)] = 2**32
    return apart
