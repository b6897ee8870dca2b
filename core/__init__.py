"""Reconstruct visual hulls, lengths and attitude of satellites from multi-view radar images.

The engine. It knows nothing of the server in `app`. Data flows one way:
echoes, coherent intervals, frames, silhouettes, views, votes, hull, surface, measurements.
"""
