"""Can I prove that no collapse state of the paper's block lies below the least one found?

`la-bound` writes a certificate, and `verify` checks it in fractions with code that does not know how it was found.
The bound is two millionths below the exact minimum 2/5.

Expected:

    state found 0.400000
    proved within two millionths: True
"""

import json
from fractions import Fraction
from pathlib import Path

import drystone
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import verify


def main() -> None:
    """Print the answer."""
    wall = drystone.library_wall("single-block")
    result = drystone.analyse(wall, "la-bound")
    certificate = Path("certificate.json")
    certificate.write_text(json.dumps(result.details["certificate"]), encoding="utf-8")
    document = json.loads(certificate.read_text(encoding="utf-8"))
    require_same_wall(document, wall.assembly)
    bound, state = verify(document)
    assert state is not None
    print(f"state found {float(state):.6f}")
    print(f"proved within two millionths: {Fraction(2, 5) - bound <= Fraction(2, 10**6)}")


if __name__ == "__main__":
    main()
