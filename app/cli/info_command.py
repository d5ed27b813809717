"""`metagraph info`: what is in a project, an export or a clip file."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from app.cli.command_output import open_for_command, say
from app.cli.journal_note import warn_of_journals
from metagraph.errors import FileError
from metagraph.formats.clip_readers import list_clip_suffixes
from metagraph.formats.clips import read_clips
from metagraph.graph.expand import count_machine_size
from metagraph.graph.model import KINDS, LAYERS


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("path", type=Path, help="a project, an exported JSON, or a clip file")


def run(options: Namespace) -> int:
    path: Path = options.path
    if path.is_dir():
        raise FileError(
            path,
            "is a folder",
            "the path",
            "Give a project, an exported JSON or a clip file in it; 'metagraph verify' takes a folder.",
        )
    if path.suffix.lower() in list_clip_suffixes():
        clips = read_clips(path)
        from metagraph.motion.roles import find_roles

        roles = find_roles(clips[0].skeleton)
        joints = clips[0].skeleton.names
        data: dict[str, Any] = {
            "joints": len(joints),
            "height": round(clips[0].skeleton.height, 3),
            "clips": [
                {
                    "name": c.name,
                    "frames": c.frames,
                    "fps": c.fps,
                    "seconds": round(c.duration, 3),
                    "notes": list(c.notes),
                }
                for c in clips
            ],
            "roles": {role: joints[j] for role, j in roles.items()},
        }
        many = "1 clip" if len(clips) == 1 else f"{len(clips)} clips"
        lines = [f"{path.name}: {many} on {len(joints)} joints, which reach {data['height']} m high"]
        lines += [f"  {c.name:40} {c.duration:7.2f} s  {c.frames:5} frames at {c.fps:g} fps" for c in clips]
        say(options, "\n".join(lines), data)
        return 0
    if path.suffix == ".json":
        from metagraph.engines.reading import find_export_glb, read_export

        project = read_export(path, motions=False)
        find_export_glb(path)  # raises where it is another's
    else:
        project = open_for_command(path)
        warn_of_journals(path)
    whole = count_machine_size(project)
    layers = {
        layer: {
            "stances": len(project.graphs[layer].stances),
            **{k: sum(a.kind == k for a in project.graphs[layer].actions.values()) for k in KINDS},
        }
        for layer in LAYERS
    }
    data = {
        "name": project.name,
        "clips": len(project.clips),
        "placed": whole.clips,
        "states": whole.states,
        "connections": whole.connections,
        "joints": len(project.skeleton) if project.skeleton else 0,
        "layers": layers,
    }
    many = "1 clip" if len(project.clips) == 1 else f"{len(project.clips)} clips"
    lines = [f"{project.name}: {many}, {whole.clips} placed, {data['joints']} joints"]
    for layer, counts in layers.items():
        lines.append(
            f"  {layer:5} "
            + ", ".join(
                f"{n} {k.removesuffix('s')}{'s' if n != 1 else ''}"
                for k, n in counts.items()
                if k != "stance"
            )
        )
    lines.append(f"  the machine it stands for: {whole.states} states, {whole.connections} connections")
    say(options, "\n".join(lines), data)
    return 0
