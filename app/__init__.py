"""The command line and the workstation around the engine in `core`."""
