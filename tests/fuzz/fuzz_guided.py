"""The fuzzer guided by coverage: atheris (extra `fuzz`) keeps what reaches new code, to change it.

python tests/fuzz/fuzz_guided.py profile --count 1000000
"""

from __future__ import annotations

import argparse
import random
import sys
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["brdfc"]):
    from fuzz import MUTATED
    from fuzz_corpus import CORPORA
    from fuzz_limits import Findings, judged
    from fuzz_targets import TARGETS

LONGEST = 20_000
"""Bytes of an input."""
PLAIN = 0.1
"""The part of the changes that are atheris's own."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--findings", type=Path, default=Path("findings"))
    given = parser.parse_args()
    findings = Findings(given.findings)
    target, change = TARGETS[given.target], MUTATED[given.target]
    corpus = CORPORA[given.target](True)
    done = 0

    def one(data: bytes) -> None:
        nonlocal done
        done += 1
        judged(target, data, findings, f"{given.target}-guided-{given.seed}-{done}")

    def mutate(data: bytes, longest: int, seed: int) -> bytes:
        generator = random.Random(seed)
        if generator.random() < PLAIN:
            return bytes(atheris.Mutate(data, longest))
        return change(data, generator, corpus)[:longest]

    folder = given.findings / f"corpus-{given.target}"
    folder.mkdir(parents=True, exist_ok=True)
    for index, data in enumerate(corpus):
        (folder / f"{index}").write_bytes(data)
    options = [f"-runs={given.count}", f"-seed={given.seed}", f"-max_len={LONGEST}"]
    atheris.Setup([sys.argv[0], *options, str(folder)], one, custom_mutator=mutate)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
