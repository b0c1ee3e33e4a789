"""Studies: questions asked of many walls at once, as cases that the engine runs and the report plots.

wall-21-family   for which proportion and friction do FE, LA and DE agree within 1 % on the paper's wall?
friction         the same wall, bricks 2:1, over friction alone: where do the methods part?
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cases.families import FRICTIONS, Member, family
from harness.model.case import Case, CaseFile

SOURCE = "C. Baggio, P. Trovalusci 1995; proportions, friction and bottom course are lost with the paper's figures"


def _case(member: Member) -> Case:
    name = f"wall-21-{member.proportion:g}to1-mu{member.friction:g}-{member.start}".replace(".", "p")
    file = CaseFile(id=name, title=member.wall.title, source=SOURCE)
    return Case(file, member.wall, f"study of {name}")


def _grid() -> Iterator[Case]:
    """Four proportions, eleven frictions, both bottom courses."""
    for member in family(proportions=(1.0, 2.0, 3.0, 4.0)):
        yield _case(member)


def _friction() -> Iterator[Case]:
    """Bricks 2:1, bottom course begins with half a brick."""
    for member in family(proportions=(2.0,), frictions=FRICTIONS, starts=("half",)):
        yield _case(member)


STUDIES: dict[str, Callable[[], Iterator[Case]]] = {"wall-21-family": _grid, "friction": _friction}
"""Every study by name."""
