"""The equilibrium path traced exactly, breakpoint by breakpoint, to its plateau."""
