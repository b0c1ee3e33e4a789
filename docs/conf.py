"""How Sphinx builds the documentation: `make docs`. Pages under generated/ are written from the code at each build."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import figures  # noqa: E402
import gallery  # noqa: E402
import manual  # noqa: E402
import pages  # noqa: E402

import drystone  # noqa: E402

project, author, release = "Drystone", "the Drystone developers", drystone.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = f"Drystone {release}"
html_extra_path = ["wall-1.schema.json"]
html_static_path = ["static"]
html_css_files = ["print.css"]
exclude_patterns = ["_build"]
autodoc_typehints = "description"


def _generate(_app: Any) -> None:
    folder = HERE / "generated"
    folder.mkdir(exist_ok=True)
    for write in (*pages.ALL, manual.manual_page, gallery.gallery_page, *figures.ALL):
        write(folder)


def setup(app: Any) -> None:
    """Write the generated pages and figures before Sphinx looks for sources."""
    app.connect("builder-inited", _generate)
