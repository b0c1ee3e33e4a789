"""Walls of blocks whose faces are uneven, and the contacts that they have."""
