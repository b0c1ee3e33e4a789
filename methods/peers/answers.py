"""What all peers that solve the programme of limit analysis share: the dead load first, then what they hand over.

A peer ends at an approximate point. Which contacts it moves is taken from it, and the state on that pattern comes from
two linear programmes, so that the judge can hold it to rounding. The bound that a solver claims goes to
`details["claimed_bound"]`, beside `details["claimed_optimal"]`: it is what a program in floating point says and no
proof, so it is never a `lower_bound` or `certified_bound`, from which reports say what is proved.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline, best_so_far
from harness.model.errors import optional
from harness.model.method import Answer, Finding, Solver, Status
from methods.numerics.claims import at_limit, with_proof
from methods.numerics.statics import admissible_forces, dilatant_mechanism
from methods.numerics.vertex import Vertex
from methods.peers.programme import CollapseProgramme, collapse_programme

_SHARE = 0.9
"""Of the time that is left to a run: solvers look at their clock between two nodes only, and hear no alarm."""


def time_left(seconds: float) -> float:
    """Seconds that a solver has: those of its settings, or a share of what the run leaves it."""
    return min(seconds, _SHARE * Deadline.of_run().left)


@dataclass(frozen=True, eq=False)
class Ended:
    """Where a peer ended, in the units of the programme.

    Attributes:
        said: its own last word.
        optimal: whether it says that no state is lower.
        multiplier: of its point; None where it has none.
        slacks, rates: (4m,) of its point.
        bound: the multiplier below which it says that there is no state; None where it says nothing.
        iterations: nodes of its tree, or iterations.
    """

    said: str
    optimal: bool = False
    multiplier: float | None = None
    slacks: FloatArray | None = None
    rates: FloatArray | None = None
    bound: float | None = None
    iterations: int = 0


class ProgrammePeer(Solver):
    """Base of the peers that solve the programme.

    Attributes:
        name: of the method.
        package: that it needs, by its name for Python; extra: of drystone that brings it.
    """

    name: str
    package: str
    extra: str

    def prepare(self) -> None:
        """Import the package of the peer."""
        optional(self.package, self.extra, f"method {self.name}")

    @abstractmethod
    def ended(self, package: Any, programme: CollapseProgramme, settings: Any) -> Ended | str:
        """Where the peer ends on a wall that stands and carries a live load; or why it cannot take the wall.

        Args:
            package: of the peer; programme: of the wall; settings: of the method.
        """

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """The answer for a wall, from the dead load alone where that decides."""
        package = optional(self.package, self.extra, f"method {self.name}")
        return with_proof(assembly, at_limit(assembly, self._answer(package, assembly, settings)))

    def _answer(self, package: Any, assembly: Assembly, settings: Any) -> Answer:
        early = _dead_load_answer(assembly)
        if early is not None:
            return early
        programme = collapse_programme(assembly)
        if not _moves(programme):
            said = "The live load does no work on any mechanism: it cannot make the wall collapse."
            return Answer(Status.OK, Finding.UNBOUNDED, said)
        ended = self.ended(package, programme, settings)
        if isinstance(ended, str):
            return Answer(Status.REFUSED, Finding.NONE, ended)
        return best_so_far(*2 * [lambda: _answer_of(self.name, programme, ended)])  # two small programmes


def _dead_load_answer(assembly: Assembly) -> Answer | None:
    """Falls, or stands if there is no live load; None if there is a live load to study."""
    forces = admissible_forces(assembly, assembly.dead)
    if forces is None:
        mechanism = dilatant_mechanism(assembly, assembly.dead, exact=True)
        if mechanism is None:
            said = "Whether the wall stands under its dead load was not decided."
            return Answer(Status.NOT_CONVERGED, Finding.NONE, said)
        said = "The wall falls under its dead load: no equilibrium within yield exists."
        return Answer(Status.OK, Finding.FALLS, said, mechanism=mechanism, flow="associated")
    if assembly.has_live_load:
        return None
    said = "Under its dead load the wall has an equilibrium within yield; no live load is given."
    return Answer(Status.OK, Finding.STANDS, said, forces=forces, forces_multiplier=0.0)


def _moves(programme: CollapseProgramme) -> bool:
    """Whether any motion that the joints allow does live work."""
    return programme.motion_programme(np.full(4 * programme.assembly.n_interfaces, np.inf)).run()[0] != "infeasible"


def _answer_of(name: str, programme: CollapseProgramme, ended: Ended) -> Answer:
    """The collapse state where a peer ended, and what it claims."""
    unit = programme.assembly.load_unit
    details: dict[str, Any] = {"solver_message": ended.said, "unknowns": programme.unknowns}
    claim = ""
    if ended.bound is not None:
        details |= {"claimed_bound": ended.bound * unit, "claimed_optimal": ended.optimal}
        claim = f"; it claims that none lies below {ended.bound * unit:.7g}"
    if ended.multiplier is None or ended.slacks is None or ended.rates is None:
        said = f"{name} ended with {ended.said} and no collapse state{claim}."
        return Answer(Status.NOT_CONVERGED, Finding.NONE, said, iterations=ended.iterations, details=details)
    details["programme_value"] = ended.multiplier * unit
    state = _state(programme, ended.slacks, ended.rates)
    if state is None:
        said = f"{name} ended with {ended.said} at {ended.multiplier * unit:.7g}, and no collapse state has its pattern"
        return Answer(
            Status.NOT_CONVERGED, Finding.NONE, said + claim + ".", iterations=ended.iterations, details=details
        )
    multiplier, forces, mechanism = state
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"{name} leads to a collapse state at {multiplier:.7g}{claim}.",
        multiplier=multiplier,
        forces=forces,
        mechanism=mechanism,
        iterations=ended.iterations,
        details=details,
    )


def _state(
    programme: CollapseProgramme, slacks: FloatArray, rates: FloatArray
) -> tuple[float, FloatArray, FloatArray] | None:
    """The least multiplier, forces (m, 3) and mechanism (n, 3) with the pattern of a point; None if there are none.

    A contact moves in it whose rate, as a part of the largest, is more than its slack is of the largest.
    """
    assembly, m = programme.assembly, programme.assembly.n_interfaces
    moves = rates * (slacks.max() or 1.0) > slacks * (rates.max() or 1.0)
    statics = programme.forces_programme(np.append(np.zeros(3 * m), 1.0))
    statics.set_rows(3 * assembly.n_free, np.zeros(4 * m), np.where(moves, 0.0, np.inf))
    motion = programme.motion_programme(np.where(moves, np.inf, 0.0))
    found = [_vertex(statics), _vertex(motion)]
    if found[0] is None or found[1] is None:
        return None
    forces, velocities = found[0].value, found[1].value[: 3 * assembly.n_free].reshape(-1, 3).copy()
    velocities[:, 2] /= assembly.length_scale
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = velocities / (abs(velocities).max() or 1.0)
    within = assembly.law.within(forces[:-1].reshape(-1, 3))
    return float(forces[-1]) * assembly.load_unit, within * programme.unit_force, mechanism


def _vertex(programme: Any) -> Vertex | None:
    """The optimal vertex of a linear programme to rounding; None if it has none."""
    vertex: Vertex | None = programme.vertex() if programme.run()[0] == "optimal" else None
    return vertex if vertex is not None and vertex.optimal else None
