"""Texts with errors, and exactly what is said of them: golden/lang/NAME.brdf and NAME.txt."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from brdfc.lang import imports
from brdfc.lang.load import load_text
from brdfc.source.errors import ModelError

TEXTS = Path(__file__).parents[1] / "golden" / "lang"


@pytest.mark.parametrize("name", sorted(path.stem for path in TEXTS.glob("*.brdf")))
def test_every_error_is_reported_as_it_always_was(
    name: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    golden: Callable[[str, str], None],
) -> None:
    # No hint may depend on what the library happens to hold.
    monkeypatch.setattr(imports, "library_folder", lambda: tmp_path)
    text = (TEXTS / f"{name}.brdf").read_text(encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        load_text(text, f"{name}.brdf", tmp_path)
    golden(f"lang/{name}.txt", f"{caught.value}\n")
