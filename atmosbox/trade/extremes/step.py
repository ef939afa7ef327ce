"""Time steps far too large: molecules that pass through each other, and through the box."""

import math
import warnings

from atmosbox import theory
from atmosbox.engine import Periodic
from atmosbox.trade.extremes.extreme import ANY, extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance, seen_share, step_of
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

_NUMBER, _PACKING = 256, 0.01
_STEPS = 1000


def _coarse(trial: Trial, delta: float) -> Verdict:
    side = (_NUMBER * math.pi / 6.0 / _PACKING) ** (1.0 / 3.0)
    options = {"stepped": {"delta": delta}, "classic": {"delta": delta}, "dsmc": {"dt": delta}}
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        gas = trial.gas(_NUMBER, (side,) * 3, walls=(Periodic(),) * 6, options=options.get(trial.engine, {}))
    if trial.engine == "stepped" and not any("would do" in str(each.message) for each in warned):
        return wrong("a coarse step, and no warning that says which step would do")
    trial.run(gas, 20.0 * step_of(gas) or 100.0)
    before, time = gas.contacts, gas.time
    trial.run(gas, time + (max(_STEPS, 500.0 / step_of(gas)) * step_of(gas) if step_of(gas) else 2000.0))
    met = gas.contacts - before
    density = _NUMBER / gas.volume
    rate = 0.5 * (_NUMBER - 1) * float(theory.collision_rate(density, 1.0, 1.0, 1.0)) * (gas.time - time)
    thin = rate / float(theory.contact_value(_PACKING))
    if not step_of(gas):
        return judged("contacts over theory: there is no step", met / rate, 1.0, 4.0 / math.sqrt(rate) + 0.005)
    if by_chance(gas):
        return judged("contacts over theory: chance knows no step", met / thin, 1.0, 4.0 / math.sqrt(thin) + 0.005)
    left = seen_share(step_of(gas))
    what = f"contacts over theory, of which steps of δ = {step_of(gas):.3g} see {left:.2g}"
    # 4 standard errors of a count: 6 false alarms in 100 000
    return degraded(what, met / thin, left, 4.0 * math.sqrt(left / thin) + 0.03 * left)


@extreme("step-of-a-quarter", "steps of σ / 4")
def quarter(trial: Trial) -> Verdict:
    """Step so far that a contact in six is missed: the user is warned, and told which step would do."""
    return _coarse(trial, 0.25)


@extreme("step-of-ten-diameters", "steps of 10 σ", may_refuse=("stepped", "dsmc"))
def ten_diameters(trial: Trial) -> Verdict:
    """Step so far that molecules pass through each other: it is refused, or as many meet as chance lets."""
    return _coarse(trial, 10.0)


@extreme("step-of-the-box", "steps of 40 boxes", may_refuse=ANY)
def whole_box(trial: Trial) -> Verdict:
    """Step so far that molecules pass through the box dozens of times: it is refused, or chance rules."""
    return _coarse(trial, 1000.0)
