"""The declarations of the variables: the attributes of a variable in a file, and how it is stored.

That every variable has a unit, words and a name that CF knows is checked by CF's own program in tests/test_output.py.
"""

from atmosbox.file.variables import variable


def test_a_companion_is_called_what_cf_calls_it():
    cases = [
        ("air_pressure_se", "air_pressure standard_error", "Pa"),
        ("air_pressure_count", "number_of_observations", "1"),
    ]
    for name, standard_name, unit in cases:
        assert variable(name).standard_name == standard_name
        assert variable(name).units == unit


def test_every_temperature_says_whether_it_is_a_difference():
    cases = [
        ("air_temperature", "temperature: on_scale"), ("air_temperature_theory", "temperature: on_scale"),
        ("air_temperature_se", "temperature: difference"), ("air_temperature_tolerance", "temperature: difference"),
        ("air_temperature_count", None), ("air_pressure", None), ("disc_mass", None),
    ]  # fmt: skip
    for name, metadata in cases:
        assert variable(name).units_metadata == metadata
