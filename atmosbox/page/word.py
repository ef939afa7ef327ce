"""The texts of a page: the story, the settings and their differences, and notes on what the picture leaves out."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.file.molecules import Molecules
from atmosbox.file.provenance import parameters
from atmosbox.page.stage import length_text
from atmosbox.scene.conversion import phrase, spelled

if TYPE_CHECKING:
    import xarray as xr

_FAR = 0.15  # share of the box; if molecules fly farther between two frames, the page says so
_NEAR = 0.03  # share of the box that molecules fly between two frames of a run that shows their collisions
_PARTS = {"Modelled": "modelled", "Prescribed": "prescribed", "Left out": "left_out", "Exaggerated": "exaggerated"}
"""The parts of a model card, as its docstring and as the page name them."""


def card_of(text: str) -> dict[str, str]:
    """Return what the docstring of a scene says of its model, in the parts of `_PARTS` that there are.

    >>> card_of("Warmth. Modelled: spheres. Left out: rain, wind.")
    {'modelled': 'Spheres.', 'left_out': 'Rain, wind.'}
    """
    card = {}
    for paragraph in text.strip().split("\n\n"):
        _, *parts = re.split(rf"\b({'|'.join(_PARTS)})(?:: | (?=are ))", " ".join(paragraph.replace("`", "").split()))
        for name, words in zip(parts[::2], parts[1::2], strict=True):
            said = words.removeprefix("are ").strip()
            card[_PARTS[name]] = said[:1].upper() + said[1:]
    return card


def story_of(dataset: xr.Dataset) -> str:
    """Return what a scene is about: its model card up to the word "Modelled"."""
    return str(dataset.attrs.get("comment", "")).partition(" Modelled:")[0].strip()


def settings_of(dataset: xr.Dataset) -> list[tuple[str, str]]:
    """Return the settings of a run as text, with their units if the scene comes with atmosbox."""
    made = parameters(dataset)
    units = _units(str(made.get("scene", "")))
    return [
        (name.replace("_", " "), _said(value, units.get(name, ""))) for name, value in made.get("settings", {}).items()
    ]


def changed(runs: Sequence[xr.Dataset]) -> list[str]:
    """Return a heading for each run that names only what differs between the runs.

    Runs of different scenes have the titles of their scenes; runs that do not differ are numbered.
    """
    made = [parameters(run) for run in runs]
    told = [
        {"scene": str(one.get("scene", "")), **dict(settings_of(run)), "engine": str(one.get("engine", "exact"))}
        for one, run in zip(made, runs, strict=True)
    ]
    known = dict.fromkeys(name for each in told for name in each)
    if len({each["scene"] for each in told}) > 1:
        return [str(run.attrs.get("title", each["scene"])) for run, each in zip(runs, told, strict=True)]
    different = [name for name in known if len({each.get(name) for each in told}) > 1]
    headings = [" · ".join(f"{name} {each[name]}" for name in different if name in each) for each in told]
    return [heading or f"run {number + 1}" for number, heading in enumerate(headings)]


def notes(seen: Molecules, stage: Mapping[str, Any], *, frames: int) -> list[str]:
    """Return sentences on what the picture of a run leaves out or adds; ``stage`` is the record of its stage."""
    found = []
    particle, walls = stage["particle"], stage["box"]["walls"]
    if stage["molecules_shown"] < stage["molecules"]:
        found.append(f"{stage['molecules_shown']} of the {stage['molecules']} {particle}s are drawn.")
    if frames < len(seen.time):
        found.append(f"{frames} of the {len(seen.time)} frames are drawn; the graphs have all of them.")
    far, of_side = _flight(seen)
    if of_side > _FAR:
        found.append(
            f"From frame to frame a {particle} flies {length_text(far)}, and is drawn on a straight line: "
            f"its collisions on the way are not seen. {_shorter(seen, stage, of_side)}"
        )
    if walls[4] == "pool":
        found.append("The pool has no depth in the model: the layer drawn is as high as there is water left in it.")
    elif seen.drops is not None:
        wider = dict(stage["settings"]).get("drop size")
        if wider:
            found.append(f"The drops are {wider} times as wide as real ones of so many molecules.")
    elif seen.liquid is not None and np.any(seen.liquid):
        found.append("In the model the mist has no position: it is drawn as clumps at arbitrary places.")
    if seen.rained is not None and np.any(seen.rained):
        found.append("Rain has left the box: it is drawn as a layer on the floor.")
    return found


def _flight(seen: Molecules) -> tuple[float, float]:
    """Return the median distance of a molecule between two frames in the middle of a run [m], and its share of the box.

    That share is relative to the geometric mean of the sides.
    """
    if len(seen.time) < 2 or not seen.position.shape[1]:
        return 0.0, 0.0
    middle = len(seen.time) // 2
    step = np.abs(seen.position[middle] - seen.position[middle - 1])
    step = np.minimum(step, np.where(np.isfinite(step), seen.side[middle] - step, step))  # the shorter way round
    flown = np.linalg.norm(step[np.isfinite(step).all(axis=1)], axis=1)
    far = float(np.median(flown)) if flown.size else 0.0
    return far, far / float(np.exp(np.log(seen.side[middle]).mean()))


def _shorter(seen: Molecules, stage: Mapping[str, Any], of_side: float) -> str:
    """Return a sentence that names a run so short that its frames show the collisions."""
    unit = stage["time"]["unit"]
    number, _, own = dict(stage["settings"]).get("duration", "").partition(" ")
    if own != unit or not number:
        return "A shorter run shows them."
    short = float(seen.time[-1]) * _NEAR / of_side
    return f"A run with duration={float(f'{short:.1g}'):g}{unit} shows them."


def _units(scene: str) -> dict[str, str]:
    """Return the units of the settings of a scene that comes with atmosbox; none for a user's own scene."""
    from atmosbox import scenarios

    if scene not in scenarios.names():
        return {}
    return {parameter.name: parameter.unit for parameter in scenarios.load(scene).Settings.describe()}


def _said(value: object, unit: str) -> str:
    """Return the value of a setting with its unit as text.

    >>> _said(9.81, "m s-2"), _said(-5.0, "degC"), _said(True, ""), _said("warm", "")
    ('9.81 m/s²', '−5 °C', 'on', 'warm')
    """
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, int | float):
        return phrase(value, spelled(unit)).replace("-", "\u2212")
    return str(value)
