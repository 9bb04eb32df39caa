"""Parts worked on several at a time, their results in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Part = TypeVar("Part")
Result = TypeVar("Result")


def in_order(
    work: Callable[[Part], Result], parts: Iterable[Part], workers: int
) -> Generator[Result]:
    """The results of work on each part, in the order of the parts; as many are under way, or done
    and not taken yet, as there are workers.

    Reading one part, computing another and writing a third happen at the same time. What work
    raises is raised here; then, and when the caller stops, nothing is begun any more, and what is
    under way is waited for.
    """
    waiting: deque[Future[Result]] = deque()
    executor = ThreadPoolExecutor(workers)
    try:
        for part in parts:
            if len(waiting) >= workers:
                yield waiting.popleft().result()
            waiting.append(executor.submit(work, part))
        while waiting:
            yield waiting.popleft().result()
    finally:
        executor.shutdown(wait=True, cancel_futures=True)
