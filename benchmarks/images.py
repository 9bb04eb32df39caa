"""How fast images go through profiles, against copying their samples with tifffile alone.

    python benchmarks/images.py [--pixels 1e8] [--kind float32] [--layout chunky] [--folder DIR]
                                [-- OPTION ...]

An image of Ward's five coefficients is written, and three things are timed, best of rounds, each
after the file was read once:

    copy       tifffile reads strip after strip and writes all five samples of it
    copy 3     the same, and it writes three of the five: as many bytes as `brdfc apply` writes
    apply      `brdfc apply` with two angles given, a process of its own, from start to end

The peak of apply's resident memory is what Linux says of the process. At last, an image of a
megapixel in a process of its own, start and end included. What follows -- goes to `brdfc apply`.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import tifffile

import brdfc

ANGLES = ("--env", "incident=40deg", "--env", "reflection=10deg")
MB = 10**6


def bands(height: int, width: int, kind: np.dtype) -> Iterator[np.ndarray]:
    """Rows of coefficients, one after the other; a few thousand pixels, over and over."""
    random = np.random.default_rng(1)
    row = random.uniform(0.05, 0.6, (width, 5))
    row = np.round(row * 65535) if kind == np.uint16 else row
    row = row.astype(kind)
    for top in range(height):
        yield np.roll(row, 7 * top, axis=0)


def write(path: Path, height: int, width: int, kind: np.dtype, layout: str) -> None:
    if layout == "planar":
        data = np.stack(list(bands(height, width, kind)))
        tifffile.imwrite(
            path, np.moveaxis(data, -1, 0), photometric="minisblack", planarconfig="separate"
        )
        return
    options: dict[str, object] = {"rowsperstrip": max(1, (1 << 18) // (width * 5 * kind.itemsize))}
    data: object = bands(height, width, kind)
    if layout.startswith("tiled"):
        options = {"tile": (256, 256)}
        whole = np.stack(list(bands(height, width, kind)))
        data = whole
        if layout == "tiled-deflate":
            options["compression"] = "zlib"
    tifffile.imwrite(
        path,
        data,
        shape=(height, width, 5),
        dtype=kind,
        photometric="minisblack",
        planarconfig="contig",
        bigtiff=height * width * 5 * kind.itemsize > 2**32 - 2**25,
        metadata=None,
        **options,
    )


def copy(source: Path, target: Path, samples: int) -> None:
    """Read strips and write so many of their samples, with what tifffile gives for it."""
    with tifffile.TiffFile(source) as tiff:
        page = tiff.pages[0]
        height, width, _ = page.shape

        def strips() -> Iterator[np.ndarray]:
            for strip, _, _ in page.segments(maxworkers=1):
                yield np.ascontiguousarray(strip[0][..., :samples])

        tifffile.imwrite(
            target,
            strips(),
            shape=(height, width, samples),
            dtype=page.dtype,
            photometric="minisblack",
            planarconfig="contig",
            rowsperstrip=page.rowsperstrip,
            bigtiff=page.nbytes > 2**32 - 2**25,
            metadata=None,
        )


CHILD = """
import atexit, re, sys
from brdfc.cli.main import main
def peak():
    status = open("/proc/self/status").read()
    open({peak!r}, "w").write(re.search(r"VmHWM:\\s*(\\d+) kB", status)[1])
atexit.register(peak)
main()
"""


def process(folder: Path, *arguments: str) -> tuple[float, float, float]:
    """Seconds of a process, from start to end, of its processors, and its peak memory in MB.

    The peak that wait4 gives is no use: a process begins with that of the one that starts it.
    """
    peak = folder / "peak"
    code = CHILD.format(peak=str(peak))
    start = time.perf_counter()
    child = os.posix_spawn(
        sys.executable,
        [sys.executable, "-c", code, *arguments],
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
    )
    _, status, usage = os.wait4(child, 0)
    took = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status):
        sys.exit(f"brdfc {' '.join(arguments)} failed")
    return took, usage.ru_utime + usage.ru_stime, int(peak.read_text()) * 1024 / MB


def best(rounds: int, work: Callable[[], object]) -> float:
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--pixels", type=float, default=1e8)
    parser.add_argument("--kind", choices=["float32", "float16", "uint16"], default="float32")
    parser.add_argument(
        "--layout", choices=["chunky", "planar", "tiled", "tiled-deflate"], default="chunky"
    )
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("more", nargs="*")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        folder = Path(name)
        side = round(given.pixels**0.5)
        kind = np.dtype(given.kind)
        source, target = folder / "coefficients.tif", folder / "result.tif"
        write(source, side, side, kind, given.layout)
        compiled = brdfc.compile(brdfc.load("ward"))
        profiles = [str(path) for path in compiled.save(folder / "ward_mvis.icc")]
        more = [*given.more, *(["--scale", "0..1"] if kind.kind == "u" else [])]

        def apply(image: Path) -> tuple[float, float, float]:
            return process(
                folder, "apply", *profiles, str(image), "-o", str(target), *ANGLES, *more
            )

        size = source.stat().st_size
        print(f"{side:,} x {side:,} pixels, {kind} {given.layout}, {size / MB:,.0f} MB")
        pixels = side * side
        copies = {}
        if given.layout == "chunky":
            for label, samples in (("copy", 5), ("copy 3", 3)):
                copies[label] = best(given.rounds, lambda n=samples: copy(source, target, n))
                target.unlink()
                rate = pixels / copies[label] / MB
                print(f"{label:<8} {copies[label]:6.2f} s  {rate:6.1f} Mpixel/s")
        took, busy, peak = min(apply(source) for _ in range(given.rounds))
        print(
            f"{'apply':<8} {took:6.2f} s  {pixels / took / MB:6.1f} Mpixel/s, processors busy for "
            f"{busy:.2f} s, {peak:.0f} MB at most"
        )
        for label, seconds in copies.items():
            print(f"apply has {100 * seconds / took:.0f} % of the speed of {label}")
        source.unlink()
        target.unlink()
        write(folder / "small.tif", 1000, 1000, kind, given.layout)
        took, _, peak = min(apply(folder / "small.tif") for _ in range(given.rounds))
        print(f"one megapixel, start and end included: {took:.2f} s, {peak:.0f} MB at most")


if __name__ == "__main__":
    main()
