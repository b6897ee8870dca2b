"""Outlines of the target in a frame."""
