"""The set-up on machines that lack something: it works, or one sentence names what to install."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pip
import pytest

ROOT = Path(__file__).parents[2]
LOCK = "requirements.lock"


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """What the set-up needs of a checkout, in a path with blanks."""
    folder = tmp_path / "a check out"
    (folder / ".ci").mkdir(parents=True)
    shutil.copy(ROOT / ".ci" / "set-up", folder / ".ci" / "set-up")
    (folder / LOCK).write_text("")
    return folder


def python(folder: Path, name: str, script: str) -> Path:
    """A stand-in for a Python of a certain kind."""
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def set_up(checkout: Path, *words: str, path: str | None = None) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PATH": path or os.environ["PATH"]}
    command = ["/bin/sh", ".ci/set-up", ".venv", LOCK, *words]
    return subprocess.run(command, cwd=checkout, capture_output=True, text=True, timeout=300, env=environment)


def one_sentence(done: subprocess.CompletedProcess[str], *words: str) -> None:
    assert done.returncode == 2
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("set-up: ")]
    for word in words:
        assert word in line


def bare(tmp_path: Path) -> str:
    """A PATH with the tools of any Debian and no Python."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in ("sh", "mkdir", "echo", "cp"):
        found = shutil.which(tool)
        assert found is not None
        (folder / tool).symlink_to(found)
    return str(folder)


def test_a_machine_without_python_is_told_what_to_install(checkout: Path, tmp_path: Path):
    one_sentence(set_up(checkout, path=bare(tmp_path)), "Python 3.11 or newer", "no python3", "install python3.11")


def test_a_machine_with_python_3_10_is_told_what_to_install(checkout: Path, tmp_path: Path):
    path = bare(tmp_path)
    old = 'case "$1" in --version) echo "Python 3.10.13";; *) exit 1;; esac'
    python(Path(path), "python3", old)
    one_sentence(set_up(checkout, path=path), "Python 3.11 or newer", "has Python 3.10.13", "PYTHON=")


def test_a_newer_python_beside_an_old_python3_is_found(checkout: Path, tmp_path: Path):
    path = bare(tmp_path)
    python(Path(path), "python3", "exit 1")
    python(Path(path), "python3.12", f'exec "{sys.executable}" "$@"')
    done = set_up(checkout, path=path)
    # It makes the environment with it and then misses the project, which this checkout does not have.
    one_sentence(done, "the project itself could not be installed")
    assert (checkout / ".venv" / "bin" / "python").exists()


def test_debians_python_without_the_venv_package_is_told_its_name(checkout: Path, tmp_path: Path):
    path = bare(tmp_path)
    without = f'case "$2" in *ensurepip*) exit 1;; esac; exec "{sys.executable}" "$@"'
    python(Path(path), "python3", without)
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    one_sentence(set_up(checkout, path=path), f"install python{version}-venv")


def test_an_interrupted_installation_is_taken_up_again(checkout: Path):
    (checkout / ".venv" / "bin").mkdir(parents=True)
    (checkout / ".venv" / "bin" / "python").symlink_to("/nowhere/python3")
    one_sentence(set_up(checkout, sys.executable), "the project itself could not be installed")
    again = subprocess.run([checkout / ".venv" / "bin" / "python", "-m", "pip", "--version"], capture_output=True)
    assert again.returncode == 0


def test_packages_that_cannot_be_fetched_are_told(checkout: Path):
    (checkout / LOCK).write_text("no-such-package==1.0 --hash=sha256:" + "0" * 64 + "\n")
    # An environment that borrows this one's pip, because making one with its own takes ten times as long.
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", checkout / ".venv"], check=True)
    (packages,) = (checkout / ".venv" / "lib").glob("python*/site-packages")
    (packages / "borrowed.pth").write_text(str(Path(pip.__file__).parents[1]))
    script = f"exec /bin/sh .ci/set-up .venv {LOCK}"
    environment = os.environ | {"PIP_NO_INDEX": "1"}
    done = subprocess.run(
        ["/bin/sh", "-c", script], cwd=checkout, capture_output=True, text=True, timeout=300, env=environment
    )
    one_sentence(done, "network or a package index", "goes on where it stopped")


@pytest.mark.skipif(os.getuid() != 0, reason="a read-only mount needs root")
def test_a_read_only_checkout_is_told(checkout: Path):
    read_only = f"mount --bind '{checkout}' '{checkout}' && mount -o remount,ro,bind '{checkout}'"
    script = f"{read_only} && cd '{checkout}' && exec /bin/sh .ci/set-up .venv {LOCK}"
    done = subprocess.run(["unshare", "-m", "sh", "-c", script], capture_output=True, text=True, timeout=60)
    if "unshare" in done.stderr or "mount:" in done.stderr:
        pytest.skip("mounts are not allowed here")
    one_sentence(done, "cannot be written to", "copy it")
