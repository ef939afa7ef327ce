"""Made-up runs and their pages."""

import functools
from pathlib import Path

import numpy as np
import pytest

from atmosbox.file import dataset as diagnostics
from atmosbox.file.provenance import global_attributes
from atmosbox.page import save
from atmosbox.scene.instruments import LAWS
from atmosbox.scene.panels import Line, Panel, to_json
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR, WATER

SIDE = 2e-8

PANELS = (
    Panel(
        "line",
        "It warms",
        (
            Line("elapsed_time", "air_temperature", "molecules"),
            Line("elapsed_time", "air_temperature_theory", "walls", "theory", error="air_temperature_noise"),
        ),
        x_label="time",
        y_label="temperature",
        y_unit="degC",
        headlines=("final_temperature",),
    ),
    Panel(
        "profile",
        "Pressure against height",
        (Line("air_pressure", "air_temperature", "air"),),
        x_unit="hPa",
        y_scale="log",
        y_invert=True,
    ),
)


def made(frames=20, molecules=60, *, scene="temperature", settings=None, walls=("heat_bath",) * 6, water=0, **more):
    """Return a run as `atmosbox run --save-molecules` would have saved it, with molecules at random places."""
    rng = np.random.default_rng(frames * molecules + 7)
    kelvin = np.linspace(150.0, 300.0, frames)
    spread = np.sqrt(BOLTZMANN * kelvin / DRY_AIR.molecule_mass)
    velocity = rng.normal(size=(frames, molecules, 3)) * spread[:, None, None]
    position = rng.uniform(0.02, 0.98, (frames, molecules, 3)) * SIDE
    speed = np.linalg.norm(velocity, axis=2)
    species = np.arange(molecules) < water
    readings = {
        "molecule_position": position,
        "molecule_speed": speed,
        "molecule_mass": np.where(species, WATER.molecule_mass, DRY_AIR.molecule_mass),
        "molecule_diameter": np.full(molecules, DRY_AIR.diameter),
        "box_side": np.full((frames, 3), SIDE),
        "wall_law": [LAWS.index(law) for law in walls],
        "wall_temperature": np.tile([300.0 if law == "heat_bath" else np.nan for law in walls], (frames, 1)),
        "air_temperature": kelvin,
        "air_temperature_theory": np.full(frames, 300.0),
        "air_temperature_noise": np.full(frames, 12.0),
        "air_pressure": 1e5 * kelvin / 300.0,
        "potential_energy": np.zeros(frames),
    }
    if water:
        gone = np.linspace(0, water, frames).astype(int)
        for frame, number in enumerate(gone):
            position[frame, :number], speed[frame, :number] = np.nan, np.nan
        readings |= {"species": species.astype(np.int8), "liquid_molecule_count": gone}
    parameters = {
        "scene": scene,
        "settings": {"molecules": molecules, "temperature": 27.0, "seed": 3, **(settings or {})},
        "engine": "exact",
        "version": "1.0",
    }
    attributes = global_attributes(
        parameters, title="Warmth", command="a test", comment="Warm walls. Modelled: spheres.", panels=to_json(PANELS)
    )
    times = {"elapsed_time": np.arange(1.0, frames + 1.0) * 0.01}
    return diagnostics.dataset(readings | more, times, attributes)


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """Return a function that writes the page of some runs, once, and returns its address."""
    folder = tmp_path_factory.mktemp("pages")

    @functools.cache
    def address(name):
        runs = {
            "warm": lambda: [made()],
            "pair": lambda: [made(), made(settings={"temperature": 60.0})],
            "moist": lambda: [made(water=30, molecules=120, scene="./own.py", walls=("heat_bath",) * 6)],
            "large": lambda: [made(6, 5000)],
            "heated": lambda: [made(wall_temperature=np.tile(np.linspace(230.0, 340.0, 20)[:, None], (1, 6)))],
            "still": lambda: [made(1, 1)],
        }[name]()
        return save(runs, Path(folder, f"{name}.html")).as_uri()

    return address


@pytest.fixture(scope="module")
def new_tab(new_tab):
    """Return a function that opens a tab of some size without a network."""

    def make(size=(1280, 720), **options):
        tab = new_tab(size, offline=True, has_touch=size[0] < 600, reduced_motion="reduce", **options)
        tab.set_default_timeout(15_000)
        return tab

    return make


@pytest.fixture
def opened(new_tab, usual_tab, site):
    """Return a function that opens a page without a network; any error in the page fails the test."""
    tabs, faults, own = [], [], ("file:", "blob:", "data:")
    heard = {
        "pageerror": lambda error: faults.append(str(error)),
        "console": lambda said: faults.append(said.text) if said.type == "error" else None,
        "request": lambda asked: faults.append(asked.url) if not asked.url.startswith(own) else None,
    }

    def page(name, before="", **look):
        tab = new_tab(**look) if look or before else usual_tab
        tabs.append(tab)
        for event, hear in heard.items():
            tab.on(event, hear)
        if before:
            tab.add_init_script(before)
        tab.goto(site(name))
        tab.wait_for_selector("body[data-ready]")
        return tab

    yield page
    for tab in tabs:
        tab.goto("about:blank")
        for event, hear in heard.items():
            tab.remove_listener(event, hear)
    assert faults == []


@pytest.fixture(scope="session")
def run():
    """Return a function that makes up a run."""
    return made
