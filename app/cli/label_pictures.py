"""Draw the pictures of the label report: each clip in its clearest pose, each stance at rest."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from metagraph.graph.model import Project

SIZE = 192  # pixels


def draw_label_pictures(
    project: Project, folder: Path, clips: Sequence[str], tell: Callable[[int, int], None]
) -> Mapping[str, Any]:
    """Return clip or stance -> `[H, W, 4]` uint8; none if nothing can be drawn here. tell: called with how
    many clips are drawn, and of how many.
    """
    from app.cli.render_command import load_figure
    from metagraph.errors import FileError
    from preview.offscreen import Offscreen, OpenGLError
    from preview.thumbnail import ThumbnailStyle, draw_clip_thumbnail, render_thumbnail

    out: dict[str, Any] = {}
    style = ThumbnailStyle(SIZE, scale=1)
    try:
        figure = load_figure(project, folder)
        with Offscreen(SIZE, SIZE) as stage:
            for n, clip in enumerate(clips, 1):
                tell(n, len(clips))
                if (motion := project.clips[clip].motion) is not None:
                    out[clip] = draw_clip_thumbnail(stage, figure, motion, style)
            for graph in project.graphs.values():
                for stance in graph.stances:
                    rest = next(iter(graph.of(stance, "stance")), None)
                    motion = project.clips[rest.clip].motion if rest is not None else None
                    if rest is None or motion is None:
                        continue
                    start, end = project.span(rest)
                    frame = min(motion.frames - 1, round((start + end) / 2 * motion.fps))
                    pose = motion.skeleton.globals(motion.poses()[frame])
                    out[stance] = render_thumbnail(stage, figure, *pose, style)
    except (OpenGLError, FileError) as error:
        print(f"note: the report has no pictures: {error}", file=sys.stderr)
        return {}
    return out
