"""Tags from the folders that clips lie in: those in `happy/` are happy, those in `sad/` beside it are sad."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath

from metagraph.common.wording import phrase
from metagraph.suggest.estimate import Belief
from metagraph.suggest.words.names import read_names
from metagraph.suggest.words.patterns import Patterns

SURE = 0.8  # certainty of a tag that a folder gives, as of one that a name gives
# Folders that say what files are, not what is in them.
KINDS_OF_FILES = frozenset(
    ("anim", "anims", "animation", "animations", "bvh", "clip", "clips", "export", "exports", "fbx", "glb")
    + ("gltf", "mocap", "motion", "motions", "take", "takes", "vrm", "vrma")
)


def read_folder_tags(
    paths: Mapping[str, str], patterns: Patterns | None = None
) -> dict[str, Belief[tuple[str, ...]]]:
    """Return clip id -> the tags that its folders give. `paths` are those of all clips, by id, as a project
    keeps them. Absolute ones lie outside the project, as all do before it is saved: of their folders only
    those give tags whose names mean something in clips' names.

    A folder gives a tag where it lies beside other folders with clips: its own name, and what that means as a
    word of a clip's name ("sad" is also negative).
    """
    outside = {clip for clip, path in paths.items() if PurePath(path).is_absolute()}
    folders = {clip: PurePath(path).parent.parts for clip, path in paths.items()}
    beside: dict[tuple[str, ...], set[str]] = {}
    for parts in folders.values():
        for n, part in enumerate(parts):
            beside.setdefault(parts[:n], set()).add(part)
    meanings = read_names(sorted({part for parts in folders.values() for part in parts}), patterns)
    out: dict[str, Belief[tuple[str, ...]]] = {}
    for clip, parts in folders.items():
        found, named = list[str](), list[str]()
        for n, part in enumerate(parts):
            name = " ".join(part.replace("_", " ").replace("-", " ").lower().split())
            if len(beside[parts[:n]]) < 2 or name.rstrip(" 0123456789") in (*KINDS_OF_FILES, ""):
                continue
            said = meanings[part].tags
            if clip in outside and said is None:
                continue
            named.append(part)
            found += [name, *(said.value if said is not None else ())]
        if found:
            tags = tuple(dict.fromkeys(found))
            out[clip] = Belief(tags, SURE, phrase("its folder is '{name}'", name="/".join(named)))
    return out


def join_tags(
    one: Belief[tuple[str, ...]] | None, other: Belief[tuple[str, ...]] | None
) -> Belief[tuple[str, ...]] | None:
    """Return the tags of two beliefs together; None of neither."""
    if one is None or other is None:
        return one or other
    why = phrase("{one} and {other}", one=one.reason, other=other.reason)
    return Belief(
        tuple(dict.fromkeys((*one.value, *other.value))), min(one.confidence, other.confidence), why
    )
