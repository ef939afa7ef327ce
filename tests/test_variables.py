"""The declarations of the variables: the attributes of a variable in a file, and how it is stored.

That every variable has a unit, words and a name that CF knows is checked by CF's own program in tests/test_output.py.
"""

import pytest

from atmosbox.file.declaration import SUFFIXES, Variable, derived
from atmosbox.file.variables import VARIABLES, variable

HEIGHT = Variable("height", ("height",), "m", "height of the middle of the layer", "height", axis="Z", positive="up")


def test_attributes_that_are_not_set_are_left_out():
    assert HEIGHT.attributes() == {
        "standard_name": "height",
        "long_name": "height of the middle of the layer",
        "units": "m",
        "axis": "Z",
        "positive": "up",
    }


def test_a_companion_has_the_name_of_its_parent_with_the_suffix_and_its_dimensions():
    for suffix in SUFFIXES:
        companion = derived(HEIGHT, suffix)
        assert companion.name == f"height{suffix}"
        assert companion.dims == HEIGHT.dims
        assert companion.positive == ("up" if suffix == "_theory" else None)


def test_a_companion_is_called_what_cf_calls_it():
    cases = [
        ("air_pressure_se", "air_pressure standard_error", "Pa"),
        ("air_pressure_theory", None, "Pa"),
        ("air_pressure_tolerance", None, "Pa"),
        ("air_pressure_count", "number_of_observations", "1"),
        ("number_density_se", None, "m-3"),
    ]
    for name, standard_name, unit in cases:
        assert variable(name).standard_name == standard_name
        assert variable(name).units == unit


def test_no_companion_must_be_finite_or_is_an_average():
    for name in ("kinetic_energy_se", "air_pressure_theory"):
        assert not variable(name).ledger
        assert variable(name).cell_methods is None


def test_every_temperature_says_whether_it_is_a_difference():
    cases = [
        ("air_temperature", "temperature: on_scale"),
        ("air_temperature_theory", "temperature: on_scale"),
        ("air_temperature_se", "temperature: difference"),
        ("air_temperature_tolerance", "temperature: difference"),
        ("air_temperature_count", None),
        ("air_pressure", None),
        ("disc_mass", None),
    ]
    for name, metadata in cases:
        assert variable(name).units_metadata == metadata


def test_an_error_bar_of_nothing_is_refused():
    with pytest.raises(KeyError, match="nothing_se"):
        variable("nothing_se")


def test_a_standard_name_stands_at_one_variable_so_that_it_is_found_without_a_doubt():
    names = [each.standard_name for each in VARIABLES.values() if each.standard_name]
    assert len(names) > 10
    assert sorted(names) == sorted(set(names))
    assert all(variable(f"{name}_theory").standard_name is None for name in VARIABLES)
