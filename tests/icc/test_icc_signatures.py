"""Colour spaces as bytes and as text."""

import pytest

from brdfc.icc.signatures import (
    DEVICE_CLASSES,
    NOT_IN,
    SPACE_SIZES,
    counted_space,
    multiplex_space,
    n_channel_space,
    signature_bytes,
    signature_text,
    space_channels,
    space_from_text,
    space_text,
)
from brdfc.icc.tags import TAGS
from brdfc.source.errors import ProfileError


@pytest.mark.parametrize(
    ("space", "text", "channels"),
    [
        (n_channel_space(5), "nc0005", 5),
        (n_channel_space(0x4C52), "nc4C52", 0x4C52),
        (multiplex_space(65535), "mcFFFF", 65535),
        (counted_space("rs", 31), "rs001F", 31),
        (b"nc\0\0", "nc0000", None),
        (b"XYZ ", "XYZ ", 3),
        (b"Lab ", "Lab ", 3),
        (b"GRAY", "GRAY", 1),
        (b"CMYK", "CMYK", 4),
        (b"2CLR", "2CLR", 2),
        (b"FCLR", "FCLR", 15),
        (bytes(4), "", 0),
        (b"what", "what", None),
    ],
)
def test_spaces(space, text, channels):
    assert space_text(space) == text
    assert space_from_text(text) == space
    assert space_channels(space) == channels


def test_a_count_is_binary_not_digits():
    assert n_channel_space(5).hex() == "6e630005"


def test_short_names_are_padded():
    assert space_from_text("RGB") == b"RGB "


@pytest.mark.parametrize("count", [0, -1, 65536])
def test_counts_a_space_cannot_have(count):
    with pytest.raises(ProfileError, match="1 to 65535"):
        n_channel_space(count)


def test_a_prefix_without_a_count():
    with pytest.raises(ProfileError, match="colour space with a count"):
        counted_space("xy", 3)


def test_tables_hold_signatures_only():
    names = [*TAGS, *DEVICE_CLASSES, *(tag for tags in NOT_IN.values() for tag in tags)]
    names += [kind for tag in TAGS.values() for kind in (*tag.types, *tag.before_4, *tag.since_5)]
    assert all(signature_text(signature_bytes(name)) == name for name in names)
    assert all(len(space) == 4 for space in SPACE_SIZES)
