import os
import subprocess
import sys

from core.hull.warm_up import compile_kernels

AFTERWARDS = """
import numba
from core.hull import crossings, kept_crossings, slab_mesh, sweep
from core.hull.warm_up import compile_kernels
compile_kernels()
found = [crossings.cross_grid_edges, kept_crossings._match, slab_mesh.mesh_slab, sweep.sweep_planes]
assert all(kernel.signatures for kernel in found)
assert not any(sum(kernel.stats.cache_misses.values()) for kernel in found)
"""


def test_it_tells_its_progress():
    told = []
    compile_kernels(lambda stage, done, total: told.append((stage, done, total)))
    assert told[-1][1] == told[-1][2] == len(told)


def test_what_was_compiled_once_is_loaded_by_another_process():
    compile_kernels()
    ended = subprocess.run(
        [sys.executable, "-c", AFTERWARDS],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
