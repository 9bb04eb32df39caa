"""Names in a calculator: where the reference puts what they stand for, and what it is told of
mistakes."""

from __future__ import annotations

from pathlib import Path

import pytest
from xml_samples import calculator, program

from brdfc.calc.program import Matrix, Program
from brdfc.calc.text import disassemble
from brdfc.source.errors import BrdfcError


def text(main: str, declarations: str = "", attributes: str = "", channels: int = 3) -> str:
    """The main function as it stands in the profile, on one line."""
    made = program(calculator(main, declarations, attributes, channels))
    return " ".join(disassemble(made.body).split())


def refused(main: str, declarations: str = "", attributes: str = "") -> str:
    with pytest.raises(BrdfcError) as caught:
        program(calculator(main, declarations, attributes))
    return str(caught.value)


# ---------------------------------------------------------------- what names stand for


def test_channels() -> None:
    names = 'InputNames="C MY[2]" OutputNames="a b[2]"'
    assert text(
        "{ in{C} in{MY} in{MY[1]} in{MY[0],2} in{C,3} out{a} out{b} out{b[1]} }", "", names
    ) == ("{ in[0,1] in[1,2] in[2,1] in[1,2] in[0,3] out[0,1] out[1,2] out[2,1] }")


def test_variables_stand_after_those_with_a_position_in_the_order_of_their_use() -> None:
    declarations = """<Variables>
      <Declare Name="unused" Size="7"/> <Declare Name="late"/>
      <Declare Name="fixed" Position="4" Size="2"/> <Declare Name="rgb">r g[2] b</Declare>
    </Variables>"""
    assert text(
        "{ 1 tput{rgb} tget{rgb.g} tput{late} tsav{rgb.b} tput{fixed[1]} tget{rgb.g[1]} "
        "tget{rgb[0,3]} }",
        declarations,
    ) == ("{ 1 tput[6,4] tget[7,2] tput[10,1] tsav[9,1] tput[5,1] tget[8,1] tget[6,3] }")


def test_locals_stand_after_all_variables_those_of_inner_macros_after_the_callers() -> None:
    declarations = """<Variables><Declare Name="v" Size="2"/><Declare Name="w"/></Variables>
    <Macros>
      <Macro Name="double">2 mul</Macro>
      <Macro Name="outer" Local="a b[2]">tput{@a} #inner call{inner} tget{@b[1]} tput{w}</Macro>
      <Macro Name="inner" Local="a">#double tput{@a}</Macro>
    </Macros>"""
    assert text("{ 5 call{outer} #inner tput{v} }", declarations) == (
        "{ 5 tput[3,1] 2 mul tput[6,1] 2 mul tput[6,1] tget[5,1] tput[0,1] 2 mul tput[3,1] "
        "tput[1,2] }"
    )


def test_macros_may_hold_choices_and_comments() -> None:
    macros = (
        """<Macros><Macro Name="m">if { 1 } else { sel case { 2 } } ; the end</Macro></Macros>"""
    )
    assert text("{ 0 #m }", macros) == "{ 0 if { 1 } else { sel case { 2 } } }"


def test_sub_elements_unnamed_first_then_as_they_are_used() -> None:
    def matrix(name: str, value: int) -> str:
        named = f'Name="{name}"' if name else ""
        return (
            f'<MatrixElement {named} InputChannels="1" OutputChannels="1">'
            f"<MatrixData>{value}</MatrixData></MatrixElement>"
        )

    listed = [("a", 1), ("", 2), ("b", 3), ("c", 4), ("", 5)]
    declarations = f"<SubElements>{''.join(matrix(*row) for row in listed)}</SubElements>"
    made = program(calculator("{ 1 mtx{c} elem{a} mtx{c} mtx(1) }", declarations))
    assert " ".join(disassemble(made.body).split()) == "{ 1 mtx(2) elem(3) mtx(2) mtx(1) }"
    assert [e.values for e in made.elements if isinstance(e, Matrix)] == [(2,), (5,), (4,), (1,)]


def test_calculators_inside_have_names_of_their_own() -> None:
    inner = """<SubElements><CalculatorElement Name="f" InputChannels="1" OutputChannels="1"
      InputNames="x"><Variables><Declare Name="v"/></Variables>
      <MainFunction>{ in{x} tput{v} tget{v} out }</MainFunction></CalculatorElement></SubElements>
      <Variables><Declare Name="v" Position="9"/></Variables>"""
    made = program(calculator("{ 1 calc{f} tput{v} }", inner))
    (function,) = made.elements
    assert isinstance(function, Program)
    assert disassemble(function.body).split()[1:3] == ["in[0,1]", "tput[0,1]"]


def test_comments_of_both_kinds_are_passed_over() -> None:
    assert text("<!-- { a } -->\n{ 1 % one\n 2 <!-- three --> ; four\n / five\n }") == "{ 1 2 }"


def test_spaces_in_brackets_as_the_iccs_samples_have_them() -> None:
    assert text("{ in(0, 3) pop( 3 ) }") == "{ in[0,3] pop(3) }".replace("pop(3)", "pop[3]")


# ---------------------------------------------------------------- imports


def library(folder: Path, name: str, inside: str) -> None:
    path = folder / name
    path.parent.mkdir(exist_ok=True, parents=True)
    path.write_text(f"<IccCalcImport>{inside}</IccCalcImport>")


def imported(*names: str) -> str:
    listed = "".join(f'<Import Filename="{name}"/>' for name in names)
    return f"<Imports>{listed}</Imports>"


def test_imports_bring_variables_macros_and_elements(tmp_path: Path) -> None:
    library(
        tmp_path,
        "parts/a.xml",
        imported("b.xml")
        + """<Variables><Declare Name="v"/></Variables>
        <SubElements><MatrixElement Name="M" InputChannels="1" OutputChannels="1">
        <MatrixData>3</MatrixData></MatrixElement></SubElements>""",
    )
    library(tmp_path, "parts/b.xml", '<Macros><Macro Name="m">mtx{M} tput{v}</Macro></Macros>')
    data = calculator("{ 1 #m }", imported("parts/a.xml", "parts/b.xml", "parts/a.xml"))
    made = program(data, tmp_path)
    assert disassemble(made.body).split()[1:4] == ["1", "mtx", "tput[0,1]"]


def macro(name: str, inside: str) -> str:
    return f'<Macros><Macro Name="{name}">{inside}</Macro></Macros>'


def variable(attributes: str, inside: str = "") -> str:
    return f"<Variables><Declare {attributes}>{inside}</Declare></Variables>"


UNNAMED = '<SubElements><MatrixElement InputChannels="1" OutputChannels="1"/></SubElements>'


@pytest.mark.parametrize(
    ("files", "names", "message"),
    [
        ({}, ["b.xml"], "x.xml:11:10: error: there is no file 'b.xml'"),
        ({"a.xml": imported("a.xml")}, ["a.xml"], "a.xml:1:25: error: imports in a circle"),
        (
            {"a.xml": imported("b.xml"), "b.xml": imported("a.xml")},
            ["a.xml"],
            "b.xml:1:25: error: imports in a circle",
        ),
        ({}, ["../b.xml"], "error: '../b.xml' lies outside the folder of the document"),
        ({}, ["/etc/passwd"], "error: '/etc/passwd' lies outside the folder"),
        ({}, ["."], "error: there is no file '.'"),
        ({}, ["a" * 5000], "' cannot be read"),
        ({"a.xml": "<Macros>"}, ["a.xml"], "a.xml:1:26: error: not well-formed XML"),
        ({"a.xml": "<Header/>"}, ["a.xml"], "<Header> cannot stand in <IccCalcImport>"),
        (
            {"a.xml": UNNAMED},
            ["a.xml"],
            "an imported sub-element needs a Name",
        ),
        (
            {"a.xml": '<Variables><Declare Name="v" Position="2"/></Variables>'},
            ["a.xml"],
            "an imported variable has no Position",
        ),
        (
            {"a.xml": macro("m", "1"), "b.xml": macro("m", "2")},
            ["a.xml", "b.xml"],
            "b.xml:1:24: error: a macro 'm' is declared already, with another text",
        ),
    ],
)
def test_imports_that_are_refused(
    files: dict[str, str], names: list[str], message: str, tmp_path: Path
) -> None:
    for name, inside in files.items():
        library(tmp_path, name, inside)
    with pytest.raises(BrdfcError) as caught:
        program(calculator("{ 1 }", imported(*names)), tmp_path)
    assert message in str(caught.value).replace(f"{tmp_path}/", "")


def test_a_link_does_not_lead_out_of_the_folder(tmp_path: Path) -> None:
    library(tmp_path, "secret.xml", "")
    (tmp_path / "inside").mkdir()
    (tmp_path / "inside" / "a.xml").symlink_to(tmp_path / "secret.xml")
    with pytest.raises(BrdfcError, match="lies outside the folder"):
        program(calculator("{ 1 }", imported("a.xml")), tmp_path / "inside")


def test_a_document_is_the_import_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("<IccProfile/>")
    with pytest.raises(BrdfcError, match="an imported document is an <IccCalcImport>"):
        program(calculator("{ 1 }", imported("a.xml")), tmp_path)


# ---------------------------------------------------------------- mistakes

VARIABLES = '<Variables><Declare Name="light" Size="3">x y z</Declare></Variables>'
MACROS = '<Macros><Macro Name="a" Local="t">#b</Macro><Macro Name="b">call{a}</Macro></Macros>'


@pytest.mark.parametrize(
    ("main", "declarations", "message"),
    [
        ("{ tget{lihgt} }", VARIABLES, "no variable is called 'lihgt'"),
        ("{ tget{lihgt} }", VARIABLES, "did you mean 'light'?"),
        ("{ tget{light.w} }", VARIABLES, "no member of 'light' is called 'w'"),
        ("{ tget{light[3]} }", VARIABLES, "'light' has 3 values, none at 3"),
        ("{ tget{light[1,3]} }", VARIABLES, "'light' has 3 values, none at 3"),
        ("{ tget{light[0,0]} }", VARIABLES, "'light' has 3 values"),
        ("{ tget{light],2} }", VARIABLES, "is no name, nor a name with [first,count]"),
        ("{ tget{light[0],2} }", VARIABLES, "a count of temporaries stands in the bracket"),
        ("{ tget{@t} }", MACROS, "'@t' is a local variable, and this is no macro"),
        ("{ #a }", MACROS, "macros in a circle: a calls b calls a"),
        ("{ call{c} }", MACROS, "no macro is called 'c'"),
        ("{ call{c} }", "", "no macro is declared"),
        ("{ mtx{M} }", "", "no sub-element is called 'M'"),
        ("{ sin{x} }", "", "'sin' takes no name in braces"),
        ("{ foo{x} }", "", "'foo' takes no name in braces"),
        ("{ in{x} }", "", "no input channel is called 'x'"),
        ("{ in[0,3]pop }", "", "'in[0,3]pop' cannot stand here"),
        ("{ tget{ light } }", VARIABLES, "names in braces have no spaces"),
        ("{ 1", "", "the text ends before its last '}'"),
        ("", "", "the text ends before its last '}'"),
        ("{ 1 }", '<Variables><Declare Name="1a"/></Variables>', "'1a' is no name"),
        ("{ 1 }", VARIABLES * 2, "a variable 'light' is declared already"),
        ("{ 1 }", '<Variables><Declare Name="a" Size="x"/></Variables>', "Size is a whole number"),
        ("{ 1 }", variable('Name="a" Position="65530" Size="9"'), "65536 temporaries"),
        ("{ 1 }", variable('Name="a"', "b[0]"), "'b[0]' has an impossible size"),
        ("{ 1 }", variable('Name="a"', "b b"), "'b' stands there twice"),
        ("{ 1 }", '<Macros><Macro Name="a">{ 1 }</Macro></Macros>', "'{' cannot stand here"),
        ("{ 1 }", '<Macros><Macro Name="a">1 }</Macro></Macros>', "cannot stand here"),
        ("{ 1 }", "<Macros><Macro>1</Macro></Macros>", "<Macro> needs the attribute 'Name'"),
        ("{ 1 }", "<Varables/>", "<Varables> cannot stand in <CalculatorElement>"),
        ("{ 1 }", "<Varables/>", "did you mean 'Variables'?"),
        ("{ 1 <b/> }", "", "<b> cannot stand in <MainFunction>"),
    ],
)
def test_mistakes(main: str, declarations: str, message: str) -> None:
    assert message in refused(main, declarations)


def test_the_place_of_a_mistake_is_that_in_the_file() -> None:
    message = refused("\n{\n  in[0,3] <!-- a\n comment --> tget{lihgt} }\n", VARIABLES)
    assert message == (
        "x.xml:15:14: error: no variable is called 'lihgt'\n"
        "   15 |  comment --> tget{lihgt} }\n"
        "      |              ^^^^^^^^^^^\n"
        "          hint: did you mean 'light'?"
    )


def test_the_place_of_a_mistake_in_a_macro_is_in_the_macro() -> None:
    message = refused("{ #m }", '<Macros><Macro Name="m">1 soin</Macro></Macros>')
    assert message.startswith("x.xml:11:27: error: 'soin' is no operator")


def test_names_of_too_many_channels() -> None:
    assert "InputNames names 4 channels; there are 3" in refused("{ 1 }", "", 'InputNames="a[4]"')
