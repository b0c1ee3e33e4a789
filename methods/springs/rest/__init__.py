"""Equilibrium at a given load: Newton's steps, and slow motion to rest where they cycle."""
