"""What a run leaves behind: the answer, what the judge and the references say of it, and what it cost."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from harness.model.assembly import Assembly, FloatArray
from harness.model.details import AnswerDetails
from harness.model.fields import Cost, Counted
from harness.model.method import Answer, Finding, Status, Traits


class Verdict(StrEnum):
    """How a value stands to what is known. It says nothing about how the run ended: that is the status."""

    AGREES = "agrees"
    OUTSIDE_TOLERANCE = "outside_tolerance"
    VIOLATES_BOUND = "violates_bound"
    NO_REFERENCE = "no_reference"
    NOT_TESTED = "not_tested"
    """The method needs a package that is not installed here."""


_WORKS = {
    "live_work": "work of the live load, must be positive",
    "dead_work": "work of the dead load, must exceed closing_work",
    "closing_work": "what immense forces do on closings, must be below dead_work",
}
"""Numbers of a judgement beside its residuals, which need not vanish, and what is asked of them."""


class Judgement(BaseModel):
    """What an independent check of an answer found.

    Attributes:
        residuals: each residual by name, relative and dimensionless; see `harness.engine.judge`.
        tolerance: the largest residual that was acceptable.
        accepted: whether every residual is within the tolerance; None where there was nothing to judge.
        sentence: what was judged, and what failed if anything did.
        multiplier_error: how far, by virtual work, the multiplier of the mechanism can be from the reported one; None
            where that was not shown.
        code: hash of the judge's code, where the result is kept; another judge judges it again. Empty where the run had
            a judge of its own, whose word counts for that run only.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid")
    residuals: dict[str, float] = Field(default_factory=dict)
    tolerance: float = 0.0
    accepted: bool | None = None
    sentence: str = ""
    multiplier_error: float | None = None
    code: str = ""

    @property
    def worst(self) -> tuple[str, float] | None:
        """Name and value of the largest of the residuals that ought to vanish; None if nothing was judged.

        Work is no residual, and those of a measured motion have a tolerance of their own.
        """
        small = [item for item in self.residuals.items() if item[0] not in _WORKS and not item[0].startswith("motion_")]
        return max(small, key=lambda item: item[1], default=None)

    def listed(self, digits: int = 2) -> list[tuple[str, str]]:
        """Name and value of each number that was found, for people; what is work says so, and what is asked of it."""
        return [
            (name, f"{value:.{digits}e}" + (f" (no residual: {_WORKS[name]})" if name in _WORKS else ""))
            for name, value in self.residuals.items()
        ]

    @property
    def decimals(self) -> int | None:
        """Decimals of the multiplier of which the last stands for more than twice its error; None: no bound on it."""
        return None if not self.multiplier_error else math.floor(-math.log10(2.0 * self.multiplier_error))

    @property
    def outcome(self) -> str:
        """Accepted, rejected or not judged, in a word for people and scripts."""
        return {True: "accepted", False: "rejected", None: "not_judged"}[self.accepted]


class Comparison(BaseModel):
    """One result compared with one reference."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    reference: str
    quantity: str
    value: float | list[float] | str | None
    expected: float | list[float] | str
    tolerance: float
    gate: bool
    verdict: Verdict
    sentence: str


class Result(BaseModel):
    """One run of one method on one wall: a row of the report.

    Field names are a promise to scripts (`drystone run --json`); docs/json.md describes them.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid")
    case: str
    method: str
    family: str
    key: str = ""
    status: Status
    finding: Finding
    sentence: str
    multiplier: float | None = None
    bracket: tuple[float, float] | None = None
    bracket_meaning: str = ""
    bracket_width: float | None = None
    bracket_wide: bool = False
    verdict: Verdict = Verdict.NO_REFERENCE
    comparisons: list[Comparison] = Field(default_factory=list)
    judge: Judgement = Field(default_factory=Judgement)
    cpu_seconds: Cost | None = None
    wall_seconds: Cost | None = None
    peak_memory_bytes: Counted | None = None
    blocks: Counted
    interfaces: Counted
    iterations: Counted = 0
    unknowns: Counted | None = None
    settings: dict[str, Any] = Field(default_factory=dict)
    limits: dict[str, float] = Field(default_factory=dict)
    given: list[str] = Field(default_factory=list)
    versions: dict[str, str] = Field(default_factory=dict)
    machine: dict[str, Any] = Field(default_factory=dict)
    started: str = ""
    flow: str = "non-associated"
    traits: Traits = Field(default_factory=Traits)
    forces_multiplier: float | None = None
    path: dict[str, list[float]] = Field(default_factory=dict)
    details: dict[str, Any] = Field(default_factory=dict)
    warnings: list[str] = Field(default_factory=list)
    forces: list[tuple[float, float, float]] | None = None
    mechanism: list[tuple[float, float, float]] | None = None
    states: list[str] | None = None

    @property
    def is_main(self) -> bool:
        """Whether its method is the main one of its family, which bears the family's name."""
        return self.method == self.family

    @property
    def width_in_words(self) -> str:
        """What follows a bracket that is wide, empty for others."""
        return f" ({100.0 * self.bracket_width:.2g} % wide)" if self.bracket_wide and self.bracket_width else ""

    def summary(self) -> dict[str, Any]:
        """The result as JSON values, without fields per block or interface and without the path."""
        return self.model_dump(mode="json", exclude={"forces", "mechanism", "states", "path"})


def residual_of(result: Result) -> Result | None:
    """The answer for the same wall without cohesion and tensile strength that comes with a result, as a result.

    None where none comes, or where what comes is no answer.
    """
    return _beside(result, AnswerDetails(result.details).without_strength)


def plastic_of(result: Result) -> Result | None:
    """The answer that comes with that for a wall with broken joints: as if all kept their strength. None as above."""
    return _beside(result, AnswerDetails(result.details).with_strength)


def plastic_and_residual_of(result: Result) -> tuple[Result, Result] | None:
    """The answers with plastic strength and without it, of which one is the result; None where it is alone."""
    if (plastic := plastic_of(result)) is not None:
        return plastic, result
    residual = residual_of(result)
    return None if residual is None else (result, residual)


def size_of(answer: Answer | Result) -> float | None:
    """What answers are ordered by: 0 if the wall falls, infinite if nothing makes it collapse, else the multiplier.

    None without an answer. Of walls without dilatancy neither the size with the strength of joints nor that without is
    always the lower: strength may bear the compression on which the friction of another joint depends.
    """
    if answer.status is not Status.OK:
        return None
    if answer.finding is Finding.FALLS:
        return 0.0
    if answer.finding in (Finding.UNBOUNDED, Finding.STANDS):
        return math.inf
    return answer.multiplier if answer.finding.has_multiplier else None


def bears_less_with_strength(plastic: Answer | Result, residual: Answer | Result, rounding: float = 1e-9) -> bool:
    """Whether the multiplier with the strength of joints is the lower one, by more than a relative rounding."""
    whole, without = size_of(plastic), size_of(residual)
    return whole is not None and without is not None and whole < without * (1.0 - rounding)


def _beside(result: Result, own: object) -> Result | None:
    """What stands in the details of a result for an answer, as a result."""
    if not isinstance(own, dict):
        return None
    kept = {name: getattr(result, name) for name in ("case", "method", "family", "blocks", "interfaces", "traits")}
    try:
        return Result.model_validate(kept | own)
    except ValidationError:
        return None


def _measured_bracket(answer: Answer | Result) -> tuple[float, float] | None:
    """The bracket between whose ends a multiplier was measured; None without one.

    The zero of a wall at its limit is no measurement: statics shows it (`harness.model.limit`).
    """
    return answer.bracket if answer.flow == "approximate" and answer.finding is not Finding.AT_LIMIT else None


def measured_width(answer: Answer | Result) -> float | None:
    """Width of the bracket of a measured multiplier as a share of its larger end; None without one, or at zero."""
    low, high = _measured_bracket(answer) or (0.0, 0.0)
    larger = max(abs(low), abs(high))
    return abs(high - low) / larger if larger > 0.0 else None


def bracket_is_wide(answer: Answer | Result, traits: Traits) -> bool:
    """Whether a measured bracket is wide: its middle is no value of the multiplier within what its method states.

    Within the stated accuracy the middle lies at most that far from either end. There is no other notion of "wide":
    every output marks such a bracket, and studies leave it out of means.
    """
    low, high = _measured_bracket(answer) or (0.0, 0.0)
    return high - low > max(traits.accuracy * abs(low + high), traits.resolution) * (1.0 + 1e-9)


def fastest_vertex(assembly: Assembly, mechanism: FloatArray) -> float:
    """The largest speed of a vertex of the wall under a mechanism (n, 3)."""
    points, block = assembly.corners
    speed = vertex_velocities(points, assembly.centroid[block], mechanism[block])
    return float(np.hypot(speed[:, 0], speed[:, 1]).max(initial=0.0))


def normalised_mechanism(assembly: Assembly, mechanism: FloatArray) -> FloatArray:
    """A mechanism (n, 3) scaled so that the fastest vertex of the wall has speed 1; unchanged if nothing moves."""
    largest = float(abs(mechanism).max(initial=0.0))
    if not 0.0 < largest < np.inf:
        return mechanism
    motion = mechanism / largest  # first, so that no square of a speed underflows
    fastest = fastest_vertex(assembly, motion)
    return motion / fastest if fastest > 0.0 else motion


def vertex_velocities(points: FloatArray, centroid: FloatArray, motion: FloatArray) -> FloatArray:
    """Velocities (k, 2) of points (k, 2) of a block with centroid (2,) and motion (ux, uy, omega), or each of its own.

    Points of many blocks come with the centroid (k, 2) and the motion (k, 3) of the block of each.
    """
    arm = points - centroid
    return np.asarray(motion[..., :2] + motion[..., 2:] * np.stack([-arm[:, 1], arm[:, 0]], axis=1))


def relative_velocities(assembly: Assembly, mechanism: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Opening (m, 2) at the two ends and slip (m,) of every interface, from the velocities of b and a at the points."""

    def velocity(block: Any, point: FloatArray) -> FloatArray:
        arm = point - assembly.centroid[block]
        omega = mechanism[block, 2:3]
        return np.asarray(mechanism[block, :2] + omega * np.stack([-arm[:, 1], arm[:, 0]], axis=1))

    jump1 = velocity(assembly.block_b, assembly.end1) - velocity(assembly.block_a, assembly.end1)
    jump2 = velocity(assembly.block_b, assembly.end2) - velocity(assembly.block_a, assembly.end2)
    opening = np.stack([(jump1 * assembly.normal).sum(axis=1), (jump2 * assembly.normal).sum(axis=1)], axis=1)
    return opening, np.asarray((0.5 * (jump1 + jump2) * assembly.tangent).sum(axis=1))


def contact_states(assembly: Assembly, mechanism: FloatArray | None) -> list[str] | None:
    """ "stick", "slip", "rock" (one end opens) or "open" (both do) for every interface, from a normalised mechanism.

    Relative velocities below a hundred-thousandth of the fastest vertex count as none.
    """
    if mechanism is None:
        return None
    opening, slip = relative_velocities(assembly, normalised_mechanism(assembly, mechanism))
    small = 1e-5
    opens = opening > small
    state = np.where(abs(slip) > small, "slip", "stick")
    state = np.where(opens.any(axis=1), "rock", state)
    state = np.where(opens.all(axis=1), "open", state)
    return [str(item) for item in state]


def result_of(
    answer: Answer, assembly: Assembly, *, case: str, method: str, family: str, traits: Traits | None = None
) -> Result:
    """The result an answer makes before it is judged, compared and measured; `traits` are those of its method."""
    mechanism = (
        None if answer.mechanism is None else normalised_mechanism(assembly, np.asarray(answer.mechanism, float))
    )
    width = measured_width(answer)
    return Result(
        case=case,
        method=method,
        family=family,
        status=answer.status,
        finding=answer.finding,
        sentence=answer.sentence,
        multiplier=answer.multiplier,
        bracket=answer.bracket,
        bracket_meaning=answer.bracket_meaning,
        bracket_width=width,
        bracket_wide=bracket_is_wide(answer, traits or Traits()),
        blocks=assembly.n_free,
        interfaces=assembly.n_interfaces,
        iterations=int(answer.iterations),
        unknowns=AnswerDetails(answer.details).unknowns,
        flow=answer.flow,
        traits=traits or Traits(),
        forces_multiplier=answer.multiplier if answer.forces_multiplier is None else answer.forces_multiplier,
        path=answer.path,
        details=answer.details,
        forces=None if answer.forces is None else np.asarray(answer.forces, float).tolist(),
        mechanism=None if mechanism is None else mechanism.tolist(),
        states=contact_states(assembly, mechanism),
    )
