"""Functions that have no instruction of their own, on several pixels at a time.

They are computed in float64, with more digits than float32 keeps, and rounded once: so they are
within a hair of correctly rounded, agree with the interpreter but for the rarest ties, and give the
same bits on every processor. Arguments are float32 values, widened. Reductions and reconstructions
are the classic ones: W. J. Cody, W. Waite, Software Manual for the Elementary Functions (1980);
M. Payne, R. Hanek, Radian Reduction for Trigonometric Functions (1983). The polynomials interpolate
at Chebyshev's nodes, and bounds on their errors are beside them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

from brdfc.engine.lanes import Lanes, bits

_EXP = (
    1.0000000000000135,
    1.0000000000000013,
    0.4999999999943859,
    0.16666666666615648,
    0.04166666704055191,
    0.008333333367311603,
    0.0013888801749656543,
    0.0001984119064754424,
    2.4884459751751116e-05,
    2.7632640675430236e-06,
)
"""exp(x), |x| <= ln 2 / 2: off by 2^-46 at most."""
_LN = (
    2.0000000000000004,
    0.6666666666655292,
    0.40000000061741614,
    0.2857141602110767,
    0.22223434547517906,
    0.18121934431215214,
    0.16837659970680488,
)
"""2 artanh(s)/s in s^2, s <= 3 - 2 sqrt 2: off by 2^-52 at most."""
_SIN = (
    -0.16666666666663885,
    0.008333333331079206,
    -0.00019841266916969272,
    2.7555990924514207e-06,
    -2.4805635773967187e-08,
)
"""(sin(x)/x - 1)/x^2 in x^2, |x| <= pi/4: off by 2^-42 at most."""
_COS = (
    0.04166666666666468,
    -0.0013888888887277331,
    2.480158521097858e-05,
    -2.755636969196081e-07,
    2.0700600148842637e-09,
)
"""(cos(x) - 1 + x^2/2)/x^4 in x^2, |x| <= pi/4: off by 2^-44 at most."""
_ATAN = (
    0.999999999999999,
    -0.3333333333322143,
    0.19999999978392663,
    -0.14285712661684793,
    0.11111048853751296,
    -0.09089529956562307,
    0.07673535428183285,
    -0.0650598296717084,
    0.05024762118940128,
    -0.025316479573776477,
)
"""atan(x)/x in x^2, |x| <= sqrt 2 - 1: off by 2^-50 at most."""

_SHIFT = 1.5 * 2.0**52
"""Added to a number, it leaves the nearest whole number in the lowest bits."""
_LN2 = math.log(2)


def exp(lanes: Lanes, x: str) -> str:
    """2^n e^r with r within half of ln 2. Beyond +-200 all is 0 or infinite in float32."""
    x = lanes.pick("D", lanes.test("ogt", "D", x, 200.0), 200.0, x)
    x = lanes.pick("D", lanes.test("olt", "D", x, -200.0), -200.0, x)
    shifted = lanes.do("fadd", "D", lanes.do("fmul", "D", x, 1 / _LN2), _SHIFT)
    n = lanes.do("fsub", "D", shifted, _SHIFT)
    r = lanes.do("fsub", "D", x, lanes.do("fmul", "D", n, _LN2))
    exponent = lanes.do("add", "I", lanes.convert("bitcast", "D", shifted, "I"), "splat (i64 1023)")
    power = lanes.convert("bitcast", "I", lanes.do("shl", "I", exponent, "splat (i64 52)"), "D")
    return lanes.do("fmul", "D", lanes.polynomial(r, _EXP), power)


def ln(lanes: Lanes, x: str) -> str:
    """e ln 2 + 2 artanh((m - 1)/(m + 1)), for x = 2^e m with m within a factor sqrt 2 of 1."""
    low = bits(math.sqrt(0.5))
    whole = lanes.convert("bitcast", "D", x, "I")
    biased = lanes.do("add", "I", whole, lanes.constant("I", bits(1.0) - low))
    e = lanes.do("lshr", "I", biased, "splat (i64 52)")  # and 1023
    number = lanes.do("or", "I", e, lanes.constant("I", bits(2.0**52)))
    exponent = lanes.do("fsub", "D", lanes.convert("bitcast", "I", number, "D"), 2.0**52 + 1023)
    above = lanes.do("shl", "I", lanes.do("sub", "I", e, "splat (i64 1023)"), "splat (i64 52)")
    m = lanes.convert("bitcast", "I", lanes.do("sub", "I", whole, above), "D")
    f = lanes.do("fsub", "D", m, 1.0)
    s = lanes.do("fdiv", "D", f, lanes.do("fadd", "D", f, 2.0))
    inner = lanes.do("fmul", "D", s, lanes.polynomial(lanes.do("fmul", "D", s, s), _LN))
    found = lanes.do("fadd", "D", lanes.do("fmul", "D", exponent, _LN2), inner)
    found = lanes.pick("D", lanes.test("olt", "D", x, math.inf), found, x)  # infinity, NaN
    found = lanes.pick("D", lanes.test("olt", "D", x, 0.0), math.nan, found)
    return lanes.pick("D", lanes.test("oeq", "D", x, 0.0), -math.inf, found)


def log10(lanes: Lanes, x: str) -> str:
    return lanes.do("fmul", "D", ln(lanes, x), 1 / math.log(10))


_NEAR = 2.0**20
"""Up to here a product of pi/2's first 33 bits is exact."""
_RIGHT_HIGH, _RIGHT_LOW = 0x3FF921FB54400000, 0x3DD0B4611A626331
"""pi/2: its first 33 bits, and the rest."""


def _reduced(lanes: Lanes, x: str) -> tuple[str, str]:
    """x = k pi/2 + r, r within pi/4: r, and k modulo 4."""
    if ("reduced", x) in lanes.known:
        r, quarter = lanes.known["reduced", x]
        return r, quarter
    shifted = lanes.do("fadd", "D", lanes.do("fmul", "D", x, 2 / math.pi), _SHIFT)
    k = lanes.do("fsub", "D", shifted, _SHIFT)
    high, low = (f"splat (double 0x{part:016X})" for part in (_RIGHT_HIGH, _RIGHT_LOW))
    near = lanes.do("fsub", "D", x, lanes.do("fmul", "D", k, high))
    near = lanes.do("fsub", "D", near, lanes.do("fmul", "D", k, low))
    turns = lanes.convert("bitcast", "D", shifted, "I")
    far = lanes.any(lanes.test("ogt", "D", lanes.call("fabs", "D", x), _NEAR))
    before, inside, after = lanes.block, lanes.name("far"), lanes.name("reduced")
    lanes.lines.append(f"  br i1 {far}, label %{inside}, label %{after}")
    lanes.label(inside)
    lanes.declared["@reduce_far"] = _reduce_far(lanes.width)
    wide, whole = lanes.kind("D"), lanes.kind("I")
    lanes.lines += [
        f"  store {wide} {x}, ptr %angles",
        f"  store {wide} {near}, ptr %rests",
        f"  store {whole} {turns}, ptr %turns",
        "  call void @reduce_far(ptr %angles, ptr %rests, ptr %turns)",
    ]
    rest, turned = lanes.new(f"load {wide}, ptr %rests"), lanes.new(f"load {whole}, ptr %turns")
    lanes.lines.append(f"  br label %{after}")
    lanes.label(after)
    r = lanes.new(f"phi {wide} [ {near}, %{before} ], [ {rest}, %{inside} ]")
    quarter = lanes.new(f"phi {whole} [ {turns}, %{before} ], [ {turned}, %{inside} ]")
    lanes.known["reduced", x] = (r, quarter)
    return r, quarter


def _sine_and_cosine(lanes: Lanes, r: str) -> tuple[str, str]:
    if ("circle", r) in lanes.known:
        sine, cosine = lanes.known["circle", r]
        return sine, cosine
    z = lanes.do("fmul", "D", r, r)
    inner = lanes.do("fadd", "D", lanes.do("fmul", "D", z, lanes.polynomial(z, _SIN)), 1.0)
    sine = lanes.do("fmul", "D", r, inner)  # so that the sine of -0 is -0
    fourth = lanes.do("fmul", "D", lanes.do("fmul", "D", z, z), lanes.polynomial(z, _COS))
    half = lanes.do("fsub", "D", "splat (double 1.0)", lanes.do("fmul", "D", z, 0.5))
    cosine = lanes.do("fadd", "D", half, fourth)
    lanes.known["circle", r] = (sine, cosine)
    return sine, cosine


def _odd(lanes: Lanes, quarter: str) -> str:
    return lanes.test("ne", "I", lanes.do("and", "I", quarter, "splat (i64 1)"), "zeroinitializer")


def _circular(lanes: Lanes, x: str, turned: int) -> str:
    r, quarter = _reduced(lanes, x)
    sine, cosine = _sine_and_cosine(lanes, r)
    if turned:
        quarter = lanes.do("add", "I", quarter, "splat (i64 1)")
    value = lanes.pick("D", _odd(lanes, quarter), cosine, sine)
    half = lanes.do("and", "I", quarter, "splat (i64 2)")
    opposite = lanes.test("ne", "I", half, "zeroinitializer")
    return lanes.pick("D", opposite, lanes.do("fneg", "D", value), value)


def sin(lanes: Lanes, x: str) -> str:
    return _circular(lanes, x, 0)


def cos(lanes: Lanes, x: str) -> str:
    return _circular(lanes, x, 1)


def tan(lanes: Lanes, x: str) -> str:
    r, quarter = _reduced(lanes, x)
    sine, cosine = _sine_and_cosine(lanes, r)
    odd = _odd(lanes, quarter)
    above = lanes.pick("D", odd, lanes.do("fneg", "D", cosine), sine)
    return lanes.do("fdiv", "D", above, lanes.pick("D", odd, sine, cosine))


def angle(lanes: Lanes, y: str, x: str) -> str:
    """The angle of (x, y), as atan2: an arc tangent below tan(pi/8), and what it is short of."""
    across, along = lanes.call("fabs", "D", x), lanes.call("fabs", "D", y)
    steep = lanes.test("ogt", "D", along, across)
    less = lanes.pick("D", steep, across, along)
    more = lanes.pick("D", steep, along, across)
    beyond = lanes.test("ogt", "D", less, lanes.do("fmul", "D", more, math.tan(math.pi / 8)))
    infinite = lanes.test("oeq", "D", less, math.inf)
    above = lanes.pick("D", beyond, lanes.do("fsub", "D", less, more), less)
    below = lanes.pick("D", beyond, lanes.do("fadd", "D", less, more), more)
    t = lanes.do("fdiv", "D", above, below)
    base = lanes.pick("D", beyond, math.pi / 4, 0.0)
    nothing = lanes.either("or", lanes.test("oeq", "D", below, 0.0), infinite)
    t = lanes.pick("D", nothing, 0.0, t)
    base = lanes.pick("D", infinite, math.pi / 4, base)
    arc = lanes.do("fmul", "D", t, lanes.polynomial(lanes.do("fmul", "D", t, t), _ATAN))
    arc = lanes.do("fadd", "D", base, arc)
    arc = lanes.pick("D", steep, lanes.do("fsub", "D", lanes.constant("D", math.pi / 2), arc), arc)
    behind = lanes.convert("bitcast", "D", x, "I")
    left = lanes.test("slt", "I", behind, "zeroinitializer")  # x is negative, or -0
    arc = lanes.pick("D", left, lanes.do("fsub", "D", lanes.constant("D", math.pi), arc), arc)
    arc = lanes.call("copysign", "D", arc, y)
    return lanes.pick("D", lanes.test("uno", "D", x, y), math.nan, arc)


def atan(lanes: Lanes, x: str) -> str:
    return angle(lanes, x, lanes.constant("D", 1.0))


def _other_side(lanes: Lanes, x: str) -> str:
    """sqrt(1 - x^2), NaN beyond 1."""
    less = lanes.do("fsub", "D", lanes.constant("D", 1.0), x)
    more = lanes.do("fadd", "D", lanes.constant("D", 1.0), x)
    return lanes.call("sqrt", "D", lanes.do("fmul", "D", less, more))


def asin(lanes: Lanes, x: str) -> str:
    return angle(lanes, x, _other_side(lanes, x))


def acos(lanes: Lanes, x: str) -> str:
    return angle(lanes, _other_side(lanes, x), x)


def cbrt(lanes: Lanes, x: str) -> str:
    size = ln(lanes, lanes.call("fabs", "D", x))
    return lanes.call("copysign", "D", exp(lanes, lanes.do("fmul", "D", size, 1 / 3)), x)


def power(lanes: Lanes, x: str, y: str) -> str:
    """x^y with the special values of C's pow (ISO/IEC 9899, F.10.4.4)."""
    size = lanes.call("fabs", "D", x)
    found = exp(lanes, lanes.do("fmul", "D", y, ln(lanes, size)))
    whole = lanes.test("oeq", "D", lanes.call("floor", "D", y), y)
    half = lanes.do("fmul", "D", y, 0.5)
    odd = lanes.either("and", whole, lanes.test("one", "D", lanes.call("floor", "D", half), half))
    odd = lanes.either("and", odd, lanes.test("olt", "D", lanes.call("fabs", "D", y), math.inf))
    signed = lanes.call("copysign", "D", found, x)
    found = lanes.pick("D", odd, signed, found)
    inside = lanes.either(
        "and", lanes.test("olt", "D", x, 0.0), lanes.test("ogt", "D", x, -math.inf)
    )
    unreal = lanes.either("and", inside, lanes.test("one", "D", lanes.call("floor", "D", y), y))
    found = lanes.pick("D", unreal, math.nan, found)
    endless = lanes.test("oeq", "D", lanes.call("fabs", "D", y), math.inf)
    still = lanes.either("and", endless, lanes.test("oeq", "D", size, 1.0))
    still = lanes.either("or", still, lanes.test("oeq", "D", x, 1.0))
    still = lanes.either("or", still, lanes.test("oeq", "D", y, 0.0))
    found = lanes.pick("D", still, 1.0, found)
    # Squares and the like are often exactly half-way between two float32 values; roots nearly so.
    product = x
    for whole_exponent in (2.0, 3.0, 4.0):
        product = lanes.do("fmul", "D", product, x)
        found = lanes.pick("D", lanes.test("oeq", "D", y, whole_exponent), product, found)
    above = lanes.test("ogt", "D", x, 0.0)
    rooted = lanes.either("and", above, lanes.test("oeq", "D", y, 0.5))
    return lanes.pick("D", rooted, lanes.call("sqrt", "D", x), found)


FUNCTIONS: dict[str, Callable[..., str]] = {
    "exp": exp,
    "ln": ln,
    "log": log10,
    "sin": sin,
    "cos": cos,
    "tan": tan,
    "asin": asin,
    "acos": acos,
    "atan": atan,
    "cbrt": cbrt,
    "pow": power,
    # The calculator's atn2 has y nearer the top of the stack.
    "atn2": lambda lanes, x, y: angle(lanes, y, x),
}
"""By the operators' names, on float64 values."""

_TWO_OVER_PI = 0xA2F9836E4E441529FC2757D1F534DDC0DB6295993C439041FE5163ABDEBBC561B7246E
"""2/pi times 2^280."""


@cache
def _reduce_far(width: int) -> str:
    """The text of `reduce_far`: arguments beyond _NEAR, one by one, after Payne and Hanek.

    A float32 is m 2^p with a whole m below 2^24; what counts of 2^p 2/pi, modulo 4, is kept in
    three parts, of which products of m with the first two are exact.
    """
    rows = []
    for exponent in range(20, 128):
        kept = (_TWO_OVER_PI << (exponent - 23 + 3)) % (1 << 285)  # modulo 4, times 2^283
        first, rest = divmod(kept, 1 << (283 - 27))
        second, rest = divmod(rest, 1 << (283 - 56))
        parts = (first / 2.0**27, second / 2.0**56, rest / 2**283)
        rows.append("[3 x double] [" + ", ".join(f"double 0x{bits(v):016X}" for v in parts) + "]")
    table = f"@quarters = internal constant [{len(rows)} x [3 x double]] [{', '.join(rows)}]"
    return table + _REDUCE_FAR.replace("WIDTH", str(width)).replace(
        "RIGHT", f"0x{bits(math.pi / 2):016X}"
    )


_REDUCE_FAR = """
declare double @llvm.fabs.f64(double)
declare double @llvm.floor.f64(double)
declare i64 @llvm.umin.i64(i64, i64)
define internal void @reduce_far(ptr %angles, ptr %rests, ptr %turns) noinline {
entry:
  br label %next
next:
  %i = phi i64 [ 0, %entry ], [ %after, %done ]
  %from = getelementptr double, ptr %angles, i64 %i
  %x = load double, ptr %from
  %size = call double @llvm.fabs.f64(double %x)
  %far = fcmp ogt double %size, 0x4130000000000000
  br i1 %far, label %reduce, label %done
reduce:
  %bits = bitcast double %size to i64
  %biased = lshr i64 %bits, 52
  %last = call i64 @llvm.umin.i64(i64 %biased, i64 1150)
  %row = sub i64 %last, 1043
  %fraction = and i64 %bits, 4503599627370495
  %full = or i64 %fraction, 4503599627370496
  %digits = lshr i64 %full, 29
  %m = uitofp i64 %digits to double
  %p1 = getelementptr [3 x double], ptr @quarters, i64 %row, i64 0
  %p2 = getelementptr [3 x double], ptr @quarters, i64 %row, i64 1
  %p3 = getelementptr [3 x double], ptr @quarters, i64 %row, i64 2
  %h1 = load double, ptr %p1
  %h2 = load double, ptr %p2
  %h3 = load double, ptr %p3
  %a = fmul double %m, %h1
  %b = fmul double %m, %h2
  %c = fmul double %m, %h3
  %a4 = fmul double %a, 0.25
  %turned = call double @llvm.floor.f64(double %a4)
  %rounds = fmul double %turned, 4.0
  %within = fsub double %a, %rounds
  %about = fadd double %within, %b
  %above = fadd double %about, 0.5
  %k = call double @llvm.floor.f64(double %above)
  %r1 = fsub double %within, %k
  %r2 = fadd double %r1, %b
  %r3 = fadd double %r2, %c
  %zero = fsub double %size, %size
  %r4 = fmul double %r3, RIGHT
  %r = fadd double %r4, %zero
  %negative = fcmp olt double %x, 0.0
  %minus = fneg double %r
  %rest = select i1 %negative, double %minus, double %r
  %quarter = fptosi double %k to i64
  %opposite = sub i64 4, %quarter
  %turn = select i1 %negative, i64 %opposite, i64 %quarter
  %torest = getelementptr double, ptr %rests, i64 %i
  store double %rest, ptr %torest
  %toturn = getelementptr i64, ptr %turns, i64 %i
  store i64 %turn, ptr %toturn
  br label %done
done:
  %after = add i64 %i, 1
  %more = icmp ult i64 %after, WIDTH
  br i1 %more, label %next, label %end
end:
  ret void
}
"""
