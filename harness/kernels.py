"""Compile the kernels of every shipped method: `python -m harness.kernels`, which `make` runs when it installs."""

from __future__ import annotations

import sys

from harness.conformance import CLOSED_FORMS, assembly_of
from harness.engine.preload import shipped
from harness.model.method import load_method, method_names


def main() -> None:
    """Run every shipped method on two small walls, which compiles what it uses; print what could not be run."""
    for name in shipped(method_names()):
        try:
            method = load_method(name)
            for form in CLOSED_FORMS[-2:]:
                method.solve(assembly_of(form.wall, form.name), method.Settings())
        except Exception as error:
            print(f"{name} cannot be prepared: {error}", file=sys.stderr)


if __name__ == "__main__":
    main()
