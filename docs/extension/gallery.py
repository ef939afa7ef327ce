"""The gallery: of every scene a page that plays, a film, a worksheet and the lab, made when the site is built.

A page or a film is a megabyte or two, so none is kept: each is made of a run with few molecules. In the source the
gallery has the pictures and the commands; on the site each scene has its page and its film as well, which are loaded
when they are opened, and links to them. The page of a scene holds its lab, too. The labs and their index are the folder
that `atmosbox lab --all` writes. With the option
``-D gallery_scenes=NAME,NAME`` of Sphinx these scenes alone have them, which is quicker.
"""

import subprocess
import sys
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [] if str(ROOT) in sys.path else [str(ROOT)]

from atmosbox.lab.wasm_module import SCENES  # noqa: E402

NAME, LABS = "gallery", "labs"

FEW = {
    "temperature": {"molecules": 100, "duration": "4 ns"},
    "atmosphere": {"molecules": 400, "duration": 60},
    "lifting-dry": {"molecules": 400},
    "condensation": {"molecules": 500},
    "evaporation": {"molecules": 2000, "pool": 400},
    "lifting-moist": {"molecules": 2500},
    "lifting-sounding": {"molecules": 2500},
    "mountains": {"molecules": 2500},
    "elastic-collisions": {},
    "convection": {"molecules": 3000},
    "attraction": {"molecules": 300},
    "diffusion": {"molecules": 3000},
    "nuclei": {"duration": 40},
}
"""So few molecules that a page is small and quick to make."""


PICTURES = 8.0
"""How many pictures a second a film has: one of eight seconds takes seconds to make, and a megabyte."""


def make(folder: Path, seconds: float, chosen: list[str]) -> None:
    """Make pages, films of some seconds and worksheets of some scenes, and their labs, in a folder."""
    import atmosbox as ab
    from atmosbox import film, sheet
    from atmosbox.cli.lab import save_all
    from atmosbox.page import save

    for name in chosen:
        run = ab.run(name, save_molecules=True, **FEW[name])
        save([run], folder / f"{name}.html", force=True)
        film.save(run, folder / f"{name}.mp4", force=True, seconds=seconds, fps=PICTURES)
        sheet.save(sheet.worksheet(name, {}), folder / f"{name}-sheet.pdf", force=True)
    save_all(folder.parent / LABS, theme="auto", language="auto", force=True, scenes=chosen)


def scenes(app: Sphinx) -> list[str]:
    """Return the scenes of which the gallery has more than a picture."""
    wanted = app.config.gallery_scenes
    return list(FEW) if wanted == "all" else wanted.split(",")


def add_links(app: Sphinx, docname: str, source: list[str]) -> None:
    """Put what is made below the heading of each scene, and its lab into its own page."""
    scene = docname.removeprefix("scenes/")
    chosen = scenes(app)
    if docname != scene and scene in SCENES and scene in chosen:
        heading, _, rest = source[0].partition("\n")
        lab = _framed(f"../{LABS}/{scene}-lab.html", "Let it run here", f"{scene}, running")
        source[0] = f"{heading}\n\n{lab}\n{rest}"
    if docname != NAME:
        return
    lines = []
    for line in source[0].splitlines():
        lines.append(line)
        name = line.removeprefix("## ")
        if name not in chosen or line == name:
            continue
        lab = f'<a href="{LABS}/{name}-lab.html">let it run</a> · ' if name in SCENES else ""
        lines += ["", f'<p>{lab}<a href="{NAME}/{name}-sheet.pdf">worksheet (PDF)</a></p>', ""]
        lines += [_framed(f"{NAME}/{name}.html", "Play it here", f"{name}, to play"), _film(f"{NAME}/{name}.mp4", name)]
    source[0] = "\n".join(lines)


def _framed(place: str, words: str, title: str) -> str:
    """Return a page in a frame, closed: a browser loads it only when it is to be seen."""
    links = f'<a href="{place}" target="_blank">in its own window</a> · <a href="{place}" download>download</a>'
    frame = f'<iframe src="{place}" title="{title}" loading="lazy"></iframe>'
    return f'<details class="lab"><summary>{words}</summary>\n<p>{links}</p>\n{frame}\n</details>\n'


def _film(place: str, name: str) -> str:
    """Return a film, closed: a browser loads it only when it is started."""
    film = f'<video src="{place}" controls loop muted preload="none" aria-label="film of {name}"></video>'
    return f'<details class="lab"><summary>Watch the film</summary>\n{film}\n</details>\n'


def build(app: Sphinx, problem: Exception | None) -> None:
    """Make pages, films and worksheets beside the site, in a process of its own, whose engine is compiled."""
    if problem is None and app.builder.format == "html":
        folder = Path(app.outdir) / NAME
        folder.mkdir(exist_ok=True)
        subprocess.run([sys.executable, __file__, str(folder), app.config.gallery_film, *scenes(app)], check=True)


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.add_config_value("gallery_scenes", "all", "html", str)
    app.add_config_value("gallery_film", "8", "html", str)  # seconds
    app.connect("source-read", add_links)
    app.connect("build-finished", build)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    make(Path(sys.argv[1]), float(sys.argv[2]), sys.argv[3:])
