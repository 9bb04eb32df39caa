"""What the library's models say of laws is so: claims hold, breaches are as large as said."""

from __future__ import annotations

import pytest

from brdfc.checker import ERROR, OPEN, WARNING, check_laws
from brdfc.lang.load import library, load

MODELS = [name for name, entry in library().items() if entry.kind == "model"]


@pytest.mark.parametrize("name", MODELS)
def test_what_a_model_says_of_laws_is_so(name: str) -> None:
    findings = list(check_laws(load(name, "full")))
    assert findings
    assert [f for f in findings if f.status in (ERROR, WARNING, OPEN)] == []


@pytest.mark.parametrize("name", MODELS)
def test_a_model_speaks_of_reciprocity_sign_and_energy(name: str) -> None:
    model = load(name, "full")
    spoken_of = {law.name for law in (*model.laws, *(b.law for b in model.breaches))}
    assert {"reciprocal", "positive", "energy"} <= spoken_of
