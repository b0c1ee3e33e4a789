"""Settings of methods as they are given on the command line, NAME=VALUE or METHOD.NAME=VALUE."""

from __future__ import annotations

import json
from typing import Any

from harness.engine.plan import check_methods
from harness.model.errors import InputError, did_you_mean
from harness.model.method_registry import load_method
from harness.model.reading import validate


def settings_of(method: str, pairs: tuple[str, ...]) -> dict[str, Any]:
    """Settings of one method, from NAME=VALUE.

    Raises:
        InputError: a setting that does not exist, or a value it cannot have.
    """
    if not pairs:
        return {}
    values: dict[str, Any] = {}
    known = load_method(method).Settings.model_fields
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not equals and name in known:
            raise InputError(f'"{pair}" gives no value', "Give NAME=VALUE", "--set")
        if name not in known:
            names = f"Give NAME=VALUE with a name of: {', '.join(known) or '(it has none)'}"
            raise InputError(
                f'"{pair}" is no setting of {method}', f"{did_you_mean(name, known)} {names}".strip(), "--set"
            )
        try:
            values[name] = json.loads(text)
        except (ValueError, RecursionError):  # no JSON, a number of thousands of digits, or nested without end
            values[name] = text
    validate(load_method(method).Settings, values, f"--set of {method}")
    return values


def method_settings(pairs: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """Settings of several methods, from METHOD.NAME=VALUE.

    Raises:
        InputError: a method or a setting that does not exist, or a value it cannot have.
    """
    by_method: dict[str, list[str]] = {}
    for pair in pairs:
        method, dot, rest = pair.partition(".")
        if not dot or "=" in method:
            raise InputError(f'"{pair}" names no method', "Give METHOD.NAME=VALUE", "--set")
        by_method.setdefault(method, []).append(rest)
    check_methods(list(by_method), "--set")
    return {method: settings_of(method, tuple(given)) for method, given in by_method.items()}
