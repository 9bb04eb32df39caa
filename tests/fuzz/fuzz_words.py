"""Changes to texts, XML or calculator: words and whole elements taken out, doubled, moved, and put
in the place of others."""

from __future__ import annotations

import random
import re

WORDS = re.compile(rb"<[^<>]*>|[{}]|[^\s<>{}]+|\s+")
NUMBER = re.compile(rb"-?\d+(\.\d+)?(e[+-]?\d+)?", re.IGNORECASE)
NUMBERS = (
    *(b"0", b"1", b"-1", b"2", b"3", b"16", b"255", b"256", b"65535", b"65536", b"1e30", b"1e-50"),
    *(b"1e999", b"nan", b"inf", b"-inf", b"+infinity", b"0x10", b"", b"\xd9\xa1", b"9" * 30),
)
MARKUP = (
    *(b"<!-- c -->", b"<![CDATA[", b"]]>", b"<?p?>", b"&amp;", b"&x;", b"&#0;", b"&#x10FFFF;"),
    *(b"<!DOCTYPE a>", b"\0", b"\xff", b"\xef\xbb\xbf", b"<a>", b"</a>", b'"', b"'"),
)
CALCULATOR = (
    *(b"{", b"}", b"if {", b"else {", b"sel", b"case {", b"dflt {", b"in[0,1]", b"out[0]", b"copy"),
    *(b"tput[0]", b"tget[0]", b"env(inci)", b"calc(0)", b"mtx(0)", b"solv(3,3)", b"copy(65536,9)"),
    *(b"#m", b"call{m}", b"tget{v}", b"in{a}", b"scnt", b"% c", b"rotl(3,1)", b"posd[2,3]", b"pop"),
)


def mutated(data: bytes, generator: random.Random, others: tuple[bytes, ...]) -> bytes:
    """The text after one change or a few; others: texts that words may come from."""
    words = WORDS.findall(data)
    for _ in range(generator.choice((1, 1, 1, 2, 3, 6))):
        change(words, generator, others)
    data = b"".join(words)
    if data and generator.random() < 0.15:
        at = generator.randrange(len(data))
        end = at + generator.choice((0, 1, 1, 2, len(data)))
        data = data[:at] + generator.choice((b"", bytes([generator.randrange(256)]))) + data[end:]
    return data


def change(words: list[bytes], generator: random.Random, others: tuple[bytes, ...]) -> None:
    at = generator.randrange(len(words)) if words else 0
    chosen = generator.randrange(8)
    if not words or chosen == 0:
        words.insert(at, b" " + generator.choice((*MARKUP, *CALCULATOR)) + b" ")
    elif chosen == 1:
        del words[at : at + generator.choice((1, 1, 2, 3, 9))]
    elif chosen == 2:
        other = WORDS.findall(generator.choice(others))
        start = generator.randrange(len(other))
        words[at:at] = other[start : start + generator.choice((1, 2, 5, 20))]
    elif chosen == 3:
        start, end = element_at(words, at)
        part = words[start:end]
        words[start:start] = part * generator.choice((1, 1, 2, 30))
    elif chosen == 4:
        start, end = element_at(words, at)
        del words[start:end]
    elif chosen == 5:
        start, end = element_at(words, at)
        part = words[start:end]
        del words[start:end]
        to = generator.randrange(len(words) + 1)
        words[to:to] = part
    else:
        numbers = [i for i, word in enumerate(words) if NUMBER.search(word)] or [at]
        at = generator.choice(numbers)
        words[at] = NUMBER.sub(
            lambda m: generator.choice(NUMBERS) if generator.random() < 0.5 else m.group(),
            words[at],
        )


def element_at(words: list[bytes], at: int) -> tuple[int, int]:
    """The words of the XML element, or of the block in braces, that begins at or after a word; the
    word alone where none does."""
    for start in range(at, min(at + 20, len(words))):
        word = words[start]
        if word == b"{":
            opening, closing = b"{", b"}"
        elif word.startswith(b"<") and word[1:2].isalpha() and not word.endswith(b"/>"):
            opening, closing = b"<" + word[1:-1].split()[0], b"</" + word[1:-1].split()[0] + b">"
        else:
            continue
        depth = 0
        for end in range(start, len(words)):
            depth += words[end] != closing and words[end].startswith(opening)
            depth -= words[end] == closing
            if depth == 0:
                return start, end + 1
    return at, at + 1
