"""The order of the stages: a folder imports only those before it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "brdfc"
ORDER = [
    "source",
    "lang",
    "symbolic",
    "forms",
    "calc",
    "codegen",
    "engine",
    "colour",
    "proof",
    "judge",
    "laws",
    "icc",
    "profiles",
    "xml",
    "cmm",
    "images",
    "fit",
    "scenes",
    "charts",
    "pictures",
    "cli",
]
ANYWHERE = {"data", "files", ""}
"""Modules of the package itself that every stage may use: data files, whole files, the version."""
TOP = {"pictures", "cli"}
"""The folders that may use what joins the stages (compiler, checker)."""


def imports(path: Path) -> set[tuple[str, str]]:
    """(top of package, second part) of every import in a file, wherever it stands."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module]
        for name in names:
            top, _, rest = name.partition(".")
            found.add((top, rest.partition(".")[0]))
    return found


def files() -> list[Path]:
    return sorted(PACKAGE.glob("*/**/*.py"))


def stage_of(path: Path) -> str:
    """The folder of the package that a file is in, at whatever depth."""
    return path.relative_to(PACKAGE).parts[0]


def test_every_folder_has_its_place() -> None:
    folders = {stage_of(path) for path in files()}
    assert folders <= set(ORDER)


@pytest.mark.parametrize("path", files(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_stage_knows_only_those_before_it(path: Path) -> None:
    stage = stage_of(path)
    for top, second in imports(path):
        if top != "brdfc" or second in ANYWHERE:
            continue
        if second in ORDER:
            assert ORDER.index(second) <= ORDER.index(stage), f"{stage} imports {second}"
        else:
            assert stage in TOP, f"{stage} imports brdfc.{second}"


@pytest.mark.parametrize("path", files(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_only_the_symbolic_stage_knows_sympy(path: Path) -> None:
    if stage_of(path) != "symbolic":
        assert not {"sympy", "mpmath"} & {top for top, _ in imports(path)}
