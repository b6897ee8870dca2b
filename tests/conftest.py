from pathlib import Path

import pytest
from hypothesis import settings

# Speed is measured by benchmarks; a slow machine must not fail a law.
settings.register_profile("radarhull", deadline=None)
settings.load_profile("radarhull")

SHARED_DATA = Path(__file__).parents[2] / "shared" / "data"


@pytest.fixture
def shared_data():
    """Return a function from a folder's name to the outside data set of that name, or skip."""

    def folder(name: str) -> Path:
        path = SHARED_DATA / name
        if not path.is_dir():
            pytest.skip(f"outside data set {name} is not beside this checkout")
        return path

    return folder
