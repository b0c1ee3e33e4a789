"""A wall becomes its assembly: polygons checked, interfaces found or taken, friction and loads assigned."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import Bars
from harness.model.blocks import blocks_of_wall
from harness.model.errors import MOST_NAMED, InputError, first_few, raise_faults
from harness.model.friction_rules import JointLaws, laws_of_joints
from harness.model.input_checks import input_warnings, thickness_of
from harness.model.laid import Laid, lay
from harness.model.load_fields import Load, Loads
from harness.model.loads import check_pairs, dead_load, fill_as_bars, generalised_load, with_pressures
from harness.model.names import faults_of_wall, names_of_bars
from harness.model.plausibility import contact_warnings, force_warnings, interface_warnings, near_misses
from harness.model.wall import Block, Inset, Interface, Wall

_MOST_MOVED = 1_000_000
"""Pairs of a settlement and a support that it moves, a second of work."""
_SMALLEST = float(np.finfo(float).tiny / np.finfo(float).eps)
"""Least sum of loads, whatever its unit: a share of it as small as rounding still has all its digits."""


@dataclass(frozen=True)
class Built:
    """An assembly with what a person should hear about it.

    Attributes:
        assembly: the numeric view of the wall.
        warnings: the doubts of the wall, and sentences about contacts at corners, very short interfaces, and points
            that lie off their block.
        explicit: makes the explicit form.
        thickness: makes the thickness of the joints.
    """

    assembly: Assembly
    warnings: tuple[str, ...]
    explicit: Callable[[], Wall]
    thickness: Callable[[], FloatArray]

    @cached_property
    def wall(self) -> Wall:
        """The explicit form, with every block and interface written out; made when it is first asked for."""
        return self.explicit()

    @cached_property
    def joint_thickness(self) -> FloatArray:
        """(m,) thickness of the interfaces out of plane [length], that of the thinner block; made when asked for."""
        return self.thickness()


def build(wall: Wall, name: str = "wall", laid: Laid | None = None) -> Built:
    """The assembly of a wall.

    Args:
        wall: as described; name: what it is called.
        laid: its blocks and joints, where they were laid for other loads already.

    Raises:
        InputError: naming the block, interface or load that is wrong; or it has load cases, each a wall of its own.
    """
    if named := wall.load_case_fields:
        raise InputError(
            f"it has the load cases of {first_few(named, MOST_NAMED)}, each a wall of its own",
            "Choose one: --load-case NAME of `drystone run` or `compare`; other commands take the file that "
            "`drystone expand WALL.json --load-case NAME` prints",
            wall.load_cases_place,
        )
    if laid is None:
        blocks = blocks_of_wall(wall)
    else:
        blocks = laid.blocks
        raise_faults(faults_of_wall(wall, blocks))
    for load in (wall.loads.dead, wall.loads.live or Load()):
        check_pairs(load, blocks)
    laid = lay(wall, blocks) if laid is None else laid
    names, index, fixed, size = tuple(laid.index), laid.index, laid.fixed, laid.size
    weight, centroids, face1, face2 = laid.weight, laid.centroids, laid.face1, laid.face2
    interfaces = laid.joints.interfaces
    across, up = np.abs((face2 - face1) @ _level_and_upright(wall.loads).T).T
    inclined = np.where(across >= up, "bed", "head").tolist()
    joints = tuple(interface.joint or name for interface, name in zip(interfaces, inclined, strict=True))
    laws = laws_of_joints(wall, interfaces, joints, blocks, index)
    end1, end2 = _set_in(interfaces, wall.contact_inset, face1, face2)
    assembly = Assembly(
        name=name,
        block_ids=names,
        polygons=laid.polygons,
        centroid=centroids,
        weight=weight,
        fixed=fixed,
        block_a=laid.block_a,
        block_b=laid.block_b,
        end1=end1,
        end2=end2,
        face1=face1,
        face2=face2,
        normal=laid.normal,
        friction=laws.friction,
        dilatancy=laws.dilatancy,
        joint=joints,
        dead=dead_load(wall.loads, laid),
        live=generalised_load(wall.loads.live or Load(), laid),
    )
    if _has_pressures(wall.loads):
        assembly = with_pressures(wall, laid, assembly)
    if wall.settlements:
        assembly = replace(assembly, support_motion=_support_motion(wall, laid))
    resisting = [number for number, fill in enumerate(wall.loads.dead.fills) if fill.passive is not None]
    if wall.ties or wall.props or resisting:
        bars = _bars(wall, index)
        for number in resisting:
            bars = bars.followed_by(fill_as_bars(wall, laid, assembly.support_motion, number))
        given = len(wall.ties) + len(wall.props)
        if shared := set(bars.names[:given]).intersection(bars.names[given:]):
            problem = f'a tie or prop is called "{min(shared)}", as is a bar of passive fill'
            raise InputError(problem, "Give every bar an id of its own", "wall")
        prestress = np.where(fixed[:, None], 0.0, bars.generalised(bars.prestress, centroids))
        assembly = replace(assembly, bars=bars, dead=assembly.dead + prestress)
    if laws.strong:
        faces = np.linalg.norm(assembly.face2 - assembly.face1, axis=1)
        area = np.asarray(faces * _joint_thickness(wall, blocks, assembly))
        assembly = replace(assembly, constant=laws.constant(area), crushing=laws.crushing(area), brittle=laws.brittle)
    if wall.loads.live is not None and not assembly.has_live_load:
        raise InputError(
            "the live load puts no force on any free block",
            "Load a block, or leave loads.live out to ask only whether the wall stands",
            "loads.live",
        )
    _check_sizes(assembly)
    warnings = [
        *wall.doubts,
        *contact_warnings(assembly, laid.joints.corners, size),
        *near_misses(names, laid.joints.missed, laid.joints.missed_gap, laid.joints.gap),
        *force_warnings(assembly, wall.loads, size),
        *input_warnings(wall, blocks, assembly, laws.given),
    ]
    if laid.joints.trusted < len(interfaces):
        warnings += interface_warnings(assembly, size, laid.joints.trusted)
    explicit = partial(_explicit, wall, blocks, weight, interfaces, joints, laws)
    return Built(assembly, tuple(warnings), explicit, partial(_joint_thickness, wall, blocks, assembly))


_MOST_CRUSHING = 1e5
"""Crushing force of a joint, in dead loads, above which the pressed strip is thinner than a hundred-thousandth of it.

A multiplier changes by that share, and the rates at which such a joint closes are lost to rounding."""


def _check_sizes(assembly: Assembly) -> None:
    """Every load, and every multiplier of about the dead over the live load, is a number that keeps its digits.

    Raises:
        InputError: one is so large or so small that its products or its parts leave the range of numbers.
    """

    def check(element: str, what: str, size: float) -> None:
        if not _SMALLEST <= size <= 1.0 / _SMALLEST:
            wrong = "small" if size < 1.0 else "large"
            raise InputError(f"{what} too {wrong} to compute with", "Check the units", element)

    check("loads", "its loads are", assembly.force_scale)
    if assembly.has_live_load:
        check("loads.live", "beside the dead load it is", 1.0 / assembly.load_unit)
        check("loads.live", "it is", assembly.force_scale / assembly.load_unit)
    if assembly.constant.max(initial=0.0) > 1e9 * assembly.force_scale:
        joint = int(assembly.constant.max(axis=1).argmax())
        between = f"{assembly.block_ids[assembly.block_a[joint]]} and {assembly.block_ids[assembly.block_b[joint]]}"
        raise InputError(
            "its strength is more than a thousand million times the dead load: too large to compute with",
            "Check the units: cohesion and tensile strength are in force/length^2 of the file",
            f"interface between {between}",
        )
    crushing = np.where(np.isfinite(assembly.crushing), assembly.crushing, 0.0)
    if crushing.max(initial=0.0) > _MOST_CRUSHING * assembly.force_scale:
        joint = int(crushing.argmax())
        between = f"{assembly.block_ids[assembly.block_a[joint]]} and {assembly.block_ids[assembly.block_b[joint]]}"
        raise InputError(
            f"it crushes under more than {_MOST_CRUSHING:g} times the dead load, which changes no digit of an answer",
            "Check the units: compressive strength is in force/length^2 of the file; or leave it out",
            f"interface between {between}",
        )


def _level_and_upright(loads: Loads) -> FloatArray:
    """Unit vectors (2, 2) across gravity and along it, by which a joint is a bed or a head joint."""
    x, y = loads.gravity_per_weight
    size = math.hypot(x, y)
    x, y = (x / size, y / size) if size > 0.0 else (0.0, -1.0)
    return np.array([[-y, x], [x, y]])


def _support_motion(wall: Wall, laid: Laid) -> FloatArray:
    """(n, 3) motions of the supports, those of several settlements of a block added up, as a direction.

    The greatest translation of a settlement becomes one length; where none is given, the greatest rotation one radian.
    So the work on the motion, the reaction along it, is a force, or of rotations alone a moment.

    Raises:
        InputError: a settlement names a block that is not fixed, or a group that there is not.
    """
    motion, moved = np.zeros((len(laid.blocks), 3)), 0
    for number, settlement in enumerate(wall.settlements):
        place = f"settlements[{number}]"
        chosen = laid.named(settlement)
        if chosen is None or not len(chosen):
            raise InputError(f'no block is in a group "{settlement.group}"', "Name a group of fixed blocks", place)
        moved += len(chosen)
        if moved > _MOST_MOVED:
            problem = f"it and those before it move more than {_MOST_MOVED:,} supports in all"
            raise InputError(problem, "Add up those of the same supports", place)
        if not laid.fixed[chosen].all():
            name = laid.blocks[int(chosen[np.argmin(laid.fixed[chosen])])].id
            raise InputError(f'block "{name}" is not fixed', "Name supports: only they have a prescribed motion", place)
        middle = laid.centroids[chosen]
        x, y = (middle - (middle if settlement.about is None else settlement.about)).T
        turn = settlement.rotation
        motion[chosen] += np.stack(
            [settlement.translation[0] - turn * y, settlement.translation[1] + turn * x, np.full(len(x), turn)], axis=1
        )
    longest = max(math.hypot(*settlement.translation) for settlement in wall.settlements)
    return motion / (longest or max(abs(settlement.rotation) for settlement in wall.settlements))


def _bars(wall: Wall, index: dict[str, int]) -> Bars:
    """Ties and then props as arrays; tension is positive."""
    given = [("tie", 1.0, tie) for tie in wall.ties] + [("prop", -1.0, prop) for prop in wall.props]
    kinds = tuple(kind for kind, _, _ in given)
    prestress = np.array([sign * bar.prestress for _, sign, bar in given])
    further = np.array([sign * bar.yield_force for _, sign, bar in given]) - prestress
    return Bars(
        names=tuple(names_of_bars(wall)),
        kinds=kinds,
        block_a=np.array([index[bar.start.block] for _, _, bar in given], dtype=np.int64),
        block_b=np.array([index[bar.end.block] for _, _, bar in given], dtype=np.int64),
        end1=np.array([bar.start.at for _, _, bar in given], dtype=float).reshape(-1, 2),
        end2=np.array([bar.end.at for _, _, bar in given], dtype=float).reshape(-1, 2),
        prestress=prestress,
        least=np.minimum(further, 0.0),
        greatest=np.maximum(further, 0.0),
        stiffness=np.array([np.nan if bar.stiffness is None else bar.stiffness for _, _, bar in given]),
    )


def _joint_thickness(wall: Wall, blocks: list[Block], assembly: Assembly) -> FloatArray:
    """(m,) thickness of the interfaces, that of the thinner block [length].

    A support that gives no thickness is as thick as what stands on it.
    """
    thickness = np.array([thickness_of(block, wall) for block in blocks])
    given = np.array([block.thickness is not None for block in blocks])
    thickness[assembly.fixed & ~given] = np.inf
    return np.asarray(np.minimum(thickness[assembly.block_a], thickness[assembly.block_b]))


def _set_in(
    interfaces: list[Interface], general: Inset | None, face1: FloatArray, face2: FloatArray
) -> tuple[FloatArray, FloatArray]:
    length = np.linalg.norm(face2 - face1, axis=1)
    depth = np.zeros(len(interfaces))
    for number, interface in enumerate(interfaces):
        inset = interface.inset or general
        if inset is None:
            continue
        depth[number] = inset.length if inset.length is not None else (inset.fraction or 0.0) * length[number]
        if depth[number] >= 0.5 * length[number]:
            raise InputError(
                f"contact points set in by {depth[number]:.6g} at both ends leave nothing of its {length[number]:.6g}",
                "Give an inset below half of the shortest interface",
                f"interface between {' and '.join(interface.between)}",
            )
    step = (depth / length)[:, None] * (face2 - face1) if len(interfaces) else face1
    return face1 + step, face2 - step


def _explicit(
    wall: Wall,
    blocks: list[Block],
    weight: FloatArray,
    interfaces: list[Interface],
    joints: tuple[str, ...],
    laws: JointLaws,
) -> Wall:
    return wall.model_copy(
        update={
            "pattern": None,
            "blocks": [
                block.model_copy(update={"weight": float(w), "unit_weight": None})
                for block, w in zip(blocks, weight, strict=True)
            ],
            "interfaces": [
                interface.model_copy(
                    update={
                        "joint": joint,
                        "friction": mu,
                        "friction_angle": None,
                        "dilatancy": psi or None,
                        "cohesion": cohesion or None,
                        "tensile_strength": tension or None,
                        "compressive_strength": crushing if math.isfinite(crushing) else None,
                        "after": "residual" if brittle and (cohesion or tension) else None,
                    }
                )
                for interface, joint, (mu, psi, cohesion, tension, crushing, brittle) in zip(
                    interfaces, joints, laws.given.tolist(), strict=True
                )
            ],
        }
    )


def _has_pressures(loads: Loads) -> bool:
    """Whether any load presses on faces."""
    return any(load.pressures or load.fills for load in (loads.dead, loads.live or Load()))
