"""Certificates of a tree in fractions, from the leaves that a search has given up."""
