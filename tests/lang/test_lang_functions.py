"""The table of built-in functions agrees with itself."""

from __future__ import annotations

import pytest

from brdfc.lang.functions import FUNCTIONS, MISSING, PI, Function
from brdfc.lang.words import KEYWORDS

EXPECTED = (
    "sin cos tan asin acos atan atan2 exp ln log10 sqrt cbrt abs sign floor ceil round trunc "
    "min max clamp dot cross length normalize radians degrees"
)


def test_all_are_there() -> None:
    assert set(FUNCTIONS) == set(EXPECTED.split())


def test_no_name_is_used_for_two_things() -> None:
    assert not FUNCTIONS.keys() & (MISSING.keys() | KEYWORDS | {PI})


@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=lambda function: function.name)
def test_each_row(function: Function) -> None:
    parameters = function.signature.partition("(")[2].rstrip(")").split(", ")
    named = [parameter for parameter in parameters if parameter != "..."]
    assert function.least == len(named)
    assert function.most == (None if "..." in parameters else len(named))
    assert function.accepts_count(len(named))
    assert not function.accepts_count(len(named) - 1)
    assert function.sentence.endswith(".")
