"""Tables of three inputs in tetrahedra: exactly, by hand, and like the reference engine."""

import struct

import numpy as np
import pytest
from calc.calc_elements import TABLES

from brdfc.calc.samples import Samples, Storage
from brdfc.calc.tables import LookupTable
from brdfc.cmm import reference
from brdfc.engine import interpreter, runs
from brdfc.engine.choice import Engine
from brdfc.engine.tables import Interpolation, interpolation_named
from brdfc.icc.header import Header
from brdfc.icc.profile import Profile
from brdfc.icc.types import LocalizedText, Opaque, XYZArray
from brdfc.source.errors import ValueGivenError

RANDOM = np.random.default_rng(3)
TETRAHEDRAL = Interpolation.TETRAHEDRAL
CUBE = LookupTable(3, 1, (2, 2, 2), Samples.of([0, 1, 2, 10, 4, 20, 30, 100]))
"""The corners by their bits, the first input's the highest."""


def run(element, pixels, interpolation=TETRAHEDRAL):
    return interpreter.run(element, pixels, {}, interpolation=interpolation)


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        # Along the edges from 000: the farthest input first.
        ((0.75, 0.5, 0.25), 0 + 0.75 * (4 - 0) + 0.5 * (30 - 4) + 0.25 * (100 - 30)),
        ((0.75, 0.25, 0.5), 0 + 0.75 * (4 - 0) + 0.5 * (20 - 4) + 0.25 * (100 - 20)),
        ((0.5, 0.75, 0.25), 0 + 0.75 * (2 - 0) + 0.5 * (30 - 2) + 0.25 * (100 - 30)),
        ((0.25, 0.75, 0.5), 0 + 0.75 * (2 - 0) + 0.5 * (10 - 2) + 0.25 * (100 - 10)),
        ((0.5, 0.25, 0.75), 0 + 0.75 * (1 - 0) + 0.5 * (20 - 1) + 0.25 * (100 - 20)),
        ((0.25, 0.5, 0.75), 0 + 0.75 * (1 - 0) + 0.5 * (10 - 1) + 0.25 * (100 - 10)),
        ((0.5, 0.5, 0.5), 50),
        ((1, 1, 1), 100),
        ((2, -1, np.nan), 4),
    ],
)
def test_by_hand(point, expected):
    assert run(CUBE, [point]).tolist() == [[expected]]


def test_only_tables_of_three_inputs():
    for table in TABLES:
        pixels = RANDOM.uniform(0, 1, (20, table.inputs))
        same = np.array_equal(run(table, pixels), run(table, pixels, Interpolation.LINEAR))
        assert same == (table.inputs != 3)


def version_4(table):
    """A profile with a table of three inputs and outputs as `mft2`, between curves that change
    nothing; the engine is asked how it interpolates those."""
    matrix = struct.pack(">9i", *(65536 * v for v in (1, 0, 0, 0, 1, 0, 0, 0, 1)))
    line = struct.pack(">6H", *(0, 65535) * 3)
    head = b"mft2" + bytes(4) + bytes([3, 3, table.grid[0], 0]) + matrix + struct.pack(">HH", 2, 2)
    return Profile(
        Header("scnr", version=0x04000000, colour_space=b"RGB ", pcs=b"XYZ "),
        {
            "desc": LocalizedText.english("table"),
            "cprt": LocalizedText.english("none"),
            "wtpt": XYZArray(((0.9642, 1.0, 0.8249),)),
            "A2B0": Opaque(head + line + table.samples.data + line),
        },
    )


def test_like_the_reference_engine(tmp_path):
    pytest.importorskip("iccdev")
    samples = Samples.of(RANDOM.uniform(0, 1, 3 * 5**3), Storage.UINT16)
    table = LookupTable(3, 3, (5, 5, 5), samples, extended=True)
    path = tmp_path / "table.icc"
    path.write_bytes(version_4(table).to_bytes())
    ties = RANDOM.choice(np.linspace(0, 1, 13), (500, 3))
    pixels = np.concatenate([RANDOM.uniform(0, 1, (500, 3)), ties]).astype(np.float32)
    theirs = reference.chain([path], pixels, encoded=False, tetrahedral=True).xyz[0]
    np.testing.assert_array_equal(run(table, pixels), theirs)


@pytest.mark.parametrize("engine", list(Engine))
def test_by_every_engine(engine):
    if engine is Engine.COMPILED:
        pytest.importorskip("llvmlite")
    pixels = RANDOM.uniform(0, 1, (500, 3)).astype(np.float32)
    for interpolation in (*Interpolation, Interpolation.LINEAR):  # forms of one are not the other's
        found = runs.run((CUBE,), 3, pixels, {}, engine=engine, interpolation=interpolation)
        np.testing.assert_array_equal(found, run(CUBE, pixels, interpolation))


def test_by_name():
    assert interpolation_named("tetrahedral") is TETRAHEDRAL
    with pytest.raises(ValueGivenError, match="no interpolation 'tetra'"):
        interpolation_named("tetra")
