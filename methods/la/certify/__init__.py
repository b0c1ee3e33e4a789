"""Proofs that no collapse state lies lower, and states and bounds in fractions."""
