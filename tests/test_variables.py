"""The declarations of the variables."""

import pytest

from atmosbox.file.variables import VARIABLES, variable

DIMENSIONS = {"elapsed_time", "height", "speed", "energy", "wall", "molecule", "drop", "axis"}


@pytest.mark.parametrize("name", VARIABLES)
def test_every_declared_variable_has_words_and_a_unit(name):
    declared = VARIABLES[name]
    assert declared.name == name
    assert declared.long_name
    assert bool(declared.units) == (declared.dtype != "U" and not declared.flags)


@pytest.mark.parametrize("name", VARIABLES)
def test_the_dimensions_of_every_variable_are_declared(name):
    assert set(VARIABLES[name].dims) <= DIMENSIONS


def test_every_standard_name_is_in_the_table_of_cf():
    cf = pytest.importorskip("compliance_checker.cf.util")
    table = cf.StandardNameTable()
    used = {declared.standard_name for declared in VARIABLES.values()} - {None}
    assert len(used) >= 5
    for name in used:
        assert name in table


def test_an_error_bar_has_the_standard_name_of_its_parent_with_the_modifier_of_cf():
    assert variable("air_pressure_se").standard_name == "air_pressure standard_error"
    assert variable("number_density_se").standard_name is None


def test_a_number_of_samples_is_what_cf_calls_the_number_of_observations():
    assert variable("number_density_count").standard_name == "number_of_observations"
    assert variable("number_density_count").units == "1"


def test_an_answer_of_theory_is_the_same_quantity_and_a_tolerance_is_not():
    assert variable("air_pressure_theory").standard_name == "air_pressure"
    assert variable("air_pressure_tolerance").standard_name is None
    assert variable("air_pressure_tolerance").units == "Pa"


def test_no_companion_keeps_the_books_or_is_an_average():
    for name in ("kinetic_energy_se", "air_pressure_theory"):
        assert not variable(name).ledger
        assert variable(name).cell_methods is None


@pytest.mark.parametrize(
    ("name", "metadata"),
    [
        ("air_temperature", "temperature: on_scale"),
        ("air_temperature_theory", "temperature: on_scale"),
        ("air_temperature_se", "temperature: difference"),
        ("air_temperature_tolerance", "temperature: difference"),
        ("air_temperature_count", None),
        ("air_pressure", None),
        ("disc_mass", None),
    ],
)
def test_every_temperature_says_whether_it_is_a_difference(name, metadata):
    assert variable(name).units_metadata == metadata


def test_an_error_bar_of_nothing_is_refused():
    with pytest.raises(KeyError, match="nothing_se"):
        variable("nothing_se")
