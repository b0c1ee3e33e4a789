"""Packages that one method alone needs: they come with an extra, and their absence is stated in a sentence."""

from __future__ import annotations

import importlib
from typing import Any

from harness.model.errors import MissingPackage


def optional(package: str, extra: str, method: str) -> Any:
    """A package that an extra installs.

    Args:
        package: its name for Python.
        extra: of drystone that brings it.
        method: that needs it.

    Raises:
        MissingPackage: it is not installed.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise MissingPackage(
            f"it needs the package {package} ({error})", f"Install drystone[{extra}]", f"method {method}"
        ) from error
