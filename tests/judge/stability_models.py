"""Models with planted faults, and a model out of plane, for the tests of stability."""

from __future__ import annotations

from functools import cache

from brdfc.compiled import Compiled
from brdfc.compiler import compile_model
from brdfc.judge.problem import Problem
from brdfc.judge.rival import Subject, as_written, subject
from brdfc.lang.load import load_text
from brdfc.lang.model import Model
from brdfc.prepared import problem_of

_DIFFUSE = """channel Rd : XYZ       in 0..1     = 0.5    "diffuse reflectance"
"""
_LOBE = """channel ks : number    in 0..1     = 0.05   "specular coefficient"
channel m  : roughness in 0.001..1 = 0.15   "RMS slope"
"""
_PLANE = """env incident   : angle in -90deg..90deg = 45deg as inci "incidence angle"
env reflection : angle in -90deg..90deg = 0deg  as refl "viewing angle"
"""
_FULL = """env incident   : angle in 0deg..90deg = 45deg as inci "incidence angle"
env reflection : angle in 0deg..90deg = 0deg  as refl "viewing angle"
env incident_azimuth   : angle in -180deg..180deg = 0deg as inaz "azimuth of the light"
env reflection_azimuth : angle in -180deg..180deg = 180deg as reaz "azimuth of the viewer"
"""
_END = """
radiance = {radiance}
"""
CUT = " where cos(incident) > 0 and cos(reflection) > 0 else 0"
WARD = "cos(incident)*(Rd/pi + ks/sqrt(cos(incident)*cos(reflection))*exp(-{t2}/m^2)/(4*pi*m^2))"

HALF = "tan((incident - reflection)/2)^2"
"""tan^2 of the half vector's angle, as the library writes it in the plane."""
ARC_COSINE = (
    "let l = (sin(incident), 0, cos(incident))\n"
    "let v = (-sin(reflection), 0, cos(reflection))\n"
    "let h = normalize(l + v)\n"
)
FULL_T2 = (
    "let sq = sin(incident)*sin(reflection)*cos((incident_azimuth - reflection_azimuth)/2)^2\n"
    "let P = cos((incident + reflection)/2)^2\n"
    "let Q = cos((incident - reflection)/2)^2\n"
)


def model(radiance: str, lets: str = "", *, lobe: bool = False, full: bool = False) -> Model:
    """A model of a diffuse part, with a specular lobe's coefficients or without, in the plane or
    out of it."""
    text = 'model planted "Planted"\n  cite "our own"\n\n' + _DIFFUSE + (_LOBE if lobe else "")
    text += (_FULL if full else _PLANE) + lets + _END.format(radiance=radiance)
    found = load_text(text)
    assert isinstance(found, Model)
    return found


def ward(full: bool = False) -> Model:
    if full:
        t2 = "(tan((incident - reflection)/2)^2 + sq/(P*Q))"
        return model(WARD.format(t2=t2) + CUT, FULL_T2, lobe=True, full=True)
    return model(WARD.format(t2=HALF) + CUT, lobe=True)


def cancelling_ward() -> Model:
    return model(WARD.format(t2="tan(acos(h.z))^2") + CUT, ARC_COSINE, lobe=True)


def uncut_ward() -> Model:
    """Without the horizon cut, as papers print it."""
    return model(WARD.format(t2="tan(acos(h.z))^2"), ARC_COSINE, lobe=True)


def lambert(more: str = "") -> Model:
    """Lambert, its radiance with something more behind it, cut off at the horizon."""
    return model(f"cos(incident)*Rd/pi{more}" + CUT)


@cache
def compiled(of: str) -> tuple[Compiled, Problem]:
    made = compile_model({"ward": ward, "full": lambda: ward(True), "lambert": lambert}[of]())
    return made, problem_of(made.roles, made.formula)


def subjects(of: str, rival: Model) -> tuple[Problem, list[Subject]]:
    """A model of these, compiled, and a rival as it is written."""
    made, problem = compiled(of)
    program = as_written(rival, problem, made.roles.constants)
    return problem, [
        subject("compiled", made.program, problem),
        subject("as written", program, problem),
    ]
