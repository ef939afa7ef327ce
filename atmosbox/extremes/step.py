"""Time steps far too large: molecules that pass through each other, and through the box."""

import math

from atmosbox import theory
from atmosbox.engine.walls import Periodic
from atmosbox.extremes.extreme import ANY, extreme
from atmosbox.extremes.law import by_chance, seen_share, step_of
from atmosbox.extremes.trial import Trial
from atmosbox.extremes.verdict import Verdict, degraded, judged

_NUMBER, _PACKING = 256, 0.01
_STEPS = 1000


def _coarse(trial: Trial, delta: float) -> Verdict:
    side = (_NUMBER * math.pi / 6.0 / _PACKING) ** (1.0 / 3.0)
    options = {"stepped": {"delta": delta}, "classic": {"delta": delta}, "dsmc": {"dt": delta}}
    gas = trial.gas(_NUMBER, (side,) * 3, walls=(Periodic(),) * 6, options=options.get(trial.engine, {}))
    trial.run(gas, 20.0 * step_of(gas) or 100.0)
    before, time = gas.contacts, gas.time
    trial.run(gas, time + (_STEPS * step_of(gas) or 2000.0))
    met = gas.contacts - before
    density = _NUMBER / gas.volume
    rate = 0.5 * (_NUMBER - 1) * float(theory.collision_rate(density, 1.0, 1.0, 1.0)) * (gas.time - time)
    thin = rate / float(theory.contact_value(_PACKING))
    if not step_of(gas):
        return judged("contacts over theory: there is no step", met / rate, 1.0, 4.0 / math.sqrt(rate) + 0.005)
    if by_chance(gas):
        return judged("contacts over theory: chance knows no step", met / thin, 1.0, 4.0 / math.sqrt(thin) + 0.005)
    left = seen_share(step_of(gas))
    what = f"contacts over theory, with steps of δ = {step_of(gas):.3g}; as many as chance places on each other"
    # 4 standard errors of a count: 6 false alarms in 100 000
    return degraded(what, met / thin, left, 4.0 * math.sqrt(left / thin) + 0.03 * left)


@extreme("step-of-ten-diameters", "steps of 10 σ", may_refuse=("stepped", "dsmc"))
def ten_diameters(trial: Trial) -> Verdict:
    """Step so far that molecules pass through each other: it is refused, or as many meet as chance lets."""
    return _coarse(trial, 10.0)


@extreme("step-of-the-box", "steps of 40 boxes", may_refuse=ANY)
def whole_box(trial: Trial) -> Verdict:
    """Step so far that molecules pass through the box dozens of times: it is refused, or chance rules."""
    return _coarse(trial, 1000.0)
