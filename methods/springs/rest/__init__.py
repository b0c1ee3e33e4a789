"""Equilibrium at a given load: Newton's steps, and pseudo-transient relaxation to rest where they cycle."""
