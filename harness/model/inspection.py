"""Everything that is wrong or doubtful about a wall at once, each with its place, its size and what would mend it.

Building stops at the first stage that cannot go on; a person who mends a drawing wants the whole list, and to see it.
So the stages are gone through here one by one, each with what the faults of the others leave.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.blocks import polygons_of, support_faults, weight_of, written_out
from harness.model.build import Built, build
from harness.model.contacts import check_gap
from harness.model.errors import MOST_WORDED, InputError, Spot, first_few, sorted_out, uncounted
from harness.model.input_checks import unknown_in_rules
from harness.model.interfaces import Joints, faults_of_given, floating, floating_groups, joints_of, limits_of
from harness.model.laid import lay
from harness.model.load_cases import each_built, named_loads, under_load_case
from harness.model.names import faults_of_wall
from harness.model.plausibility import NEAR_MISS, allowing, saying, span
from harness.model.wall import Block, Detection, Interface, Wall


@dataclass(frozen=True)
class FaultMark:
    """Something wrong or doubtful.

    Attributes:
        kind: "fault", and the wall cannot be built, or "doubt", and it may not be the one that was meant.
        element: the block, interface, load or field; empty where it is none.
        problem, remedy: what is wrong, and what would mend it.
        blocks: names of the blocks concerned.
        at: where (x, y) [length]; None where it is not in the plane.
        size: depth of an overlap, width of a gap [length]; None where it has none.
    """

    kind: str
    element: str
    problem: str
    remedy: str = ""
    blocks: tuple[str, ...] = ()
    at: tuple[float, float] | None = None
    size: float | None = None

    @property
    def near_miss(self) -> bool:
        """Whether it is a pair of faces that face each other and have no joint."""
        return self.kind == "doubt" and self.size is not None

    def __str__(self) -> str:
        return str(InputError(self.problem, self.remedy, self.element, spot=Spot(self.blocks, self.at)))


@dataclass(frozen=True, eq=False)
class Inspection:
    """A wall looked over.

    Attributes:
        wall: as it was read.
        names, outlines (k, 2), fixed: of its blocks; an outline that is no polygon is as drawn [length].
        marks: faults first, in the order in which they are found.
        built: the wall, where nothing keeps it from being built.
        load_case: under which it is built; empty where it has none.
    """

    wall: Wall
    names: tuple[str, ...]
    outlines: tuple[FloatArray, ...]
    fixed: BoolArray
    marks: tuple[FaultMark, ...]
    built: Built | None
    load_case: str = ""

    @property
    def faults(self) -> tuple[FaultMark, ...]:
        """What keeps the wall from being built."""
        return tuple(mark for mark in self.marks if mark.kind == "fault")

    def sentences(self, advice: float | None = None) -> list[str]:
        """The marks with their numbers, the near misses, which may be hundreds, in one sentence with one tolerance.

        Args:
            advice: a tolerance that is likely to be right [length]; that which joins all of them if None, or if it
                joins none.
        """
        near = [(number, mark.size) for number, mark in enumerate(self.marks, start=1) if mark.near_miss and mark.size]
        lines = [
            f"{number}. {mark.kind}: {mark}" for number, mark in enumerate(self.marks, start=1) if not mark.near_miss
        ]
        if not near:
            return lines
        gaps = np.array([size for _, size in near])
        joined = 0 if advice is None else int((gaps <= advice).sum())
        remedy = allowing(gaps.max())
        if advice is not None and joined:
            remedy = f"{saying(advice)}, which joins {'all' if joined == len(gaps) else joined} of them"
        lines.append(
            f"{near[0][0]} to {near[-1][0]}. doubt: {len(near)} pair(s) of faces {NEAR_MISS} {span(gaps)} apart, or "
            f"overlap by as much, and have no joint; if they are in contact, write {remedy}"
        )
        return lines


def inspect(
    wall: Wall, name: str = "wall", before: Sequence[InputError] = (), load_case: str | None = None
) -> Inspection:
    """A wall looked over.

    Args:
        wall: as read; name: what it is called; before: faults for which parts of the file are already left out of it.
        load_case: under which it is built; None: the first, if it has any.

    Raises:
        InputError: it has no blocks, or too many, or it can be built and has no such load case.
    """
    blocks = written_out(wall)
    apart = _with_own_names(blocks)
    fixed = np.array([block.fixed for block in blocks], dtype=bool)
    bad, polygons = _outlines(blocks)
    faults = [*faults_of_wall(wall, blocks), *bad, *sorted_out(lambda block: weight_of(block, wall), blocks)[0]]
    faults += support_faults(fixed)
    doubts: list[FaultMark] = []
    joints: Joints | None = None
    if polygons:
        kept = [apart[k] for k in polygons]
        found, doubts, joints = _lying(wall, kept, list(polygons.values()), _hulls(blocks, polygons))
        faults += found
    built: Built | None = None
    drawn, warnings = "", [*wall.doubts]
    if not faults and not before:
        try:
            drawn, built, warnings = _built(wall, name, blocks, joints, load_case)
        except InputError as error:
            faults += error.faults
    if built is not None and load_case is not None and load_case != drawn:
        under_load_case(wall, load_case)  # says which there are
    marks = [*(_marked(fault, "fault") for fault in (*before, *faults)), *doubts]
    # Near misses are in the list one by one, so the sentence that sums them up would be a repetition.
    if built is None:
        warnings += unknown_in_rules(wall, blocks)
    marks += [FaultMark("doubt", "", text) for text in warnings if NEAR_MISS not in text]
    middle = {block.id: np.mean(np.array(block.polygon), axis=0) for block in apart}
    names = tuple(block.id for block in apart)
    outlines = tuple(polygons.get(k, np.array(block.polygon, dtype=float)) for k, block in enumerate(blocks))
    placed = tuple(_placed(mark, middle) for mark in _once(marks))
    return Inspection(wall, names, outlines, fixed, placed, built, drawn)


def _built(
    wall: Wall, name: str, blocks: list[Block], joints: Joints | None, wanted: str | None
) -> tuple[str, Built, list[str]]:
    """The wall under the load case that is wanted or else the first, with its name, and the warnings of all of them.

    A wall without load cases is built as it is, and the name is empty.

    Its blocks have no faults, and the joints between them are known, unless no two blocks can have one.
    """
    known, chosen = named_loads(wall), None
    laid = lay(wall, blocks, joints)
    concerned: dict[str, list[str]] = {}
    for load_case, _, built in each_built(wall, dict.fromkeys(known, name), known, laid) if known else ():
        if chosen is None or load_case == wanted:
            chosen = load_case, built
        for sentence in built.warnings:
            concerned.setdefault(sentence, []).append(load_case)
    if chosen is None:
        alone = build(wall, name, laid)
        return "", alone, list(alone.warnings)
    return *chosen, [
        sentence if len(names) == len(known) else f"load case {first_few(names, 5)}: {sentence}"
        for sentence, names in concerned.items()
    ]


def _outlines(blocks: Sequence[Block]) -> tuple[list[InputError], dict[int, FloatArray]]:
    """The faults of outlines that are no polygons, and the others by their numbers: all at once where all are sound."""
    try:
        return [], dict(enumerate(polygons_of(blocks)))
    except InputError:
        return sorted_out(_outline, blocks)


def _outline(block: Block) -> FloatArray:
    try:
        return polygons_of([block])[0]
    except InputError as error:
        error.spot = Spot((block.id,))
        raise


def _with_own_names(blocks: Sequence[Block]) -> list[Block]:
    """The blocks, a second one of a name with its number behind it."""
    seen: Counter[str] = Counter()
    apart = []
    for block in blocks:
        seen[block.id] += 1
        again = {"id": f"{block.id} ({seen[block.id]})"}
        apart.append(block.model_copy(update=again) if seen[block.id] > 1 else block)
    return apart


def _hulls(blocks: Sequence[Block], polygons: dict[int, FloatArray]) -> list[shapely.Geometry]:
    """Convex hulls of the blocks whose outlines are no polygons: what bears on them is not to be called floating."""
    return [shapely.MultiPoint(block.polygon).convex_hull for k, block in enumerate(blocks) if k not in polygons]


def _lying(
    wall: Wall, blocks: Sequence[Block], polygons: Sequence[FloatArray], hulls: Sequence[shapely.Geometry]
) -> tuple[list[InputError], list[FaultMark], Joints | None]:
    """What is wrong and doubtful about where blocks of sound outlines lie, and their joints where they were found."""
    names = [block.id for block in blocks]
    fixed = np.array([block.fixed for block in blocks], dtype=bool)
    if fixed.all() or not fixed.any():
        return [], [], None
    asked = wall.interfaces
    shapes = geometry.shapes_of(polygons)
    size = geometry.typical_size(shapes[~fixed])
    limits = limits_of(Detection() if isinstance(asked, list) else asked, size)
    faults: list[InputError] = []
    try:
        overlapping, shared = geometry.overlapping(shapes, fixed, limits.overlap)
        faults += geometry.overlap_faults(shapes, names, overlapping, shared)
        joints = Joints(asked) if isinstance(asked, list) else joints_of(asked, polygons, names, fixed, limits)
    except InputError as error:  # there is more than can be looked at
        return [*faults, *error.faults], [], None
    if isinstance(asked, Detection):
        try:
            check_gap(shapes, names, limits.gap)
        except InputError as error:
            faults.append(error)
    index = {name: k for k, name in enumerate(names)}
    known = [item for item in joints.interfaces if set(item.between) <= index.keys()]
    faults += faults_of_given(joints, index, fixed)
    # Blocks that overlap are in contact once that is mended.
    pairs = np.concatenate([_joined(known, index), overlapping])
    held = fixed | _beside(polygons, hulls, limits.sight)
    groups = floating_groups(held, pairs)
    faults += [floating(names, group, joints) for group in groups[:MOST_WORDED]]
    if len(groups) > MOST_WORDED:
        faults.append(uncounted(len(groups) - MOST_WORDED, "groups of blocks float", "blocks"))
    said = {fault.spot.blocks for fault in faults if fault.spot is not None}
    return faults, [mark for mark in _missed(names, joints) if mark.blocks not in said], joints


def _joined(interfaces: Iterable[Interface], index: dict[str, int]) -> IntArray:
    """Pairs (k, 2) of blocks with an interface."""
    return np.array([[index[name] for name in item.between] for item in interfaces], dtype=np.int64).reshape(-1, 2)


def _beside(polygons: Sequence[FloatArray], hulls: Sequence[shapely.Geometry], sight: float) -> BoolArray:
    """Which blocks (n,) lie within sight of one of the hulls."""
    near = np.zeros(len(polygons), dtype=bool)
    if hulls:
        near[shapely.STRtree(geometry.shapes_of(polygons)).query(hulls, predicate="dwithin", distance=sight)[1]] = True
    return near


def _missed(names: Sequence[str], joints: Joints) -> list[FaultMark]:
    """The near misses one by one, the nearest first."""
    marks = []
    for k in np.argsort(joints.missed_gap, kind="stable").tolist():
        pair, gap = tuple(names[i] for i in joints.missed[k].tolist()), float(joints.missed_gap[k])
        at = (float(joints.missed_at[k, 0]), float(joints.missed_at[k, 1]))
        marks.append(
            FaultMark(
                "doubt",
                f'blocks "{pair[0]}" and "{pair[1]}"',
                f"faces {NEAR_MISS} {gap:.3g} apart, or overlap by as much, and have no joint, because "
                f"joints are up to {joints.gap:.3g} wide",
                f"If they are in contact, write {allowing(gap)}",
                pair,
                at,
                gap,
            )
        )
    return marks


def _marked(error: InputError, kind: str) -> FaultMark:
    spot = error.spot or Spot(())
    return FaultMark(kind, error.element, error.problem, error.remedy, spot.blocks, spot.at, spot.size)


def _once(marks: Sequence[FaultMark]) -> list[FaultMark]:
    """The marks without repetitions: a wrong name shows in the file, and again in what is left of it."""
    first: dict[tuple[object, ...], FaultMark] = {}
    for mark in marks:
        first.setdefault((mark.problem, mark.blocks, mark.at) if mark.blocks else (mark.problem, mark.element), mark)
    return list(first.values())


def _placed(mark: FaultMark, middle: dict[str, FloatArray]) -> FaultMark:
    """The mark at the middle of its blocks where nothing says a closer place."""
    there = [middle[name] for name in mark.blocks if name in middle]
    if mark.at is not None or not there:
        return mark
    x, y = np.mean(there, axis=0).tolist()
    return replace(mark, at=(x, y))
