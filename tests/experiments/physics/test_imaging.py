import numpy as np
import pytest

from core.experiments.physics import imaging
from core.experiments.physics.imaging import imaging_part
from core.experiments.physics.point_spread import _cut
from core.experiments.pictures import write_pictures
from core.radar.window import HAMMING


def test_responses_are_the_windows_and_plain_range_doppler_smears(tmp_path, monkeypatch):
    monkeypatch.setattr(imaging, "SHARES", (0.4, 0.45, 0.5))
    monkeypatch.setattr(imaging, "SIDES", 4)
    monkeypatch.setattr(imaging, "PASSES", (1,))
    monkeypatch.setattr(imaging, "PIXEL_M", 0.024)
    part = imaging_part(lambda _stage, _done, _total: None)
    assert [figure.name for figure in part.figures if figure.met is False] == []
    values = {figure.name: figure.value for figure in part.figures}
    smear = "plain range-Doppler, 10 m off in {}: −3 dB width from the window's, worst"
    assert values[smear.format("range")] > 20
    assert values[smear.format("cross-range")] > 40
    names = [path.name for path in write_pictures(part.pictures, tmp_path)]
    assert names == ["point-responses.png", "window-cuts.png"]


@pytest.mark.parametrize(("stretch", "shift"), [(1.0, 0.0), (1.1, 0.3), (0.9, -0.2)])
def test_a_cut_is_measured_for_what_it_is(stretch, shift):
    cells = np.linspace(-12, 12, 2401)
    line = np.abs(HAMMING.point_response((cells - shift) / stretch))
    cut = _cut(line, 1200.0, 0.01, HAMMING.half_power_width_cells)
    assert cut.error_cells == pytest.approx(shift, abs=1e-4)
    assert cut.width_ratio == pytest.approx(stretch, abs=1e-3)
    assert cut.sidelobe_db == pytest.approx(HAMMING.highest_sidelobe_db, abs=0.05)
