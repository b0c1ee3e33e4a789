"""Whether the packages that Drystone stands on are its own: other files of their names may lie in the way."""

from __future__ import annotations

import importlib.util
from pathlib import Path

PACKAGES = ("harness", "methods", "cases", "reports")
"""Top-level packages that are installed with `drystone`; their names are ordinary words."""


def in_the_way() -> str:
    """A sentence that names the first file Python would import in place of a package of ours; empty if there is none.

    Ours lie beside the package `drystone`; a module of the working folder or of another distribution does not.
    """
    home = Path(__file__).resolve().parent.parent
    for name in PACKAGES:
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
