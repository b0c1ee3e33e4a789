"""The factor of safety on friction: how far the shear strength of all joints can fall before a wall does.

Strength reduction: at the factor F every joint has the friction mu / F and the cohesion c / F, its tensile strength and
the loads as they are (Zienkiewicz, Humpheson and Lewis 1975; Dawson, Roth and Drescher 1999).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from drystone.walls import Wall, checked_wall
from harness.engine.judge import judge
from harness.engine.pipeline import Runs
from harness.engine.plan import check_methods, check_taken, takers
from harness.engine.run import Limits
from harness.model.assembly import Assembly
from harness.model.case import Case
from harness.model.content import exact_hash_of
from harness.model.errors import InputError
from harness.model.fields import LARGEST
from harness.model.input_checks import plastic_strength
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import validate
from harness.model.result import Result

_WITHOUT_SELF_STRESS = ("fe", "de")
"""Methods that load a wall from rest, so that its joints carry no self-stress but what the loads cause."""
_NONE_WITHOUT = f"and none of {', '.join(_WITHOUT_SELF_STRESS)}, which would find that, takes this wall"


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
        """Hash of the assembly."""
        return exact_hash_of(self.assembly)

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
        """Those of the wall as it is described, and that strength which a factor divides is never lost."""
        return (*self.case.warnings, *plastic_strength(self.case.assembly))


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
    def warnings(self) -> tuple[str, ...]:
        """What a person should hear about the wall and the strength of its joints."""
        return ReducedWall(self.wall.case, 1.0, self.share).warnings

    @property
    def value(self) -> float | None:
        """The lower end of the bracket; infinite: the wall stands without friction; None: nothing stands."""
        return None if self.stands is None else self.lower

    @property
    def fall_proved(self) -> bool:
        """Whether the judge accepted that no equilibrium exists at the upper end."""
        return self.falls is not None and self.falls.judge.accepted is True

    @property
    def sentence(self) -> str:
        """What was found, between which ends, and what is proved of them."""
        return " ".join(filter(None, (self._found(), self.reason, *self._proofs())))

    def _found(self) -> str:
        if self.stands is None:
            if self.falls is None:
                return "Whether the wall stands was not found."
            if math.isinf(self.upper):
                return "The wall falls without friction; no state was found that stands."
            if self.upper >= 1.0 or self.reason:
                return f"The wall falls with its friction divided by {self.upper:.8g}; no state was found that stands."
            return (
                f"No factor of safety exists: the wall falls even with friction {1.0 / self.upper:.8g} times as large."
            )
        if math.isinf(self.lower):
            return "The wall stands without friction: the factor of safety on friction is infinite."
        if math.isinf(self.upper):
            return f"The factor of safety on friction is at least {self.lower:.8g}."
        return f"The factor of safety on friction is {self.lower:.8g}; the wall falls at {self.upper:.8g}."

    def _proofs(self) -> Iterator[str]:
        if self.stands is not None:
            if math.isinf(self.lower):
                yield "The judge accepted its equilibrium."
                return
            yield f"The judge accepted an equilibrium within yield at {self.lower:.8g}."
            if self.stands.traits.any_self_stress:
                without = " and ".join(takers(self.wall.case, _WITHOUT_SELF_STRESS))
                yield (
                    "Joints may carry any self-stress in it: a wall whose joints slide without dilatancy can fall "
                    f"earlier, {f'so ask {without} too' if without else _NONE_WITHOUT}."
                )
        if self.falls is not None:
            at = "without friction" if math.isinf(self.upper) else f"at {self.upper:.8g} and above"
            if self.fall_proved:
                yield f"Proved: no equilibrium exists {at}."
            else:
                yield f"The fall was computed by {self.method}; that no equilibrium exists is not proved."

    def as_json(self) -> dict[str, Any]:
        """JSON values; what is infinite is null."""
        ends = {
            name: None if end is None else {"factor": _finite(at), "result": end.summary()}
            for name, end, at in (("stands", self.stands, self.lower), ("falls", self.falls, self.upper))
        }
        return {
            "case": self.wall.name,
            "method": self.method,
            "share": self.share,
            "factor": None if self.value is None else _finite(self.value),
            "infinite": self.value == math.inf,
            "bracket": [_finite(self.lower), _finite(self.upper)],
            "sentence": self.sentence,
            "fall_proved": self.fall_proved,
            "runs": self.runs,
            "warnings": list(self.warnings),
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
    isolated: bool = False,
    seconds: float = Limits().seconds,
    memory_bytes: int = Limits().memory_bytes,
    store: str | Path | None = None,
    **settings: Any,
) -> FactorOfSafety:
    """The largest factor by which friction and cohesion of all joints can be divided before the wall falls.

    >>> from drystone import library_wall
    >>> print(f"{factor(library_wall('incline-down')).value:.3f}")  # friction 0.5 on 10 degrees
    2.836

    Args:
        wall: the wall; of its live load only the share acts.
        method: the name of the method whose finding is taken.
        share: multiple of the live load that acts beside the dead load.
        accuracy: relative width at which the bracket is narrow enough; None: 1e-4, or the accuracy that a method states
            which measures.
        isolated, seconds, memory_bytes, store, settings: as of `analyse`; limits are of one run.

    Raises:
        InputError: an unknown method or setting, a share of a live load that the wall does not have, an accuracy out of
            range, or a wall that the method refuses.
    """
    runs = Runs(Limits(seconds, memory_bytes) if isolated else None, store)
    return factor_by(wall, method, settings, share=share, accuracy=accuracy, runs=runs)


def factor_by(
    wall: Wall,
    method: str,
    settings: dict[str, Any],
    *,
    share: float = 0.0,
    accuracy: float | None = None,
    furthest: float = 2.0**16,
    runs: Runs = Runs(),
) -> FactorOfSafety:
    """As `factor`, with settings that may have any name, `seconds` among them.

    Args:
        wall, method, settings, share, accuracy: see `factor`.
        furthest: the factor is sought from 1 / furthest to furthest.
        runs: how they are made.

    Raises:
        InputError: as `factor`.
    """
    wall = checked_wall(wall)
    check_methods([method], "method")
    loaded = load_method(method)
    validate(loaded.Settings, settings, "settings")
    if not abs(share) <= LARGEST:
        raise InputError(f"the share {share} is no number up to {LARGEST:g}", "Give one as 0.5", "share")
    if accuracy is None:
        accuracy = loaded.traits.accuracy if loaded.traits.brackets else 1e-4
    if not 1e-12 <= accuracy < 1.0:
        raise InputError(f"the accuracy {accuracy:g} is out of range", "Give one from 1e-12 to below 1", "accuracy")
    check_taken(loaded, wall.case, "--method")
    if share != 0.0 and not wall.assembly.has_live_load:
        raise InputError(
            "a share of the live load is asked for and there is none",
            'Give "loads": {"live": ...}, or the share 0',
            "loads.live",
            wall.case.origin,
        )
    alone = partial(judge, alone=True)
    search = FactorSearch(lambda at: runs.result(ReducedWall(wall.case, at, share), method, settings, alone))
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
class FactorSearch:
    """The search for the factor at which a wall begins to fall.

    Attributes:
        run: makes the judged result of a factor.
        lower, upper, stands, falls, runs, reason: as of `FactorOfSafety`.
        cut_off: a run was ended by a limit or crashed; further ones would be too.
    """

    run: Callable[[float], Result]
    lower: float = 0.0
    upper: float = math.inf
    stands: Result | None = None
    falls: Result | None = None
    runs: int = 0
    reason: str = ""
    cut_off: bool = False

    def bracket(self, furthest: float) -> None:
        """Ask the wall without friction, then as drawn, then at the factors 2, 4, 16, ... or their inverses."""
        if self._holds(math.inf) or self.cut_off:
            return
        self.reason = ""  # a method may have no answer without friction
        drawn, exponent = self._holds(1.0), 1.0
        while drawn is not None and 2.0**exponent <= furthest:
            found = self._holds(2.0 ** (exponent if drawn else -exponent))
            if found is not drawn:
                return
            exponent *= 2.0

    def bisect(self, accuracy: float) -> None:
        """Halve the bracket on a logarithmic scale until its relative width is no larger than the accuracy.

        Factors at which the method decides nothing are left between the ends, which close in on them from both sides.
        """
        doubt: tuple[float, float] | None = None
        while self.lower > 0.0 and self.upper < math.inf and not self.cut_off:
            if doubt is not None and not self.lower < doubt[0] <= doubt[1] < self.upper:
                doubt, self.reason = None, ""
            if self.upper <= self.lower * (1.0 + accuracy):
                self.reason = ""
                return
            gaps = [(self.lower, self.upper)] if doubt is None else [(self.lower, doubt[0]), (doubt[1], self.upper)]
            low, high = max(gaps, key=lambda gap: gap[1] / gap[0])
            if high <= low * (1.0 + 0.25 * accuracy):
                return
            middle = math.sqrt(low) * math.sqrt(high)
            if self._holds(middle) is None:
                doubt = (middle, middle) if doubt is None else (min(doubt[0], middle), max(doubt[1], middle))

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
        answered = result.status in (Status.OK, Status.NOT_CONVERGED)
        decided = result.finding in (Finding.STANDS, Finding.FALLS)
        why = result.judge.sentence if decided else result.sentence
        where = "Without friction" if math.isinf(factor) else f"At {factor:.7g}"
        self.reason = f"{where} the run decides nothing: {why.rstrip('.')}."
        self.cut_off = not answered
        return None
