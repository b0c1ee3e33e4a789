"""The equations of a wall that the bound needs: statics, kinematics and friction, scaled to order one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw, block_diagonal
from methods.proof.search.options import ProofOptions


@dataclass(frozen=True, eq=False)
class Equations:
    """A wall of n free blocks and m interfaces: C' r + dead + multiplier * live = 0, strains C u, live.u = n.

    Attributes:
        kinematic: sparse (3m, 3n) matrix C; a strain is (opening 1, opening 2, slip).
        dead, live: (3n,) loads in mean block weights.
        friction: (m,) friction coefficients.
        options: of the search for a bound of its multiplier.
    """

    kinematic: sp.csr_matrix
    dead: FloatArray
    live: FloatArray
    friction: FloatArray
    options: ProofOptions = ProofOptions()

    @property
    def n_interfaces(self) -> int:
        """Number of interfaces m."""
        return len(self.friction)

    @property
    def n_blocks(self) -> float:
        """Number of free blocks n, the live work of every mechanism."""
        return len(self.dead) / 3.0

    @cached_property
    def slack(self) -> FloatArray:
        """(4m, 3m) matrix S of the slacks y = S r = (n1, n2, mu N + s, mu N - s) of every interface."""
        return block_diagonal(self.law.rows).toarray()

    @cached_property
    def flow(self) -> FloatArray:
        """(3m, 4m) matrix E of the strains E g of rates g = (opening 1, opening 2, slip +, slip -)."""
        return block_diagonal(self.law.flow).toarray()

    @cached_property
    def law(self) -> JointLaw:
        """The law of its joints, without dilatancy."""
        return JointLaw(self.friction, np.zeros(self.n_interfaces))
