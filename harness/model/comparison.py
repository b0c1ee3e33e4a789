"""What the engine hands to the report: cases, their results, and the statements of theory that relate them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, ConfigDict

from harness.model.case import Case
from harness.model.library import library
from harness.model.method import Finding, Status
from harness.model.result import Result


class Gate(BaseModel):
    """A statement of theory tested on the results of one case (Baggio & Trovalusci 1995; bounds of limit analysis).

    Attributes:
        name: short name, e.g. "fe-below-associated".
        statement: what theory says.
        passed: whether it holds; None where a result it needs is missing.
        sentence: the figures.
        of_search: whether it fails where a search missed a state that another method reached, and no answer is wrong.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid")
    name: str
    statement: str
    passed: bool | None
    sentence: str
    of_search: bool = False


@dataclass(frozen=True)
class Certified:
    """What a certificate proves of a wall in fractions.

    Attributes:
        bound: no collapse state lies from zero to below this multiplier.
        sentence: what is proved, in words.
        source: name of the file.
    """

    bound: float
    sentence: str
    source: str


def refusal(method: str, why: str) -> str:
    """A sentence about a certificate that is refused."""
    return f"The certificate that {method} hands on is refused, and proves nothing: {why.rstrip('.')}."


@dataclass(frozen=True)
class CaseResults:
    """One case with the results of every method asked for, failed ones included.

    Attributes:
        case: the wall and its references.
        results: of every method.
        gates: statements of theory tested on them.
        certified: what the certificate beside the case proves, if there is one that holds.
        refused: {method: why the certificate that it handed on is refused}.
    """

    case: Case
    results: list[Result]
    gates: list[Gate] = field(default_factory=list)
    certified: Certified | None = None
    refused: dict[str, str] = field(default_factory=dict)

    @property
    def refusals(self) -> list[str]:
        """Sentences about certificates that methods handed on and that are refused, as every output prints them."""
        return [refusal(method, why) for method, why in self.refused.items()]

    def of(self, method: str) -> Result | None:
        """The result of a method, or None."""
        return next((result for result in self.results if result.method == method), None)

    @property
    def mains(self) -> list[Result]:
        """The result of every family's main method, in the order of families."""
        return sorted((r for r in self.results if r.is_main), key=lambda r: library().order(r.method, r.family))

    @property
    def associated(self) -> Result | None:
        """The collapse state that bounds every other from above, unless the judge rejects it; or None."""
        found = (
            result
            for result in self.results
            if result.traits.bounds_above
            and result.flow == "associated"  # whatever a method says of itself: only such a mechanism bounds them
            and result.status is Status.OK
            and result.finding.has_multiplier
            and result.judge.accepted is not False
        )
        return next(found, None)

    @property
    def split_on_dead_load(self) -> str:
        """Which methods say that the wall falls under its dead load and which that it stands; empty if they agree."""
        answered = [result for result in self.results if result.status is Status.OK]
        fall = {result.method: result.traits for result in answered if result.finding is Finding.FALLS}
        stand = {
            result.method: result.traits
            for result in answered
            if result.finding not in (Finding.FALLS, Finding.AT_LIMIT, Finding.NONE)
        }
        if not fall or not stand:
            return ""
        who = f"Under the dead load the wall falls for {', '.join(fall)} and stands for {', '.join(stand)}"
        by_self_stress = all(traits.any_self_stress for traits in stand.values())
        if not by_self_stress or any(traits.any_self_stress for traits in fall.values()):
            return f"{who}: it may be at the limit of standing, or one of them is wrong"
        return (
            f"{who}. Limit analysis allows the joints any self-stress within statics and friction; springs "
            "and distinct elements start without. A multiplier of this wall holds only if its joints are under such "
            "stress"
        )


@dataclass(frozen=True)
class ComparisonRun:
    """Everything one `drystone compare` left: what the report is made of.

    Attributes:
        title: what was compared, e.g. "suite paper".
        command: the command that repeats it.
        created: ISO time of the run [UTC].
        cases: in the order asked for.
        provenance: versions, commit, machine, limits of the comparison as a whole.
    """

    title: str
    command: str
    created: str
    cases: list[CaseResults]
    provenance: dict[str, Any] = field(default_factory=dict)
