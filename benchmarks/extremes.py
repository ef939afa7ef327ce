"""Store what each engine makes of each extreme: the outcomes with which later ones are compared.

    python benchmarks/extremes.py                 # says what has changed, and changes nothing
    python benchmarks/extremes.py --write         # stores it
    python benchmarks/extremes.py --only cradle --engine dsmc --write

An engine that has become worse in an extreme fails the tests and ``atmosbox check --extremes`` until its outcome is
stored anew: on purpose, after a look at what has changed. What is wrong is never stored.
"""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from atmosbox.scene.engines import choose, names
from atmosbox.trade.extremes import EXTREMES, STORED, examine


def main(words: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", action="append", choices=names(), help="an engine; all by default")
    parser.add_argument("--only", action="append", choices=EXTREMES, metavar="NAME", help="an extreme; all by default")
    parser.add_argument("--write", action="store_true", help="store the outcomes")
    given = parser.parse_args(words)
    kept = json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else {}
    for name in given.only or EXTREMES:
        for engine in given.engine or names():
            found = examine(EXTREMES[name], choose(engine))
            print(f"{name} on {engine}: {found.verdict}; {found.verdict.told} ({found.seconds:.1f} s)", flush=True)
            if found.verdict.passed:
                kept.setdefault(name, {})[engine] = asdict(found.verdict)
    if given.write:
        kept = {name: kept[name] for name in EXTREMES if name in kept}
        STORED.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
