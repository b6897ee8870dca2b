"""Finds a Chromium for the browser tests, and gets one where there is none.

Run as a script it prints the path, or says that Playwright's own build will be used.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

FLAGS = (
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
"""A browser without a graphics card, that asks nothing of the network by itself."""


def installed_chromium() -> Path | None:
    """Return the first Chromium or Chrome on PATH, None where there is none."""
    found = (shutil.which(name) for name in NAMES)
    return next((Path(path) for path in found if path), None)


def ensure_chromium() -> Path | None:
    """Return a Chromium to drive; None stands for Playwright's own, which is then installed.

    Where none is on PATH, root on Debian or Ubuntu gets the distribution's package; anybody else
    gets Playwright's download.

    Raises:
        RuntimeError: neither could be installed.
    """
    chromium = installed_chromium()
    if chromium is not None:
        return chromium
    if os.geteuid() == 0 and shutil.which("apt-get"):
        _say("No Chromium found; installing the distribution's package with apt-get.")
        environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
        _run(["apt-get", "update", "-q"], environment)
        _run(["apt-get", "install", "-q", "-y", "--no-install-recommends", "chromium"], environment)
        return installed_chromium()
    _say("No Chromium found; Playwright fetches its own (into its cache in your home folder).")
    _run([sys.executable, "-m", "playwright", "install", "chromium"], dict(os.environ))
    return None


def _run(command: list[str], environment: dict[str, str]) -> None:
    ended = subprocess.run(command, env=environment, check=False)
    if ended.returncode != 0:
        raise RuntimeError(
            f"`{' '.join(command)}` failed with exit code {ended.returncode}. The browser tests "
            f"need one of {', '.join(NAMES)} on PATH; install it and run them again."
        )


def _say(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        print(ensure_chromium() or "Playwright's own Chromium")
    except RuntimeError as error:
        sys.exit(str(error))
