"""The hard walls as another processor has them: kernels of BLAS that round otherwise, in a process of their own."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest
from llvmlite.binding import get_host_cpu_features

HERE = Path(__file__).parent
HARD = (
    "test_hard_walls.py",
    "test_degenerate_walls.py::test_degenerate_wall_is_answered_as_exact_arithmetic_and_theory_have_it[lifting_loads]",
    "test_degenerate_walls.py::test_degenerate_wall_is_answered_as_exact_arithmetic_and_theory_have_it[zero_weights]",
)


def as_on(core: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Python in a process whose OpenBLAS takes the kernels of a core type, and says so."""
    variables = {"OPENBLAS_CORETYPE": core, "OPENBLAS_VERBOSE": "2", "OMP_NUM_THREADS": "1"}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, env=os.environ | variables, cwd=HERE.parents[1]
    )


@pytest.mark.slow
@pytest.mark.parametrize("core", ["Nehalem", "Haswell"])
def test_hard_walls_hold_with_the_kernels_of(core: str):
    if platform.machine() not in ("x86_64", "AMD64"):
        pytest.skip(f"{core} kernels are of x86-64, and this is {platform.machine()}")
    if core == "Haswell" and not get_host_cpu_features()["avx2"]:
        pytest.skip("this processor has no AVX2, which Haswell kernels need")
    said = as_on(core, "-c", "import numpy").stderr
    if "Core: " not in said:
        pytest.skip("numpy's BLAS is no OpenBLAS that chooses kernels at run time")
    assert f"Core: {core}" in said
    tests = [str(HERE / name) for name in HARD]
    run = as_on(core, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests)
    assert run.returncode == 0, run.stdout[-3000:]
