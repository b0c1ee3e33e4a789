"""The one way from a run to its result: found in the store or made, judged, compared with references, and kept."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.engine.executors import Executor, InProcess, Job, LocalExecutor
from harness.engine.judge import judge
from harness.engine.provenance import judge_version
from harness.engine.run import Analysed, Judge, Limits, Run
from harness.engine.verdict import compare, overall
from harness.model.answer_check import AnswerFault, checked
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Answer, Status
from harness.model.method_registry import load_method
from harness.model.reading import validate
from harness.model.result import Judgement, Result, bracket_is_wide, measured_width, result_of

if TYPE_CHECKING:
    from harness.engine.store import Store

Progress = Callable[[Run, Result, bool], None]
"""Called after every run with the run, its result and whether it came from the store."""


def opened_at(path: str | Path | None) -> AbstractContextManager[Store | None]:
    """The store of a file, closed at the end; None where there is no path.

    Raises:
        InputError: as of `harness.engine.store.open_store`.
    """
    if path is None:
        return nullcontext()
    from harness.engine.store import open_store

    return open_store(Path(path))


@dataclass(frozen=True)
class Runs:
    """How runs are made that follow from each other, one at a time.

    Attributes:
        limits: of each, in a child process; None: they are made in this process, without limits.
        store: file in which results are looked for and kept; None: nowhere.
        fresh: run what is in the store as well.
    """

    limits: Limits | None = None
    store: str | Path | None = None
    fresh: bool = False

    def result(self, case: Analysed, method: str, settings: Mapping[str, Any], judge: Judge | None = None) -> Result:
        """The judged result of one run; arguments as of `Run`.

        Raises:
            InputError: as of `execute`, and what the method refuses where there are no limits.
        """
        executor = InProcess() if self.limits is None else LocalExecutor(1)
        run = Run(case, method, settings, self.limits, judge=judge)
        with opened_at(self.store) as opened:
            (result,) = execute([run], opened, 1, fresh=self.fresh, executor=executor)
        return result


def execute(
    runs: Sequence[Run],
    store: Store | None,
    jobs: int,
    *,
    fresh: bool = False,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> list[Result]:
    """Results of runs, in their order. Each is stored as soon as it is there.

    Args:
        runs: what to run.
        store: where results are looked for and kept; None: nowhere.
        jobs: number of child processes at a time.
        fresh: run what is in the store as well.
        progress: called after each run.
        executor: where runs are made; None: in child processes of this machine.

    Raises:
        InputError: a wall that cannot be built, or a store that is damaged or cannot be written.
    """
    results: dict[int, Result] = {}
    with closing(executed(runs, store, executor or LocalExecutor(jobs), fresh=fresh)) as ended:
        for number, result, stored in ended:
            results[number] = result
            if progress:
                progress(runs[number], result, stored)
    return [results[number] for number in range(len(runs))]


def executed(
    runs: Sequence[Run],
    store: Store | None,
    executor: Executor,
    *,
    fresh: bool = False,
    whole: bool = True,
    refused: list[tuple[int, InputError]] | None = None,
) -> Generator[tuple[int, Result, bool]]:
    """Numbers and results of runs as they end, and whether the result came from the store: those first.

    A run that is planned twice is made once. Closing the generator stops what is under way; what ended is stored.

    Args:
        runs: what to run.
        store: where results are looked for and kept; only this process writes it. None: nowhere.
        executor: where runs are made.
        fresh: run what is in the store as well.
        whole: stored results with forces, mechanism and details, judged anew; False: without, which is quick, with the
            word of the judge that was kept, unless the judge is another now.
        refused: takes the numbers of runs whose wall cannot be built, with the reason; None: the reason is raised.

    Raises:
        InputError: a wall that cannot be built, or a store that is damaged or cannot be written.
    """
    waiting: dict[str, list[int]] = {}
    looked_in = None if fresh else store
    summaries = {} if whole or looked_in is None else looked_in.summaries({run.key for run in runs})
    for number, run in enumerate(runs):
        found = None if looked_in is None else _found(run, looked_in, None if whole else summaries)
        if found is None:
            waiting.setdefault(run.key or f"run {number}", []).append(number)
        else:
            yield number, found, True
    same = list(waiting.values())
    firsts = [runs[numbers[0]] for numbers in same]
    assemblies: dict[int, Assembly] = {}

    def jobs() -> Iterator[Job]:
        for place, run in enumerate(firsts):
            try:
                assemblies[place] = run.case.assembly
            except InputError as error:
                if refused is None:
                    raise
                refused.extend((number, error) for number in same[place])
            else:
                yield Job(place, run.case.id, run.task(assemblies[place]))

    with closing(executor.map(jobs(), {run.method for run in firsts})) as made:
        for place, measured in made:
            run, result = firsts[place], measured.result
            known = {
                "key": run.key,
                "given": [motion.found_by for motion in run.given],
                "judge": _word(run, assemblies.pop(place), result, measured.tolerance),
            }
            result = result.model_copy(update=known)
            if store is not None and run.key:
                store.put(run.key, result, measured.tolerance)
            for number in same[place]:
                yield number, _held(runs[number], result), False


def judged(run: Run, result: Result, tolerance: float) -> Result:
    """A stored result with the judge's word, its comparisons and the doubts about its wall, made anew.

    Args:
        run: it is of; result: as it was stored.
        tolerance: as it was stored, which counts where the method is not installed here.

    Raises:
        InputError: it is of another method, or its arrays are not of the size of its wall.
    """
    result, tolerance = _of_its_method(run, result, tolerance)
    result = _fitting(run, result)
    return _held(run, result.model_copy(update={"judge": _word(run, run.case.assembly, result, tolerance)}))


def _found(run: Run, store: Store, summaries: Mapping[str, dict[str, Any]] | None) -> Result | None:
    """The result of a run that the store has, judged; with summaries one without its fields."""
    if summaries is not None:
        if run.key not in summaries:
            return None
        try:
            result = Result.model_validate(summaries[run.key], strict=False)
        except ValueError as error:
            raise store.damaged(f"the result of {run.method} on {run.case.id} in it", error) from None
        result, tolerance = _of_its_method(run, result, result.judge.tolerance)
        if result.judge.code == judge_version() and result.judge.tolerance == tolerance:
            return _held(run, result.model_copy(update=_widths(result)))
    found = store.get(run.key)
    if found is None:
        return None
    result = judged(run, *found)
    if summaries is not None:  # so that it is quick next time
        store.put(run.key, found[0].model_copy(update={"judge": result.judge}), found[1])
    return result


def _word(run: Run, assembly: Assembly, result: Result, tolerance: float) -> Judgement:
    said = (run.judge or judge)(assembly, result, tolerance)
    code = "" if run.judge else judge_version()  # the word of its own judge counts for this run alone
    return said.model_copy(update={"code": code})


def _held(run: Run, result: Result) -> Result:
    """A judged result as one of its run: compared with its references, with the doubts about its wall."""
    result = result.model_copy(update={"case": run.case.id, "warnings": list(run.case.warnings)})
    comparisons = [compare(reference, result) for reference in run.references]
    return result.model_copy(update={"comparisons": comparisons, "verdict": overall(comparisons)})


def _of_its_method(run: Run, result: Result, tolerance: float) -> tuple[Result, float]:
    """A stored result with what its method says of itself, and the tolerance of that, whatever the store has.

    As stored where the method is not installed here, and where a run came to no answer: its method may not have begun.

    Raises:
        InputError: it is of another method.
    """
    if result.method != run.method:
        raise _not_usable(run, f"it is one of {result.method or 'no method'}")
    if result.status is not Status.OK:
        return result, tolerance
    try:
        method = load_method(run.method)
        settings = validate(method.Settings, dict(run.settings), "settings").model_dump(mode="json")
    except (KeyError, InputError):
        return result, tolerance
    own = {"family": method.family, "traits": method.traits, "settings": settings}
    return result.model_copy(update=own), method.tolerance


def _not_usable(run: Run, problem: str) -> InputError:
    element = f"the stored result of {run.method} on {run.case.id}"
    return InputError(problem, "Repeat the run with --fresh", element)


def _widths(result: Result) -> dict[str, Any]:
    """What of a result follows from its bracket and the traits of its method."""
    return {"bracket_width": measured_width(result), "bracket_wide": bracket_is_wide(result, result.traits)}


_FOLLOWS = ("bracket_width", "bracket_wide", "blocks", "interfaces", "unknowns", "states")
"""What of a result follows from its answer and its wall."""


def _fitting(run: Run, result: Result) -> Result:
    """A stored result held to what any answer for its wall has to be, with what follows from it derived anew.

    Raises:
        InputError: naming the run and what is wrong: a store may have been changed by another hand.
    """
    assembly = run.case.assembly
    blocks, interfaces = assembly.n_blocks, assembly.n_interfaces
    for name, rows in (("forces", interfaces), ("states", interfaces), ("mechanism", blocks)):
        listed = getattr(result, name)
        if listed is not None and len(listed) != rows:
            problem = f"its {name} have {len(listed)} entries and its wall needs {rows}: it was not made for this wall"
            raise _not_usable(run, problem)
    try:
        answer = checked(Answer(**{each.name: getattr(result, each.name) for each in fields(Answer)}), assembly)
    except AnswerFault as error:
        raise _not_usable(run, f"it cannot be used: {error.problem}") from None
    kept = {name: getattr(result, name) for name in ("case", "method", "family", "traits")}
    anew = result_of(answer, assembly, **kept)
    return result.model_copy(update={name: getattr(anew, name) for name in _FOLLOWS})
