"""What a class changes by hand: knobs while a box runs, and settings and engine with which it begins anew."""

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
from atmosbox.scene.parameter import Value
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared, usual_engine

__all__ = ["MOST_CHANGES", "Hand", "begun_anew", "meeting", "with_collisions"]

MOST_CHANGES = 5000
"""How many changes are kept: as many as a file can hold."""


class Hand:
    """The knobs of one box.

    Parameters
    ----------
    setup
        The box.

    Attributes
    ----------
    changes
        What was done, in order; a knob turned twice within a frame stands there once.
    turned
        What each knob that was turned says now.

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
        """Return the settings with which a box would begin anew: what the knobs say, and the rest as it was."""
        return {name: self.turned.get(name, value) for name, value in prepared.settings.as_dict().items()}

    def controls(self, prepared: Prepared, setup: Setup) -> tuple[Control, ...]:
        """Return all that can be changed, as it is now."""
        values = prepared.settings.as_dict() | self.turned
        collide = meeting(prepared, setup)
        return controls(setup.knobs, prepared.settings.describe(), values, collisions=collide)

    def turn(self, control: Control, value: Value, experiment: Experiment) -> None:
        """Turn a knob, and note it.

        Raises
        ------
        SettingError
            If the box cannot do it; nothing has changed then.
        """
        try:
            self._knobs[control.name].set(float(value))
        except RefusedError as error:
            said = str(value) if not control.parameter.unit else f"{value} {control.parameter.unit}"
            raise SettingError(control.name, said, f"is not possible ({error})", "give another") from error
        self.turned[control.name] = value
        self._note(control, value, experiment)

    def changes_more(self, control: Control) -> bool:
        """Return whether the first turn of a knob changes more than a value, as one that makes heat baths does."""
        return self._knobs[control.name].leave is not None

    def leave(self, control: Control, experiment: Experiment) -> None:
        """Make the box as it was before a knob was first turned, and note it."""
        self._knobs[control.name].reset()
        del self.turned[control.name]
        self._note(control, None, experiment)

    def _note(self, control: Control, value: Value | None, experiment: Experiment) -> None:
        experiment.begin_averages_anew()
        change = Change(experiment.now, experiment.frame, control.name, value, control.parameter.unit)
        last = self.changes[-1] if self.changes else None
        if last is not None and (last.name, last.frame) == (change.name, change.frame):
            self.changes[-1] = change  # a slider on its way
        else:
            self.changes.append(change)


def meeting(prepared: Prepared, setup: Setup) -> bool | None:
    """Return whether molecules meet; None where that cannot be chosen, for they hit drops, or never meet.

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
    """Return the words that ask for an engine with collisions, or without.

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
    """Return a scene with other settings and another engine; if that is its usual one, the usual one of these settings.

    Raises
    ------
    AtmosboxError
        If one of them is not allowed.

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
