"""Frames of reference, lines of sight, projections and grids."""
