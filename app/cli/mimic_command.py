"""`metagraph mimic`: recognise a person's stances in keypoints, a video or before a camera, and let the
character mimic them.
"""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser, Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.filmed_keypoints import add_camera_arguments, read_person
from app.cli.outputs import ProjectOutput
from metagraph.graph.words import LAYERS

if TYPE_CHECKING:
    from metagraph.graph.model import Project
    from metagraph.graph.requests import Performance
    from metagraph.mimicry.keypoint_layouts import KeypointTrack
    from metagraph.mimicry.performing import Mimicry
    from metagraph.playback.plan import Plan

OUT = (".mp4", ".png", ".glb", ".usda", ".bvh", ".json")
TAKES = (".bvh", ".glb")


def add_arguments(parser: ArgumentParser) -> None:
    """Add the command's options."""
    parser.add_argument(
        "keypoints",
        type=Path,
        nargs="?",
        help="a video of a person; or keypoints of OpenPose or MediaPipe: a JSON file, or a folder of "
        "OpenPose frames; or markers of motion capture (.trc, .c3d)",
    )
    add_camera_arguments(parser)
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        help=f"write it: a video, a contact sheet, motion, or the requests ({', '.join(OUT)})",
    )
    parser.add_argument("--keep", metavar="NAME", help="save the result as a performance of the project")
    parser.add_argument(
        "--take",
        type=Path,
        metavar="FILE",
        help=f"write the person's own motion on the project's skeleton, a take ({', '.join(TAKES)}); needs "
        "keypoints in three dimensions",
    )
    parser.add_argument(
        "--no-mirror",
        action="store_true",
        help="match left with left, instead of mirroring the person",
    )
    parser.add_argument(
        "--gaze", action="store_true", help="also make the character look where the person's head points"
    )
    parser.add_argument(
        "--layer", action="append", choices=LAYERS, help="mimic on this layer only; repeat for more"
    )
    parser.add_argument(
        "--fps", type=float, help="frames a second of keypoints that have no times (default: 30)"
    )
    parser.add_argument(
        "--picture",
        metavar="WxH",
        help="size of the camera's picture, for coordinates given as shares of it (default: 16:9)",
    )
    parser.add_argument(
        "--seed",
        type=int,
        help="random seed; another seed gives another performance (default: the project's seed)",
    )
    parser.add_argument(
        "--size", default="960x540", help="width x height of the pictures in pixels (default: 960x540)"
    )


def run(options: Namespace) -> int:
    """Print the stances in keypoints; write the performance to `out`, and save it as `keep`, if given."""
    from app.cli.render_command import read_size

    if options.out is not None and options.out.suffix not in OUT:
        name = options.out.suffix or options.out.name
        raise ValueError(f"the file can be {', '.join(OUT)}, not '{name}'")
    if options.take is not None and options.take.suffix not in TAKES:
        raise ValueError(f"a take can be written as {' or '.join(TAKES)}, not as '{options.take.suffix}'")
    picture = read_size(options.picture) if options.picture else None
    size = read_size(options.size)
    with ProjectOutput(options.project) if options.keep is not None else nullcontext() as output:
        return _mimicked(options, picture, size, output)


def _mimicked(
    options: Namespace,
    picture: tuple[int, int] | None,
    size: tuple[int, int],
    output: ProjectOutput | None,
) -> int:
    """output: the path at which the project is saved, or None."""
    from app.cli.command_output import open_for_command
    from metagraph.graph.requests import Performance
    from metagraph.mimicry.performing import REST, mimic_performance, place_requests

    project = open_for_command(options.project)
    seen = read_person(options, picture)
    source = _name_source(options)
    length = round(seen.seconds + REST, 3)
    new = Performance(name=options.keep or Path(source).stem, seed=options.seed, length=length)
    found = mimic_performance(
        project, seen, not options.no_mirror, options.layer or LAYERS, options.gaze, new
    )
    kept = place_requests(project, found.performance)
    made = _planned(project, kept)
    written = [
        str(x)
        for x in (
            _keep(output, project, kept),
            _write(options, project, kept, made, size),
            _take(options, project, seen),
        )
        if x is not None
    ]
    for note in seen.notes:
        print(f"note: {note}", file=sys.stderr)
    rows = _rows(project, found, made)
    if options.json:
        print(
            json.dumps({**_facts(options, seen), "seen": rows, "notes": list(seen.notes), "written": written})
        )
    else:
        print("\n".join(_lines(options, seen, rows, written)))
    return 0 if rows else 3


def _take(options: Namespace, project: Project, seen: KeypointTrack) -> Path | None:
    """Write the person's own motion, if it is wanted."""
    from metagraph.errors import FileError
    from metagraph.formats.bvh.file import write_bvh
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.mimicry.keypoint_take import KeypointTakeError, make_clip_from_keypoints

    path: Path | None = options.take
    if path is None:
        return None
    if project.skeleton is None:
        raise ValueError("a project without clips has no skeleton to move: import clips first")
    try:
        clip = make_clip_from_keypoints(
            seen if options.no_mirror else seen.mirrored(), project.skeleton, path.stem
        )
    except KeypointTakeError as error:
        raise FileError(
            _name_source(options), str(error).partition(": ")[0], "", str(error).partition(": ")[2]
        ) from None
    for note in clip.notes:
        print(f"note: {note}", file=sys.stderr)
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".bvh":
        write_bvh(clip, path)
    else:
        write_glb(path, [clip])
    return path


def _planned(project: Project, kept: Performance) -> Plan:
    from metagraph.playback.planning.running_plan import list_kept_asks, plan_performance

    return plan_performance(
        project, list_kept_asks(kept), kept.length, kept.seed, dict(kept.stances), kept.idle
    )


def _keep(output: ProjectOutput | None, project: Project, kept: Performance) -> Path | None:
    if output is None:
        return None
    from metagraph.graph.editing.performances import add_performance

    output.save(add_performance(project, kept)[0])
    return output.path


def _write(
    options: Namespace, project: Project, kept: Performance, made: Plan, size: tuple[int, int]
) -> Path | None:
    out: Path | None = options.out
    if out is None:
        return None
    if out.suffix == ".json":
        import msgspec

        from metagraph.formats.atomic import write_atomically

        write_atomically(out, msgspec.json.format(msgspec.json.encode(kept), indent=1))
        return out
    from app.cli.render_command import MOTION, Shot, bake_to, draw_to, load_figure
    from app.stage.playback_source import ShownPlayback

    folder, shown = options.project.resolve().parent, ShownPlayback(project, made, kept.length)
    if out.suffix in MOTION:
        bake_to(out, shown, kept.length, 30.0, folder)
    else:
        draw_to(out, [(load_figure(project, folder), shown)], Shot(kept.length, size, 30.0, 24, "dark"))
    return out


def _rows(project: Project, found: Mimicry, made: Plan) -> list[dict[str, Any]]:
    """Return what was seen and when, and when the character goes there, for each sighting."""
    from metagraph.playback.planning.extend_performance import answer_ask

    rows = []
    for sight in found.sightings:
        stance = project.stance(sight.stance)
        said = answer_ask(made, sight.id)
        rows.append(
            {
                "at": round(sight.at, 3),
                "layer": sight.layer,
                "stance": sight.stance,
                "name": stance.name if stance else sight.stance,
                "distance": round(sight.distance, 2),
                "again": sight.again,
                "state": said.state,
                "goes": None if said.at is None else round(said.at, 3),
                "there": None if said.until is None else round(said.until, 3),
            }
        )
    return rows


def _name_source(options: Namespace) -> str:
    return str(options.keypoints) if options.keypoints is not None else f"camera {options.camera}"


def _facts(options: Namespace, seen: KeypointTrack) -> dict[str, Any]:
    return {
        "keypoints": _name_source(options),
        "seconds": round(seen.seconds, 3),
        "frames": len(seen),
        "dimensions": seen.judged.dims,
        "mirrored": not options.no_mirror,
    }


def _lines(
    options: Namespace, seen: KeypointTrack, rows: list[dict[str, Any]], written: list[str]
) -> list[str]:
    how = "as in a mirror" if not options.no_mirror else "left as left"
    deep = "with depth" if seen.judged.dims == 3 else "without depth"
    out = [f"{_name_source(options)}: {len(seen)} frames, {seen.seconds:.1f} s, {deep}, {how}"]
    for row in rows:
        when = (
            f"goes there {row['goes']:.2f} s to {row['there']:.2f} s"
            if row["goes"] is not None
            else "is there already"
        )
        when = "cannot go there" if row["state"] == "refused" else when
        out.append(
            f"{row['at']:8.2f}  {row['layer']:5} {row['name']:20} {when}{' (again)' if row['again'] else ''}"
        )
    if not rows:
        out.append("the keypoints match no stance of the project")
    return [*out, *(f"written {path}" for path in written)]
