"""From a waveform and a target to phase histories, coherent intervals and images."""
