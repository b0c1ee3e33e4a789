"""The answer of a program in any language, format `result/1`, and how it becomes an `Answer`.

A proof is judged as those of other methods are: a certificate goes to the checker of `drystone verify-bound`, and a
lower bound without one is shown in the name of its method.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from harness.model.answer_check import AnswerFault, checked
from harness.model.assembly import Assembly
from harness.model.details import BAR_FORCES, DEAD_BAR_FORCES, MOVING_FORCES
from harness.model.errors import InputError
from harness.model.fields import LARGEST
from harness.model.json_text import require_format
from harness.model.method import Answer, Finding, Status
from harness.model.reading import validate

Finite = Annotated[float, Field(ge=-LARGEST, le=LARGEST, strict=True)]
Triples = list[tuple[Finite, Finite, Finite]]
_OF_INTERFACES = ("forces", "live_forces", "dead_forces", MOVING_FORCES)
_OF_BLOCKS = ("mechanism", "dilatant_mechanism")
_OF_BARS = (BAR_FORCES, DEAD_BAR_FORCES)
_FOR_THE_JUDGE = ("without_strength", "with_strength", "broken", "breaking", "displaced_state")
"""Details that the judge reads and for which `result/1` has no field: no program takes what they are about."""
_VERBS = (Finding.COLLAPSES, Finding.STANDS, Finding.FALLS)
_IN_DETAILS = (*_OF_INTERFACES[1:], *_OF_BARS, "dilatant_mechanism", "lower_bound", "certificate")
"""Fields that an `Answer` holds among its details."""


class ResultDocument(BaseModel):
    """What a program found on one wall, format `result/1`.

    Forces are (n1, n2, s) of every interface and mechanisms (ux, uy, omega) of every block, in the order of the wall
    that the program read; docs/sign-conventions.md has their signs. What is left out is not claimed.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid", allow_inf_nan=False, frozen=True)
    format: Literal["result/1"]
    status: Literal["ok", "not_converged", "refused"] = "ok"
    finding: Finding = Field(Finding.COLLAPSES, description='"none" unless the status is "ok"')
    sentence: str = Field("", description="for a reader: what was found, or why nothing was")
    multiplier: Finite | None = Field(None, description="collapse multiplier, zero or more")
    bracket: tuple[Finite, Finite] | None = Field(None, description="lower and upper end")
    bracket_meaning: str = Field("", description="what the two ends are")
    forces: Triples | None = Field(None, description="contact forces in equilibrium with dead + multiplier * live")
    forces_multiplier: Finite | None = Field(None, description="multiplier of the forces; else `multiplier`")
    mechanism: Triples | None = Field(None, description="block velocities at any scale; zero on fixed blocks")
    flow: Literal["non-associated", "associated", "approximate"] = Field(
        "non-associated", description="of the mechanism: no dilatancy, dilatancy mu, or a measured motion"
    )
    live_forces: Triples | None = Field(None, description="that balance the live load alone: proof of `unbounded`")
    dead_forces: Triples | None = Field(None, description="under the dead load: proof of `at its limit`")
    moving_forces: Triples | None = Field(None, description="measured with a mechanism of flow `approximate`")
    dilatant_mechanism: Triples | None = Field(None, description="proof of `falls` beside a measured motion")
    bar_forces: list[Finite] | None = Field(None, description="tensions of the ties and then the props, with `forces`")
    dead_bar_forces: list[Finite] | None = Field(None, description="the same, with `dead_forces`")
    lower_bound: Finite | None = Field(None, description="no collapse state lies below it, in floating point")
    certificate: dict[str, Any] | None = Field(None, description="as `drystone bound` writes it: it is checked")
    iterations: Annotated[int, Field(ge=0)] = 0
    path: dict[str, list[Finite]] = Field(default_factory=dict, description="columns of equal length")
    details: dict[str, Any] = Field(default_factory=dict, description="further findings by name")

    @model_validator(mode="after")
    def _collapse_has_a_multiplier(self) -> ResultDocument:
        if self.status == "ok" and self.finding.has_multiplier and self.multiplier is None:
            raise ValueError(f'the finding "{self.finding}" needs a "multiplier"')
        return self


def answer_of(data: Any, assembly: Assembly, source: str) -> Answer:
    """The answer of a `result/1` document.

    Args:
        data: what a program wrote, as JSON values.
        assembly: the wall it is about.
        source: what errors call it.

    Raises:
        InputError: no such document, or arrays that are not of the size of the wall.
    """
    require_format(data, "result/1", "a result", source)
    found = validate(ResultDocument, data, source)
    arrays = {name: getattr(found, name) for name in (*_OF_INTERFACES, *_OF_BLOCKS)}
    for name, listed in arrays.items():
        rows = assembly.n_interfaces if name in _OF_INTERFACES else assembly.n_blocks
        if listed is not None and len(listed) != rows:
            columns = "n1, n2, s of every interface" if name in _OF_INTERFACES else "ux, uy, omega of every block"
            remedy = f"Give {columns} in the order of the wall (`drystone expand` prints it)"
            raise InputError(f"it has {len(listed)} entries, and should have {rows}", remedy, name, source)
    for name in _OF_BARS:
        listed = getattr(found, name)
        if listed is not None and len(listed) != len(assembly.bars):
            problem = f"it has {len(listed)} entries, and should have {len(assembly.bars)}"
            raise InputError(problem, "Give the tension of every tie and then of every prop", name, source)
    own = {name: value for name in _IN_DETAILS if (value := getattr(found, name)) is not None}
    shapes = {"forces": assembly.n_interfaces, "mechanism": assembly.n_blocks}
    fields = {
        name: None if arrays[name] is None else np.array(arrays[name], dtype=float).reshape(rows, 3)
        for name, rows in shapes.items()
    }
    return Answer(
        status=Status(found.status),
        finding=found.finding if found.status == "ok" else Finding.NONE,
        sentence=found.sentence or _default_sentence(found),
        multiplier=found.multiplier if found.status == "ok" else None,
        bracket=found.bracket,
        bracket_meaning=found.bracket_meaning,
        forces_multiplier=found.forces_multiplier,
        flow=found.flow,
        iterations=found.iterations,
        path=found.path,
        details=found.details | own,
        **fields,
    )


def answer_from_file(data: Any, assembly: Assembly, source: str) -> Answer:
    """An answer as `drystone judge` takes it: `result/1`, or any object with some of its fields among others.

    The latter, such as the output of `drystone run --json --fields`, claims what it holds under the names of `result/1`
    or under those in its `details`; all else in it is passed over.

    Raises:
        InputError: as of `answer_of`, or details that the judge cannot read.
    """
    if not isinstance(data, dict) or "format" in data:
        return _readable(answer_of(data, assembly, source), assembly, source)
    within = data.get("details")
    details = within if isinstance(within, dict) else {}
    names = ("finding", "multiplier", "bracket", "forces", "forces_multiplier", "mechanism", "flow")
    taken = {name: data[name] for name in names if name in data}
    if data.get("status", "ok") != "ok":  # how a run ended, of which `result/1` knows fewer ways
        taken["status"] = "not_converged"
    proofs = ("live_forces", "dead_forces", MOVING_FORCES, "dilatant_mechanism")
    proofs = (*proofs, *(_OF_BARS if len(assembly.bars) else ()))
    taken |= {name: listed for name in proofs if (listed := data.get(name, details.get(name))) is not None}
    others = {name: data.get(name, details.get(name)) for name in _FOR_THE_JUDGE}
    taken["details"] = {name: found for name, found in others.items() if found is not None}
    document = {"format": "result/1", "sentence": "An answer from a file."} | taken
    return _readable(answer_of(document, assembly, source), assembly, source)


def _readable(answer: Answer, assembly: Assembly, source: str) -> Answer:
    """The answer, if the judge can read its details."""
    try:
        return checked(answer, assembly)
    except AnswerFault as fault:
        raise InputError(fault.problem, "Give what `drystone run --json --fields` writes", "details", source) from None


def _default_sentence(found: ResultDocument) -> str:
    if found.status != "ok":
        return f"The program answers {found.status.replace('_', ' ')} and gives no reason."
    value = f" at {found.multiplier:.7g}" if found.multiplier is not None else ""
    finds = found.finding if found.finding in _VERBS else f"is {found.finding}"
    return f"The wall {finds}{value}, says the program."
