"""What says how to cite Drystone names its version, its licence and its authors as the package does."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import drystone

ROOT = Path(__file__).resolve().parents[2]


def test_citation_and_codemeta_agree_with_the_package():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (author,) = (item["name"] for item in project["authors"])
    cited = (ROOT / "CITATION.cff").read_text()
    listed = json.loads((ROOT / "codemeta.json").read_text())
    assert re.findall(r"^version: (.+)$", cited, re.MULTILINE) == [drystone.__version__]
    assert listed["version"] == drystone.__version__
    assert f"  - name: {author}\n" in cited
    assert listed["author"][0]["name"] == author
    assert author in (ROOT / "LICENSE").read_text()
    assert f"license: {project['license']}\n" in cited
    assert listed["license"].endswith(project["license"])
    for classifier in ("3.11", "3.12", "3.13"):
        assert f"Programming Language :: Python :: {classifier}" in project["classifiers"]
