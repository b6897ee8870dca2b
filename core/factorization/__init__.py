"""Shape and motion from scatterers tracked through range-Doppler images: the paper's rival."""
