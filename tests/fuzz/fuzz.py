"""Damaged input by the thousand, each a change of something right: see tests/README.md.

    python tests/fuzz/fuzz.py profile --count 1000000 --seed 1
    python tests/fuzz/fuzz.py profile findings/profile-1-4711.bin   # one finding again

The same seed gives the same inputs, so that one that crashes the process is known by its number.
"""

from __future__ import annotations

import argparse
import random
import sys
from pathlib import Path

import fuzz_mutations
import fuzz_words
from fuzz_corpus import CORPORA
from fuzz_limits import Findings, in_processes, judged
from fuzz_targets import TARGETS

MUTATED = {
    "profile": fuzz_mutations.mutated,
    "document": fuzz_words.mutated,
    "text": fuzz_words.mutated,
}


def made(target: str, seed: int, index: int, whole: bool = True) -> bytes:
    """The input of a number: a member of the corpus, or of the part that is soon made, changed."""
    generator = random.Random(f"{target}:{seed}:{index}")
    corpus = CORPORA[target](whole)
    return MUTATED[target](generator.choice(corpus), generator, corpus)


def fuzz(target: str, seed: int, numbers: range, findings: Findings, whole: bool = True) -> int:
    """Run the inputs of these numbers; how many were accepted to the end."""
    accepted = 0
    for index in numbers:
        findings.index = index
        data = made(target, seed, index, whole)
        accepted += judged(TARGETS[target], data, findings, f"{target}-{seed}-{index}")
    return accepted


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("file", nargs="?", type=Path, help="one input instead")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="number to begin with")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--findings", type=Path, default=Path("findings"))
    given = parser.parse_args()
    if given.file is not None:
        TARGETS[given.target](given.file.read_bytes())
        return
    findings = Findings(given.findings)
    CORPORA[given.target](True)
    numbers = range(given.first, given.first + given.count)
    accepted = in_processes(
        lambda part: fuzz(given.target, given.seed, part, findings),
        lambda index: made(given.target, given.seed, index),
        numbers,
        findings,
    )
    print(f"{given.target}: {given.count:,} inputs of seed {given.seed}, {accepted:,} accepted")
    print(f"{findings.count} findings in {findings.folder}" if findings.count else "no finding")
    sys.exit(bool(findings.count))


if __name__ == "__main__":
    main()
