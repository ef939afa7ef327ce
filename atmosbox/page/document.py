"""The page as one HTML document that contains the libraries, our scripts, and the data of the runs."""

import base64
import functools
import gzip
import html
import json
import tomllib
from collections.abc import Collection, Iterable, Mapping, Sequence
from importlib import resources
from typing import Any

THEMES = ("auto", "light", "dark")

LANGUAGES = ("auto", "en", "de", "es")
"""The languages of a page; ``auto`` takes the first language of the reader's browser that the page has."""

MODULES = (
    "words.js", "colour.js", "figure.js", "frames.js", "clock.js", "molecules.js", "mist.js", "walls.js",
    "labels.js", "trace.js", "wind.js", "camera.js", "stage.js", "speeds.js", "atmosphere.js", "curves.js",
    "skewt.js", "ink.js", "notes.js", "graph.js", "means.js", "graphs.js", "caption.js", "legend.js",
    "transport.js", "keys.js", "sheet.js",
)  # fmt: skip
"""Our scripts, each after the scripts that it imports."""

_ENTRIES = {
    "view": ("view.js",),
    "lab": ("controls.js", "player.js", "gauges.js", "lesson.js", "prediction.js", "engine.js", "link.js", "lab.js"),
}
_THREE = ("three.core.min.js", "three.module.min.js", "OrbitControls.js")


def view_page(
    runs: Sequence[Mapping[str, Any]], frames: Sequence[str], *, theme: str = "auto", language: str = "auto"
) -> str:
    """Return the complete page that shows saved runs; it needs no other file and no network.

    Parameters
    ----------
    runs : sequence of mapping
        The record of each run: its ``stage``, its ``values`` by name, and the other entries of
        `atmosbox.page.saved_run.Page`.
    frames : sequence of str
        The frames of each run, as `atmosbox.page.frame.pack` returns them.
    theme : {"auto", "light", "dark"}
        Colours of the page; ``auto`` takes those that the reader's system prefers.
    language : {"auto", "en", "de", "es"}
        Language of the page; ``auto`` takes the first language of the reader's browser that the page has.

    Examples
    --------
    >>> page = view_page([{"stage": {"title": "Air & water"}}], ["eJw="])
    >>> page.startswith("<!doctype html>"), "<title>Air &amp; water</title>" in page
    (True, True)
    """
    titles = dict.fromkeys(str(run["stage"]["title"]) for run in runs)
    packed = (_block(f"frames-{number}", "text/plain", text) for number, text in enumerate(frames))
    told = _block("told", "application/json", _json({"runs": list(runs)}))
    return _document("view", " · ".join(titles), theme, language, [told, *packed])


def lab_page(
    stage: Mapping[str, Any],
    starts: Sequence[Any],
    module: str,
    stored: str,
    *,
    theme: str = "auto",
    language: str = "auto",
    served: bool = False,
) -> str:
    """Return the complete page in which a box runs; it needs no other file and no network.

    Parameters
    ----------
    stage : mapping
        The record of the stage: its ``title``, and the ``card`` of the model, of which the page has all translations.
    starts : sequence
        For each start that the page offers its label, and the number of bytes of its plan and of its memory.
    module, stored : str
        The engine, and the plans and memories of all starts (see `atmosbox.lab`), both compressed and in base64.
    theme, language : str
        As for `view_page`.
    served : bool
        Whether the page may ask the server that it comes from for plans of boxes with other settings, at ``/plan``.
    """
    engine = "\n".join(packaged("web", name) for name in ("lab_machine.js", "lab_worker.js"))
    data = [
        *([_block("plans", "text/plain", "/plan")] if served else []),
        _block("starts", "application/json", _json(starts)),
        _block("module", "text/plain", module),
        _block("stored", "text/plain", stored),
        _block("worker", "text/plain", _inline(engine)),
    ]
    return _document("lab", stage["title"], theme, language, data, card=stage.get("card", {}).values(), served=served)


@functools.cache
def words(language: str) -> dict[str, Any]:
    """Return the texts of the page in a language: see ``language/en.toml``."""
    return tomllib.loads(packaged("language", f"{language}.toml"))


def phrase(language: str, text: str) -> str:
    """Return an English text of a scene or of a worksheet in a language; unchanged where there is no translation."""
    plain, told = text.replace("\u00a0", " "), words(language)
    return str((told.get("phrase", {}) | told.get("sheet", {})).get(plain, text))


def _said(language: str, card: Iterable[str]) -> dict[str, Any]:
    """Return the texts of the page in a language, of the cards of all models those of one."""
    told = dict(words(language))
    cards = told.pop("card", {})
    told.pop("sheet", None)
    return {**told, "phrase": {**told.get("phrase", {}), **{text: cards[text] for text in card if text in cards}}}


def _document(
    entry: str,
    title: str,
    theme: str,
    language: str,
    data: Iterable[str],
    *,
    card: Collection[str] = (),
    served: bool = False,
) -> str:
    """Return the HTML document that contains some data."""
    libraries = ("three", "uplot", "lean-qr") if entry == "lab" else ("three", "uplot")
    scripts = [_packed_module(name) for name in _THREE]
    scripts += [_module("qr.mjs", packaged("vendor", "lean-qr", "nano.mjs"))] if entry == "lab" else []
    scripts += [_module(name, packaged("web", name)) for name in (*MODULES, *_ENTRIES[entry])]
    first = "en" if language == "auto" else language
    said = words(first)["page"]
    tables = {
        name: _said(name, card) for name in (LANGUAGES[1:] if language == "auto" else dict.fromkeys(("en", first)))
    }
    parts = {
        "LANG": first,
        "LANGUAGE": language,
        "WORDS": _block("words", "application/json", _json(tables)),
        **{name.upper(): html.escape(said[name]) for name in ("wait", "no_script", "cannot_start")},
        "TITLE": html.escape(title),
        "THEME": theme,
        "ENTRY": entry,
        "CONNECT": "'self'" if served else "'none'",
        "ALSO": " 'wasm-unsafe-eval'" if entry == "lab" else "",
        "STYLE": "\n".join((packaged("vendor", "uplot", "uPlot.min.css"), packaged("web", "theme.css"))),
        "UPLOT": _inline(packaged("vendor", "uplot", "uPlot.iife.min.js")),
        "MODULES": "\n".join(scripts),
        "DATA": "\n".join(data),
        "BOOT": _inline(packaged("web", "boot.js")),
        "LICENCES": "\n".join(f"{name}:\n{packaged('vendor', name, 'LICENSE')}" for name in libraries),
    }
    pieces = packaged("web", "page.html").split("@@")
    return "".join(parts[piece] if number % 2 else piece for number, piece in enumerate(pieces))


def packaged(*place: str) -> str:
    """Return a file of the package."""
    return resources.files("atmosbox.page").joinpath(*place).read_text(encoding="utf-8")


def _module(name: str, text: str) -> str:
    """Return the element of a script that ``boot.js`` turns into a module."""
    return f'<script type="text/plain" data-module="{name}">{_inline(text)}</script>'


@functools.cache
def _packed_module(name: str) -> str:
    """Return the same for a script of the library three, compressed: it takes a third of the room."""
    packed = base64.b64encode(gzip.compress(packaged("vendor", "three", name).encode(), 9, mtime=0)).decode("ascii")
    return f'<script type="text/plain" data-module="{name}" data-packed>{packed}</script>'


def _block(name: str, kind: str, text: str) -> str:
    return f'<script type="{kind}" id="{name}">{text}</script>'


def _inline(text: str) -> str:
    """Return a script in which no text can end the HTML element around it."""
    return text.replace("</script", "<\\/script")


def _json(content: Any) -> str:
    """Return JSON that is safe inside an HTML element."""
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
