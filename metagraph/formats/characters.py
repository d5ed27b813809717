"""Which file a project's character is drawn from, and what of it: stand-ins are given from characters, and
what is carried in the hands by the dozen is hidden at first.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from metagraph.common.files import is_text
from metagraph.errors import FileError
from metagraph.formats.gltf.reader import has_skinned_mesh, read_character, read_vrm_roles
from metagraph.graph.edits import hide_meshes, set_character, set_role
from metagraph.graph.face.rig import with_morphs
from metagraph.graph.model import Project
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.fitting.fit_character import explain_no_fit
from metagraph.motion.roles import ROLES, find_roles
from metagraph.motion.skeleton import Skeleton

SUFFIXES = (".glb", ".gltf", ".vrm")
SAME = 0.8  # share of a skeleton's joints that a file without motion must name to be taken for its character


@dataclass(frozen=True)
class CharacterFile:
    """`path`: as the project keeps it. `morphs`: its morph targets. `hidden`: meshes that are not drawn at
    first. `why_not`: why its mesh is no character, in words that follow "its mesh"; None if it is one.
    `roles`: role -> joint name, those that a VRM file states and names and shape do not tell.
    """

    path: str
    morphs: tuple[str, ...] = ()
    hidden: tuple[str, ...] = ()
    why_not: str | None = None
    roles: Mapping[str, str] = field(default_factory=dict)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know of it."""
        if not self.hidden:
            return ()
        some = f"{', '.join(self.hidden[:3])}{' …' if len(self.hidden) > 3 else ''}"
        return (
            f"{Path(self.path).name}: {len(self.hidden)} meshes in the hands are hidden ({some}), since no "
            "one holds them all; show them with Meshes of the character (File menu)",
        )

    def into(self, project: Project) -> Project:
        """Edit `project`: draw it with this character. Roles that a user has corrected are kept."""
        project = with_morphs(hide_meshes(set_character(project, self.path), self.hidden), self.morphs)
        joints = project.skeleton or ()
        for role, joint in self.roles.items():
            if role not in project.roles and joint in joints:
                project = set_role(project, role, joint)
        return project


def look_at(name: str, folder: Path | None, skeleton: Skeleton | None) -> CharacterFile:
    """Read what a project of a skeleton has to know of a character's file. Raises FileError."""
    if not is_text(name):
        raise FileError(name, "has a name that is no text", "its name", "Rename it.")
    path = (folder or Path()) / name
    return _described(name, path, read_character(path), skeleton)


def _described(name: str, path: Path, body: CharacterMesh, skeleton: Skeleton | None) -> CharacterFile:
    stated = read_vrm_roles(path)
    found = find_roles(body.skeleton)
    roles = {
        role: joint
        for role, joint in stated.items()
        if role in ROLES and body.skeleton.index(joint) != found.get(role)
    }
    why_not = explain_no_fit(body, skeleton)
    return CharacterFile(name, body.morphs, find_held_meshes(body), why_not, roles)


def find_held_meshes(body: CharacterMesh) -> tuple[str, ...]:
    """Return the meshes that hang in the hands, where one hand holds several: they cannot all be meant at
    once.

    A hand of which the skin follows nothing is made of such meshes itself, and nothing in it is hidden.
    """
    roles = find_roles(body.skeleton)
    held = {s.mesh: s.held for s in body.surfaces if s.held >= 0}
    rigid = {t for s in body.surfaces if s.held >= 0 for t in range(s.first, s.first + s.count)}
    skinned = np.ones(len(body.triangles), bool)
    skinned[sorted(rigid)] = False
    used = np.unique(body.triangles[skinned])
    moved = set(np.unique(body.joints[used][body.weights[used] > 0]).tolist())
    found: dict[int, list[str]] = {}
    for side in ("left", "right"):
        hand = roles.get(f"{side}_hand")
        if hand is None:
            continue
        below = {hand}
        for joint in range(hand + 1, len(body.skeleton)):
            if int(body.skeleton.parents[joint]) in below:
                below.add(joint)
        if moved & below:
            for mesh, joint in held.items():
                if joint in below and joint not in moved:
                    found.setdefault(joint, []).append(mesh)
    if all(len(meshes) < 2 for meshes in found.values()):
        return ()
    some = {mesh for meshes in found.values() for mesh in meshes}
    return tuple(mesh for mesh in body.meshes if mesh in some)


def find_character_among(
    clips: Iterable[str], still: Iterable[str], folder: Path | None, skeleton: Skeleton
) -> tuple[CharacterFile | None, tuple[CharacterFile, ...]]:
    """Return the first file with a character for a skeleton, and those whose mesh is none if there is no such
    file.

    clips: files of clips on that skeleton. still: files without motion, which may hold another character.
    """
    none: list[CharacterFile] = []
    for name in dict.fromkeys(clips):
        found = _look(name, folder, skeleton)
        if found is not None and found.why_not is None:
            return found, ()
        none += [found] if found is not None else []
    for name in dict.fromkeys(still):
        found = _look(name, folder, skeleton, SAME)
        if found is not None and found.why_not is None:
            return found, ()
    return None, tuple(none)


def find_fitting_character(name: str, folder: Path | None, skeleton: Skeleton) -> CharacterFile | None:
    """Return what a project of a skeleton has to know of a file with a character that can be drawn on it, by
    the names of its joints or fitted; None if it holds none.
    """
    found = _look(name, folder, skeleton)
    return found if found is not None and found.why_not is None else None


def _look(name: str, folder: Path | None, skeleton: Skeleton, same: float = 0.0) -> CharacterFile | None:
    """Look at a file that may hold a character; None if it holds no mesh on a skeleton, or names less than a
    share `same` of the joints.
    """
    path = (folder or Path()) / name
    try:
        if path.suffix.lower() not in SUFFIXES or not has_skinned_mesh(path):
            return None
        body = read_character(path)
    except FileError:
        # its clips were read; what is wrong with its meshes the preview says if it is chosen
        return None
    if sum(joint in body.skeleton for joint in skeleton.names) < same * len(skeleton):
        return None
    return _described(name, path, body, skeleton)
