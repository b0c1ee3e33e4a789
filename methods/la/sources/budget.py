"""What a search may spend, and what it has spent: one budget, from which all its sources draw.

Work is counted in linear programmes, Newton steps times blocks, and breakpoints of paths of springs, never in seconds:
a seed gives the same answer on every machine of the same arithmetic. The size of a wall decides how much there is of
it, and nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from methods.la.core.problem import Problem
from methods.la.settings import SearchSettings


@dataclass(frozen=True)
class SearchLimits:
    """How much is tried.

    Attributes:
        starts: central paths of the wall with blocks of other weights that may lead to nothing lower in a row.
        failures, draws: draws without a lower value that end a descent, and draws of one at most.
        descents: lowest states of each source, and of each step of the friction continuation, that are descended from.
        continuation: factors on friction of the steps of the friction continuation.
        nodes: of the tree that may prove the least state.
        certificates: programmes that may bound an unfinished tree as a whole, to rounding.
        leaves: of such a tree that are bounded where the whole takes more.
        programmes: linear ones in all, those of the proof among them.
        block_steps: Newton steps times blocks after which no further path is begun once a state is known.
        breakpoints: on all paths of springs after which no further one is begun; twice as many while no state is known.
        unbounded_breakpoints: instead of those where statics allows any live load.
    """

    starts: int = 0
    failures: int = 12
    draws: int = 200
    descents: int = 1
    continuation: tuple[float, ...] = ()
    nodes: int = 0
    certificates: int = 300
    leaves: int = 100
    programmes: int = 50_000
    block_steps: float = 1e6
    breakpoints: int = 9_000
    unbounded_breakpoints: int = 9_000


@dataclass(frozen=True)
class Sizes:
    """The sizes at which the budget of normal effort changes, so that the time grows slowly, and what it is there.

    Attributes:
        few_blocks, some_blocks: up to the first all steps of the friction continuation, up to the next half of
            them, three descents a source on both; above, no steps of it but those of rough joints, and one longer
            descent.
        descended: interfaces up to which states are descended from; above, a draw takes a second and more.
        provable, provable_ring: interfaces up to which a proof is tried, and those of walls with at most two more
            interfaces than blocks. With more, hardly any tree finishes within its nodes.
        starts, blocks_started: with other weights, and those times the blocks of the wall, at most; a sixth of them
            for the quick effort.
        continuation, fine_continuation: factors on friction: mechanisms found at each are carried on. The fine one
            first goes down from above the friction of the wall.
    """

    few_blocks: int = 30
    some_blocks: int = 60
    descended: int = 1000
    provable: int = 16
    provable_ring: int = 30
    starts: int = 144
    blocks_started: int = 4500
    continuation: tuple[float, ...] = (0.55, 0.65, 0.75, 0.85, 0.925)
    fine_continuation: tuple[float, ...] = (
        *(1.3, 1.15, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5),
        *(0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95),
    )

    def limits(self, effort: str, problem: Problem) -> SearchLimits:
        """The limits of an effort ("quick", "normal" or "deep") on a wall."""
        blocks, interfaces = problem.assembly.n_free, problem.n_interfaces
        most = self.provable_ring if interfaces <= blocks + 2 else self.provable
        nodes = 1500 if interfaces <= most else 0
        descents = int(interfaces <= self.descended)
        starts = min(self.starts, self.blocks_started // max(blocks, 1))
        if effort == "quick":
            few = min(nodes, 100)
            return SearchLimits(starts // 6, 8, 200, descents, nodes=few, breakpoints=300, unbounded_breakpoints=300)
        if effort == "deep":
            nodes = 20000 if interfaces <= 2 * most else 0
            work = 2 * self.starts, 40, 200, 8, self.fine_continuation, nodes, 3 * nodes, nodes
            return SearchLimits(*work, 1_000_000, 1e7, 100_000, 100_000)
        if blocks <= self.few_blocks:
            return SearchLimits(starts, 12, 200, 3, self.continuation, nodes)
        if blocks <= self.some_blocks:
            return SearchLimits(starts, 12, 200, 3, self.continuation[::2], nodes)
        if descents:
            return SearchLimits(starts, 40, breakpoints=20_000, unbounded_breakpoints=20_000)
        return SearchLimits(0, 40, descents=0, breakpoints=60_000, unbounded_breakpoints=1)


def rounds_of(settings: SearchSettings, problem: Problem) -> tuple[SearchLimits, ...]:
    """The limits that the settings ask for, of one round of the search after the other.

    What they leave open depends on the size of the wall. Whoever asks for draws, starts or factors has them descended
    from at any size. The first round of `deep` is a normal search, so that it never ends above one.
    """
    names = ("starts", "failures", "continuation")
    asked = {name: value for name in names if (value := getattr(settings, name)) is not None}
    rounds = []
    for effort in ("normal", "deep") if settings.effort == "deep" else (settings.effort,):
        limits = Sizes().limits(effort, problem)
        rounds.append(replace(limits, descents=max(limits.descents, 1), **asked) if asked else limits)
    return tuple(rounds)


@dataclass
class Work:
    """Work that was done: programmes, Newton steps, the same times blocks, breakpoints."""

    programmes: int = 0
    newton_steps: int = 0
    block_steps: float = 0.0
    breakpoints: int = 0

    def since(self, before: Work) -> Work:
        """What was done after `before`."""
        return Work(
            self.programmes - before.programmes,
            self.newton_steps - before.newton_steps,
            self.block_steps - before.block_steps,
            self.breakpoints - before.breakpoints,
        )


@dataclass
class Budget:
    """The limits of a search, and what it and those of other friction that serve it have spent."""

    limits: SearchLimits = field(default_factory=SearchLimits)
    spent: Work = field(default_factory=Work)

    def stepped(self, steps: int, blocks: int) -> None:
        """Count Newton steps of a matrix of so many blocks."""
        self.spent.newton_steps += steps
        self.spent.block_steps += steps * blocks

    @property
    def programmes(self) -> int:
        """Programmes left."""
        return max(self.limits.programmes - self.spent.programmes, 0)

    def steps_left(self, known: bool) -> bool:
        """Whether a further path of Newton steps may begin; `known` says whether a state is known."""
        return not known or self.spent.block_steps < self.limits.block_steps

    def breakpoints_left(self, known: bool) -> bool:
        """Whether a further path of springs may begin; `known` says whether a state is known."""
        return self.spent.breakpoints < self.limits.breakpoints * (1 if known else 2)
