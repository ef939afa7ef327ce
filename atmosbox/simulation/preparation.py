"""A scenario made ready to run: loaded, from its settings or from a link, its settings checked, its box built."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any, NamedTuple
from urllib.parse import quote

from atmosbox import scenarios
from atmosbox.engine import PackingError as EnginePackingError
from atmosbox.engine import RefusedError
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.errors import AtmosboxError, Command, EngineError, FileError, Option, PackingError, SettingError, shown
from atmosbox.scene.engines import EXACT, EngineChoice, choose
from atmosbox.scene.instruments import Discs
from atmosbox.scene.settings import Parameter, SceneSettings
from atmosbox.scene.setup import Setup
from atmosbox.scene.spelling import field_name
from atmosbox.simulation import accuracy as accuracies
from atmosbox.simulation.accuracy import Expectation
from atmosbox.simulation.link import Replay, read_link, refuse
from atmosbox.version import __version__

_MEMORY = 8e9  # bytes that saved molecules may need
_SMALL = 10e6  # bytes up to which the molecules are saved unasked


@dataclass(frozen=True)
class Prepared:
    """A scenario with its settings, checked and ready to run."""

    scene: str
    module: ModuleType
    settings: SceneSettings
    save_molecules: bool | None = False
    """None: if they take little space, see `keeps_molecules`."""
    engine: EngineChoice = EXACT
    expectation: Expectation | None = None
    stated: Mapping[str, Any] | None = None
    """For a resumed run, the errors that were expected when it began."""
    replay: Replay | None = None
    """For the run of a link, how long it is, and the turns of its knobs."""

    @property
    def unusual_engine(self) -> str:
        """The engine with its options; empty if it is the one on which the scene runs by default.

        >>> prepare("temperature", {}).unusual_engine, prepare("temperature", {}, engine="dsmc").unusual_engine
        ('', 'dsmc')
        """
        return "" if self.engine == usual_engine(self.module, self.settings) else str(self.engine)

    @property
    def parameters(self) -> dict[str, Any]:
        """All values that determine the run, and its expected errors, as JSON can hold them."""
        expected = self.stated if self.expectation is None else self.expectation.as_dict()
        known = {} if expected is None else {"accuracy": expected}
        made: dict[str, Any] = {"scene": self.scene, "settings": self.settings.as_dict(), "engine": str(self.engine)}
        made |= {"version": __version__, "save_molecules": self.save_molecules}
        return {**made, **known, **({} if self.replay is None else {"replay": self.replay.link})}

    def frames(self, setup: Setup) -> int:
        """Return the number of frames of the run: those of the scene, or of the link."""
        return setup.frames if self.replay is None else self.replay.length(setup)


class Card(NamedTuple):
    """The model card of a scene."""

    scene: str
    title: str
    story: str
    facts: tuple[tuple[str, str], ...]
    parameters: tuple[Parameter, ...]


def prepare(
    scene: str | os.PathLike[str],
    settings: Mapping[str, Any],
    *,
    engine: str | EngineChoice | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = False,
) -> Prepared:
    """Load a scenario and check its settings, or raise an AtmosboxError; nothing is simulated yet.

    Parameters
    ----------
    scene, settings
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own; values by name, numbers in the
        documented unit or texts with a unit.
    engine
        The engine with its options, such as ``stepped:delta=0.02``; None for that of the scene, see `usual_engine`.
    accuracy
        A target, as `atmosbox.simulation.accuracy.parse` reads it. It chooses the engine and the settings that trade
        accuracy for time; values in `settings` are not changed.
    save_molecules
        Whether position and velocity of all molecules are saved in every frame; None if they take less than 10 MB.

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
        why = getattr(module, "not_measured", "whose errors were not measured")
        picked = accuracies.choose(name, accuracy, checked.changed(), why=why)
        given = {field_name(setting) for setting in settings}
        sets = {name: value for name, value in picked.sets.items() if name not in given}
        checked = module.Settings.from_user({**checked.as_dict(), **sets})
        engine = picked.way.engine
    chosen = usual_engine(module, checked) if engine is None else choose(engine)
    if chosen != EXACT and not _takes_engine(module):
        raise SettingError(
            "engine", str(chosen), f"is not for the scene {os.fspath(scene)}, whose build takes no engine",
            Option("engine", EXACT.name), ", or let its build take one: build(settings, engine)"
        )  # fmt: skip
    expectation = None
    if accuracy is not None:
        expectation = picked.at(checked.changed())
    elif chosen != usual_engine(module, checked):
        expectation = accuracies.expect(name, str(chosen), checked.changed())
    return Prepared(name, module, checked, save_molecules, chosen, expectation)


def agreed(
    scene: str | os.PathLike[str] | None, named: str, source: str, option: str, error: type[AtmosboxError] = FileError
) -> str:
    """Return the scene, which a user and a file, `source`, must not name differently.

    A file alone never makes atmosbox run a program: the path of a user's own scene must be typed.
    """
    typed = os.fspath(scene or named)
    if not scene and scenarios.is_path(named):
        problem = f"{source} is for the scene in the file {named}, which must be typed"
        raise error(problem, Command("run", (named, Option(option, source))))
    by_name = named and not scenarios.is_path(named) and not scenarios.is_path(typed)
    if by_name and typed.replace("_", "-") != named.replace("_", "-"):
        raise error(f"{source} is for the scene {named}, not for {scene}: leave one of them out.")
    return typed


def card(prepared: Prepared) -> Card:
    """Return the model card: the description, the facts for these settings, the parameters.

    >>> dict(card(prepare("lifting-dry", {"molecules": 100})).facts)["gamma"]
    '7/5'
    """
    if not prepared.unusual_engine and prepared.scene in scenarios.names():
        # a scene that comes with atmosbox is known to start in a valid state; one of a user's own is built to check it
        prepared = replace(prepared, engine=replace(prepared.engine, described=True))
    setup = build(prepared)
    story = (prepared.module.__doc__ or "").strip()
    title = getattr(prepared.module, "title", prepared.scene)
    return Card(prepared.scene, title, story, tuple(setup.facts.items()), tuple(prepared.settings.describe()))


def usual_engine(module: ModuleType, settings: SceneSettings) -> EngineChoice:
    """Return the engine on which a scene runs unless the user names another.

    It is the exact one, unless the scene has a function ``usual_engine`` of its settings that names another.

    >>> str(prepare("atmosphere", {}).engine).partition(":")[0]
    'dsmc'
    """
    own = getattr(module, "usual_engine", None)
    return EXACT if own is None else choose(own(settings))


def _takes_engine(module: ModuleType) -> bool:
    """Return whether a scene can run on another engine than the exact one."""
    return "engine" in inspect.signature(module.build).parameters


def build(prepared: Prepared) -> Setup:
    """Return the box of a scenario at its start."""
    try:
        engine = [prepared.engine] if _takes_engine(prepared.module) else []
        setup: Setup = prepared.module.build(prepared.settings, *engine)
        if not isinstance(setup, Setup):
            raise TypeError(f"build returns a {type(setup).__name__}, and not a Setup")
        if isinstance(setup.parcel, MarchingParcel):
            setup.parcel.divide(setup.frame / setup.samples)
    except EnginePackingError as error:
        molecules = getattr(prepared.settings, "molecules", None)
        raise PackingError("molecules", molecules, "do not fit", str(error)) from error
    except (RefusedError, ValueError) as error:
        if isinstance(error, SettingError):
            raise
        if prepared.engine.name != EXACT.name:
            problem = f"cannot do {prepared.scene} ({error})"
            raise SettingError("engine", str(prepared.engine), problem, Option("engine", EXACT.name)) from error
        where = scenarios.place(error)
        box = f"The box of {prepared.scene}" if where is None else f"{where}: the box"
        raise EngineError(f"{box} cannot be built: {error}.") from error
    if prepared.save_molecules:
        needed = _space(prepared, setup)
        if needed > _MEMORY:
            raise SettingError(
                "molecules", setup.parcel.present.size,
                f"saved in {prepared.frames(setup)} frames would take {needed / 1e9:.0f} GB",
                "leave out ", Option("save_molecules", True), ", or take fewer molecules"
            )  # fmt: skip
    return setup


def _space(prepared: Prepared, setup: Setup) -> float:
    """Return the space that all molecules of a run take: position, velocity and speed in single precision."""
    return 28.0 * setup.parcel.present.size * prepared.frames(setup)


def keeps_molecules(prepared: Prepared, setup: Setup) -> bool:
    """Return whether a run saves its molecules: as asked for, or else if they take less than 10 MB.

    Discs are saved in any case, by their own instrument.
    """
    if prepared.save_molecules is not None:
        return prepared.save_molecules
    return _space(prepared, setup) < _SMALL and not any(isinstance(each, Discs) for each in setup.instruments)


def link_start(prepared: Prepared) -> str:
    """Return the part of a link that a run without a turned knob has: all but the seed and the number of frames.

    >>> link_start(prepare("temperature", {"molecules": 400, "seed": 7})).partition("&")[2]
    'scene=temperature&molecules=400'
    """
    changed = {name: value for name, value in prepared.settings.changed().items() if name != "seed"}
    pairs = {"atmosbox": __version__, "scene": os.path.basename(prepared.scene), **changed}
    return "&".join(f"{name}={quote(str(value), safe='')}" for name, value in pairs.items())


def replayed(
    text: str, scene: str | os.PathLike[str] | None = None, *, save_molecules: bool | None = False
) -> Prepared:
    """Return the scene of a link, ready to run as the page ran it.

    `scene` is its path if it is one of your own: a link alone never makes atmosbox run a program.

    >>> replayed(f"#atmosbox={__version__}&scene=temperature&molecules=40&seed=7&frames=90&end").settings.molecules
    40
    """
    named, settings, replay = read_link(text)
    if scene is None and named not in scenarios.names():
        own = Command("run", (named, Option("replay", "LINK"))) if named.endswith(".py") else Command("list")
        why = "of your own, whose file must be typed" if named.endswith(".py") else "that there is not"
        raise SettingError("replay", text, f"is for a scene {why}, {shown(named)}", own)
    if scene is not None and os.path.basename(scene).replace("_", "-") != named.replace("_", "-"):
        raise SettingError("replay", text, f"is for the scene {shown(named)}, not for {scene}", "leave one of them out")
    typed = named if scene is None else scene
    for told in scenarios.load(typed).Settings.describe():
        if told.kind == "str" and not told.choices and settings.get(told.name, told.default) != told.default:
            refuse(text, f"names a file, {told.name} = {shown(settings[told.name])}, which a link must not")
    prepared = prepare(typed, settings, engine="exact", save_molecules=save_molecules)
    return replace(prepared, replay=replay)
