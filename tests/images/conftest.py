from __future__ import annotations

import pytest

import brdfc


@pytest.fixture(scope="session")
def ward() -> brdfc.compiled.Compiled:
    return brdfc.compile(brdfc.load("ward"))


@pytest.fixture(scope="session")
def rendering(ward: brdfc.compiled.Compiled) -> brdfc.Rendering:
    env = {"incident": 0.7, "reflection": 0.5}
    return brdfc.rendering(brdfc.connect(ward.mid, ward.mvis, env=env))
