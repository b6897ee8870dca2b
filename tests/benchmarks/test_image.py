import numpy as np
import pytest

from core.benchmarks.gridding import numpy_polar_format
from core.benchmarks.image import run_image
from core.geometry.track import random_views_track
from core.radar.aperture import Aperture
from core.radar.echoes import point_echoes
from core.radar.imaging import ImagingSettings, whole_interval
from core.radar.phase_history import PhaseHistory
from core.radar.polar_format import polar_format
from core.radar.waveform import Waveform


@pytest.mark.parametrize("shape", [(48, 64), (33, 47)])
def test_plain_numpy_is_the_direct_sum_and_so_is_ours(shape):
    random = np.random.default_rng(5)
    pulses, frequencies, spacing_m = 30, 40, (0.1, 0.13)
    angle = np.linspace(-0.03, 0.03, pulses)
    aperture = Aperture(
        samples=(random.normal(size=(pulses, frequencies, 2)).view(complex)[..., 0]).astype(
            np.complex64
        ),
        along=np.cos(angle),
        across=np.sin(angle),
        wavenumber_rad_per_m=np.linspace(680, 720, frequencies),
    )
    wavenumber = aperture.wavenumber_rad_per_m
    along = np.outer(aperture.along, wavenumber) - wavenumber.mean()
    across = np.outer(aperture.across, wavenumber)
    row_m, column_m = (
        (np.arange(count) - count // 2) * step for count, step in zip(shape, spacing_m, strict=True)
    )
    rows = np.exp(1j * np.multiply.outer(row_m, along))
    columns = np.exp(1j * np.multiply.outer(column_m, across))
    direct = np.einsum("rpf,cpf,pf->rc", rows, columns, aperture.samples, optimize=True)
    for form in (numpy_polar_format, polar_format):
        image = form(aperture, shape, spacing_m)
        assert np.abs(image - direct).max() < 1e-3 * np.abs(direct).max()


def test_every_way_is_timed_and_agrees():
    waveform = Waveform(frequency_count=96)
    track = random_views_track(
        views=1,
        turn_rad=waveform.wavelength_m / 0.3,
        pulses_per_view=150,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(1),
    )
    random = np.random.default_rng(2)
    samples = point_echoes(
        random.uniform(-3, 3, (20, 3)), np.ones(20), track.line_of_sight, waveform.frequencies_hz()
    )
    history = PhaseHistory(samples=samples, frequency_hz=waveform.frequencies_hz(), track=track)
    small = ImagingSettings(shape=(64, 64), pixel_spacing_m=0.15)
    results = run_image(repeats=1, echoes=[(history, whole_interval(history))], settings=small)
    values = {figure.name: figure for figure in results.figures}
    assert values["1 frames from their echoes"].wanted is None
    assert values["1 frames from their echoes, per second"].value > 0
    assert values["polar format, times faster than back-projection"].value > 0
    agreed = [figure.met for name, figure in values.items() if "differs from" in name]
    assert agreed == [True, True]
