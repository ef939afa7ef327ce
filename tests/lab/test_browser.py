"""The page in a real browser, opened from disk without a network: the same bytes as Python, and knobs that act."""

import hashlib
import io
import json
import re
import shlex

import numpy as np
import pytest

from atmosbox.file.netcdf import read
from atmosbox.lab import box as lab_box
from atmosbox.lab import save_lab
from atmosbox.lab.plan import DROP_STATE, STATE, WET_STATE
from atmosbox.lab.stage import lab_stage
from atmosbox.lab.wasm_module import SCENES
from atmosbox.simulation.preparation import build, prepare
from atmosbox.simulation.recording import Recording
from atmosbox.theory import WATER_MASS_RATIO
from tests.in_process import typed

SMALL = {
    "temperature": ({"molecules": 150}, 60),
    "elastic-collisions": ({}, 30),
    "atmosphere": ({"molecules": 3000}, 3),  # its layers are fitted to the molecules at the start, and when they fall
    "convection": ({"molecules": 500}, 20),
    "lifting-dry": ({"molecules": 300, "ascent": 100}, 40),  # its cells are laid out again twice
    "temperature-large": ({"molecules": 300}, 20),
    "diffusion": ({"molecules": 2000}, 8),
    "attraction": ({"molecules": 300, "duration": "0.6 ns"}, 40),  # drops grow, and touch each other
    "evaporation": ({"molecules": 400, "pool": 150}, 60),
    "condensation": ({"molecules": 300, "humidity": 300}, 40),
    "lifting-moist": ({"molecules": 400, "ascent": 60, "dewpoint": 23}, 60),  # its cells are laid out again too
    "lifting-sounding": ({"molecules": 300, "ascent": 40}, 80),
    "mountains": ({"molecules": 400, "travel": 60}, 96),  # up and down again, and it rains
    "nuclei": ({}, 6),
}
BESIDE = {"nuclei": ({"molecules": 1000}, 12)}
"""Fewer molecules, whose rows of cells hold copies of trajectories."""
TOLD = ("adiabat", "environment", "parcel_height", "parcel_temperature_se", "dry_air_adiabat", "largest_haze")
"""Beginnings of the names of curves of theory for a parcel."""


KEEPS_FRAME = """
window.Worker = class extends Worker {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", ({ data }) => {
      if (data instanceof ArrayBuffer) window.frame = new Uint8Array(data.slice(0));
    });
  }
};
"""


class Lab:
    """The page of a scene in a tab of the browser; a fault in it fails the test."""

    def __init__(self, tab, address):
        self.page, self.faults = tab, []
        tab.on("pageerror", self._failed)
        tab.on("console", self._said)
        tab.goto(address)
        tab.wait_for_selector("body[data-ready]", timeout=30_000)

    def _failed(self, error):
        self.faults.append(str(error))

    def _said(self, said):
        if said.type == "error":
            self.faults.append(said.text)

    def close(self):
        """Stop the page, whose tab is free for the next one."""
        self.page.goto("about:blank")
        self.page.remove_listener("pageerror", self._failed)
        self.page.remove_listener("console", self._said)
        assert not self.faults

    def ask(self, **message):
        """Send a message to the engine."""
        said = json.dumps(message)
        self.page.evaluate(f"document.dispatchEvent(new CustomEvent('ask', {{detail: {said}}}))")

    def digest(self):
        """Return the SHA-256 of the state of the box."""
        self.page.evaluate("delete document.body.dataset.digest")
        self.ask(type="digest")
        return self.page.wait_for_selector("body[data-digest]").get_attribute("data-digest")

    def frame(self):
        """Return the data of the last picture, see `parts_of`."""
        return parts_of(bytes(self.page.evaluate("Array.from(window.frame)")))

    def table(self):
        """Return the file that the page saves: its first lines, and the columns by name."""
        with self.page.expect_download() as saving:
            self.page.click("#save")
        text = saving.value.path().read_text(encoding="utf-8")
        about = [line for line in text.splitlines() if line.startswith("#")]
        rest = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
        return about, np.genfromtxt(io.StringIO(rest), delimiter=",", names=True, deletechars="")

    def until(self, is_so):
        """Wait until a condition is true."""
        for _ in range(200):
            if is_so():
                return
            self.page.wait_for_timeout(50)
        raise AssertionError("it never was so")

    def note(self):
        """Return the text of the next note."""
        return self.page.wait_for_selector("#notes .note").inner_text()


@pytest.fixture(scope="module")
def new_tab(new_tab):
    """A function that opens a tab without a network."""

    def make(**options):
        tab = new_tab(**{"offline": True, "reduced_motion": "reduce", **options})
        tab.add_init_script(KEEPS_FRAME)
        return tab

    return make


@pytest.fixture
def lab(new_tab, usual_tab, tmp_path):
    """A function that opens the page of a scene."""
    opened = []

    def show(scene, settings, *, others=False, **options):
        prepared = prepare(scene, SCENES[scene] | settings, engine="exact")
        path = save_lab(prepared, tmp_path / "lab.html", others=others, force=True)
        assert path.stat().st_size <= 1_500_000
        opened.append(Lab(new_tab(**options) if options else usual_tab, path.as_uri()))
        return opened[-1]

    yield show
    for each in opened:
        each.close()


def parts_of(frame):
    """Return the sides of the box, the places and states of molecules, and the drops: see `atmosbox.page.frame`."""
    count = int(np.frombuffer(frame, "<u4", 1, 24)[0])
    place = np.frombuffer(frame, "<u2", 3 * count, 32).astype(int)
    state = np.frombuffer(frame, np.uint8, count, 32 + 7 * count)
    return np.frombuffer(frame, "<f4", 3, 12), place, state, np.frombuffer(frame[36 + 8 * count :], "<f4")


def python_frame(setup, stage):
    """Return the same data as Python makes them of a box."""
    parcel, snapshot, scale = setup.parcel, setup.parcel.snapshot(), setup.scale
    position, speed = np.full((parcel.present.size, 3), np.nan), np.full(parcel.present.size, np.nan)
    position[parcel.present] = snapshot.position * scale.length
    speed[parcel.present] = np.sqrt(np.sum(snapshot.velocity**2, axis=1)) * scale.velocity
    drops = None
    if hasattr(parcel, "drops"):
        centre, radius, _ = parcel.drops()
        drops = np.column_stack([centre, radius]) * scale.length
    liquid, rained = (int(getattr(parcel, name, 0)) for name in ("liquid", "rained"))
    return stage.frame(
        0, 0.0, parcel.length * scale.length, position, speed, drops=drops, liquid=liquid, rained=rained
    )  # fmt: skip


def advance(setup, frames, first=0):
    """Advance a box in Python as a page does: sample by sample, for a number of frames."""
    for frame in range(first, frames):
        for sample in range(1, setup.samples + 1):
            setup.parcel.advance(setup.moment(frame, sample))


def state_of(parcel):
    """Return the SHA-256 of the same arrays in Python."""
    parts = {
        "gas.molecules": parcel._molecules,
        "gas.kinds.rotational_energy": parcel._kinds.rotational_energy,
        "gas.tallies.count": parcel._tallies.count,
        "gas.tallies.heat": parcel._tallies.heat,
        "gas.tallies.random": parcel._tallies.random,
    }
    names = STATE
    if hasattr(parcel, "vapour"):
        names = (*names, *WET_STATE)
        parts |= {name: getattr(parcel._reservoir, name.rpartition(".")[2]) for name in WET_STATE}
    if hasattr(parcel, "drops"):
        names = (*names, *DROP_STATE)
        parts |= {name: getattr(parcel._drops, name.rpartition(".")[2], None) for name in DROP_STATE}
        parts["gas.kinds.table"] = parcel._kinds.table
    return hashlib.sha256(b"".join(parts[name].tobytes() for name in names)).hexdigest()


ALIKE = ("lifting-sounding", "mountains", "temperature-large", "diffusion", "atmosphere", "condensation")
"""These scenes use the module of another, or one that differs little."""
FIXED = ("elastic-collisions", "convection")
"""In these scenes Python places the molecules, and a page offers only the seeds for which it has done so."""


@pytest.mark.parametrize(
    ("scene", "settings", "frames"),
    [
        pytest.param(scene, *case, marks=pytest.mark.nightly if scene in ALIKE or case is SMALL["nuclei"] else ())
        for cases in (SMALL, BESIDE)
        for scene, case in cases.items()
    ],
)
def test_the_page_has_the_same_bytes_as_python_with_another_seed_and_measures_the_same(lab, scene, settings, frames):
    another = settings | {"seed": 7}
    shown = lab(scene, another if scene in FIXED else settings)
    if scene not in FIXED:
        shown.ask(type="reset", seed=7)
    shown.ask(type="frames", value=frames)
    prepared = prepare(scene, SCENES[scene] | another, engine="exact")
    setup = build(prepared)
    recording, (stage, _) = Recording(prepared, setup, {}), lab_stage(prepared, setup, ())
    for _ in range(frames):
        recording.advance(lambda now: None)
    assert setup.parcel.contacts > 200
    if hasattr(setup.parcel, "vapour"):
        assert min(setup.parcel.condensed, setup.parcel.evaporated) > 20
    assert shown.digest() == state_of(setup.parcel)
    for seen, expected in zip(shown.frame(), parts_of(python_frame(setup, stage)), strict=True):
        # places are rounded to 16 bits; exact halves may be rounded up or down
        np.testing.assert_allclose(seen, expected, rtol=1e-6, atol=int(seen.dtype == int))
    _, table = shown.table()
    assert len(table) == frames
    found, _ = recording.dataset("lab", settle=0, judged=False)
    compared = 0
    for name in table.dtype.names:
        if name in found:
            # between the rows of a table the page interpolates linearly, and a cloud begins with no water
            told = name.endswith(("_theory", "_noise")) or name.startswith(TOLD)
            expected = np.asarray(found[name].values, np.float64)
            width, off = (5e-6, 5e-6 * np.nanmax(np.abs(expected))) if told else (1e-9, 0.0)
            if hasattr(setup.parcel, "drops"):  # the ledger holds 1e8 kT in nuclei, and e_s(T) magnifies its rounding
                width = max(width, 1e-8)
            if name == "adiabat_temperature" and "rain_mixing_ratio" in found:
                # rain is here that of the planned pressures, in a file that of the measured ones, which scatter
                assert (np.abs(table[name] - expected) < 0.25 * found.parcel_temperature_se.values).all()
                continue
            if name == "parcel_buoyancy":  # g (T' / T - 1), of which T is from a table
                off = 5e-6 * 9.80665
            if name == "largest_haze_mixing_ratio":  # within 1e-4 molecules: it has a kink at each whole molecule
                off = 1e-4 * WATER_MASS_RATIO / setup.parcel.number
            np.testing.assert_allclose(table[name], expected, rtol=width, atol=off, err_msg=name)
            compared += 1
    assert compared > 3


@pytest.mark.parametrize("frames", [90, pytest.param(138, marks=pytest.mark.nightly)])
def test_lists_of_neighbours_grow_while_the_attraction_is_turned_down_and_up_again(lab, monkeypatch, frames):
    usual = lab_box.lists
    # 23 words are enough at the start, but not where a drop forms: there the page gives them 46, or more
    monkeypatch.setattr(lab_box, "lists", lambda parcel: usual(parcel)._replace(stride=np.array([23])))
    settings, turns = {"molecules": 100, "duration": "2.4 ns"}, ((50, 0.5), (70, 1.0), (frames, 1.0))
    shown = lab("attraction", settings)
    setup = build(prepare("attraction", settings))
    parcel, frame = setup.parcel, 0
    for until, strength in turns:
        shown.ask(type="frames", value=until)
        shown.ask(type="set", name="attraction", value=strength)
        advance(setup, until, frame)
        frame = until
        parcel.set_strength(strength)
    assert (parcel._walls.epoch[0] > 0.0) == (frames > 134)  # after which all clocks are set back
    assert shown.digest() == state_of(parcel)
    _, table = shown.table()
    assert table["work_by_attraction"][50] > 0.0  # weaker wells
    free = table["vapor_molecule_count"]
    assert free[65:70].mean() > free[40:50].mean() + 10.0  # the drop has gone with the attraction


@pytest.mark.nightly  # for its box, kernels are compiled that no other unmarked test needs
def test_rows_of_names_grow_when_molecules_are_placed_and_on_the_way(lab, monkeypatch):
    monkeypatch.setattr(lab_box, "ROW", 7)  # words; twice as many are enough at the start, and not for long
    settings = {"molecules": 600, "water": 200, "seed": 4}
    shown = lab("nuclei", settings)
    shown.ask(type="frames", value=6)
    setup = build(prepare("nuclei", settings))
    most = []
    for frame in range(6):
        cells = setup.parcel.arrays().gas.cells
        rows = cells.row.reshape(-1, cells.stride)
        most.append(rows[:, 0].max())
        advance(setup, frame + 1, frame)
    assert 7 <= most[0] < 14 <= max(most) < 28
    assert shown.digest() == state_of(setup.parcel)


def test_floor_ceiling_and_gravity_are_turned_apart_and_the_wind_is_drawn(lab):
    settings = {"molecules": 500}
    shown = lab("convection", settings)
    setup = build(prepare("convection", settings, engine="exact"))
    knobs, frame = {knob.name: knob for knob in setup.knobs}, 0
    turns = (10, "floor_temperature", 100.0), (20, "ceiling_temperature", -200.0), (30, "gravity", 25.0), (40, "", 0.0)
    for until, name, value in turns:
        shown.ask(type="frames", value=until)
        advance(setup, until, frame)
        frame = until
        if name:
            shown.ask(type="set", name=name, value=value)
            knobs[name].set(value)
    assert shown.digest() == state_of(setup.parcel)
    _, table = shown.table()
    floor, ceiling = (table[f"wall_temperature[{wall}]"][[9, 10, 20]] for wall in ("z_low", "z_high"))
    assert floor == pytest.approx([543.15, 373.15, 373.15])
    assert ceiling == pytest.approx([28.15, 28.15, 73.15])
    assert table["gravity"][[29, 30]] == pytest.approx([9.80665, 25.0])
    assert re.search(r"energy conserved to 1[45] digits$", shown.page.locator("#vitals").inner_text())
    assert re.fullmatch(r"wind: longest arrow \d+ m/s", shown.page.locator(".wind").inner_text())


def test_a_parcel_comes_to_its_end_and_goes_back_to_where_the_knob_leads_it(lab):
    shown = lab("lifting-dry", {"molecules": 200, "ascent": 40})
    shown.ask(type="frames", value=40)
    assert "end of its path" in shown.note()
    shown.ask(type="set", name="altitude", value=1.0)
    shown.ask(type="frames", value=80)
    _, table = shown.table()
    height = table["parcel_height"]
    assert height[39] == pytest.approx(9_160.0, abs=100.0)  # of 300 hPa in this environment
    assert height[-1] == pytest.approx(1_000.0, abs=1.0)
    # the piston has compressed it again, and it is about as warm as dry air is at 1 km
    assert table["parcel_temperature"][39] < 210.0
    assert table["parcel_temperature"][-1] == pytest.approx(278.4, abs=15.0)


def test_the_temperature_of_the_walls_acts_and_the_saved_table_says_so(lab):
    shown = lab("temperature", {"molecules": 250})
    shown.ask(type="frames", value=60)
    about, before = shown.table()
    assert any("repeats this run" in line for line in about)
    assert any("--seed 1" in line and "molecules=250" in line for line in about)
    slider = shown.page.locator("input[type=range][name=temperature]")
    slider.fill("300")
    slider.dispatch_event("change")
    shown.ask(type="frames", value=160)
    about, after = shown.table()
    assert not any("repeats this run" in line for line in about)
    assert any(line.startswith("# after frame 60, at ") and line.endswith("temperature = 300 degC") for line in about)
    assert after["wall_temperature[z_low]"][-1] == pytest.approx(573.15)
    # 40 frames of 250 molecules scatter by less than 20 K, whatever their correlation
    assert before["air_temperature"][-20:].mean() == pytest.approx(298.15, abs=30.0)
    assert after["air_temperature"][-40:].mean() == pytest.approx(573.15, abs=60.0)
    assert after["air_temperature_theory"][-1] == pytest.approx(573.15)
    frame = bytes(shown.page.evaluate("Array.from(window.frame)"))
    fastest = float(np.frombuffer(frame, "<f4", 1, 28)[0])
    assert fastest == 1500.0  # three thermal speeds of air of 573 K are 1217 m/s
    assert shown.page.locator("#legend .ends span").last.inner_text() == "1500"
    speed = np.frombuffer(frame, np.uint8, 250, 32 + 6 * 250) / 255.0 * fastest
    assert np.mean(speed**2) == pytest.approx(3.0 * 8.314 * 573.15 / 0.02897, rel=0.3)


def test_a_pool_that_is_covered_by_hand_has_the_bytes_of_one_that_python_covers(lab):
    settings = {"molecules": 300, "pool": 60}
    shown = lab("evaporation", settings)
    setup = build(prepare("evaporation", settings))
    left = []
    for first, share in ((0, 100.0), (30, 0.0), (60, 100.0)):
        shown.ask(type="set", name="open_pool", value=share)
        shown.ask(type="frames", value=first + 30)
        setup.knobs[1].set(share)
        advance(setup, first + 30, first)
        left.append(setup.parcel.evaporated)
    assert 0 < left[0] == left[1] < left[2]
    assert shown.digest() == state_of(setup.parcel)
    _, table = shown.table()
    assert (table["evaporation_rate"][30:60] == 0.0).all()
    assert (table["pool_open_share"][30:60] == 0.0).all()
    assert (table["condensation_rate_theory"][30:60] == 0.0).all()


def test_other_numbers_of_molecules_and_presets_begin_the_runs_that_python_begins_with_them(lab):
    shown = lab("elastic-collisions", {"molecules": 40, "seed": 3}, others=True)
    first = shown.digest()

    def runs_as_python_with(**settings):
        shown.ask(type="frames", value=10)
        setup = build(prepare("elastic-collisions", {"seed": 3, **settings}))
        advance(setup, 10)
        assert setup.parcel.contacts > 5
        assert shown.digest() == state_of(setup.parcel)
        about, table = shown.table()
        assert len(table) == 10
        return about[0]

    def choose(value):
        shown.page.locator("select", has=shown.page.locator(f"option[value='{value}']")).select_option(value)

    choose("160")
    assert "molecules=160" in runs_as_python_with(molecules=160)
    shown.ask(type="set", name="molecules", value="123")
    assert "10, 20, 40, 80, 160" in shown.note()
    choose("80")
    choose("21 %")  # there is a start with both
    told = shown.page.locator("#notes .note", has_text="the other settings are back at their first values")
    assert told.count() == 0
    assert "molecules=80 --set filling=21" in runs_as_python_with(molecules=80, filling=21)
    choose("5")  # with that seed there is only a start with the page's own numbers
    told.wait_for(timeout=5_000)
    assert runs_as_python_with(molecules=40, seed=5).endswith("molecules=40 --seed 5")
    presets = shown.page.locator("#presets")
    presets.select_option(label="Boulders among pebbles")
    assert "mass_ratio=1000" in runs_as_python_with(molecules=40, mass_ratio=1000)
    presets.select_option(label="as the page was written")
    assert shown.digest() == first


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("temperature", {"molecules": 150}),
        pytest.param("attraction", {"molecules": 150}, marks=pytest.mark.nightly),
        pytest.param("diffusion", {"molecules": 1001}, marks=pytest.mark.nightly),
        pytest.param("atmosphere", {"molecules": 500, "plane": True}, marks=pytest.mark.nightly),
    ],
)
def test_another_seed_begins_the_run_that_python_begins_with_it(lab, scene, settings):
    shown = lab(scene, settings)
    first = shown.digest()
    for seed in (7, 2**53 - 1):
        shown.page.fill("#seed", str(seed))
        shown.page.click("#reset")
        shown.until(lambda seed=seed: f"seed {seed}" in shown.page.locator("#caption").text_content())
        shown.ask(type="frames", value=4)
        setup = build(prepare(scene, settings | {"seed": seed}))
        advance(setup, 4)
        assert shown.digest() == state_of(setup.parcel)
    about, _ = shown.table()
    assert about[0].endswith(f"--seed {seed}")
    shown.page.fill("#seed", str(2**53))
    shown.page.click("#reset")
    assert "9007199254740991" in shown.note()
    shown.page.fill("#seed", "1")
    shown.page.click("#reset")
    assert shown.digest() == first


def test_undo_takes_the_knob_back_and_reset_begins_the_same_run(lab):
    shown = lab("temperature", {"molecules": 50})
    shown.ask(type="frames", value=20)
    first = shown.digest()
    shown.ask(type="set", name="temperature", value=400)
    shown.ask(type="frames", value=40)
    assert shown.digest() != first
    shown.ask(type="undo")
    slider = shown.page.locator("input[type=range][name=temperature]")
    shown.until(lambda: slider.input_value() == "25")
    shown.page.click("#reset")
    shown.ask(type="frames", value=20)
    assert shown.digest() == first


def test_a_value_that_is_not_possible_is_refused_in_a_sentence_and_changes_nothing(lab):
    shown = lab("temperature", {"molecules": 20})
    before = shown.digest()
    for value in ("1e9", "", "warm"):
        shown.ask(type="set", name="temperature", value=value)
        assert "-200 to 500 degC" in shown.note().replace("−", "-")
        assert shown.digest() == before


def test_a_knob_has_the_name_beside_it_owns_its_keys_and_keeps_its_value_when_its_field_is_emptied(lab):
    shown = lab("temperature", {"molecules": 50})
    page = shown.page
    slider, field = (page.get_by_role(role, name="temperature of the walls") for role in ("slider", "spinbutton"))
    slider.focus()
    before = page.locator("body").get_attribute("data-time"), page.locator("#pace").inner_text()
    for key, value in (("ArrowRight", "26"), ("ArrowUp", "27"), ("ArrowDown", "26"), ("ArrowLeft", "25")):
        page.keyboard.press(key)
        assert (slider.input_value(), field.input_value()) == (value, value), key
    assert (page.locator("body").get_attribute("data-time"), page.locator("#pace").inner_text()) == before
    field.fill("")
    field.press("Tab")
    assert field.input_value() == "25"
    assert shown.note().startswith("i\ntemperature of the walls: type a number.")
    field.fill("600")
    field.press("Tab")
    assert field.input_value() == "25"
    page.locator("#notes .note", has_text="a number from −200 to 500 °C").wait_for(timeout=5_000)
    for seed in ("-3", "1.5", ""):
        page.fill("#seed", seed)
        page.click("#reset")
        assert page.locator("#seed").input_value() == "1"
    page.locator("#notes .note", has_text="whole number from 0").first.wait_for(timeout=5_000)
    assert {page.locator(name).get_attribute("aria-live") for name in ("#time", "#vitals")} == {"off"}
    page.keyboard.press("?")
    keys = page.locator("#sheet").inner_text()
    assert "Shift" not in keys
    assert "←" not in keys
    assert "graph" not in keys
    assert "by kind" not in keys  # there is one kind of molecule
    page.keyboard.press("Escape")


def test_a_saved_table_names_its_units_and_the_frames_that_its_command_repeats(lab, tmp_path, monkeypatch):
    shown = lab("temperature", {"molecules": 50, "duration": "2 ns"})
    frames = build(prepare("temperature", {"molecules": 50, "duration": "2 ns"})).frames
    shown.ask(type="frames", value=frames + 3)
    about, table = shown.table()
    assert about[1] == f"# repeats the first {frames} frames of this run"
    assert "elapsed_time [ns], air_temperature [K], air_pressure [Pa], collision_count [1]" in about[-1]
    monkeypatch.chdir(tmp_path)
    program, *words = shlex.split(about[0][2:])
    assert program == "atmosbox"
    assert typed(*words, "--out", "run.nc").exit_code == 0
    np.testing.assert_array_equal(read("run.nc").collision_count, table["collision_count"][:frames])


@pytest.mark.nightly
def test_a_box_that_runs_for_long_takes_no_more_memory(lab):
    shown = lab("temperature", {"molecules": 20, "duration": "20 ns"})
    sizes = []
    for frames in (5_000, 10_000, 15_000, 20_000):
        shown.ask(type="frames", value=frames)
        shown.digest()  # answers when the frames are through
        shown.page.evaluate("window.gc?.()")
        sizes.append(shown.page.evaluate("performance.memory.usedJSHeapSize"))
    assert sizes[-1] < 1.5 * sizes[0] + 5e6
    # the memory of the engine is fixed; only the series could grow, and every second point of them is dropped
    about, table = shown.table()
    assert len(table) <= 4_000
    assert "# every 8th frame" in about


TASKS = {
    "temperature": ({}, {"temperature": 323}, 300),
    "temperature-large": ({"molecules": 400}, {"temperature": 398}, 300),
    "elastic-collisions": ({"molecules": 60}, {"presets": "A crowded table"}, 205),
    "diffusion": ({"molecules": 1000}, {"presets": "Hot gases"}, 60),
    "atmosphere": ({"molecules": 1500}, {"temperature": 410}, 120),
    "lifting-dry": ({"molecules": 400}, {"altitude": 4.6}, 40),
    "convection": ({}, {"gravity": 36}, 110),
    "evaporation": ({}, {"temperature": 36}, 250),
    "condensation": ({}, {"temperature": 9.7}, 200),
    "nuclei": ({}, {"presets": "Water without surface tension"}, 20),
    "lifting-moist": ({}, {"altitude": 4.3}, 60),
    "lifting-sounding": ({}, {"altitude": 5.8}, 70),
    "mountains": ({}, {"way": 67}, 110),
    "attraction": ({}, {"temperature": 70}, 150),
}
"""For each scene the settings, the knobs to turn after 10 frames, and the frames after which its task is done."""
FLUCTUATING = {"temperature", "temperature-large", "atmosphere", "convection"}
FLUCTUATING |= {"evaporation", "condensation", "attraction"}
"""In these scenes a task is about a mean over time."""


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(name, marks=() if name in ("temperature", "elastic-collisions") else pytest.mark.nightly)
        for name in TASKS
    ],
)
def test_a_task_is_done_with_the_controls_of_the_page_and_the_page_says_so(lab, scene):
    settings, turns, frames = TASKS[scene]
    shown = lab(scene, settings, others="presets" in turns)
    page = shown.page
    shown.ask(type="frames", value=10)
    assert page.locator(".task.reached").count() == 0
    for name, value in turns.items():
        if name == "presets":
            page.locator("#presets").select_option(label=value)
        else:
            page.locator(f"input[name={name}] + input").fill(str(value))
            page.locator(f"input[name={name}] + input").press("Enter")
    shown.ask(type="frames", value=frames)
    page.locator(".task.reached").wait_for(timeout=120_000)
    said = page.locator(".task .done").inner_text()
    assert said.startswith("Reached: ")
    assert ("mean of the last" in said) == (scene in FLUCTUATING)


def test_a_question_is_answered_in_the_language_that_is_chosen_and_the_box_goes_on(lab):
    shown = lab("temperature", {"molecules": 50})
    page = shown.page
    shown.ask(type="frames", value=30)
    before = shown.digest()
    title = page.locator(".graph strong").first
    assert title.inner_text() == "Temperature"  # its title tells the result
    page.get_by_role("button", name="doubles").click()
    assert title.inner_text() == "Molecules reach the temperature of the walls"
    assert page.locator(".predict .why").inner_text().startswith("No. Pressure is proportional")
    page.select_option("#language", "de")
    shown.until(lambda: page.locator(".predict .why").inner_text().startswith("Nein. Der Druck ist proportional"))
    assert page.get_by_role("slider", name="Temperatur der Wände").count() == 1
    assert page.locator("#play").get_attribute("aria-label") == "abspielen"
    assert shown.digest() == before
    assert len(shown.table()[1]) == 30
    page.select_option("#language", "en")


@pytest.mark.nightly
def test_what_is_measured_can_be_heard(lab):
    page = lab("temperature", {"molecules": 50}).page
    page.click("#play")
    page.locator("#gauges output").first.wait_for(timeout=10_000)
    assert page.get_by_role("group", name="what is measured now").count() == 1
    page.keyboard.press("m")
    heard = page.locator("#voice").inner_text()
    assert re.fullmatch(r"[\d.]+ ns: temperature −?[\d.]+ ±\s34 °C, pressure \d+ hPa", heard)


def test_a_thermometer_tells_its_scatter_and_why_and_means_stand_beside_theory(lab):
    shown = lab("temperature", {"molecules": 200})
    page = shown.page
    shown.ask(type="frames", value=400)
    page.locator(".thermometer .spread", has_text="± 17 °C").wait_for(timeout=10_000)  # 298 K times the root of 2/600
    page.locator(".thermometer").click()
    assert "only 200 of them it changes by about 17 K" in shown.note()
    said = page.locator(".graph .sentences", has_text="theory").first
    mean, error = re.fullmatch(
        r"([\d.]+) ± ([\d.]+) °C mean since the start \(theory 25.0\d?\) ?", said.inner_text()
    ).groups()
    assert float(mean) == pytest.approx(25.0, abs=4.0 * float(error))
    assert 0.2 < float(error) < 3.0
    _, table = shown.table()
    now, lasted = re.fullmatch(
        r"Now: ([\d.]+) hPa \(mean of the last ([\d.]+) ns\)\.", page.locator(".verdict").inner_text()
    ).groups()
    assert float(now) == pytest.approx(table["air_pressure"][-100:].mean() / 100.0, abs=0.6)
    assert float(lasted) == pytest.approx(table["elapsed_time"][-1] - table["elapsed_time"][-101], rel=0.03)
    shown.ask(type="set", name="temperature", value=225.0)
    shown.ask(type="frames", value=900)
    page.locator(".graph .sentences", has_text="mean since the last change (theory 225").wait_for(timeout=20_000)
    page.locator(".term", has_text="n k T").click()
    page.locator("#notes .note", has_text="molecules need room").wait_for(timeout=5_000)


KEEPS_TEXTS = """() => {
  window.texts = new Set();
  const canvas = CanvasRenderingContext2D.prototype, write = canvas.fillText;
  canvas.fillText = function (text, ...at) { window.texts.add(text); write.call(this, text, ...at); };
}"""


@pytest.mark.parametrize(
    ("scene", "kind", "curves", "texts"),
    [
        ("lifting-sounding", "skewt", ["environment", "dewpoint"], {"27 °C", "1000 hPa", "0.0 km"}),
        ("lifting-moist", "profile", ["without condensation", "environment"], {"cloud base", "start", "25 °C"}),
    ],
)
def test_the_air_around_a_parcel_and_its_start_are_drawn_before_it_moves(lab, scene, kind, curves, texts):
    page = lab(scene, SMALL[scene][0]).page
    page.evaluate(KEEPS_TEXTS)
    page.click("#theme")  # all graphs are drawn again
    page.wait_for_function("(wanted) => wanted.every((text) => window.texts.has(text))", arg=sorted(texts))
    assert page.locator(f".graph.{kind} .key").first.locator("span").all_inner_texts() == curves


def _drawn_anew(page):
    """Return the texts of all graphs, which are drawn again."""
    page.evaluate("window.texts.clear()")
    page.click("#theme")
    page.wait_for_function("window.texts.size > 5")
    page.wait_for_timeout(400)
    return page.evaluate("[...window.texts]")


@pytest.mark.parametrize(
    "scene",
    ["lifting-moist", *(pytest.param(name, marks=pytest.mark.nightly) for name in ("lifting-dry", "mountains"))],
)
def test_at_the_end_of_an_ascent_gauges_task_and_picture_show_its_last_frame(lab, scene):
    shown = lab(scene, SMALL[scene][0])
    page = shown.page
    page.evaluate(KEEPS_TEXTS)
    shown.ask(type="pace", value=16)
    page.click("#play")
    page.locator("#vitals", has_text="the run is over").wait_for(timeout=60_000)
    page.wait_for_timeout(400)
    _, table = shown.table()
    kelvin, pascal, metre = (table[f"parcel_{name}"][-1] for name in ("temperature", "pressure", "height"))

    def near(text, value, unit, decimals):
        """Return whether a text is the value with these decimals, or the next one, because halves may be rounded up."""
        told = re.fullmatch(rf"(−?[\d.]+) {unit}", text)
        return told and abs(float(told[1].replace("−", "-")) - value) < 0.51 * 10.0**-decimals

    read = [page.locator(f".{name}").inner_text().split("\n") for name in ("thermometer", "barometer")]
    assert near(" ".join(read[0][1:]), kelvin - 273.15, "°C", 1)
    assert near(" ".join(read[1][1:]), pascal / 100.0, "hPa", 0)
    said = page.locator(".verdict").inner_text().removeprefix("Now: ").removesuffix(".")
    assert near(said, metre / 1000.0, "km", 2) if scene == "mountains" else near(said, kelvin - 273.15, "°C", 1)
    for key in page.locator(".key").all():  # curves of one label look alike
        labels = key.locator(":scope > span").all_inner_texts()
        assert len(set(labels)) == len(labels)
    texts = _drawn_anew(page)
    for value, unit, decimals in ((kelvin - 273.15, "°C", 0), (pascal / 100.0, "hPa", 0), (metre / 1000.0, "km", 1)):
        assert any(near(text, value, unit, decimals) for text in texts), (value, texts)


def test_named_guides_are_hidden_while_a_prediction_is_drawn_and_once_a_knob_is_turned(lab):
    page = lab("lifting-moist", SMALL["lifting-moist"][0]).page
    page.evaluate(KEEPS_TEXTS)
    assert "cloud base" in _drawn_anew(page)
    page.get_by_role("button", name="Draw your prediction").click()
    assert "cloud base" not in _drawn_anew(page)
    shown = lab("atmosphere", {"molecules": 1000})
    shown.ask(type="frames", value=2)
    shown.page.evaluate(KEEPS_TEXTS)
    for gravity, count in ((9.80665, 3), (1.62, 0), (9.80665, 3)):
        shown.ask(type="set", name="gravity", value=gravity)
        shown.digest()  # by then the engine has told the page
        assert sum(" % below " in text for text in _drawn_anew(shown.page)) == count, gravity


def test_profiles_are_drawn_faint_while_a_column_settles(lab):
    settle = build(prepare("atmosphere", {"molecules": 1000})).settle
    shown = lab("atmosphere", {"molecules": 1000})
    keys = shown.page.locator(".graph.profile .key")
    assert keys.first.inner_text() == ""
    for frames, label in (
        (2, "molecules\u00a0(settling)"),
        (settle, "molecules\u00a0(settling)"),
        (settle + 1, "molecules"),
    ):
        shown.ask(type="frames", value=frames)
        shown.digest()  # by then the engine has told the page
        shown.page.wait_for_timeout(400)
        assert [label in key.locator("span").all_text_contents() for key in keys.all()] == [True, True], frames
