"""What a method is: a name, its settings and one function from an assembly to an answer."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pkgutil import resolve_name
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import OutOfTime as OutOfTime


class Status(StrEnum):
    """How a run ended. It says nothing about whether the value is right: that is the verdict."""

    OK = "ok"
    NOT_CONVERGED = "not_converged"
    REFUSED = "refused"
    TIMEOUT = "timeout"
    OUT_OF_MEMORY = "out_of_memory"
    CRASHED = "crashed"


class Finding(StrEnum):
    """What an answer says about the wall."""

    COLLAPSES = "collapses"
    """At the multiplier given, by the mechanism given."""
    STANDS = "stands"
    """Under its dead load; no live load is given."""
    FALLS = "falls"
    """Already under its dead load, at multiplier zero."""
    UNBOUNDED = "unbounded"
    """The live load cannot make it collapse."""
    AT_LIMIT = "at its limit"
    """Its multiplier is zero within the accuracy of the numbers that describe the wall (`harness.model.limit`)."""
    NONE = "none"
    """Nothing was found."""

    @property
    def has_multiplier(self) -> bool:
        """Whether the wall collapses at a multiplier, be it zero."""
        return self in (Finding.COLLAPSES, Finding.AT_LIMIT)


def none_above(upper: float) -> str:
    """What an upper bound says, for the end of a sentence that finds no collapse state."""
    return f"above {upper:.7g} no equilibrium within yield exists, so the wall moves there at the latest"


@dataclass
class Answer:
    """What a method found. n = number of blocks (fixed ones included), m = number of interfaces.

    Attributes:
        status: ok, not_converged or refused; the engine adds the other endings.
        finding: what this says about the wall.
        sentence: one sentence for a reader: what was found, or why nothing was.
        multiplier: collapse multiplier, zero or more; 0 where `finding` is AT_LIMIT, else None unless it is COLLAPSES.
        bracket: (lower, upper), or None; `bracket_meaning` says what the two ends are.
        forces: (m, 3) contact forces (n1, n2, s) [force], conventions of `assembly`, in equilibrium with
            dead + forces_multiplier * live; or None.
        forces_multiplier: the multiplier the forces belong to; None means `multiplier`.
        mechanism: (n, 3) block velocities (ux, uy, omega) at any scale, zero on fixed blocks; or None.
        flow: which flow rule the mechanism obeys: "non-associated" (zero dilatancy), "associated" (dilatancy mu),
            or "approximate" (a measured velocity field, as of a distinct-element run; it must be a motion that the
            joints allow, to the tolerances of `harness.engine.measured_motion`).
        iterations: iterations of the method's main loop.
        path: columns of equal length that record the way, e.g. {"multiplier": [...], "live_displacement": [...]}.
        details: further findings by name; JSON values only. `MOVING_FORCES` are those of a measured mechanism, which is
            then judged more sharply.
    """

    status: Status
    finding: Finding
    sentence: str
    multiplier: float | None = None
    bracket: tuple[float, float] | None = None
    bracket_meaning: str = ""
    forces: FloatArray | None = None
    forces_multiplier: float | None = None
    mechanism: FloatArray | None = None
    flow: str = "non-associated"
    iterations: int = 0
    path: dict[str, list[float]] = field(default_factory=dict)
    details: dict[str, Any] = field(default_factory=dict)


class Settings(BaseModel):
    """Base of every method's settings: immutable, unknown names refused, NaN refused."""

    model_config = ConfigDict(
        defer_build=True, frozen=True, extra="forbid", allow_inf_nan=False, ser_json_inf_nan="constants"
    )


class Traits(BaseModel):
    """What the numbers of a method are, and how curves of them are drawn: said by the method itself.

    Attributes:
        caption: what its multiplier is, in a few words for the head of a column; empty: nothing is said.
        brackets: its multiplier is measured and lies between the ends of its bracket, a load held and one that moved;
            shown as the bracket, and compared with exact values to `accuracy`.
        accuracy: stated relative accuracy of a multiplier that is measured between two loads.
        resolution: difference, in units of the multiplier, to which its bracket is narrowed, where that is coarser.
        held_accuracy: how far, in units of the multiplier, a held load can lie above what rigid blocks bear, where
            contacts give way.
        seeks_least: it looks for the least collapse state, so that a lower accepted value is a better one.
        bounds_above: no wall bears more than its multiplier, whatever the flow: the associated maximum.
        elastic: its joints are springs, loaded from the dead load on.
        any_self_stress: it lets joints carry any self-stress that statics and friction allow; others start without.
        any_dilatancy: it follows the dilatancy that a wall gives its joints; other methods refuse such a wall.
        any_strength: it takes joints with cohesion and tensile strength; other methods refuse such a wall.
        any_brittle: it takes joints that lose their strength once they have moved; other methods refuse such a wall.
        brittle_alone: it takes such joints only where none dilates or crushes.
        any_bars: it takes ties, props and passive fill; other methods refuse such a wall.
        any_crushing: it takes joints with compressive strength; other methods refuse such a wall.
        any_settlements: it takes supports that move, and finds what they bear; other methods refuse such a wall.
        moves_no_lower: it measures when rigid blocks on even faces move (`details["lowest_moving"]`): where theory
            knows the least multiplier, moving below it is an error.
        colour: of its curves, as "#rrggbb"; empty: the drawing chooses.
        marker: of its points, by the name matplotlib gives it; empty: the drawing chooses.
        line: "solid", "dashed", "dotted" or "dashdot".
    """

    model_config = ConfigDict(defer_build=True, frozen=True, extra="forbid")
    caption: str = ""
    brackets: bool = False
    accuracy: float = Field(default=5e-3, gt=0.0, lt=1.0)
    resolution: float = Field(default=0.0, ge=0.0, lt=1.0)
    held_accuracy: float = Field(default=0.0, ge=0.0, lt=1.0)
    seeks_least: bool = False
    bounds_above: bool = False
    elastic: bool = False
    any_self_stress: bool = False
    any_dilatancy: bool = False
    any_strength: bool = False
    any_brittle: bool = False
    brittle_alone: bool = False
    any_bars: bool = False
    any_crushing: bool = False
    any_settlements: bool = False
    moves_no_lower: bool = False
    colour: str = Field(default="", pattern="^(#[0-9a-f]{6})?$")
    marker: str = ""
    line: Literal["solid", "dashed", "dotted", "dashdot"] = "solid"


class Solver(ABC):
    """What answers for an assembly: a method, or what a listed method leads to."""

    def prepare(self) -> None:  # noqa: B027 - a method without it needs nothing
        """Load what its runs need (libraries, compiled kernels); called once in a process before a run's clock starts.

        May raise; that is reported as a method that cannot be loaded.
        """

    @abstractmethod
    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """Answer for this assembly. May raise; the engine turns any exception into a row with a sentence."""

    def solve_from(self, assembly: Assembly, settings: Any, motions: Sequence[FloatArray]) -> Answer:
        """The answer that given mechanisms alone lead to on this wall, by its own forces; `solve` is the whole search.

        Args:
            assembly: the wall.
            settings: as for `solve`.
            motions: (m, 3) openings at both ends and slip of the joints in each mechanism, found on a wall with the
                same blocks and joints in the same order, whose friction or shape may be other.

        Raises:
            NotImplementedError: it follows no motions (`Method.follows_motions`).
        """
        raise NotImplementedError


class Method(Solver):
    """Base of a method: a name that users type, what its numbers are, its settings and `solve`.

    A method of your own is a subclass with at least `name`, `family`, `title`, `tolerance` and `solve`; the rest has
    defaults. Importing its module should cost little, since lists of methods do: what its runs need is loaded in
    `prepare`. An entry point in the group `drystone.methods` leads to the class.

    Attributes:
        name: the name users type, e.g. "la".
        family: "fe", "la", "de" or a word of your own; the report groups by it.
        title: a few words for the head of a column.
        tolerance: the largest relative residual the judge may find in an answer of this method
        Settings: the class of its settings; its defaults are what `drystone compare` runs.
        traits: what its numbers are. They travel with each result, so that whoever shows results need not load the
            method.
        fresh_process: each of its runs has a process of its own, as its library keeps something from run to run.
        shares_work: it makes parts of a run side by side where `processes_allowed()` is more than one; its answer must
            be the same to the bit.
        follows_motions: it takes up mechanisms that were found on other walls (`solve_from`).
        version: of what solves, where that is no installed package; it stands among the versions of its results.
    """

    name: str
    family: str
    title: str
    tolerance: float
    version: str = ""
    Settings: type[Settings] = Settings
    traits: Traits = Traits()
    fresh_process: bool = False
    shares_work: bool = False
    follows_motions: bool = False

    def processes_kept(self) -> list[int]:
        """Numbers of processes that it keeps from run to run: their time and memory are those of its runs too."""
        return []


@dataclass(frozen=True, kw_only=True)
class Listed(Method):
    """A method described apart from what solves it, which is imported when a run needs it and not to list the method.

    Attributes:
        solver: "module:Class" of its `Solver`; the others as for `Method`.
    """

    solver: str
    name: str
    family: str
    title: str
    tolerance: float
    Settings: type[Settings]
    traits: Traits
    fresh_process: bool = False
    shares_work: bool = False
    follows_motions: bool = False

    def prepare(self) -> None:
        """Import the solver, and let it load what it needs besides."""
        self._solver().prepare()

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """The answer of the solver."""
        return self._solver().solve(assembly, settings)

    def solve_from(self, assembly: Assembly, settings: Any, motions: Sequence[FloatArray]) -> Answer:
        """What the solver makes of mechanisms that are given."""
        return self._solver().solve_from(assembly, settings, motions)

    def _solver(self) -> Solver:
        found: Solver = resolve_name(self.solver)()
        return found


GROUP = "drystone.methods"
UNLISTED = "drystone.unlisted_methods"
"""Group of entry points of methods that run by name and stand in no list."""


OF_COMMANDS = "drystone.command_methods"
"""Group of entry points of methods that commands of their own run, as `drystone reaction`: nobody names them, as their
answers are about other questions than the multiplier."""


@cache
def method_points() -> tuple[EntryPoint, ...]:
    """The entry points of all installed methods; looked for once in a process."""
    return tuple(point for group in (GROUP, UNLISTED, OF_COMMANDS) for point in entry_points(group=group))


_processes: ContextVar[int] = ContextVar("processes", default=1)


def processes_allowed() -> int:
    """Processes that a run may use side by side, one unless the user allows more; its answer is the same with any."""
    return _processes.get()


@contextmanager
def allowing(processes: int) -> Iterator[None]:
    """Allow the runs made inside so many processes each."""
    token = _processes.set(processes)
    try:
        yield
    finally:
        _processes.reset(token)
