"""`de-closed`: distinct elements find which contacts of an uneven wall are closed, FE and LA then load that structure.

C. Baggio and P. Trovalusci (1995) end by asking for this division of labour: the contacts of the imperfect wall are
found once, under its dead load, and the cheaper methods analyse the wall with those contacts alone under the live
load. Gaps that would close while the live load grows stay open here; `de-uneven` lets them close.
"""

from __future__ import annotations

import time
from typing import Any, ClassVar

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Settings, Status, load_method
from methods.de.imperfect import UnevenSettings
from methods.de.uneven import load_uneven, settle_uneven


class ClosedSettings(UnevenSettings):
    """The defects, and who analyses the structure of closed contacts.

    Attributes:
        main: method whose multiplier is the answer; others: methods that analyse the same structure beside it.
        compare: also load the same uneven wall with distinct elements alone, as `de-uneven` does, for value and cost.
    """

    main: str = "fe"
    others: tuple[str, ...] = ("la",)
    compare: bool = True


class ClosedContacts:
    """Contacts of an uneven wall from distinct elements, its multiplier from FE and LA (`de-closed`)."""

    name: ClassVar[str] = "de-closed"
    family: ClassVar[str] = "de"
    title: ClassVar[str] = "distinct elements find the contacts, FE and LA load them"
    tolerance: ClassVar[float] = 1e-6
    Settings: ClassVar[type[Settings]] = ClosedSettings

    def solve(self, assembly: Assembly, settings: ClosedSettings) -> Answer:
        """Settle the uneven wall, then analyse the wall with its closed contacts under the live load."""
        if not assembly.has_live_load:
            return Answer(Status.REFUSED, Finding.NONE, "The closed contacts are then loaded: give a live load.")
        began = time.process_time()
        settled = settle_uneven(assembly, settings.size, settings.faces, settings.seed)
        seconds = time.process_time() - began
        details: dict[str, Any] = {
            "settling": {"at_rest": settled.at_rest, "cpu_seconds": seconds},
            "interfaces": {"perfect": assembly.n_interfaces, "closed": settled.assembly.n_interfaces},
            "single_points": settled.single_points,
        }
        wall = settings.wall
        if not settled.at_rest:
            sentence = f"{wall} did not come to rest under its dead load, so its closed contacts are not known."
            return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, details=details)
        answers = {name: _analysed(name, settled.assembly) for name in (settings.main, *settings.others)}
        details["analyses"] = {name: found for name, (_, found) in answers.items()}
        if settings.compare:
            details["distinct_elements"] = _loaded(assembly, settings)
        main, _ = answers[settings.main]
        details["state"] = _state(settled.assembly, main)
        told = main.finding in (Finding.COLLAPSES, Finding.UNBOUNDED)
        return Answer(
            main.status if told else Status.NOT_CONVERGED,
            main.finding if told else Finding.NONE,
            f"{wall} has {settled.assembly.n_interfaces} closed contacts under its dead load, "
            f"{settled.single_points} of them at one point; with these alone {settings.main} says: {main.sentence}",
            multiplier=main.multiplier,
            flow="approximate",
            iterations=main.iterations,
            details=details,
        )


def _state(structure: Assembly, answer: Answer) -> dict[str, Any]:
    """The closed contacts and the forces (n1, n2, s) on them: what a check of the answer needs."""
    contacts = ("block_a", "block_b", "end1", "end2", "normal", "friction")
    return {
        **{name: getattr(structure, name).tolist() for name in contacts},
        "forces": None if answer.forces is None else answer.forces.tolist(),
        "multiplier": answer.multiplier if answer.forces_multiplier is None else answer.forces_multiplier,
    }


def _analysed(name: str, structure: Assembly) -> tuple[Answer, dict[str, Any]]:
    """The answer of a method on the structure of closed contacts, and what is told of it."""
    method = load_method(name)
    began = time.process_time()
    answer = method.solve(structure, method.Settings())
    return answer, {
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
