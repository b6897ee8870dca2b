"""One pool of threads for all compiled kernels.

The kernels release the interpreter lock, so plain threads run them in parallel. numba's own
parallel layers are not used: OpenMP's starts jitter by milliseconds and the work queue aborts the
process when two Python threads call it.
"""

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import TypeVar

Compiled = {"cache": True, "nogil": True, "error_model": "numpy"}
"""How every kernel is compiled: kept on disk, free of the lock, dividing as NumPy does."""
InnerLoop = {**Compiled, "_nrt": False}
"""For loops that allocate nothing: without it every slice and every array passed on counts
references, atomically, and two threads that share an array wait for each other at each count."""

Item = TypeVar("Item")
Result = TypeVar("Result")


def thread_count() -> int:
    """Return how many kernels run at once: the processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_parallel(work: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """Return `work` of each item in order; what one of them raises is raised here."""
    return list(_pool().map(work, items))


def one_after_another(
    work: Callable[[Item], Result], items: Iterable[Item]
) -> Generator[Result, None, None]:
    """Yield `work` of each item in order as they are done; to close it drops those not begun."""
    yield from _pool().map(work, items)


def chunks(count: int, *, per_thread: int = 4) -> list[tuple[int, int]]:
    """Return ranges (first, past the last) that together cover `count` items evenly."""
    parts = min(count, per_thread * thread_count())
    ends = [count * part // parts for part in range(parts + 1)]
    return list(pairwise(ends))


@cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(thread_count(), thread_name_prefix="hull")
