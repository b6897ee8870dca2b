"""What an analyst does to an outline: every tool takes rings and returns new ones."""
