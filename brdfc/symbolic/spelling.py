"""A whole expression in the language's notation, its shared parts named first, so that the text
grows with the graph and not with the tree."""

from __future__ import annotations

from collections import Counter

from brdfc.symbolic.expression import Expression, describe, quantity, rebuild, walk


def spelled(expression: Expression) -> str:
    """`t1 = cos(incident); t2 = ...; result`: every part that occurs twice is named once."""
    uses = Counter(argument for e in walk(expression) for argument in e.arguments)
    names: dict[Expression, Expression] = {}
    texts: list[str] = []
    for e in walk(expression):
        short = rebuild(e, [names[a] for a in e.arguments])
        names[e] = short
        if e is not expression and uses[e] > 1 and e.arguments:
            name = quantity(f"t{len(texts) + 1}", e.width)
            texts.append(f"{name} = {_text(short)}")
            names[e] = name
    return "; ".join([*texts, _text(names[expression])])


def _text(e: Expression) -> str:
    text = describe(e, 1000)
    return text[1:-1] if text.startswith("(") and _closes(text) else text


def _closes(text: str) -> bool:
    """Whether the first bracket is closed by the last character only."""
    depth = 0
    for position, character in enumerate(text):
        depth += {"(": 1, ")": -1}.get(character, 0)
        if depth == 0:
            return position == len(text) - 1
    return False
