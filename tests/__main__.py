"""Gets a Chromium where there is none, then runs the suite on all processors: `python -m tests`."""

import sys

import pytest

from tests.chromium import ensure_chromium

if __name__ == "__main__":
    ensure_chromium()
    # A file's tests share what they compute once, so they stay together.
    raise SystemExit(pytest.main(["-n", "auto", "--dist", "loadfile", *sys.argv[1:]]))
