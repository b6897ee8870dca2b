"""The engine's kernels compiled beside the running server, once per machine."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from core.hull.closed_mesh import Surface
from core.hull.surface import mask_surface
from core.hull.volume import VoteVolume


class Compilation:
    """A process that compiles all kernels into the cache on disk.

    Until it has ended a hull is shown halfway between its voxels, which needs none of the kernels
    that take long; afterwards exactly.
    """

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        """Watch a running process."""
        self._process = process

    @property
    def is_done(self) -> bool:
        """Whether all kernels can be loaded at once."""
        return self._process.poll() is not None

    def surface_of(self, volume: VoteVolume) -> Surface:
        """Return the volume's surface, exact as soon as nobody has to wait for it."""
        if self.is_done:
            return volume.surface()
        return mask_surface(volume.hull(), volume.grid)


@contextmanager
def compiling() -> Iterator[Compilation]:
    """Compile in the background for as long as the block runs."""
    # "-P" keeps a folder called "core" where the server was started from being taken for ours.
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", "core.hull.warm_up"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield Compilation(process)
    finally:
        process.terminate()
        process.wait()
