"""The register of jobs: what the pages quote, who computes it, and whether it agrees with theory.

A job is a function that is given a `Findings` and puts numbers, tables and figures into it. What it finds is
called by its own name: the job ``energy`` makes the table ``energy`` and numbers such as ``energy.collisions``.
"""

import io
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from atmosbox import scenarios
from atmosbox.text.table import measurement

DOCS = Path(__file__).resolve().parents[1]
ROOT = DOCS.parent
FIGURES = DOCS / "figures"
BENCHMARKS = ROOT / "benchmarks"
SCENES = tuple(name for name in scenarios.names() if (DOCS / "scenes" / f"{name}.md").is_file())
"""The scenes that have a page; a variant is told on the page of the scene that it varies."""
LARGEST_FIGURE = 300_000
"""Bytes that a figure may have."""


class Job(NamedTuple):
    """A job: its name, its function, whether it takes no more than a second or two, and the file where it stands."""

    name: str
    function: Callable[["Findings"], None]
    quick: bool
    file: Path


JOBS: dict[str, Job] = {}
"""All jobs by name, in the order in which they run."""


def job(name: str, *, quick: bool = False) -> Callable[[Callable[["Findings"], None]], Callable[["Findings"], None]]:
    """Enter a function into the register."""

    def enter(function: Callable[["Findings"], None]) -> Callable[["Findings"], None]:
        if name in JOBS:
            raise ValueError(f"there are two jobs named {name}")
        file = Path(getattr(function, "func", function).__code__.co_filename)
        JOBS[name] = Job(name, function, quick, file)
        return function

    return enter


def markdown(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table as Markdown."""
    lines = [list(header), ["---"] * len(header), *([str(cell) for cell in row] for row in rows)]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def results(name: str) -> Any:
    """Return what a benchmark has written."""
    return json.loads((BENCHMARKS / f"{name}.json").read_text(encoding="utf-8"))["results"]


def rounded(value: float, figures: int = 2) -> str:
    """Return a number to so many figures, powers of ten written as in print."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    if 1e-3 <= abs(value) < 1e5:
        decimals = max(figures - 1 - math.floor(math.log10(abs(value))), 0)
        return f"{value:.{decimals}f}".replace("-", "−")
    mantissa, power = f"{value:.{figures - 1}e}".split("e")
    return f"{mantissa.replace('-', '−')}·10{str(int(power)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"


@dataclass
class Findings:
    """What a job has found; ``write`` tells whether figures are to be written."""

    name: str
    write: bool = True
    numbers: dict[str, str] = field(default_factory=dict)
    tables: dict[str, str] = field(default_factory=dict)
    figures: list[str] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)

    def number(self, key: str, text: object) -> None:
        """Keep a number under NAME.key, as it stands in a sentence."""
        self.numbers[f"{self.name}.{key}"] = str(text)

    def table(self, header: Sequence[str], rows: Sequence[Sequence[object]], key: str = "") -> None:
        """Keep a table under NAME, or NAME.key."""
        self.text(markdown(header, rows), key)

    def text(self, text: str, key: str = "") -> None:
        """Keep whole lines under NAME, or NAME.key."""
        self.tables[f"{self.name}.{key}" if key else self.name] = text

    def agree(
        self,
        what: str,
        value: float,
        error: float,
        theory: float,
        tolerance: float = 0.0,
        unit: str = "",
        limit: float = math.inf,
    ) -> None:
        """Enter a row that compares a measurement with theory, and fail if it is off.

        The misfit may be four standard errors and the tolerance of the model, and never more than ``limit``.
        """
        allowed = min(4.0 * error + tolerance, limit)
        misfit = value - theory
        if not abs(misfit) <= allowed:
            self.failures.append(f"{what}: {value:.6g} +- {error:.2g}, but theory says {theory:.6g}")
        shown = measurement(value, error).replace("-", "−")
        self.rows.append(
            [what + (f" [{unit}]" if unit else ""), shown, rounded(theory, 5), rounded(misfit), rounded(allowed)]
        )

    def bound(self, what: str, value: float, limit: float) -> None:
        """Enter a row for a number that must not exceed a limit."""
        if not abs(value) <= limit:
            self.failures.append(f"{what}: {value:.3g}, and no more than {limit:.3g} is allowed")
        self.rows.append([what, rounded(value), "0", rounded(value), rounded(limit)])

    def close(self) -> None:
        """Make a table of the rows that were entered."""
        if self.rows:
            self.table(["quantity", "measured", "theory", "difference", "expected within"], self.rows)
            self.rows = []

    def figure(self, drawing: Any, name: str, dots_per_inch: float) -> None:
        """Write a figure, or at least check that it can be drawn."""
        stream = io.BytesIO()
        drawing.savefig(stream, format="png", dpi=dots_per_inch, metadata={"Software": None})
        self.picture(stream.getvalue(), name)

    def picture(self, content: bytes, name: str) -> None:
        """Write a figure that is a PNG already."""
        if len(content) > LARGEST_FIGURE:
            content = compact(content)
        if len(content) > LARGEST_FIGURE:
            self.failures.append(f"the figure {name} has {len(content)} bytes, more than {LARGEST_FIGURE}")
        self.figures.append(f"{name}.png")
        if self.write:
            FIGURES.mkdir(exist_ok=True)
            (FIGURES / f"{name}.png").write_bytes(content)


def compact(png: bytes) -> bytes:
    """Return a PNG of 256 colours: nobody sees the difference in a drawing, and it is a third of the size."""
    from PIL import Image

    picture = Image.open(io.BytesIO(png)).convert("RGB")
    picture = picture.quantize(256, dither=Image.Dither.NONE)
    stream = io.BytesIO()
    picture.save(stream, format="png", optimize=True)
    return stream.getvalue()
