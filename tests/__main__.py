"""Gets a Chromium where there is none, then runs the whole suite: `python -m tests`."""

import sys

import pytest

from tests.chromium import ensure_chromium

if __name__ == "__main__":
    ensure_chromium()
    raise SystemExit(pytest.main(sys.argv[1:]))
