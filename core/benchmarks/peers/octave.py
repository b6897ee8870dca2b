"""Octave's inpolygon, the paper's own way; holes and parts are combined by exclusive or."""

import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat, savemat

from core.benchmarks.workload import Task

_SCRIPT = """
load('in.mat');
[y, z] = ndgrid(0:size_yz(1) - 1, 0:size_yz(2) - 1);
votes = zeros([numel(planes), size_yz], 'uint16');
for p = 1:numel(planes)
  for v = 1:numel(outlines)
    m = squeeze(to_image(v, :, :));
    r = m(1, 1) * planes(p) + m(1, 2) * y + m(1, 3) * z + m(1, 4);
    c = m(2, 1) * planes(p) + m(2, 2) * y + m(2, 3) * z + m(2, 4);
    inside = false(size(r)); on = inside;
    for k = 1:numel(outlines{v})
      ring = outlines{v}{k};
      [i, o] = inpolygon(r, c, ring(:, 1), ring(:, 2));
      inside = xor(inside, i); on = on | o;
    end
    votes(p, :, :) += reshape(uint16(inside | on), [1, size_yz]);
  end
end
save('-v7', 'out.mat', 'votes');
"""


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    outlines = np.empty(len(task.views), dtype=object)
    for number, view in enumerate(task.views):
        rings = np.empty(len(view.silhouette.rings), dtype=object)
        rings[:] = list(view.silhouette.rings)
        outlines[number] = rings
    given = {
        "planes": planes.astype(np.float64),
        "size_yz": np.array(task.grid.shape[1:], dtype=np.float64),
        "to_image": task.to_image,
        "outlines": outlines,
    }
    with tempfile.TemporaryDirectory() as folder:
        savemat(Path(folder) / "in.mat", given)
        command = ["octave", "--no-gui", "--quiet", "--eval", _SCRIPT]
        subprocess.run(command, cwd=folder, check=True)  # noqa: S603 - nothing of a user's in it
        found: NDArray[Any] = loadmat(Path(folder) / "out.mat")["votes"]
    return found.reshape(len(planes), *task.grid.shape[1:])
