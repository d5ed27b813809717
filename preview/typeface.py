"""Find the files of the typeface that the window and pictures are written in."""

from __future__ import annotations

from pathlib import Path

FAMILY = "Source Sans Pro"
WEIGHTS = ("Regular", "Semibold", "Bold", "It")


def find_typeface_file(weight: str) -> Path:
    """Return the TrueType file of a weight, one of `WEIGHTS`."""
    from font_source_sans_pro import font_directory

    return Path(font_directory) / f"SourceSansPro-{weight}.ttf"
