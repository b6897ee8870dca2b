"""Image-sequence energy accumulation (ISEA): points from images, without tracks or silhouettes."""
