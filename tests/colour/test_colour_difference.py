"""CIEDE2000 against the published pairs and colour-science; sRGB against colour-science."""

from __future__ import annotations

import numpy as np
import pytest

from brdfc.colour.difference import D50, ciede2000, ciede2000_of_lab, lab
from brdfc.colour.picture import srgb

# G. Sharma, W. Wu, E. N. Dalal, Color Research and Application 30(1), 2005, table 1: L, a, b of
# two colours and their difference.
SHARMA = """
50.0000 2.6772 -79.7751 50.0000 0.0000 -82.7485 2.0425
50.0000 3.1571 -77.2803 50.0000 0.0000 -82.7485 2.8615
50.0000 2.8361 -74.0200 50.0000 0.0000 -82.7485 3.4412
50.0000 -1.3802 -84.2814 50.0000 0.0000 -82.7485 1.0000
50.0000 -1.1848 -84.8006 50.0000 0.0000 -82.7485 1.0000
50.0000 -0.9009 -85.5211 50.0000 0.0000 -82.7485 1.0000
50.0000 0.0000 0.0000 50.0000 -1.0000 2.0000 2.3669
50.0000 -1.0000 2.0000 50.0000 0.0000 0.0000 2.3669
50.0000 2.4900 -0.0010 50.0000 -2.4900 0.0009 7.1792
50.0000 2.4900 -0.0010 50.0000 -2.4900 0.0010 7.1792
50.0000 2.4900 -0.0010 50.0000 -2.4900 0.0011 7.2195
50.0000 2.4900 -0.0010 50.0000 -2.4900 0.0012 7.2195
50.0000 -0.0010 2.4900 50.0000 0.0009 -2.4900 4.8045
50.0000 -0.0010 2.4900 50.0000 0.0010 -2.4900 4.8045
50.0000 -0.0010 2.4900 50.0000 0.0011 -2.4900 4.7461
50.0000 2.5000 0.0000 50.0000 0.0000 -2.5000 4.3065
50.0000 2.5000 0.0000 73.0000 25.0000 -18.0000 27.1492
50.0000 2.5000 0.0000 61.0000 -5.0000 29.0000 22.8977
50.0000 2.5000 0.0000 56.0000 -27.0000 -3.0000 31.9030
50.0000 2.5000 0.0000 58.0000 24.0000 15.0000 19.4535
50.0000 2.5000 0.0000 50.0000 3.1736 0.5854 1.0000
50.0000 2.5000 0.0000 50.0000 3.2972 0.0000 1.0000
50.0000 2.5000 0.0000 50.0000 1.8634 0.5757 1.0000
50.0000 2.5000 0.0000 50.0000 3.2592 0.3350 1.0000
60.2574 -34.0099 36.2677 60.4626 -34.1751 39.4387 1.2644
63.0109 -31.0961 -5.8663 62.8187 -29.7946 -4.0864 1.2630
61.2901 3.7196 -5.3901 61.4292 2.2480 -4.9620 1.8731
35.0831 -44.1164 3.7933 35.0232 -40.0716 1.5901 1.8645
22.7233 20.0904 -46.6940 23.0331 14.9730 -42.5619 2.0373
36.4612 47.8580 18.3852 36.2715 50.5065 21.2231 1.4146
90.8027 -2.0831 1.4410 91.1528 -1.6435 0.0447 1.4441
90.9257 -0.5406 -0.9208 88.6381 -0.8985 -0.7239 1.5381
6.7747 -0.2908 -2.4247 5.8714 -0.0985 -2.2286 0.6377
2.0776 0.0795 -1.1350 0.9033 -0.0636 -0.5514 0.9082
"""
PAIRS = np.array([line.split() for line in SHARMA.split("\n") if line], dtype=float)


def test_there_are_all_the_published_pairs() -> None:
    assert PAIRS.shape == (34, 7)


@pytest.mark.parametrize("pair", PAIRS, ids=range(1, 35))
def test_published_pairs(pair: np.ndarray) -> None:
    first, second = pair[:3], pair[3:6]
    assert ciede2000_of_lab(first, second) == pytest.approx(pair[6], abs=5.1e-5)
    assert ciede2000_of_lab(second, first) == pytest.approx(pair[6], abs=5.1e-5)


def test_as_colour_science() -> None:
    colour = pytest.importorskip("colour")
    random = np.random.default_rng(1)
    first = random.uniform(0, 1, (500, 3)) ** 2
    second = np.clip(first + random.normal(0, 0.1, (500, 3)), 0, None)
    white = colour.XYZ_to_xy(np.array(D50))
    wanted = colour.delta_E(
        colour.XYZ_to_Lab(first, white), colour.XYZ_to_Lab(second, white), method="CIE 2000"
    )
    assert ciede2000(first, second) == pytest.approx(wanted, rel=1e-6, abs=1e-9)


def test_lab_of_known_colours() -> None:
    assert lab(D50) == pytest.approx([100, 0, 0])
    assert lab([0, 0, 0]) == pytest.approx([0, 0, 0])
    # Y = 216/24389 is the knee: L* = 8.
    assert lab(np.array(D50) * 216 / 24389) == pytest.approx([8, 0, 0], abs=1e-9)


def test_equal_colours_do_not_differ() -> None:
    colours = np.array([[0, 0, 0], [0.2, 0.3, 0.1], D50, [1e4, 1e4, 1e4], [0, 1, 0]])
    assert (ciede2000(colours, colours) == 0).all()


def test_shapes_broadcast() -> None:
    assert ciede2000(np.zeros((4, 5, 3)), np.array(D50)).shape == (4, 5)
    assert ciede2000(np.array(D50), np.zeros(3)) == pytest.approx(100)


# ------------------------------------------------------------ pictures


def test_white_black_and_grey() -> None:
    picture, outside = srgb([D50, (0, 0, 0), np.array(D50) * 0.2158605])
    assert picture.tolist() == [[255, 255, 255], [0, 0, 0], [128, 128, 128]]
    assert not outside.any()


def test_the_primaries() -> None:
    """sRGB's primaries under D50 (the columns of the matrix of IEC 61966-2-1, Bradford adapted)."""
    red, green, blue = (0.4361, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141)
    picture, _ = srgb([red, green, blue])
    assert np.abs(picture.astype(int) - np.eye(3) * 255).max() <= 2


def test_what_cannot_be_shown_is_clipped_and_counted() -> None:
    picture, outside = srgb([(2, 2, 2), (0.1, 0.5, 0.0), np.array(D50) / 2])
    assert outside.tolist() == [True, True, False]
    assert picture.dtype == np.uint8
    assert picture[0].max() == 255


def test_srgb_as_colour_science() -> None:
    colour = pytest.importorskip("colour")
    random = np.random.default_rng(2)
    values = random.uniform(0, 1, (20, 30, 3)) * np.array(D50)
    adapted = colour.adaptation.chromatic_adaptation_VonKries(
        values, np.array(D50), colour.xy_to_XYZ([0.3127, 0.3290]), transform="Bradford"
    )
    linear = colour.XYZ_to_RGB(adapted, "sRGB", apply_cctf_encoding=False)
    wanted = np.round(np.clip(colour.cctf_encoding(linear, "sRGB"), 0, 1) * 255)
    picture, _ = srgb(values)
    assert picture.shape == values.shape
    assert np.abs(picture - wanted).max() <= 1
