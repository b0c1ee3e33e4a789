"""How do I look at an answer in ParaView and as a figure?

The file for ParaView has a cell for each block, supports too, and the motion of its mechanism; the figure is a
matplotlib figure. The stack has two free blocks and its base, which is fixed.

Expected:

    cells of blocks at least 3: True
    figure written: True
"""

from pathlib import Path

import meshio

import drystone
from harness.formats.paraview import write_vtu


def main() -> None:
    """Print the answer."""
    wall = drystone.new_wall("stack", count=2)
    result = drystone.analyse(wall, "la")
    write_vtu(wall.case.built, result, Path("answer.vtu"))
    cells = sum(len(group.data) for group in meshio.read("answer.vtu").cells)
    print(f"cells of blocks at least 3: {cells >= 3}")
    result.plot().savefig("mechanism.svg")
    print(f"figure written: {'<svg' in Path('mechanism.svg').read_text(encoding='utf-8')}")


if __name__ == "__main__":
    main()
