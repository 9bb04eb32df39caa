"""The usual way to run elements: a whole chain at once, without jumps where that can be.

Pixels are taken as they lie, interleaved or in planes, by machine code where llvmlite is installed
and the pixels are worth compiling for, else by NumPy in blocks that fit the cache; on as many
threads as there are processors. Several runs of the same pixels, as in a sweep of angles, take one
pass over them. NumPy's results are the interpreter's to the last bit; those of machine code too,
but for the rarest ties of functions (functions.py).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike

from brdfc.calc.program import Program
from brdfc.calc.verify import verify
from brdfc.engine import interpreter, native
from brdfc.engine.choice import Engine, compiled_is_quicker, threads_at_hand
from brdfc.engine.jobs import Compiled, Job, by_code, in_blocks
from brdfc.engine.kernels import Values
from brdfc.engine.layout import Samples, flat, samples, shares
from brdfc.engine.straight import Straight, straighten
from brdfc.engine.trace import Chain, Crooked, Route
from brdfc.source.errors import BrdfcError, ProgramError

Environment = Mapping[str, ArrayLike]

RECENT = 256
"""Straight forms kept: an image comes in bands, and each is a run of the same chain."""
SHARE = 1 << 16
"""Pixels that a thread of its own is worth."""


def run(
    chain: Chain,
    channels: int,
    pixels: ArrayLike,
    environment: Environment,
    *,
    engine: Engine = Engine.AUTO,
    threads: int | None = None,
    total: int | None = None,
) -> Values:
    """Apply a chain of elements to pixels.

    pixels: (..., channels), taken as float32. environment: variables by signature, as for
    interpreter.run. total: how many pixels are to come in all, where these are a part. Returns
    (..., outputs), float32. Raises ProgramError where a program cannot be proven safe or channels
    do not fit, BrdfcError where the compiled engine is asked for and llvmlite is not installed.
    """
    array = np.asarray(pixels, dtype=np.float32)
    result = np.empty((*array.shape[:-1], outputs_of(chain, channels)), np.float32)
    one = ([environment], [result])
    sweep(chain, channels, array, *one, engine=engine, threads=threads, total=total)
    return result


def outputs_of(chain: Chain, channels: int) -> int:
    """How many values a chain gives; without elements it gives what it takes."""
    if not chain:
        return channels
    last = chain[-1]
    return len(last.sources) if isinstance(last, Route) else last.outputs


def sweep(
    chain: Chain,
    channels: int,
    pixels: Values,
    environments: Sequence[Environment],
    results: Sequence[Values],
    *,
    engine: Engine = Engine.AUTO,
    threads: int | None = None,
    total: int | None = None,
) -> None:
    """The same for several runs over the same pixels, into results (..., outputs) each."""
    if pixels.ndim == 0 or pixels.shape[-1] != channels:
        raise ProgramError(f"{channels} channels are needed, the array is {pixels.shape}")
    if engine is Engine.COMPILED and not native.available():
        raise BrdfcError(
            "the compiled engine needs llvmlite, which is not installed",
            hint="pip install 'brdfc[jit]', or leave the engine to be chosen",
        )
    shape = pixels.shape[:-1]
    given = [{n: interpreter.variable(v, shape) for n, v in e.items()} for e in environments]
    if not pixels.size:
        return
    forms = [_straight(chain, channels, e, engine) for e in given]
    if any(form is None for form in forms):
        for environment, result in zip(environments, results, strict=True):
            result[...] = _interpreted(chain, pixels, environment)
        return
    whole = flat(pixels)
    found = [flat(result) for result in results]
    jobs = [
        Job(form, [e[n] for n in form.variables], samples(values, native.WIDEST))
        for form, e, values in zip(forms, given, found, strict=True)
        if form is not None
    ]
    work = _work(jobs, samples(whole, native.WIDEST), engine, total or len(whole))
    parts = list(shares(len(whole), threads or threads_at_hand(), SHARE, 64))
    if len(parts) == 1:
        work(*parts[0])
    else:
        list(_pool().map(work, *zip(*parts, strict=True)))
    for values, result in zip(found, results, strict=True):
        if not np.shares_memory(values, result):  # its strides have no view as a list of pixels
            result[...] = values.reshape(result.shape)


def _straight(
    chain: Chain, channels: int, variables: Mapping[str, Values], engine: Engine
) -> Straight | None:
    """The straight form of a chain in a run, None where it has none; made once for runs alike."""
    if engine is Engine.INTERPRETER:
        return None
    same = tuple(sorted((n, None if v.ndim else v.tobytes()) for n, v in variables.items()))
    key = (tuple(map(id, chain)), same)
    known = _recent.get(key)
    if known is not None:
        return known[1]
    for element in chain:
        if isinstance(element, Program):
            verify(element)
    try:
        found: Straight | None = straighten(chain, channels, variables)
    except Crooked:
        found = None
    with _one_at_a_time:
        while len(_recent) >= RECENT:
            del _recent[next(iter(_recent))]
        _recent[key] = chain, found
    return found


_Key = tuple[tuple[int, ...], tuple[tuple[str, bytes | None], ...]]
_recent: dict[_Key, tuple[Chain, Straight | None]] = {}
"""By the elements themselves, which are kept with the form so that no other takes their place."""
_one_at_a_time = Lock()


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads_at_hand(), thread_name_prefix="brdfc")


def _interpreted(chain: Chain, pixels: Values, environment: Environment) -> Values:
    """Element by element over the whole array."""
    values = pixels
    for step in chain:
        if isinstance(step, Route):
            kept = [values[..., source or 0] for source in step.sources]
            for channel, default in enumerate(step.defaults):
                if step.sources[channel] is None:
                    kept[channel] = np.full_like(kept[channel], default)
            values = np.stack(kept, axis=-1)
        else:
            values = interpreter.run(step, values, environment)
    return values


Work = Callable[[int, int], None]
"""What a thread does: pixels from the first number to before the second."""


def _work(jobs: Sequence[Job], pixels: Samples, engine: Engine, total: int) -> Work:
    """By machine code if it is asked for, or quicker; else by NumPy."""
    if engine is not Engine.BLOCKS and native.available():
        found = [native.shape_of(job.form, pixels.step, job.results.step) for job in jobs]
        quicker = engine is Engine.COMPILED or any(
            compiled_is_quicker(job.form, total, native.is_kept(shape))
            for job, (shape, _) in zip(jobs, found, strict=True)
        )
        if quicker:
            codes = [Compiled(native.code_for(shape), constants) for shape, constants in found]
            return partial(by_code, jobs, codes, pixels)
    return partial(in_blocks, jobs, pixels)
