"""How do I make a page with sliders that shows why three methods differ on one block?

`drystone learn` makes the page for the class; the same from Python with only the paper's block. The page works
offline, and the three values on it are those of docs/theory-single-block.md. Its sliders
are the friction of both halves and the stiffness, and the friction of the wall of 21 bricks.

Expected:

    la 0.400000
    fe 0.476190
    la-associated 0.545455
    sliders 4
"""

from pathlib import Path

import drystone
from reports.page.learn import write_learn


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("single-block")
    compared = drystone.compare(wall, ["la", "fe", "la-associated"], isolated=False, title="Why methods differ")
    for result in compared.results:
        print(f"{result.method} {result.multiplier:.6f}")
    write_learn(compared.run, Path("learn.html"))
    page = Path("learn.html").read_text(encoding="utf-8")
    sliders = page.count('type="range"')
    print(f"sliders {sliders}")


if __name__ == "__main__":
    main()
