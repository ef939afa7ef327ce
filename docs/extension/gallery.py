"""The gallery: of every scene a page that plays and a worksheet, and of some a lab, made when the site is built.

A page is a megabyte or two, so none is kept: each is made of a run with few molecules. In the source the gallery has
the pictures and the commands; on the site each scene has two links more, or three. The page of a scene that has a lab
holds it, too: it is loaded when it is opened.
"""

import subprocess
import sys
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [] if str(ROOT) in sys.path else [str(ROOT)]

NAME = "gallery"

LABS = {
    "temperature": {"molecules": 400},
    "elastic-collisions": {},
    "atmosphere": {"molecules": 1500, "start": "equilibrium"},
    "lifting-dry": {"molecules": 1500, "ascent": 400},
}
"""The settings of the labs: so few molecules that a phone keeps up."""

FEW = {
    "temperature": {"molecules": 100, "duration": "4 ns"},
    "temperature-large": {"molecules": 400, "duration": "4 ns"},
    "atmosphere": {"molecules": 400, "duration": 60},
    "lifting-dry": {"molecules": 400},
    "condensation": {"molecules": 500},
    "evaporation": {},
    "lifting-moist": {"molecules": 2500},
    "lifting-sounding": {"molecules": 2500},
    "mountains": {"molecules": 2500},
    "elastic-collisions": {},
}
"""So few molecules that a page is small and quick to make."""


def make(folder: Path) -> None:
    """Make pages and worksheets in a folder."""
    import atmosbox as ab
    from atmosbox import scenarios, sheet
    from atmosbox.lab import save_lab
    from atmosbox.page import save
    from atmosbox.simulation.preparation import prepare

    for name in scenarios.names():
        save([ab.run(name, save_molecules=True, **FEW.get(name, {}))], folder / f"{name}.html", force=True)
        sheet.save(sheet.worksheet(name, {}), folder / f"{name}-sheet.pdf", force=True)
    for name, settings in LABS.items():
        save_lab(prepare(name, settings), folder / f"{name}-lab.html", force=True)


def add_links(app: Sphinx, docname: str, source: list[str]) -> None:
    """Put the links to what is made below the heading of each scene, and its lab into its own page."""
    scene = docname.removeprefix("scenes/")
    if docname != scene and scene in LABS:
        heading, _, rest = source[0].partition("\n")
        source[0] = f"{heading}\n\n{_lab(scene)}\n{rest}"
    if docname != NAME:
        return
    lines = []
    for line in source[0].splitlines():
        lines.append(line)
        name = line.removeprefix("## ")
        if line.startswith("## "):
            play = f'<a href="{NAME}/{name}.html">Play it in the browser</a>'
            lab = f' · <a href="{NAME}/{name}-lab.html">let it run</a>' if name in LABS else ""
            lines += ["", f'<p>{play}{lab} · <a href="{NAME}/{name}-sheet.pdf">worksheet (PDF)</a></p>']
    source[0] = "\n".join(lines)


def _lab(scene: str) -> str:
    """Return the lab of a scene, closed: a browser loads the frame only when it is to be seen."""
    place = f"../{NAME}/{scene}-lab.html"
    links = f'<a href="{place}" target="_blank">in its own window</a> · <a href="{place}" download>download</a>'
    frame = f'<iframe src="{place}" title="{scene}, running" loading="lazy"></iframe>'
    return f'<details class="lab"><summary>Let it run here</summary>\n<p>{links}</p>\n{frame}\n</details>\n'


def build(app: Sphinx, problem: Exception | None) -> None:
    """Make pages and worksheets beside the site, in a process of its own, whose engine is compiled."""
    if problem is None and app.builder.format == "html":
        folder = Path(app.outdir) / NAME
        folder.mkdir(exist_ok=True)
        subprocess.run([sys.executable, __file__, str(folder)], check=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.connect("source-read", add_links)
    app.connect("build-finished", build)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    make(Path(sys.argv[1]))
