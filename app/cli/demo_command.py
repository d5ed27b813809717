"""`metagraph demo`: the main job without a window."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.cli.command_output import add_performance_arguments, choose_plan, open_for_command
from app.cli.progress_line import ProgressLine
from app.cli.render_command import Shot, draw_to, load_figure, mix_sound
from app.stage.playback_source import ShownPlayback
from metagraph.formats.store import SUFFIX
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import LAYERS

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips" / f"sample{SUFFIX}"


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "-o", "--out", type=Path, default=Path("out"), help="the folder to write into (default: out)"
    )
    add_performance_arguments(parser, 60.0)


def run(options: Namespace) -> int:
    """The main job without a window: graph, performance, contact sheet, video, export; say where the results
    are.
    """
    from metagraph.engines.export import export_project as write_export
    from metagraph.engines.export import make_export_stem
    from metagraph.formats.outputs import claim, note_written

    source: Path = getattr(options, "project", None) or SAMPLE
    project = open_for_command(source)
    folder = source.resolve().parent
    made = choose_plan(project, options)
    out: Path = options.out
    sheet, video = out / f"{project.name}.png", out / f"{project.name}.mp4"
    own = out / f"{make_export_stem(project)}.json", out / f"{make_export_stem(project)}.glb"
    claim(sheet, video, *own)
    out.mkdir(parents=True, exist_ok=True)
    whole = count_machine_size(project)
    cues = sum(len(made.layers[layer].cues) for layer in LAYERS)
    quiet = options.json
    if not quiet:
        print(f"{project.name}: {whole.clips} clips placed")
        print(f"expanded state machine: {whole.states} states, {whole.connections:,} connections")
        print(f"planned {made.end:g} s: {cues} actions on {len(LAYERS)} layers")
    shown = ShownPlayback(project, made, made.end)
    seen = [(load_figure(project, folder), shown)]
    draw_to(sheet, seen, Shot(made.end, (960, 540), 30, 24, "dark"))
    if not quiet:
        print(f"contact sheet  {sheet.resolve()}", flush=True)
    shot = Shot(made.end, (640, 360), 30, 0, "dark")
    line = ProgressLine(options, "Drawing pictures")
    draw_to(video, seen, shot, mix_sound(shown, folder, made.end), line.tell)
    if not quiet:
        print(f"video          {video.resolve()}", flush=True)
    exported = write_export(project, out, character=folder / project.character if project.character else None)
    note_written(*own)
    results = {"sheet": sheet, "video": video, "json": exported.json, "glb": exported.glb}
    if quiet:
        print(json.dumps({k: str(v.resolve()) for k, v in results.items()}))
    else:
        print(f"graph (JSON)   {exported.json.resolve()}\nclips (GLB)    {exported.glb.resolve()}")
    return 0
