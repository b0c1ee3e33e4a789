"""Raise the live load on a wall that keeps its displacements, until it no longer comes to rest."""

from __future__ import annotations

import math
from collections.abc import Callable

from methods.de.settings import RISE

Rests = Callable[[float], bool]
"""Whether the wall comes to rest at a multiplier, from where it rested last. If not, it is put back there."""


def raise_until_it_falls(
    rests: Rests, greatest: float, step: float, accuracy: float, growth: float = 0.0, share: float = math.inf
) -> tuple[float, float | None]:
    """The highest multiplier at which the wall came to rest and the lowest at which it did not.

    Args:
        rests: holds the wall at a multiplier; it rests at zero.
        greatest: multiplier at which the loading ends; the second one is None where the wall rests up to there.
        step: load step.
        accuracy: the two are narrowed to this difference.
        growth: share of itself by which the multiplier may grow in one step, where that is more than `step`.
        share: of the multiplier to which they are narrowed, where that is less than `accuracy`.
    """
    stood, fell = 0.0, None
    while stood < greatest if fell is None else fell - stood > min(accuracy, share * fell):
        trial = min(stood + max(step, growth * stood), greatest) if fell is None else (stood + fell) / 2.0
        if rests(trial):
            stood = trial
        else:
            fell = trial
    return stood, fell


def shown_to_fall(
    rests: Rests, moved: list[float], ends: tuple[float, float | None], greatest: float, rise: float
) -> tuple[float, float | None]:
    """The highest multiplier at which a wall came to rest and the least above it at which it is shown to move, if any.

    Args:
        rests: holds the wall, and notes in `moved` where it is shown to move.
        moved: those multipliers.
        ends: what `raise_until_it_falls` found.
        greatest: multiplier at which the loading ends.
        rise: where nothing shows a motion, so much more is tried, then twice as much again, and so on.
    """
    stood, trial = ends
    while trial is not None and trial + rise <= greatest and not any(multiplier > stood for multiplier in moved):
        trial += rise
        rise *= RISE
        if rests(trial):
            stood = trial
    return stood, min((multiplier for multiplier in moved if multiplier > stood), default=None)
