"""The usual way to run elements: a whole chain at once, without jumps where that can be.

Pixels are taken as they lie, interleaved or in planes, by machine code where llvmlite is installed
and the pixels are worth compiling for, else by NumPy in blocks that fit the cache; on as many
threads as there are processors. Several runs of the same pixels, as in a sweep of angles, take one
pass over them. NumPy's results are the interpreter's to the last bit; those of machine code too,
but for the rarest ties of functions (functions.py).
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial

import numpy as np
from numpy.typing import ArrayLike

from brdfc.engine import choice, interpreter, native
from brdfc.engine.choice import Engine, engine_named, threads_at_hand
from brdfc.engine.forms import straight_form
from brdfc.engine.jobs import Compiled, Job, by_code, in_blocks
from brdfc.engine.kernels import Values
from brdfc.engine.layout import Samples, flat, samples, shares
from brdfc.engine.tables import Interpolation
from brdfc.engine.trace import Chain, Route
from brdfc.source.errors import MissingExtraError, ProgramError

Environment = Mapping[str, ArrayLike]

SHARE = 1 << 16
"""Pixels that a thread of its own is worth."""


def run(
    chain: Chain,
    channels: int,
    pixels: ArrayLike,
    environment: Environment,
    *,
    engine: Engine | str = Engine.AUTO,
    threads: int | None = None,
    total: int | None = None,
    interpolation: Interpolation = Interpolation.LINEAR,
) -> Values:
    """Apply a chain of elements to pixels.

    pixels: (..., channels), taken as float32. environment: variables by signature, as for
    interpreter.run. total: how many pixels are to come in all, where these are a part.
    interpolation: of tables of three inputs. Returns (..., outputs), float32.
    Raises ProgramError where a program cannot be proven safe or channels do not fit,
    MissingExtraError where the compiled engine is asked for without llvmlite.
    """
    array = np.asarray(pixels, dtype=np.float32)
    result = np.empty((*array.shape[:-1], outputs_of(chain, channels)), np.float32)
    sweep(
        chain,
        channels,
        array,
        [environment],
        [result],
        engine=engine,
        threads=threads,
        total=total,
        interpolation=interpolation,
    )
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
    pixels: ArrayLike,
    environments: Sequence[Environment],
    results: Sequence[Values],
    *,
    engine: Engine | str = Engine.AUTO,
    threads: int | None = None,
    total: int | None = None,
    interpolation: Interpolation = Interpolation.LINEAR,
) -> None:
    """The same for several runs over the same pixels.

    results: an array (..., outputs) of float32 for each, of any strides. Raises as run does, and
    ValueError for results that cannot take the values.
    """
    array = np.asarray(pixels, dtype=np.float32)
    engine = engine_named(engine)
    _check(chain, channels, array, len(environments), results)
    if engine is Engine.COMPILED and not native.available():
        raise MissingExtraError(
            "the compiled engine needs llvmlite, which is not installed",
            hint="pip install 'brdfc[jit]', or leave the engine to be chosen",
        )
    shape = array.shape[:-1]
    if not math.prod(shape) or not results or not results[0].shape[-1]:
        return
    if any(np.may_share_memory(array, result) for result in results):
        array = array.copy()
    given = [{n: interpreter.variable(v, shape) for n, v in e.items()} for e in environments]
    if engine is Engine.INTERPRETER:
        forms = None
    else:
        forms = [straight_form(chain, channels, e, interpolation) for e in given]
    if forms is None or any(form is None for form in forms):
        for environment, result in zip(environments, results, strict=True):
            result[...] = _interpreted(chain, array, environment, interpolation)
        return
    found = [flat(result) for result in results]
    jobs = [
        Job(
            form,
            [np.require(e[n], np.float32, ["C", "A"]) for n in form.variables],
            samples(values, native.WIDEST),
        )
        for form, e, values in zip(forms, given, found, strict=True)
        if form is not None
    ]
    whole = flat(array)
    work = _work(jobs, samples(whole, native.WIDEST), engine, total or len(whole))
    parts = list(shares(len(whole), threads or threads_at_hand(), SHARE, 64))
    if len(parts) == 1:
        work(*parts[0])
    else:
        list(_pool().map(work, *zip(*parts, strict=True)))
    for values, result in zip(found, results, strict=True):
        if not np.may_share_memory(values, result):  # no view of it is a list of pixels
            result[...] = values.reshape(result.shape)


def _check(
    chain: Chain, channels: int, pixels: Values, count: int, results: Sequence[Values]
) -> None:
    """Machine code trusts addresses: what they lead to is made sure of here."""
    if pixels.ndim == 0 or pixels.shape[-1] != channels:
        raise ProgramError(f"{channels} channels are needed, the array is {pixels.shape}")
    shape = (*pixels.shape[:-1], outputs_of(chain, channels))
    for result in results:
        if result.shape != shape or result.dtype != np.float32 or not result.flags.writeable:
            raise ValueError(
                f"results are float32 arrays {shape} that can be written to, not "
                f"{result.dtype} {result.shape}"
            )
    if count != len(results):
        raise ValueError(f"{count} runs, and {len(results)} results")


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads_at_hand(), thread_name_prefix="brdfc")


if hasattr(os, "register_at_fork"):  # the threads are not in the other process
    os.register_at_fork(after_in_child=_pool.cache_clear)


def _interpreted(
    chain: Chain, pixels: Values, environment: Environment, interpolation: Interpolation
) -> Values:
    """Element by element over the whole array."""
    values = pixels
    for step in chain:
        if isinstance(step, Route):
            routed = np.empty((*values.shape[:-1], len(step.sources)), np.float32)
            for channel, (source, default) in enumerate(
                zip(step.sources, step.defaults, strict=True)
            ):
                routed[..., channel] = default if source is None else values[..., source]
            values = routed
        else:
            values = interpreter.run(step, values, environment, interpolation=interpolation)
    return values


Work = Callable[[int, int], None]
"""What a thread does: pixels from the first number to before the second."""


def _work(jobs: Sequence[Job], pixels: Samples, engine: Engine, total: int) -> Work:
    """By machine code if it is asked for, or quicker; else by NumPy, and so what is too much to
    compile."""
    possible = native.available() and all(choice.can_be_compiled(job.form) for job in jobs)
    if engine is not Engine.BLOCKS and possible:
        found = [native.shape_of(job.form, pixels.step, job.results.step) for job in jobs]
        new = {shape: job.form for (shape, _), job in zip(found, jobs, strict=True)}
        making = sum(choice.making(form) for shape, form in new.items() if not native.kept(shape))
        saved = total * sum(choice.saved(job.form) for job in jobs)
        quicker = saved > making and len(new) <= native.KEPT
        if quicker or engine is Engine.COMPILED:
            codes = [Compiled(native.code_for(shape), constants) for shape, constants in found]
            return partial(by_code, jobs, codes, pixels)
    return partial(in_blocks, jobs, pixels)
