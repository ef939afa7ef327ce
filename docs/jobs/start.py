"""The first five minutes: what a reader types, what comes, and the figure."""

import tempfile
from pathlib import Path

from jobs.generated import console, typed
from jobs.registry import Findings, job, rounded

from atmosbox.file.netcdf import read
from atmosbox.plot import figure
from atmosbox.simulation import runner

RUN = "run lifting-dry --set molecules=2000 --out lift.nc"


@job("start")
def start(found: Findings) -> None:
    """Type the commands of the page, and keep what they print and draw."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found.text(console(RUN, folder), key="run")
        found.text(console("plot lift.nc", folder), key="plot")
        typed(*RUN.replace("lift.nc", "spheres.nc").split(), "--set", "rotation=off", folder=folder)
        air, spheres = read(folder / "lift.nc"), read(folder / "spheres.nc")
        for dataset in (air, spheres):
            at_top = float(dataset.temperature_at_300_hpa), float(dataset.temperature_at_300_hpa_se)
            found.agree("300 hPa", *at_top, float(dataset.temperature_at_300_hpa_theory), limit=1.5)
        found.rows = []
        ground = runner.prepare("lifting-dry", {}).settings.si.temperature
        cooling = ground - float(air.temperature_at_300_hpa)
        found.number("cooling", f"{rounded(cooling, 3)} K")
        found.number("colder", f"{rounded(float(air.temperature_at_300_hpa - spheres.temperature_at_300_hpa))} K")
        found.figure(figure(air, "slides"), "start", 100)
