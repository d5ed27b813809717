"""Define what is dragged or dropped: clips and actions of the project, or files to read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

from app.translation import tr

ANNOTATIONS = ".eaf"


@dataclass(frozen=True)
class Load:
    """What is being dragged: clips, actions or files."""

    clips: tuple[str, ...] = ()
    actions: tuple[str, ...] = ()
    files: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.clips or self.actions or self.files)

    @property
    def count(self) -> int:
        return len(self.clips) or len(self.actions) or len(self.files)


def describe_readable_formats() -> str:
    """Return the formats of clips that can be read here, in words."""
    if not _is_fbx_readable():
        return tr("BVH, GLB, glTF, VRM animation\n(FBX needs the extra 'fbx')")
    return tr("BVH, FBX, GLB, glTF, VRM animation")


@cache  # each look takes as long as a panel's update
def _is_fbx_readable() -> bool:
    return find_spec("ufbx") is not None
