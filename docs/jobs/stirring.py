"""Columns that are stirred: the temperature between rest and the adiabat, and its lapse rate against the stirring."""

import numpy as np
from jobs.drawing import BLUE, axes_of, explain, save
from jobs.registry import Findings, job, rounded

from atmosbox import theory
from atmosbox.plot.theme import DARK, DATA_COLOURS
from atmosbox.simulation import runner
from atmosbox.simulation.runner import Outcome
from tests.oracle.stirred_kinetic import stirred_profiles

RATES = (0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
SHOWN = (1.0, 100.0)


def stirred(stirring: float, **settings: object) -> Outcome:
    """Run a column that is stirred."""
    return runner.execute(runner.prepare("atmosphere", {"stirring": stirring, **settings}))


def lapse(outcome: Outcome) -> tuple[float, float, float, float]:
    """Return the lapse rate, its error, that of theory, and the known error [K/km]."""
    found = {each.name: each for each in outcome.headlines}["lapse_rate_of_the_air"]
    return tuple(1000.0 * each for each in (found.value, found.standard_error, found.theory or 0.0, found.tolerance))  # type: ignore[return-value]


def theoretical(stirring: float, rotation: bool) -> float:
    """Return the lapse rate of theory over that of the adiabat, away from floor and ceiling."""
    prepared = runner.prepare("atmosphere", {"stirring": stirring, "rotation": rotation})
    column = prepared.module.Column(prepared.settings)
    profile = column.stirred()
    inner = slice(round(0.1 * len(profile.height)), -round(0.1 * len(profile.height)))
    slope = np.polyfit(profile.height[inner], profile.temperature[inner], 1)[0]
    return float(-0.5 * (column.freedom + 2) * slope)


@job("stirring")
def stirring(found: Findings) -> None:
    """Stir columns ever faster, of air that rotates and of spheres that do not; lay them beside the column at rest."""
    rest = runner.execute(
        runner.prepare(
            "atmosphere",
            {
                "height": 11,
                "knudsen": 0.02,
                "rotation": True,
                "molecules": 4000,
                "start": "equilibrium",
                "duration": 300,
            },
            engine="dsmc",
        )
    )
    curves = {rotation: [stirred(rate, rotation=rotation) for rate in RATES] for rotation in (True, False)}
    single = stirred(100.0, exchange="molecules")
    adiabats = {
        rotation: 1000.0 * runner.prepare("atmosphere", {"rotation": rotation}).settings.lapse for rotation in curves
    }
    named = {True: "air", False: "spheres that do not rotate"}
    for rotation, outcomes in curves.items():
        for rate, outcome in zip(RATES, outcomes, strict=True):
            value, error, expected, known = lapse(outcome)
            found.agree(f"{named[rotation]}, stirring {rate:g}", value, error, expected, known, "K/km")
        value, error, _, _ = lapse(outcomes[-1])
        found.number(f"fastest-{'air' if rotation else 'spheres'}", rounded(value / adiabats[rotation], 3))
    value, error, expected, known = lapse(single)
    found.agree("air, molecules swapped one by one, stirring 100", value, error, round(expected, 9), known, "K/km")
    fast = curves[True][-1]
    warmer = fast.dataset.layer_temperature - fast.dataset.layer_temperature_theory
    found.number("warmer", rounded(float(warmer.mean()), 2))
    many = stirred(100.0, rotation=True, molecules=16_000).dataset
    found.number("warmer-many", rounded(float((many.layer_temperature - many.layer_temperature_theory).mean()), 2))
    column = stirred_profiles(0.02, 100.0, 5)
    found.number("warmer-kinetic", rounded(288.15 * float((column.kinetic - column.fourier)[30:-30].mean()), 2))
    settled = fast.dataset.isel(elapsed_time=slice(len(fast.dataset.elapsed_time) // 3, None))
    work, heat = (
        float(each[-1] - each[0]) for each in (settled.work_by_stirring, -settled.heat_from_wall.sel(wall="z_low"))
    )
    found.number("taken", rounded(100.0 * heat / work, 3))

    with axes_of(2, (10.4, 4.9), (1.0, 1.0)) as (drawing, (left, right)):
        height = fast.dataset.height.values / 1000.0
        left.plot(
            theory.isa_temperature(1000.0 * height),
            height,
            color="#009e73",
            linestyle="-.",
            label="standard atmosphere",
        )
        adiabat = fast.dataset.layer_temperature_adiabat.values
        left.plot(
            adiabat, height, color=DATA_COLOURS[1], linewidth=5, alpha=0.45, label=f"adiabat, {adiabats[True]:.1f} K/km"
        )
        cases = [("at rest", rest, "o", BLUE), ("stirring 100, single molecules", single, "x", "#cc79a7")]
        cases += [
            (f"stirring {rate:g}, parcels", curves[True][RATES.index(rate)], mark, colour)
            for rate, mark, colour in zip(SHOWN, ("^", "s"), ("#56b4e9", DARK), strict=True)
        ]
        for label, outcome, mark, colour in cases:
            values, errors = (outcome.dataset[f"layer_temperature{each}"].values for each in ("", "_se"))
            left.errorbar(values, height, xerr=errors, fmt=mark, color=colour, markersize=5, label=label)
        left.set(xlabel="temperature (K)", ylabel="height (km)", title="Stirred, the column cools", ylim=(0.0, 11.0))
        left.legend(loc="lower left")
        for rotation, outcomes in curves.items():
            values, errors = np.array([lapse(outcome)[:2] for outcome in outcomes]).T / adiabats[rotation]
            between = np.geomspace(RATES[0], RATES[-1], 25)
            expected = [theoretical(rate, rotation) for rate in between]
            colour = BLUE if rotation else DATA_COLOURS[1]
            fill = colour if rotation else "white"
            mark = "o" if rotation else "D"
            label = f"{named[rotation]}, g/c$_p$ = {adiabats[rotation]:.1f} K/km"
            right.errorbar(
                RATES, values, yerr=errors, fmt=mark, color=colour, markerfacecolor=fill, label=label, zorder=3
            )
            right.plot(
                between,
                expected,
                color=DARK,
                linestyle="--" if rotation else ":",
                label="theory, air" if rotation else "theory, spheres",
            )
        right.axhline(1.0, color="0.7", linewidth=1)
        right.set(
            xscale="log", ylim=(0.0, 1.1), title="Between rest and the adiabat",
            xlabel="heat carried by stirring over that conducted by molecules", ylabel="lapse rate over g/c$_p$",
        )  # fmt: skip
        right.set_xticks(RATES, [f"{rate:g}" for rate in RATES])
        right.minorticks_off()
        right.legend(loc="lower right")
        explain(drawing)
        save(found, drawing, "stirred")
