"""Motion in time of rigid blocks on ground that accelerates, until the wall has fallen or all motion has died."""
