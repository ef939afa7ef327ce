"""Deliberate faults: each is put into a copy of the checkout, where the test that it names must fail.

``python -m tests.faults [NAME ...]`` tries all faults of ``faults.toml``, or those named, prints a table, and returns 1
if one survives, or if the list does not fit the code. ``--list`` prints what each of them is.

The faults are of the kind that a person makes: a factor, a sign, a wall, a frame, a unit. A test that is shortened must
still catch those that name it. One edit of the engine compiles its kernels again, so each names a small test.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LEFT_OUT = shutil.ignore_patterns(".*", "__pycache__", "atmosbox-env", "figures", "site", "dist")


def faults():
    """Return the faults by name."""
    return tomllib.loads((ROOT / "tests" / "faults.toml").read_text(encoding="utf-8"))


def stale(fault):
    """Return a sentence if a fault cannot be made in the present code, or its test does not exist; else nothing."""
    times = (ROOT / fault["file"]).read_text(encoding="utf-8").count(fault["old"])
    if times != 1:
        return f"the text to replace stands {times} times in {fault['file']}"
    file, _, name = fault["test"].partition("::")
    there = (ROOT / file).exists() and f"def {name.partition('[')[0]}(" in (ROOT / file).read_text(encoding="utf-8")
    return "" if there else f"there is no {fault['test']}"


def tested(copy, *tests):
    """Run tests in the copy; return the status of pytest (0 if all pass, 1 if some fail) and what it said."""
    # no byte code is kept: it is known by second and size, which a fault may share with what it replaces
    more = {"PYTHONPATH": str(copy), "NUMBA_CACHE_DIR": str(copy.parent / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    environment = os.environ | more
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", *tests]
    ran = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    return ran.returncode, ran.stdout + ran.stderr


def survives(fault, copy):
    """Put a fault into the copy and take it out again; return a sentence if its test does not fail, else nothing."""
    file = copy / fault["file"]
    sound = file.read_text(encoding="utf-8")
    file.write_text(sound.replace(fault["old"], fault["new"]), encoding="utf-8")
    try:
        status, said = tested(copy, fault["test"])
    finally:
        file.write_text(sound, encoding="utf-8")
    if status == 1:
        return ""
    return "NOT CAUGHT" if status == 0 else f"the test could not be run: {' '.join(said.split()[-30:])}"


def main(words):
    """Try the faults that are named, or all; return the exit status."""
    known = faults()
    chosen = {name: known[name] for name in [word for word in words if word != "--list"] or known}
    if "--list" in words:
        for name, fault in chosen.items():
            print(f"{name:24} {fault['file']}: {fault['wrong']}\n{'':24} {fault['test']}")
        return 0
    old = [f"{name}: {said}" for name, fault in chosen.items() if (said := stale(fault))]
    if old:
        print("The list is older than the code:", *old, sep="\n")
        return 1
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "copy"
        shutil.copytree(ROOT, copy, ignore=LEFT_OUT)
        status, said = tested(copy, *dict.fromkeys(fault["test"] for fault in chosen.values()))
        if status:
            print(f"The tests must pass before a fault is made:\n{said}")
            return 1
        survived = 0
        for name, fault in chosen.items():
            began = time.monotonic()
            found = survives(fault, copy)
            survived += bool(found)
            print(f"{name:24} {time.monotonic() - began:6.1f} s  {found or 'caught'}  {fault['test']}", flush=True)
    print(f"{len(chosen) - survived} of {len(chosen)} faults are caught.")
    return min(survived, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
