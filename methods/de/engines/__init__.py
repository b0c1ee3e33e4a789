"""Rigid bodies in contact, advanced in time: what a hold asks of an engine, and the engines."""
