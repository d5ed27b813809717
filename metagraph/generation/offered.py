"""Which models there are to choose from: beside a project, and the one that comes with the program."""

from __future__ import annotations

from pathlib import Path

from metagraph.generation.stored import SUFFIX

OWN = "own"  # what programs call it
OWN_WORDS = "Metagraph's own"
FOLDER = "models"  # beside the project file
SHIPPED = Path(__file__).resolve().parents[2] / "sample_clips" / "models" / f"{OWN}{SUFFIX}"


def list_models(folder: Path | None) -> dict[str, Path]:
    """Return models by name: the program's own, where it is installed, then those in a project's folder and
    in its FOLDER, by name. None is read.
    """
    out = {OWN: SHIPPED} if SHIPPED.is_file() else {}
    for place in () if folder is None else (folder / FOLDER, folder):
        if place.is_dir():
            for path in sorted(place.glob(f"*{SUFFIX}")):
                out.setdefault(path.stem, path)
    return out


def model_title(name: str) -> str:
    """Return a model's name as people read it."""
    return OWN_WORDS if name == OWN else name
