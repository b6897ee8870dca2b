"""From outlines and projections to the visual hull and its surface."""
