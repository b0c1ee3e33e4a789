"""Limit analysis: collapse states as pairs of contact forces and a mechanism, without any stiffness."""
