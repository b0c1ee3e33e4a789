"""What joints do in a collapse state, by motion and by force: stick, slide, rock, both, part, dilate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly
from harness.model.result import Result, normalised_mechanism, relative_velocities
from reports.labels import numbers
from reports.memo import memo

_STILL = 1e-5
"""Relative velocity that counts as none, as in `harness.model.result.contact_states`; the fastest vertex has 1."""
_STILL_MEASURED = 1e-3
"""The same in a measured velocity field, in which nothing is exactly at rest; as blocks in `shapes.moving`."""
_CARRIES = 2e-3
"""Share of the largest contact force below which a joint counts as without force, as forces are drawn."""
SLIDE, ROCK, BOTH, OPEN, DILATANT, STICK = "slide", "rock", "rock and slide", "open", "dilatant slip", "stick"


@dataclass(frozen=True)
class JointMotion:
    """What joints do in a mechanism, as facts each.

    Attributes:
        slides: (m,) whether the joint slides.
        opens: (m,) whether one of its ends or both open, beyond what dilatancy lifts.
        parts: (m,) whether both ends do.
        dilates: (m,) whether an end still pressed widens by tan phi times the slip, in an associated mechanism.
    """

    slides: np.ndarray
    opens: np.ndarray
    parts: np.ndarray
    dilates: np.ndarray

    @property
    def rubs(self) -> np.ndarray:
        """(m,) whether the joint slides while it touches: what parts along its whole length spends no friction."""
        return np.asarray(self.slides & ~self.parts)


@memo
def _motion(assembly: Assembly, result: Result) -> JointMotion:
    velocities = normalised_mechanism(assembly, np.asarray(result.mechanism, dtype=float))
    opening, slip = relative_velocities(assembly, velocities)
    still = _STILL_MEASURED if result.flow == "approximate" else _STILL
    associated = result.flow == "associated"
    law = assembly.law.associated if associated else assembly.law
    lifted = law.dilatancy * abs(slip)
    ends = np.asarray(opening - lifted[:, None] > still)
    slides = np.asarray(abs(slip) > still)
    parts = ends[:, 0] & ends[:, 1]
    return JointMotion(slides, ends[:, 0] | ends[:, 1], parts, slides & associated & ~parts)


def motion(assembly: Assembly, result: Result) -> JointMotion | None:
    """How the joints of a result move; None for a measured velocity field, in which nothing is exactly at rest."""
    if result.mechanism is None or result.flow == "approximate":
        return None
    return _motion(assembly, result)


def joint_states(assembly: Assembly, result: Result) -> list[str] | None:
    """What every joint of a mechanism does: one of the words above; None without a mechanism.

    In an associated mechanism a joint that slides widens by tan phi times its slip while it carries force: dilatant
    slip, whether it turns as well or not. Only what opens beyond that at both ends parts.
    """
    if result.mechanism is None or len(result.mechanism) != assembly.n_blocks:
        return None
    found = _motion(assembly, result)
    state = np.where(found.slides, SLIDE, STICK).astype(object)
    state[found.opens & ~found.slides] = ROCK
    state[found.opens & found.slides] = BOTH
    state[found.dilates] = DILATANT
    state[found.parts] = OPEN
    return [str(name) for name in state]


def open_with_force(assembly: Assembly, result: Result) -> int:
    """How many joints are drawn as open and carry a force that is drawn."""
    states = joint_states(assembly, result)
    if states is None or result.forces is None or len(result.forces) != assembly.n_interfaces:
        return 0
    forces = np.asarray(result.forces, dtype=float)
    normal = forces[:, 0] + forces[:, 1]
    size = np.hypot(normal, forces[:, 2])
    carries = (normal > 0.0) & (size >= _CARRIES * float(size.max(initial=0.0)))
    return sum(bool(force) and name == OPEN for name, force in zip(states, carries, strict=True))


def joints_in_words(found: JointMotion) -> str:
    """How many joints slide, rock and part, as "1 joint slides, 9 rock and 2 rock and slide"; nothing if none moves."""
    rocks = found.opens & ~found.parts & ~found.dilates
    both = int((rocks & found.slides).sum())
    counts = [
        (int((found.slides & ~found.opens & ~found.dilates).sum()), "slide"),
        (int(found.dilates.sum()), "slide and widen under force"),
        (int(rocks.sum()) - both, "rock"),
        (both, "rock and slide"),
        (int(found.parts.sum()), "open along their whole length"),
    ]
    moving = [(number, _OF_ONE[verb] if number == 1 else verb) for number, verb in counts if number]
    phrases = [
        f"{numbers.count(number, 'joint') if k == 0 else number} {verb}" for k, (number, verb) in enumerate(moving)
    ]
    return " and ".join(filter(None, [", ".join(phrases[:-1]), *phrases[-1:]]))


_OF_ONE = {
    "slide": "slides",
    "slide and widen under force": "slides and widens under force",
    "rock": "rocks",
    "rock and slide": "rocks and slides",
    "open along their whole length": "opens along its whole length",
}
