"""Fixtures that all tests share."""

from __future__ import annotations

import atexit
import difflib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import FrameType

import pytest

# Searches are remembered for the whole run, by all processes of it; the user's own cache and prices
# are left alone.
if "PYTEST_XDIST_WORKER" not in os.environ:
    os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="brdfc-tests-")
    os.environ["XDG_CONFIG_HOME"] = os.environ["XDG_CACHE_HOME"]
    os.environ.pop("BRDFC_PRICES", None)
    atexit.register(shutil.rmtree, os.environ["XDG_CACHE_HOME"], ignore_errors=True)

# Two workers, each with as many threads of linear algebra as processors, wait for each other
# a hundred times longer than they compute.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

GOLDEN = Path(__file__).parent / "golden"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden", action="store_true", help="write the golden files anew, for review"
    )
    parser.addoption(
        "--programs", type=int, default=150, help="random programs that engines are compared on"
    )


@pytest.fixture
def function_calls() -> Callable[[Callable[[], object]], int]:
    """How many functions of Python are called while one runs: how much work it is, on any machine
    and however busy that is."""

    def count(run: Callable[[], object]) -> int:
        calls = 0

        def note(_frame: FrameType, event: str, _argument: object) -> None:
            nonlocal calls
            calls += event == "call"

        before = sys.getprofile()
        sys.setprofile(note)
        try:
            run()
        finally:
            sys.setprofile(before)
        return calls

    return count


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[str, str], None]:
    """check(name, text): the text equals tests/golden/NAME, or the test fails with the diff."""

    def check(name: str, text: str) -> None:
        path = GOLDEN / name
        if request.config.getoption("--update-golden"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            return
        kept = path.read_text(encoding="utf-8") if path.exists() else ""
        if kept == text:
            return
        state = "differs from what is kept" if kept else "is not kept yet"
        diff = "".join(
            difflib.unified_diff(
                kept.splitlines(keepends=True), text.splitlines(keepends=True), "kept", "now"
            )
        )
        pytest.fail(f"golden/{name} {state}; to accept it: make golden\n{diff}", pytrace=False)

    return check
