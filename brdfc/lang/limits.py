"""How large a text may be. A text from outside must not exhaust the machine or the stack."""

from __future__ import annotations

MAX_TEXT = 1 << 17
"""Longest text, in bytes and in characters: ten times what any model of the library has."""

MAX_NESTING = 100
"""Deepest expression as it is written; every later stage may walk one by recursion."""

MAX_LEVELS = 150
"""Deepest expression once every name in it is replaced by what it stands for."""

MAX_FINDINGS = 100
"""After so many findings a file is beyond help, and reading on is of none."""

MAX_IMPORTS = 16
"""Most files that import one another in a row."""
