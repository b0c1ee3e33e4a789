"""The answer about a wall on ground that accelerates (`de-time`): the history of its blocks."""

from __future__ import annotations

import numpy as np
import pymunk

from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.followed import ShakenWall
from harness.model.ground_motion import GroundMotion
from harness.model.method import Answer, Finding, Solver, Status
from methods.de.settings import TimeHistorySettings, TimeSteps
from methods.de.time.history import follow
from methods.de.time.impact import HOUSNER, WITHIN, measured_impact


class TimeHistories(Solver):
    """Rigid blocks in pymunk, followed until one has fallen or all motion has died."""

    def prepare(self) -> None:
        """Load the engine, and measure its impact with the steps that are usual: once for all runs."""
        measured_impact(TimeSteps())

    def solve(self, assembly: Assembly, settings: TimeHistorySettings) -> Answer:
        """Whether it stands or falls; places of the blocks in time, as details.

        Raises:
            InputError: the engine does not lose the energy of Housner's impact with these steps.
        """
        steps = TimeSteps.model_validate({name: getattr(settings, name) for name in TimeSteps.model_fields})
        impact = measured_impact(steps)
        if not abs((impact / HOUSNER) ** 2 - 1.0) <= WITHIN:
            raise InputError(
                f"with these steps the engine keeps {impact:.4g} of the speed of a rocking block at an impact, and not "
                f"{HOUSNER:.4g}",
                "Give shorter time steps",
                "steps",
            )
        motion = GroundMotion(*(np.array(each) for each in (settings.time, settings.first, settings.last)))
        found = follow(assembly, motion, settings.gravity, steps)
        undecided = found.finding is Finding.NONE
        said = "undecided" if undecided else str(found.finding)
        return Answer(
            Status.NOT_CONVERGED if undecided else Status.OK,
            found.finding,
            f"{said.capitalize()}, {found.time[-1]:.4g} s after the ground began to move.",
            iterations=found.steps,
            details=ShakenWall(
                found.time,
                found.places,
                found.energy,
                np.isin(np.arange(assembly.n_blocks), found.fallen),
                found.at_rest,
                f"pymunk {pymunk.version}",
                impact,
            ).as_details(),
        )
