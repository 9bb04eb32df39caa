"""What `brdfc check` says of laws: claimed, said to be broken, or passed over in silence."""

from __future__ import annotations

import pytest
from law_models import named

from brdfc.checker import ERROR, OK, OPEN, WARNING, Finding, check_laws
from brdfc.lang.load import load


def findings(name: str, more: str, **change: str) -> list[Finding]:
    return list(check_laws(named(name, more=more, **change)))


def only(status: str, found: list[Finding]) -> str:
    (message,) = (finding.message for finding in found if finding.status == status)
    return message


def test_claims_that_hold() -> None:
    found = findings("lambert", "law reciprocal\nlaw positive\nlaw bounded <= 0.3184\n")
    assert [finding.status for finding in found] == [OK, OK, OK]
    assert found[2].message.startswith("law: bounded <= 0.3184: 0.31831 at worst (incident=")


def test_a_claim_that_does_not_hold_says_what_to_do() -> None:
    found = findings("phong", "law reciprocal\nlaw positive\nlaw bounded <= 1000\n")
    assert [finding.status for finding in found] == [OK, OK, ERROR]
    assert "1592.2 at worst (incident=" in found[2].message
    assert found[2].message.endswith("or say that the model breaks the law")


def test_a_condition_and_quantities_are_taken_into_account() -> None:
    claims = "law bounded <= 0.16 where Rd.x + Rd.y + Rd.z <= 0.5\nlaw increasing Rd\n"
    found = findings("lambert", claims)
    assert only(OPEN, [*found, Finding(OPEN, "none")]) == "none"
    bounded, increasing, *_ = found
    assert (bounded.status, increasing.status) == (OK, OK)
    assert "where Rd.x + Rd.y + Rd.z <= 0.5: 0.15915 at worst" in bounded.message
    assert "increasing Rd: relative fall 0" in increasing.message


def test_silence_about_reciprocity_is_a_warning_where_it_is_broken() -> None:
    found = findings("ward_printed", "law positive\n")
    assert "reciprocal is broken, and nothing says so" in only(WARNING, found)
    silent = findings("lambert", "law positive\n")
    assert "reciprocal holds, but is not claimed" in silent[1].message
    assert silent[1].status == OK


@pytest.mark.parametrize(
    ("figure", "reflection", "status", "said"),
    [
        ("0.5", "60deg", OK, "as stated; reciprocal: relative difference 1 at worst"),
        ("0.4", "60deg", ERROR, "and not 0.4; correct the figure"),
        ("0", "0deg", ERROR, "does not break the law"),
    ],
)
def test_a_breach_is_reproduced_where_the_model_states_it(
    figure: str, reflection: str, status: str, said: str
) -> None:
    point = f"Rd=0 ks=1 m=0.5 incident=0deg reflection={reflection}"
    breach = f'breaks reciprocal {point} -> {figure} within 1e-6 "one way only"\n'
    (positive, found) = findings("ward_printed", f"law positive\n{breach}")
    assert positive.status == OK
    assert found.status == status
    assert said in found.message


def test_signed_angles_are_left_open() -> None:
    plane = load("lambert", "plane")
    found = list(check_laws(plane))
    assert {finding.status for finding in found} == {OPEN}
    assert len(found) == len(plane.laws)
