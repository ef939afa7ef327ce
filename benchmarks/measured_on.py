"""The computer and the date of a measurement, which are written into its file."""

import datetime
import json
import os
import platform
import re
from importlib.metadata import version
from pathlib import Path
from typing import Any

__all__ = ["keep", "machine"]


def machine() -> dict[str, Any]:
    """Return the date, the name and number of processors, and the versions of Python and numba."""
    told = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*: (.+)", told.read_text(encoding="utf-8")) if told.is_file() else None
    return {
        "date": datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        "processor": found[1].strip() if found else platform.processor() or platform.machine(),
        "processors": os.cpu_count(),
        "python": platform.python_version(),
        "numba": version("numba"),
    }


def keep(file: Path | None, results: Any) -> None:
    """Write results and a description of the machine into a file, if one is named."""
    if file is not None:
        told = {"measured_on": machine(), "results": results}
        file.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
