"""Make new clips: cut from others, and saved as files in a folder beside the project.

Call these functions on a job's thread.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from pathlib import Path

from metagraph.common.file_names import make_file_stem
from metagraph.graph.edits import find_free_name
from metagraph.motion.clip import Clip

Loaded = tuple[str, int, str, Clip]  # what `add_clips` takes


def cut_into_pieces(clip: Clip, spans: Sequence[tuple[float, float]]) -> list[Clip]:
    """Return a clip cut into numbered stretches from start to end, in seconds."""
    out = []
    for n, (start, end) in enumerate(spans, 1):
        first, last = round(start * clip.fps), round(end * clip.fps) + 1
        out.append(clip.trimmed(first, last).renamed(f"{clip.name}_{n:02d}"))
    return out


def save(clips: Sequence[Clip], folder: Path, inside: str, taken: Collection[str] = ()) -> list[Loaded]:
    """Write each clip as a GLB of its own in a folder of the project; return what `add_clips` takes. `taken`
    has the names of existing clips. Raises FileError.
    """
    from metagraph.formats.clips import digest
    from metagraph.formats.gltf.writer import write_glb

    out: list[Loaded] = []
    names = set(taken)
    place = folder / inside
    place.mkdir(parents=True, exist_ok=True)
    for clip in clips:
        name = find_free_name(clip.name, names)
        while (place / f"{_file(name)}.glb").exists():
            names.add(name)
            name = find_free_name(clip.name, names)
        names.add(name)
        path = place / f"{_file(name)}.glb"
        write_glb(path, [clip.renamed(name)])
        out.append((f"{inside}/{path.name}", 0, digest(path), clip.renamed(name)))
    return out


def _file(name: str) -> str:
    return make_file_stem(re.sub(r"[^\w .()-]", "_", name).strip(" ."), "clip")
