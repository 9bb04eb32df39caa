"""A stack of images to an image of coefficients: what comes out, what is refused, what outlives an
interruption."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import tifffile
from stacks import ANGLES, coefficients, directions, reflected, write_stack

from brdfc.fit import pixel_image
from brdfc.fit.measurements import Kind
from brdfc.fit.pixel_image import Fitted, Options, fit_stack
from brdfc.fit.response import Response
from brdfc.fit.stack import read_stack
from brdfc.images import cluster, memory, unfinished
from brdfc.lang.load import load
from brdfc.source.errors import BrdfcError, FitError, ImageError, MeasurementError
from brdfc.symbolic.formula import NO_WHITE


@pytest.fixture(autouse=True)
def small_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "WINDOW_PIXELS", 60)
    monkeypatch.setattr(memory, "_FEWEST", 40)
    monkeypatch.setattr(pixel_image, "BATCH", 60)
    monkeypatch.setattr(cluster, "TASK_PIXELS", 120)


def fitted(path: Path, name: str = "ward", out: str = "out.tif", **options: object) -> Fitted:
    quality = path.parent / f"q_{out}"
    chosen = Options(**options)  # type: ignore[arg-type]
    model = load(name, "full")
    return fit_stack(model, read_stack(path), path.parent / out, quality, options=chosen)


def read(path: Path, out: str = "out.tif") -> tuple[np.ndarray, np.ndarray]:
    return tifffile.imread(path.parent / out), tifffile.imread(path.parent / f"q_{out}")


def left(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir() if not p.name[0].isdigit())


@pytest.mark.parametrize("name", ["lambert", "ward", "ggx"])
def test_the_truth_comes_back(name: str, tmp_path: Path) -> None:
    truth = coefficients(name, 20, 17)
    path = write_stack(tmp_path, reflected(name, truth))
    found = fitted(path, name)
    assert (found.pixels, found.fitted, found.left_out) == (340, 340, 0)
    image, quality = read(path)
    assert image.dtype == np.float32
    np.testing.assert_allclose(image, truth, rtol=5e-3, atol=1e-4)
    assert quality.shape == (20, 17, 3)
    assert (quality[..., 1:] == (1, 40)).all()
    with tifffile.TiffFile(tmp_path / "out.tif") as tiff:
        described = tiff.pages[0].description
    assert described == f"coefficients of {name}: {', '.join(found.coefficients)}"


def test_a_profile_takes_what_is_written(tmp_path: Path) -> None:
    import brdfc
    from brdfc.images.apply import apply_to_tiff

    path = write_stack(tmp_path, reflected("ward", coefficients("ward", 6, 7)))
    fitted(path)
    pair = brdfc.compile(load("ward"))
    link = brdfc.connect(pair.mid, pair.mvis, env={"incident": 0.7, "reflection": 0.2})
    apply_to_tiff(brdfc.rendering(link), tmp_path / "out.tif", tmp_path / "xyz.tif")
    assert np.isfinite(tifffile.imread(tmp_path / "xyz.tif")).all()


@pytest.mark.parametrize(
    ("unit", "factor"), [("radiance-factor", np.pi), ("percent", 100 * np.pi), ("cosine", 0)]
)
def test_units(unit: str, factor: float, tmp_path: Path) -> None:
    truth = coefficients("ward", 4, 5)
    scaled = reflected("ward", truth).astype(float)
    if factor:
        scaled *= factor
    else:
        unit = "brdf-cos-incident"
        scaled *= np.cos(np.radians([i for i, _ in ANGLES]))[:, None]
    path = write_stack(tmp_path, scaled.astype(np.float32), unit)
    fitted(path)
    np.testing.assert_allclose(read(path)[0], truth, rtol=5e-3, atol=1e-4)


def test_one_band_is_neutral_and_rgb_has_no_white(tmp_path: Path) -> None:
    truth = np.tile([0.3, 0.3, 0.3, 0.05, 0.15], (4, 5, 1))
    values = Response(load("ward", "full"), directions(), {}, NO_WHITE).values(truth)
    path = write_stack(tmp_path / "single", values[..., 1:2].astype(np.float32))
    fitted(path)
    found = read(path)[0]
    np.testing.assert_allclose(found[..., 1], 0.3, rtol=1e-2)
    np.testing.assert_allclose(found[..., 4], 0.15, rtol=1e-2)
    path = write_stack(tmp_path / "rgb", values.astype(np.float32), says='colours = "RGB"')
    fitted(path)
    np.testing.assert_allclose(read(path)[0], truth, rtol=1e-2)


def test_integers_with_a_scale(tmp_path: Path) -> None:
    truth = coefficients("ward", 4, 5)
    whole = np.round(reflected("ward", truth) * (65535 / 8)).astype(np.uint16)
    path = write_stack(tmp_path / "a", whole, says='scale = "0..8"')
    fitted(path)
    np.testing.assert_allclose(read(path)[0], truth, rtol=0.05, atol=5e-3)
    with pytest.raises(ImageError, match="uint16, and nothing says what they mean"):
        fitted(write_stack(tmp_path / "b", whole))


def test_masks_and_pixels_that_fail(tmp_path: Path) -> None:
    values = reflected("ward", coefficients("ward", 10, 12))
    values[0, 0] = np.nan
    values[0, 1, 2:] = -1
    values[2, 2, 7] = np.inf
    bright = values > 1.5
    path = write_stack(tmp_path, values)
    found = fitted(path, clip=1.5)
    assert found.few == 2
    assert found.fitted + found.failed == 118
    assert found.left_out >= bright[np.isfinite(values)].sum() + 3 * 40
    image, quality = read(path)
    assert np.isnan(image[0, :2]).all()
    assert quality[0, 0].tolist()[1:] == [0, 0]
    assert quality[0, 1].tolist()[1:] == [0, 2]
    assert quality[2, 2, 2] == 39 - bright[2, 2].any(axis=-1).sum() + bright[2, 2, 7].any()


def test_what_did_not_converge_is_nan_unless_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from brdfc.fit import pixels

    monkeypatch.setattr(pixels, "MOST_STEPS", 1)
    path = write_stack(tmp_path, reflected("ward", coefficients("ward", 5, 6), 0.05))
    found = fitted(path)
    assert (found.fitted, found.failed) == (0, 30)
    image, quality = read(path)
    assert np.isnan(image).all()
    assert (quality[..., 1] == 0).all()
    fitted(path, out="kept.tif", keep=True)
    image, quality = read(path, "kept.tif")
    assert np.isfinite(image).all()
    assert (quality[..., 1] == 0).all()


@pytest.mark.parametrize(
    "options", [{"rowsperstrip": 3, "compression": "zlib"}, {"tile": (16, 16)}]
)
def test_the_same_bytes_with_any_threads_and_memory(
    options: dict[str, object], tmp_path: Path
) -> None:
    values = reflected("ward", coefficients("ward", 40, 33), 0.05)
    path = write_stack(tmp_path, values, **options)
    bytes_of = []
    for number, how in enumerate(({}, {"threads": 1}, {"threads": 5, "memory": 300 * 10**6})):
        fitted(path, out=f"{number}_out.tif", **how)
        bytes_of.append(
            [(tmp_path / n).read_bytes() for n in (f"{number}_out.tif", f"q_{number}_out.tif")]
        )
    assert bytes_of[0] == bytes_of[1] == bytes_of[2]


class Stopped(Exception):
    pass


def stop_at(share: float) -> Callable[[int, int], None]:
    def progress(done: int, total: int) -> None:
        if done > share * total:
            raise Stopped

    return progress


def test_a_run_goes_on_where_it_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unfinished, "_EVERY", 0.0)
    path = write_stack(tmp_path, reflected("ward", coefficients("ward", 30, 20), 0.05))
    whole = fitted(path, out="whole.tif")
    model, stack = load("ward", "full"), read_stack(path)
    out, quality = tmp_path / "out.tif", tmp_path / "q_out.tif"
    options = Options(resume=True)
    for share in (0.3, 0.6):
        with pytest.raises(Stopped):
            fit_stack(model, stack, out, quality, options=options, progress=stop_at(share))
        assert ".out.tif.journal" in left(tmp_path)
        assert "out.tif" not in left(tmp_path)
    with pytest.raises(ImageError, match="other options"):
        fit_stack(model, stack, out, quality, options=Options(resume=True, clip=3.0))
    with pytest.raises(ImageError, match="other model"):
        fit_stack(load("ward_duer", "full"), stack, out, quality, options=options)
    starts: list[int] = []
    found = fit_stack(
        model, stack, out, quality, options=options, progress=lambda d, t: starts.append(d)
    )
    assert starts[0] > 300
    assert found == whole
    assert out.read_bytes() == (tmp_path / "whole.tif").read_bytes()
    assert quality.read_bytes() == (tmp_path / "q_whole.tif").read_bytes()
    assert left(tmp_path) == ["out.tif", "q_out.tif", "q_whole.tif", "stack.toml", "whole.tif"]


def test_without_resume_nothing_is_left(tmp_path: Path) -> None:
    path = write_stack(tmp_path, reflected("lambert", coefficients("lambert", 20, 20)))
    with pytest.raises(Stopped):
        fit_stack(
            load("lambert", "full"),
            read_stack(path),
            tmp_path / "out.tif",
            progress=stop_at(0.5),
        )
    assert left(tmp_path) == ["stack.toml"]


def test_a_cluster_writes_what_one_machine_does(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="runs on a cluster need distributed")
    path = write_stack(tmp_path, reflected("ward", coefficients("ward", 20, 20), 0.05))
    here = fitted(path, out="here.tif")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as started:
        there = fitted(path, out="there.tif", scheduler=started.scheduler_address)
    assert here == there
    for prefix in ("", "q_"):
        pair = [(tmp_path / f"{prefix}{n}.tif").read_bytes() for n in ("here", "there")]
        assert pair[0] == pair[1]


def test_images_that_do_not_fit(tmp_path: Path) -> None:
    values = reflected("lambert", coefficients("lambert", 4, 5))
    path = write_stack(tmp_path, values)
    tifffile.imwrite(
        tmp_path / "3.tif", values[:3, :, 3], photometric="minisblack", planarconfig="contig"
    )
    with pytest.raises(ImageError, match="3 rows of 5 pixels of 3 samples, the first image has 4"):
        fitted(path, "lambert")
    (tmp_path / "3.tif").unlink()
    with pytest.raises(ImageError, match=r"3\.tif: cannot be read"):
        fitted(path, "lambert")
    (tmp_path / "3.tif").write_text("no image")
    with pytest.raises(ImageError, match="not a TIFF"):
        fitted(path, "lambert")
    path = write_stack(tmp_path / "two", values[..., :2])
    with pytest.raises(ImageError, match="2 samples a pixel; an image of a stack has 1 or 3"):
        fitted(path, "lambert")
    path = write_stack(tmp_path / "few", values[:, :, :2])
    with pytest.raises(FitError, match="2 geometries for 5 coefficients of 'ward'"):
        fitted(path)
    with pytest.raises(BrdfcError, match="the output would replace an input"):
        fitted(path, "lambert", out="0.tif")
    with pytest.raises(ImageError, match="cannot be resumed"):
        fitted(path, "lambert", scheduler="tcp://nowhere:1", resume=True)


def test_a_stack_as_a_table(tmp_path: Path) -> None:
    plain = write_stack(tmp_path, reflected("lambert", coefficients("lambert", 2, 2)))
    table = tmp_path / "stack.csv"
    rows = "".join(f"{k}.tif,{i},{o}\n" for k, (i, o) in enumerate(ANGLES))
    table.write_text(f"# unit: brdf\n# white: 0.9,1,1.1\nfile,incident,reflection\n{rows}")
    one, other = read_stack(plain), read_stack(table)
    np.testing.assert_allclose(one.directions, other.directions)
    assert one.files == other.files
    assert other.white == (0.9, 1.0, 1.1)
    assert other.kind is Kind.XYZ
    table.write_text(
        "# unit: radiance-factor\n# angles: radians\n"
        "file,incident,reflection,incident_azimuth,reflection_azimuth\na.tif,0.5,0.6,0,2\n"
    )
    found = read_stack(table)
    np.testing.assert_allclose(found.directions, [[0.5, 0.6, 0, 2]])
    np.testing.assert_allclose(found.factors, 1 / np.pi)
    assert read_stack(table, unit="brdf").factors.tolist() == [1]


IMAGE = '[[image]]\nfile = "a.tif"\nincident = "40deg"\nreflection = "10deg"\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (IMAGE, "the unit of the values is not declared"),
        ('unit = "brdf"', r"sections \[\[image\]\] are needed"),
        ('unit = "brdf"\nimage = 3', r"sections \[\[image\]\] are needed"),
        ("unit = ", "not a TOML file"),
        ("a = " + "[" * 5000, "not a TOML file"),
        (f'unit = "brtf"\n{IMAGE}', "'brtf' is no unit of values"),
        (f"unit = 3\n{IMAGE}", "unit: a text in quotes is needed"),
        (f'untit = "brdf"\n{IMAGE}', "a stack has no 'untit'"),
        (f'unit = "brdf"\nscale = "0-1"\n{IMAGE}', "scale: '0-1..' is no range"),
        (f'unit = "brdf"\ncolours = "Lab"\n{IMAGE}', "'Lab' are no colours"),
        (f'unit = "brdf"\nwhite = [1, 2]\n{IMAGE}', "a white is X,Y,Z"),
        (f'unit = "brdf"\nwhite = [0, 0, 0]\n{IMAGE}', "white"),
        (f'unit = "brdf"\n{IMAGE}zenith = "3deg"', "image 1: an image has no 'zenith'"),
        (f'unit = "brdf"\n{IMAGE}'.replace("40deg", "40"), "image 1"),
        (f'unit = "brdf"\n{IMAGE}'.replace('"40deg"', "40"), 'incident = "40deg" is needed'),
        (f'unit = "brdf"\n{IMAGE}'.replace("40deg", "95deg"), "angles within 90 degrees"),
        (f'unit = "brdf"\n{IMAGE}' + IMAGE.replace("40deg", "95deg"), "1 of 2 images are seen or"),
        (f'unit = "brdf"\n{IMAGE}{IMAGE}incident_azimuth = "3deg"', "image 1: incident_azimuth"),
        (f'unit = "brdf"\n{IMAGE}incident_azimuth = "3deg"', "the viewer has none"),
        ('unit = "brdf"\n[[image]]\nincident = "4deg"', "file = "),
        ("file,incident\na.tif,3", "unit"),
        ("# unit: brdf\nfile,incident\na.tif,3", "no column has the zenith 'reflection'"),
        ("# unit: brdf\nfile,incident,reflection\na.tif,3", "2 values where 3 columns"),
        ("# unit: brdf\nfile,incident,reflection\na.tif,3,x", "'x' where a number belongs"),
        ("# unit: brdf\nfile,incident,reflection\na.tif,3,nan", "an angle is missing"),
        ("# unit: brdf\nfile,incident,reflection,X\na.tif,3,4,5", "'X' is no column of a stack"),
        ("# unit: brdf\nfile,incident,reflection\n", "0 images"),
    ],
)
def test_stacks_that_are_none(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "stack.toml"
    path.write_text(text)
    with pytest.raises(MeasurementError, match=message):
        read_stack(path)
