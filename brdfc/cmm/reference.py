"""The ICC's reference engine (the package iccdev, extra `verify`) as a judge.

It runs in a process of its own, because a bad profile or a failed link can crash it:

    python -m brdfc.cmm.reference REQUEST.json ANSWER.npz

Environment variables are not in its Python interface; they go in through the C functions its
library exports, as does the full validation, which its Python `validate_profile` leaves out.
"""

from __future__ import annotations

import ctypes
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from brdfc.source.errors import BrdfcError, LinkError, MissingExtraError

ENCODING = 65535 / 32768
"""XYZ leaves its C interface PCS-encoded; this gives it back as it is. Not 2."""

STATUS = {0: "OK", 1: "warning", 2: "non-compliant", 3: "critical"}
_UNKNOWN_SPACE, _XYZ_SPACE = 0x3F3F3F3F, 0x58595A20


def available() -> bool:
    """Whether the reference engine is installed."""
    return find_spec("iccdev") is not None


@dataclass(frozen=True)
class ReferenceRun:
    """xyz: (runs, pixels, 3) in float64, as the engine's float32 stand for. seconds: the least
    time one pass over the pixels took, for each run."""

    xyz: NDArray[np.float64]
    seconds: NDArray[np.float64]


def validate(path: str | Path) -> tuple[str, str]:
    """The engine's verdict on a profile ("OK", "warning", ...) and its report."""
    answer = _ask({"task": "validate", "path": str(path)}, {})
    return STATUS.get(int(answer["status"]), "unreadable"), str(answer["report"])


def apply(
    mid: str | Path,
    mvis: str | Path,
    pixels: ArrayLike,
    runs: Sequence[Mapping[str, float]] = ({},),
    repeat: int = 1,
) -> ReferenceRun:
    """Pixels (n, channels) through MID and MVIS, once for each set of variables (by signature).

    repeat: passes over the pixels, for timing. Raises LinkError when the engine does not connect
    the profiles, or crashes on them.
    """
    return chain([mid, mvis], pixels, runs, repeat)


def chain(
    profiles: Sequence[str | Path],
    pixels: ArrayLike,
    runs: Sequence[Mapping[str, float]] = ({},),
    repeat: int = 1,
    encoded: bool = True,
    tetrahedral: bool = False,
) -> ReferenceRun:
    """As apply, through any profiles that lead to XYZ. encoded: what comes out is PCS-encoded: the
    last profile's connection space, and not the device values of a profile of XYZ. tetrahedral:
    how it interpolates tables of three inputs outside processing elements; it takes those inside
    for linear always."""
    request = {
        "task": "apply",
        "profiles": [str(path) for path in profiles],
        "runs": [dict(run) for run in runs],
        "repeat": repeat,
        "interpolation": int(tetrahedral),
    }
    answer = _ask(request, {"pixels": np.ascontiguousarray(pixels, dtype=np.float32)})
    if "status" in answer:
        raise LinkError(f"the reference engine refuses the profiles with status {answer['status']}")
    scale = ENCODING if encoded else 1.0
    return ReferenceRun(answer["xyz"].astype(np.float64) * scale, answer["seconds"])


def _ask(request: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    if not available():
        raise MissingExtraError(
            "the reference engine is not installed", hint="pip install 'brdfc[verify]'"
        )
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "request.json").write_text(json.dumps(request))
        np.savez(place / "arrays.npz", **arrays)  # type: ignore[arg-type]
        done = subprocess.run(
            [sys.executable, "-m", "brdfc.cmm.reference", folder],
            capture_output=True,
            text=True,
            check=False,
        )
        answer = place / "answer.npz"
        if done.returncode != 0 or not answer.exists():
            raise BrdfcError(f"the reference engine failed: {done.stderr.strip()[-500:]}")
        with np.load(answer) as data:
            return {key: data[key] for key in data.files}


# ---------------------------------------------------------------- in the other process


class _Variables(ctypes.Structure):
    _fields_ = (
        ("count", ctypes.c_uint32),
        ("signatures", ctypes.POINTER(ctypes.c_uint32)),
        ("values", ctypes.POINTER(ctypes.c_float)),
    )


class _String(ctypes.Structure):
    """A std::string of GNU's C++ library: pointer, size, and room for 16 bytes."""

    _fields_ = (
        ("data", ctypes.c_void_p),
        ("size", ctypes.c_size_t),
        ("room", ctypes.c_char * 16),
    )


_VALIDATE = (
    "_Z18ValidateIccProfilePKhjRNSt7__cxx1112basic_string"
    "IcSt11char_traitsIcESaIcEEER16icValidateStatus"
)


def _library() -> ctypes.CDLL:
    import iccdev

    return ctypes.CDLL(iccdev._iccdev.__file__)


def _validate(path: str) -> dict[str, Any]:
    import iccdev

    data = Path(path).read_bytes()
    result = iccdev.validate_profile(data)
    report, status = str(result.report), ctypes.c_int(int(result.status))
    library = _library()
    if hasattr(library, _VALIDATE):
        text = _String()
        text.data = ctypes.addressof(text) + _String.room.offset
        function = getattr(library, _VALIDATE)
        function.restype = ctypes.c_void_p
        function(data, len(data), ctypes.byref(text), ctypes.byref(status))
        report += ctypes.string_at(text.data, text.size).decode(errors="replace")
    return {"status": max(int(result.status), status.value), "report": report}


def _apply(request: dict[str, Any], pixels: NDArray[np.float32]) -> dict[str, Any]:
    from time import perf_counter

    library = _library()
    library.IccCmmCreate.restype = ctypes.c_void_p
    xyz, seconds = [], []
    for run in request["runs"]:
        handle = ctypes.c_void_p(library.IccCmmCreate(_UNKNOWN_SPACE, _XYZ_SPACE, 1))
        count = len(run)
        signatures = (ctypes.c_uint32 * max(count, 1))(
            *(int.from_bytes(name.ljust(4).encode("latin-1"), "big") for name in run)
        )
        values = (ctypes.c_float * max(count, 1))(*run.values())
        variables = _Variables(count, signatures, values)
        for path in request["profiles"]:
            status = library.IccCmmAttachProfileFile(
                handle,
                path.encode(),
                0,
                request["interpolation"],
                None,
                0,
                0,
                0,
                ctypes.byref(variables),
            )
            if status:
                return {"status": status}
        status = library.IccCmmBegin(handle)
        if status:  # applying now would crash
            return {"status": status}
        result = np.empty((len(pixels), 3), dtype=np.float32)
        least = float("inf")
        for _ in range(request["repeat"]):
            start = perf_counter()
            status = library.IccCmmApplyFloatMulti(
                handle,
                result.ctypes.data_as(ctypes.c_void_p),
                pixels.ctypes.data_as(ctypes.c_void_p),
                ctypes.c_uint32(len(pixels)),
            )
            least = min(least, perf_counter() - start)
            if status:
                return {"status": status}
        library.IccCmmFree(handle)
        xyz.append(result)
        seconds.append(least)
    return {"xyz": np.array(xyz), "seconds": np.array(seconds)}


def _serve(folder: Path) -> None:
    request = json.loads((folder / "request.json").read_text())
    if request["task"] == "validate":
        answer = _validate(request["path"])
    else:
        with np.load(folder / "arrays.npz") as arrays:
            answer = _apply(request, arrays["pixels"])
    np.savez(folder / "answer.npz", **answer)


if __name__ == "__main__":
    _serve(Path(sys.argv[1]))
