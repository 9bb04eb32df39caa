"""The calculator text of every library model, and a digest of its profiles' bytes, kept."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable

import pytest

import brdfc
from brdfc.lang.load import library

MODELS = [name for name, entry in library().items() if entry.kind == "model"]
VARIANTS = {
    **{name: (name, None, {}, ()) for name in MODELS},
    **{f"{name}_full": (name, "full", {}, ()) for name in ("ward", "ggx_anisotropic", "eon")},
    "ward_baked": ("ward", None, {"incident": "40deg", "reflection": "10deg"}, ()),
    "ward_curved": ("ward", None, {}, ("incident", "reflection")),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_calculator_text_and_bytes_are_as_kept(
    variant: str, golden: Callable[[str, str], None]
) -> None:
    name, geometry, fixed, channels = VARIANTS[variant]
    compiled = brdfc.compile(brdfc.load(name, geometry), fixed, channels)
    digests = "".join(
        f"; {kind} {hashlib.sha256(profile.to_bytes()).hexdigest()}\n"
        for kind, profile in (("MID ", compiled.mid), ("MVIS", compiled.mvis))
    )
    golden(f"{variant}.calc", digests + compiled.text)


def test_a_golden_file_that_differs_or_is_missing_fails_with_the_diff(
    golden: Callable[[str, str], None], request: pytest.FixtureRequest
) -> None:
    if request.config.getoption("--update-golden"):
        pytest.skip("golden files are being written, not compared")
    with pytest.raises(pytest.fail.Exception, match=r"not kept yet; to accept it: make golden"):
        golden("no_such_model.calc", "{ in[0,1] out[0,1] }\n")
    text = (brdfc.compile(brdfc.load("lambert")).text).replace("cos", "sin", 1)
    with pytest.raises(pytest.fail.Exception, match=r"(?s)differs.*\+.*sin"):
        golden("lambert.calc", text)


def test_bytes_do_not_depend_on_hash_order() -> None:
    script = (
        "import brdfc, hashlib; c = brdfc.compile(brdfc.load('cook_torrance'));"
        "print(hashlib.sha256(c.mid.to_bytes() + c.mvis.to_bytes()).hexdigest())"
    )
    digests = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("0", "1", "77")
    }
    assert len(digests) == 1
