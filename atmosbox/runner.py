"""Run a scenario: advance, measure, report."""

from __future__ import annotations

import inspect
import json
import math
import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from atmosbox import __version__, scenarios
from atmosbox import accuracy as accuracies
from atmosbox.accuracy import Expectation, ExpectedError
from atmosbox.engine.marching import MarchingParcel
from atmosbox.engine.refusal import PackingError as EnginePackingError
from atmosbox.engine.refusal import RefusedError, StalledError
from atmosbox.engines import EXACT, EngineChoice, choose
from atmosbox.errors import EngineError, FileError, PackingError, SettingError
from atmosbox.headline import Headline
from atmosbox.instruments import Molecules, Readings
from atmosbox.panels import to_json
from atmosbox.parameter import Parameter
from atmosbox.scene import Setup
from atmosbox.settings import SceneSettings

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.checkpoint import Checkpoint

__all__ = [
    "LEDGER_LIMIT",
    "Card",
    "Check",
    "Interrupted",
    "Outcome",
    "Prepared",
    "card",
    "execute",
    "headlines_of",
    "prepare",
    "run",
    "verify",
]

LEDGER_LIMIT = 1e-10
"""By how much, relative to the energy there is or has passed, the ledger of a sound run may fail to close."""

_BREATH = 0.1
_MEMORY = 8e9

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class Prepared:
    """A scenario with its settings, checked and ready to run."""

    scene: str
    module: ModuleType
    settings: SceneSettings
    save_molecules: bool = False
    engine: EngineChoice = EXACT
    expectation: Expectation | None = None

    @property
    def parameters(self) -> dict[str, Any]:
        """Everything that makes the run, and the errors that are expected of it, as JSON can hold it."""
        known = {} if self.expectation is None else {"accuracy": self.expectation.as_dict()}
        return {
            "scene": self.scene,
            "settings": self.settings.as_dict(),
            "engine": str(self.engine),
            "version": __version__,
            "save_molecules": self.save_molecules,
            **known,
        }


class Card(NamedTuple):
    """The model card of a scene."""

    scene: str
    title: str
    story: str
    facts: tuple[tuple[str, str], ...]
    parameters: tuple[Parameter, ...]


class Outcome(NamedTuple):
    """What a run came to."""

    dataset: xr.Dataset
    headlines: tuple[Headline, ...]
    seconds: float
    collisions: int
    ledger: float
    engine_seconds: float
    """Processor time of the engine alone, without instruments and files."""
    made: float
    """Energy that the engine's scheme itself has made, in that of the motion; zero for an engine that keeps it."""
    escaped: int
    """Number of molecules outside the box, or nowhere: zero, or the engine is wrong."""


class Check(NamedTuple):
    """One thing that was verified of a file."""

    name: str
    passed: bool
    sentence: str


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C; ``outcome`` holds the frames that are complete, None if there is none."""

    def __init__(self, outcome: Outcome | None) -> None:
        super().__init__("the run was interrupted")
        self.outcome = outcome


def prepare(
    scene: str | os.PathLike[str],
    settings: Mapping[str, Any],
    *,
    engine: str | EngineChoice | None = None,
    accuracy: str | None = None,
    save_molecules: bool = False,
) -> Prepared:
    """Load a scenario and check its settings; nothing is computed yet.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    settings
        Values by name, numbers in the documented unit or texts with a unit.
    engine
        What lets time pass, with its options: ``stepped:delta=0.02``; ``exact`` if nothing is said.
    accuracy
        A wish that picks the engine and the settings that trade accuracy for time, as `atmosbox.accuracy.parse`
        reads it; what is in `settings` stays as it is.
    save_molecules
        Whether places and speeds of all molecules are kept in every frame.

    Returns
    -------
    Prepared
        What `execute` takes.

    Raises
    ------
    AtmosboxError
        If the scene is unknown or a setting is refused.

    Examples
    --------
    >>> prepare("lifting-dry", {"temperature": "20 degC"}).settings.temperature
    20.0
    """
    module = scenarios.load(scene)
    checked = module.Settings.from_user(settings)
    name = os.fspath(scene).replace("_", "-")
    name = name if name in scenarios.names() else os.fspath(scene)
    if accuracy is not None:
        if engine is not None:
            raise SettingError("accuracy", accuracy, "picks the engine itself", f"leave it out, or the engine {engine}")
        picked = accuracies.choose(name, accuracy, checked.changed())
        own = {setting.strip().replace("-", "_"): value for setting, value in settings.items()}
        checked = module.Settings.from_user({**picked.sets, **own})
        engine = picked.way.engine
    chosen = choose(EXACT if engine is None else engine)
    if chosen.name != EXACT.name and "engine" not in inspect.signature(module.build).parameters:
        raise SettingError(
            "engine", str(chosen), f"is not for the scene {os.fspath(scene)}, whose build takes no engine",
            f"give --engine {EXACT}, or let its build take one: build(settings, engine)",
        )  # fmt: skip
    expectation = None
    if accuracy is not None:
        expectation = picked.at(checked.changed())
    elif chosen.name != EXACT.name:
        expectation = accuracies.expect(name, str(chosen), checked.changed())
    return Prepared(name, module, checked, save_molecules, chosen, expectation)


def card(prepared: Prepared) -> Card:
    """Return the model card: the story, the facts for these settings, the parameters.

    Examples
    --------
    >>> dict(card(prepare("lifting-dry", {"molecules": 100})).facts)["gamma"]
    '7/5'
    """
    setup = build(prepared)
    story = (prepared.module.__doc__ or "").strip()
    title = getattr(prepared.module, "title", prepared.scene)
    return Card(prepared.scene, title, story, tuple(setup.facts.items()), tuple(prepared.settings.describe()))


def build(prepared: Prepared) -> Setup:
    """Build the box, in the words of a user where it cannot be built."""
    try:
        with_engine = "engine" in inspect.signature(prepared.module.build).parameters
        setup: Setup = prepared.module.build(prepared.settings, *([prepared.engine] if with_engine else []))
        if isinstance(setup.parcel, MarchingParcel):
            setup.parcel.divide(setup.frame / setup.samples)
    except EnginePackingError as error:
        molecules = getattr(prepared.settings, "molecules", None)
        raise PackingError("molecules", molecules, "do not fit", str(error)) from error
    except (RefusedError, ValueError) as error:
        if isinstance(error, SettingError):
            raise
        if prepared.engine.name != EXACT.name:
            raise SettingError(
                "engine", str(prepared.engine), f"cannot do {prepared.scene} ({error})", f"give --engine {EXACT}"
            ) from error
        raise EngineError(f"The box of {prepared.scene} cannot be built: {error}.") from error
    if prepared.save_molecules:
        needed = 16.0 * setup.parcel.number * setup.frames
        if needed > _MEMORY:
            raise SettingError(
                "molecules", setup.parcel.number, f"saved in {setup.frames} frames would take {needed / 1e9:.0f} GB",
                "leave out --save-molecules, or take fewer molecules",
            )  # fmt: skip
    return setup


@dataclass
class _Recording:
    """A run under way: its box, its instruments, and the times of its frames."""

    prepared: Prepared
    setup: Setup
    attributes: dict[str, Any]
    times: list[float] = field(default_factory=lambda: [0.0])
    busy: float = 0.0

    def __post_init__(self) -> None:
        extra = (Molecules(),) if self.prepared.save_molecules else ()
        self.instruments = (*self.setup.instruments, *extra)

    @property
    def frames(self) -> int:
        return len(self.times) - 1

    def advance(self, watch: Callable[[float], None]) -> None:
        """Advance by one frame and measure."""
        setup = self.setup
        parcel = setup.parcel
        for sample in range(1, setup.samples + 1):
            until = (self.frames + sample / setup.samples) * setup.frame
            if sample == setup.samples:
                until = (self.frames + 1) * setup.frame
            busy = time.process_time()
            parcel.advance(max(until, parcel.time), watch)
            self.busy += time.process_time() - busy
            snapshot = parcel.snapshot()
            for instrument in self.instruments:
                instrument.look(parcel, snapshot)
        for instrument in self.instruments:
            instrument.close(parcel, snapshot)
        self.times.append(parcel.time)

    def dataset(self, status: str) -> tuple[xr.Dataset, tuple[Headline, ...]]:
        """Return all that has been measured so far, with theory beside it."""
        from atmosbox import diagnostics

        setup, settings, module = self.setup, self.prepared.settings, self.prepared.module
        in_unit = setup.scale.time / {"s": 1.0, "ns": 1e-9, "ps": 1e-12}[setup.time_unit]
        times = np.array(self.times) * in_unit
        readings = Readings()
        settle = min(setup.settle, max(self.frames - 2, 0))
        for instrument in self.instruments:
            readings.update(instrument.readings(setup.scale, settle))
        names = ("height", "height_bnds", "speed", "speed_bnds")
        coords = {name: readings.pop(name) for name in names if name in readings}
        coords["elapsed_time"] = times[1:]
        coords["elapsed_time_bnds"] = np.stack([times[:-1], times[1:]], axis=1)
        attributes = self.attributes | {"atmosbox_status": status}
        measured = diagnostics.dataset(readings, coords, attributes, time_unit=setup.time_unit)
        if self.frames < 2:
            return measured, ()
        answers = module.theory(measured, settings)
        full = diagnostics.dataset(readings | answers, coords, attributes, time_unit=setup.time_unit)
        headlines = _with_bias(module.headlines(full, settings), self.prepared.parameters)
        return diagnostics.dataset(
            readings | answers, coords, attributes, headlines, time_unit=setup.time_unit
        ), headlines


def execute(
    prepared: Prepared,
    *,
    checkpoint: Checkpoint | None = None,
    progress: Progress | None = None,
    command: str = "",
) -> Outcome:
    """Run a prepared scenario.

    Parameters
    ----------
    prepared
        From `prepare`.
    checkpoint
        Keeps what is complete on disk while the run goes on, and writes the finished file.
    progress
        Called with the share that is done and a word on what goes on.
    command
        What the user typed, for the file's history.

    Returns
    -------
    Outcome
        The dataset, its headlines, and what it cost.

    Raises
    ------
    Interrupted
        After Ctrl-C, with the frames that are complete.
    EngineError
        If the engine cannot go on.

    Examples
    --------
    >>> outcome = execute(prepare("elastic-collisions", {"duration": "2 s"}))
    >>> outcome.ledger < LEDGER_LIMIT
    True
    """
    from atmosbox.provenance import global_attributes

    tell = progress or (lambda share, word: None)
    tell(0.0, "compiling the engine, once")
    setup = build(prepared)
    panels = prepared.module.panels
    attributes = global_attributes(
        prepared.parameters,
        title=getattr(prepared.module, "title", prepared.scene),
        command=command or f"atmosbox run {prepared.scene}",
        comment=" ".join((prepared.module.__doc__ or "").split()),
        references=prepared.engine.engine.reference,
        panels=to_json(panels(prepared.settings) if callable(panels) else panels),
        status="partial",
    )
    recording = _Recording(prepared, setup, attributes)
    setup.parcel.advance(0.0)
    last = spent = 0.0

    def watch(now: float) -> None:
        nonlocal last
        if time.perf_counter() - last > _BREATH:
            last = time.perf_counter()
            tell(min(now / setup.duration, 1.0), "running")

    def outcome(status: str) -> Outcome:
        dataset, headlines = recording.dataset(status)
        parcel = setup.parcel
        made = parcel.numerical_heat / (sum(parcel.energy()[:2]) or 1.0)
        return Outcome(
            dataset, headlines, spent, parcel.contacts, parcel.ledger(), recording.busy, made, parcel.escaped()
        )  # fmt: skip

    try:
        while recording.frames < setup.frames:
            began = time.perf_counter()
            recording.advance(watch)
            spent += time.perf_counter() - began
            watch(setup.parcel.time)
            if checkpoint is not None and recording.frames < setup.frames:
                checkpoint(lambda: recording.dataset("partial")[0])
        tell(1.0, "done")
        done = outcome("complete")
    except StalledError as error:
        raise EngineError(f"The run of {prepared.scene} cannot go on: {error}.") from error
    except KeyboardInterrupt:
        partial = outcome("interrupted") if recording.frames else None
        if partial is not None and checkpoint is not None:
            checkpoint.save(partial.dataset)
        raise Interrupted(partial) from None
    if checkpoint is not None:
        checkpoint.finish(done.dataset)
    return done


def run(
    scene: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool = False,
    **settings: Any,
) -> xr.Dataset:
    """Run a scenario and return what it measured.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    out
        Where to write the netCDF file; nothing is written without it. An existing file is never replaced.
    progress
        Called with the share that is done and a word on what goes on.
    engine
        What lets time pass, with its options: ``stepped:delta=0.02``; ``exact`` if nothing is said.
    accuracy
        How accurate the run shall be: ``"sketch"``, ``"lecture"``, ``"reference"``, or the largest error, as ``"0.5K"``
        or ``"2%"``. Picks the engine, and the settings that are not given.
    save_molecules
        Whether places and speeds of all molecules are kept in every frame.
    **settings
        Values by name, numbers in the documented unit or texts with a unit.

    Returns
    -------
    xarray.Dataset
        Everything measured, with theory beside it, in SI units.

    Raises
    ------
    AtmosboxError
        If the scene or a setting is refused, the file cannot be written, or the engine cannot go on.

    Examples
    --------
    >>> box = run("elastic-collisions", duration="2 s", seed=3)
    >>> bool(abs(box.energy_change).max() < 1e-12)
    True
    """
    from atmosbox.checkpoint import Checkpoint
    from atmosbox.output import check_writable

    prepared = prepare(scene, settings, engine=engine, accuracy=accuracy, save_molecules=save_molecules)
    checkpoint = None
    if out is not None:
        check_writable(Path(out))
        checkpoint = Checkpoint(Path(out))
    given = {name: text for name, text in (("engine", engine), ("accuracy", accuracy)) if text is not None} | settings
    words = ", ".join([repr(str(scene)), *(f"{name}={value!r}" for name, value in given.items())])
    return execute(prepared, checkpoint=checkpoint, progress=progress, command=f"atmosbox.run({words})").dataset


def _with_bias(headlines: Iterable[Headline], parameters: Mapping[str, Any]) -> tuple[Headline, ...]:
    """Return headlines that know by how much their approximate engine was measured to be off, at the same settings."""
    known = parameters.get("accuracy")
    if not known or known["differs"] or known["engine"] == str(EXACT):
        return tuple(headlines)
    found = []
    for headline in headlines:
        if headline.name in known["errors"]:
            stated = known["errors"][headline.name]
            error = ExpectedError(*(stated[name] for name in ExpectedError._fields))
            size = error.size(headline.theory)
            headline = replace(headline, bias=size * error.bias, bias_se=size * error.bias_se)
        found.append(headline)
    return tuple(found)


def headlines_of(dataset: xr.Dataset) -> tuple[Headline, ...]:
    """Return the headlines that a dataset carries.

    Raises
    ------
    FileError
        If the file names headlines that it does not hold.

    Examples
    --------
    >>> box = run("elastic-collisions", duration="2 s")
    >>> headlines_of(box)[0].name
    'energy_of_light_discs'
    """
    found = []
    try:
        for name in json.loads(dataset.attrs.get("atmosbox_headlines", "[]")):
            value = dataset[name]
            theory = dataset.get(f"{name}_theory")
            error = dataset.get(f"{name}_se")
            tolerance = dataset.get(f"{name}_tolerance")
            found.append(
                Headline(
                    name,
                    float(value),
                    float(error) if error is not None else 0.0,
                    float(theory) if theory is not None else None,
                    float(tolerance) if tolerance is not None else 0.0,
                    str(value.attrs.get("comment", "")),
                    str(value.attrs["units"]),
                    str(value.attrs.get("display_units", value.attrs["units"])),
                    str(value.attrs["long_name"]),
                )
            )
        return _with_bias(found, json.loads(dataset.attrs.get("atmosbox_parameters", "{}")))
    except (KeyError, ValueError, TypeError) as error:
        raise FileError(f"The headlines of this file cannot be read ({error}): run the scene again.") from error


def verify(dataset: xr.Dataset) -> list[Check]:
    """Check a dataset again: that it is complete, its ledger closes, and theory agrees within error.

    Examples
    --------
    >>> all(check.passed for check in verify(run("elastic-collisions", seed=2)))
    True
    """
    checks = []
    status = str(dataset.attrs.get("atmosbox_status", "unknown"))
    frames = int(dataset.sizes.get("elapsed_time", 0))
    checks.append(Check("complete", status == "complete", f"the run is {status}, with {frames} frames"))
    bad = [
        str(name)
        for name, values in dataset.data_vars.items()
        if values.dtype.kind == "f" and np.isinf(values.values).any()
    ]
    checks.append(Check("finite", not bad, f"infinite numbers in {', '.join(bad)}" if bad else "no number is infinite"))
    if "ledger_residual" in dataset:
        worst = float(np.max(dataset["ledger_residual"].values)) if frames else math.nan
        checks.append(Check("ledger", worst <= LEDGER_LIMIT, f"the energy ledger closes to {worst:.1e}"))
        checks.append(_balance(dataset))
    for headline in headlines_of(dataset):
        if headline.agrees is not None:
            checks.append(
                Check(
                    headline.name,
                    bool(headline.agrees),
                    f"{headline.label}: misfit {headline.misfit:.3g} {headline.unit}, allowed {headline.allowed:.3g}"
                    + (f", for its engine is known to be off by {headline.bias:.3g}" if headline.excused else ""),
                )
            )
    return checks


def _balance(dataset: xr.Dataset) -> Check:
    """Sum the ledger anew from its entries."""
    total = sum(dataset[name].values for name in ("kinetic_energy", "rotational_energy", "potential_energy"))
    heat, work = dataset["heat_from_wall"].values, dataset["work_by_piston"].values
    made = dataset["numerical_heat"].values if "numerical_heat" in dataset else 0.0
    start = total - (heat.sum(axis=1) + work + made)
    scale = np.maximum.reduce([np.abs(total), np.abs(start), np.abs(heat).sum(axis=1) + np.abs(work)])
    worst = float(np.max(np.abs(start - start[0]) / np.where(scale > 0.0, scale, 1.0))) if len(start) else math.nan
    return Check(
        "balance",
        worst <= LEDGER_LIMIT,
        f"energy less heat{', what the scheme made' if np.any(made) else ''} and work is the same in all frames to "
        f"{worst:.1e}",
    )
