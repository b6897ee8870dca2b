"""Cameras and what they see of a target."""
