"""Registration: the unknown offset of every frame in range and cross-range (section III.D)."""
