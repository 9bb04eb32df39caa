"""The profiles that a profile was made of: `pseq` and `psid`."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar

from brdfc.icc.layout import check_count, read_parts, unpack, unpack_records, write_parts
from brdfc.icc.plain_texts import TextDescription, read_description
from brdfc.icc.signatures import signature_bytes, signature_text
from brdfc.icc.tag import Tag
from brdfc.icc.texts import LocalizedText
from brdfc.source.errors import ProfileError

Description = LocalizedText | TextDescription


@dataclass(frozen=True)
class ProfileDescription:
    """What the header of one of the profiles says, and its `dmnd` and `dmdd`."""

    manufacturer: str
    model: str
    attributes: int
    technology: str
    manufacturer_text: Description
    model_text: Description


@dataclass(frozen=True)
class ProfileSequence(Tag):
    """`pseq`: profiles in the order in which they were combined.

    The texts stand in the tag without offsets or sizes. An `mluc` is padded to 4 bytes, as the
    reference writes it; without padding, as others do, it is read too.
    """

    type_signature: ClassVar[str] = "pseq"
    profiles: tuple[ProfileDescription, ...]

    def encode(self) -> bytes:
        data = b"pseq" + struct.pack(">II", 0, len(self.profiles))
        for profile in self.profiles:
            data += signature_bytes(profile.manufacturer) + signature_bytes(profile.model)
            try:
                data += struct.pack(">Q", profile.attributes)
            except struct.error as error:
                raise ProfileError(f"'pseq' cannot hold attributes: {error}") from error
            data += signature_bytes(profile.technology)
            for text in (profile.manufacturer_text, profile.model_text):
                data += text.encode()
                if isinstance(text, LocalizedText):
                    data += bytes(-len(data) % 4)
        return data

    @staticmethod
    def decode(data: bytes, where: str) -> ProfileSequence:
        (count,) = unpack("I", data, 8, where)
        check_count(count, where)
        place = 12
        profiles = []
        for index in range(count):
            at = f"{where}, profile {index}"
            # Where the text of the profile before ends is known only but for its padding.
            if not _is_text(data, place + 20):
                place += -place % 4
            manufacturer, model, attributes, technology = unpack("4s4sQ4s", data, place, at)
            first, place = _read_text(data, place + 20, at)
            second, place = _read_text(data, place, at)
            profiles.append(
                ProfileDescription(
                    signature_text(manufacturer),
                    signature_text(model),
                    attributes,
                    signature_text(technology),
                    first,
                    second,
                )
            )
        return ProfileSequence(tuple(profiles))


def _is_text(data: bytes, place: int) -> bool:
    return data[place : place + 4] in (b"mluc", b"desc")


def _read_text(data: bytes, place: int, where: str) -> tuple[Description, int]:
    """The text at a place, or after its padding, and where it ends."""
    if not _is_text(data, place):
        place += -place % 4
    if data[place : place + 4] == b"desc":
        return read_description(data, place, where)
    if data[place : place + 4] != b"mluc":
        raise ProfileError(f"no 'mluc' or 'desc' at byte {place}", where=where)
    (count,) = unpack("I", data, place + 8, where)
    records = unpack_records("4sII", count, data, place + 16, where)
    size = max((offset + length for _, length, offset in records), default=0)
    end = place + max(size, 16 + 12 * count)
    return LocalizedText.decode(data[place:end], where), end


@dataclass(frozen=True)
class ProfileIdentifiers(Tag):
    """`psid`: the profile ID (16 bytes) and description of each profile of a sequence."""

    type_signature: ClassVar[str] = "psid"
    profiles: tuple[tuple[bytes, LocalizedText], ...]

    def encode(self) -> bytes:
        if any(len(identifier) != 16 for identifier, _ in self.profiles):
            raise ProfileError("a profile ID has 16 bytes", where="'psid'")
        places, body = write_parts(
            self.profiles,
            lambda profile: profile[0] + profile[1].encode(),
            key=id,
            start=12 + 8 * len(self.profiles),
        )
        head = b"psid" + struct.pack(">II", 0, len(self.profiles))
        return head + b"".join(struct.pack(">II", *place) for place in places) + body

    @staticmethod
    def decode(data: bytes, where: str) -> ProfileIdentifiers:
        (count,) = unpack("I", data, 8, where)
        places = unpack_records("II", count, data, 12, where)
        labels = [f"profile {index}" for index in range(count)]
        return ProfileIdentifiers(
            tuple(read_parts(data, places, labels, 12 + 8 * count, where, _identifier))
        )


def _identifier(data: bytes, where: str) -> tuple[bytes, LocalizedText]:
    if data[16:20] != b"mluc":
        raise ProfileError("no 'mluc' after the profile ID", where=where)
    return data[:16], LocalizedText.decode(data[16:], where)
