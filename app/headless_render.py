"""`metagraph render`: a performance, or one clip, as pictures, a video with sound, or plain motion."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from app.headless_common import opened, say, staged
from metagraph.graph.model import Project
from metagraph.playback.bake import bake
from metagraph.playback.plan import Plan
from metagraph.playback.player import morphs_at, pose_at


def figure_of(project: Project, folder: Path) -> Any:
    from preview.figure import SkinnedFigure, StickFigure

    assert project.skeleton is not None
    if project.character is not None:
        from metagraph.formats.gltf import read_character

        return SkinnedFigure(read_character(folder / project.character), project.skeleton)
    return StickFigure(project.skeleton)


def size_of(text: str) -> tuple[int, int]:
    try:
        width, height = (int(x) for x in text.lower().split("x"))
    except ValueError:
        raise ValueError(f"a size is given as 960x540, not {text!r}") from None
    if not (16 <= width <= 7680 and 16 <= height <= 7680):
        raise ValueError("a size lies between 16x16 and 7680x7680")
    return width, height


def pictures(
    project: Project, figure: Any, times: np.ndarray, made: Plan | None, clip: str | None, size: tuple[int, int], look: str
) -> Iterator[np.ndarray]:
    """Yield one picture `[H, W, 4]` for each time: of a plan, or of a clip alone. The camera holds still."""
    from preview.camera import whole_figure
    from preview.offscreen import Offscreen
    from preview.scene import THEMES, Actor, Scene

    assert project.skeleton is not None
    entry = project.clips[clip] if clip is not None else None

    def pose(at: np.ndarray) -> Any:
        if entry is not None:
            assert entry.motion is not None
            return entry.motion.pose_at(at)
        assert made is not None
        return pose_at(made, project, at)

    def morphs(at: float) -> Any:
        if not figure.morphs:
            return None
        if entry is not None and entry.motion is not None:
            return figure.morph_weights(entry.motion.morphs_at(at))
        assert made is not None
        return figure.morph_weights(morphs_at(made, project, at))

    skeleton = project.skeleton
    _, seen = skeleton.globals(pose(times[:: max(1, len(times) // 60)]))
    camera = whole_figure(figure.bounds(seen), size[0] / size[1])
    with Offscreen(*size) as offscreen:
        for at in times:
            rotations, positions = skeleton.globals(pose(np.asarray(at)))
            yield offscreen.render(Scene((Actor(figure, rotations, positions, morphs(float(at))),)), camera, THEMES[look])


def render(options: Namespace) -> int:
    project = opened(options.project)
    if project.skeleton is None:
        raise ValueError("the project has no clips; there is nothing to draw")
    if not 1 <= options.fps <= 240:
        raise ValueError("a video has 1 to 240 pictures a second")
    if not 2 <= options.frames <= 1000:
        raise ValueError("a contact sheet has 2 to 1000 pictures")
    if options.out.suffix not in (".png", ".mp4", ".glb", ".bvh"):
        name = options.out.suffix or options.out.name
        raise ValueError(f"pictures are written as .png, videos as .mp4, motion as .glb or .bvh, not as '{name}'")
    size = size_of(options.size)
    figure = figure_of(project, options.project.resolve().parent)
    clip = None
    if options.clip is not None:
        clip = next((e.id for e in project.clips.values() if options.clip in (e.name, e.id)), None)
        if clip is None or project.clips[clip].motion is None:
            raise ValueError(f"there is no clip '{options.clip}' in the project")
        options.seconds = project.clips[clip].duration
    made = staged(project, options) if clip is None else None
    seconds = options.seconds
    if options.out.suffix in (".glb", ".bvh"):
        bake_to(options.out, project, made, clip, seconds, options.fps, options.project.resolve().parent)
    else:
        sound = sound_of(project, options.project.resolve().parent, made, seconds) if options.out.suffix == ".mp4" else None
        draw_to(
            options.out, project, figure, made, clip, seconds, size, options.fps, options.frames, options.theme, sound, options.progress
        )
    say(options, f"{options.out}", {"written": str(options.out)})
    return 0


def sound_of(project: Project, folder: Path, made: Plan | None, seconds: float) -> tuple[np.ndarray, int] | None:
    """Return the sound of what is said in a performance, None where nothing is."""
    if made is None or not any(s.line and project.lines[s.line].audio for s in made.track.speeches if s.line in project.lines):
        return None
    from metagraph.speech.soundtrack import RATE, line_sounds, mixed, placed

    sounds, notes = line_sounds(project, folder)
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    return mixed(placed(made, sounds), 0, round(seconds * RATE)), RATE


def draw_to(
    out: Path, project: Project, figure: Any, made: Plan | None, clip: str | None, seconds: float, size: tuple[int, int],
    fps: float, frames: int, look: str, sound: tuple[np.ndarray, int] | None = None, progress: bool = False,
) -> None:  # fmt: skip
    """Write a contact sheet (.png) or a video (.mp4), with its sound."""
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".mp4":
        from preview.video import write_video

        times = np.arange(max(1, round(seconds * fps))) / fps

        def told(count: int) -> None:
            if progress:
                print(f"{count}/{len(times)}", file=sys.stderr, flush=True)

        write_video(out, pictures(project, figure, times, made, clip, size, look), fps, size, told, sound=sound)
    elif out.suffix == ".png":
        from preview.sheet import contact_sheet, write_png

        times = np.linspace(0, seconds, max(2, frames))
        small = (max(16, size[0] * 2 // 9), max(16, size[1] * 5 // 9))
        images = list(pictures(project, figure, times, made, clip, small, look))
        labels = [f"{t:.2f} s" + (f"  {_doing(made, t)}" if made is not None else "") for t in times]
        write_png(out, contact_sheet(images, 8, labels))
    else:
        raise ValueError(f"pictures are written as .png, videos as .mp4, not '{out.suffix}'")


def bake_to(out: Path, project: Project, made: Plan | None, clip: str | None, seconds: float, fps: float, folder: Path) -> None:
    """Write a performance, or a clip, as plain motion: what an engine or an animation program plays without a planner.

    A GLB has the character in it, where the project has one.
    """
    from metagraph.formats.bvh import write_bvh
    from metagraph.formats.gltf_writer import write_glb

    if clip is not None and project.clips[clip].motion is not None:
        motion = project.clips[clip].motion
    else:
        assert made is not None
        motion = bake(made, project, seconds, fps)
    assert motion is not None
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".bvh":
        write_bvh(motion, out)
    else:
        body = None
        if project.character is not None:
            from metagraph.formats.gltf import read_character

            body = read_character(folder / project.character)
            if body.skeleton != project.skeleton:
                body = None  # it would not move with this motion
        write_glb(out, [motion], body)


def _doing(made: Plan, seconds: float) -> str:
    cue = next((cue for layer in ("arms", "head", "body") if (cue := made.layers[layer].cue_at(seconds)) is not None), None)  # type: ignore[index]
    return cue.action.name if cue is not None else ""
