"""Lengths, attitude and comparisons read off a hull."""
