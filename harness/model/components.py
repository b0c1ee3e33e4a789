"""Independent components of a wall: free blocks that touch or are tied; fixed blocks do not connect.

No force of one component reaches another, so each is analysed alone, in its own units of weight and length. The wall
collapses at the least multiplier of its components, by the mechanism of that one, while the others bear the load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from harness.model.assembly import OF_BLOCKS, Assembly, BoolArray, FloatArray, IntArray
from harness.model.breakpoints import of_whole_wall
from harness.model.deadline import OutOfTime, best_so_far
from harness.model.details import MOVING_FORCES, AnswerDetails
from harness.model.errors import as_sentence, first_few
from harness.model.groups import groups_of
from harness.model.method import Answer, Finding, Status

_NAMED = 8
"""Blocks of a component that are named at most."""

Solve = Callable[[Assembly], Answer]
"""The answer of a method for one component."""
Bear = Callable[[Assembly, Answer, float], "FloatArray | None"]
"""Contact forces (m, 3) of a component within yield at a multiplier of the live load, or None if none are found.

Its arguments: the component; the method's answer for it; the multiplier, which is no higher than the answer's own.
"""


@dataclass(frozen=True, eq=False)
class Component:
    """Free blocks that touch each other, with the fixed blocks they touch.

    Attributes:
        assembly: the component as a wall of its own.
        blocks: indices (k,) of its blocks in the whole wall.
        interfaces: indices (j,) of its interfaces in the whole wall.
        bars: indices (i,) of its ties and props in the whole wall.
    """

    assembly: Assembly
    blocks: IntArray
    interfaces: IntArray
    bars: IntArray

    @property
    def named(self) -> str:
        """A few of its free blocks in words."""
        return first_few([self.assembly.block_ids[i] for i in self.assembly.free], _NAMED)


def components_of(assembly: Assembly) -> list[Component]:
    """The independent components of a wall, in the order of their first free blocks.

    A wall with one component, or without a block that can move, is returned as it is, to the bit.
    """
    bars = assembly.bars
    a = np.concatenate([assembly.block_a, bars.block_a])
    b = np.concatenate([assembly.block_b, bars.block_b])
    free = ~assembly.fixed
    joined = free[a] & free[b]
    n = assembly.n_blocks
    label = groups_of(n, a[joined], b[joined])
    _, first = np.unique(label[assembly.free], return_index=True)
    if len(first) <= 1:
        return [Component(assembly, np.arange(n), np.arange(assembly.n_interfaces), np.arange(len(bars)))]
    return [_component(assembly, free & (label == label[assembly.free[k]])) for k in np.sort(first)]


def _component(assembly: Assembly, moving: BoolArray) -> Component:
    """The wall of the moving blocks (n,) alone, with the interfaces and the fixed blocks that they touch."""
    interfaces = np.flatnonzero(moving[assembly.block_a] | moving[assembly.block_b])
    bars = np.flatnonzero(moving[assembly.bars.block_a] | moving[assembly.bars.block_b])
    kept = moving.copy()
    kept[assembly.block_a[interfaces]] = kept[assembly.block_b[interfaces]] = True
    kept[assembly.bars.block_a[bars]] = kept[assembly.bars.block_b[bars]] = True
    blocks = np.flatnonzero(kept)
    place = np.full(assembly.n_blocks, -1, dtype=np.int64)
    place[blocks] = np.arange(len(blocks))
    part = replace(
        assembly.with_joints(interfaces),
        block_ids=tuple(assembly.block_ids[i] for i in blocks),
        polygons=tuple(assembly.polygons[i] for i in blocks),
        block_a=place[assembly.block_a[interfaces]],
        block_b=place[assembly.block_b[interfaces]],
        bars=assembly.bars.chosen(bars, place),
        **{name: getattr(assembly, name)[blocks] for name in OF_BLOCKS if name != "polygons"},
    )
    return Component(part, blocks, interfaces, bars)


def joints_of(part: Assembly, whole: Assembly) -> IntArray:
    """Indices (j,) in the whole wall of the interfaces of one of its components, in their order."""
    if part is whole:
        return np.arange(whole.n_interfaces)
    moving = {part.block_ids[i] for i in part.free}
    own = np.array([name in moving for name in whole.block_ids])
    return np.flatnonzero(own[whole.block_a] | own[whole.block_b])


def analysed_apart(assembly: Assembly, solve: Solve, bear: Bear) -> Answer:
    """The answer for a wall from those for its components, each analysed alone.

    The smallest come first, so that a run that is stopped knows as much as it can. After one that was stopped by the
    time limit (`details["stopped_by_limit"]`, or `OutOfTime` once another has an answer) there is no time for others.

    Args:
        assembly: the wall.
        solve: the method on one component.
        bear: forces of a component that does not fail, at the multiplier of the one that does.
    """
    parts = components_of(assembly)
    if len(parts) == 1:
        return solve(parts[0].assembly)
    answers: dict[int, Answer] = {}
    stopped = False
    for k in sorted(range(len(parts)), key=lambda k: parts[k].assembly.n_free):
        missed = _not_reached(parts[k])
        if stopped:
            answers[k] = missed
            continue
        answers[k] = best_so_far(partial(solve, parts[k].assembly), partial(_beside, answers, missed))
        stopped = answers[k] is missed or AnswerDetails(answers[k].details).stopped_by_limit
    return joined(assembly, parts, [answers[k] for k in range(len(parts))], bear)


def _beside(others: dict[int, Answer], missed: Answer) -> Answer:
    """The answer for a component in which the time was over; raises OutOfTime where no other has an answer."""
    if not others:
        raise OutOfTime
    return missed


def _not_reached(part: Component) -> Answer:
    """The answer for a component for which the time did not suffice."""
    sentence = f"the time was over before the component of {part.named} had an answer"
    return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)


def joined(assembly: Assembly, parts: list[Component], answers: list[Answer], bear: Bear) -> Answer:
    """The answer for the whole wall: falls if a component does, else the least multiplier, else unbounded or stands.

    Args:
        assembly: the wall; parts: its components; answers: of a method for each; bear: as for `analysed_apart`.
    """
    falls = [k for k, answer in enumerate(answers) if answer.status is Status.OK and answer.finding is Finding.FALLS]
    collapses = [k for k, answer in enumerate(answers) if answer.finding.has_multiplier]
    least = min((_upper_end(answers[k]) for k in collapses), default=np.inf)
    failed = [k for k, a in enumerate(answers) if a.status is not Status.OK and AnswerDetails(a.details).cap < least]
    unbounded = [k for k, answer in enumerate(answers) if answer.finding is Finding.UNBOUNDED]
    if falls:
        deciding = falls[0]
    elif failed:
        deciding = failed[0]
    elif collapses:
        deciding = min(collapses, key=lambda k: _lower_end(answers[k]))
    else:
        deciding = (unbounded or [0])[0]
    chosen = answers[deciding]
    answer = replace(
        chosen,
        sentence=_sentence(parts, answers, deciding),
        mechanism=_mechanism(assembly, parts[deciding], chosen),
        forces=None,
        path=of_whole_wall(chosen.path, parts[deciding].interfaces),
        iterations=sum(each.iterations for each in answers),
        details=chosen.details | _moving_forces(assembly, parts[deciding], chosen) | _details(parts, answers, deciding),
    )
    if falls or failed:
        return replace(answer, forces_multiplier=None)
    if chosen.bracket is not None:
        uppers = [_upper_end(answers[k]) for k in collapses]
        answer = replace(answer, bracket=(chosen.bracket[0], min(uppers)))
        assert chosen.multiplier is not None
        answer = replace(answer, multiplier=min(chosen.multiplier, min(uppers)))
    return _with_forces(assembly, parts, answers, deciding, answer, bear)


def _lower_end(answer: Answer) -> float:
    assert answer.multiplier is not None
    return answer.multiplier if answer.bracket is None else answer.bracket[0]


def _upper_end(answer: Answer) -> float:
    assert answer.multiplier is not None
    return answer.multiplier if answer.bracket is None else answer.bracket[1]


def _with_forces(
    assembly: Assembly, parts: list[Component], answers: list[Answer], deciding: int, answer: Answer, bear: Bear
) -> Answer:
    """The answer with contact forces of every component at the multiplier of the deciding one's forces.

    Without forces of the deciding component there are none of the wall either.
    """
    at = answer.forces_multiplier if answer.forces_multiplier is not None else answer.multiplier or 0.0
    if answers[deciding].forces is None:
        return answer
    whole = np.zeros((assembly.n_interfaces, 3))
    for k, (part, own) in enumerate(zip(parts, answers, strict=True)):
        same = k == deciding or own.finding is Finding.STANDS or (own.multiplier == at and own.forces_multiplier == at)
        forces = own.forces if same and own.forces is not None else bear(part.assembly, own, at)
        if forces is None:
            return replace(
                answer,
                status=Status.NOT_CONVERGED,
                finding=Finding.NONE,
                sentence=f"{answer.sentence} No contact forces were found with which the component of {part.named} "
                f"bears the load at {at:.7g}.",
                multiplier=None,
                bracket=None,
                mechanism=None,
                forces_multiplier=None,
            )
        whole[part.interfaces] = forces
    return replace(answer, forces=whole)


def _mechanism(assembly: Assembly, part: Component, answer: Answer) -> FloatArray | None:
    """The mechanism (n, 3) of a component as one of the whole wall, at rest elsewhere."""
    if answer.mechanism is None:
        return None
    motion = np.zeros((assembly.n_blocks, 3))
    motion[part.blocks] = answer.mechanism
    return motion


def _moving_forces(assembly: Assembly, part: Component, answer: Answer) -> dict[str, Any]:
    """The contact forces that were measured with the mechanism of a component, as details of the whole wall."""
    measured = AnswerDetails(answer.details).moving_forces
    if measured is None:
        return {}
    forces = np.zeros((assembly.n_interfaces, 3))
    forces[part.interfaces] = measured
    return {MOVING_FORCES: forces.tolist()}


def _sentence(parts: list[Component], answers: list[Answer], deciding: int) -> str:
    """What the deciding component's answer says, of which component it is, and what the others do."""
    said = f"{as_sentence(answers[deciding].sentence)} The wall has {len(parts)} independent components"
    if answers[deciding].status is not Status.OK:
        known = [k for k, answer in enumerate(answers) if answer.finding.has_multiplier]
        least = min(known, key=lambda k: _lower_end(answers[k]), default=None)
        other = "" if least is None else (
            f" That of {parts[least].named} alone collapses at {answers[least].multiplier:.7g}."
        )  # fmt: skip
        return f"{said}; this is said of that of {parts[deciding].named}.{other}"
    if answers[deciding].finding.has_multiplier or answers[deciding].finding is Finding.FALLS:
        return f"{said}; the one that fails is that of {parts[deciding].named}."
    return f"{said}, and none of them fails."


def _details(parts: list[Component], answers: list[Answer], deciding: int) -> dict[str, Any]:
    """The components with their findings, and the one that decides."""
    listed = [
        {
            "blocks": part.named,
            "free_blocks": part.assembly.n_free,
            "status": answer.status.value,
            "finding": answer.finding.value,
            "multiplier": answer.multiplier,
        }
        for part, answer in zip(parts, answers, strict=True)
    ]
    return {"components": listed, "deciding_component": deciding}
