"""What a compilation aims at: the cheapest form that is good enough, or the best there is."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from brdfc.judge.measure import Measured
from brdfc.source.diagnostics import did_you_mean
from brdfc.source.errors import ValueGivenError


@dataclass(frozen=True)
class Goal:
    """kind: "de" or "ulp", the cheapest form whose worst error is at most limit; "best", the
    cheapest of the most accurate ones."""

    kind: str
    limit: float = 0.0

    def accepts(self, measured: Measured) -> bool:
        """Whether a form is good enough."""
        if self.kind == "de":
            return measured.de <= self.limit
        return self.kind == "best" or 2**measured.bits - 1 <= self.limit

    @property
    def counts_bits(self) -> bool:
        """Whether errors count in bits; else in CIEDE2000."""
        return self.kind != "de"

    @property
    def most(self) -> float:
        """The largest error accepted, in what counts; 0 for the most accurate there is."""
        return math.log2(1 + self.limit) if self.counts_bits else self.limit

    def __str__(self) -> str:
        unit = {"de": "CIEDE2000", "ulp": "units in the last place"}.get(self.kind)
        return f"the cheapest within {self.limit:g} {unit}" if unit else "the most accurate"


GOALS = {"speed": Goal("de", 0.1), "balanced": Goal("de", 0.01), "accuracy": Goal("best")}
"""--optimize. 0.01 is a hundredth of what a trained observer sees, 0.1 a tenth."""

_ERROR = re.compile(r"(\d+\.?\d*(?:e-?\d+)?|\.\d+)\s*(dE|ulp)", re.IGNORECASE)


def goal(optimize: str, max_error: str | None = None) -> Goal:
    """The goal of --optimize, or of --max-error ("0.01dE", "8ulp"), which overrides it."""
    if max_error is not None:
        found = _ERROR.fullmatch(max_error.strip())
        if not found:
            raise ValueGivenError(
                f"'{max_error}' is no error", hint="write 0.01dE (CIEDE2000) or 8ulp"
            )
        return Goal(found[2].lower(), float(found[1]))
    if optimize not in GOALS:
        known = ", ".join(GOALS)
        raise ValueGivenError(
            f"'{optimize}' is nothing to optimize for",
            hint=did_you_mean(optimize, GOALS) or f"there is {known}",
        )
    return GOALS[optimize]
