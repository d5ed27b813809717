"""Film what plays without a window: the figure that draws a project, and a picture of each moment."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from app.stage.playback_source import ASIDE, ShownPlayback
from metagraph.graph.model import Project

if TYPE_CHECKING:
    from app.stage.props import PropMeshes
    from preview.scene import SceneTheme

Seen = tuple[Any, ShownPlayback]  # a figure, and what it plays
TOGETHER = 32  # poses of a video made at once


def make_project_figure(project: Project, folder: Path, sticks: bool = False) -> Any:
    """Return the figure that draws a project; its `instead` says why it is not the character's mesh. `sticks`
    draws a stick figure in place of the default body. Raises FileError.
    """
    from metagraph.motion.fitting.footing import choose_footing
    from preview.character_file import load_mesh_figure

    assert project.skeleton is not None
    path = folder / project.character if project.character is not None else None
    footing = choose_footing((entry.motion for entry in project.clips.values()), project.skeleton)
    return load_mesh_figure(path, project.skeleton, project.hidden, footing, sticks)


def measure_bounds(seen: Sequence[Seen], times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest corner, `[3]`, of a box round all that is seen at times."""
    from preview.scene import Scene

    some = times[:: max(1, len(times) // 60)]
    return Scene(tuple(_actor(figure, shown, some) for figure, shown in seen)).drawn_bounds()


def render_pictures(
    seen: Sequence[Seen],
    times: np.ndarray,
    size: tuple[int, int],
    look: SceneTheme | str,
    camera: Any = None,
    into: np.ndarray | None = None,
    seat: str = "stool",
    props: PropMeshes | None = None,
) -> Iterator[np.ndarray]:
    """Yield one picture `[H, W, 4]` for each time. camera: a fixed camera, or a function from seconds to a
    camera; by default it sees everything. into: an array in which all pictures come, for callers that finish
    with one before they ask for the next. seat: one of `preview.looks.SEATS`. props: the meshes
    of the projects' props, None to draw none.
    """
    from app.stage.cutting import Filmed
    from app.stage.prop_contacts import put_on_props
    from app.stage.stools import make_stools
    from preview.camera import make_whole_figure_camera
    from preview.drawing_apart import draw_scenes
    from preview.framing import find_focus, find_lamp_turn, has_studio_lamp, turn_to_face
    from preview.scene import THEMES, LampTurn, Scene

    theme = THEMES[look] if isinstance(look, str) else look

    if props is not None:
        seen = [(figure, put_on_props(shown, props)) for figure, shown in seen]
    seats = tuple(one for of, shown in seen for one in make_stools(shown, seat, of, props))
    figure, first = seen[0]
    pose = first.pose(float(times[0])) if len(seen) == 1 and not callable(camera) else None
    turn = 0.0
    if pose is not None and first.skeleton is not None:
        turn = turn_to_face(figure, first.skeleton.globals(pose)[1])
    if camera is not None and not callable(camera):
        follows = len(seen) == 1 and has_studio_lamp(theme)
        lamp = find_lamp_turn(camera.yaw, turn) if follows else LampTurn(turn) if turn else None
        kept = Filmed(camera, lamp)
        camera = lambda _: kept  # noqa: E731
    if camera is None:
        box = measure_bounds(seen, times)
        whole = make_whole_figure_camera(box, size[0] / size[1], ASIDE if len(seen) > 1 else turn)
        filmed = Filmed(whole, LampTurn(turn) if turn else None)
        camera = lambda _: filmed  # noqa: E731

    def scenes() -> Iterator[tuple[Scene, Any]]:
        for start in range(0, len(times), TOGETHER):
            some = times[start : start + TOGETHER]
            acted = zip(*(_actors(figure, shown, some, props) for figure, shown in seen), strict=True)
            for at, actors in zip(some, acted, strict=True):
                now = camera(float(at))
                focus = find_focus(now.camera, [some[0] for some in actors]) if theme.blurred else None
                everything = (*(a for some in actors for a in some), *seats)
                yield Scene(everything, lamp=now.lamp, focus=focus), now.camera

    return draw_scenes(scenes(), len(times), size, theme, into)


def _actors(
    figure: Any, shown: ShownPlayback, times: np.ndarray, props: PropMeshes | None
) -> list[tuple[Any, ...]]:
    """Return a figure as it is shown at each of some times, with its props."""
    from app.stage.props import make_prop_actors
    from preview.scene import Actor

    rotations, positions = _placed(shown, times)
    faces: list[Any] = [None] * len(times)
    if figure.morphs:
        faces = [figure.morph_weights(face) for face in shown.faces(times)]
    return [
        (Actor(figure, *at), *(make_prop_actors(shown, props, at[:2]) if props is not None else ()))
        for at in zip(rotations, positions, faces, strict=True)
    ]


def _placed(shown: ShownPlayback, times: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return global rotations `[..., J, 4]` and positions `[..., J, 3]` at one time, or at many."""
    pose, skeleton = shown.pose(times), shown.skeleton
    assert pose is not None and skeleton is not None
    rotations, positions = skeleton.globals(pose)
    return (rotations, positions) if shown.stand is None else shown.stand.placed(rotations, positions)


def _actor(figure: Any, shown: ShownPlayback, times: Any) -> Any:
    """Return a figure as it is shown at one time, or at many."""
    from preview.scene import Actor

    morphs = (
        figure.morph_weights(shown.morphs(float(times))) if figure.morphs and np.ndim(times) == 0 else None
    )
    return Actor(figure, *_placed(shown, times), morphs)
