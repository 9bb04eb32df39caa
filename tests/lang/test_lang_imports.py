"""Imports: where files are found, what they bring, and what stands for what."""

from __future__ import annotations

from pathlib import Path

import pytest

from brdfc.lang import imports
from brdfc.lang.load import load
from brdfc.lang.model import Definition, Model, Quantity
from brdfc.source.errors import ModelError

SHAPES = """\
module shapes "Functions"
let square(x) = x*x
let bump(x) = exp(-square(x))
"""
LOBE = """\
model lobe "A lobe"
channel m : roughness in 0.01..1 = 0.2
env t : angle in -90deg..90deg = 10deg as tt
let width = 2*m
let peak(x) = exp(-tan(x)^2/width^2)
let plain(x) = 2*x
radiance = peak(t)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for a user's files, beside an empty library."""
    (tmp_path / "library").mkdir()
    (tmp_path / "mine").mkdir()
    monkeypatch.setattr(imports, "library_folder", lambda: tmp_path / "library")
    return tmp_path / "mine"


def written(folder: Path, **texts: str) -> None:
    for name, text in texts.items():
        (folder / f"{name}.brdf").write_text(text, encoding="utf-8")


def loaded(folder: Path, body: str) -> Model:
    written(folder, main=f'model main "Main"\n{body}\n')
    return load(folder / "main.brdf")


def refused(folder: Path, body: str) -> str:
    """What is said of a text with errors, with the folder's name left out."""
    with pytest.raises(ModelError) as caught:
        loaded(folder, body)
    return str(caught.value).replace(f"{folder}/", "")


def symbol(definition: Definition, *names: str) -> Quantity | Definition:
    """What a name refers to, following the names one scope after the other."""
    found: Quantity | Definition = definition
    for name in names:
        assert isinstance(found, Definition)
        found = found.scope[name]
    return found


def test_functions_of_a_module(folder: Path) -> None:
    written(folder, shapes=SHAPES)
    main = loaded(folder, "import shapes (bump, square as sq)\nradiance = bump(1) + sq(2)")
    assert [d.name for d in main.definitions] == [], "only its own"
    assert symbol(main.radiance, "sq").name == "sq"
    assert symbol(main.radiance, "bump", "square").name == "square"


def test_the_library_is_searched_after_the_own_folder(folder: Path) -> None:
    written(folder.parent / "library", shapes=SHAPES)
    loaded(folder, "import shapes (bump)\nradiance = bump(1)")


def test_a_path_starts_from_the_importing_file(folder: Path) -> None:
    (folder / "sub").mkdir()
    written(folder / "sub", shapes=SHAPES, more='module more "m"\nimport "shapes.brdf" (bump)\n'
            "let twice(x) = 2*bump(x)")  # fmt: skip
    loaded(folder, 'import "sub/more.brdf" (twice)\nradiance = twice(1)')


def test_one_file_by_two_ways_is_read_once(folder: Path) -> None:
    written(folder, shapes=SHAPES, a='module a "a"\nimport shapes (bump)\nlet f(x) = bump(x)')
    loaded(folder, "import a (f)\nimport shapes (bump)\nimport shapes (square)\nradiance = f(1)")


def test_own_quantities_stand_for_those_of_an_imported_definition(folder: Path) -> None:
    written(folder, lobe=LOBE)
    main = loaded(
        folder,
        "channel m : roughness in 0.1..0.5\nimport lobe (peak as p, plain)\nradiance = p(1deg)",
    )
    assert [q.name for q in main.quantities] == ["m"]
    through = symbol(main.radiance, "p", "width", "m")
    assert through is main.quantities[0]


def test_a_whole_model_brings_its_quantities(folder: Path) -> None:
    written(folder, lobe=LOBE)
    main = loaded(
        folder,
        "channel k : number in 0..1\nchannel m : roughness in 0.1..0.5\nimport lobe\n"
        "radiance = k*lobe where t > 0deg else 0",
    )
    assert [q.name for q in main.quantities] == ["k", "m", "t"], "its own first"
    assert main.quantities[1].low == 0.1
    assert symbol(main.radiance, "lobe", "width", "m") is main.quantities[1]
    assert symbol(main.radiance, "lobe", "t") is main.quantities[2]


def test_two_whole_models_share_what_has_one_name(folder: Path) -> None:
    flat = 'model flat "f"\nchannel k : number in 0..1\nenv t : angle in 0deg..9deg = 0deg as tt\n'
    written(folder, lobe=LOBE, flat=f"{flat}radiance = k*cos(t)")
    main = loaded(folder, 'import lobe\nimport "flat.brdf"\nradiance = lobe + flat')
    assert [q.name for q in main.quantities] == ["m", "t", "k"]
    assert symbol(main.radiance, "flat", "t") is symbol(main.radiance, "lobe", "t")


def test_standing_reaches_through_files(folder: Path) -> None:
    middle = 'model middle "m"\nchannel m : roughness in 0.1..1\nimport lobe (peak)\n'
    written(folder, lobe=LOBE, middle=f"{middle}let far(x) = peak(x)\nradiance = m")
    main = loaded(
        folder, "channel m : roughness in 0.2..1\nimport middle (far)\nradiance = far(1deg)"
    )
    assert symbol(main.radiance, "far", "peak", "width", "m") is main.quantities[0]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("import shaps (bump)", "no 'shaps.brdf' beside this file, nor in the library"),
        ("import shaps (bump)", "did you mean 'shapes'?"),
        ('import "no/such.brdf" (bump)', "there is no file 'no/such.brdf'"),
        ("import shapes (bumb)", "'shapes' does not define 'bumb'"),
        ("import shapes (bumb)", "did you mean 'bump'?"),
        ("import shapes", "name what you need of it: import shapes (square, bump)"),
        ("import lobe (m)", "'m' is a quantity of that model: declare your own"),
        ("import lobe (peak)", "'peak' uses 'm', which is not declared here"),
        ("import lobe (peak)", "declare it: channel m : roughness in ..."),
        ("channel m : number in 0..1\nimport lobe (peak)", "'m', which is of type number here"),
        ("channel m : number in 0..1\nimport lobe", "'m' of 'lobe' is of type roughness"),
        ("channel t : number in 0..1\nimport shapes (bump as t)", "'t' is declared twice"),
        ("import shapes (bump as cos)", "'cos' is a built-in function"),
        ("import shapes (bump)\nlet bump(x) = x", "'bump' is declared twice"),
        ("import lobe\nlet m = 1", "'m' is declared twice"),
        ("import lobe\nlet lobe = 1", "'lobe' is declared twice"),
        ("env q : number in 0..1 = 1 as tt\nimport lobe", "the signature 'tt' of 't' is taken"),
        ("import shapes (bump)\nlet f(bump) = 1", "'bump' would hide"),
        ("import both (f)", "'both' is ambiguous"),
        ("import both (f)", "rename your both.brdf"),
        ("import broken (f)", "broken.brdf:2:12: error: nothing here is called 'y'"),
        ("import notes (f)", "'notes': this is a binary file"),
    ],
)
def test_what_can_be_wrong(folder: Path, body: str, said: str) -> None:
    both = 'module both "b"\nlet f(x) = x'
    written(folder.parent / "library", both=both)
    written(folder, shapes=SHAPES, lobe=LOBE, both=both)
    written(folder, broken='module broken "b"\nlet f(x) = y', notes="\0\1\2")
    assert said in refused(folder, f"{body}\nradiance = 1")


def test_a_failed_import_is_the_only_error(folder: Path) -> None:
    said = refused(folder, "import nothing (f as g)\nimport nowhere\nradiance = g(1) + nowhere*m")
    assert said.count("error:") == 2


def test_an_error_in_an_imported_function_shows_both_places(folder: Path) -> None:
    written(folder, shapes='module shapes "s"\nlet far(x) = cos(x)')
    said = refused(folder, "import shapes (far)\nradiance = far(1)")
    assert "shapes.brdf:2:18: error: 'cos' takes an angle, and this is a number" in said
    assert "main.brdf:3:12: in the function called here" in said


def test_circles(folder: Path) -> None:
    for name, other in (("a", "b"), ("b", "c"), ("c", "a")):
        written(
            folder,
            **{name: f'module {name} "m"\nimport {other} (g)\nlet f(x) = g(x)\nlet g(x) = 1'},
        )
    said = refused(folder, "import a (g)\nradiance = g(1)")
    assert "in a circle: a.brdf -> b.brdf -> c.brdf -> a.brdf" in said
    assert said.count("error:") == 1
    assert "main.brdf -> main.brdf" in refused(folder, "import main\nradiance = 1")


def test_a_row_of_imports_ends_somewhere(folder: Path) -> None:
    for i in range(40):
        written(folder, **{f"f{i}": f'module f{i} "m"\nimport f{i + 1} (g)\nlet g(x) = x'})
    assert "more than 16 files" in refused(folder, "import f0 (g)\nradiance = g(1)")


def test_a_module_that_needs_quantities_cannot_be(folder: Path) -> None:
    written(folder, lobe=LOBE, half='module half "h"\nimport lobe (peak)\nlet f(x) = peak(x)')
    said = refused(folder, "import half (f)\nradiance = 1")
    assert "half.brdf:2:14: error: 'peak' uses 'm'" in said
