import numpy as np
import pytest
import xarray as xr

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read


@pytest.fixture
def dataset(levels):
    pressure, height, temperature, dewpoint = np.array(levels).T
    return xr.Dataset(
        {
            "a": ("level", temperature, {"units": "degC", "standard_name": "air_temperature"}),
            "b": ("level", dewpoint + 273.15, {"units": "K", "standard_name": "dew_point_temperature"}),
            "c": ("level", height, {"units": "m", "standard_name": "altitude"}),
        },
        coords={"level": ("level", pressure, {"units": "hPa", "standard_name": "air_pressure"})},
    )


@pytest.fixture
def saved(tmp_path):
    def save(dataset, **options):
        path = tmp_path / "ascent.nc"
        dataset.to_netcdf(path, **options)
        return path

    return save


def test_variables_are_found_by_their_standard_names(dataset, saved, same_as):
    sounding = read(saved(dataset))
    same_as(sounding)
    assert sounding.source.endswith("ascent.nc, netCDF")


def test_the_classic_format_is_read_under_any_name(dataset, saved, same_as, tmp_path):
    path = saved(dataset, format="NETCDF3_CLASSIC").rename(tmp_path / "ascent.txt")
    same_as(read(path))


def test_variables_are_found_by_their_own_names(dataset, saved, same_as):
    plain = dataset.rename(a="temperature", b="dewpoint", c="height", level="pressure")
    for variable in plain.variables.values():
        del variable.attrs["standard_name"]
    same_as(read(saved(plain)))


def test_a_single_profile_may_have_dimensions_of_size_one(dataset, saved, same_as):
    same_as(read(saved(dataset.expand_dims(time=[0.0], lat=[50.0]))))


def test_levels_from_the_top_down_are_turned_and_the_title_is_the_name(dataset, saved, same_as):
    sounding = read(saved(dataset.isel(level=slice(None, None, -1)).assign_attrs(title="Nowhere")))
    same_as(sounding)
    assert sounding.name == "Nowhere"


def test_the_height_of_a_thermometer_is_not_taken_for_that_of_the_levels(dataset, saved, same_as):
    odd = dataset.drop_vars("c").assign(height=((), 2.0, {"units": "m", "standard_name": "height"}))
    same_as(read(saved(odd)))


def test_fill_values_are_missing(dataset, saved):
    dataset["a"][3] = np.nan
    sounding = read(saved(dataset, encoding={"a": {"_FillValue": -32768.0}}))
    assert len(sounding) == 11


def test_a_variable_without_a_unit_is_refused(dataset, saved):
    del dataset["a"].attrs["units"]
    with pytest.raises(SoundingError, match="the temperature has no unit"):
        read(saved(dataset))


def test_a_file_without_one_profile_is_refused_in_a_sentence(dataset, saved):
    cases = [
        (lambda d: d.drop_vars("b"), 'no variable is the dewpoint: give one the standard_name "dew_point_temperature"'),
        (lambda d: d.expand_dims(time=[0.0, 1.0]), "the temperature in a is not one value for each level .* time = 2"),
        (
            lambda d: d.isel(level=0),
            "the pressure in level is not one value for each level of the pressure, for it has no dimension",
        ),
        (
            lambda d: d.assign(b=d.b.rename(level="other")),
            "the dewpoint in b is not one value for each level of the pressure, for it has other = 12",
        ),
        (lambda d: d.assign(a=d.a.copy(data=["warm"] * 12)), "a holds no numbers"),
        (lambda d: d.assign(a=d.a.where(d.level > 200, np.inf)), "level 11: the temperature is not finite"),
        (lambda d: d.assign(b=d.b + 20.0), "level 1: the dewpoint of .* degC is above the temperature"),
        (lambda d: xr.Dataset({"speed": ("bin", [1.0])}), "no variable is the pressure"),
    ]
    for change, sentence in cases:
        dataset["b"].attrs.update(units="K")
        with xr.set_options(keep_attrs=True), pytest.raises(SoundingError, match=sentence) as caught:
            read(saved(change(dataset)))
        assert "\n" not in str(caught.value)


def test_a_damaged_file_is_refused(dataset, saved):
    for kept in [9, 100, 1000, 4000]:
        path = saved(dataset)
        path.write_bytes(path.read_bytes()[:kept])
        with pytest.raises(SoundingError, match="is damaged or not readable"):
            read(path)
