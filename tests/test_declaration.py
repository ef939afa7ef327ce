"""What a declaration says of a variable, and how the variable is stored."""

import numpy as np
import pytest

from atmosbox.file.declaration import SUFFIXES, Variable, derived

PATH = Variable("molecule_position", ("elapsed_time", "molecule", "axis"), "m", "position of the molecule", dtype="f4")
HEIGHT = Variable("height", ("height",), "m", "height of the middle of the layer", "height", axis="Z", positive="up")


def test_attributes_that_are_not_set_are_left_out():
    assert HEIGHT.attributes() == {
        "standard_name": "height",
        "long_name": "height of the middle of the layer",
        "units": "m",
        "axis": "Z",
        "positive": "up",
    }


def test_the_values_of_a_flag_are_numbered_and_named():
    species = Variable("species", ("molecule",), "", "species", dtype="i1", flags=("dry_air", "water"))
    assert species.attributes()["flag_values"].tolist() == [0, 1]
    assert species.attributes()["flag_values"].dtype == np.int8
    assert species.attributes()["flag_meanings"] == "dry_air water"


def test_books_have_no_value_that_stands_for_a_missing_one():
    kept = Variable("kinetic_energy", ("elapsed_time",), "J", "energy", ledger=True)
    assert kept.encoding((3,)) == {"dtype": "f8", "_FillValue": None}
    assert np.isnan(HEIGHT.encoding((3,))["_FillValue"])


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_companion_has_the_name_of_its_parent_with_the_suffix_and_its_dimensions(suffix):
    companion = derived(HEIGHT, suffix)
    assert companion.name == f"height{suffix}"
    assert companion.dims == HEIGHT.dims
    assert companion.positive == ("up" if suffix == "_theory" else None)


@pytest.mark.parametrize(
    ("frames", "molecules", "chunks"),
    [(1000, 800, (100, 800, 3)), (7, 800, (7, 800, 3)), (1000, 100_000, (100, 3333, 3)), (0, 0, (1, 1, 3))],
)
def test_the_paths_of_molecules_are_packed_in_blocks_of_many_frames_and_few_megabytes(frames, molecules, chunks):
    assert PATH.encoding((frames, molecules, 3)) == {
        "dtype": "f4",
        "_FillValue": pytest.approx(np.nan, nan_ok=True),
        "zlib": True,
        "complevel": 4,
        "shuffle": True,
        "chunksizes": chunks,
    }
