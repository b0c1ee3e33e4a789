"""The path of a wall with brittle joints: from strength to strength, each joint that reaches its own loses it.

Where a joint reaches its strength the multiplier is held, the joint turns into a dry one and the force it releases goes
over to the others (`methods.springs.model.breaking`). All that reach theirs at once, or by this, break together. If
equilibrium is found the path goes on; if not, this multiplier is the greatest reached, and the wall collapses there.
The motion from one equilibrium to the next is slow: what a sudden break adds in motion is left out.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.bars import with_bar_forces, with_bars_as_joints
from harness.model.components import analysed_apart, joints_of
from harness.model.deadline import STOPPED, best_so_far
from harness.model.errors import first_few
from harness.model.method import Answer, Finding, Status
from methods.fe.answers import compact, gravity_failure, single_state_answer, stands
from methods.fe.histories import SENTENCES, HistoryTuning
from methods.fe.settings import GapSpringsSettings
from methods.numerics.claims import at_limit, with_proof
from methods.numerics.statics import admissible_forces, dilatant_mechanism, greatest_multiplier
from methods.springs.model.breaking import broken_model, joints_at_strength
from methods.springs.model.factor import SingularTangent, make_factor
from methods.springs.model.wall_model import WallModel, build_model, load_scale
from methods.springs.path.continuation import PathFollower
from methods.springs.path.load_path import LoadPath, follow
from methods.springs.path.path_record import PathEnd, PathRecord
from methods.springs.path.plateau import PlateauState, finish
from methods.springs.rest.equilibrium import equilibrium, first_step, gravity_state
from methods.springs.rest.newton import Equilibrium


@dataclass
class _BrittlePath:
    """A path on which joints break.

    Attributes:
        whole: the wall with all of its joints whole; settings: of the method; scale: a multiplier of its order.
        max_events: changes of state after which it is given up.
        model, rest: the wall as it is, and the equilibrium that it has come to.
        broken: joints that have broken, in this order; at: the multiplier at which each did.
        record: the path.
    """

    whole: Assembly
    settings: GapSpringsSettings
    scale: float
    max_events: int
    model: WallModel
    rest: Equilibrium
    broken: list[int] = field(default_factory=list)
    at: list[float] = field(default_factory=list)
    record: PathRecord = field(default_factory=PathRecord)

    @property
    def wall(self) -> Assembly:
        """The wall as it is now, its broken joints dry."""
        return self.model.assembly

    def details(self, status: str) -> dict[str, Any]:
        """What of the path goes into the details of every answer."""
        return {
            "broken": list(self.broken),
            "broken_at": list(self.at),
            "path_status": status,
            "events": self.record.events,
            "gap_points": self.model.n_points,
        }

    def forces(self) -> FloatArray:
        """(m, 3) contact forces of the rest [force]."""
        return self.model.end_forces(*self.model.forces(self.rest.u, self.rest.history, self.rest.state))

    def at_strength(self) -> IntArray:
        """The joints that have reached their strength in the rest."""
        rest, model = self.rest, self.model
        opening, slip = model.strains(rest.u)
        within = model.options.breakpoints.broken * load_scale(model, rest.multiplier)
        return joints_at_strength(model, opening, model.kt * slip + rest.history, rest.state, within)

    def break_joints(self, joints: IntArray) -> bool:
        """Take their strength from these joints at a constant multiplier; whether equilibrium is found without it.

        Where none is, the path stays where it was.
        """
        mask = np.zeros(self.wall.n_interfaces, dtype=bool)
        mask[joints] = True
        rest = self.rest
        after = broken_model(self.model, mask, rest.u, rest.history, rest.state, self.settings)
        found = equilibrium(after, make_factor(after), rest.u, rest.multiplier, after.history, commits=True)
        if not found.found:
            return False
        self.model, self.rest = after, found
        self.broken += joints.tolist()
        self.at += [rest.multiplier] * len(joints)
        return True

    def follow(self) -> LoadPath:
        """Follow the path from the rest to where joints reach their strength, which is then the rest, or to its end.

        Raises:
            SingularTangent: the path cannot be taken up where it stands.
        """
        start = self.rest if self.rest.multiplier > 0.0 else self._first_step()
        follower = PathFollower.from_rest(self.model, make_factor(self.model), start)
        way = follow(follower, self.record, self.max_events)
        if way.end is PathEnd.BROKEN:
            end, history = way.follower, way.follower.commit()
            self.rest = replace(start, multiplier=end.multiplier, u=end.u, history=history, state=end.state)
        return way

    def _first_step(self) -> Equilibrium:
        """An equilibrium off the dead load in which no joint has reached its strength, or the shortest tried.

        Raises:
            SingularTangent: there is none.
        """
        model, options = self.model, self.model.options.first_steps
        scale, gravity = self.scale, self.rest
        for _ in range(options.tries):
            first = first_step(model, make_factor(model), gravity, scale)
            if not first.found:
                raise SingularTangent("no step off the dead load is in equilibrium")
            self.rest = first
            joints = self.at_strength()
            self.rest = gravity
            if not len(joints):
                break
            scale = options.shorter * min(1.0, scale)
        return first


def brittle_answer(assembly: Assembly, settings: GapSpringsSettings, scale: float, max_events: int) -> Answer:
    """The answer for a wall with brittle joints, by one friction history without updates.

    Args:
        assembly: the wall; its components are followed apart.
        settings: of `fe`; scale: a multiplier of the order of collapse; max_events: as `_BrittlePath` has it.
    """
    solved: list[tuple[Assembly, Answer]] = []
    tuning = HistoryTuning()  # initial shears are tried in turn where ties lead the path astray

    def solve(part: Assembly) -> Answer:
        answer = Answer(Status.NOT_CONVERGED, Finding.NONE, SENTENCES[PathEnd.BREAKDOWN])
        for disturbance in (0.0, *tuning.disturbances):
            answer = _traced(part, settings, scale, max_events, disturbance, tuning.seed)
            if answer.status is Status.OK or answer.details.get("stopped_by_limit"):
                break
        solved.append((part, answer))
        return answer

    rows = with_bars_as_joints(assembly)
    answer = analysed_apart(rows, solve, _borne)
    joints = _joints_of_wall(rows, answer, solved)
    broken = np.zeros(rows.n_interfaces, dtype=bool)
    broken[joints["broken"]] = True
    proved = with_proof(rows.with_broken(broken), replace(answer, details=answer.details | joints))
    return with_bar_forces(proved, assembly.bars, assembly.n_interfaces) if len(assembly.bars) else proved


def _borne(part: Assembly, answer: Answer, multiplier: float) -> FloatArray | None:
    """Forces (m, 3) of a component at a multiplier up to its own, its joints that had broken by then dry."""
    broken = np.zeros(part.n_interfaces, dtype=bool)
    broken[[p for p, at in _breaks(answer) if at <= multiplier]] = True
    return admissible_forces(part.with_broken(broken), part.dead + multiplier * part.live)


def _breaks(answer: Answer) -> list[tuple[int, float]]:
    """The joints that broke in the answer for a component, and the multiplier at which each did."""
    return list(zip(answer.details.get("broken", []), answer.details.get("broken_at", []), strict=True))


def _joints_of_wall(assembly: Assembly, answer: Answer, solved: list[tuple[Assembly, Answer]]) -> dict[str, Any]:
    """Broken joints of the wall at the multiplier of its answer, and those that break there, from its components."""
    own = answer.details.get("broken", [])
    at = np.inf if answer.multiplier is None else answer.multiplier
    found: list[tuple[float, int]] = []
    breaking: list[int] = []
    for part, each in solved:
        index = joints_of(part, assembly)
        decides = each.details.get("broken") is own
        found += [(when, int(index[p])) for p, when in _breaks(each) if decides or when <= at]
        if decides:
            breaking = [int(index[p]) for p in each.details.get("breaking", [])]
    if len(solved) > 1:
        found.sort()
    listed: dict[str, Any] = {"broken": [p for _, p in found], "broken_at": [t for t, _ in found]}
    return listed | ({"breaking": breaking} if breaking else {})


def _traced(
    assembly: Assembly, settings: GapSpringsSettings, scale: float, max_events: int, disturbance: float, seed: int
) -> Answer:
    """The answer by a path that starts with random initial shears, in weights of a block."""
    model = build_model(assembly, settings)
    if disturbance:
        noise = np.random.default_rng(seed).uniform(-disturbance, disturbance, model.n_points)
        model = replace(model, history=model.history + noise)
    gravity = gravity_state(model, make_factor(model))
    if not gravity.found:
        return gravity_failure(model, gravity)
    path = _BrittlePath(assembly, settings, scale, max_events, model, gravity)
    return best_so_far(partial(_followed, path), partial(_stopped, path))


def _followed(path: _BrittlePath) -> Answer:
    """The answer at the end of a path; raises OutOfTime where the time is over."""
    try:
        while True:
            joints = path.at_strength()
            while len(joints):
                if not path.break_joints(joints):
                    return _collapse_by_breaking(path, joints)
                joints = path.at_strength()
            if not path.wall.has_live_load:
                answer = stands(path.model, path.rest)
                return replace(answer, details=answer.details | path.details("stands"))
            way = path.follow()
            if way.end is not PathEnd.BROKEN:
                return _at_the_end(path, way)
    except SingularTangent:
        return _lost(path, SENTENCES[PathEnd.BREAKDOWN])


def _at_the_end(path: _BrittlePath, way: LoadPath) -> Answer:
    """The answer where a path has ended without a further break."""
    follower, model = way.follower, path.model
    state: PlateauState | None = None
    if way.end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN, PathEnd.EVENTS):
        state = finish(model, follower.present(), follower.kept)
    if state is not None and state.multiplier >= 0.0:
        said = f"plateau; peak {path.record.peak:.6g}; {_order(path)}"
        answer = single_state_answer(
            model, state, said, path.record, path.details("plateau") | {"peak": path.record.peak}, path.record.events
        )
    elif way.end is PathEnd.UNBOUNDED:
        sentence = f"the live load cannot make the wall collapse: the path continues to any multiplier; {_order(path)}"
        answer = Answer(Status.OK, Finding.UNBOUNDED, sentence, iterations=path.record.events)
        answer = replace(answer, details=path.details("unbounded"))
    else:
        return _lost(path, SENTENCES[way.end])
    return at_limit(path.wall, answer)


def _collapse_by_breaking(path: _BrittlePath, joints: IntArray) -> Answer:
    """The answer where no equilibrium is left once these joints have lost their strength at a constant multiplier.

    Two things prove it: forces in equilibrium at this multiplier while the joints are whole and at their strength, and
    a dilatant mechanism of the wall without that strength, on which the loads do more work than the joints take.
    """
    mask = np.zeros(path.wall.n_interfaces, dtype=bool)
    mask[joints] = True
    after, multiplier = path.wall.with_broken(mask), path.rest.multiplier
    load = after.dead + multiplier * after.live
    statics = greatest_multiplier(after)
    mechanism = statics[2] if statics is not None and statics[0] < multiplier else dilatant_mechanism(after, load)
    names = _named(path.whole, joints.tolist())
    before = f"; before, {_order(path)}" if path.broken else ""
    details = path.details("break")
    if multiplier == 0.0:
        details |= {"broken": [*path.broken, *joints.tolist()], "broken_at": [*path.at, *[0.0] * len(joints)]}
        sentence = f"the wall falls under its dead load by the break of {names}: no equilibrium is left{before}"
        flow, finding = "associated", Finding.FALLS
        return Answer(Status.OK, finding, sentence, mechanism=mechanism, flow=flow, details=details)
    sentence = (
        f"the wall collapses at {multiplier:.6g} times the live load, the greatest multiplier reached, by the break of "
        f"{names}: no equilibrium was found after it{before}"
    )
    if mechanism is None:
        sentence += "; statics alone would find one, so that the collapse depends on the stiffness of the joints"
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        sentence,
        multiplier=multiplier,
        forces=path.forces(),
        forces_multiplier=multiplier,
        mechanism=mechanism,
        flow="associated",
        iterations=path.record.events,
        path=compact(path.model, path.record),
        details=details | {"breaking": joints.tolist(), "peak": multiplier},
    )


def _lost(path: _BrittlePath, why: str) -> Answer:
    """The answer of a path that came to no end."""
    reached = f", up to {path.record.peak:.6g} times the live load" if np.isfinite(path.record.peak) else ""
    sentence = f"no plateau was reached: {why}{reached}; {_order(path)}"
    curve = compact(path.model, path.record)
    return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, path=curve, details=path.details("not_converged"))


def _stopped(path: _BrittlePath) -> Answer:
    """The answer where the time is over."""
    lost = _lost(path, f"the path was {STOPPED}")
    return replace(lost, details=lost.details | {"stopped_by_limit": True})


def _order(path: _BrittlePath) -> str:
    """Which joints broke where, in words."""
    if not path.broken:
        return "no brittle joint broke"
    names = _named(path.whole, path.broken)
    return f"{names} broke, the first at {path.at[0]:.6g}, the last at {path.at[-1]:.6g}"


def _named(wall: Assembly, joints: list[int]) -> str:
    """A few joints by their blocks."""
    pairs = [f"{wall.block_ids[wall.block_a[p]]}-{wall.block_ids[wall.block_b[p]]}" for p in joints]
    return f"brittle joint{'s' if len(pairs) > 1 else ''} {first_few(pairs, 4)}"
