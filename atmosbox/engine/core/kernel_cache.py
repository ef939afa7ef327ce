"""Where the machine code of kernels is kept, and reports of the compilations that really happen.

numba's own disk cache watches only the file that holds a function, not the other files that it calls or whose constants
it uses. Here the cache is kept under a digest of all the engine's code, so that any edit of code, or a newly installed
version, starts a new cache, and an edited comment does not. That is right only because the engine imports nothing of
atmosbox from outside its folder, which a test enforces.
"""

import ast
import contextlib
import errno
import functools
import hashlib
import os
import re
import stat
import sys
import tempfile
import uuid
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

_NO_LINK = getattr(os, "O_NOFOLLOW", 0)
_DIGEST = re.compile(rb"[0-9a-f]{16}")


def code_of(source: str) -> str:
    """Return the code of a source: its syntax tree without docstrings, comments and line numbers."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            # a text that stands alone is a docstring, or the description of a constant
            node.body = [part for part in body if not _is_text(part)]  # type: ignore[attr-defined]
    return ast.dump(tree)


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def source_digest(folder: Path | None = None, memory: Path | None = None) -> str:
    """Return a short digest of the code in a folder, by default the engine's, of numba and of Python.

    Only code counts: an edited docstring or comment leaves the digest as it is. The folder ``memory`` keeps the digests
    of earlier sources, because parsing all sources again takes a tenth of a second.
    """
    from importlib.metadata import version as version_of

    folder = folder or Path(__file__).parents[1]
    sources = {file.relative_to(folder).as_posix(): file.read_bytes() for file in sorted(folder.rglob("*.py"))}
    version = f"{version_of('numba')} {sys.version}"
    written = _digest([version, *(f"{name} {hashlib.sha256(text).hexdigest()}" for name, text in sources.items())])
    known = memory / f"{written}.digest" if memory else None
    if known:
        with contextlib.suppress(OSError):
            held = own_content(known)
            if _DIGEST.fullmatch(held):  # a power failure may leave anything in a file
                return held.decode()
    digest = _digest([version, *(f"{name} {code_of(text.decode())}" for name, text in sources.items())])
    if known:
        keep(known, digest.encode())
    return digest


def _digest(lines: list[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def _homes_of_caches() -> list[Path]:
    """Return the folders in which a cache may be kept, best first."""
    if sys.platform == "win32":
        usual = os.environ.get("LOCALAPPDATA", tempfile.gettempdir())
    elif sys.platform == "darwin":
        usual = "~/Library/Caches"
    else:
        usual = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    owner = str(os.getuid()) if hasattr(os, "getuid") else os.environ.get("USERNAME", "cache")
    homes = [Path(tempfile.gettempdir()) / f"atmosbox-{owner}"]
    with contextlib.suppress(RuntimeError):  # in a container, a user may be a number that has no home
        homes.insert(0, Path(usual).expanduser() / "atmosbox")
    asked = os.environ.get("NUMBA_CACHE_DIR")
    return [Path(asked), *homes] if asked else homes


def own_folder(folder: Path) -> Path:
    """Return a folder whose files may be run; make it if needed.

    A link is refused, and a folder that belongs to another user, or that other users can write to.
    """
    for each in reversed((folder, *folder.parents)):
        if not os.path.lexists(each):
            with contextlib.suppress(FileExistsError):  # another process was faster
                each.mkdir(mode=0o700)
    _refuse_foreign(folder, folder.lstat())
    return folder


def own_content(path: Path) -> bytes:
    """Return the content of a file that no other user can have written, or refuse it.

    The file is checked after it was opened, so it does not matter who can write to the folders above it.
    """
    try:
        with open(path, "rb", opener=lambda name, flags: os.open(name, flags | _NO_LINK)) as file:
            _refuse_foreign(path, os.fstat(file.fileno()))
            return file.read()
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise ForeignError(path, "it is a link") from error
        raise


def keep(path: Path, content: bytes) -> None:
    """Put a file whole into the cache; only its owner may read it or write to it."""
    new = path.with_name(f"{path.name}.{uuid.uuid4().hex[:16]}.tmp")
    try:
        with open(new, "xb", opener=lambda name, flags: os.open(name, flags, 0o600)) as file:
            file.write(content)
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


class ForeignError(PermissionError):
    """A folder or file of the cache that another user may have written: what is in it would be run."""

    def __init__(self, path: Path, reason: str, remedy: str = "remove it") -> None:
        super().__init__(f"{path} is not used for compiled code, because {reason}: {remedy}.")


@contextlib.contextmanager
def excused() -> Iterator[None]:
    """Go on without what cannot be read or written, and warn once of what is not ours."""
    try:
        yield
    except ForeignError as error:
        _warn_once(str(error))
    except Exception:
        pass


@functools.cache
def _warn_once(sentence: str) -> None:
    warnings.warn(sentence, stacklevel=2)


def _refuse_foreign(path: Path, about: os.stat_result) -> None:
    """Refuse what another user may have written."""
    if not hasattr(os, "getuid"):
        return
    if stat.S_ISLNK(about.st_mode):
        raise ForeignError(path, "it is a link")
    if about.st_uid != os.getuid():
        raise ForeignError(path, "it belongs to another user")
    if about.st_mode & 0o022:
        raise ForeignError(path, "other users may write to it", f"type chmod go-w {path}")


def cache_folder() -> Path | None:
    """Return the folder of this engine's machine code, made if needed, or None where no folder can be used.

    ``NUMBA_CACHE_DIR`` is respected if it can be used; with a read-only home, a folder of the user's own among the
    temporary files is used. A folder that belongs to another user, or that others may write to, is not used, and a
    warning says so: its files would be run.
    """
    for home in _homes_of_caches():
        with excused():
            own_folder(home)
            folder = own_folder(home / source_digest(memory=home))
            with tempfile.TemporaryFile(dir=folder):
                return folder
    return None


_WATCHES: list[Callable[[str, bool], None]] = []


@contextlib.contextmanager
def compilations(watch: Callable[[str, bool], None]) -> Iterator[None]:
    """Report every kernel that is compiled while a block runs; kernels found in the cache are not reported.

    ``watch`` is called with the name of the kernel and True when its compilation begins, and with False when it has
    ended.
    """
    _WATCHES.append(watch)
    try:
        yield
    finally:
        _WATCHES.remove(watch)


def announce(name: str, begins: bool) -> None:
    """Tell all watchers that the compilation of a kernel begins, or has ended."""
    for watch in tuple(_WATCHES):
        watch(name, begins)
