"""Plugin of pytest: a case is a test. `pytest --drystone quick` collects `case.toml` files, an item a reference."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from harness.engine.run import Run

# Imports of Drystone stand in the functions: pytest loads this module in every project.


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option `--drystone` and the field `drystone` of pytest's own configuration."""
    meaning = "collect case.toml files: hold their checked references, of the quick or the full tier"
    parser.getgroup("drystone").addoption("--drystone", choices=("quick", "full"), help=meaning)
    parser.addini("drystone", meaning, default="")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """The collector of a `case.toml`, where it was asked for."""
    tier = _tier(parent.config)
    if not tier or file_path.name != "case.toml":
        return None
    if tier not in ("quick", "full"):
        raise pytest.UsageError(f'drystone = "{tier}" in the configuration: the tier is quick or full')
    return CaseTests.from_parent(parent, path=file_path)


def _tier(config: pytest.Config) -> Any:
    return config.getoption("--drystone") or config.getini("drystone")


class CaseTests(pytest.File):
    """A case with its checked references."""

    def collect(self) -> Iterator[pytest.Item]:
        """An item for each method and checked reference; those of one run share it.

        Raises:
            CollectError: the case, its wall or a reference is wrong, in the words of `drystone check`.
        """
        from drystone.checking import planned
        from harness.engine.plan import find_cases
        from harness.model.errors import InputError

        try:
            plan = planned(find_cases([str(self.path.parent)], None, ()), _tier(self.config))
        except InputError as error:
            raise self.CollectError(str(error)) from None
        for run in plan.gated:
            held = HeldRun(run)
            for number, reference in enumerate(run.references):
                settings = "".join(f" {key}={value}" for key, value in sorted(run.settings.items()))
                name = f"{reference.id}[{run.method}{settings}]"
                yield ReferenceTest.from_parent(self, name=name, held=held, number=number)


class HeldRun:
    """The lines of one run, which is made when the first of them is asked for."""

    def __init__(self, run: Run) -> None:
        self._run = run

    @cached_property
    def lines(self) -> list[dict[str, Any]]:
        """One for each reference, in their order, as of `drystone.Check`."""
        from drystone.checking import Plan, held

        return held(Plan([self._run], []), None, 1).lines


class ReferenceTest(pytest.Item):
    """A checked reference that a method is held to."""

    def __init__(self, *, held: HeldRun, number: int, **given: Any) -> None:
        super().__init__(**given)
        self._held = held
        self._number = number

    def runtest(self) -> None:
        """Fail with the figures where the reference is missed; skip where it cannot be tested."""
        from harness.model.result import Verdict

        line = self._held.lines[self._number]
        sentence = f"{line['requirement']} {line['sentence']}"
        if line["verdict"] == Verdict.NOT_TESTED:
            pytest.skip(sentence)
        if line["verdict"] != Verdict.AGREES:
            raise AssertionError(sentence)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The sentence alone of a missed reference: its traceback tells nothing."""
        if isinstance(excinfo.value, AssertionError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Where the reference stands."""
        return self.path, 0, f"{self.path.parent.name}: {self.name}"
