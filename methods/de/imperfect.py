"""`de-uneven`: one wall of blocks with uneven faces, loaded at large displacements until it no longer comes to rest."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Settings, Status, Traits
from harness.model.rings import rings_of
from methods.de.uneven.defects import Faces
from methods.de.uneven.settled_contacts import Loading, load_uneven

BRACKET_MEANING = "[highest multiplier at which it came to rest, lowest at which it fell]"


class UnevenSettings(Settings):
    """The defects of planarity and how finely the multiplier is sought.

    Attributes:
        size: greatest cut of a corner as a part of the block height; each is drawn from U(0, size x height).
        faces: which faces are uneven.
        seed: seed of the cuts.
        accuracy: the multiplier is narrowed to this difference.
        greatest: multiplier at which the loading ends.
    """

    size: float = Field(default=0.03, ge=0.0, le=0.3)
    faces: Faces = "both"
    seed: int = Field(default=0, ge=0)
    accuracy: float = Field(default=0.005, gt=0.0, le=0.1)
    greatest: float = Field(default=2.0, gt=0.0)

    @property
    def wall(self) -> str:
        """What a sentence calls the wall with these defects."""
        return f"The wall with corners cut by up to {self.size:g} of the block height (seed {self.seed})"


class UnevenBlocks:
    """Distinct elements on a wall with seeded defects of planarity (C. Baggio and P. Trovalusci 1995, section 6)."""

    name: ClassVar[str] = "de-uneven"
    family: ClassVar[str] = "de"
    title: ClassVar[str] = "distinct elements, uneven blocks"
    tolerance: ClassVar[float] = 1e-6
    traits: ClassVar[Traits] = Traits(
        caption="between held and moving, uneven blocks",
        brackets=True,
        colour="#2f6b3a",
        marker="h",
        line="dashdot",
    )
    Settings: ClassVar[type[Settings]] = UnevenSettings

    def solve(self, assembly: Assembly, settings: UnevenSettings) -> Answer:
        """The bracket [stood, fell] of one imperfect wall; gaps close under the load as they do."""
        if not assembly.has_live_load:
            return Answer(Status.REFUSED, Finding.NONE, "Uneven walls are loaded until they fall: give a live load.")
        if any(len(rings_of(polygon)) > 1 for polygon in assembly.polygons):
            return Answer(Status.REFUSED, Finding.NONE, "Corners of blocks with holes are not cut: ask de.")
        found = load_uneven(
            assembly, settings.size, settings.faces, settings.seed, settings.greatest, accuracy=settings.accuracy
        )
        wall = settings.wall
        if found.stood is None and not found.undecided:
            return Answer(Status.OK, Finding.FALLS, f"{wall} falls under its dead load.", flow="approximate")
        if found.stood is None or found.fell is None:
            return Answer(Status.NOT_CONVERGED, Finding.NONE, _without_fall(wall, found))
        return Answer(
            Status.OK,
            Finding.COLLAPSES,
            f"{wall} came to rest at {found.stood:.6g} and fell at {found.fell:.6g}.",
            multiplier=0.5 * (found.stood + found.fell),
            bracket=(found.stood, found.fell),
            bracket_meaning=BRACKET_MEANING,
            flow="approximate",
            details={"drift": found.drift},
        )


def _without_fall(wall: str, found: Loading) -> str:
    """What is said of a wall that is not shown to move at any load."""
    if found.stood is None:
        return f"{wall} neither came to rest under its dead load nor is shown to fall."
    if found.undecided:
        return f"{wall} came to rest at {found.stood:.6g}, and above it neither did so nor is shown to fall."
    return f"{wall} stood at {found.stood:.6g}, the greatest multiplier asked."
