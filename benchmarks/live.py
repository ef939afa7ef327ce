"""How many pictures a second a page gets of a box that runs, with its graphs.

    python benchmarks/live.py [--molecules 800 5000] [--scene temperature] [--seconds 10] [--pace 1] [--json live.json]

For each number of molecules it starts ``atmosbox live`` as a user does, opens its socket as a browser does, lets the
box play and counts the pictures that arrive. It also gives the time that passes in the box in a second, as a share of
the time that the page asks for. A share below 1 means that the engine is at its limit: the motion is then slower, but
as smooth as before.
"""

import argparse
import json
import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from websockets.sync.client import connect  # noqa: E402

from atmosbox.live.session import Session  # noqa: E402
from atmosbox.simulation.preparation import prepare  # noqa: E402

_WARM_UP = 3.0


def measure(scene: str, molecules: int, seconds: float, pace: float) -> dict[str, Any]:
    """Return the pictures a second, the share of the time, and the bytes per picture for a number of molecules."""
    words = ["live", scene, "--set", f"molecules={molecules}", "--no-browser", "--quiet"]
    session = Session(prepare(scene, {"molecules": molecules}))
    unit = session.picture.time
    session.obey({"type": "pace", "value": pace})
    session.obey({"type": "play"})
    before = unit()
    session.run(1.0)
    wanted = unit() - before
    with tempfile.TemporaryDirectory() as folder, subprocess.Popen(
        [sys.executable, "-m", "atmosbox", *words], cwd=folder, stdout=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    ) as program:  # fmt: skip
        assert program.stdout is not None
        address = program.stdout.readline().strip()
        try:
            with connect(address.replace("http", "ws", 1).replace("/?", "/socket?"), max_size=2**26) as page:
                page.send(json.dumps({"type": "pace", "value": pace}))
                page.send(json.dumps({"type": "play"}))
                listen(page, min(_WARM_UP, seconds))
                began = time.perf_counter()
                pictures, words_told = listen(page, seconds)
                lasted = time.perf_counter() - began
        finally:
            program.terminate()
    first, last = (struct.unpack("<Id", picture[:12]) for picture in (pictures[0], pictures[-1]))
    return {
        "scene": scene,
        "molecules": molecules,
        "pace": pace,
        "pictures_per_second": round(len(pictures) / lasted, 1),
        "share_of_the_time_asked_for": round((last[1] - first[1]) / lasted / wanted, 2),
        "bytes_per_picture": len(pictures[-1]),
        "words_per_second": round(words_told / lasted, 1),
    }


def listen(page: Any, seconds: float) -> tuple[list[bytes], int]:
    """Return the pictures that arrive in a time, and the number of text messages."""
    pictures: list[bytes] = []
    words = 0
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        message = page.recv(timeout=60)
        if isinstance(message, bytes):
            pictures.append(message)
        else:
            words += 1
    return pictures, words


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else "")
    parser.add_argument("--scene", default="temperature")
    parser.add_argument("--molecules", type=int, nargs="+", default=[800, 5000])
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--pace", type=float, default=1.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    print("| scene | molecules | pictures/s | share of the time asked for | kB a picture |")
    print("|---|---|---|---|---|")
    found = []
    for molecules in options.molecules:
        one = measure(options.scene, molecules, options.seconds, options.pace)
        found.append(one)
        print(
            f"| {one['scene']} | {molecules} | {one['pictures_per_second']} | {one['share_of_the_time_asked_for']} "
            f"| {one['bytes_per_picture'] / 1000:.1f} |",
            flush=True,
        )
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
