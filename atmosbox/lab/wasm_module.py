"""The WebAssembly modules of the package: which box needs which module, and from which sources each was made."""

from __future__ import annotations

import gzip
import hashlib
import sys
from pathlib import Path
from typing import Any

from atmosbox.engine.core.kernel_cache import code_of
from atmosbox.errors import Command, EngineError, Option

FOLDER = Path(__file__).parent / "modules"
SCENES: dict[str, dict[str, Any]] = {
    "temperature": {},
    "elastic-collisions": {},
    "atmosphere": {"molecules": 3000},
    "convection": {},
    "lifting-dry": {},
    "temperature-large": {},
    "diffusion": {"molecules": 4000},
    "attraction": {},
    "evaporation": {"molecules": 3000, "pool": 600},
    "condensation": {"molecules": 3000},
    "lifting-moist": {"molecules": 3000},
    "lifting-sounding": {"molecules": 3000},
    "mountains": {"molecules": 3000},
    "nuclei": {},
}
"""The scenes of atmosbox that a page can run, with settings that they need for it or that suit watching them run."""
BESIDE: tuple[tuple[str, dict[str, Any]], ...] = (
    ("lifting-dry", {"rotation": False}),
    ("diffusion", {"molecules": 4000, "mass_ratio": 10}),
    ("nuclei", {"molecules": 1500}),
)
"""Further settings, for worksheets or for fewer molecules, that need kernels of their own."""


def module_name(modes: Any, *, wells: bool = False) -> str:
    """Return the name of the module for a set of modes; ``wells`` if molecules attract each other.

    >>> from atmosbox.engine.core.state import Modes
    >>> module_name(Modes(True, False, False, False, False, False, False, rows=True))
    'contacts-rows'
    """
    flags = {"wells": wells, **modes._asdict()}
    return "-".join(name for name, is_on in flags.items() if is_on)


def source_stamp() -> str:
    """Return the stamp of a module that is made now: a digest of the code of the engine and of `kernels`.

    Comments and docstrings do not count. The minor version of Python precedes the digest, because the syntax trees of
    two versions differ.
    """
    package = Path(__file__).parents[1]
    files = sorted([*(package / "engine").rglob("*.py"), *(package / "lab" / "kernels").glob("*.py")])
    said = "\n".join(f"{file.relative_to(package).as_posix()} {code_of(file.read_text('utf-8'))}" for file in files)
    return f"{sys.version_info.major}.{sys.version_info.minor} {hashlib.sha256(said.encode()).hexdigest()[:16]}"


def stamp_of(content: bytes) -> str:
    """Return the stamp of a gzipped module: its last section.

    >>> stamp_of(gzip.compress(b"...sources3.11 0123456789abcdef"))
    '3.11 0123456789abcdef'
    """
    return gzip.decompress(content).rpartition(b"sources")[2].decode("ascii")


def elsewhere(scene: str) -> tuple[Command | str, ...]:
    """Return what to do with a scene that cannot run in a page: the parts of the end of a sentence.

    >>> from atmosbox.errors import on_command_line
    >>> print(EngineError("It has no piston", *elsewhere("temperature")).said(on_command_line))
    It has no piston: show a run of it: atmosbox run temperature --save-molecules, then atmosbox view.
    """
    run = Command("run", (scene, Option("save_molecules", True)))
    return "show a run of it: ", run, ", then ", Command("view")


def module_bytes(name: str, scene: str) -> bytes:
    """Return a module by its name, gzipped as it is in the package; say what to do if the package does not have it."""
    path = FOLDER / f"{name}.wasm.gz"
    if not path.is_file():
        if not any(FOLDER.glob("*.wasm.gz")):
            raise EngineError(
                "This checkout has no WebAssembly modules: pip install ziglang and run python tools/wasm.py."
            )
        problem = f"The page has no WebAssembly module for the box of {scene} with these settings ({name})"
        raise EngineError(problem, "take other settings, or ", *elsewhere(scene))
    return path.read_bytes()
