"""A formula as FPCore 1.2, the format of FPBench: what other tools for accuracy read.

FPCore knows no vectors, so a formula becomes one FPCore a component, of the channels' own names.
Source of the format: FPBench, https://fpbench.org/spec/fpcore-1.2.html.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction

from brdfc.forms.fpcore_names import COMPARISONS, OPERATORS, escape_name
from brdfc.forms.fpcore_reader import Core, from_fpcore
from brdfc.lang.model import Quantity
from brdfc.symbolic.expression import Expression, component, make, walk
from brdfc.symbolic.intervals import Interval

__all__ = ["Core", "from_fpcore", "scalars", "to_fpcore"]

_SPELLED = {operator: symbol for symbol, operator in OPERATORS.items()}
_SPELLED["neg"] = "-"
_TRUTHS = ("and", "or", "not")
_REPEATED = {"const", "pi", "quantity", "component", *COMPARISONS}
"""What is written again wherever it is used, rather than given a name."""
_LONGEST_QUOTIENT = 40
"""Digits of a number beyond which it is written as a decimal, to more than any tool keeps."""
_DIGITS = 60


def to_fpcore(
    expressions: Sequence[Expression],
    name: str,
    domain: Mapping[str, Interval],
    quantities: Sequence[Quantity],
    citations: Sequence[str] = (),
) -> str:
    """FPCores of the distinct components of expressions, one after the other.

    expressions: of any width. domain: the range of every quantity in them (angles in radians);
    quantities gives their order and the names of their components (one that is not among them has
    its own name). citations become the description, and their keys (ward-1992) the :cite.
    """
    parts = [part for expression in expressions for part in scalars(expression)]
    distinct = list(dict.fromkeys(parts))
    suffixes = ("",) if len(distinct) == 1 else _suffixes(len(distinct))
    cores = [
        _core(part, name + suffix, domain, quantities, citations)
        for part, suffix in zip(distinct, suffixes, strict=True)
    ]
    return "\n".join(cores)


def scalars(expression: Expression) -> tuple[Expression, ...]:
    """The components of an expression, each with scalars only in it."""
    done: dict[tuple[Expression, int], Expression] = {}

    def scalar(e: Expression, index: int) -> Expression:
        key = (e, index if e.width > 1 else 0)
        if key not in done:
            done[key] = taken(*key)
        return done[key]

    def taken(e: Expression, index: int) -> Expression:
        if e.operator == "quantity":
            return component(e, index) if e.width > 1 else e
        if e.operator == "component":
            return scalar(e.arguments[0], e.index)
        if e.operator == "vector":
            return scalar(e.arguments[index], 0)
        if not e.arguments:
            return e
        return make(e.operator, *(scalar(a, index) for a in e.arguments))

    return tuple(scalar(expression, i) for i in range(expression.width))


def _suffixes(count: int) -> tuple[str, ...]:
    letters = "XYZ" if count <= 3 else range(1, count + 1)
    return tuple(f", {letter}" for letter in letters)[:count]


def _core(
    e: Expression,
    name: str,
    domain: Mapping[str, Interval],
    quantities: Sequence[Quantity],
    citations: Sequence[str],
) -> str:
    names = {q.name: q.component_names for q in quantities if q.name in domain}
    names |= {name: (name,) for name in domain if name not in names}
    used = {_argument(part) for part in walk(e)}
    ranges = {
        escape_name(argument): domain[name]
        for name, arguments in names.items()
        for index, argument in enumerate(arguments)
        if (name, index) in used
    }
    lines = [f"(FPCore ({' '.join(ranges)})", f"  :name {_string(name)}"]
    if citations:
        lines.append(f"  :description {_string('; '.join(citations))}")
    keys = [key for key in map(_citation_key, citations) if key]
    if keys:
        lines.append(f"  :cite ({' '.join(dict.fromkeys(keys))})")
    lines.append("  :precision binary32")
    limits = [limit for limit in (_limit(n, r) for n, r in ranges.items()) if limit]
    if len(limits) == 1:
        lines.append(f"  :pre {limits[0]}")
    elif limits:
        lines.append("  :pre (and " + "\n            ".join(limits) + ")")
    return "\n".join(lines) + f"\n{_body(e, set(ranges), names)})\n"


def _argument(e: Expression) -> tuple[str, int] | None:
    """The quantity a scalar stands for, and which component of it."""
    if e.operator == "component":
        return e.arguments[0].name, e.index
    return (e.name, 0) if e.operator == "quantity" and e.width == 1 else None


def _limit(name: str, within: Interval) -> str:
    """The range of an argument; its ends are exactly those float32 has."""
    ends = [str(end) for end in (within.low, within.high)]
    low, high = ("" if "inf" in e else _number(Fraction(float(e))) for e in ends)
    between = " ".join(part for part in (low, name, high) if part)
    return f"(<= {between})" if low or high else ""


def _body(e: Expression, taken: set[str], components: Mapping[str, Sequence[str]]) -> str:
    """The formula, with a name for each part that is used more than once."""
    uses = Counter(a for part in walk(e) for a in part.arguments)
    uses.update(part.arguments[0] for part in walk(e) if part.operator == "sign")  # written twice
    repeated = [p for p in walk(e) if _is_shared(p, uses)]
    free = (f"t{i}" for i in range(1, len(repeated) + len(taken) + 1) if f"t{i}" not in taken)
    names = dict(zip(repeated, free, strict=False))

    def text(part: Expression, truth: bool) -> str:
        return names[part] if part in names else written(part, truth)

    def written(part: Expression, truth: bool) -> str:
        match part.operator:
            case "const":
                return ("TRUE" if part.value else "FALSE") if truth else _number(part.value)
            case "pi":
                return "PI"
            case "quantity":
                return escape_name(part.name)
            case "component":
                return escape_name(components[part.arguments[0].name][part.index])
            case "where":
                condition, value, otherwise = part.arguments
                branches = f"{text(value, truth)} {text(otherwise, truth)}"
                return f"(if {text(condition, True)} {branches})"
            case "sign":  # FPCore's copysign has no 0
                x = text(part.arguments[0], False)
                return f"(if (> {x} 0) 1 (if (< {x} 0) -1 0))"
            case _:
                of_truths = part.operator in _TRUTHS
                parts = [text(a, of_truths) for a in part.arguments]
                return f"({_SPELLED[part.operator]} {' '.join(parts)})"

    if not names:
        return f"  {text(e, False)}"
    bound = "\n         ".join(f"({names[p]} {written(p, False)})" for p in names)
    return f"  (let* ({bound})\n    {text(e, False)})"


def _is_shared(e: Expression, uses: Mapping[Expression, int]) -> bool:
    return e.operator not in _REPEATED and uses[e] > 1


def _number(value: Fraction) -> str:
    """Exactly: a whole number, a decimal or a quotient; a very long quotient to _DIGITS digits."""
    if value.denominator == 1 and abs(value.numerator) < 10**21:
        return str(value.numerator)
    rest = value.denominator
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    size = max(value.numerator.bit_length(), value.denominator.bit_length())
    if rest > 1 and size < _LONGEST_QUOTIENT * 3:
        return f"{value.numerator}/{value.denominator}"
    # A quotient that ends has no more digits than its denominator has bits, after the first.
    digits = _DIGITS if rest > 1 else size + value.denominator.bit_length() + 1
    context = Context(prec=digits, Emin=-(10**6), Emax=10**6)
    decimal = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    return str(decimal.normalize(context)).replace("E", "e")


def _string(text: str) -> str:
    """A string of FPCore: printable ASCII, accents taken off."""
    plain = unicodedata.normalize("NFKD", text.replace("–", "-"))
    ascii_text = "".join(c for c in plain if " " <= c <= "~")
    return '"' + ascii_text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _citation_key(citation: str) -> str | None:
    """ward-1992 of "G. J. Ward, Measuring and modeling ..., 1992": first name, last year."""
    author = re.search(r"[^\W\d_]{2,}", citation)
    years = re.findall(r"\b(?:1[5-9]|20)\d\d\b", citation)
    if not author or not years:
        return None
    return escape_name(f"{author[0].lower()}-{years[-1]}")
