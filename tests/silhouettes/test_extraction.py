import numpy as np

from core.silhouettes.extraction import sidelobe_ceiling


def test_sidelobes_lie_on_the_row_and_column_of_a_bright_point():
    image = np.full((5, 6), 1e-3, np.float32)
    image[2, 3] = 1.0
    ceiling = sidelobe_ceiling(image, -40.0)
    assert np.allclose(ceiling[2], 1e-2)
    assert np.allclose(ceiling[:, 3], 1e-2)
    assert np.allclose(np.delete(np.delete(ceiling, 2, 0), 3, 1), 1e-5)
