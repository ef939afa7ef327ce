"""Parcels change places: what is conserved, how energies change; and runs do not depend on how they are divided."""

import copy

import numpy as np
import pytest

from atmosbox.engine import HeatBath, ParcelSet, Periodic, Specular, Stirring
from atmosbox.engine.dsmc.stirred_dsmc_parcel import StirredDsmcParcel

N = 600
COLUMN = (Periodic(),) * 4 + (HeatBath(1.0), Specular())
STIRRING = Stirring(parcel=60, least=90, most=210, rate=40.0, interval=0.1)


def column(stirring=STIRRING, rotation=2.0, seed=3, kT=1.0, **changes):
    """Return a column of an isothermal gas, one scale height high."""
    rng = np.random.default_rng(seed)
    z = -np.log(1.0 - rng.random(N) * (1.0 - np.exp(-1.0)))
    spin = rng.exponential(kT, N) if rotation else np.zeros(N)
    facts = {
        "length": (0.4, 0.4, 1.0),
        "walls": COLUMN,
        "diameter": 0.0,
        "gravity": 1.0,
        "rotation": rotation,
        "rotational_energy": spin,
        "seed": seed,
    }
    position = np.stack([0.4 * rng.random(N), 0.4 * rng.random(N), np.clip(z, 0.0, 1.0)], axis=1)
    velocity = np.sqrt(kT) * rng.standard_normal((N, 3))
    return StirredDsmcParcel(position, velocity, stirring=stirring, **facts | changes)


def energy_of(box):
    return sum(box.energy())


@pytest.mark.parametrize("rotation", [0.0, 2.0])
@pytest.mark.parametrize("works", [True, False])
def test_an_exchange_keeps_heights_and_momentum_and_books_its_work(rotation, works):
    box = column(STIRRING._replace(works=works), rotation)
    before, energies = box.snapshot(), box.energy()
    box._stir(7)
    after = box.snapshot()
    assert box.exchanges == 7
    assert np.array_equal(np.sort(after.position[:, 2]), np.sort(before.position[:, 2]))
    assert (after.position[:, 2] != before.position[:, 2]).sum() >= 120
    assert np.array_equal(after.position[:, :2], before.position[:, :2])
    assert np.allclose(after.velocity.sum(axis=0), before.velocity.sum(axis=0), atol=1e-11)
    gained = energy_of(box) - sum(energies)
    assert box.stirring_work == pytest.approx(gained, abs=1e-10)
    if works:
        # an isothermal column is stable: overturning it takes work, whose energy is now kinetic
        assert gained > 1.0
        assert box.energy()[2] == pytest.approx(energies[2], rel=1e-14)
    else:
        assert box.stirring_work == 0.0
        assert np.array_equal(after.velocity, before.velocity)
        assert np.array_equal(after.rotational_energy, before.rotational_energy)


@pytest.mark.parametrize("rotation", [0.0, 2.0])
def test_a_parcel_that_rises_cools_by_the_law_of_poisson(rotation):
    """One exchange: energies of the rising and of the sinking parcel, from the pressures of the weight above."""
    box = column(STIRRING, rotation, kT=1.3)
    before = box.snapshot()
    order = np.argsort(before.position[:, 2])
    weight = 1.0 / 0.4**2
    squares = float((before.velocity**2).sum())
    floor = (squares / 3.0 + float((1.0 - before.position[:, 2]).sum())) / 0.4**2
    box._stir(1)
    after = box.snapshot()
    rose = np.flatnonzero(after.position[:, 2] > before.position[:, 2])
    sank = np.flatnonzero(after.position[:, 2] < before.position[:, 2])
    assert len(rose) == len(sank) == 60
    place = np.empty(N)
    place[order] = np.arange(N) + 0.5
    climbed = np.argsort(np.argsort(after.position[:, 2]))[rose] - np.argsort(np.argsort(before.position[:, 2]))[rose]
    assert np.ptp(climbed) == 0
    assert 90 <= climbed[0] <= 210
    for moved, lift in ((rose, climbed[0]), (sank, -climbed[0])):
        ratio = (floor - weight * (place[moved] + lift)) / (floor - weight * place[moved])
        factor = ratio ** (2.0 / (5.0 + rotation))
        if rotation:
            assert np.allclose(after.rotational_energy[moved], factor * before.rotational_energy[moved], rtol=1e-12)
        old, new = (each - each.mean(axis=0) for each in (before.velocity[moved], after.velocity[moved]))
        scaled = np.sqrt(factor)[:, None] * old
        assert np.allclose(new, scaled - scaled.mean(axis=0), atol=1e-12)
        assert np.allclose(before.velocity[moved].mean(axis=0), after.velocity[moved].mean(axis=0), atol=1e-13)


def test_a_stirred_column_is_the_same_however_it_is_cut_copied_or_restored():
    whole, cut, later = column(), column(), column()
    whole.advance(3.0)
    for until in np.linspace(0.0, 3.0, 18):
        cut.advance(until)
        cut = copy.deepcopy(cut) if until > 1.5 else cut
    later.restore(cut.state())
    half = column()
    half.advance(1.3)
    resumed = column()
    resumed.restore(half.state())
    resumed.advance(3.0)
    truth = whole.snapshot()
    assert whole.exchanges == int(40.0 * whole.time)
    for other in (cut, later, resumed):
        seen = other.snapshot()
        assert all(np.array_equal(one, two) for one, two in zip(truth[1:], seen[1:], strict=True))
        assert (other.stirring_work, other.exchanges) == (whole.stirring_work, whole.exchanges)
    assert whole.ledger() < 1e-13
    assert not np.array_equal(column(seed=4).snapshot().position, truth.position)


def test_a_column_that_is_not_stirred_moves_as_any_other():
    still, plain = column(STIRRING._replace(rate=0.0)), column(STIRRING)
    plain.set_stirring(0.0)
    for box in (still, plain):
        box.advance(1.0)
        assert (box.exchanges, box.stirring_work) == (0, 0.0)
    assert np.array_equal(still.snapshot().velocity, plain.snapshot().velocity)
    plain.set_stirring(10.0)
    plain.advance(2.0)
    assert 9 <= plain.exchanges <= 10


def test_spheres_that_exclude_volume_know_no_stirring():
    with pytest.raises(TypeError):
        ParcelSet([[1, 1, 1]], [[0, 0, 0]], length=(2, 2, 2), stirring=STIRRING)
