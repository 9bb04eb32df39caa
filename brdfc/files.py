"""Output files appear whole or not at all: written beside their final name, then renamed.

A process that is killed leaves the file it was at under a hidden name, `.NAME.xxxxxxxx.part`, which
nothing reads and no later run takes for a result; it may be removed.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from brdfc.source.errors import BrdfcError


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """A temporary path beside `path`; renamed to it when the block ends, removed when it fails.

    Raises BrdfcError when the folder cannot be written, or what is there is no file.
    """
    final = place_of(path)
    try:
        handle, name = tempfile.mkstemp(dir=final.parent, prefix=f".{final.name}.", suffix=".part")
    except OSError as error:
        raise BrdfcError(f"cannot write here: {error.strerror}", where=str(path)) from error
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp makes files private; give the mode that an ordinary new file would have.
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)
        temporary.replace(final)
    except OSError as error:
        reason = error.strerror or str(error)
        raise BrdfcError(f"cannot be written: {reason}", where=str(path)) from error
    finally:
        temporary.unlink(missing_ok=True)


def place_of(path: str | Path) -> Path:
    """Where an output comes to lie: what a link leads to, not the link; BrdfcError where something
    is that cannot be replaced as a file can, such as a folder or a device."""
    final = Path(os.path.realpath(path))
    if final.exists() and not final.is_file():
        raise BrdfcError(
            "cannot be written: it is no file, and an output replaces what is there",
            where=str(path),
            hint="name a file",
        )
    return final


def write_whole(path: str | Path, data: bytes) -> None:
    """Write bytes to a path, whole or not at all."""
    with whole_file(path) as temporary:
        temporary.write_bytes(data)


def write_all(*files: tuple[str | Path, bytes]) -> None:
    """Write several files, all of them whole or none; BrdfcError where two are one."""
    refuse_same([path for path, _ in files])
    with ExitStack() as stack:
        for path, data in files:
            stack.enter_context(whole_file(path)).write_bytes(data)


def refuse_same(
    written: Sequence[str | Path | None], read: Sequence[str | Path | None] = ()
) -> None:
    """Raise BrdfcError where two of the files to be written are one, or one would replace a file
    that is read. None stands for a file that is not asked for."""
    targets = [Path(path) for path in written if path is not None]
    for i, target in enumerate(targets):
        if any(_one(target, other) for other in targets[:i]):
            raise BrdfcError("two outputs would be written here", where=str(target))
        if any(_one(target, Path(path)) for path in read if path is not None):
            raise BrdfcError("the output would replace an input", where=str(target))


def _one(a: Path, b: Path) -> bool:
    """Whether two paths lead to one file."""
    if a.exists() and b.exists():
        return a.samefile(b)
    return a.absolute() == b.absolute()


def read_file(path: str | Path, limit: int | None = None) -> bytes:
    """The bytes of a file; BrdfcError with the reason where it cannot be read.

    limit: refuse files larger than this many bytes (input from outside is not trusted).
    """
    try:
        with Path(path).open("rb") as stream:
            size = os.fstat(stream.fileno()).st_size
            if limit is not None and size > limit:
                raise BrdfcError(f"{size:,} bytes are more than {limit:,}", where=str(path))
            return stream.read()
    except OSError as error:
        raise BrdfcError(f"cannot be read: {error.strerror}", where=str(path)) from error
