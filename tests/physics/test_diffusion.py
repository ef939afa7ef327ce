"""Two gases that mix: D, the slowest mode and the entropy of mixing, against theory and against direct counting."""

import math

import numpy as np
import pytest

import atmosbox
from atmosbox import theory as law
from atmosbox.errors import SettingError
from atmosbox.scene.instruments.mixing import entropy_of_counts
from atmosbox.simulation.preparation import prepare
from atmosbox.theory import unlike_gases


def test_the_share_solves_the_diffusion_equation_and_keeps_half_of_each_gas():
    edges = np.linspace(0.0, 1.0, 201)
    for passed in (0.02, 0.3, 2.0):
        share = law.mixed_share(edges, np.array([passed - 1e-4, passed, passed + 1e-4]))
        assert share.mean(axis=1) == pytest.approx([0.5] * 3, abs=1e-12)
        rate = (share[2] - share[0]) / 2e-4  # per mixing time: d c / d(Gamma t) = (L / pi)^2 c''
        bend = np.diff(share[1], 2) * 200.0**2 / math.pi**2
        assert np.allclose(rate[1:-1], bend, atol=2e-3 * np.abs(rate).max())


def test_entropy_counted_from_few_molecules_is_not_too_small():
    rng = np.random.default_rng(5)
    left = rng.binomial(40, 0.3, (4000, 1))
    plain, corrected = [], []
    for (n,) in left:
        share = n / 40.0
        plain.append(-sum(p * math.log(p) for p in (share, 1.0 - share) if p))
        corrected.append(entropy_of_counts(np.array([n]), np.array([40 - n])))
    exact = -0.3 * math.log(0.3) - 0.7 * math.log(0.7)
    error = np.std(plain) / math.sqrt(4000)
    assert exact - np.mean(plain) > 8.0 * error  # 1 / 80 too small without the correction
    assert abs(np.mean(corrected) - exact) < 4.0 * error


@pytest.mark.parametrize("number", [2, pytest.param(8, marks=pytest.mark.nightly)])
def test_gases_alike_mix_as_fast_as_chapman_and_enskog_say_and_make_k_ln_2(number):
    runs = [atmosbox.run("diffusion", molecules=3000, seed=seed) for seed in range(number)]
    ratio = np.array([float(run.diffusion_coefficient / run.diffusion_coefficient_theory) for run in runs])
    stated = float(runs[0].diffusion_coefficient_se / runs[0].diffusion_coefficient_theory)
    assert abs(ratio.mean() - 1.0) < 4.0 * stated / math.sqrt(number)  # a false alarm with probability 6e-5
    end = np.mean([float(run.mixing_entropy[-1]) for run in runs])
    assert end == pytest.approx(float(runs[0].mixing_entropy_theory[-1]), abs=0.005)
    assert float(runs[0].mixing_entropy[0]) < 0.3
    assert max(float(run.ledger_residual.max()) for run in runs) < 1e-12


def test_the_boltzmann_equation_has_the_known_coefficients_of_hard_spheres():
    # self-diffusion, conduction of heat and viscosity to all orders of Chapman and Enskog; both waves of sound lose
    # half of 4/3 eta + 2/5 (5/3 - 1) lambda / k
    diffuse, conduct, viscous = 0.215581, 0.677833, 0.179136
    assert law.mutual_diffusivity(1.0, 1.0, (1.0, 1.0), 1.0) == pytest.approx(diffuse, rel=2e-5)
    collide, stream, norm = unlike_gases._equation(1.0)
    k, scale = 1e-3, 1.0 / np.sqrt(norm)
    rates = -np.linalg.eigvals(-(1j * k * stream + collide) * np.outer(scale, scale)) / k**2
    slow = rates[np.argsort(rates.real)[:4]]
    sound = 0.5 * (4.0 / 3.0 * viscous + 4.0 / 15.0 * conduct)
    assert np.sort(slow.real) == pytest.approx(sorted([diffuse, 0.4 * conduct, sound, sound]), rel=1e-4)
    assert np.abs(slow.imag).max() * k == pytest.approx(math.sqrt(5.0 / 3.0), rel=1e-5)


def test_the_second_approximation_is_that_of_chapman_and_cowling(monkeypatch):
    # as Marrero and Mason (1972, doi:10.1063/1.3253094) write it, for rigid spheres
    monkeypatch.setattr(unlike_gases, "_ORDER", 2)
    first, second = 1.0, 10.0
    total, product = first + second, 4.0 * first * second / (first + second) ** 2
    numerator = 15.0 * (1.0 - product) + 2.0 * product
    denominator = 19.5 * (1.0 - product) + 8.6 * product + 1.6 * total / math.sqrt(first * second)
    for one, other in ((first, second), (second, first)):
        wide = 2.0 / (other * total) * math.sqrt(2.0 * other / total)
        numerator += wide * one**2
        denominator += wide * (1.3 * one**2 + 3.0 * other**2 + 1.6 * one * other)
    expected = 1.0 / (1.0 - 0.1 * numerator / denominator)
    assert law.diffusivity_factor.__wrapped__((first, second)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.nightly
def test_unlike_gases_mix_as_the_boltzmann_equation_says():
    settings = {"mass_ratio": 10.0, "diameter": "0.8 nm", "molecules": 2000, "duration": 1.5}
    runs = [atmosbox.run("diffusion", seed=seed, **settings) for seed in range(8)]
    amplitude = np.array([run.mixing_amplitude.values for run in runs])
    apart = amplitude - runs[0].mixing_amplitude_theory.values
    error = apart.std(axis=0, ddof=1) / math.sqrt(8.0)
    halfway = slice(20, None, 20)
    # 13 mean free paths long: the decay by D alone is 0.1 lower, this one 0.01 off: D is not the same all over
    assert (np.abs(apart.mean(axis=0)) <= 5.0 * error + 0.01)[halfway].all()  # eight runs know their error by a quarter
    alone = np.exp(-1.5 * np.arange(1, 121) / 120.0)
    assert (amplitude.mean(axis=0) - alone > 8.0 * error)[halfway].sum() >= 4


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"length": "20 nm"}, "mean free paths long"),
        ({"diameter": "3 nm"}, "too wide for a gas"),
        ({"molecules": 100, "length": "1000 nm"}, "diameters wide"),
    ],
)
def test_boxes_in_which_gases_do_not_diffuse_are_refused(values, said):
    with pytest.raises(SettingError, match=said):
        prepare("diffusion", values)
