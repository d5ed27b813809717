"""Draws portraits of characters in a pose of the project's clips."""

from __future__ import annotations

import pickle
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.project.files import SAMPLE
from app.stage.picture_process import PictureOrder
from app.translation import tr, tr_error, tr_phrase
from metagraph.common.programs import make_python_command, start
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.fitting.footing import Footing

EDGE = 2  # pixels round a figure


@dataclass(frozen=True)
class Portrait:
    """picture: `[N, N, 4]` uint8, cut to the figure, None without OpenGL. refused: in words, why the
    character cannot be drawn.
    """

    picture: Any = None
    refused: str = ""


def find_still(project: Project) -> Clip | None:
    """Return one frame of the clip that shows the project's characters best: of the base pose, a stance, or
    any.
    """
    stances = [a.clip for a in project.actions() if a.kind == "stance"]
    for ident in (project.base.clip, *stances, *project.clips):
        entry = project.clips.get(ident or "")
        if entry is not None and entry.motion is not None and entry.motion.skeleton == project.skeleton:
            return _first_frame(entry.motion)
    return None


def _first_frame(clip: Clip) -> Clip:
    return replace(
        clip, rotations=clip.rotations[:1], translations=clip.translations[:1], morphs=(), weights=None
    )


def draw_portraits(
    files: Sequence[Path | None], clip: Clip | None, theme: str, footing: Footing | None
) -> list[Portrait]:
    """Return for each file a picture `[H, W, 4]` of its character in a clip's pose, None without OpenGL, and
    in words why it cannot be drawn, None if it can. file: None is the default body. clip: None is a stance of
    the sample.
    """
    from metagraph.formats.characters import look_at
    from metagraph.formats.clips import read_clips

    if clip is None:
        clip = _first_frame(read_clips(SAMPLE.parent / "clips" / "hands_at_sides__stance.glb")[0])
    refused: list[str] = []
    for file in files:
        try:
            found = look_at(str(file), None, clip.skeleton) if file is not None else None
            why = found.why_not if found is not None else None
            refused.append("" if why is None else tr("Its mesh {why}.", why=tr_phrase(why)))
        except FileError as error:
            refused.append(tr_error(error))
    orders = [
        PictureOrder(number, clip, "moving", theme, None, file, (), footing)
        for number, file in enumerate(files)
        if not refused[number]
    ]
    pictures = _draw(orders)
    return [Portrait(pictures.get(number), why) for number, why in enumerate(refused)]


def _draw(orders: Sequence[PictureOrder]) -> dict[int, Any]:
    """Return the first picture of each order by its number, none without OpenGL."""
    process = start(
        make_python_command("app.stage.picture_process"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    out: dict[int, Any] = {}
    with process:
        assert process.stdin is not None and process.stdout is not None
        try:
            for order in orders:
                pickle.dump(order, process.stdin)
            process.stdin.flush()
            while len(out) < len(orders):
                number, pictures = pickle.load(process.stdout)
                if pictures is not None:
                    out[number] = _cut(pictures[0])
        except (EOFError, OSError, pickle.UnpicklingError):
            pass
        finally:
            process.kill()
    return out


def _cut(picture: Any) -> Any:
    """Return the smallest square `[N, N, 4]` round the figure of a picture that is transparent elsewhere."""
    rows, columns = np.nonzero(picture[..., 3])
    if not len(rows):
        return picture
    side = int(max(np.ptp(rows), np.ptp(columns))) + 1 + 2 * EDGE
    out = np.zeros((side, side, 4), np.uint8)
    top, left = rows.min(), columns.min()
    found = picture[top : rows.max() + 1, left : columns.max() + 1]
    y, x = ((side - size) // 2 for size in found.shape[:2])
    out[y : y + found.shape[0], x : x + found.shape[1]] = found
    return out
