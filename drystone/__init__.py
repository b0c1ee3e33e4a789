"""Drystone as a library: walls in, judged answers out.

>>> import drystone
>>> wall = drystone.new_wall("stack", count=3, width=0.3, height=0.2, friction=0.8)
>>> result = drystone.analyse(wall, "la-associated")
>>> print(f"{result.multiplier:.6f}, {result.judge.outcome}")
0.500000, accepted

`read_wall`, `build_wall`, `new_wall` and `library_wall` give a `Wall`; `analyse` runs one method in this process,
`compare` many, each run in a process of its own; `judge` checks an answer for equilibrium, yield and flow. `sweep`
varies friction, proportions or seeds over many walls, and `check` compares methods with checked references.
`factor` is the factor of safety on friction, `domain` the interaction domain of two live loads, and `capacity` the
capacity curve, on updated geometry; `shake` and `least_shaking` follow walls in time on ground that accelerates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "1.0.0"

__all__ = [
    "Answer",
    "CapacityCurve",
    "Check",
    "Comparison",
    "Domain",
    "FactorOfSafety",
    "Finding",
    "InputError",
    "Judgement",
    "LeastShaking",
    "Result",
    "Shaking",
    "Status",
    "Sweep",
    "Traits",
    "Verdict",
    "Wall",
    "__version__",
    "analyse",
    "build_wall",
    "capacity",
    "check",
    "compare",
    "domain",
    "factor",
    "judge",
    "least_shaking",
    "library_wall",
    "library_walls",
    "methods",
    "new_wall",
    "read_wall",
    "shake",
    "sweep",
]

if TYPE_CHECKING:
    from drystone.analysis import Result, analyse, judge, methods
    from drystone.capacity_curve import CapacityCurve, capacity
    from drystone.checking import Check, check
    from drystone.comparing import Comparison, compare
    from drystone.interaction import Domain, domain
    from drystone.safety import FactorOfSafety, factor
    from drystone.shaking import Shaking, shake
    from drystone.studies import Sweep, sweep
    from drystone.toppling import LeastShaking, least_shaking
    from drystone.walls import Wall, build_wall, library_wall, library_walls, new_wall, read_wall
    from harness.model.errors import InputError
    from harness.model.method import Answer, Finding, Status, Traits
    from harness.model.result import Judgement, Verdict

_HOME = {
    "drystone.analysis": ("Result", "analyse", "judge", "methods"),
    "drystone.capacity_curve": ("CapacityCurve", "capacity"),
    "drystone.checking": ("Check", "check"),
    "drystone.comparing": ("Comparison", "compare"),
    "drystone.interaction": ("Domain", "domain"),
    "drystone.toppling": ("LeastShaking", "least_shaking"),
    "drystone.safety": ("FactorOfSafety", "factor"),
    "drystone.shaking": ("Shaking", "shake"),
    "drystone.studies": ("Sweep", "sweep"),
    "drystone.walls": ("Wall", "build_wall", "library_wall", "library_walls", "new_wall", "read_wall"),
    "harness.model.errors": ("InputError",),
    "harness.model.method": ("Answer", "Finding", "Status", "Traits"),
    "harness.model.result": ("Judgement", "Verdict"),
}

_PACKAGES = ("harness", "methods", "cases", "reports")
"""Top-level packages that are installed with `drystone`; their names are ordinary words."""


def in_the_way() -> str:
    """A sentence that names the first file Python would import in place of a package of ours; empty if there is none.

    Ours lie beside the package `drystone`; a module of the working folder or of another distribution does not.
    """
    import importlib.util
    from pathlib import Path

    home = Path(__file__).resolve().parent.parent
    for name in _PACKAGES:
        spec = importlib.util.find_spec(name)
        places = [] if spec is None else list(spec.submodule_search_locations or [spec.origin or ""])
        if spec is None:
            return f"the package {name} is not installed beside {home / 'drystone'}: install Drystone again"
        if home / name not in [Path(place).resolve() for place in places]:
            return (
                f"{places[0]} is imported in place of the package {name} of Drystone: rename it, or run Drystone "
                "from another folder"
            )
    return ""


def __getattr__(name: str) -> Any:
    """Public names are imported when they are used first, so that the command starts at once.

    Raises:
        ImportError: a file lies in the way of a package of Drystone; the message names it.
    """
    import importlib

    for module, names in _HOME.items():
        if name in names:
            obstacle = in_the_way()
            if obstacle:
                raise ImportError(obstacle)
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module 'drystone' has no attribute {name!r}")


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
