"""An analysis under an analyst's hands: frames, their outlines with all revisions, and the hull."""
