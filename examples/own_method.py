"""How do I have a method of my own judged and compared with a shipped one?

A method is a class with `solve`. This one is for one block on one joint that slides at its friction mu: three equations
of equilibrium give the three forces of the joint. The case `slide` slides at mu = 0.3, before it topples at b/h = 2.

Expected:

    mine 0.300000, accepted
    la 0.300000, accepted
"""

import numpy as np

import drystone
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Method, Settings, Status, Traits


class SlidingBlock(Method):
    """One block on one joint, at the multiplier at which it slides to the right."""

    name, family, title, tolerance = "mine", "mine", "sliding block", 1e-9
    traits = Traits(caption="sliding block")

    def solve(self, assembly: Assembly, settings: Settings) -> Answer:
        """Forces from equilibrium at the multiplier mu, and the block as it slides."""
        multiplier = float(assembly.friction[0])
        dead, live = assembly.free_loads()
        forces = np.linalg.solve(assembly.kinematic_matrix.toarray().T, -dead - multiplier * live)
        mechanism = np.where(assembly.fixed[:, None], 0.0, [1.0, 0.0, 0.0])
        found = Status.OK, Finding.COLLAPSES, "The block slides."
        return Answer(*found, multiplier, forces=forces.reshape(1, 3), mechanism=mechanism, flow="non-associated")


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("slide")
    for result in (drystone.analyse(wall, SlidingBlock()), drystone.analyse(wall, "la")):
        print(f"{result.method} {result.multiplier:.6f}, {result.judge.outcome}")


if __name__ == "__main__":
    main()
