"""Runs for other programs: molecules as extended XYZ, numbers as CSV, each read by another program."""

import io

import numpy as np
import pytest

import atmosbox as ab
from atmosbox.errors import FileError
from atmosbox.file.export import extended_xyz
from tests.few_frames import few_frames_of

DALTON = 1.66053906892e-27


few_frames = few_frames_of({"temperature": (60, 10), "condensation": (40, 10)})
"""Runs have few frames: each is read as the others are."""


@pytest.fixture(scope="module")
def box():
    return ab.run("temperature", molecules=50, duration="2 ns", save_molecules=True)


@pytest.fixture(scope="module")
def cloud():
    return ab.run("condensation", molecules=200, duration="2 ns", save_molecules=True)


def with_ase(content):
    import ase.io

    return ase.io.read(io.StringIO(content.decode()), index=":", format="extxyz")


def test_a_box_of_nanometres_is_read_by_ase_in_angstroms(box):
    frames = with_ase(extended_xyz(box))
    assert len(frames) == box.sizes["elapsed_time"]
    for k in (0, -1):
        np.testing.assert_allclose(frames[k].positions, 1e10 * box.molecule_position[k], rtol=1e-6)
        np.testing.assert_allclose(frames[k].arrays["velo"], 1e-2 * box.molecule_velocity[k], rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(np.diag(frames[k].cell[:]), 1e10 * box.box_side[k], rtol=1e-8)
    np.testing.assert_allclose(frames[0].arrays["mass"], box.molecule_mass / DALTON, rtol=1e-6)
    assert frames[-1].info["Time"] == pytest.approx(2000.0)  # ps
    assert not frames[0].pbc.any()


def test_a_molecule_in_the_liquid_is_left_out_and_keeps_its_number(cloud):
    present = np.isfinite(cloud.molecule_position.values[:, :, 0])
    assert not present.all()
    frames = with_ase(extended_xyz(cloud))
    assert [len(frame) for frame in frames] == present.sum(axis=1).tolist()
    for frame, there in zip(frames, present, strict=True):
        assert frame.arrays["id"].tolist() == (np.flatnonzero(there) + 1).tolist()
        assert [symbol == "O" for symbol in frame.symbols] == (cloud.species.values[there] == 1).tolist()


def test_a_run_without_molecules_or_velocities_says_what_to_do(box):
    bare = ab.run("temperature", molecules=50, duration="1 ns", save_molecules=False)
    with pytest.raises(FileError, match="save_molecules=True"):
        extended_xyz(bare)
    with pytest.raises(FileError, match="speeds and no velocities"):
        extended_xyz(box.drop_vars("molecule_velocity"))
