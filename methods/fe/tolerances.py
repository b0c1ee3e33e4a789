"""When numbers of the continuation count as zero, as free, as large or as lost."""

from __future__ import annotations

ILL = 1e-6
"""|1 + b'y| below which the tangent is nearly singular: the piece is followed, then factorised afresh."""
SINGULAR = 1e-13
"""|1 + b'y| below which the tangent is singular: the multiplier rests while the wall moves along y."""
DRIFT = 1e-9
"""Out-of-balance force (share of the load scale) above which the tangent is factorised afresh."""
STEEP = 1e6
"""Changes with |1 + b'y| or its inverse above this would cost digits; the tangent is factorised afresh."""
FREE = 1e5
"""Directions larger than this many times the first one are measured in doubled precision."""
BENT = 1e-7
"""Defect of K d = live (share of the live load) above which the tangent is factorised afresh."""
CROOKED = 1e-5
"""The same when refinement no longer helps."""
NEARLY_FREE = 1e5
"""Directions larger than this many times the first one are looked at as possible mechanisms."""
BLIND = 1e10
"""Directions larger than this many times the first one that refinement cannot straighten are null vectors."""
FAR = 1e4
"""A mechanism that moves this many times the present displacement before its next kink is the collapse."""
LARGE = 1e13
"""Displacements, in multiples of the first ones, beyond which the path is not followed."""
LOST = 1e-5
"""Out-of-balance force (share of the load scale) at which the path counts as lost."""
NOISE = 1e-4
"""Force rates (share of the live load) below this count as zero on pieces measured in doubled precision."""
GLANCE = 4
"""Changes of state between two looks at how straight the direction is, while it is not FREE."""
LOOK = 8
"""Changes of state between two looks at the out-of-balance force."""
TIE = 1e-12
"""How far a kink may be overrun by the choice among near ties (share of the load scale)."""
RIGID = 1e-12
"""The same share where rates were refined in doubled precision: there a null vector is told from a soft piece."""
ELASTIC = 1e-8
"""Elastic force rates below this share of the strain rates count as zero: the direction is a mechanism."""
