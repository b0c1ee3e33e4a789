"""Branch and bound over contacts: what it proves is what enumeration and the search of `la` find too."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.walls import small_arch
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.wall import Wall
from methods.la.certify.proof import LeafCertificates, TreePart, TreeProof, prove
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.state import CollapseState
from methods.la.core.vertex_programmes import ForceProgramme
from methods.la.find_certificate import find_certificate
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.la.sources.search import Search
from methods.proof.verify.checker import verify
from tests.la.bodies import block_on_halves, column, running_bond
from tests.la.test_mechanisms import six_blocks
from tests.soak import random_wall


def proof_from(wall: Assembly, nodes: int) -> tuple[Problem, CollapseState, TreeProof]:
    """What the tree proves from the state that the interior point ends at, which need not be the least."""
    problem = make_problem(wall)
    search = Search(problem, NewtonMatrix(problem))
    known = search.interior()
    assert known is not None
    return problem, known, prove(search, known, nodes)


def test_the_paper_s_block_has_no_collapse_state_below_its_smaller_friction() -> None:
    """Its joints may carry any self-stress, so it slides at .4, where FE's plateau is .4762 (paper, table 1)."""
    answer = LimitAnalysis().solve(block_on_halves(), SearchSettings())
    assert answer.details["proved_least"]
    assert answer.multiplier == pytest.approx(0.4, rel=1e-12)
    assert answer.details["lower_bound"] == pytest.approx(0.4, rel=2e-6)  # the margin of the tree
    assert "excludes lower ones to rounding" in answer.sentence


def test_the_tree_finds_the_least_state_of_six_blocks_from_a_higher_one() -> None:
    problem, known, proof = proof_from(six_blocks(), 3000)
    assert proof.complete
    assert problem.to_multiplier(proof.state.multiplier) == pytest.approx(0.4257766, rel=1e-6)  # seven digits
    assert known.multiplier > 1.1 * proof.state.multiplier


def test_a_tree_cut_short_proves_less_but_nothing_wrong() -> None:
    whole = proof_from(column([0.5, 0.4, 0.6], [0.3, 0.5, 0.2], 0.55), 1000)[2]
    assert whole.complete
    for nodes in (0, 1, 3, 5, 9):
        part = proof_from(column([0.5, 0.4, 0.6], [0.3, 0.5, 0.2], 0.55), nodes)[2]
        assert part.lower_bound <= whole.state.multiplier
        assert part.nodes <= nodes + 2


def test_a_wall_too_large_for_a_tree_is_said_to_have_no_proof() -> None:
    answer = LimitAnalysis().solve(running_bond(6, 3, 0.2, 0.65), SearchSettings(effort="quick"))
    assert not answer.details["proved_least"]
    assert answer.details["lower_bound"] < answer.multiplier


def test_a_tree_that_does_not_end_bounds_by_all_its_leaves() -> None:
    """It ends with a few hundred leaves; cut off earlier it bounds by those it has and by the parts that are left."""
    problem = make_problem(build(random_wall(59)).assembly)
    search = Search(problem, NewtonMatrix(problem))
    known = search.interior()
    assert known is not None
    proof = prove(search, known, 800)
    assert not proof.complete
    assert len(proof.leaves) > 350
    assert 0.387 < proof.lower_bound < known.multiplier


def test_contacts_that_a_certificate_needs_bound_without_the_others() -> None:
    """Of parts that hold these and more the same vertex is the proof; the programmes with these alone say so too."""
    problem, _, proof = proof_from(six_blocks(), 3000)
    limit = proof.lower_bound
    certificates, programme = LeafCertificates(Search(problem, NewtonMatrix(problem)), limit), ForceProgramme(problem)
    assert all(certificates.bound(TreePart(tight, still, 0.0, 0)) for tight, still in proof.leaves)
    assert 0 < len(certificates.tight) + len(certificates.still) < len(proof.leaves)
    for tight in certificates.tight:
        least = programme.extreme(greatest=False, tight=tight)
        assert least == "infeasible" or least.statics.multiplier >= limit * (1.0 - 1e-9)
    for still in certificates.still:
        work = programme.least_dead_work(still)
        assert work == "unbounded" or work.work >= limit * (1.0 - 1e-9)


@pytest.mark.parametrize("seed", [1, 28, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (10, 11, 15))])
def test_small_arches_are_proved_by_the_tree_and_in_fractions(seed: int) -> None:
    """Parts without live work have mechanisms on which dead loads work: an arch slides down at an abutment."""
    wall = small_arch(seed)
    answer = LimitAnalysis().solve(wall, SearchSettings())
    assert answer.details["proved_least"]
    document = find_certificate(wall, 10.0, SearchSettings()).document
    assert document is not None
    lower, upper = verify(document)
    assert upper is not None
    assert float(upper) == pytest.approx(answer.multiplier, rel=1e-9)
    assert 0.0 <= float(upper - lower) <= 3e-6 * float(upper)


def test_a_part_whose_mechanisms_all_work_against_the_live_load_is_excluded() -> None:
    """A block on a slope of 3 in 4, pushed straight into it, that may slide one way only, without live work.

    Forces that do no work on a slip downwards do not carry the weight, at any multiplier, but they carry the push.
    """
    slope = {"id": "slope", "polygon": [[0, 0], [4, 3], [7, -1], [3, -4]], "fixed": True}
    block = {"id": "block", "polygon": [[0, 0], [4, 3], [1, 7], [-3, 4]]}
    loads = {"live": {"body": [{"per_weight": [0.6, -0.8]}]}}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.9, "blocks": [slope, block], "loads": loads}
    programme = ForceProgramme(make_problem(build(Wall.model_validate(wall)).assembly))
    found = []
    for way in (2, 3):
        still = np.ones((1, 4), dtype=bool)
        still[0, way] = False
        work = programme.least_dead_work(still)
        found.append(work if isinstance(work, str) else str(work.work))
    assert sorted(found) == ["inf", "unbounded"]
