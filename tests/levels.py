"""Makes the levels of detail of the samples' characters before the tests: `python -m tests.levels`.

Each process that shows a character would make them, while its window waits to be emptied for the next test.
"""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HOME = ROOT / ".pytest_cache" / "meshes"


def make_levels_of_samples() -> None:
    """Make what is not kept yet: of the characters, and of the default body on the samples' skeleton."""
    from metagraph.formats.store import open_project
    from preview.character_file import load_mesh_figure

    skeleton = open_project(ROOT / "sample_clips" / "sample.metagraph.yaml").project.skeleton
    assert skeleton is not None
    for name in ("mannequin.glb", "ada.glb", "ben.glb", None):
        path = ROOT / "sample_clips" / name if name else None
        load_mesh_figure(path, skeleton, (), None, False).simplify()


if __name__ == "__main__":
    os.environ["METAGRAPH_MESH_CACHE"] = str(HOME)
    make_levels_of_samples()
