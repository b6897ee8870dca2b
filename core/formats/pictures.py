"""Frames as pictures."""

from pathlib import Path

import cv2
import numpy as np

from core.formats.files import checked_output, written_aside
from core.frame import Frame

DEPTH_DB = 60.0

SUFFIXES = (".png",)


def write_picture(path: Path, frame: Frame) -> None:
    """Write a frame as a grey PNG in dB, from its peak (white) down to −60 dB (black).

    Raises:
        ValueError: another ending than .png, or a folder that cannot be written.
    """
    checked_output(path, SUFFIXES)
    grey = (frame.decibels(floor_db=-DEPTH_DB) / DEPTH_DB + 1) * 255
    _, content = cv2.imencode(".png", np.round(grey).astype(np.uint8))
    with written_aside(path) as aside:
        aside.write_bytes(content.tobytes())
