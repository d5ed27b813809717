"""Draw the props of a project: things that stand beside the character or that its joints carry."""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from PySide6.QtCore import QObject, Signal

from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.playback_source import ShownPlayback
from app.translation import tr_error, tr_phrase
from metagraph.common.network_paths import is_closed
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.graph.prop import Prop, make_turn
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.mesh_rays import find_hits
from preview.figure import SkinnedFigure

if TYPE_CHECKING:
    from metagraph.motion.prop_tops import PropTop
    from preview.scene import Actor

LYING = 0.02  # metres between a prop and what it lies on
TOPS = 64  # places of props whose tops are kept
SKY = 2000.0  # metres: higher than any prop


@dataclass
class PropMeshes:
    """What the files of props hold, by their whole paths, and the figures that draw them. Each size of a prop
    has its own figure; `keep_used` forgets the sizes that nothing has any more. folder: what paths in a
    project are relative to, unless what is shown says it.
    """

    folder: Path = Path()
    meshes: dict[Path, CharacterMesh] = field(default_factory=dict)
    _figures: dict[tuple[Path, float], SkinnedFigure] = field(default_factory=dict)
    carrying: tuple[Hashable, tuple[str, float]] | None = None  # what was last found to carry who sits
    tops: dict[tuple[Hashable, ...], tuple[PropTop, ...]] = field(default_factory=dict)  # by mesh and place

    def locate(self, path: str, folder: Path | None = None) -> Path:
        """Return the whole path of a prop's file, spelt in one way. folder: instead of its own."""
        return Path(os.path.normpath((folder or self.folder) / path))

    def find_figure(self, place: Path, scale: float) -> SkinnedFigure | None:
        """Return the figure of a prop's file at a scale; None for a file that is not among them."""
        mesh = self.meshes.get(place)
        if mesh is None:
            return None
        key = place, scale
        if key not in self._figures:
            self._figures[key] = SkinnedFigure(replace(mesh, positions=mesh.positions * np.float32(scale)))
        return self._figures[key]

    def keep_tops(self, key: tuple[Hashable, ...], tops: tuple[PropTop, ...]) -> None:
        """Keep the tops of a prop where it stands, and those of the last others."""
        if len(self.tops) >= TOPS:
            self.tops.clear()
        self.tops[key] = tops

    def keep_used(self, used: set[tuple[Path, float]]) -> None:
        """Forget all figures but some, and the files that none of those is of."""
        self._figures = {key: figure for key, figure in self._figures.items() if key in used}
        places = {place for place, _ in used}
        self.carrying = None
        self.meshes = {place: mesh for place, mesh in self.meshes.items() if place in places}
        there = set(map(id, self.meshes.values()))
        self.tops = {key: tops for key, tops in self.tops.items() if id(key[0]) in there}


class PropFigures(QObject):
    """Reads the document's props on a thread, each file once. `changed` is emitted when one is ready, `told`
    has the words for one that cannot be read, and for what was assumed of another.
    """

    changed = Signal()
    told = Signal(str)

    def __init__(self, document: Document, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document, self.jobs = document, jobs
        self.meshes = PropMeshes()
        self._asked: set[Path] = set()  # read, being read, or refused
        self._problems: dict[Path, str] = {}  # why those that were refused cannot be drawn
        document.changed.connect(self._follow)

    def find_problem(self, path: str) -> str:
        """Return why the file of a prop cannot be drawn, "" if it can, or is not read yet."""
        return self._problems.get(self.meshes.locate(path), "")

    def keep_mesh(self, path: Path, mesh: CharacterMesh) -> None:
        """Take over the mesh of a file that was read already, and tell what was assumed of it."""
        place = self.meshes.locate(str(path.parent.resolve() / path.name))
        self._asked.add(place)
        self._problems.pop(place, None)
        self.meshes.meshes[place] = mesh
        self.changed.emit()
        if mesh.notes:
            self.told.emit(f"{place.name}: {'; '.join(map(tr_phrase, mesh.notes))}")

    def _follow(self, before: Project, after: Project) -> None:
        if before.props is after.props:
            return
        self.meshes.folder = self.document.folder or Path()
        locate = self.meshes.locate
        used = {(locate(prop.path), prop.scale) for prop in after.props.values()}
        self.meshes.keep_used(used)
        self._asked &= {place for place, _ in used}
        for prop in after.props.values():
            place = locate(prop.path)
            if place not in self._asked and not is_closed(prop.path):
                self._asked.add(place)
                self._read(place)
        self.changed.emit()

    def _read(self, place: Path) -> None:
        from metagraph.formats.props.reader import read_prop

        def refuse(error: Exception) -> None:
            self._problems[place] = tr_error(error)
            self.changed.emit()
            self.told.emit(self._problems[place])

        self.jobs.start(
            f"prop {place}",
            lambda _: read_prop(place),
            lambda mesh: self.keep_mesh(place, mesh),
            refuse,
            quick=True,
        )


def read_prop_meshes(project: Project, folder: Path) -> tuple[PropMeshes, list[str]]:
    """Return the meshes of a project's props, and what to say of those that cannot be drawn."""
    from metagraph.formats.props.reader import read_prop

    out = PropMeshes(folder)
    problems: list[str] = []
    for path in dict.fromkeys(prop.path for prop in project.props.values() if not is_closed(prop.path)):
        try:
            out.meshes[out.locate(path)] = read_prop(folder / path)
        except FileError as error:
            problems.append(str(error))
    return out, problems


def to_mesh_space(prop: Prop, origin: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a ray as the mesh of a prop that stands has it, before it is turned, resized and placed; lengths
    along it stay the same.
    """
    back = rotation.conjugate(np.array(make_turn(prop)))
    start = rotation.rotate_vectors(back, origin - np.asarray(prop.at, float)) / prop.scale
    return start, rotation.rotate_vectors(back, direction) / prop.scale


def find_prop_on_ray(
    project: Project, meshes: PropMeshes, origin: np.ndarray, direction: np.ndarray
) -> tuple[str, float]:
    """Return the id of the nearest prop that stands on a ray in the project's space, and how far along it is;
    "" and infinity for none.
    """
    found = ("", float("inf"))
    for ident, prop in project.props.items():
        mesh = meshes.meshes.get(meshes.locate(prop.path))
        if mesh is None or prop.joint:
            continue
        hits = find_hits(mesh.positions, mesh.triangles, *to_mesh_space(prop, origin, direction))
        if len(hits) and hits[0] < found[1]:
            found = (ident, float(hits[0]))
    return found


def put_prop_down(
    project: Project, meshes: PropMeshes, ident: str, prop: Prop, to: tuple[float, float]
) -> Prop:
    """Return a prop at another place of the floor, x and z in metres. What lay on the floor or on a larger
    prop lies on what is below it there; what was lifted off stays as high.
    """
    before, after = (
        find_height_below(project, meshes, ident, x, z) for x, z in ((prop.at[0], prop.at[2]), to)
    )
    high = after if abs(prop.at[1] - before) < LYING else prop.at[1]
    return msgspec.structs.replace(prop, at=(round(to[0], 4), round(high, 4), round(to[1], 4)))


def find_height_below(project: Project, meshes: PropMeshes, ident: str, x: float, z: float) -> float:
    """Return how high the place of the floor is that a prop would lie on there, metres: on a larger prop that
    stands there, or 0 for the floor itself.
    """
    own = _measure_footprint(project.props[ident], meshes)
    high = 0.0
    for prop in project.props.values():
        mesh = meshes.meshes.get(meshes.locate(prop.path))
        if mesh is None or prop.joint or _measure_footprint(prop, meshes) <= own:
            continue
        origin, down = to_mesh_space(prop, np.array([x, SKY, z]), np.array([0.0, -1.0, 0.0]))
        hits = find_hits(mesh.positions, mesh.triangles, origin, down)
        high = max(high, SKY - float(np.min(hits, initial=SKY)))
    return high


def _measure_footprint(prop: Prop, meshes: PropMeshes) -> float:
    """Return the area of the box round a prop from above, square metres; 0 if its file is not read yet."""
    mesh = meshes.meshes.get(meshes.locate(prop.path))
    if mesh is None:
        return 0.0
    wide, _, deep = np.ptp(mesh.positions, axis=0) * prop.scale
    return float(wide * deep)


def make_prop_actors(
    shown: ShownPlayback,
    meshes: PropMeshes,
    placed: tuple[np.ndarray, np.ndarray],
    props: Mapping[str, Prop] | None = None,
) -> Iterator[Actor]:
    """Yield the props of the project that is shown, at one moment. placed: the character's global rotations
    `[J, 4]` and positions `[J, 3]`, where it stands. props: those to draw, if not those it was planned with.
    A clip that plays alone has none; a prop whose joint the character has not, and one whose mesh is not
    there, is left out. Of several speakers the first has what stands.
    """
    from preview.scene import Actor

    skeleton = shown.skeleton
    if shown.clip is not None or skeleton is None:
        return
    for prop in (shown.project.props if props is None else props).values():
        figure = meshes.find_figure(meshes.locate(prop.path, shown.folder), prop.scale)
        if figure is None or (prop.joint and prop.joint not in skeleton) or (not prop.joint and shown.side):
            continue
        turn, at = np.array(make_turn(prop)), np.asarray(prop.at, float)
        if prop.joint:
            joint = skeleton.names.index(prop.joint)
            base, origin = placed[0][joint], placed[1][joint]
            turn, at = rotation.multiply(base, turn), origin + rotation.rotate_vectors(base, at)
        elif shown.stand is not None:
            turns, places = shown.stand.placed(turn[None], at[None])
            turn, at = turns[0], places[0]
        yield Actor(figure, np.asarray(turn, np.float32)[None], np.asarray(at, np.float32)[None])
