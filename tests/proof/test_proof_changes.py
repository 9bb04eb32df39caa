"""Replacements that are easily proved wrongly: squares, powers, poles, bounds out of reach."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from brdfc.colour.colorimetry import Colorimetry
from brdfc.proof.pair import Pair
from brdfc.proof.subdivide import bound
from brdfc.symbolic.expression import ONE, ZERO, Expression, const, make, quantity, vector
from brdfc.symbolic.intervals import Interval

X, Y, Q = (quantity(name, 1) for name in "xyq")


def m(operator: str, *arguments: Expression | float) -> Expression:
    made = [a if isinstance(a, Expression) else const(Fraction(str(a))) for a in arguments]
    return make(operator, *made)


def clamped(x: Expression) -> Expression:
    return m("max", x, 0)


CASES: dict[str, tuple[Expression, Expression, dict[str, tuple[float, float]]]] = {
    "a square's one factor": (
        m("add", Y, m("mul", X, X)),
        m("add", Y, make("mul", X, ONE)),
        {"x": (0.9, 1.1), "y": (0.1, 0.1)},
    ),
    "a square to a product": (
        m("div", 1, m("add", 1, m("mul", X, X))),
        m("div", 1, m("add", 1, m("mul", X, Q))),
        {"x": (0.2, 0.6), "q": (0.2, 0.6)},
    ),
    "a power of what may be 0": (
        m("pow", clamped(X), 0.5),
        m("pow", clamped(m("add", X, 0.01)), 0.5),
        {"x": (-0.5, 0.0)},
    ),
    "an exponent that reaches 0": (
        m("pow", clamped(Q), m("add", Y, 0.1)),
        m("pow", clamped(Q), make("add", Y, ZERO)),
        {"q": (-1.0, -0.5), "y": (0.0, 1.0)},
    ),
    "a power that underflows": (
        m("pow", X, Y),
        m("pow", X, Q),
        {"x": (0.3, 0.45), "y": (950.0, 1000.0), "q": (2.0, 1000.0)},
    ),
    "a pole between": (
        m("add", 1, m("mul", 0.1, m("pow", X, -1))),
        m("add", 1, m("mul", 0.1, m("pow", const(Fraction(1, 2)), -1))),
        {"x": (-0.5, -0.4)},
    ),
    "a negative base": (m("pow", X, Y), ZERO, {"x": (-1.0, -0.5), "y": (2.0, 2.0)}),
    "an overflow": (
        m("div", 1, m("add", 1, m("pow", m("mul", m("mul", X, 1e200), 1e200), 2))),
        m("mul", X, 1),
        {"x": (0.9, 1.0)},
    ),
    "an undefined branch": (
        m("exp", m("where", m("gt", Y, 0), m("ln", clamped(X)), Q)),
        m("exp", m("where", m("gt", Y, 0), m("ln", clamped(X)), m("mul", Q, 0.5))),
        {"x": (-1.0, -0.5), "y": (-1.0, 1.0), "q": (0.1, 1.0)},
    ),
}


def pair(first: Expression, second: Expression, domain: dict[str, tuple[float, float]]) -> Pair:
    ranges = {name: (Interval(*ends),) for name, ends in domain.items()}
    return Pair(vector([first] * 3), vector([second] * 3), Colorimetry((1, 1, 1)), ranges)


@pytest.mark.parametrize("case", CASES)
def test_no_difference_exceeds_its_bound(case: str) -> None:
    made = pair(*CASES[case])
    whole = made.whole()
    random = np.random.default_rng(4)
    share = random.random((400, whole.low.shape[1]))
    share = np.where(random.random(share.shape) < 0.4, np.round(share), share)
    seen = made.differences(whole.low + share * (whole.high - whole.low))
    seen = seen[np.isfinite(seen)]
    assert seen.max(initial=0.0) > 1e-6
    assert made.bounds(whole)[0][0] >= seen.max() - 1e-7
    found = bound(made, 200.0, 2_000)
    assert found.most >= seen.max() - 1e-7


def test_components_that_do_not_vary() -> None:
    """Colours of which some components are constants, in several boxes at a time."""
    parts = [X, const(Fraction(1, 2)), Y]
    dimmed = [m("mul", X, 0.9), parts[1], Y]
    made = Pair(
        vector(parts),
        vector(dimmed),
        Colorimetry((1, 1, 1)),
        {"x": (Interval(0.4, 0.5),), "y": (Interval(0.4, 0.5),)},
    )
    found = bound(made, 50.0, 3_000, 3_000)
    assert 0 < found.seen <= found.most < 1.5 * found.seen


def test_what_becomes_undefined_is_no_proof() -> None:
    made = pair(m("sqrt", clamped(X)), m("sqrt", X), {"x": (-0.5, -0.1)})
    assert bound(made, 1.0, 500).most == np.inf
