"""Make every figure in docs/figures, and every number and table that the pages quote.

    python docs/figures.py                     run all jobs, write figures, numbers.json and pages
    python docs/figures.py --only energy       run one job (or several), take the rest from numbers.json
    python docs/figures.py --quick             run only the jobs that take a second or two
    python docs/figures.py --stale             run only the jobs whose sources have changed since they were run
    python docs/figures.py --check             write nothing; exit 1 if a page would change
    python docs/figures.py --list              name the jobs, with --stale those that are stale and how long they take

The exit status is 1 if a run disagrees with theory, if a page quotes what no job computes, if a job computes
what no page quotes, with --check, if a page would change, or, with --list --stale, if a job is stale. The numbers are
those of fixed seeds: they come out the same on every computer, but for times.
A job is stale if the code that its numbers depend on has changed since (jobs/source.py says what that is). There is no
way to call it fresh but to run it.
"""

import argparse
import importlib
import json
import sys
import time
import traceback
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from jobs import page, source  # noqa: E402
from jobs.registry import DOCS, FIGURES, JOBS, ROOT, Findings  # noqa: E402

NUMBERS = DOCS / "numbers.json"
for _module in sorted((HERE / "jobs").glob("*.py")):
    importlib.import_module(f"jobs.{_module.stem}")


def arguments(words: list[str] | None = None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__.partition("\n")[0], epilog="The exit status is 1 if anything disagrees."
    )
    parser.add_argument("--only", nargs="+", metavar="NAME", help="run these jobs only")
    parser.add_argument("--quick", action="store_true", help="run only the jobs that take a second or two")
    parser.add_argument("--check", action="store_true", help="write nothing, fail if a page would change")
    parser.add_argument("--stale", action="store_true", help="run only the jobs whose sources have changed since")
    parser.add_argument("--list", action="store_true", help="name the jobs, and run none")
    given = parser.parse_args(words)
    unknown = sorted(set(given.only or ()) - set(JOBS))
    if unknown:
        parser.error(f"there is no job {', '.join(unknown)}: --list names them")
    return given


def run(name: str, write: bool) -> tuple[dict[str, Any], list[str]]:
    """Run a job; return what numbers.json keeps of it, and what failed."""
    found = Findings(name, write)
    sources = {} if JOBS[name].quick else {"sources": source.digest(name, JOBS[name].file)}
    began = time.perf_counter()
    try:
        JOBS[name].function(found)
        found.close()
    except Exception:
        found.failures.append(traceback.format_exc())
    seconds = time.perf_counter() - began
    verdict = "FAILED" if found.failures else "ok"
    print(f"{name:<22} {seconds:7.1f} s  {verdict}", file=sys.stderr, flush=True)
    kept: dict[str, Any] = {"numbers": found.numbers, "tables": found.tables, "figures": found.figures}
    if sources:
        kept |= {**sources, "seconds": round(seconds)}
    return kept, [f"{name}: {failure}" for failure in found.failures]


def stale(known: dict[str, Any]) -> list[str]:
    """Return the jobs whose sources have changed since they were run; quick ones are tested, and never stale."""
    return [
        name
        for name, each in JOBS.items()
        if not each.quick and known.get(name, {}).get("sources") != source.digest(name, each.file)
    ]


def rebuild(known: dict[str, Any], write: bool) -> list[str]:
    """Put all numbers and tables into the pages; return what is wrong with them."""
    numbers = {key: text for each in known.values() for key, text in each["numbers"].items()}
    tables = {key: text for each in known.values() for key, text in each["tables"].items()}
    figures = {name for each in known.values() for name in each["figures"]}
    faults, wanted, quoted = [], set(), set()
    for path in page.pages():
        old = path.read_text(encoding="utf-8")
        new = page.filled(old, numbers, tables, wanted)
        quoted |= page.used(new)
        if new != old and write:
            path.write_text(new, encoding="utf-8")
        elif new != old:
            faults.append(f"{path.relative_to(ROOT)} would change: run python docs/figures.py")
    faults += [f"a page quotes {name}, which no job computes" for name in sorted(wanted)]
    made = {f"number:{key}" for key in numbers} | {f"table:{key}" for key in tables}
    made |= {f"figure:{name}" for name in figures}
    faults += [f"{name} is computed, but no page quotes it" for name in sorted(made - quoted)]
    shown = {name for name in quoted if name.startswith("figure:")}
    faults += [f"a page shows {name}, which no job makes" for name in sorted(shown - made)]
    faults += [f"docs/figures/{name} is missing" for name in sorted(figures) if not (FIGURES / name).is_file()]
    return faults


def main(words: list[str] | None = None) -> int:
    """Run what was asked for; return the exit status."""
    given = arguments(words)
    known = json.loads(NUMBERS.read_text(encoding="utf-8")) if NUMBERS.is_file() else {}
    chosen = [name for name in JOBS if name in (given.only or JOBS) and (JOBS[name].quick or not given.quick)]
    if given.stale:
        old = set(stale(known))
        chosen = [name for name in chosen if name in old]
    if given.list:
        for name in chosen:
            took = known.get(name, {}).get("seconds")
            print(f"{name:<24} took {took} s" if given.stale and took is not None else name)
        return 1 if given.stale and chosen else 0
    faults: list[str] = []
    for name in chosen:
        kept, failures = run(name, not given.check)
        faults += failures
        if not failures:
            known[name] = kept
        if not given.check:
            known = {each: known[each] for each in JOBS if each in known}
            NUMBERS.write_text(json.dumps(known, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    faults += rebuild(known, not given.check)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
