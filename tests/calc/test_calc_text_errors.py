"""Every mistake in a calculator's text, and what its author is shown."""

import pytest

from brdfc.calc.program import MAX_NESTING
from brdfc.calc.text import assemble
from brdfc.source.errors import ProgramError

ANYWHERE = "calculator text is one { ... }, with a block { ... } after each if, else, case and dflt"

CASES = {
    "unknown operator": (
        "{\n  in[0,3]\n  sine[3]\n}",
        "ward.calc:3:3: error: 'sine' is no operator\n"
        "    3 |   sine[3]\n"
        "      |   ^^^^^^^\n"
        "          hint: did you mean 'sin'?",
    ),
    "no end": (
        "{ in[0,3] out[0,3]\n",
        "ward.calc:1:19: error: the text ends before its last '}'\n"
        "    1 | { in[0,3] out[0,3]\n"
        "      |                   ^",
    ),
    "no braces": (
        "in[0,3]",
        "ward.calc:1:1: error: 'in[0,3]' cannot stand here\n"
        "    1 | in[0,3]\n"
        "      | ^^^^^^^\n"
        f"          hint: {ANYWHERE}",
    ),
    "after the end": (
        "{ 1 } pop",
        "ward.calc:1:7: error: 'pop' cannot stand here\n"
        "    1 | { 1 } pop\n"
        "      |       ^^^\n"
        f"          hint: {ANYWHERE}",
    ),
    "no block": (
        "{ 1 if pop }",
        "ward.calc:1:8: error: 'pop' cannot stand here\n"
        "    1 | { 1 if pop }\n"
        "      |        ^^^\n"
        f"          hint: {ANYWHERE}",
    ),
    "else alone": (
        "{ 1 else { } }",
        "ward.calc:1:5: error: 'else' cannot stand here\n"
        "    1 | { 1 else { } }\n"
        "      |     ^^^^\n"
        "          hint: 'else' stands right after 'if { ... }'",
    ),
    "case alone": (
        "{ 1 case { } }",
        "ward.calc:1:5: error: 'case' cannot stand here\n"
        "    1 | { 1 case { } }\n"
        "      |     ^^^^\n"
        "          hint: 'case' stands right after 'sel'",
    ),
    "default twice": (
        "{ 1 sel case { } dflt { } dflt { } }",
        "ward.calc:1:27: error: 'dflt' cannot stand here\n"
        "    1 | { 1 sel case { } dflt { } dflt { } }\n"
        "      |                           ^^^^\n"
        "          hint: 'dflt' stands right after 'case { ... }'",
    ),
    "sub-element by name": (
        "{ mtx{M} }",
        "ward.calc:1:3: error: 'mtx{M}' refers to a name, and this text has none\n"
        "    1 | { mtx{M} }\n"
        "      |   ^^^^^^\n"
        "          hint: variables, macros and channels have names in XML only; here they are "
        "called by number",
    ),
    "glued to a bracket": (
        "{ in[0,3]pop }",
        "ward.calc:1:3: error: 'in[0,3]pop' cannot stand here\n"
        "    1 | { in[0,3]pop }\n"
        "      |   ^^^^^^^^^^\n"
        "          hint: put a space after the closing bracket",
    ),
    "too large": (
        "{ 1e39 }",
        "ward.calc:1:3: error: this number does not fit a 32-bit float\n"
        "    1 | { 1e39 }\n"
        "      |   ^^^^\n"
        "          hint: infinity is +INF or -INF",
    ),
    "a constant's operator": (
        "{ data }",
        "ward.calc:1:3: error: a constant is written as the bare number\n"
        "    1 | { data }\n"
        "      |   ^^^^",
    ),
    "an argument too many": (
        "{ sin[1,2] }",
        "ward.calc:1:3: error: 'sin' takes [n]: components of a vector\n"
        "    1 | { sin[1,2] }\n"
        "      |   ^^^^^^^^",
    ),
    "out of range": (
        "{ sum(1) }",
        "ward.calc:1:3: error: 1 is outside 2 to 65537\n    1 | { sum(1) }\n      |   ^^^^^^",
    ),
}


@pytest.mark.parametrize(("text", "expected"), CASES.values(), ids=CASES.keys())
def test_message(text, expected):
    with pytest.raises(ProgramError) as caught:
        assemble(text, "ward.calc")
    assert str(caught.value) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the text ends before its last '}'"),
        ("{", "the text ends before its last '}'"),
        ("{ % }", "the text ends before its last '}'"),
        ("{ 1 if { }", "the text ends before its last '}'"),
        ("{ +5 }", "'+5' is no operator"),
        ("{ - }", "'-' is no operator"),
        ("{ iffy }", "'iffy' is no operator"),
        ("{ 1e999 }", "this number does not fit a 32-bit float"),
        ("{ 1.5sin }", "'1.5sin' cannot stand here"),
        ("{ 1 sel { } }", "'{' cannot stand here"),
        ("{ 1 sel dflt { } }", "'dflt' cannot stand here"),
        ("{ 1 sel case { } else { } }", "'else' cannot stand here"),
        ("{ 1 if { } else { } else { } }", "'else' cannot stand here"),
        ("{ if(3) { } }", "'if(3)' cannot stand here"),
        ("{ in[0,3) }", "'in[0,3)' cannot stand here"),
        ("{ in[0 3] }", "'in' takes [start,count]"),
        ("{ ~ }", "'~' cannot stand here"),
        ("{ \0 }", "cannot stand here"),
        ("{ in[] }", "'in' takes [start,count]"),
        ("{ in[1,2,3] }", "'in' takes [start,count]"),
        ("{ in[-1] }", "'in' takes [start,count]"),
        ("{ in[٣] }", "'in' takes [start,count]"),
        ("{ ٣ }", "'٣' cannot stand here"),
        ("{ in[0,70000] }", "70000 is outside 1 to 65536"),
        ("{ in[99999999999999999999] }", "'in' takes [start,count]"),
        ("{ sin[0] }", "0 is outside 1 to 65536"),
        ("{ mtx(65536) }", "65536 is outside 0 to 65535"),
        ("{ pi[2] }", "'pi' takes no argument"),
        ("{ env }", "'env' takes a name of up to 4 characters, or 8 hex digits"),
        ("{ env(azimu) }", "'env' takes a name"),
        ("{ env(ε) }", "'env' takes a name"),
        ("{ env(a,b) }", "'env' takes a name"),
    ],
)
def test_other_mistakes(text, message):
    with pytest.raises(ProgramError) as caught:
        assemble(text)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "{ 1 if " * 100_000,
        "{ 1 if { " * 65 + "} " * 66,
        "{\n" + "env(;) if {\n" * 500 + "}" * 501,
        "{ 1 sel case {" * 100_000,
    ],
)
def test_nesting_bombs(text):
    """Also where a comment sign in an argument would hide a brace from the count."""
    with pytest.raises(ProgramError):
        assemble(text)


def test_nesting_message():
    text = "{" + " 1 if {" * (MAX_NESTING + 1)
    with pytest.raises(ProgramError) as caught:
        assemble(text, "t")
    assert str(caught.value).startswith(f"t:1:{len(text)}: error: blocks nest deeper than 64\n")
