"""Numbers of a run beside numbers that are computed in another way: along a known path, from random numbers, by hand.

A fault of bookkeeping (a frame, a wall, an error bar, a row of a table) changes no law and closes every energy budget.
"""

import csv
import io
import json
import os
import subprocess
import sys
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr

import atmosbox as ab
from atmosbox import theory
from atmosbox.engine import FollowPressure, ParcelSet, Piston, Specular
from atmosbox.file.export import tables
from atmosbox.lab.box import lab_box
from atmosbox.lab.kernels.kernel_table import kernels
from atmosbox.lab.plan import lab_plan
from atmosbox.plot.curve import curve
from atmosbox.scene.ascent.drawn_parcels import _ROTATION, _SHEAR
from atmosbox.scene.instruments import Air, Flow, Layers, Mixing, Molecules
from atmosbox.scene.instruments.lifted_air import Environment, Lift
from atmosbox.scene.panels import Line, Panel
from atmosbox.scene.setup import Setup
from atmosbox.scene.units import Scale
from atmosbox.sheet import worksheet
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import build, prepare
from atmosbox.simulation.recording import Recording
from atmosbox.theory.constants import BOLTZMANN

SCALE = Scale(3.0, 2.0, 400.0 * BOLTZMANN, 5.0)
"""A unit of length of 3 m, of mass 2 kg, of temperature 400 K; each molecule stands for 5."""
GRAVITY, HIGH, SPEED = 0.5, 5.0, 3.0


def bounced(time):
    """Return height and velocity of a molecule of radius 0.5 thrown up from the floor, and its hits on both ends."""
    top = np.sqrt(SPEED**2 - 2.0 * GRAVITY * (HIGH - 1.0))  # what is left of its speed at the ceiling
    climb = (SPEED - top) / GRAVITY
    turns, since = np.divmod(time, 2.0 * climb)
    rises = since < climb
    velocity = SPEED - GRAVITY * since if rises else -SPEED + GRAVITY * (2.0 * climb - since)
    height = 0.5 + (SPEED**2 - velocity**2) / (2.0 * GRAVITY)
    floor, ceiling = turns, turns + (not rises)
    return height, velocity, 2.0 * SPEED * floor, 2.0 * top * ceiling


def of_known_path(*instruments, samples=4, frames=3, duration=12.0):
    """Run one molecule that bounces between floor and ceiling, and one at the floor beside it that does the same."""
    place = [[1.0, 1.0, 0.5], [3.0, 3.0, 0.5]]
    parcel = ParcelSet(
        place, [[0.0, 0.0, SPEED]] * 2, length=(4.0, 4.0, HIGH), gravity=GRAVITY, walls=(Specular(),) * 6
    )
    setup = Setup(parcel, SCALE, duration, frames, instruments, samples=samples)
    recording = Recording(SimpleNamespace(save_molecules=False, replay=None), setup, {})
    for _ in range(frames):
        recording.advance(lambda now: None)
    ends = np.linspace(0.0, duration, frames + 1)
    moments = ends[:-1, None] + np.arange(1, samples + 1) / samples * (duration / frames)
    return recording, ends, moments


def test_thermometer_barometer_and_molecules_are_those_of_a_known_path():
    whole, floor, kept = Air(), Air("floor"), Molecules()
    recording, ends, moments = of_known_path(whole, floor, kept)
    paths = np.array([[bounced(t) for t in row] for row in moments])
    speeds = np.mean(paths[:, :, 1] ** 2, axis=1)
    found = whole.readings(SCALE, 0)
    assert found["air_temperature"] == pytest.approx(400.0 * speeds / 3.0, rel=1e-9)  # two molecules of mass 1
    below, above = np.diff(np.array([bounced(t)[2:] for t in ends]), axis=0).T
    assert below.min() > 0.0 < above.min()
    unit = 400.0 * BOLTZMANN * 5.0 / 3.0**3 / (ends[1] * 9.0)  # centres reach 3 by 3 of floor and ceiling
    assert floor.readings(SCALE, 0)["air_pressure"] / unit == pytest.approx(2.0 * below, rel=1e-9)
    assert found["wall_pressure"][:, 4:] / unit == pytest.approx(2.0 * np.stack([below, above], axis=1), rel=1e-9)
    sides = 4.0 * 3.0 * 4.0 / 9.0  # the four others, over the floor
    assert found["air_pressure"] / unit == pytest.approx(2.0 * (below + above) / (2.0 + sides), rel=1e-9)
    height = kept.readings(SCALE, 0)["molecule_position"][:, 0, 2]
    assert height == pytest.approx(3.0 * paths[:, -1, 0], rel=1e-6)
    assert recording.times == pytest.approx(ends)


def test_the_times_of_a_file_are_the_ends_of_its_frames():
    run = ab.run("elastic-collisions", duration="2 s", seed=4)
    assert np.array_equal(run.elapsed_time, run.elapsed_time_bnds[:, 1])
    assert float(run.elapsed_time[-1]) == pytest.approx(2.0)
    assert float(run.elapsed_time_bnds[0, 0]) == 0.0


def page_and_python():
    """Return time, kT and pressure of each frame of a column, by the kernels of its page and by Python."""
    prepared = prepare("atmosphere", {"molecules": 50, "duration": 2, "start": "equilibrium"}, engine="exact")
    box, setup = lab_box(prepared), build(prepared)
    call = kernels(box.modes)
    assert call["start"](box.gas, box.ascent, box.book, box.start, prepared.settings.seed) == 0
    call["place"](box.gas, box.book, box.layout)
    call["begin"](box.gas, box.ascent, box.book, box.gauges, box.crowd)
    recording, (air,) = Recording(prepared, setup, {}), (each for each in setup.instruments if isinstance(each, Air))
    pages, frames = [], 4
    for frame in range(frames):
        for sample in range(1, setup.samples + 1):
            call["pass_time"](box.gas, box.ascent, box.book, box.layout, setup.moment(frame, sample), 10**9)
            call["sample"](box.gas, box.ascent, box.book, box.gauges)
        call["end_frame"](box.gas, box.ascent, box.book, box.gauges, box.layout, box.crowd)
        pages.append([float(each) for each in box.gauges.reading[:3]])
        recording.advance(lambda now: None)
    rows = [[row["air_temperature"], row["air_pressure"]] for row in air._rows]
    return pages, [[t, *row] for t, row in zip(recording.times[1:], rows, strict=True)], setup.parcel.contacts


def test_the_kernels_of_a_page_read_the_time_temperature_and_pressure_that_python_reads():
    code = "import json; from tests.test_known_numbers import page_and_python; print(json.dumps(page_and_python()))"
    ran = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, capture_output=True, check=True
    )
    page, python, contacts = json.loads(ran.stdout)
    assert contacts > 0
    assert np.array(page) == pytest.approx(np.array(python), rel=1e-9)


def test_a_knob_of_a_page_sets_the_temperature_that_it_shows():
    prepared = prepare("temperature", {"molecules": 50})
    told = lab_plan(prepared)[0]["knobs"]["temperature"]
    scale = build(prepared).scale
    for celsius in (-50.0, 25.0, 300.0):
        warm = celsius * told["up"] / told["down"] + told["offset"]
        assert warm * told["times"] / told["over"] == pytest.approx((celsius + 273.15) / scale.temperature)


def test_a_page_draws_the_random_numbers_of_its_seed():
    plans = [lab_plan(prepare("temperature", {"molecules": 50, "seed": seed})) for seed in (3, 3, 4)]
    assert [plan["seed"] for plan, *_ in plans] == [3, 3, 4]
    assert plans[0][1] == plans[1][1] != plans[2][1]


# Error bars and profiles


def layered(seed, frames=200):
    """Return the readings of two layers of a gas of 400 molecules, with a virial of 30 a unit of time."""
    rng, layers = np.random.default_rng(seed), Layers(2)
    parcel = SimpleNamespace(
        length=np.full(3, 4.0),
        mass=np.ones(400),
        planar=False,
        volume=64.0,
        virial=np.zeros(2),
        energy=lambda: (600.0,),
    )
    for frame in range(frames):
        place = np.stack([rng.uniform(0.0, 4.0, 400)] * 3, axis=1)
        parcel.time, parcel.virial = frame + 1.0, parcel.virial + 30.0
        layers.sample(parcel, SimpleNamespace(position=place, velocity=rng.normal(size=(400, 3))))
        layers.end_frame(parcel, None)
    return layers.readings(Scale(1.0, 1.0, BOLTZMANN), settle=0)


def test_layers_of_a_gas_have_the_pressure_n_k_t_plus_a_third_of_the_virial_and_the_errors_of_their_scatter():
    runs = [layered(seed) for seed in range(60)]
    expected = {
        "layer_temperature": 1.0,
        "number_density": 6.25,
        "layer_pressure": (6.25 + 30.0 / 3.0 / 32.0) * BOLTZMANN,
    }
    for name, right in expected.items():
        values, errors = (np.array([run[each] for run in runs]) for each in (name, f"{name}_se"))
        stated = np.sqrt(np.mean(errors**2, axis=0))
        assert values.mean(axis=0) == pytest.approx(right, abs=4.0 * stated.max() / 60**0.5)
        # the scatter of 60 runs is known within 9 %, the error of a run from twenty blocks within 16 %
        assert np.mean(values.std(axis=0, ddof=1) / stated) == pytest.approx(1.0, abs=0.25)


def test_the_wind_of_air_at_rest_is_none_but_for_noise_of_either_sign():
    rng, flow = np.random.default_rng(5), Flow(8, 8, release=9)
    parcel = SimpleNamespace(
        length=np.full(3, 4.0), mass=np.ones(1000), planar=False, volume=64.0, periodic=(True, True, False),
        diameter=np.ones(1000),
    )  # fmt: skip
    for _ in range(40):
        snapshot = SimpleNamespace(position=rng.uniform(0.0, 4.0, (1000, 3)), velocity=rng.normal(size=(1000, 3)))
        flow.sample(parcel, snapshot)
        flow.end_frame(parcel, snapshot)
    wind = flow.readings(Scale(1.0, 1.0, 1.0), 0)["wind_speed"]
    square = np.sign(wind) * wind**2
    # of 16 molecules in a cell, two components of chance alone would be 2 / 16
    assert abs(square.mean()) < 4.0 * square.std(ddof=1) / 40**0.5 < 0.02


def test_profiles_of_two_gases_are_those_of_the_frame_nearest_to_their_moment():
    right = np.arange(8) >= 4
    mixing = Mixing(right, {"early": 1.2, "late": 3.9}, bins=2)
    place = np.array([0.0, 1.0, 1.0, 1.0, 9.0, 9.0, 9.0, 9.0])
    parcel = SimpleNamespace(length=np.full(3, 10.0), diameter=np.zeros(8), periodic=(False,) * 3)
    for time in (1.0, 2.0, 3.0, 4.0):
        place[4 + int(time) - 1] = 1.0  # one more of the right gas comes to the left
        parcel.time = time
        mixing.end_frame(parcel, SimpleNamespace(position=np.stack([place] * 3, axis=1)))
    found = mixing.readings(Scale(1.0, 1.0, 1.0), 0)
    assert found["left_gas_share_early"][0] == pytest.approx(4.0 / 5.0)
    assert found["left_gas_share_late"][0] == pytest.approx(4.0 / 8.0)


def test_a_rising_parcel_that_rotates_has_the_potential_temperature_with_the_exponent_two_sevenths():
    rng = np.random.default_rng(2)
    place = 1.0 + 3.0 * np.stack(np.meshgrid(*[np.arange(2.0)] * 3), axis=-1).reshape(-1, 3)
    parcel = ParcelSet(
        place, rng.normal(size=(8, 3)), length=(6.0,) * 3, walls=(Specular(),) * 5 + (Piston(),),
        rotation=np.full(8, 2.0), rotational_energy=np.ones(8),
    )  # fmt: skip
    driver = FollowPressure([0.0, 10.0], [0.04, 0.03], mean_free_time=1.0)
    lift = Lift(driver, Environment(lambda t: 0.0, lambda t: 1.0, lambda t: 1.0))
    lift.end_frame(parcel, None)
    scale = Scale(1.0, 1.0, 300.0 * BOLTZMANN, 1e5 / (300.0 * BOLTZMANN))
    found = {name: float(values[0]) for name, values in lift.readings(scale, 0).items()}
    ratio = found["parcel_potential_temperature"] / found["parcel_temperature"]
    assert found["parcel_pressure"] < 1e4
    assert np.log(ratio) / np.log(1e5 / found["parcel_pressure"]) == pytest.approx(2.0 / 7.0)


def test_the_shares_of_friction_are_those_of_the_dissipation_of_rotating_molecules():
    assert pytest.approx(theory.DISSIPATION, abs=0.02) == _SHEAR + _ROTATION


# What is written


def test_a_budget_that_is_open_by_a_millionth_is_found():
    run = ab.run("elastic-collisions", duration="2 s", seed=4)
    assert all(check.passed for check in runner.verify(run))
    run["kinetic_energy"][-1] *= 1.0 + 1e-6
    assert [check.name for check in runner.verify(run) if not check.passed] == ["balance"]


def test_a_table_for_a_spreadsheet_has_value_error_and_theory_of_the_headline():
    run = ab.run("temperature", molecules=50, duration="2 ns", seed=4)
    head, *rows = csv.reader(io.StringIO(tables(run)["headlines"].decode()))
    assert head[2:] == ["value", "standard error", "theory", "unit"]
    for name, _, *numbers, _ in rows:
        expected = [float(run[each]) for each in (name, f"{name}_se", f"{name}_theory")]
        assert [float(each) for each in numbers] == expected
    assert len(rows) == 4


def test_each_row_of_a_sheet_has_the_number_of_its_own_run():
    sheet = worksheet("elastic-collisions", {"seed": 3, "duration": "10 s"}, answers=True)
    lines = [line.split("|")[3:5] for line in sheet.text.splitlines() if line.startswith("|") and "±" in line]
    shown = {letter.strip(): float(value.split("±")[0]) for letter, value in lines[1:]}
    assert len(shown) == len(sheet.runs) == 3
    for run in sheet.runs:
        alone = runner.execute(run.prepared).headlines[0]
        assert shown[run.letter] == pytest.approx(alone.value, abs=6e-4)


def test_a_file_has_the_temperature_and_pressure_that_were_set_in_the_units_that_it_names(tmp_path):
    settings = {"temperature": "40 degC", "pressure": "500 hPa", "duration": "2 ns"}
    ab.run("temperature", molecules=100, seed=2, out=tmp_path / "run.nc", **settings)
    with netCDF4.Dataset(tmp_path / "run.nc") as file:
        found = {
            name: (float(np.mean(file[name][:])), file[name].units) for name in ("air_temperature", "air_pressure")
        }
        assert (float(file["elapsed_time"][-1]), file["elapsed_time"].units) == (pytest.approx(2.0), "ns")
    assert found == {
        "air_temperature": (pytest.approx(313.15, rel=0.05), "K"),
        "air_pressure": (pytest.approx(5e4, rel=0.1), "Pa"),
    }


def test_the_error_bar_of_a_temperature_in_degrees_celsius_is_not_shifted():
    values = {"t": ("time", [293.15, 303.15], {"units": "K"}), "t_se": ("time", [0.5, 0.25], {"units": "K"})}
    run = xr.Dataset(values, {"time": ("time", [0.0, 1.0], {"units": "ns"})})
    line = Line("time", "t", "air", error="t_se")
    drawn = curve(run, Panel("line", "Temperature", (line,), y_unit="degC"), line)
    assert drawn.y == pytest.approx([20.0, 30.0])
    assert drawn.error == pytest.approx([0.5, 0.25])
