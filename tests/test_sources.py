"""Every DOI that the repository cites is on the page of sources, with how it was checked."""

import re
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).parents[1]
DOI = re.compile(r"\b10\.\d{4,5}/[A-Za-z0-9.()/<>:;_-]+")
PLACES = ("atmosbox", "scenarios", "docs", "benchmarks", "README.md")


def cited(text):
    """Return the DOIs in a text, without what follows them in the sentence."""
    found = set()
    for doi in DOI.findall(unquote(text)):
        plain = doi.rstrip(".,;:")
        while plain.endswith(")") and plain.count(")") > plain.count("("):
            plain = plain[:-1].rstrip(".,;:")
        found.add(plain.lower())
    return found


def test_every_doi_stands_on_the_page_of_sources():
    page = ROOT / "docs" / "sources.md"
    known = cited(page.read_text(encoding="utf-8"))
    assert len(known) > 40
    missing = {}
    for place in PLACES:
        paths = [ROOT / place] if place.endswith(".md") else sorted((ROOT / place).rglob("*"))
        for path in paths:
            if path.suffix in {".py", ".md", ".toml", ".jinja"} and "vendor" not in path.parts and path != page:
                for doi in cited(path.read_text(encoding="utf-8")) - known:
                    missing.setdefault(doi, path.relative_to(ROOT).as_posix())
    assert missing == {}
