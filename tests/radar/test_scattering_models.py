import numpy as np
import pytest
import trimesh

from core.geometry.track import track_from_angles
from core.radar.echoes import simulate_echoes
from core.radar.facets import shaded_surface
from core.radar.reflectors import dihedral, square_plate
from core.radar.scatterers import surface_scatterers
from core.radar.scattering_models import ConductingSurface, Mixture, scattering_model
from core.radar.waveform import Waveform
from core.targets import Target

WAVEFORM = Waveform(frequency_count=64)
BOX = Target(name="box", parts=(trimesh.creation.box((1.0, 2.0, 3.0)),))


def model(name, target=BOX, seed=0, **options):
    return scattering_model(
        target, name, random=np.random.default_rng(seed), scatterers=4000, **options
    )


def turning(start_rad, stop_rad, count):
    angle = np.linspace(start_rad, stop_rad, count)
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)


def test_every_model_has_the_same_power_over_all_aspects():
    quarter = 22 / 4
    for each in (
        model("diffuse"),
        model("physical-optics"),
        model("mixed", roughness=0.3),
        model("mixed", roughness=0.0),
    ):
        assert each.mean_echo_power() == pytest.approx(quarter)
        assert each.reach_m() == pytest.approx(np.sqrt(14) / 2, rel=0.1)


def test_a_mixture_is_the_mirror_at_no_roughness_and_the_points_at_full():
    direction, frequency = turning(0.0, 0.02, 5), WAVEFORM.frequencies_hz()
    mirror, points = model("physical-optics"), model("diffuse")
    for roughness in (0.0, 0.36, 1.0):
        mixed = model("mixed", roughness=roughness).echoes(direction, frequency)
        wanted = np.sqrt(1 - roughness) * mirror.echoes(direction, frequency)
        wanted = wanted + np.sqrt(roughness) * points.echoes(direction, frequency)
        assert np.abs(mixed - wanted).max() < 1e-4 * np.abs(wanted).max()


def test_facets_flash_and_vanish_and_points_do_not():
    """A box's face turns through its flash: the mirror's echo follows it, the points' not."""
    frequency = WAVEFORM.frequencies_hz()[30:34]
    peaks = {}
    for name in ("diffuse", "mixed", "physical-optics"):
        each = model(name, roughness=0.9)
        power = [
            np.mean(np.abs(each.echoes(turning(a, a + 0.004, 8), frequency)) ** 2)
            for a in np.linspace(-0.3, 0.3, 31)
        ]
        peaks[name] = 10 * np.log10(power)
    assert peaks["diffuse"].std() < 4
    assert peaks["physical-optics"].std() > 8
    assert peaks["diffuse"].std() < peaks["mixed"].std() < peaks["physical-optics"].std()
    assert np.argmax(peaks["physical-optics"]) in (14, 15)


def test_away_from_all_flashes_roughness_carries_the_mixture():
    aside = turning(0.7, 0.75, 32) * 0.8 + np.array([0.0, 0.0, 0.6])
    power = {
        name: np.mean(np.abs(model(name).echoes(aside, WAVEFORM.frequencies_hz())) ** 2)
        for name in ("diffuse", "mixed", "physical-optics")
    }
    assert power["physical-optics"] < 0.05 * power["diffuse"]
    assert power["mixed"] == pytest.approx(0.5 * power["diffuse"], rel=0.2)


def test_a_mirror_flashes_with_its_textbook_section_in_simulated_echoes():
    target = Target(name="plate", parts=(square_plate(0.5),))
    angle = np.linspace(-0.03, 0.03, 31)
    track = track_from_angles(np.arange(31) / 100, -np.pi / 2 + angle - angle[0], 0 * angle)
    echoes = simulate_echoes(
        model("physical-optics", target),
        track,
        WAVEFORM,
        signal_to_noise_db=200.0,
        random=np.random.default_rng(0),
    )
    section = 4 * np.pi * 0.5**4 / WAVEFORM.wavelength_m**2
    flash = np.abs(echoes.samples[0, 31:33]) ** 2
    assert 10 * np.log10(flash.mean() / section) == pytest.approx(0, abs=0.1)
    assert np.abs(echoes.samples[-1]).max() < 0.2 * np.sqrt(section)


def test_bounces_traced_once_hold_over_an_interval():
    """Echoes of a dihedral over 3.4° are those of rays traced anew at every pulse."""
    target = Target(name="dihedral", parts=(dihedral(0.5, 0.5),))
    mirror, frequency = model("physical-optics", target), WAVEFORM.frequencies_hz()[:3]
    direction = -turning(np.pi / 4 - 0.03, np.pi / 4 + 0.03, 13)
    at_once = mirror.echoes(direction, frequency)
    anew = np.concatenate([mirror.echoes(each[None], frequency) for each in direction])
    assert np.abs(at_once - anew).max() < 0.05 * np.abs(anew).max()
    section = 8 * np.pi * 0.5**4 / WAVEFORM.wavelength_m**2
    decibels = 10 * np.log10(np.abs(at_once[6]) ** 2 / section)
    assert np.abs(decibels).max() < 0.7
    single = model("physical-optics", target, most_bounces=1).echoes(direction, frequency)
    assert np.abs(single[6]).max() < 0.1 * np.abs(at_once[6]).max()


@pytest.mark.parametrize(
    ("make", "wanted"),
    [
        (lambda: model("mixed", roughness=1.5), "0 to 1; got 1.5"),
        (lambda: model("mixed", roughness=np.nan), "0 to 1; got nan"),
        (lambda: model("physical-optics", most_bounces=0), "at least 1 bounces"),
        (lambda: Mixture(models=()), "at least one model"),
        (
            lambda: ConductingSurface(
                surface=shaded_surface(BOX, longest_edge_m=1.0), reflection=2.0
            ),
            "keeps 0 to 1",
        ),
    ],
)
def test_models_that_cannot_be_are_refused(make, wanted):
    with pytest.raises(ValueError, match=wanted):
        make()


def test_what_shows_its_back_only_returns_nothing():
    mirror = model("physical-optics", Target(name="plate", parts=(square_plate(0.5),)))
    from_behind = np.array([[0.0, 0.6, 0.8], [0.0, 0.59, 0.81]])
    assert not mirror.echoes(from_behind, WAVEFORM.frequencies_hz()).any()


def test_points_can_be_scaled():
    points = surface_scatterers(BOX, count=10, random=np.random.default_rng(0))
    assert points.scaled(0.5).mean_echo_power() == pytest.approx(points.mean_echo_power() / 4)
