"""What the commands do. Each takes the parsed options and returns the exit code; Qt is imported by `window` alone."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace
from collections import Counter
from pathlib import Path
from typing import Any

from app.cli.annotate_command import annotate as annotate
from app.cli.command_output import opened, say, staged
from app.cli.export_command import export as export
from app.cli.label_command import label as label
from app.cli.live_command import live as live
from app.cli.mimic_command import mimic as mimic
from app.cli.motion_graph_command import motion_graph as motion_graph
from app.cli.render_command import draw_to, figure_of, sound_of
from app.cli.render_command import render as render
from app.cli.speech_command import speech as speech
from app.cli.study_command import study as study
from app.stage.playback_source import Shown
from metagraph.errors import FileError
from metagraph.formats.clips import SUFFIXES, read_clips
from metagraph.formats.imports import import_files
from metagraph.formats.store import SUFFIX, save_project
from metagraph.graph.check import check as find_problems
from metagraph.graph.expand import size
from metagraph.graph.model import KINDS, LAYERS, Project

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"


def has_screen() -> bool:
    """Return whether a window can be shown."""
    return not sys.platform.startswith("linux") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def window(options: Namespace) -> int:
    if options.project is not None and not options.project.is_file():
        raise FileError(options.project, "there is no such project", "on opening it", "Give a file ending in .metagraph.yaml.")
    if not has_screen() and os.environ.get("QT_QPA_PLATFORM") is None:
        if not options.json:
            print("There is no screen here, so the same job runs without a window.\n")
        return demo(Namespace(json=options.json, out=Path("out"), seconds=60.0, seed=None, performance=None, project=options.project))
    from app.main import run_window

    return run_window(options.project, options.sample)


def import_clips(options: Namespace) -> int:
    path: Path = options.project
    if path.is_file():
        project = opened(path)
    else:
        if path.suffix not in (".yaml", ".yml"):
            path = path.with_name(path.name + SUFFIX)
        project = Project(name=path.name.removesuffix(SUFFIX))
    show = sys.stderr.isatty() and not options.json

    def progress(done: int, total: int, file: Path) -> None:
        if show:
            print(f"\r{done}/{total} {file.name[:50]:<50}", end="", file=sys.stderr)

    result = import_files(project, path.resolve().parent, options.paths, progress, retarget="yes" if options.retarget else "no")
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
    data = {
        "project": str(path), "imported": len(result.loaded), "retargeted": result.retargeted, "failures": list(result.failures),
        "notes": list(result.notes),
    }  # fmt: skip
    brought = f" ({result.retargeted} retargeted)" if result.retargeted else ""
    say(options, f"{path}: {len(result.loaded)} clips imported{brought}, {len(result.failures)} files left out", data)
    if not result.loaded and result.failures:
        return 1
    return 3 if result.failures else 0


def check(options: Namespace) -> int:
    problems = find_problems(opened(options.project))
    counts = Counter(p.severity for p in problems)
    if options.json:
        fields = ("severity", "code", "message", "remedy", "layer", "stance", "action", "clip")
        print(json.dumps({"problems": [{f: getattr(p, f) for f in fields} for p in problems]}))
    else:
        for p in problems:
            print(f"{p.severity:8}{f'{p.layer}: ' if p.layer else ''}{p.message}\n        {p.remedy}")
        print(f"{counts['error']} errors, {counts['warning']} warnings, {counts['hint']} hints")
    return 3 if counts["error"] or (options.strict and counts["warning"]) else 0


def plan(options: Namespace) -> int:
    project = opened(options.project)
    made = staged(project, options)
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
        say(options, "\n".join(lines), data)
        return 0
    if path.suffix == ".json":
        from metagraph.engines.reading import read_export

        project = read_export(path, motions=False)
    else:
        project = opened(path)
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
    say(options, "\n".join(lines), data)
    return 0


def demo(options: Namespace) -> int:
    """The main job without a window: graph, performance, contact sheet, video, export; say where the results are."""
    from metagraph.engines.export import export as write_export

    source: Path = getattr(options, "project", None) or SAMPLE
    project = opened(source)
    folder = source.resolve().parent
    made = staged(project, options)
    out: Path = options.out
    out.mkdir(parents=True, exist_ok=True)
    whole = size(project)
    cues = sum(len(made.layers[layer].cues) for layer in LAYERS)
    quiet = options.json
    if not quiet:
        print(f"{project.name}: {whole.clips} clips placed")
        print(f"the machine nobody had to draw: {whole.states} states, {whole.connections:,} connections")
        print(f"planned {made.end:g} s: {cues} actions on {len(LAYERS)} layers")
    shown = Shown(project, made, made.end)
    seen = [(figure_of(project, folder), shown)]
    sheet, video = out / f"{project.name}.png", out / f"{project.name}.mp4"
    draw_to(sheet, seen, made.end, (960, 540), 30, 24, "dark")
    if not quiet:
        print(f"contact sheet  {sheet.resolve()}", flush=True)
    draw_to(video, seen, made.end, (640, 360), 30, 0, "dark", sound_of(shown, folder, made.end))
    if not quiet:
        print(f"video          {video.resolve()}", flush=True)
    exported = write_export(project, out, character=folder / project.character if project.character else None)
    results = {"sheet": sheet, "video": video, "json": exported.json, "glb": exported.glb}
    if quiet:
        print(json.dumps({k: str(v.resolve()) for k, v in results.items()}))
    else:
        print(f"graph (JSON)   {exported.json.resolve()}\nclips (GLB)    {exported.glb.resolve()}")
    return 0
