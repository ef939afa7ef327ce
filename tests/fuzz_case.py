"""Checks of every case of a fuzz test: it must end within some seconds of processor time; and counts of the cases."""

import contextlib
import signal
from collections import Counter

from tests import in_process

CASES = Counter()
"""Number of cases, by what was fuzzed and by their outcome."""
STATUSES = (0, 1, 2, 3, 130)
_LONGEST = 20.0


class Endless(BaseException):
    """A case has not come to an end."""


@contextlib.contextmanager
def fuzz_case(kind):
    """Count a case, and stop it after twenty seconds of processor time; waiting for other programs does not count.

    An exception cannot stop a library that never returns to Python: the whole test process is killed after a minute.
    """

    def stop(number, frame):
        raise Endless(f"{kind}: no end in {_LONGEST} s of processor time")

    CASES[kind] += 1
    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, _LONGEST)
    signal.setitimer(signal.ITIMER_VIRTUAL, 3.0 * _LONGEST)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def typed(kind, *words):
    """Type a command in this process; return its result after checking that a failure, if any, was one sentence."""
    with fuzz_case(kind):
        result = in_process.typed(*words)
    said = f"{words}: {result.exception!r}\n{result.output}"
    assert result.exit_code in STATUSES, said
    assert result.exception is None or isinstance(result.exception, SystemExit), said
    assert "Traceback" not in result.output, said
    assert "this is a bug" not in result.output.lower(), said
    if result.exit_code in (1, 2):
        assert result.stdout == "", said
        lines = [line for line in result.stderr.splitlines() if not line.startswith(("note: ", "warning: "))]
        assert lines, said
        if lines[0].startswith("error: "):
            assert len(lines) == 1, said
        else:
            assert lines[0].startswith("Usage: "), said
    CASES[f"{kind}, status {result.exit_code}"] += 1
    return result
