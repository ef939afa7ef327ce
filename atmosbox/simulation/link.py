"""The link of a run: its scene, its settings, its seed, and every turn of a knob, in the address of a page.

The page of a scene writes it, and Python runs the same run from it, to the last bit. A link may come from anybody: it
is parsed strictly, holds numbers and names alone, and never names a file or a program::

    #atmosbox=0.2.0&scene=temperature&molecules=400&seed=7&turns=60:temperature:120,90:temperature:start&frames=150&end

Each turn has the number of frames that were complete, the knob, and its new value in the unit of the knob, or "start"
if it went back to how it was before its first turn. ``frames`` is how far the run had come. Before it may stand what a
class predicted, ``predict=air_temperature:-70,-20,10,20,25``: a variable, and five values in the unit of its graph. It
is for the page, and changes nothing here.
"""

from __future__ import annotations

import itertools
import json
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn
from urllib.parse import unquote

from atmosbox.errors import SettingError
from atmosbox.scene.panels import from_json, to_json, without_headlines
from atmosbox.version import __version__

if TYPE_CHECKING:
    from collections.abc import Mapping

    from atmosbox.scene.setup import Setup

_LONGEST = 200_000  # characters
_MOST_TURNS = 5_000
_MOST_FRAMES = 1_000_000
_LINK = re.compile(
    r"atmosbox=(?P<version>[\w.+-]{1,30})&scene=(?P<scene>[\w.%~-]{1,300})(?P<settings>(?:&\w+=[\w.%~-]*)*)"
    r"&seed=(?P<seed>[0-9]{1,16})(?:&turns=(?P<turns>[\w:,.+-]+))?(?:&predict=(?P<prediction>[\w:,.+-]+))?"
    r"&frames=(?P<frames>[0-9]{1,7})&end",
    re.ASCII,
)
_NUMBER = r"-?[0-9]+(?:\.[0-9]+)?(?:e[+-]?[0-9]+)?"
_TURN = re.compile(rf"([0-9]{{1,7}}):(\w+):(start|{_NUMBER})", re.ASCII)
_PREDICTION = re.compile(rf"\w+:{_NUMBER}(?:,{_NUMBER}){{4}}", re.ASCII)


class Turn(NamedTuple):
    """A knob that was turned when a number of frames were complete.

    The value is in the unit of the knob; None if it went back to how it was before its first turn.
    """

    frame: int
    name: str
    value: float | None


@dataclass(frozen=True)
class Replay:
    """What a link says beside scene and settings: the number of frames, 0 for that of the scene, and the turns."""

    link: str
    frames: int
    turns: tuple[Turn, ...]

    def length(self, setup: Setup) -> int:
        """Return the number of frames to run: as many as the page had shown, or those of the scene."""
        last = self.turns[-1].frame + 1 if self.turns else 0
        return self.frames or max(setup.frames, last)

    def check(self, setup: Setup) -> None:
        """Refuse a turn of a knob that the scene does not have, or outside its range."""
        knobs = {knob.name: knob for knob in setup.knobs}
        for turn in self.turns:
            knob = knobs.get(turn.name)
            if knob is None:
                which = f"it has {', '.join(knobs)}" if knobs else "it has none"
                refuse(self.link, f"moves the slider {turn.name}, which the scene does not have ({which})")
            if turn.value is not None and not knob.low <= turn.value <= knob.high:
                allowed = f"{knob.low:g} to {knob.high:g} {knob.unit}".strip()
                refuse(self.link, f"moves {turn.name} to {turn.value:g}, outside its range of {allowed}")

    def attributes(self, setup: Setup, others: Mapping[str, Any]) -> dict[str, Any]:
        """Return the attributes of a file that say which knobs are turned; its panels show no headlines.

        ``others`` are the other attributes of the file.
        """
        knobs, frames = {knob.name: knob for knob in setup.knobs}, self.length(setup)
        each = setup.frame * setup.scale.time / {"s": 1.0, "ns": 1e-9, "ps": 1e-12}[setup.time_unit]
        told = [
            {"frame": t.frame, "elapsed_time": t.frame * each, "time_unit": setup.time_unit, "name": t.name,
             "value": t.value, "unit": knobs[t.name].unit}
            for t in self.turns if t.frame < frames
        ]  # fmt: skip
        if not told:
            return {}
        panels = map(without_headlines, from_json(others["atmosbox_panels"]))
        turned = "Knobs were turned, see atmosbox_turns; averages begin after the last."
        return {
            "atmosbox_turns": json.dumps(told),
            "atmosbox_panels": to_json(panel for panel in panels if panel is not None),
            "comment": f"{turned} {others.get('comment', '')}".rstrip(),
        }


def read_link(text: str) -> tuple[str, dict[str, str], Replay]:
    """Return the scene, the settings and the turns of a link: an address of a page, or its part from ``#`` on.

    A link that was cut off, or is that of another version, is refused.

    >>> link = f"#atmosbox={__version__}&scene=temperature&seed=7&turns=60:temperature:120&frames=90&end"
    >>> scene, settings, replay = read_link(f"https://example.org/lab.html{link}")
    >>> scene, settings, replay.turns
    ('temperature', {'seed': '7'}, (Turn(frame=60, name='temperature', value=120.0),))
    """
    told = text.strip().rpartition("#")[2]
    found = _LINK.fullmatch(told) if len(told) <= _LONGEST else None
    if found is None:
        refuse(text, "is not a link of a run, or only a part of one")
    version = unquote(found["version"])
    if version != __version__:
        raise SettingError(
            "replay", text, f"is of atmosbox {version}, and this is {__version__}, whose numbers may differ",
            f"type pip install atmosbox=={version} to run it",
        )  # fmt: skip
    turns = [_TURN.fullmatch(each) for each in (found["turns"] or "").split(",") if found["turns"]]
    made = tuple(Turn(int(t[1]), t[2], None if t[3] == "start" else float(t[3])) for t in turns if t is not None)
    frames, in_order = int(found["frames"]), all(a.frame <= b.frame for a, b in itertools.pairwise(made))
    if len(made) < len(turns) or len(made) > _MOST_TURNS or not in_order:
        refuse(text, "has moves of sliders that cannot be read")
    if max(frames, *(turn.frame for turn in made), 0) > _MOST_FRAMES:
        refuse(text, f"is of more than {_MOST_FRAMES} frames")
    if found["prediction"] and not _PREDICTION.fullmatch(found["prediction"]):
        refuse(text, "has a prediction that cannot be read: it needs a variable and five numbers")
    pairs = [each.split("=") for each in found["settings"].split("&")[1:]]
    settings = {name: unquote(value) for name, value in pairs}
    if len(settings) < len(pairs):
        refuse(text, "has a setting twice")
    return unquote(found["scene"]), settings | {"seed": found["seed"]}, Replay(f"#{told}", frames, made)


def refuse(link: str, problem: str) -> NoReturn:
    """Refuse a link."""
    raise SettingError("replay", link, problem, "copy the link again from the page, as a whole and in quotes")


def check_nothing_changes(what: str, given: Mapping[str, object]) -> None:
    """Refuse options that would change a run that is already determined."""
    for name, value in given.items():
        if value is not None and value != []:
            raise SettingError(name, None, f"cannot change {what}", "leave it out")
