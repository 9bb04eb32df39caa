"""Seven samples like the paper's: generated, not measured.

The coefficients that Habib, Green and Sole fitted to their prints are not public. These are made so
that the workflow can be run, by this procedure:

1. CIELAB under D50 of a matt print of the sample's name, chosen by hand (below). For the three
   Pantone colours, whose values we do not have: a yellow, a red and a brown like metallic inks.
2. Rd: its X, Y, Z, taken from D50 to the lamp's white (0.97, 1, 0.484) by linear Bradford.
3. ks and m: chosen by hand. Wax-based ink is glossier than the matt paper it is printed on.
4. An image of 24 x 24 pixels for each sample, every coefficient of every pixel varied by a factor
   from a normal distribution of 1 % (seed 2020), as a print is never quite even.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from brdfc.colour.adaptation import adaptation_matrix
from brdfc.colour.difference import D50
from brdfc.colour.library import colour_science

LAMP = (0.97, 1.0, 0.484)
"""The white of the paper's tungsten lamp."""

NOMINAL = {  # L*, a*, b* under D50; ks; m
    "white": ((93.0, 0.5, -3.0), 0.030, 0.32),
    "red": ((47.0, 66.0, 45.0), 0.050, 0.20),
    "cyan": ((60.0, -22.0, -32.0), 0.055, 0.19),
    "Pantone 10309C": ((62.0, 4.0, 38.0), 0.060, 0.18),
    "magenta": ((47.0, 70.0, -5.0), 0.055, 0.20),
    "Pantone 10213C": ((45.0, 38.0, 14.0), 0.060, 0.18),
    "Pantone 10253C": ((40.0, 12.0, 18.0), 0.060, 0.18),
}
SIZE = 24


def coefficients() -> dict[str, tuple[float, ...]]:
    """Rdx, Rdy, Rdz under the lamp, ks and m of each sample."""
    colour = colour_science()
    to_lamp = adaptation_matrix(D50, LAMP)
    found = {}
    for name, (lab, ks, m) in NOMINAL.items():
        xyz = colour.Lab_to_XYZ(np.array(lab), colour.XYZ_to_xy(np.array(D50)))
        found[name] = (*(to_lamp @ xyz).tolist(), ks, m)
    return found


def image() -> NDArray[np.float32]:
    """The coefficient image: (SIZE, 7 SIZE, 5), the samples side by side."""
    random = np.random.default_rng(2020)
    patches = []
    for values in coefficients().values():
        factors = 1 + 0.01 * random.standard_normal((SIZE, SIZE, 5))
        patches.append(np.array(values) * factors)
    return np.concatenate(patches, axis=1).astype(np.float32)


def patch(index: int) -> slice:
    """The columns of a sample in the image."""
    return slice(index * SIZE, (index + 1) * SIZE)
