"""The worksheet of the scene of one's own: what is written for it, and what comes out with the answers."""

from jobs.registry import DOCS, Findings, job

from atmosbox.sheet.worksheet import worksheet

EXAMPLE = DOCS / "examples" / "my_scene.py"


@job("sheet-words", quick=True)
def words(found: Findings) -> None:
    """Show the words of a sheet."""
    text = EXAMPLE.with_suffix(".sheet.toml").read_text(encoding="utf-8").rstrip()
    found.text(f"```toml\n{text}\n```")


@job("sheet")
def sheet(found: Findings) -> None:
    """Show the sheet that they make, with its answers."""
    made = worksheet(EXAMPLE, answers=True)
    found.failures += made.disagreements
    text = made.text.replace(str(EXAMPLE), "./my_scene.py").rstrip()
    found.text(f"````markdown\n{text}\n````")
