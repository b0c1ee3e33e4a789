"""What people look for in a wall file and Drystone does not model: a missing model is no misspelling."""

from __future__ import annotations

import re

SCOPE = "docs/scope.md"
"""Where the scope of Drystone is written, from the root of the project."""

_OUTSIDE = {
    "joints that soften, or whose friction falls as they slide (cohesion and tensile_strength are fields)": (
        "mortar", "mortar_joint", "residual_friction", "peak_friction", "roughness", "fracture_energy",
    ),
    "blocks that crack or deform (joints crush by their compressive_strength)": (
        "strength", "crushing_strength", "crushing", "fc", "fk", "fm", "fd",
        "young", "youngs_modulus", "young_modulus", "elastic_modulus", "modulus", "poisson", "poisson_ratio",
        "shear_modulus", "stiffness", "normal_stiffness", "shear_stiffness", "kn", "ks", "creep",
    ),
    "prescribed displacements (settlements of supports are a field, for `drystone reaction`)": (
        "displacement", "displacements", "prescribed_displacement", "support_movement",
        "spread", "spreading", "rotation",
    ),
    "reinforcement and springs (ties and props are fields, of bars that yield)": (
        "tie_rod", "anchor", "anchors", "reinforcement", "rebar", "spring", "springs", "cable", "cables", "frp",
        "post_tension",
    ),
    "soil and water that resist (pressures and fills of a load are fields, and a dead fill may be passive)": (
        "passive", "passive_pressure", "passive_fill", "kp",
        "backfill", "fill", "soil", "earth", "earth_pressure", "foundation", "water", "pore_pressure", "uplift",
    ),
    "motion in time": (
        "damping", "mass", "time", "time_history", "accelerogram", "ground_motion", "velocity", "acceleration",
        "frequency", "restitution",
    ),
    "a third dimension": ("z", "depth", "polyhedron", "faces", "mesh", "out_of_plane"),
    "temperature": ("temperature", "thermal", "thermal_expansion"),
}  # fmt: skip
_WORDS = {word: model for model, words in _OUTSIDE.items() for word in words}


def outside_the_model(field: str) -> str:
    """The part of reality a field speaks of that Drystone does not model; empty for any other field."""
    word = re.sub(r"(?<=[a-z])(?=[A-Z])|[\s\-]+", "_", field).lower().strip("_")
    return _WORDS.get(word, "")
