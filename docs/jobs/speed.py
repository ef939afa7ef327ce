"""How fast the engine is, as the benchmarks have measured it."""

import json

from jobs.registry import ROOT, Findings, job

RESULTS = ROOT / "benchmarks" / "results.json"
COMMANDS = "`python benchmarks/engine.py` and `python benchmarks/features.py`"


@job("speed", quick=True)
def speed(found: Findings) -> None:
    """Make the table of what the benchmarks have measured."""
    if not RESULTS.is_file():
        found.text(f"How fast it is on your computer tell {COMMANDS}, which write `benchmarks/results.json`.")
        return
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    found.text(json.dumps(results, indent=1))
