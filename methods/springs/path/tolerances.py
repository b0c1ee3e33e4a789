"""When numbers of the continuation count as zero, as free, as large or as lost."""

from __future__ import annotations

DRIFT = 1e-9
"""Out-of-balance force (share of the load scale) above which the tangent is factorised afresh."""
STEEP = 1e8
"""Changes with |1 + b'y| or its inverse above this would cost digits; the tangent is factorised afresh."""
FREE = 1e4
"""Velocities larger than this many times the first one, at the same rate of the multiplier, are pinned."""
WEAK = 1e-3
"""Share of the fastest displacement below which the pin no longer holds the motion, and is moved."""
COARSE = 1e6
"""Dimensionless displacements up to which the rounding of gap rates changes no force by more than 1e-9."""
BENT = 1e-7
"""Defect of K v = l live (share of the live load) above which a velocity is refined."""
CROOKED = 1e-5
"""The same when refinement no longer helps, above which the tangent is factorised afresh."""
STRAIGHT = 1e-7
"""Defect above which a pinned velocity is refined, as a force over a motion as long as the displacements so far."""
BEARABLE = 1e-4
"""The same when refinement no longer helps, above which the tangent is factorised afresh."""
SOFT = 1e8
"""A response of the pinned wall to the live load this many times the first one is a soft motion to be pinned too."""
MOST = 4
"""Pins at most."""
CLEAR = 1e-6
"""Rate of a kink function, over the fastest velocity, from which its sign in a new direction is beyond doubt."""
CAREFUL = 8
"""Refinements of a velocity at most."""
NOISE = 1e-7
"""Rates of kink functions below this, as forces over such a motion, count as zero on pinned pieces."""
FAR = 1e4
"""A mechanism that moves this many times the present displacement before its next kink is the collapse."""
LARGE = 1e13
"""Displacements, in multiples of the first ones, beyond which the path is not followed."""
ENOUGH = 1e10
"""Displacements, in multiples of the first ones, at which a mechanism that passes its check is the collapse."""
GROWN = 1.1
"""By how much displacements grow from one check of a mechanism to the next."""
LOST = 1e-5
"""Out-of-balance force (share of the load scale) at which the path counts as lost."""
ELSEWHERE = 1e-2
"""The same from which equilibrium, found again, would be another path's."""
GLANCE = 4
"""Changes of state between two looks at how straight the direction is, while it is not pinned."""
LOOK = 8
"""Changes of state between two looks at the out-of-balance force."""
TIE = 1e-12
"""How far a kink may be overrun by the choice among near ties (share of the load scale)."""
ELASTIC = 1e-8
"""Elastic force rates below this share of the strain rates count as zero: the direction is a mechanism."""
