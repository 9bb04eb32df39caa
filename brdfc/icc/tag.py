"""What every tag has, whatever its type."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Tag:
    """A frozen value of a type that begins with a signature of its own.

    read_from are the bytes of a tag that was read, from its type signature on. They may hold what
    the fields do not, such as padding, reserved bytes and another order of parts, so to_bytes
    gives them back; a tag that was made, or changed with dataclasses.replace, has none.
    """

    read_from: bytes | None = field(default=None, init=False, compare=False, repr=False)

    @property
    def type_signature(self) -> str:
        raise NotImplementedError

    def encode(self) -> bytes:
        """The bytes that the fields stand for; ProfileError where the type cannot hold them."""
        raise NotImplementedError

    def to_bytes(self) -> bytes:
        """The tag's bytes in a file: as they were read, otherwise as the fields say."""
        return self.encode() if self.read_from is None else self.read_from
