"""Answers about supports that move and collapses that go on: extreme reactions, and walls on updated geometry."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly
from harness.model.followed import DrivenWall, FollowedWall
from harness.model.method import Answer, Finding, Solver, Status
from methods.la.core.reaction import extreme_reaction
from methods.la.moved_wall import MovedWall
from methods.la.settings import ReactionSettings, SettlingSteps
from methods.la.settling import SettledUntil, settle, with_multiplier


class ExtremeReactions(Solver):
    """The least or the greatest reaction of moving supports, with associated flow (`la-reaction`)."""

    def solve(self, assembly: Assembly, settings: ReactionSettings) -> Answer:
        """A linear programme and its dual."""
        what = "greatest" if settings.greatest else "least"
        found = extreme_reaction(assembly, settings.greatest)
        if found == "infeasible":
            return Answer(
                Status.OK,
                Finding.FALLS,
                "No equilibrium within yield exists under the dead load: the wall falls, wherever its supports go.",
            )
        if isinstance(found, str):
            return _none(f"The linear programme of the {what} reaction is {found}.")
        driven = DrivenWall(found.reaction, found.forces, found.tensions, found.mechanism)
        sentence = f"The {what} reaction of the moving supports is {found.reaction:.7g}."
        return Answer(
            Status.OK, Finding.STANDS, sentence, forces=found.forces, forces_multiplier=0.0, flow="associated",
            details=driven.as_details(),
        )  # fmt: skip


class SettledSupports(Solver):
    """How far supports can move before a wall falls, on updated geometry (`la-settling`)."""

    def solve(self, assembly: Assembly, settings: SettlingSteps) -> Answer:
        """States on the way, as details; the forces are those of the wall as drawn."""
        found = settle(MovedWall.at_rest(assembly), settings)
        if isinstance(found, str):
            return _none(f"The linear programme of the least reaction is {found} where the supports begin to move.")
        states = _states(found)
        sentence = f"The wall stands until its supports have moved by {states.displacement[-1]:.7g}. {states.reason}"
        return Answer(
            Status.OK, Finding.STANDS, sentence.strip(), forces=states.forces[0], forces_multiplier=0.0,
            path={"displacement": states.displacement.tolist(), "reaction": states.value.tolist()},
            details=states.as_details(),
        )  # fmt: skip


class FollowedCollapse(Solver):
    """The multiplier that a wall bears as it follows its mechanism on updated geometry (`la-capacity`)."""

    def solve(self, assembly: Assembly, settings: SettlingSteps) -> Answer:
        """The collapse of the wall as drawn; states on the way, as details."""
        found = settle(MovedWall.at_rest(assembly), settings, with_multiplier)
        if found == "falls":
            return Answer(Status.OK, Finding.FALLS, "The wall falls under its dead load as drawn.")
        if found == "unbounded":
            return Answer(Status.OK, Finding.UNBOUNDED, "The live load cannot make the wall collapse.")
        if isinstance(found, str):
            return _none(f"The linear programme of the greatest multiplier is {found}.")
        states = _states(found)
        sentence = f"The multiplier is {states.value[0]:.7g} as drawn and {states.value[-1]:.7g} in the last state."
        return Answer(
            Status.OK, Finding.COLLAPSES, f"{sentence} {states.reason}".strip(), multiplier=float(states.value[0]),
            forces=states.forces[0], mechanism=states.mechanisms[0], flow="associated",
            path={"displacement": states.displacement.tolist(), "multiplier": states.value.tolist()},
            details=states.as_details(),
        )  # fmt: skip


def _states(found: SettledUntil) -> FollowedWall:
    points, fall = found.points, found.fall
    return FollowedWall(
        np.array([point.wall.displacement for point in points]),
        np.array([point.value for point in points]),
        np.array([point.wall.places for point in points]),
        np.array([point.forces for point in points]),
        np.array([point.mechanism for point in points]),
        points[-1].wall.closed,
        None if fall is None else fall.displacement,
        None if fall is None else fall.places,
        found.mechanism,
        found.reason,
    )


def _none(sentence: str) -> Answer:
    return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
