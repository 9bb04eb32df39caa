from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from brdfc.inspected import Calculator, Inspection, Part, Transform

_WIDTH = 100
_LABEL = 14


@click.command("inspect")
@click.argument("profile")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--no-engine", is_flag=True, help="Do not ask the reference engine.")
def command(profile: str, as_json: bool, no_engine: bool) -> None:
    """Show what is in PROFILE, on one screen: spaces, channels, variables, transforms with the size
    and cost of every element, metadata, and what is wrong with it.

    \b
    Example:
      brdfc inspect ward_mvis.icc
      brdfc inspect ward_mvis.icc --json
    """
    from dataclasses import asdict

    from brdfc.inspection import inspect

    found = inspect(profile, engine=not no_engine)
    if as_json:
        click.echo(json.dumps(asdict(found), indent=2))
        return
    for line in _lines(found):
        click.echo("".join(c if c.isprintable() else "?" for c in line))


def _lines(found: Inspection) -> Iterator[str]:
    yield from _row(
        "class",
        f"{found.device_class}, {found.class_name}; version {found.version}, {found.bytes:,} bytes",
    )
    yield from _row("title", found.title)
    yield from _row("spaces", "; ".join(f"{name} {text}" for name, text in found.spaces.items()))
    yield from _row(
        "channels",
        ", ".join(
            c.name if c.default is None else f"{c.name} = {c.default:.6g}" for c in found.channels
        ),
        most=4,
    )
    variables = [
        f"{v.signature} ({v.name}, {v.range} = {v.default})" if v.name else v.signature
        for v in found.variables
    ]
    yield from _row("variables", ", ".join(variables) or "none", most=4)
    for transform in found.transforms[:_MOST]:
        yield from _transform(transform)
    if len(found.transforms) > _MOST:
        yield from _row("", f"and {len(found.transforms) - _MOST} transforms more")
    shown = {tag: other for tag, other in found.other_tags.items() if other.summary}
    for tag, other in list(shown.items())[:_MOST]:
        yield from _row(tag, f"{other.name}, {other.summary}", most=1)
    rest = [tag for tag in found.other_tags if tag not in list(shown)[:_MOST]]
    yield from _row("other tags", ", ".join(rest), most=2)
    meta = [f"{name} {value}" for name, value in found.metadata.items()]
    yield from _row("metadata", "; ".join(meta), most=4)
    for who, findings in found.verdicts.items():
        if findings:
            yield from _row(who, "; ".join(findings), most=4)
        else:
            yield from _row(who, "ok")


_MOST = 8
"""Transforms, elements of each, and lookup tables and curves, that fit on the screen."""


def _transform(transform: Transform) -> Iterator[str]:
    head = f"{transform.name}, {transform.inputs} -> {transform.outputs}"
    if transform.same is not None:
        yield from _row(transform.tag, f"{head}: the same as {transform.same}")
        return
    yield from _row(transform.tag, head)
    for part in transform.elements[:_MOST]:
        yield from _part(part)
    if len(transform.elements) > _MOST:
        yield from _row("", f"and {len(transform.elements) - _MOST} elements more")


def _part(part: Part) -> Iterator[str]:
    text = f"{part.kind} {part.inputs} -> {part.outputs}, {part.bytes:,} bytes"
    yield from _row("", f"{text}, {part.size}" if part.size else text)
    if part.calculator is not None:
        yield from _calculator(part.calculator)
    if part.inside:
        yield from _row("", f"  calls {_counted(part.inside)}")


def _calculator(calculator: Calculator) -> Iterator[str]:
    if calculator.nanoseconds is None:
        yield from _row("", f"  {calculator.operators} operators, refused")
    else:
        yield from _row(
            "",
            f"  {calculator.operators} operators, at most {calculator.nanoseconds:.0f} ns a pixel "
            f"on the reference engine; stack {calculator.stack}, temporaries "
            f"{calculator.temporaries}",
        )
    yield from _row("", f"  {_counted(calculator.kinds)}")


def _counted(counts: dict[str, int]) -> str:
    return ", ".join(f"{count} {name}" for name, count in counts.items())


def _row(label: str, text: str, most: int = 2) -> Iterator[str]:
    """A label and its text, on so many lines at most; nothing where there is no text."""
    from textwrap import wrap

    # Far more than fits is not wrapped: a hostile text may be megabytes long.
    short = text[: most * _WIDTH]
    inset = " " * (len(short) - len(short.lstrip()))
    indent = " " * _LABEL + inset
    lines = wrap(short.lstrip(), _WIDTH - len(indent), max_lines=most, placeholder=" ...")
    for index, line in enumerate(lines):
        yield f"{indent if index else f'{label:<{_LABEL}}{inset}'}{line}"
