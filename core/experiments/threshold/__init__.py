"""Wrong silhouettes in a sequence, and how votes and blame repair the hull."""
