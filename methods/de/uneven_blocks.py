"""`de-uneven`: one wall of blocks with uneven faces, loaded at large displacements until it no longer comes to rest."""

from __future__ import annotations

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Solver, Status
from harness.model.rings import rings_of
from methods.de.settings import UnevenSettings
from methods.de.uneven.settled_contacts import Loading, load_uneven

BRACKET_MEANING = "[highest multiplier at which it came to rest, lowest at which it fell]"


class UnevenBlocks(Solver):
    """Distinct elements on a wall with seeded defects of planarity (C. Baggio and P. Trovalusci 1995, section 6)."""

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
        return f"{wall} neither came to rest under its dead load nor is proved to fall."
    if found.undecided:
        return f"{wall} came to rest at {found.stood:.6g}, and above it neither did so nor is proved to fall."
    return f"{wall} stood at {found.stood:.6g}, the greatest multiplier tested."
