"""The wall with springs in its contacts, and its equilibrium path traced exactly, which two method families use."""
