"""What the engine is measured against: its peers, its own growth, and the true hull."""
