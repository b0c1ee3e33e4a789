"""Blocks with uneven faces: distinct elements load the wall (`de-uneven`), or find its contacts alone (`de-closed`).

`de-uneven` loads one wall at large displacements until it no longer comes to rest. In `de-closed` distinct elements
find which contacts are closed, and finite elements then load the wall.

C. Baggio and P. Trovalusci (1995) end by asking for this division of labour: the contacts of the imperfect wall are
found once, under its dead load, and a cheaper method loads it. Gaps that close while the live load grows must be handed
over with the contacts: the springs close them as they do. What FE and LA say of the contacts alone that are closed
under the dead load, and nothing closes, stands beside that.
"""

from __future__ import annotations

import time
from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Solver, Status
from harness.model.method_registry import load_method
from harness.model.rings import rings_of
from methods.de.holds.loading import raise_until_it_falls, shown_to_fall
from methods.de.settings import REACH, ClosedSettings, UnevenSettings
from methods.de.uneven.gapped import GappedWall
from methods.de.uneven.settled_contacts import Loading, load_uneven, settle_uneven

_BRACKET_MEANING = "[highest multiplier at which it came to rest, lowest at which it fell]"


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
            bracket_meaning=_BRACKET_MEANING,
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


class ClosedContacts(Solver):
    """Contacts and gaps of an uneven wall from distinct elements, its multiplier from gap springs (`de-closed`)."""

    def solve(self, assembly: Assembly, settings: ClosedSettings) -> Answer:
        """Settle the uneven wall, then load it with springs in its contacts and gaps."""
        if not assembly.has_live_load:
            return Answer(Status.REFUSED, Finding.NONE, "The contacts are then loaded: give a live load.")
        began = time.process_time()
        settled = settle_uneven(assembly, settings.size, settings.faces, settings.seed)
        details: dict[str, Any] = {
            "settling": {"at_rest": settled.at_rest, "cpu_seconds": time.process_time() - began},
            "interfaces": {"perfect": assembly.n_interfaces, "closed": settled.assembly.n_interfaces},
            "single_points": settled.single_points,
        }
        wall = settings.wall
        if not settled.at_rest:
            sentence = f"{wall} did not come to rest under its dead load, so its contacts are not determined."
            return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, details=details)
        try:
            gapped = GappedWall(assembly, settled.outlines, settled.settlement, REACH)
        except ValueError as error:
            return Answer(Status.REFUSED, Finding.NONE, f"Its gaps cannot be measured: {error}.")
        began = time.process_time()
        loaded = _load_gapped(gapped, settings.greatest, settings.step, settings.accuracy)
        details["loading"] = {"cpu_seconds": time.process_time() - began, "drift": gapped.drift}
        details["analyses"] = {name: _analysed(name, settled.assembly) for name in settings.alone}
        if settings.compare:
            details["distinct_elements"] = _loaded(assembly, settings)
        answer = _concluded(wall, loaded)
        if loaded is not None:
            answer.forces_multiplier = loaded[0]
            details |= gapped.state().as_details()
        answer.details = details
        return answer


def _concluded(wall: str, loaded: tuple[float, float | None] | None) -> Answer:
    """What the loading says, without details."""
    if loaded is None:
        sentence = f"{wall} came to rest in distinct elements, but springs in its contacts found no equilibrium."
        return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
    stood, fell = loaded
    if fell is None:
        sentence = f"{wall} stood at {stood:.6g} and did not fall up to the greatest multiplier tested."
        return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence)
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"{wall}, with springs in the contacts and gaps that distinct elements found, came to rest at {stood:.6g} and "
        f"fell at {fell:.6g}.",
        multiplier=0.5 * (stood + fell),
        bracket=(stood, fell),
        bracket_meaning=_BRACKET_MEANING,
        flow="approximate",
    )


def _analysed(name: str, structure: Assembly) -> dict[str, Any]:
    """What a method says of the structure of closed contacts alone."""
    method = load_method(name)
    began = time.process_time()
    answer = method.solve(structure, method.Settings())
    return {
        "status": str(answer.status),
        "finding": str(answer.finding),
        "multiplier": answer.multiplier,
        "residuals": answer.details.get("residuals"),
        "cpu_seconds": time.process_time() - began,
    }


def _loaded(assembly: Assembly, settings: ClosedSettings) -> dict[str, Any]:
    """The bracket of distinct elements alone on the same uneven wall, and its cost."""
    began = time.process_time()
    found = load_uneven(
        assembly, settings.size, settings.faces, settings.seed, settings.greatest, accuracy=settings.accuracy
    )
    return {"stood": found.stood, "fell": found.fell, "cpu_seconds": time.process_time() - began}


def _load_gapped(wall: GappedWall, greatest: float, step: float, accuracy: float) -> tuple[float, float | None] | None:
    """The highest multiplier at which the wall came to rest and the lowest at which it is shown to move, if any.

    Args:
        wall: the wall, which stays at its last rest.
        greatest, step, accuracy: as in `raise_until_it_falls`.

    Returns:
        None where it does not come to rest under its dead load.
    """
    if not wall.rests(0.0):
        return None
    ends = raise_until_it_falls(wall.rests, greatest, step, accuracy)
    return shown_to_fall(wall.rests, wall.moved, ends, greatest, accuracy)
