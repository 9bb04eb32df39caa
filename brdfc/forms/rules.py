"""The rules that turn an expression into an equivalent one, as data.

Each is an identity over the real numbers, written in the language of the models: its variables
stand for any expression (k: for a product's constant factor, if it has one), a product for any
product that contains those factors. needs says what the ranges of variables must prove. In float32
the two sides differ, which is the point: some lose 20 bits, some take half the time. The search
measures that; a rule only promises the value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

VALUE = ""
"""In needs: the value of the left side itself."""


@dataclass(frozen=True)
class Rule:
    """left -> right, and right -> left too if both is set. needs: variable to "> 0", ">= 0", or
    "within pi" (from -pi to pi, as float32 has it). multiplies_out: read backwards it opens a
    bracket, which can be done at many places and seldom helps; a search tries it last."""

    name: str
    left: str
    right: str
    needs: Mapping[str, str] = field(default_factory=dict)
    both: bool = False
    multiplies_out: bool = False


_COMPENSATED = """
  let d = x - y in
  let z = d - x in
  let lost = (x - (d - z)) - (y + z) in
  let s = tan(d/2) in
  let t = s/m in
  let high = 4097*t - (4097*t - t) in
  let low = t - high in
  let mhigh = 4097*m - (4097*m - m) in
  let mlow = m - mhigh in
  let p = t*m in
  let rounded = ((high*mhigh - p) + high*mlow + low*mhigh) + low*mlow in
  let rest = (((s - p) - rounded) + lost*(1 + s^2)/2)/m in
  exp(-high^2)*exp(min(-(low*(t + high) + 2*t*rest), 80))
"""
"""exp(-tan((x - y)/2)^2/m^2) with the exponent to nearly twice float32's precision. Over the reals
lost = rest = 0 and high = t. In float32 lost is what rounding x - y lost (Knuth, The Art of
Computer Programming 2, 4.2.2), high is t to 12 bits (Veltkamp), so that high^2 is exact, and rest
is what the division lost (Dekker, Numerische Mathematik 18, 1971). The bound of 80 never acts over
the reals; in float32 it keeps 0 times infinity away far outside the lobe."""

_COMPENSATED_COSINE = """
  let s = x + y in
  let z = s - x in
  let lost = (x - (s - z)) + (y - z) in
  cos(s/2) - sin(s/2)*min(max(lost, -0.00001), 0.00001)/2
"""
"""cos((x + y)/2) with what rounding x + y lost put back (Knuth, as above), to first order. Over the
reals lost = 0; its bounds, which no sum of two angles reaches, let ranges see that it is small."""

RULES: tuple[Rule, ...] = (
    # ---- powers and roots
    Rule("quotient of squares", "x^2/y^2", "(x/y)^2", both=True),
    Rule("product of squares", "x^2*y^2", "(x*y)^2", both=True),
    Rule("product of roots", "sqrt(x)*sqrt(y)", "sqrt(x*y)", {"x": ">= 0", "y": ">= 0"}, both=True),
    Rule("quotient of roots", "sqrt(x)/sqrt(y)", "sqrt(x/y)", {"x": ">= 0", "y": "> 0"}),
    Rule("factor into the root", "sqrt(x)*y", "sqrt(x*y^2)", {"x": ">= 0", "y": ">= 0"}),
    Rule("square into the root", "sqrt(x)*y^2", "sqrt(x*y^4)", {"x": ">= 0"}),
    Rule("constant into the root", "k*sqrt(x)", "sqrt(k^2*x)", {"x": ">= 0"}),
    Rule("constant into the root below", "k/sqrt(x)", "1/sqrt(x/k^2)", {"x": ">= 0"}),
    Rule("root of a square", "sqrt(x^2)", "x", {"x": ">= 0"}),
    Rule("square of a root", "sqrt(x)^2", "x", {"x": ">= 0"}),
    Rule("root less its part", "sqrt(x^2 + y) - x", "y/(sqrt(x^2 + y) + x)", {"x": "> 0"}),
    Rule("reciprocal once", "y/x^2", "y*(1/x)^2", {"x": "> 0"}),
    Rule("cancelled factor", "x*y/x", "y", {"x": "> 0"}),
    # ---- exponentials and logarithms
    Rule("exponential below", "exp(-x)", "1/exp(x)", both=True),
    Rule("product of exponentials", "exp(x)*exp(y)", "exp(x + y)", both=True),
    Rule("two half exponentials", "exp(x)", "exp(x/2)^2"),
    Rule("factor into the exponent", "x*exp(y)", "exp(y + ln(x))", {"x": "> 0"}),
    Rule("logarithm of a product", "ln(x*y)", "ln(x) + ln(y)", {"x": "> 0", "y": "> 0"}, both=True),
    Rule("exponential of a logarithm", "exp(ln(x))", "x", {"x": "> 0"}),
    Rule("power as exponential", "x^y", "exp(y*ln(x))", {"x": "> 0"}),
    Rule("compensated exponent", "exp(-(tan((x - y)/2)^2/m^2))", _COMPENSATED, {"m": "> 0"}),
    # ---- trigonometry
    Rule("tangent as quotient", "tan(x)", "sin(x)/cos(x)", both=True),
    Rule("secant", "1/cos(x)^2 - 1", "tan(x)^2", both=True),
    Rule("secant, turned", "1 - 1/cos(x)^2", "-tan(x)^2"),
    Rule("sine from cosine, turned", "cos(x)^2 - 1", "-sin(x)^2"),
    Rule("half angle, turned", "cos(x) - 1", "-2*sin(x/2)^2"),
    Rule("secant over a cosine", "(1 - cos(x)^2)/cos(x)^2", "tan(x)^2", both=True),
    Rule("sine from cosine", "1 - cos(x)^2", "sin(x)^2", both=True),
    Rule("cosine from sine", "1 - sin(x)^2", "cos(x)^2", both=True),
    Rule("half angle", "1 - cos(x)", "2*sin(x/2)^2", both=True),
    Rule("tangent of half", "tan(x/2)^2", "(1 - cos(x))/(1 + cos(x))", both=True),
    Rule(
        "tangent of half a difference",
        "tan((x - y)/2)",
        "(sin(x) - sin(y))/(cos(x) + cos(y))",
        both=True,
    ),
    Rule("product to sum", "cos(x)*cos(y)", "(cos(x - y) + cos(x + y))/2", both=True),
    Rule("cosine of a sum", "cos(x)*cos(y) - sin(x)*sin(y)", "cos(x + y)", both=True),
    Rule("cosine of a difference", "cos(x)*cos(y) + sin(x)*sin(y)", "cos(x - y)", both=True),
    Rule("angle of a cosine", "cos(acos(x))", "x", {"x": ">= 0"}),
    Rule("tangent of an arc cosine", "tan(acos(x))^2", "(1 - x^2)/x^2"),
    Rule("arc cosine of a cosine", "acos(cos(x))", "abs(x)", {"x": "within pi"}),
    Rule("even cosine", "cos(abs(x))", "cos(x)"),
    Rule("even square", "abs(x)^2", "x^2"),
    Rule("squares apart", "1 - x^2", "(1 - x)*(1 + x)", both=True),
    Rule(
        "cosine of half a sum",
        "cos((x + y)/2)",
        "sqrt((sin(x) - sin(y))^2 + (cos(x) + cos(y))^2)/2",
        {VALUE: ">= 0"},
    ),
    Rule(
        "cosine of half a difference",
        "cos((x - y)/2)",
        "sqrt((sin(x) + sin(y))^2 + (cos(x) + cos(y))^2)/2",
        {VALUE: ">= 0"},
    ),
    Rule("compensated angle sum", "cos((x + y)/2)", _COMPENSATED_COSINE),
    # ---- sums and products
    Rule("common factor", "x*y + x*z", "x*(y + z)", both=True, multiplies_out=True),
    Rule(
        "common factor of a difference",
        "x*y - x*z",
        "x*(y - z)",
        both=True,
        multiplies_out=True,
    ),
    Rule("one part of two", "x*(1 - y) + y", "x + y*(1 - x)", both=True),
    Rule("lerp", "x + (1 - x)*y", "y + x*(1 - y)", both=True),
    Rule("common factor of a minimum", "min(x*y, x*z)", "x*min(y, z)", {"x": ">= 0"}, both=True),
    Rule("minimum of reciprocals", "min(1/x, 1/y)", "1/max(x, y)", {"x": "> 0", "y": "> 0"}),
    Rule("minimum over one divisor", "min(x/z, y/z)", "min(x, y)/z", {"z": "> 0"}, both=True),
    Rule("sum over one divisor", "x/z + y/z", "(x + y)/z", both=True, multiplies_out=True),
)
