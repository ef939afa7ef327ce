"""Changes by hand: knobs of the running box, and settings and engine with which the box is restarted."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from atmosbox.engine import RefusedError
from atmosbox.errors import SettingError
from atmosbox.live.control import COLLISIONS, Control, controls
from atmosbox.live.experiment import Experiment
from atmosbox.live.tape import Change
from atmosbox.scene.engines import EngineChoice, choose
from atmosbox.scene.settings import Value
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared, usual_engine

__all__ = ["MOST_CHANGES", "Hand", "begun_anew", "meeting", "with_collisions"]

MOST_CHANGES = 5000
"""Largest number of changes that are kept: as many as a file can hold."""


class Hand:
    """The knobs of one box.

    Parameters
    ----------
    setup
        The box.

    Attributes
    ----------
    changes
        The changes in order; a knob that is turned twice within a frame is listed once.
    turned
        The present value of each knob that was turned.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> prepared = prepare("elastic-collisions", {"molecules": 10})
    >>> Hand(prepared.module.build(prepared.settings)).names
    ('speed',)
    """

    def __init__(self, setup: Setup) -> None:
        self._knobs = {knob.name: knob for knob in setup.knobs}
        self.changes: list[Change] = []
        self.turned: dict[str, Value] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the knobs."""
        return tuple(self._knobs)

    @property
    def overflows(self) -> bool:
        """Whether there are more changes than a file can hold."""
        return len(self.changes) > MOST_CHANGES

    def settings(self, prepared: Prepared) -> dict[str, Value]:
        """Return the settings for a restart: the present values of the knobs, and the other settings unchanged."""
        return {name: self.turned.get(name, value) for name, value in prepared.settings.as_dict().items()}

    def controls(self, prepared: Prepared, setup: Setup) -> tuple[Control, ...]:
        """Return all controls with their present values."""
        values = prepared.settings.as_dict() | self.turned
        collide = meeting(prepared, setup)
        return controls(setup.knobs, prepared.settings.describe(), values, collisions=collide)

    def turn(self, control: Control, value: Value, experiment: Experiment) -> None:
        """Turn a knob, and record the change.

        Raises
        ------
        SettingError
            If the box refuses the value; nothing has changed then.
        """
        try:
            self._knobs[control.name].set(float(value))
        except RefusedError as error:
            said = str(value) if not control.parameter.unit else f"{value} {control.parameter.unit}"
            raise SettingError(control.name, said, f"is not possible ({error})", "give another") from error
        self.turned[control.name] = value
        self._note(control, value, experiment)

    def changes_more(self, control: Control) -> bool:
        """Return whether the first turn of a knob changes more than a value, for example makes walls heat baths."""
        return self._knobs[control.name].leave is not None

    def leave(self, control: Control, experiment: Experiment) -> None:
        """Restore the state before a knob was first turned, and record the change."""
        self._knobs[control.name].reset()
        del self.turned[control.name]
        self._note(control, None, experiment)

    def _note(self, control: Control, value: Value | None, experiment: Experiment) -> None:
        experiment.begin_averages_anew()
        change = Change(experiment.now, experiment.frame, control.name, value, control.parameter.unit)
        last = self.changes[-1] if self.changes else None
        if last is not None and (last.name, last.frame) == (change.name, change.frame):
            self.changes[-1] = change  # a slider that is being moved
        else:
            self.changes.append(change)


def meeting(prepared: Prepared, setup: Setup) -> bool | None:
    """Return whether molecules collide; None if that cannot be switched, for they hit drops, or never collide.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> prepared = prepare("temperature", {"molecules": 10})
    >>> meeting(prepared, prepared.module.build(prepared.settings))
    True
    """
    takes_engine = "engine" in inspect.signature(prepared.module.build).parameters
    if hasattr(setup.parcel, "drops") or not takes_engine or not setup.parcel.diameter.any():
        return None
    return prepared.engine.options.get(COLLISIONS) is not False


def with_collisions(engine: EngineChoice, wanted: bool) -> str:
    """Return the text that requests an engine with collisions, or without.

    Examples
    --------
    >>> from atmosbox.scene.engines import EXACT
    >>> with_collisions(EXACT, False), with_collisions(EXACT, True)
    ('exact:collisions=off', 'exact')
    """
    options: dict[str, Any] = {name: value for name, value in engine.options.items() if name != COLLISIONS}
    if not wanted:
        options[COLLISIONS] = False
    return str(replace(engine, options=options))


def begun_anew(prepared: Prepared, values: Mapping[str, Any], engine: str) -> Prepared:
    """Return a scene with other settings and another engine.

    If the engine is the default of the scene, the default engine for the new settings is used.

    Raises
    ------
    AtmosboxError
        If a setting or the engine is not allowed.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> begun_anew(prepare("temperature", {}), {"molecules": 10}, "stepped").settings.molecules
    10
    """
    settings = type(prepared.settings).from_user(dict(values))
    chosen = choose(engine)
    if chosen == usual_engine(prepared.module, prepared.settings):
        chosen = usual_engine(prepared.module, settings)
    return replace(prepared, settings=settings, engine=chosen, expectation=None)
