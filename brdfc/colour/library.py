"""colour-science, imported where it is needed: it takes longer than compiling a model."""

from __future__ import annotations

import warnings
from typing import Any


def colour_science() -> Any:
    """The package `colour`."""
    with warnings.catch_warnings():
        # It warns of optional packages that nothing here needs.
        warnings.simplefilter("ignore")
        import colour

    return colour
