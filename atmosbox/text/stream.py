"""Output streams: the result goes to stdout, everything else to stderr."""

import contextlib
import json
import math
import os
import sys
from collections.abc import Mapping
from typing import Any, TextIO

from atmosbox.errors import AtmosboxError


def say(text: str) -> None:
    r"""Write a line or more of the result to stdout.

    If the reader, for example ``head``, has closed the pipe, the command goes on.

    >>> say("two\nlines")
    two
    lines
    """
    try:
        _write(sys.stdout, text)
    except BrokenPipeError:
        # Python flushes stdout when it exits, and that must not fail.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        sys.stdout = None  # so that the flush when Python exits does not fail again
        raise AtmosboxError(f"The result cannot be written to stdout: {error.strerror}.") from error


def tell(text: str) -> None:
    """Write a line that is not the result to stderr."""
    with contextlib.suppress(OSError):  # the reader may have closed the pipe
        _write(sys.stderr, text)


def _write(stream: TextIO | None, text: str) -> None:
    """Write a line and flush it; characters that the encoding lacks are replaced."""
    if stream is None:  # the shell closed it
        return
    line = f"{text}\n"
    try:
        line.encode(stream.encoding or "utf-8", stream.errors or "strict")
    except UnicodeEncodeError:
        spelled = line.replace("±", "+-").replace("σ", " sigma")
        line = spelled.encode(stream.encoding, "backslashreplace").decode(stream.encoding)
    stream.write(line)
    stream.flush()


def say_json(content: Mapping[str, Any]) -> None:
    """Write the result as one JSON object; a number that is not finite becomes null.

    >>> say_json({"value": float("nan"), "unit": "K"})
    {
      "value": null,
      "unit": "K"
    }
    """
    say(json.dumps(_finite(content), indent=2, allow_nan=False))


def _finite(content: Any) -> Any:
    """Return a value as JSON can hold it, with None for numbers that are not finite."""
    if isinstance(content, Mapping):
        return {str(name): _finite(value) for name, value in content.items()}
    if isinstance(content, list | tuple):
        return [_finite(value) for value in content]
    return None if isinstance(content, float) and not math.isfinite(content) else content
