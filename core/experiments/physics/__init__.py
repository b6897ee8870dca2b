"""The physics behind the pipeline, held against theory and measured data, part by part."""
