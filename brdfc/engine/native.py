"""Straight chains as machine code: LLVM's text, compiled by llvmlite (the extra `brdfc[jit]`).

One loop over pixels, several at a time, one pass over memory. Constants come in a table, so that
the code of a run serves every other run of the same shape, such as the next angles of a sweep.
Results are the interpreter's, but for the rarest ties of the functions in functions.py.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from brdfc.engine.lanes import Lanes
from brdfc.engine.operations import OPERATORS
from brdfc.engine.straight import Straight

KEPT = 64
"""Codes kept, of the shapes used last."""
WIDEST = 16
"""Samples of an interleaved pixel, at most, that are taken apart in registers."""


@cache
def available() -> bool:
    """Whether llvmlite is installed."""
    return find_spec("llvmlite") is not None


@dataclass(frozen=True)
class Shape:
    """What code is made for: a straight chain but for its constants, and how pixels lie in memory.

    inputs, outputs: samples from one pixel to the next where they are interleaved; 1 where each has
    a plane of its own. Variables that differ between pixels always have planes.
    """

    steps: tuple[tuple[str, tuple[int | None, ...], int], ...]
    results: tuple[int | None, ...]
    read: tuple[int, ...]
    channels: int
    inputs: int
    outputs: int


def shape_of(straight: Straight, inputs: int, outputs: int) -> tuple[Shape, NDArray[np.float32]]:
    """The shape of a chain, None standing for its constants, and those in order."""
    constants: list[np.float32] = []

    def place(value: int | np.float32) -> int | None:
        if isinstance(value, int):
            return value
        constants.append(value)
        return None

    steps = tuple((s.name, tuple(map(place, s.arguments)), s.targets[0]) for s in straight.steps)
    results = tuple(map(place, straight.outputs))
    shape = Shape(steps, results, straight.read, straight.channels, inputs, outputs)
    return shape, np.array(constants, np.float32)


class Code:
    """Machine code for a shape. width: the pixels of a run are a multiple of this."""

    def __init__(self, shape: Shape) -> None:
        import llvmlite.binding as llvm

        self.width, processor, features = _processor()
        module = llvm.parse_assembly(_text(shape, self.width))
        target = llvm.Target.from_default_triple()
        # It belongs to the engine, and goes with it.
        machine = target.create_target_machine(processor, features, opt=2, jit=True)
        self._engine = llvm.create_mcjit_compiler(module, machine)
        self._engine.finalize_object()
        pointer, number = ctypes.c_void_p, ctypes.c_int64
        kind = ctypes.CFUNCTYPE(None, pointer, pointer, pointer, number)
        self._run = kind(self._engine.get_function_address("run"))

    def __call__(
        self,
        inputs: Sequence[int],
        outputs: Sequence[int],
        constants: NDArray[np.float32],
        pixels: int,
    ) -> None:
        """Addresses of the first sample of each input and output, or of the first of all where they
        are interleaved; the interpreter's lock is released meanwhile."""
        places = [(ctypes.c_void_p * max(1, len(p)))(*p) for p in (inputs, outputs)]
        self._run(*(ctypes.addressof(p) for p in places), constants.ctypes.data, pixels)


_kept: dict[Shape, Code] = {}
_lock = Lock()


def code_for(shape: Shape) -> Code:
    """The code for a shape, made once."""
    with _lock:
        code = _kept.pop(shape, None) or Code(shape)
        _kept[shape] = code
        if len(_kept) > KEPT:
            del _kept[next(iter(_kept))]
    return code


def kept(shape: Shape) -> bool:
    """Whether the code for a shape is there."""
    with _lock:
        return shape in _kept


def _after_fork() -> None:
    """Another thread may have held the lock."""
    global _lock
    _lock = Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


@cache
def _processor() -> tuple[int, str, str]:
    """Pixels at a time that suit this processor, its name and what it can do."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    features = llvm.get_host_cpu_features()
    width = 16 if features.get("avx512f") else 8
    return width, llvm.get_host_cpu_name(), features.flatten()


def _text(shape: Shape, width: int) -> str:
    """The function `run`: (inputs, outputs, constants, pixels)."""
    lanes = Lanes(width, block="pixels")
    registers: dict[int, str] = _loads(shape, lanes)
    used = 0

    def value(place: int | None) -> str:
        nonlocal used
        if place is not None:
            return registers[place]
        used += 1
        at = lanes.new(f"getelementptr float, ptr %constants, i64 {used - 1}")
        one = lanes.new(f"load float, ptr {at}")
        whole = lanes.kind("F")
        first = lanes.new(f"insertelement {whole} poison, float {one}, i64 0")
        return lanes.new(
            f"shufflevector {whole} {first}, {whole} poison, <{width} x i32> zeroinitializer"
        )

    for name, arguments, target in shape.steps:
        registers[target] = OPERATORS[name](lanes, *map(value, arguments))
    _stores(shape, lanes, list(map(value, shape.results)))
    wide = '"prefer-vector-width"="512" "min-legal-vector-width"="512"'
    return "\n".join(
        [
            *lanes.declared.values(),
            "define void @run(ptr %inputs, ptr %outputs, ptr %constants, i64 %count) #0 {",
            "entry:",
            *(f"  %{name} = alloca {lanes.kind(k)}" for name, k in _SCRATCH),
            *_pointers(shape),
            "  %none = icmp eq i64 %count, 0",
            "  br i1 %none, label %end, label %pixels",
            "pixels:",
            f"  %i = phi i64 [ 0, %entry ], [ %next, %{lanes.block} ]",
            *lanes.lines,
            f"  %next = add i64 %i, {width}",
            "  %more = icmp ult i64 %next, %count",
            "  br i1 %more, label %pixels, label %end",
            "end:",
            "  ret void",
            "}",
            f"attributes #0 = {{ nounwind {wide} }}",
        ]
    )


_SCRATCH = (("angles", "D"), ("rests", "D"), ("turns", "I"))
"""Where functions.py hands over what it computes one by one."""


def _pointers(shape: Shape) -> list[str]:
    lines = []
    for name, count in (("inputs", _planes(shape)), ("outputs", len(shape.results))):
        one = name[:-1]
        for k in range(count):
            lines.append(f"  %{one}s.{k} = getelementptr ptr, ptr %{name}, i64 {k}")
            lines.append(f"  %{one}.{k} = load ptr, ptr %{one}s.{k}")
            if name == "outputs" and shape.outputs > 1:
                break
    return lines


def _planes(shape: Shape) -> int:
    """Pointers to inputs that the code is given."""
    return max([0, *(_plane(shape, k) for k in shape.read)]) + 1


def _plane(shape: Shape, place: int) -> int:
    """The pointer that an input is found at: interleaved channels have one together."""
    if shape.inputs == 1:
        return place
    return 0 if place < shape.channels else place - shape.channels + 1


def _loads(shape: Shape, lanes: Lanes) -> dict[int, str]:
    """The inputs that are read, by register."""
    found = {}
    whole: str | None = None
    many = lanes.width * shape.inputs
    for place in shape.read:
        pointer = f"%input.{_plane(shape, place)}"
        if shape.inputs == 1 or place >= shape.channels:
            at = lanes.new(f"getelementptr float, ptr {pointer}, i64 %i")
            found[place] = lanes.new(f"load {lanes.kind('F')}, ptr {at}, align 4")
            continue
        if whole is None:
            first = lanes.new(f"mul i64 %i, {shape.inputs}")
            at = lanes.new(f"getelementptr float, ptr {pointer}, i64 {first}")
            whole = lanes.new(f"load <{many} x float>, ptr {at}, align 4")
        found[place] = _shuffled(
            lanes, many, (whole, "poison"), [place + shape.inputs * k for k in range(lanes.width)]
        )
    return found


def _stores(shape: Shape, lanes: Lanes, values: list[str]) -> None:
    if shape.outputs == 1:
        for k, value in enumerate(values):
            at = lanes.new(f"getelementptr float, ptr %output.{k}, i64 %i")
            lanes.lines.append(f"  store {lanes.kind('F')} {value}, ptr {at}, align 4")
        return
    width, count = lanes.width, len(values)
    # Side by side, twice as many each time, then in the order that they have in memory.
    size = width
    row = list(values)
    while len(row) > 1:
        row += ["poison"] * (len(row) % 2)
        pairs = zip(row[::2], row[1::2], strict=True)
        row = [_shuffled(lanes, size, pair, list(range(2 * size))) for pair in pairs]
        size *= 2
    order = [channel * width + pixel for pixel in range(width) for channel in range(count)]
    whole = _shuffled(lanes, size, (row[0], "poison"), order)
    first = lanes.new(f"mul i64 %i, {count}")
    at = lanes.new(f"getelementptr float, ptr %output.0, i64 {first}")
    lanes.lines.append(f"  store <{width * count} x float> {whole}, ptr {at}, align 4")


def _shuffled(lanes: Lanes, size: int, pair: tuple[str, str], order: Sequence[int]) -> str:
    kind = f"<{size} x float>"
    places = ", ".join(f"i32 {k}" for k in order)
    return lanes.new(
        f"shufflevector {kind} {pair[0]}, {kind} {pair[1]}, <{len(order)} x i32> <{places}>"
    )
