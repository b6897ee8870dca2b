"""Gets a Chromium where there is none, then runs the suite on all processors: `python -m tests`."""

import sys

import pytest

from tests.chromium import ensure_chromium

PARALLEL = ("-n", "auto", "--dist", "loadfile", "--durations", "25")
"""A file's tests share what they compute once, so they stay together; the slowest are named."""

if __name__ == "__main__":
    ensure_chromium()
    raise SystemExit(pytest.main([*PARALLEL, *sys.argv[1:]]))
