"""What can be called from Python: a table of the modules that have a page, read off their docstrings."""

import importlib
import re

from jobs.registry import DOCS, Findings, job

PAGES = DOCS / "api"
MODULE = re.compile(r"^\.\. automodule:: ([\w.]+)$", re.MULTILINE)

DOORS = {
    "run": (
        "atmosbox",
        "atmosbox.scenarios",
        "atmosbox.simulation.runner",
        "atmosbox.file.netcdf",
        "atmosbox.plot",
        "atmosbox.errors",
    ),
    "physics": ("atmosbox.theory", "atmosbox.scene.sounding", "atmosbox.scene.units", "atmosbox.scene.statistics"),
    "scene": (
        "atmosbox.scene.settings",
        "atmosbox.scene.setup",
        "atmosbox.engine",
        "atmosbox.scene.instruments",
        "atmosbox.scene.headline",
        "atmosbox.scene.panels",
        "atmosbox.file.dataset",
    ),
    "show": (
        "atmosbox.plot.compare",
        "atmosbox.sweep",
        "atmosbox.page",
        "atmosbox.film",
        "atmosbox.sheet",
    ),
    "trust": ("atmosbox.scene.engines", "atmosbox.simulation.accuracy", "atmosbox.trade.tradeoff"),
}
"""The modules by the table in which they stand."""


def first_sentence(text: str | None) -> str:
    """Return the first sentence of a docstring, or what stands before its first empty line."""
    return " ".join((text or "").partition("\n\n")[0].split())


@job("interface", quick=True)
def interface(found: Findings) -> None:
    """Make the tables of the modules, each with its page, and fail if a page or a table lacks one."""
    pages = {MODULE.findall(path.read_text(encoding="utf-8"))[0]: path for path in sorted(PAGES.glob("*.rst"))}
    listed = {name for names in DOORS.values() for name in names}
    if listed != set(pages):
        found.failures.append(f"these modules have a page or a line, but not both: {sorted(listed ^ set(pages))}")
    for key, names in DOORS.items():
        rows = []
        for name in names:
            module = importlib.import_module(name)
            rows.append([f"[`{name}`]({pages[name].name})", first_sentence(module.__doc__)])
        found.table(["module", "what it is"], rows, key=key)
