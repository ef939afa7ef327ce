"""Provenance: the attributes of a file that say how it was made, and from which the run can be repeated."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from atmosbox.errors import FileError, SettingError
from atmosbox.version import __version__

if TYPE_CHECKING:
    import xarray as xr

FORMAT = 1
"""The version of the layout of the files, in the attribute ``atmosbox_format``."""


def moment() -> str:
    """Return the time in UTC; SOURCE_DATE_EPOCH sets it, so that a repeated run can give an identical file."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        now = datetime.fromtimestamp(int(epoch), UTC) if epoch else datetime.now(UTC)
    except (ValueError, OverflowError, OSError):
        problem, fix = "is not a number of seconds since 1970", "type unset SOURCE_DATE_EPOCH"
        raise SettingError("SOURCE_DATE_EPOCH", epoch, problem, fix) from None
    return now.strftime("%Y-%m-%dT%H:%M:%SZ")


def history_line(command: str) -> str:
    """Return the line that a command adds to a file's history: the time in UTC and the command."""
    return f"{moment()}: {command}"


def global_attributes(
    parameters: Mapping[str, Any],
    *,
    title: str,
    command: str,
    comment: str = "",
    references: str = "",
    panels: str = "[]",
    status: str = "complete",
) -> dict[str, Any]:
    """Return the global attributes of a file: what it contains, how it was made and how to repeat the run.

    ``parameters`` is everything that determines the run, as JSON can hold it: ``scene``, ``settings``, ``engine``,
    ``version``. ``title`` says in one line what the file contains, and ``command`` is what the user typed. ``comment``
    and ``references`` are the assumptions of the scene and the literature that it uses, ``panels`` those of its figure,
    as JSON. ``status`` is ``complete``, ``partial`` or ``interrupted``.

    >>> made = global_attributes({"scene": "temperature"}, title="A box", command="atmosbox run temperature")
    >>> made["Conventions"], made["atmosbox_parameters"]
    ('CF-1.11', '{"scene": "temperature"}')
    """
    version = str(parameters.get("version", __version__))
    engine = parameters.get("engine")
    attributes: dict[str, Any] = {
        "Conventions": "CF-1.11",
        "title": title,
        "institution": "not stated; a simulation for teaching",
        "source": f"atmosbox {version}, colliding hard spheres" + (f", {engine} engine" if engine else ""),
        "history": history_line(command),
        "references": references,
        "comment": comment,
        "license": "CC0-1.0",
        "date_created": moment(),
        "product_version": version,
        "atmosbox_format": FORMAT,
        "atmosbox_status": status,
        "atmosbox_parameters": json.dumps(dict(parameters), allow_nan=False),
        "atmosbox_panels": panels,
    }
    return {name: value for name, value in attributes.items() if value != ""}


def parameters(dataset: xr.Dataset) -> dict[str, Any]:
    """Return everything that determines a run, so that it can be repeated.

    >>> import xarray
    >>> made = global_attributes({"scene": "temperature"}, title="A box", command="a test")
    >>> parameters(xarray.Dataset(attrs=made))
    {'scene': 'temperature'}
    """
    try:
        found = json.loads(dataset.attrs["atmosbox_parameters"])
    except (KeyError, TypeError, ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        name = dataset.encoding.get("source", "This dataset")
        raise FileError(f"{name} does not say which run it holds: give a file that atmosbox has written.")
    return found
