"""NAME conforms to the suite of Drystone, and finds the associated maximum of the paper's wall."""

from MODULE import CLASS

import drystone
from harness.conformance import suite


def test_it_finds_what_the_method_of_drystone_finds() -> None:
    wall = drystone.library_wall("wall-21")
    mine, other = drystone.analyse(wall, CLASS()), drystone.analyse(wall, "la-associated")
    assert mine.multiplier is not None
    assert other.multiplier is not None
    assert abs(mine.multiplier / other.multiplier - 1.0) < 1e-8
    assert mine.judge.accepted


def test_it_conforms() -> None:
    found = [check.row(CLASS()) for check in suite()]
    assert [row for row in found if row.outcome == "fails"] == []
    assert sum(row.outcome == "conforms" for row in found) >= 15
