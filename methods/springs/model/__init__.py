"""The wall with springs in its contacts: gap points, their law, the tangent and its factors."""
