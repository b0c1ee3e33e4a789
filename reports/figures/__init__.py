"""Figures for papers and charts of curves, through matplotlib, which the extra `figures` installs."""

from harness.model.errors import optional

optional("matplotlib", "figures", "figures")
