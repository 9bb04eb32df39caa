"""What is wrong with a profile that can be read: one rule broken, one Finding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Finding:
    """One rule that a profile breaks; tag is "" where the header or the whole file does."""

    severity: Severity
    tag: str
    message: str

    def __str__(self) -> str:
        place = f"tag '{self.tag}'" if self.tag else "header"
        return f"{self.severity}: {place}: {self.message}"


def error(message: str, tag: str = "") -> Finding:
    """A rule broken that readers may refuse the profile for."""
    return Finding("error", tag, message)


def warning(message: str, tag: str = "") -> Finding:
    """A rule broken that readers get over."""
    return Finding("warning", tag, message)
