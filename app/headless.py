"""What the commands do. Each takes the parsed options and returns the exit code; Qt is imported by `window` alone."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from app.headless_annotate import annotate as annotate
from app.headless_live import live as live
from app.opening import open_whole
from metagraph.errors import FileError
from metagraph.formats.clips import SUFFIXES, read_clips
from metagraph.formats.imports import import_files
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.asks import Performance
from metagraph.graph.check import check as find_problems
from metagraph.graph.expand import size
from metagraph.graph.model import KINDS, LAYERS, Project
from metagraph.playback.bake import bake
from metagraph.playback.hear import perform
from metagraph.playback.plan import Plan
from metagraph.playback.planner import make_plan
from metagraph.playback.player import morphs_at, pose_at

SAMPLE = Path(__file__).resolve().parents[1] / "sample_clips" / f"sample{SUFFIX}"

LONGEST = 24 * 3600  # seconds of one performance


def _say(options: Namespace, words: str, data: Any) -> None:
    print(json.dumps(data) if options.json else words)


def _open(path: Path) -> Project:
    opened = open_whole(path)
    for note in opened.notes:
        print(f"note: {note}", file=sys.stderr)
    return opened.project


def has_screen() -> bool:
    """Return whether a window can be shown."""
    return not sys.platform.startswith("linux") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def window(options: Namespace) -> int:
    if options.project is not None and not options.project.is_file():
        raise FileError(options.project, "there is no such project", "on opening it", "Give a file ending in .metagraph.yaml.")
    if not has_screen() and os.environ.get("QT_QPA_PLATFORM") is None:
        if not options.json:
            print("There is no screen here, so the same job runs without a window.\n")
        return demo(Namespace(json=options.json, out=Path("out"), seconds=60.0, seed=None, project=options.project))
    from app.main import run_window

    return run_window(options.project, options.sample)


def import_clips(options: Namespace) -> int:
    path: Path = options.project
    if path.is_file():
        project = _open(path)
    else:
        if path.suffix not in (".yaml", ".yml"):
            path = path.with_name(path.name + SUFFIX)
        project = Project(name=path.name.removesuffix(SUFFIX))
    show = sys.stderr.isatty() and not options.json

    def progress(done: int, total: int, file: Path) -> None:
        if show:
            print(f"\r{done}/{total} {file.name[:50]:<50}", end="", file=sys.stderr)

    result = import_files(project, path.resolve().parent, options.paths, progress)
    if show:
        print(file=sys.stderr)
    for failure in result.failures:
        print(f"left out: {failure}", file=sys.stderr)
    if not options.json:
        for note in result.notes:
            print(f"note: {note}", file=sys.stderr)
    if result.loaded:
        project = result.into(project)
        save_project(project, path, path)
    data = {"project": str(path), "imported": len(result.loaded), "failures": list(result.failures), "notes": list(result.notes)}
    _say(options, f"{path}: {len(result.loaded)} clips imported, {len(result.failures)} files left out", data)
    if not result.loaded and result.failures:
        return 1
    return 3 if result.failures else 0


def check(options: Namespace) -> int:
    problems = find_problems(_open(options.project))
    counts = Counter(p.severity for p in problems)
    if options.json:
        fields = ("severity", "code", "message", "remedy", "layer", "stance", "action", "clip")
        print(json.dumps({"problems": [{f: getattr(p, f) for f in fields} for p in problems]}))
    else:
        for p in problems:
            print(f"{p.severity:8}{f'{p.layer}: ' if p.layer else ''}{p.message}\n        {p.remedy}")
        print(f"{counts['error']} errors, {counts['warning']} warnings, {counts['hint']} hints")
    return 3 if counts["error"] or (options.strict and counts["warning"]) else 0


def _plan(project: Project, options: Namespace) -> Plan:
    """Return the performance that is asked for, or an improvised one; its length goes into the options."""
    kept = _kept(project, options.performance) if options.performance is not None else None
    if options.seconds is None:
        options.seconds = kept.length if kept is not None else options.usual_seconds
    if not 0 < options.seconds <= LONGEST:
        raise ValueError(f"a performance lasts more than 0 and at most {LONGEST} seconds")
    if kept is None:
        return make_plan(project, options.seconds, seed=options.seed)
    seed = kept.seed if options.seed is None else options.seed
    return perform(project, kept.asks, options.seconds, seed, dict(kept.stances), kept.idle)


def _kept(project: Project, name: str) -> Performance:
    found = next((p for i, p in project.performances.items() if name in (i, p.name)), None)
    if found is None:
        names = ", ".join(f"'{p.name}'" for p in project.performances.values()) or "none"
        raise ValueError(f"there is no performance '{name}' in the project; it keeps {names}")
    return found


def plan(options: Namespace) -> int:
    project = _open(options.project)
    made = _plan(project, options)
    rows = [
        {"layer": layer, "start": round(cue.start, 4), "end": round(cue.end, 4), "kind": cue.action.kind, "action": cue.action.id,
         "name": cue.action.name, "stance": cue.stance, "then": cue.then}
        for layer in LAYERS for cue in made.layers[layer].cues
    ]  # fmt: skip
    if options.json:
        reports = [{"request": r.request, "outcome": r.outcome, "message": r.message, "layer": r.layer} for r in made.reports]
        print(json.dumps({"seed": made.seed, "end": made.end, "cues": rows, "reports": reports}))
        return 0
    for row in sorted(rows, key=lambda r: (r["start"], r["layer"])):
        print(f"{row['start']:8.2f} {row['end']:8.2f}  {row['layer']:5} {row['kind']:11} {row['name']}")
    if not rows:
        print("Nothing plays: no layer has a stance with a loop and actions around it.", file=sys.stderr)
    return 0


def _figure(project: Project, folder: Path) -> Any:
    from preview.figure import SkinnedFigure, StickFigure

    assert project.skeleton is not None
    if project.character is not None:
        from metagraph.formats.gltf import read_character

        return SkinnedFigure(read_character(folder / project.character), project.skeleton)
    return StickFigure(project.skeleton)


def _size(text: str) -> tuple[int, int]:
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
    project = _open(options.project)
    if project.skeleton is None:
        raise ValueError("the project has no clips; there is nothing to draw")
    if not 1 <= options.fps <= 240:
        raise ValueError("a video has 1 to 240 pictures a second")
    if not 2 <= options.frames <= 1000:
        raise ValueError("a contact sheet has 2 to 1000 pictures")
    if options.out.suffix not in (".png", ".mp4", ".glb", ".bvh"):
        name = options.out.suffix or options.out.name
        raise ValueError(f"pictures are written as .png, videos as .mp4, motion as .glb or .bvh, not as '{name}'")
    size = _size(options.size)
    figure = _figure(project, options.project.resolve().parent)
    clip = None
    if options.clip is not None:
        clip = next((e.id for e in project.clips.values() if options.clip in (e.name, e.id)), None)
        if clip is None or project.clips[clip].motion is None:
            raise ValueError(f"there is no clip '{options.clip}' in the project")
        options.seconds = project.clips[clip].duration
    made = _plan(project, options) if clip is None else None
    seconds = options.seconds
    if options.out.suffix in (".glb", ".bvh"):
        bake_to(options.out, project, made, clip, seconds, options.fps)
    else:
        sound = _sound(project, options.project.resolve().parent, made, seconds) if options.out.suffix == ".mp4" else None
        draw_to(options.out, project, figure, made, clip, seconds, size, options.fps, options.frames, options.theme, sound)
    _say(options, f"{options.out}", {"written": str(options.out)})
    return 0


def _sound(project: Project, folder: Path, made: Plan | None, seconds: float) -> tuple[np.ndarray, int] | None:
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
    fps: float, frames: int, look: str, sound: tuple[np.ndarray, int] | None = None,
) -> None:  # fmt: skip
    """Write a contact sheet (.png) or a video (.mp4), with its sound."""
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".mp4":
        from preview.video import write_video

        times = np.arange(max(1, round(seconds * fps))) / fps
        write_video(out, pictures(project, figure, times, made, clip, size, look), fps, size, sound=sound)
    elif out.suffix == ".png":
        from preview.sheet import contact_sheet, write_png

        times = np.linspace(0, seconds, max(2, frames))
        small = (max(16, size[0] * 2 // 9), max(16, size[1] * 5 // 9))
        images = list(pictures(project, figure, times, made, clip, small, look))
        labels = [f"{t:.2f} s" + (f"  {_doing(made, t)}" if made is not None else "") for t in times]
        write_png(out, contact_sheet(images, 8, labels))
    else:
        raise ValueError(f"pictures are written as .png, videos as .mp4, not '{out.suffix}'")


def bake_to(out: Path, project: Project, made: Plan | None, clip: str | None, seconds: float, fps: float) -> None:
    """Write a performance, or a clip, as plain motion: what an engine or an animation program plays without a planner."""
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
        write_glb(out, [motion])


def _doing(made: Plan, seconds: float) -> str:
    cue = next((cue for layer in ("arms", "head", "body") if (cue := made.layers[layer].cue_at(seconds)) is not None), None)  # type: ignore[index]
    return cue.action.name if cue is not None else ""


def export(options: Namespace) -> int:
    from metagraph.engines.export import export as write

    project = _open(options.project)
    character = options.project.resolve().parent / project.character if project.character else None
    made = write(project, options.out, options.expanded, not options.no_mesh, character)
    for warning in made.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    _say(
        options,
        f"{made.json}\n{made.glb}",
        {"json": str(made.json), "glb": str(made.glb), "clips": made.clips, "warnings": list(made.warnings)},
    )
    return 0


def info(options: Namespace) -> int:
    path: Path = options.path
    if path.suffix.lower() in SUFFIXES:
        clips = read_clips(path)
        from metagraph.motion.roles import find_roles

        roles = find_roles(clips[0].skeleton)
        joints = clips[0].skeleton.names
        data: dict[str, Any] = {
            "joints": len(joints),
            "height": round(clips[0].skeleton.height, 3),
            "clips": [
                {"name": c.name, "frames": c.frames, "fps": c.fps, "seconds": round(c.duration, 3), "notes": list(c.notes)} for c in clips
            ],
            "roles": {role: joints[j] for role, j in roles.items()},
        }
        lines = [f"{path.name}: {len(clips)} clips on {len(joints)} joints, {data['height']} m tall"]
        lines += [f"  {c.name:40} {c.duration:7.2f} s  {c.frames:5} frames at {c.fps:g} fps" for c in clips]
        _say(options, "\n".join(lines), data)
        return 0
    if path.suffix == ".json":
        from metagraph.engines.export import read_export

        project = read_export(path, motions=False)
    else:
        project = _open(path)
    whole = size(project)
    layers = {
        layer: {
            "stances": len(project.graphs[layer].stances),
            **{k: sum(a.kind == k for a in project.graphs[layer].actions.values()) for k in KINDS},
        }
        for layer in LAYERS
    }
    data = {"name": project.name, "clips": len(project.clips), "placed": whole.clips, "states": whole.states,
            "connections": whole.connections, "joints": len(project.skeleton) if project.skeleton else 0, "layers": layers}  # fmt: skip
    lines = [f"{project.name}: {len(project.clips)} clips, {whole.clips} placed, {data['joints']} joints"]
    for layer, counts in layers.items():
        lines.append(
            f"  {layer:5} " + ", ".join(f"{n} {k.removesuffix('s')}{'s' if n != 1 else ''}" for k, n in counts.items() if k != "stance")
        )
    lines.append(f"  the machine it stands for: {whole.states} states, {whole.connections} connections")
    _say(options, "\n".join(lines), data)
    return 0


def demo(options: Namespace) -> int:
    """The main job without a window: graph, performance, contact sheet, video, export; say where the results are."""
    from metagraph.engines.export import export as write

    source: Path = getattr(options, "project", None) or SAMPLE
    project = _open(source)
    folder = source.resolve().parent
    made = _plan(project, options)
    out: Path = options.out
    out.mkdir(parents=True, exist_ok=True)
    whole = size(project)
    cues = sum(len(made.layers[layer].cues) for layer in LAYERS)
    quiet = options.json
    if not quiet:
        print(f"{project.name}: {whole.clips} clips placed")
        print(f"the machine nobody had to draw: {whole.states} states, {whole.connections:,} connections")
        print(f"planned {made.end:g} s: {cues} actions on {len(LAYERS)} layers")
    figure = _figure(project, folder)
    sheet, video = out / f"{project.name}.png", out / f"{project.name}.mp4"
    draw_to(sheet, project, figure, made, None, made.end, (960, 540), 30, 24, "dark")
    if not quiet:
        print(f"contact sheet  {sheet.resolve()}", flush=True)
    draw_to(video, project, figure, made, None, made.end, (640, 360), 30, 0, "dark", _sound(project, folder, made, made.end))
    if not quiet:
        print(f"video          {video.resolve()}", flush=True)
    exported = write(project, out, character=folder / project.character if project.character else None)
    results = {"sheet": sheet, "video": video, "json": exported.json, "glb": exported.glb}
    if quiet:
        print(json.dumps({k: str(v.resolve()) for k, v in results.items()}))
    else:
        print(f"graph (JSON)   {exported.json.resolve()}\nclips (GLB)    {exported.glb.resolve()}")
    return 0
