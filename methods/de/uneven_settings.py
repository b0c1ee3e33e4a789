"""Settings of the methods on uneven blocks."""

from __future__ import annotations

from pydantic import Field

from harness.model.method import Settings
from methods.de.uneven.defects import Faces


class UnevenSettings(Settings):
    """The defects of planarity and how finely the multiplier is sought.

    Attributes:
        size: greatest cut of a corner as a part of the block height; each is drawn from U(0, size x height).
        faces: which faces are uneven.
        seed: seed of the cuts.
        accuracy: the multiplier is narrowed to this difference.
        greatest: multiplier at which the loading ends.
    """

    size: float = Field(default=0.03, ge=0.0, le=0.3)
    faces: Faces = "both"
    seed: int = Field(default=0, ge=0)
    accuracy: float = Field(default=0.005, gt=0.0, le=0.1)
    greatest: float = Field(default=2.0, gt=0.0)

    @property
    def wall(self) -> str:
        """What a sentence calls the wall with these defects."""
        return f"The wall with corners cut by up to {self.size:g} of the block height (seed {self.seed})"


class ClosedSettings(UnevenSettings):
    """The defects, how finely the multiplier is sought, and what stands beside the answer.

    Attributes:
        step: load step.
        alone: methods that analyse the contacts closed under the dead load alone.
        compare: also load the same uneven wall with distinct elements alone, as `de-uneven` does, for value and cost.
    """

    step: float = Field(default=0.02, gt=0.0, le=1.0)
    alone: tuple[str, ...] = ("fe", "la")
    compare: bool = True
