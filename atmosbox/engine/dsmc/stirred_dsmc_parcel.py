"""A column of dilute gas with stirring, advanced by direct simulation Monte Carlo."""

from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.inputs import number, whole
from atmosbox.engine.core.parcel import Arrangement, Array
from atmosbox.engine.core.random import new_state
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.core.walls import PISTON
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.dsmc.stirring import Stirring, StirringWork, stir

__all__ = ["StirredDsmcParcel"]

_FEWEST = 10
_USE = 2  # use of the seed, besides those for the run and for its start


class StirredDsmcParcel(DsmcParcel):
    """A column of gas in which parcels change places up and down, each with the work of its piston.

    Its other parameters, and its properties, are described at `DsmcParcel`; the method of stirring, at `stirring`.

    Parameters
    ----------
    stirring
        Size of the parcels, distance that they move, rate of their exchanges.

    Raises
    ------
    RefusedError
        If parcels have fewer than ten molecules, do not fit into the column or rise by less than their own size; if
        there is a piston, or no floor and ceiling.

    Notes
    -----
    Parcels change places between two steps, at times on the fixed grid of steps: so the result does not depend on the
    pieces into which a run is cut. The work is the sum of the energy that each molecule gained.

    Examples
    --------
    Cold air above warm air of the same weight is mixed to one potential temperature, and the ledger holds the work:

    >>> rng = np.random.default_rng(1)
    >>> column = StirredDsmcParcel(
    ...     rng.random((1000, 3)),
    ...     rng.normal(size=(1000, 3)),
    ...     length=(1, 1, 1),
    ...     diameter=0.0,
    ...     gravity=1.0,
    ...     stirring=Stirring(parcel=100, least=200, most=400, rate=20.0, interval=0.1),
    ... )
    >>> column.advance(2.0)
    >>> column.exchanges > 35, column.stirring_work > 0.0, column.ledger() < 1e-12
    (True, True, True)
    """

    engine: ClassVar[str] = "dsmc"

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        stirring: Stirring,
        dt: float = 0.2,
        occupancy: float = 10.0,
        cell: float | None = None,
        threads: int = 1,
        **box: Unpack[Arrangement],
    ) -> None:
        self._stirring = stirring
        self._counted = np.zeros(2)
        self._owed = np.zeros(1)
        super().__init__(position, velocity, dt=dt, occupancy=occupancy, cell=cell, threads=threads, **box)

    # ------------------------------------------------------------------ the state

    @property
    def stirring_work(self) -> float:
        """Work that the stirring has done on the molecules since the start [energy]."""
        return float(self._counted[0])

    @property
    def exchanges(self) -> int:
        """Number of pairs of parcels that have changed places since the start."""
        return int(self._counted[1])

    def set_stirring(self, rate: float) -> None:
        """Set the rate at which pairs of parcels change places [1/time] from now on.

        Raises
        ------
        RefusedError
            If the rate is negative or not finite.
        """
        self._stirring = self._stirring._replace(rate=number(rate, "rate of the stirring", least=0.0))

    # ------------------------------------------------------------------ how steps are made

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        parcel = whole(self._stirring.parcel, "parcel of the stirring", least=_FEWEST)
        least = whole(self._stirring.least, "least lift of the stirring", least=parcel)
        most = whole(self._stirring.most, "most lift of the stirring", least=least)
        if parcel + most > len(position):
            raise RefusedError(
                f"parcels of {parcel} molecules that rise by {most} do not fit into a column of {len(position)}: make "
                "them smaller"
            )
        rate = number(self._stirring.rate, "rate of the stirring", least=0.0)
        interval = number(self._stirring.interval, "interval of the stirring")
        if not interval > 0.0:
            raise RefusedError(f"interval of the stirring = {interval:g} must be above 0")
        if self._walls.law[5] == PISTON or self._periodic[2]:
            raise RefusedError("a column that is stirred has a floor and a ceiling at rest: make both walls")
        self._stirring = Stirring(parcel, least, most, rate, interval, bool(self._stirring.works))
        self._dice = new_state(self._seed, _USE)
        self._factor = np.ones(len(position))
        super()._begin(position, velocity, rotational_energy)

    def _resolve(self, first: int, many: int, ceilings: Array) -> None:
        period = max(1, round(self._stirring.interval / self._time_step))
        if not many:
            super()._resolve(first, many, ceilings)
            self._stir(0)  # compiles the kernel
        done = 0
        while done < many:
            part = min(many - done, period - (first + done) % period)
            super()._resolve(first + done, part, ceilings[done : done + part + 1])
            done += part
            if (first + done) % period == 0:
                self._owed[0] += period * self._time_step * self._stirring.rate
                due = int(self._owed[0])
                self._owed[0] -= due
                if due:
                    self._stir(due)

    def _stir(self, exchanges: int) -> None:
        n = self._number
        wide, deep, _ = self._open_sides()
        order: Any = np.argsort(self._columns.z[:n], kind="stable")
        column = self._gravity, wide * deep, self._gas.radius, self.ceiling - self._gas.radius
        work = StirringWork(self._counted, self._factor)
        stir(exchanges, self._stirring, order, self._columns, self._gas, column, self._dice, work)
