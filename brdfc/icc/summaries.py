"""Curves and lookup tables in a line each."""

from __future__ import annotations

from brdfc.calc.tables import LookupTable
from brdfc.icc.curves import AnyCurve, Curve, ParametricCurve
from brdfc.icc.luts import StagedLut, TableLut
from brdfc.icc.tag import Tag


def summary(tag: Tag) -> str:
    """What a curve or a lookup table does, in the order in which it does it; "" for other tags."""
    if isinstance(tag, (Curve, ParametricCurve)):
        return _curve(tag)
    if isinstance(tag, TableLut):
        first = tag.input_curves.count // tag.inputs
        last = tag.output_curves.count // tag.outputs
        stages = f"curves of {first}, {_table(tag.table)}, curves of {last}"
        return f"{tag.inputs} -> {tag.outputs}: {stages}"
    if isinstance(tag, StagedLut):
        return f"{tag.inputs} -> {tag.outputs}: {', '.join(_stages(tag))}"
    return ""


def _curve(curve: AnyCurve) -> str:
    if isinstance(curve, ParametricCurve):
        numbers = " ".join(f"{number:.6g}" for number in curve.parameters)
        return f"function {curve.function} of {numbers}"
    if curve.gamma is not None:
        return f"gamma {curve.gamma:.4g}"
    return "identity" if curve.samples is None else f"{curve.samples.count} samples"


def _table(table: LookupTable) -> str:
    grid = " x ".join(map(str, table.grid))
    return f"{grid} points of {table.samples.storage.name.lower()}"


def _stages(lut: StagedLut) -> list[str]:
    stages = [
        _curves("A", lut.a_curves),
        _table(lut.clut) if lut.clut else "",
        _curves("M", lut.m_curves),
        "matrix" if lut.matrix else "",
        _curves("B", lut.b_curves),
    ]
    return [stage for stage in (stages if lut.kind == "mAB " else stages[::-1]) if stage]


def _curves(name: str, curves: tuple[AnyCurve, ...] | None) -> str:
    if curves is None:
        return ""
    distinct = list(dict.fromkeys(map(_curve, curves)))
    return f"{name} curves ({distinct[0] if len(distinct) == 1 else f'{len(distinct)} different'})"
