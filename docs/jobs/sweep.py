"""The sweep of saturation over temperature: its figure, and its numbers beside theory."""

import numpy as np
from jobs.registry import Findings, job

from atmosbox.plot.sweep_figure import figure
from atmosbox.sweep import plan, sweep


@job("sweep")
def saturation(found: Findings) -> None:
    """Sweep the vapour pressure over water from -10 to 40 degC."""
    words = ["temperature=-10degC:40degC:6"]
    grid = plan("condensation", words, settings={"molecules": 2000}, members=6, engine="dsmc")
    data = sweep(grid, jobs=1)
    if data.member_status.values.any():
        found.failures.append(f"runs have failed: {data.member_reason.values}")
    name = "mean_water_vapor_partial_pressure"
    columns = [data[key].values / 100.0 for key in (name, f"{name}_se", f"{name}_theory")]
    for kelvin, mean, error, theory in zip(data.temperature.values, *columns, strict=True):
        celsius = f"{np.round(kelvin - 273.15):.0f}".replace("-", "−")
        found.agree(f"vapour pressure at {celsius} °C", mean, error, theory, unit="hPa")
    found.bound("largest residual of the energy budget", float(data.member_ledger.max()), 1e-10)
    found.close()
    found.figure(figure(data), "sweep-condensation", 115)
