"""A fit: what was found, how far it is off, how sure it is; as a text that is read back."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from brdfc.lang.model import Model
from brdfc.source.errors import FitError

Array = NDArray[np.float64]

FORMAT = 1
"""Of the file; a later one may say more."""
MOST_BYTES = 1 << 20
ROUNDED = 1e-6
"""By which a coefficient may exceed its range, rounded as it is written."""


@dataclass(frozen=True)
class Estimate:
    """A coefficient by its channel's name. low, high: of the interval of 95 %."""

    name: str
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Fit:
    """estimates: in the order of the model's channels. objective and its loss; difference: the
    CIEDE2000 of what is seen: mean, 95 %, greatest; none for what is no colour. by_incidence:
    degrees, the mean difference there, and how many measurements. starts, agreed: how many starts
    came to the best of them. remarks: what the measurements and the fit do not let one know.
    """

    model: str
    data: str
    objective: str
    method: str
    loss: float
    converged: bool
    starts: int
    agreed: int
    measurements: int
    white: tuple[float, ...]
    kind: str
    estimates: tuple[Estimate, ...]
    difference: tuple[float, float, float] | None
    by_incidence: tuple[tuple[float, float, int], ...]
    remarks: tuple[str, ...]
    fixed: Mapping[str, tuple[float, ...]]
    correlation: tuple[tuple[float, ...], ...] = ()
    bootstrap: int = 0

    @property
    def values(self) -> dict[str, float]:
        return {e.name: e.value for e in self.estimates}

    def to_toml(self) -> str:
        """The text of a file that `brdfc compile --coefficients` and other programs read."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        yield "# coefficients of a reflectance model, fitted to measurements"
        yield f"format = {FORMAT}"
        for name in ("model", "data", "kind", "objective", "method"):
            yield f"{name} = {json.dumps(getattr(self, name), ensure_ascii=False)}"
        yield f"converged = {str(self.converged).lower()}"
        yield f"loss = {_number(self.loss)}"
        for name in ("starts", "agreed", "measurements", "bootstrap"):
            yield f"{name} = {getattr(self, name)}"
        yield f"white = {_list(self.white)}"
        if self.difference is not None:
            yield f"ciede2000 = {_list(self.difference)}  # mean, 95 %, greatest"
        listed = ", ".join(json.dumps(r, ensure_ascii=False) for r in self.remarks)
        yield f"remarks = [{listed}]"
        yield from ("", "[coefficients]")
        yield from (f"{e.name} = {_number(e.value)}" for e in self.estimates)
        yield from ("", "[interval]  # of 95 %")
        yield from (f"{e.name} = {_list((e.low, e.high))}" for e in self.estimates)
        if self.fixed:
            yield from ("", "[fixed]")
            yield from (f"{name} = {_list(values)}" for name, values in self.fixed.items())
        if self.correlation:
            yield from ("", "[correlation]")
            rows = zip(self.estimates, self.correlation, strict=True)
            yield from (f"{e.name} = {_list([round(v, 4) for v in row])}" for e, row in rows)
        yield from ("", "[by_incidence]  # degrees: mean CIEDE2000, measurements")
        for degrees, mean, count in self.by_incidence:
            yield f'"{degrees:g}" = [{_number(mean)}, {count}]'


def _number(value: float) -> str:
    return repr(float(f"{value:.9g}")) if np.isfinite(value) else str(value).lower()


def _list(values: Sequence[float]) -> str:
    return f"[{', '.join(map(_number, values))}]"


@dataclass(frozen=True)
class Coefficients:
    """values: by the names of channels. white: that colours among them are relative to; kind: of
    the colours, XYZ or else. where: the file they are from."""

    model: str
    kind: str
    values: Mapping[str, float]
    white: tuple[float, ...]
    where: str


def read_coefficients(path: str | Path) -> Coefficients:
    """What a file says that a fit wrote, fixed quantities included.

    Raises FitError for another file, and for a fit that did not converge.
    """
    from brdfc.files import read_file

    try:
        read = tomllib.loads(read_file(path, MOST_BYTES).decode())
        values = {str(k): float(v) for k, v in dict(read["coefficients"]).items()}
        for quantity, numbers in dict(read.get("fixed", {})).items():
            values |= _components(str(quantity), [float(v) for v in numbers])
        white = tuple(float(v) for v in read["white"])
        name, kind, converged = str(read["model"]), str(read["kind"]), read.get("converged")
    except (KeyError, TypeError, ValueError) as error:
        raise FitError(
            f"no coefficients: {error}", where=str(path), hint="write them with brdfc fit -o"
        ) from None
    if not all(map(np.isfinite, values.values())) or len(white) != 3 or not min(white) > 0:
        raise FitError("a coefficient, or the white, is no finite number", where=str(path))
    if converged is not True:
        raise FitError("the fit did not converge", where=str(path), hint="fit it anew")
    return Coefficients(name, kind, values, white, str(path))


def _components(quantity: str, numbers: Sequence[float]) -> dict[str, float]:
    suffixes = ("",) if len(numbers) == 1 else ("x", "y", "z")
    return {quantity + s: v for s, v in zip(suffixes, numbers, strict=True)}


def with_defaults(model: Model, found: Coefficients) -> Model:
    """A model whose channels have these values where a profile finds none in an image.

    Raises FitError for coefficients of another model, of another kind of colours than X, Y, Z, or
    outside the model's ranges.
    """
    if found.model != model.name:
        raise FitError(
            f"the coefficients were fitted with '{found.model}', not '{model.name}'",
            where=found.where,
        )
    if found.kind != "XYZ":
        raise FitError(
            f"coefficients of {found.kind} values are no X, Y, Z",
            where=found.where,
            hint="fit them without --objective, which makes X, Y, Z of them",
        )
    left = dict(found.values)
    quantities = []
    for q in model.quantities:
        if all(name in left for name in q.component_names):
            values = tuple(left.pop(name) for name in q.component_names)
            if q.type.is_colour:  # a model speaks of shares of the white
                values = tuple(v / w for v, w in zip(values, found.white, strict=True))
            for name, value in zip(q.component_names, values, strict=True):
                if not q.low - ROUNDED <= value <= q.high + ROUNDED:
                    raise FitError(
                        f"{name} = {value:g} lies outside {q.low:g}..{q.high:g}, which "
                        f"'{model.name}' declares",
                        where=found.where,
                        hint="fit within it, or compile a model that declares more",
                    )
            inside = tuple(min(max(v, q.low), q.high) for v in values)
            q = replace(q, default=inside)
        quantities.append(q)
    if left:
        raise FitError(f"'{model.name}' has no {', '.join(left)}", where=found.where)
    return replace(model, quantities=tuple(quantities))
