"""Time, memory and medians, measured alike for every contender."""

import ctypes
import gc
import os
import re
import resource
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np

from core.hull.threads import chunks, in_parallel, thread_count

Result = TypeVar("Result")
Progress = Callable[[str, int, int], None]

MEMORY_METHOD = (
    "peak resident memory of the process during one untimed run less that before it, freed memory "
    "given back first (malloc_trim; VmHWM reset through clear_refs; elsewhere ru_maxrss)"
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Run(Generic[Result]):
    """One measured run.

    Attributes:
        seconds: wall-clock time.
        result: what was run returned.
    """

    seconds: float
    result: Result


def measured(work: Callable[[], Result]) -> Run[Result]:
    """Run and measure the time."""
    start = time.perf_counter()
    result = work()
    return Run(seconds=time.perf_counter() - start, result=result)


def peak_bytes(work: Callable[[], Result]) -> tuple[int, Result]:
    """Run and measure the memory (see `MEMORY_METHOD`); return it and what was run returned."""
    _give_back_freed_memory()
    _forget_peak_memory()
    before = _memory_bytes("VmRSS")
    result = work()
    return max(0, _memory_bytes("VmHWM") - before), result


def median_s(runs: Sequence[float]) -> float:
    """Return the median of some times."""
    return statistics.median(runs)


def percentile(values: Sequence[float], percent: float) -> float:
    """Return the value that `percent` of them do not exceed."""
    return float(np.percentile(values, percent))


def fitted_exponent(sizes: Sequence[float], values: Sequence[float]) -> float:
    """Return p of the power law values ∝ sizes^p that fits best on logarithmic axes."""
    slope, _ = np.polyfit(np.log(sizes), np.log(values), 1)
    return float(slope)


def machine() -> dict[str, object]:
    """Return what a reader of the figures must know of the machine and its business."""
    return {
        "threads": thread_count(),
        "load_average": round(os.getloadavg()[0], 2),
        "memory": MEMORY_METHOD,
    }


def copy_bandwidth_bytes_per_s(megabytes: int = 256, repeats: int = 5) -> float:
    """Return the best rate, read and written bytes together, of copying with all threads.

    Source: the copy kernel of McCalpin's STREAM.
    """
    source = np.ones(megabytes * 2**20, dtype=np.uint8)
    target = np.zeros_like(source)
    spans = [slice(first, last) for first, last in chunks(len(source), per_thread=1)]

    def copy(span: slice) -> None:
        np.copyto(target[span], source[span])

    seconds = min(measured(lambda: in_parallel(copy, spans)).seconds for _ in range(repeats))
    return 2 * len(source) / seconds


def _give_back_freed_memory() -> None:
    """Keep what earlier runs freed from serving this one unseen."""
    gc.collect()
    # Only the GNU C library has it.
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def _forget_peak_memory() -> None:
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return


def _memory_bytes(field: str) -> int:
    try:
        found = re.search(rf"{field}:\s+(\d+) kB", Path("/proc/self/status").read_text("ascii"))
    except OSError:
        found = None
    if found is not None:
        return 1024 * int(found.group(1))
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
