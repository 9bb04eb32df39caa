"""The ICC's reference engine as judge: every profile validates there and gives our numbers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import brdfc
from brdfc.cmm import reference
from brdfc.colour.difference import ciede2000
from brdfc.icc.types import Dictionary
from brdfc.lang.load import library
from brdfc.source.errors import LinkError

pytest.importorskip("iccdev", reason="the reference engine (extra `verify`) is not installed")

MODELS = [name for name, entry in library().items() if entry.kind == "model"]
ANGLES = [(40, -10), (40, 0), (40, 10), (40, 30)]
RIGHT = float(np.float32(math.pi / 2))


@pytest.mark.parametrize("name", MODELS)
def test_profiles_validate_with_no_remark(name: str, tmp_path: Path) -> None:
    """With the angles as variables, and with one fixed; of that the program is as written."""
    model = brdfc.load(name)
    variable, fixed = brdfc.compile(model), brdfc.compile(model, {"incident": "40deg"}, effort=1)
    paths = [*variable.save(tmp_path / "v_mvis.icc"), *fixed.save(tmp_path / "f_mvis.icc")]
    verdicts = dict(zip(paths, reference.validate_all(paths), strict=True))
    assert verdicts == dict.fromkeys(paths, ("OK", ""))


@pytest.mark.parametrize("name", MODELS)
def test_the_interpreter_agrees_within_two_units_in_the_last_place(
    name: str, tmp_path: Path
) -> None:
    compiled = brdfc.compile(brdfc.load(name))
    mid, mvis = compiled.save(tmp_path / "m_mvis.icc")
    random = np.random.default_rng(7)
    columns = []
    for q in compiled.roles.channels:
        shape = (400, q.type.value.width)
        column = random.uniform(q.low, q.high, shape)
        if q.low > 0:
            column = np.exp(random.uniform(math.log(q.low), math.log(q.high), shape))
        columns.append(np.clip(column, q.low, q.high))
    pixels = np.concatenate(columns, axis=1).astype(np.float32)
    signatures = [q.signature for q in compiled.roles.variables]
    pairs = [(RIGHT, RIGHT), (-RIGHT, 0.3), (0.0, 0.0), (0.7, 0.7), (1.57, 1.569), (1.5, -1.5)]
    pairs += [tuple(random.uniform(-RIGHT, RIGHT, 2)) for _ in range(30)]
    pairs += [(a, min(a + 10**-b, RIGHT)) for a, b in random.uniform((-1.5, 1), (1.5, 4), (30, 2))]
    runs = [{s: float(np.float32(v)) for s, v in zip(signatures, p, strict=False)} for p in pairs]
    judged = reference.apply(mid, mvis, pixels, [{}, *runs]).xyz
    for run, theirs in zip([{}, *runs], judged, strict=True):
        ours = brdfc.connect(mid, mvis, env=run).apply(pixels)
        unit = np.spacing(np.maximum(np.abs(ours), np.float32(2.0**-126))).astype(np.float64)
        assert (np.abs(ours.astype(np.float64) - theirs) / unit).max() <= 2, run


@pytest.mark.parametrize("name", ["ward", "ward_printed"])
def test_the_published_workflow_is_beaten_a_hundredfold(name: str, tmp_path: Path) -> None:
    """CIEDE2000 against float64 at the paper's angles, cyan-like coefficients (generated)."""
    random = np.random.default_rng(1)
    low, high = [0.10, 0.15, 0.35, 0.02, 0.08], [0.20, 0.28, 0.60, 0.10, 0.30]
    pixels = random.uniform(low, high, (400, 5)).astype(np.float32)
    compiled = brdfc.compile(brdfc.load(name), highlight="equal")
    mid, mvis = compiled.save(tmp_path / "w_mvis.icc")
    runs = [{"inci": math.radians(i), "refl": math.radians(r)} for i, r in ANGLES]
    judged = reference.apply(mid, mvis, pixels, runs).xyz
    rd, ks, m = np.split(pixels.astype(np.float64), [3, 4], axis=-1)
    differences = []
    for run, xyz in zip(runs, judged, strict=True):
        ci, cr = math.cos(run["inci"]), math.cos(run["refl"])
        tangent = math.tan((run["inci"] - run["refl"]) / 2)
        specular = ks / math.sqrt(ci * cr) * np.exp(-((tangent / m) ** 2)) / (4 * np.pi * m**2)
        truth = ci * rd / np.pi + specular * (1 if name == "ward_printed" else ci)
        differences.append(ciede2000(xyz, truth))
    assert np.median(differences) <= 3e-6
    assert np.max(differences) <= 2e-5


def test_a_link_it_refuses_is_an_error_and_not_a_crash(tmp_path: Path) -> None:
    compiled = brdfc.compile(brdfc.load("lambert"))
    mid, mvis = compiled.save(tmp_path / "l_mvis.icc")
    with pytest.raises(LinkError, match="refuses the profiles with status"):
        reference.apply(mvis, mid, [[0.1, 0.2, 0.3]])


def test_broken_profiles_do_not_pass_its_validation(tmp_path: Path) -> None:
    from dataclasses import replace

    mvis = brdfc.compile(brdfc.load("lambert")).mvis
    tags = {k: v for k, v in mvis.tags.items() if k != "wtpt"}
    replace(mvis, tags=tags).save(tmp_path / "broken.icc")
    verdict, report = reference.validate(tmp_path / "broken.icc")
    assert verdict != "OK"
    assert report


def test_metadata_survives_its_validation_at_its_longest(tmp_path: Path) -> None:
    from dataclasses import replace

    from brdfc.profiles.metadata import _split

    long = Dictionary(tuple(_split("note", "a < b & \"c\" 'ü' " * 100)))
    mvis = brdfc.compile(brdfc.load("lambert")).mvis
    replace(mvis, tags={**mvis.tags, "meta": long}).save(tmp_path / "long.icc")
    assert reference.validate(tmp_path / "long.icc") == ("OK", "")
