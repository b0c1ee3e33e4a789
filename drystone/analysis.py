"""One method on one wall, in this process, judged."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import PrivateAttr

from drystone.walls import Wall, checked_wall
from harness.engine import pipeline
from harness.engine.executors import InProcess, LocalExecutor
from harness.engine.judge import judge as judge_result
from harness.engine.plan import check_methods
from harness.engine.run import Limits, Run
from harness.model.columns import ResultRow
from harness.model.comparison import CaseResults
from harness.model.errors import InputError
from harness.model.method import Answer, Method
from harness.model.method_registry import checked_method, listed_methods, load_method
from harness.model.proof import Proof, proof_of
from harness.model.reading import validate
from harness.model.result import Judgement, result_of
from harness.model.result import Result as Record

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


class Result(Record):
    """What a method found on a wall, with the judge's word. In a notebook it draws itself.

    The fields are those of `drystone run --json`: `multiplier`, `bracket`, `finding`, `status`, `judge`, `forces`, ...
    """

    _wall: Wall = PrivateAttr()
    _of: tuple[CaseResults, Record] | None = PrivateAttr(None)

    @classmethod
    def on(cls, wall: Wall, record: Record, compared: CaseResults | None = None) -> Result:
        """A result together with its wall, and with the others of a comparison that it is one of."""
        made = cls.model_construct(**{name: getattr(record, name) for name in Record.model_fields})
        made._wall, made._of = wall, None if compared is None else (compared, record)
        return made

    @property
    def wall(self) -> Wall:
        """The wall it is about."""
        return self._wall

    @property
    def proof(self) -> Proof:
        """What is proved of its multiplier, by its method and by the certificate of its wall, if one is known.

        >>> import drystone
        >>> str(drystone.analyse(drystone.library_wall("slide")).proof.standing)
        'minimum'
        """
        from drystone.certificates import certified_results

        if self._of is None:
            self._of = certified_results(self._wall.case, self), self
        return proof_of(*self._of)

    @property
    def row(self) -> ResultRow:
        """What the columns of results.csv are functions of."""
        return ResultRow(self, self.proof, self._wall.case.load_in_words)

    def to_pandas(self) -> pd.DataFrame:
        """One row with the columns of results.csv; `attrs["units"]` names the unit of each measured column."""
        from reports.page.export import result_frame

        return result_frame([self.row])

    def forces_to_pandas(self) -> pd.DataFrame:
        """Contact forces: one row an interface with its blocks and n1, n2, s; `attrs["units"]` names the unit."""
        import pandas as pd

        assembly = self._wall.assembly
        ends = zip(assembly.block_a, assembly.block_b, strict=True)
        pairs = [(assembly.block_ids[a], assembly.block_ids[b]) for a, b in ends]
        table = pd.DataFrame(pairs, columns=["block_a", "block_b"])
        table[["n1", "n2", "s"]] = pd.DataFrame(self.forces or [], columns=["n1", "n2", "s"]).reindex(table.index)
        table.attrs["units"] = dict.fromkeys(("n1", "n2", "s"), self._wall.units["force"])
        return table

    def joints_to_pandas(self) -> pd.DataFrame:
        """Margins of every joint, the most critical first, with the columns of joints.csv; `attrs["units"]`: units."""
        from reports.page.export import joint_frame

        return joint_frame(self._wall.case, [self])

    def reactions_to_pandas(self) -> pd.DataFrame:
        """Reactions of the supports on the wall: one row a fixed block with Fx, Fy and moment; `attrs["units"]`."""
        from reports.page.export import reaction_frame

        return reaction_frame(self._wall.case, self)

    def bars_to_pandas(self) -> pd.DataFrame:
        """Forces of the ties and props: one row a bar, tension positive, with its range; `attrs["units"]`: units."""
        from reports.page.export import bar_frame

        return bar_frame(self._wall.case, self)

    def mechanism_to_pandas(self) -> pd.DataFrame:
        """The mechanism: one row a block with ux, uy, omega, scaled so that the fastest vertex has speed 1."""
        import pandas as pd

        table = pd.DataFrame({"block": self._wall.assembly.block_ids})
        names = ["ux", "uy", "omega"]
        table[names] = pd.DataFrame(self.mechanism or [], columns=names).reindex(table.index)
        table.attrs["units"] = {"ux": "1", "uy": "1", "omega": f"1/{self._wall.units['length']}"}
        return table

    def plot(self, kind: str = "mechanism") -> Figure:
        """A figure of the answer.

        Args:
            kind: "mechanism", "forces", "thrust" or "comparison" (mechanism above forces).

        Raises:
            InputError: an unknown kind, or an answer without the field to draw.
        """
        from reports.figures.figures import results_figure

        return results_figure(self._wall.case, [self], kind)

    def _repr_html_(self) -> str:
        from reports.drawing.mechanism_drawing import mechanism_drawing
        from reports.drawing.svg import html

        drawn = mechanism_drawing(self._wall.case, self) if self.mechanism is not None else None
        return html(f"{self._wall.name}, {self.method}: {self.sentence} ({self.judge.outcome})", drawn)


def methods() -> list[str]:
    """Names of all installed methods.

    >>> "la" in methods() and "fe" in methods() and "de" in methods()
    True
    """
    return listed_methods()


def analyse(
    wall: Wall,
    method: str | Method = "la",
    *,
    isolated: bool = False,
    seconds: float = Limits().seconds,
    memory_bytes: int = Limits().memory_bytes,
    processes: int = 1,
    store: str | Path | None = None,
    **settings: Any,
) -> Result:
    """What a method finds on a wall, judged; in this process and without limits unless it is isolated.

    Args:
        wall: the wall.
        method: its name; `methods()` lists them. Or a method of your own, as an object.
        isolated: in a process of its own, so that a method that hangs or crashes gives a result that says so.
        seconds: wall-clock limit of an isolated run [s].
        memory_bytes: memory limit of an isolated run [bytes].
        processes: that the run may use side by side, where the method can (`de`); the answer is the same.
        store: file in which the result is kept and looked for; None: nowhere. An isolated run is found there by
            `compare`, `check` and `sweep` under the same limits, and theirs by it.
        settings: of the method, by name; what is not given has its default.

    Raises:
        InputError: an unknown method or setting, a wall that the method refuses (isolated: the result says so), or one
            of your own is to be isolated or kept.
    """
    limits = Limits(seconds, memory_bytes)
    return analyse_by(wall, method, settings, isolated=isolated, limits=limits, processes=processes, store=store)


def analyse_by(
    wall: Wall,
    method: str | Method,
    settings: dict[str, Any],
    *,
    isolated: bool,
    limits: Limits,
    processes: int = 1,
    store: str | Path | None = None,
    fresh: bool = False,
) -> Result:
    """As `analyse`, with settings that may have any name, `seconds` among them.

    Args:
        wall, method, settings, isolated, limits, processes, store: see `analyse`.
        fresh: run what is in the store as well.

    Raises:
        InputError: as `analyse`.
    """
    wall = checked_wall(wall)
    if isinstance(method, str):
        check_methods([method], "method")
        loaded = load_method(method)
    elif isolated:
        raise InputError("an isolated method is called by its name", "Give it an entry point, or run it here", "method")
    elif store is not None:
        raise InputError("a method that is not installed keeps no results", "Give it an entry point", "store")
    else:
        loaded = checked_method(method)
    _check_shares(loaded, processes)
    validate(loaded.Settings, settings, "settings")
    run = Run(
        wall.case,
        loaded.name,
        settings,
        limits if isolated else None,
        tuple(
            item for item in wall.case.file.references if loaded.name in item.applies_to and item.settings == settings
        ),
        processes=processes,
        kept=isinstance(method, str),
    )
    executor = LocalExecutor(1) if isolated else InProcess(loaded)
    with pipeline.opened_at(store) as opened:
        (record,) = pipeline.execute([run], opened, 1, fresh=fresh, executor=executor)
    return Result.on(wall, record)


def judge(wall: Wall, answer: Answer | Record, tolerance: float = 1e-9) -> Judgement:
    """Check an answer from anywhere for equilibrium, yield, flow and virtual work, by code that no method shares.

    >>> from drystone import new_wall
    >>> wall = new_wall("stack", count=1, friction=0.3)
    >>> judge(wall, analyse(wall, "la-associated")).accepted
    True

    Args:
        wall: the wall the answer is about.
        answer: forces (m, 3) and a mechanism (n, 3) in the conventions and the order of `Assembly`; or a result.
        tolerance: the largest relative residual that is accepted.
    """
    wall = checked_wall(wall)
    if isinstance(answer, Answer):
        answer = result_of(answer, wall.assembly, case=wall.name, method="foreign", family="foreign")
    return judge_result(wall.assembly, answer, tolerance)


def _check_shares(method: Method, processes: int) -> None:
    """Refuse more than one process for a method that makes its runs in one.

    Raises:
        InputError: that is so.
    """
    if processes > 1 and not method.shares_work:
        raise InputError(
            f"{method.name} makes a run in one process: its parts begin with what those before them found",
            "Leave it out; several runs go side by side in `drystone compare` and `drystone sweep`",
            "--jobs",
        )
