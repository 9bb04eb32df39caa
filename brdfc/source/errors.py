"""Every error a user can cause, one family:

    BrdfcError                what the command line prints; exit status 1
    +-- ModelError            a .brdf text: one Diagnostic or many, each with its place
    +-- ValueGivenError       a value given for a run or a compilation (--env, --set, --channel)
    +-- ProgramError          a calculator program: its text, its bytes, or what verification found
    +-- ProfileError          a file that is not a well-formed ICC profile
    +-- LinkError             profiles that do not connect
    +-- SpectrumError         a table of a spectrum or of colour matching functions
    +-- SceneError            a scene file, or what it asks of a model
    +-- MeasurementError      a file of measured reflectance, or what it holds
    +-- ImageError            an image that cannot be read, applied or written
    +-- FitError              measurements that a model cannot be fitted to, or a fit that is none
    +-- SelfCheckError        a compiled program that does not agree with its model
    +-- MissingExtraError     an optional package that this needs is not installed

Anything else that escapes is a fault of brdfc itself.
"""

from __future__ import annotations

from collections.abc import Sequence

from brdfc.source.diagnostics import Diagnostic


class BrdfcError(Exception):
    """A message for the user: what is wrong, where, and (hint) what to do about it."""

    def __init__(self, message: str, *, where: str | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = where
        self.hint = hint

    def __str__(self) -> str:
        place = f"{self.where}: " if self.where else ""
        return f"{place}{self.message}" + (f"\nhint: {self.hint}" if self.hint else "")


class ModelError(BrdfcError):
    """A model text with errors: all independent ones, in the order of the text."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(str(d) for d in self.diagnostics))


class ValueGivenError(BrdfcError):
    """A value given by name that the model or profile cannot take."""


class ProgramError(BrdfcError):
    """A calculator program that is not well-formed or cannot be proven safe."""


class ProfileError(BrdfcError):
    """Bytes that are not a well-formed ICC profile; where names the tag and element."""


class LinkError(BrdfcError):
    """Profiles that do not connect."""


class SpectrumError(BrdfcError):
    """A table that is no spectrum, or a spectrum that does not fit what it is used with."""


class SceneError(BrdfcError):
    """A scene that cannot be; where names its key."""


class MeasurementError(BrdfcError):
    """Measured reflectance that cannot be read or used; where names the file and the line."""


class ImageError(BrdfcError):
    """An image that cannot be read, applied or written."""


class SelfCheckError(BrdfcError):
    """A compiled program that differs from its model; nothing is written."""


class MissingExtraError(BrdfcError):
    """An optional package is needed; the message names the extra to install."""


class FitError(BrdfcError):
    """Measurements that a model cannot be fitted to."""
