"""What a compilation gives: the profiles, and everything worth knowing of how they came about."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from brdfc.calc.program import Program
from brdfc.calc.text import disassemble
from brdfc.files import write_all
from brdfc.icc.profile import Profile
from brdfc.judge.cache import Remembered
from brdfc.judge.goals import Goal
from brdfc.judge.selfcheck import Verdict
from brdfc.lang.model import Model
from brdfc.layouts import Layout
from brdfc.profiles.multiplex import ProfilePair
from brdfc.roles import Roles
from brdfc.sceneplan import Plan
from brdfc.source.errors import ValueGivenError
from brdfc.symbolic.formula import Formula
from brdfc.symbolic.guards import Guard


@dataclass(frozen=True)
class Compiled:
    """A compiled model: its profiles, and everything worth knowing of how they came about.

    form: the form that was chosen and how it was derived; None where every form failed to be
    measured, and the formula stands as written. guards: what its domain made necessary. price:
    nanoseconds a pixel on the reference engine, by the price table. plan: how it was fitted to a
    scene.
    """

    model: Model
    roles: Roles
    formula: Formula
    goal: Goal
    form: Remembered | None
    guards: tuple[Guard, ...]
    program: Program
    price: float
    verdict: Verdict
    layout: Layout
    profiles: tuple[Profile, ...]
    plan: Plan | None = None

    @property
    def mid(self) -> Profile:
        """The profile that takes device values: the MID, or the only one."""
        return self.profiles[0]

    @property
    def mvis(self) -> Profile:
        """The profile that gives colours: the MVIS, or the only one."""
        return self.profiles[-1]

    @property
    def text(self) -> str:
        """The calculator text of the program."""
        return disassemble(self.program.body)

    def files(self, path: str | Path, mid: str | Path | None = None) -> list[tuple[Path, bytes]]:
        """Path and bytes of each profile, the MID first; beside the MVIS unless said where."""
        if len(self.profiles) == 2:
            return ProfilePair(self.mid, self.mvis).files(path, mid)
        if mid is not None:
            raise ValueGivenError(f"'{self.layout.name}' has one profile and no MID")
        return [(Path(path), self.mvis.to_bytes())]

    def save(self, path: str | Path, mid: str | Path | None = None) -> tuple[Path, ...]:
        """Write the profiles, all or none; see files. Returns their paths."""
        files = self.files(path, mid)
        write_all(*files)
        return tuple(place for place, _ in files)
