"""Layout, precedence and literals: what a text becomes."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from brdfc.lang import tree
from brdfc.lang.functions import FUNCTIONS
from brdfc.lang.parse import parse, statement_spans
from brdfc.lang.words import KEYWORDS
from brdfc.source.span import Source


def statements(text: str) -> tuple[tree.Statement, ...]:
    parsed = parse(Source("test.brdf", text))
    assert not parsed.diagnostics, str(parsed.diagnostics[0])
    return parsed.statements


def expression(text: str) -> tree.Expr:
    (radiance,) = statements(f"radiance = {text}")
    assert isinstance(radiance, tree.Radiance)
    return radiance.body


def shown(expr: tree.Expr) -> str:
    """The expression with every bracket written and nothing left to precedence."""
    match expr:
        case tree.Number(value=value, unit=unit):
            return f"{digits(value)}{unit}"
        case tree.Name(name=name):
            return name
        case tree.Call(function=function, arguments=arguments):
            return f"{function}({', '.join(map(shown, arguments))})"
        case tree.Unary(operator=operator, operand=operand):
            return f"({operator} {shown(operand)})"
        case tree.Binary(operator=operator, left=left, right=right):
            return f"({shown(left)} {operator} {shown(right)})"
        case tree.Where(value=value, condition=condition, otherwise=otherwise):
            return f"({shown(value)} where {shown(condition)} else {shown(otherwise)})"
        case tree.Vector(components=components):
            return f"({', '.join(map(shown, components))})"
        case tree.Component(vector=vector, index=index):
            return f"({shown(vector)}).{'xyz'[index]}"
        case tree.LetIn(name=name, value=value, body=body):
            return f"(let {name} = {shown(value)} in {shown(body)})"


def digits(value: Fraction) -> str:
    """A decimal fraction as written in a text."""
    return str(value) if value.denominator == 1 else str(float(value))


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("a - b - c", "((a - b) - c)"),
        ("a/b*c", "((a / b) * c)"),
        ("a + b*c^d", "(a + (b * (c ^ d)))"),
        ("a^b^c", "(a ^ (b ^ c))"),
        ("-a^2", "(- (a ^ 2))"),
        ("a^-2", "(a ^ (- 2))"),
        ("a^-b^c", "(a ^ (- (b ^ c)))"),
        ("-a*b", "((- a) * b)"),
        ("a*-b", "(a * (- b))"),
        ("--a", "(- (- a))"),
        ("a - -b", "(a - (- b))"),
        ("v.x^2", "((v).x ^ 2)"),
        ("-v.y", "(- (v).y)"),
        ("f(a).z", "(f(a)).z"),
        ("(a, b, c).x", "((a, b, c)).x"),
        ("a + b < c * d", "((a + b) < (c * d))"),
        ("not a < b and c > d or e == f", "(((not (a < b)) and (c > d)) or (e == f))"),
        ("a or b and c", "(a or (b and c))"),
        ("not not a", "(not (not a))"),
        ("a + 1 where b > 0 and c > 0 else 0", "((a + 1) where ((b > 0) and (c > 0)) else 0)"),
        ("a where b else c where d else e", "(a where b else (c where d else e))"),
        ("let q = a in q + 1 where b else c", "(let q = a in ((q + 1) where b else c))"),
        ("let q = a where b else c in q", "(let q = (a where b else c) in q)"),
        ("let q = let r = a in r in q", "(let q = (let r = a in r) in q)"),
        ("a where b else let q = c in q", "(a where b else (let q = c in q))"),
        ("((a))", "a"),
    ],
)
def test_precedence(text: str, meaning: str) -> None:
    assert shown(expression(text)) == meaning


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("0", Fraction(0), ""),
        ("0.1", Fraction(1, 10), ""),
        (".5", Fraction(1, 2), ""),
        ("2.", Fraction(2), ""),
        ("1e-3", Fraction(1, 1000), ""),
        ("1.5E+2", Fraction(150), ""),
        ("40deg", Fraction(40), "deg"),
        ("0.7rad", Fraction(7, 10), "rad"),
        ("1e2deg", Fraction(100), "deg"),
        ("0.1234567890123456789", Fraction(1234567890123456789, 10**19), ""),
    ],
)
def test_literals_are_exact(text: str, value: Fraction, unit: str) -> None:
    number = expression(text)
    assert isinstance(number, tree.Number)
    assert (number.value, number.unit) == (value, unit)


@pytest.mark.parametrize("written", ["0..1", "0 .. 1", "0. ..1", "0...5", "0.0..1.0", "-1..-.5"])
def test_two_points_make_a_range(written: str) -> None:
    (declaration,) = statements(f"channel a : number in {written}")
    assert isinstance(declaration, tree.Declaration)
    assert declaration.low is not None
    assert declaration.high is not None
    low, high = (Fraction(part.strip(" ")) for part in written.rstrip().replace("...", ".. .")
                 .replace("0. ..", "0 ..").split("..", 1))  # fmt: skip
    assert (declaration.low.value, declaration.high.value) == (low, high)


def test_every_kind_of_statement() -> None:
    found = statements(
        """\
# A comment, then the header.
model ward "Isotropic # Ward"   # a comment after it
  cite "eq. 5a"

  # a comment among the clauses
  note "one"
  note "two"
channel Rd : XYZ in 0..1 = (0.1, 0.2, 0.3) "diffuse"
channel S : spectrum(400nm..700nm, 10nm) in 0..1 = 0.5
env incident : angle in -90deg..90deg = 45deg as inci
\t"the angle"
import microfacet (beckmann, schlick as fresnel)
import ward
import "my/shapes.brdf" (bump)
let delta = (incident - reflection)/2 "half"
let lobe(x, m : roughness) = exp(-x)
law energy <= 1
example incident=40deg Rd=(0.1, -0.2, 0.6) -> (1, 2, 3) within 1e-4
"""
    )
    header, channel, spectrum, env, import_, library, path, let, function, law, example = found
    assert isinstance(header, tree.Header)
    assert (header.kind, header.name, header.title) == ("model", "ward", "Isotropic # Ward")
    assert (header.citations, header.notes) == (("eq. 5a",), ("one", "two"))
    assert isinstance(channel, tree.Declaration)
    assert channel.default is not None
    assert [float(n.value) for n in channel.default] == [0.1, 0.2, 0.3]
    assert (channel.role, channel.type_name, channel.description) == ("channel", "XYZ", "diffuse")
    assert isinstance(spectrum, tree.Declaration)
    assert [(int(n.value), n.unit) for n in spectrum.type_arguments] == [
        (400, "nm"), (700, "nm"), (10, "nm"),
    ]  # fmt: skip
    assert isinstance(env, tree.Declaration)
    assert (env.signature, env.description) == ("inci", "the angle")
    assert env.name_span.text == "incident"
    assert env.signature_span is not None
    assert env.signature_span.text == "inci"
    assert isinstance(import_, tree.Import)
    assert [(n.name, n.alias) for n in import_.names] == [
        ("beckmann", "beckmann"), ("schlick", "fresnel"),
    ]  # fmt: skip
    assert isinstance(library, tree.Import)
    assert (library.target, library.is_path, library.names) == ("ward", False, ())
    assert isinstance(path, tree.Import)
    assert (path.target, path.is_path) == ("my/shapes.brdf", True)
    assert isinstance(let, tree.Let)
    assert (let.name, let.parameters, let.description) == ("delta", None, "half")
    assert isinstance(function, tree.Let)
    assert function.parameters is not None
    assert [(p.name, p.type_name) for p in function.parameters] == [
        ("x", None), ("m", "roughness"),
    ]  # fmt: skip
    assert isinstance(law, tree.Law)
    assert law.bound is not None
    assert (law.name, law.bound.value) == ("energy", Fraction(1))
    assert isinstance(example, tree.Example)
    assert [g.name for g in example.given] == ["incident", "Rd"]
    assert example.given[1].values[1].value == Fraction(-1, 5)
    assert example.within is not None
    assert example.within.value == Fraction(1, 10000)


def test_places_are_those_of_the_whole_text() -> None:
    text = "# one\n\nlet a = 1\nlet b = (1 + 2)*\n  tan(x)\n"
    _, let = statements(text)
    assert isinstance(let, tree.Let)
    assert (let.span.line, let.span.column, let.span.text) == (4, 1, "let b = (1 + 2)*\n  tan(x)")
    assert isinstance(let.body, tree.Binary)
    assert let.body.span.text == "(1 + 2)*\n  tan(x)"
    assert let.body.right.span.text == "tan(x)"
    assert (let.body.right.span.line, let.body.right.span.column) == (5, 3)


def test_a_statement_reaches_to_the_last_line_that_is_indented() -> None:
    text = "a\n  b\n\n# comment\n\tc # end\n   \nd\n"
    spans = [span.text for span in statement_spans(Source("t", text))]
    assert spans == ["a\n  b\n\n# comment\n\tc # end", "d"]


def test_a_bad_statement_hides_no_other() -> None:
    parsed = parse(Source("t", "let a = 1\nlet b = (\nlet c = 2\nlett d = 3\nlet e = 4\n"))
    assert [s.name for s in parsed.statements if isinstance(s, tree.Let)] == ["a", "c", "e"]
    assert [d.span.line for d in parsed.diagnostics] == [2, 4]
    assert {"b", "d"} <= parsed.unread


def test_nesting_ends_somewhere() -> None:
    assert not parse(Source("t", "radiance = " + "-" * 90 + "1")).diagnostics
    assert not parse(Source("t", "radiance = " + "(" * 5000 + "1" + ")" * 5000)).diagnostics
    for text in ("-" * 5000 + "1", "+".join("1" * 5000), "f(" * 5000 + "1" + ")" * 5000):
        (found,) = parse(Source("t", f"radiance = {text}")).diagnostics
        assert "100 levels deep" in found.message


def test_size_ends_somewhere() -> None:
    (found,) = parse(Source("t", "#" * (2 << 20))).diagnostics
    assert "too long" in found.message
    assert len(parse(Source("t", "let\n" * 10_000)).diagnostics) == 100


# ---------------------------------------------------------------- printed and read again

NAMES = st.from_regex(r"[A-Za-z_][A-Za-z_0-9]{0,6}", fullmatch=True).filter(
    lambda name: name not in KEYWORDS
)
PLACE = Source("made", "").span(0, 0)
NUMBERS = st.builds(
    tree.Number,
    st.just(PLACE),
    st.integers(0, 10**9).map(lambda n: Fraction(n, 1000)),
    st.sampled_from(["", "deg", "rad"]),
)
OPERATORS = ["+", "-", "*", "/", "^", "<", "<=", ">", ">=", "==", "!=", "and", "or"]


def larger(inner: st.SearchStrategy[tree.Expr]) -> st.SearchStrategy[tree.Expr]:
    place, several = st.just(PLACE), st.lists(inner, min_size=2, max_size=4).map(tuple)
    return st.one_of(
        st.builds(tree.Unary, place, st.sampled_from(["-", "not"]), inner),
        st.builds(tree.Binary, place, st.sampled_from(OPERATORS), inner, inner),
        st.builds(tree.Where, place, inner, inner, inner),
        st.builds(tree.LetIn, place, NAMES, inner, inner),
        st.builds(tree.Vector, place, several),
        st.builds(tree.Component, place, inner, st.integers(0, 2)),
        st.builds(tree.Call, place, NAMES | st.sampled_from(sorted(FUNCTIONS)), several),
    )


EXPRESSIONS = st.recursive(st.builds(tree.Name, st.just(PLACE), NAMES) | NUMBERS, larger)


@settings(deadline=None)
@given(EXPRESSIONS)
def test_what_is_printed_is_read_as_the_same(made: tree.Expr) -> None:
    text = shown(made)
    read = expression(text)
    assert shown(read) == text
    assert type(read) is type(made)
