"""Experiments whose tables the reports print."""
