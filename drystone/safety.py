"""The factor of safety on friction: how far the shear strength of all joints can fall before a wall does.

Strength reduction: at the factor F every joint has the friction mu / F and the cohesion c / F, its tensile strength and
the loads as they are (Zienkiewicz, Humpheson and Lewis 1975; Dawson, Roth and Drescher 1999).
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from drystone.analysis import Result
from drystone.walls import Wall
from harness.engine import pipeline
from harness.engine.executors import InProcess, LocalExecutor
from harness.engine.plan import check_methods
from harness.engine.run import Limits, Run
from harness.model.assembly import Assembly
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.method import Finding, Status, check_takes, load_method
from harness.model.reading import validate


@dataclass(frozen=True)
class ReducedWall:
    """A wall with the shear strength of its joints divided by a factor, under a load that stays, as a run sees it.

    Attributes:
        case: the wall as it is described.
        factor: by which friction and cohesion are divided; infinite: they are zero.
        share: multiple of the live load that acts beside the dead load.
    """

    case: Case
    factor: float
    share: float = 0.0

    @property
    def id(self) -> str:
        """The name of the wall."""
        return self.case.id

    @property
    def content(self) -> str:
        """Hash of the wall, the factor and the share."""
        return hashlib.sha256(f"{self.case.content} {self.factor!r} {self.share!r}".encode()).hexdigest()

    @cached_property
    def assembly(self) -> Assembly:
        """The wall without a live load; dilatancy is no larger than the friction that is left."""
        drawn = self.case.assembly
        friction, constant = drawn.friction / self.factor, drawn.constant.copy()
        constant[:, 2:] /= self.factor
        return replace(
            drawn,
            friction=friction,
            dilatancy=np.minimum(drawn.dilatancy, friction),
            constant=constant,
            dead=drawn.dead + self.share * drawn.live,
            live=np.zeros_like(drawn.live),
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Those of the wall as it is described."""
        return self.case.warnings


@dataclass(frozen=True, eq=False)
class FactorOfSafety:
    """The factor of safety on friction, between a state that stands and one that falls.

    Attributes:
        wall: the wall; method: that found it; share: multiple of the live load that acts.
        lower: the largest factor at which the wall was found to stand; zero: none was found.
        upper: the least factor at which it was found to fall; infinite: none was found.
        stands, falls: the results at these two, judged; None where there is none.
        runs: number of runs asked for.
        reason: why the bracket is wider than was asked for; empty where it is not.
    """

    wall: Wall
    method: str
    share: float
    lower: float
    upper: float
    stands: Result | None
    falls: Result | None
    runs: int
    reason: str

    @property
    def value(self) -> float | None:
        """The lower end of the bracket; infinite: the wall stands without friction; None: no standing wall was found."""
        return None if self.stands is None else self.lower

    @property
    def standing_proved(self) -> bool:
        """Whether the judge accepted forces in equilibrium and within yield at the lower end."""
        return self.stands is not None and self.stands.judge.accepted is True

    @property
    def fall_proved(self) -> bool:
        """Whether the judge accepted that no equilibrium exists at the upper end."""
        return self.falls is not None and self.falls.judge.accepted is True

    @property
    def sentence(self) -> str:
        """What was found, between which ends, and what is proved of them."""
        if self.stands is None and self.falls is None:
            return f"Whether the wall stands was not found. {self.reason}"
        if self.falls is None and math.isinf(self.lower):
            found = "The wall stands without friction: the factor of safety on friction is infinite."
        elif self.falls is None:
            found = f"The factor of safety on friction is at least {self.lower:.7g}; no factor at which it falls was found."
        elif self.stands is None:
            found = f"The factor of safety on friction is below {self.upper:.7g}; no factor at which it stands was found."
        else:
            found = f"The factor of safety on friction is {self.lower:.7g}; the wall falls at {self.upper:.7g}."
        return " ".join(filter(None, (found, self.reason, *self._proofs())))

    def _proofs(self) -> Iterator[str]:
        if self.stands is not None:
            at = "without friction" if math.isinf(self.lower) else f"at {self.lower:.7g}"
            yield (
                f"Proved: an equilibrium within yield exists {at}."
                if self.standing_proved
                else f"That it stands {at} is not proved."
            )
        if self.falls is not None:
            yield (
                f"Proved: no equilibrium exists at {self.upper:.7g} and above."
                if self.fall_proved
                else f"That it falls at {self.upper:.7g} was computed by {self.method} and is not proved."
            )

    def as_json(self) -> dict[str, Any]:
        """JSON values; what is infinite is null."""
        ends = {
            name: None if end is None else {"factor": _finite(at), "proved": proved, "result": end.summary()}
            for name, end, at, proved in (
                ("stands", self.stands, self.lower, self.standing_proved),
                ("falls", self.falls, self.upper, self.fall_proved),
            )
        }
        return {
            "case": self.wall.name,
            "method": self.method,
            "share": self.share,
            "factor": None if self.value is None else _finite(self.value),
            "infinite": self.value == math.inf,
            "bracket": [_finite(self.lower), _finite(self.upper)],
            "sentence": self.sentence,
            "runs": self.runs,
            **ends,
        }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def factor(
    wall: Wall,
    method: str = "la",
    *,
    share: float = 0.0,
    accuracy: float | None = None,
    furthest: float = 2.0**16,
    isolated: bool = False,
    limits: Limits | None = None,
    store: str | Path | None = None,
    fresh: bool = False,
    **settings: Any,
) -> FactorOfSafety:
    """The largest factor by which friction and cohesion of all joints can be divided before the wall falls.

    >>> import drystone
    >>> leaning = drystone.library_wall("incline-down")
    >>> drystone.factor(leaning).sentence[:40]
    ''

    The wall without friction is asked first. Where it falls, the factor is bracketed by squares, from 2, and bisected.

    Args:
        wall: the wall; its live load acts by its share alone.
        method: the name of the method whose finding is taken.
        share: multiple of the live load that acts beside the dead load.
        accuracy: relative width at which the bracket is narrow enough; None: 1e-6, or what a method that measures
            states of itself.
        furthest: the factor is sought from 1 / furthest to furthest.
        isolated, store, settings: as of `analyse`.
        limits: of one run, where it is isolated; None: those that are usual.
        fresh: run what is in the store as well.

    Raises:
        InputError: an unknown method or setting, a share of a live load that the wall does not have, an accuracy or a
            range that is none, or a wall that the method refuses.
    """
    check_methods([method], "method")
    loaded = load_method(method)
    validate(loaded.Settings, settings, "settings")
    try:
        check_takes(loaded, wall.assembly)
    except InputError as error:
        error.source = error.source or wall.case.origin
        raise
    if share != 0.0 and not wall.assembly.has_live_load:
        raise InputError("a share of the live load is asked for and there is none", "Give loads.live", "loads.live")
    if not math.isfinite(share):
        raise InputError(f"the share {share} is no number", "Give a finite one, as 0.5", "share")
    if accuracy is None:
        accuracy = loaded.traits.accuracy if loaded.traits.brackets else 1e-6
    if not 1e-12 <= accuracy < 1.0:
        raise InputError(f"the accuracy {accuracy:g} is none", "Give one from 1e-12 to below 1", "accuracy")
    if not 1.0 < furthest < math.inf:
        raise InputError(f"the furthest factor {furthest:g} is none", "Give one above 1", "furthest")
    executor = LocalExecutor(1) if isolated else InProcess()
    with pipeline.opened_at(store) as opened:

        def run(factor: float) -> Result:
            reduced = ReducedWall(wall.case, factor, share)
            asked = Run(reduced, method, settings, (limits or Limits()) if isolated else None)
            (record,) = pipeline.execute([asked], opened, 1, fresh=fresh, executor=executor)
            return Result.on(wall, record)

        search = _Search(run)
        search.bracket(furthest)
        search.bisect(accuracy)
    return FactorOfSafety(
        wall,
        method,
        share,
        search.lower,
        search.upper,
        search.stands,
        search.falls,
        search.runs,
        search.reason,
    )


@dataclass
class _Search:
    """The search for the factor at which a wall begins to fall.

    Attributes:
        run: makes the judged result of a factor.
        lower, upper, stands, falls, runs, reason: as of `FactorOfSafety`.
    """

    run: Callable[[float], Result]
    lower: float = 0.0
    upper: float = math.inf
    stands: Result | None = None
    falls: Result | None = None
    runs: int = 0
    reason: str = ""

    def bracket(self, furthest: float) -> None:
        """Ask the wall without friction, then as drawn, then at the factors 2, 4, 16, ... or their inverses."""
        if self._holds(math.inf):
            return
        self.reason = ""  # a method may have no answer without friction
        drawn, exponent = self._holds(1.0), 1.0
        while drawn is not None and 2.0**exponent <= furthest:
            found = self._holds(2.0 ** (exponent if drawn else -exponent))
            if found is not drawn:
                return
            exponent *= 2.0

    def bisect(self, accuracy: float) -> None:
        """Halve the bracket on a logarithmic scale until its relative width is no larger than the accuracy."""
        while 0.0 < self.lower and self.lower * (1.0 + accuracy) < self.upper < math.inf:
            if self._holds(math.sqrt(self.lower) * math.sqrt(self.upper)) is None:
                return

    def _holds(self, factor: float) -> bool | None:
        """Whether the wall stands at a factor, which becomes an end of the bracket; None: not decided, for a reason."""
        result = self.run(factor)
        self.runs += 1
        if result.finding is Finding.STANDS and result.judge.accepted:
            self.lower, self.stands = factor, result
            return True
        if result.finding is Finding.FALLS and result.judge.accepted is not False:
            self.upper, self.falls = factor, result
            return False
        decided = result.status is Status.OK and result.finding in (Finding.STANDS, Finding.FALLS)
        why = result.judge.sentence if decided else result.sentence
        self.reason = f"At {factor:.7g} the run decides nothing: {why.rstrip('.')}."
        return None
