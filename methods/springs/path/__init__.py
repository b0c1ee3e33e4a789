"""The equilibrium path traced exactly, kink by kink, to its plateau."""
