"""Figures for papers, and of curves: display lists and charts through matplotlib."""
