"""Packages that a part alone needs: they come with an extra, and their absence is stated in a sentence."""

from __future__ import annotations

import importlib
from typing import Any

from harness.model.errors import MissingPackage


def optional(package: str, extra: str, part: str) -> Any:
    """A package that an extra installs.

    Args:
        package: its name for Python.
        extra: of drystone that brings it.
        part: what needs it, as the error names it: "method scip".

    Raises:
        MissingPackage: it is not installed.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise MissingPackage(
            f"it needs the package {package} ({error})",
            f'Install it with pip install "drystone[{extra}]", in a clone with pip install -e ".[{extra}]"',
            part,
        ) from error
