"""The examples a model file states, checked: small executable facts of its formula."""

from __future__ import annotations

import hashlib
import json
import math

from brdfc import __version__
from brdfc.lang.model import Example, Model
from brdfc.source.diagnostics import Diagnostic
from brdfc.source.errors import ModelError
from brdfc.symbolic.build import build
from brdfc.symbolic.constants import fold_constants
from brdfc.symbolic.evaluate import evaluate_precisely
from brdfc.symbolic.serial import to_data


def check_examples(model: Model) -> int:
    """Evaluate every example in high precision; ModelError shows those that do not hold.

    Returns how many there are. An example may give constants too, so each is built anew.
    """
    findings = [d for d in (_finding(model, example) for example in model.examples) if d]
    if findings:
        raise ModelError(findings)
    return len(model.examples)


def examples_digest(model: Model) -> str:
    """A digest of all that the outcome of check_examples depends on."""
    content = [
        [to_data(build(model.radiance, e.given)), list(e.result), e.within] for e in model.examples
    ]
    return hashlib.sha256(json.dumps([__version__, content]).encode()).hexdigest()


def _finding(model: Model, example: Example) -> Diagnostic | None:
    # Exactly first: 90deg is a right angle here, not the float nearest to one.
    result = evaluate_precisely(fold_constants(build(model.radiance, example.given)), {})
    wanted = example.result * len(result) if len(example.result) == 1 else example.result
    pairs = list(zip(result, wanted, strict=True))
    if all(math.isclose(a, b, rel_tol=example.within, abs_tol=1e-300) for a, b in pairs):
        return None
    shown = ", ".join(f"{value:.9g}" for value in result)
    undefined = any(map(math.isnan, result))
    return Diagnostic(
        example.span,
        "the formula has no value for this example"
        if undefined
        else "the formula gives another value for this example",
        expected=None if undefined else f"({shown})",
        hint="correct the formula, or the value; `within` says how near it must be",
    )
