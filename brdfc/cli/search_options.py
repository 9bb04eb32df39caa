"""The options of commands that search for equivalent forms."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import click


def search_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """--optimize, --max-error and --effort."""
    for option in (
        click.option(
            "--effort",
            type=click.IntRange(1, 100_000),
            metavar="N",
            help="Equivalent forms measured at most; 1 keeps the formula as it is written.",
        ),
        click.option(
            "--max-error",
            metavar="ERROR",
            help="Take the cheapest form within this error: 0.01dE (CIEDE2000) or 8ulp.",
        ),
        click.option(
            "--optimize",
            default="balanced",
            metavar="speed|balanced|accuracy",
            help="speed: within 0.1 CIEDE2000; balanced (default): within 0.01; accuracy: the "
            "most accurate form.",
        ),
    ):
        function = option(function)
    return function


def shown_progress(done: int, total: int) -> None:
    """Forms measured, on a terminal's standard error."""
    if sys.stderr.isatty() and (done % 20 == 0 or done == total):
        click.echo(f"\rsearching forms {done}/{total} ", nl=False, err=True)


def end_progress() -> None:
    """Clear what shown_progress wrote."""
    if sys.stderr.isatty():
        click.echo("\r" + " " * 40 + "\r", nl=False, err=True)
