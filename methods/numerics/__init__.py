"""Linear algebra and compiled code that the method families share."""
