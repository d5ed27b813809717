"""List the models that the user can choose: those beside a project, and the one that comes with Metagraph."""

from __future__ import annotations

from pathlib import Path

from metagraph.common.wording import phrase
from metagraph.generation.stored import SUFFIX

OWN = "own"  # what programs call it
OWN_WORDS = phrase("Metagraph's own")
FOLDER = "models"  # beside the project file
SHIPPED = Path(__file__).resolve().parents[2] / "sample_clips" / "models" / f"{OWN}{SUFFIX}"


def list_models(folder: Path | None) -> dict[str, Path]:
    """Return the files of models by name, without reading them: Metagraph's own if it is installed, then
    those in a project's folder and in its FOLDER.
    """
    out = {OWN: SHIPPED} if SHIPPED.is_file() else {}
    for place in () if folder is None else (folder / FOLDER, folder):
        if place.is_dir():
            for path in sorted(place.glob(f"*{SUFFIX}")):
                out.setdefault(path.stem, path)
    return out


def name_model(name: str) -> str:
    """Return a model's name as people read it."""
    return OWN_WORDS if name == OWN else name
