"""`metagraph render`: a performance, or one clip, as pictures, a video with sound, or plain motion."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, BooleanOptionalAction, Namespace
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from app.cli.command_output import add_performance_arguments, choose_plan, open_for_command, say
from app.cli.progress_line import ProgressLine
from app.look.names import name_node_rows
from app.stage.filming import Seen, make_project_figure, measure_bounds, render_pictures
from app.stage.playback_source import ASIDE, ShownPlayback, play_clip_alone
from metagraph.formats.outputs import claim, declare_inputs
from metagraph.formats.project.paths import list_project_files
from metagraph.graph.model import Layer, Project
from metagraph.motion.clip import Clip
from metagraph.playback.bake import bake

if TYPE_CHECKING:
    from app.stage.props import PropMeshes
    from metagraph.graph.timeline import Cut
    from metagraph.motion.character_mesh import CharacterMesh
    from metagraph.speech.captions import Caption
    from preview.scene import SceneTheme

VIDEOS = (".mp4", ".mov", ".webm")
MOTION = (".glb", ".usda", ".bvh", ".npz")  # what `bake_to` writes
NAMED = 12  # clips that an error lists at most


def add_arguments(parser: ArgumentParser) -> None:
    """Add the options."""
    add_performance_arguments(parser, 10.0)
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        help="the file to write: .png, .mp4, .mov (ProRes 4444), .webm (VP9), .glb, .usda, .bvh, or .npz "
        "(SMPL-H, as in AMASS)",
    )
    parser.add_argument(
        "--progress", action="store_true", help="report progress after each picture of a video"
    )
    parser.add_argument(
        "--start", type=float, default=0.0, help="second of the performance to start at (default: 0)"
    )
    parser.add_argument(
        "--bvh-order",
        type=str.upper,
        default="ZXY",
        choices=["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"],
        help="order of rotations in a .bvh file (default: ZXY; Xsens and Axis Neuron write YXZ)",
    )
    parser.add_argument(
        "--bvh-metres", action="store_true", help="write a .bvh file in metres (default: centimetres)"
    )
    parser.add_argument("--clip", help="draw only this clip of the project")
    parser.add_argument(
        "--conversation", metavar="NAME", help="draw this conversation: all its speakers, with their sound"
    )
    parser.add_argument(
        "--captions",
        action=BooleanOptionalAction,
        help="show captions (default: as set in the timeline)",
    )
    parser.add_argument(
        "--cuts",
        action=BooleanOptionalAction,
        help="follow the cuts of the conversation's camera lane, or keep one camera (default: follow "
        "them, if there are any)",
    )
    parser.add_argument("--size", default="960x540", help="width x height in pixels (default: 960x540)")
    parser.add_argument("--fps", type=float, default=30.0, help="frames a second of a video (default: 30)")
    parser.add_argument(
        "--frames",
        type=int,
        default=24,
        help="number of pictures on a contact sheet; 1 writes one picture, as large as --size (default: 24)",
    )
    parser.add_argument(
        "--sticks", action="store_true", help="draw a stick figure where a character has no mesh"
    )
    parser.add_argument("--theme", choices=("dark", "light"), default="dark")
    from preview.looks import BACKDROPS, LIGHTS, SEATS, STUDIO

    parser.add_argument("--light", choices=tuple(LIGHTS), default=STUDIO, help="the light")
    parser.add_argument(
        "--background",
        metavar="NAME",
        help=f"the background: {', '.join(BACKDROPS)}, studio, room, a colour such as #8090a0, or a PNG, "
        "JPEG or WebP file (default: the project's, else stage)",
    )
    parser.add_argument("--seat", choices=SEATS, default=SEATS[0], help="what a character sits on that sits")

    parser.add_argument(
        "--transparent",
        action="store_true",
        help="draw nothing behind the character: .png, .mov and .webm have alpha",
    )
    parser.add_argument(
        "--depth-of-field",
        action="store_true",
        help="blur what is nearer or farther than the face of who is framed",
    )


def load_figure(project: Project, folder: Path, sticks: bool = False) -> Any:
    """Return the figure that draws a project, and print a note if it is not the character's mesh. `sticks`
    draws a stick figure in place of the default body. Raises FileError.
    """
    from preview.figure import StickFigure

    figure = make_project_figure(project, folder, sticks)
    if figure.instead:
        kind = "a stick figure" if isinstance(figure, StickFigure) else "the default body"
        print(f"note: {figure.instead}; {kind} is drawn", file=sys.stderr)
    return figure


def load_props(shown: ShownPlayback, folder: Path) -> PropMeshes | None:
    """Return the meshes of the props of all projects that are shown, and print a note for each that cannot be
    drawn; None if there are none.
    """
    if not any(one.project.props for one in shown.everyone):
        return None
    from app.stage.props import PropMeshes, read_prop_meshes

    out = PropMeshes(folder)
    for one in shown.everyone:
        found, problems = read_prop_meshes(one.project, one.folder or folder)
        out.meshes.update(found.meshes)
        for problem in problems:
            print(f"note: {problem}", file=sys.stderr)
    return out


def make_render_look(
    project: Project, folder: Path, theme: str, light: str, background: str | None
) -> SceneTheme:
    """Return the light and the background of pictures. background: as `--background` has it, None for the
    project's. Raises FileError and ValueError.
    """
    from app.stage.backdrop import read_backdrop, set_backdrop
    from preview.looks import BACKDROPS, look_of

    if background is not None and background in BACKDROPS:
        return look_of(theme, light, background)
    if background is not None:
        found = read_backdrop(background, Path())
        if found is None:
            names = ", ".join((*BACKDROPS, "studio", "room"))
            raise ValueError(
                f"there is no background '{background}'; choose {names}, a colour such as #8090a0, "
                "or a picture"
            )
        project, folder = replace(project, backdrop=found), Path()
    return set_backdrop(look_of(theme, light), project, folder)


def read_size(text: str) -> tuple[int, int]:
    try:
        width, height = (int(x) for x in text.lower().split("x"))
    except ValueError:
        raise ValueError(f"give --size as 960x540, not {text!r}") from None
    if not (16 <= width <= 7680 and 16 <= height <= 7680):
        raise ValueError("--size must be between 16x16 and 7680x7680")
    return width, height


def render_directed(
    seen: Sequence[Seen],
    times: np.ndarray,
    size: tuple[int, int],
    look: SceneTheme | str,
    direction: Direction = ((), ()),
    into: np.ndarray | None = None,
    seat: str = "stool",
    props: PropMeshes | None = None,
) -> Iterator[np.ndarray]:
    """Yield pictures as `render_pictures` does, cut and with captions."""
    cuts, captions = direction
    camera: Callable[[float], Any] | None = None
    if cuts:
        from app.stage.cutting import Cutting, Filmed
        from preview.camera import make_whole_figure_camera

        aspect, cutting = size[0] / size[1], Cutting()
        whole = make_whole_figure_camera(measure_bounds(seen, times), aspect, ASIDE)
        camera = lambda at: cutting.camera(seen, cuts, at, aspect) or Filmed(whole)  # noqa: E731
    if not captions:
        yield from render_pictures(seen, times, size, look, camera, into, seat, props)
        return
    from app.cli.screenless import make_screenless_application
    from app.stage.caption_paint import add_captions
    from metagraph.speech.captions import find_captions_at

    # Text needs the fonts of an application, which a program without a window has not.
    application = make_screenless_application()
    pictures = render_pictures(seen, times, size, look, camera, into, seat, props)
    for at, picture in zip(times, pictures, strict=True):
        yield add_captions(picture, find_captions_at(captions, float(at)))
    del application


def _check_options(options: Namespace) -> None:
    """Raise ValueError for options that do not go together or are out of range."""
    if not 1 <= options.fps <= 240:
        raise ValueError("--fps must be 1 to 240")
    if not 1 <= options.frames <= 1000:
        raise ValueError("--frames must be 1 to 1000")
    if not 0 <= options.start <= 36000:
        raise ValueError("--start must be 0 to 36000 seconds")
    if options.out.suffix not in (".png", *VIDEOS, *MOTION):
        name = options.out.suffix or options.out.name
        raise ValueError(
            "pictures can be written as .png, videos as .mp4, .mov or .webm, motion as .glb, .usda, .bvh or "
            f".npz, not as '{name}'"
        )
    if options.transparent and options.out.suffix not in (".png", ".mov", ".webm"):
        raise ValueError(f"{options.out.suffix} has no transparency; write .png, .mov or .webm")
    if options.transparent and options.background is not None:
        raise ValueError("give --transparent or --background, not both")
    if options.transparent and options.depth_of_field:
        raise ValueError("give --transparent or --depth-of-field, not both")
    if options.out.suffix != ".bvh" and (options.bvh_order != "ZXY" or options.bvh_metres):
        raise ValueError("--bvh-order and --bvh-metres are for .bvh files")


def run(options: Namespace) -> int:
    project = open_for_command(options.project)
    if project.skeleton is None:
        raise ValueError("the project has no clips to draw")
    _check_options(options)
    size, folder = read_size(options.size), options.project.resolve().parent
    clip = None
    if options.clip is not None:
        found = [e.id for e in project.clips.values() if options.clip in (e.name, e.id)]
        if len(found) > 1:
            raise ValueError(
                f"{len(found)} clips are called '{options.clip}'; say which by its id: {', '.join(found)}"
            )
        clip = next(iter(found), None)
        if clip is None or project.clips[clip].motion is None:
            raise ValueError(
                f"there is no clip '{options.clip}' in the project; {_list_clips(project, options.clip)}"
            )
        options.start, options.seconds = 0.0, project.clips[clip].duration
    if options.conversation is not None:
        shown = _talking(project, options, folder)
    else:
        shown = (
            play_clip_alone(project, clip)
            if clip is not None
            else ShownPlayback(project, choose_plan(project, options), options.start + options.seconds)
        )
    for one in shown.everyone:
        declare_inputs(*list_project_files(one.project, one.folder or folder))
    props = load_props(shown, folder)
    if props is not None:
        from app.stage.prop_contacts import put_on_props

        shown = put_on_props(shown, props)
    if options.out.suffix in MOTION:
        claim(*_outs(options.out, shown))
        for one, out in zip(shown.everyone, _outs(options.out, shown), strict=True):
            style = options.bvh_order, options.bvh_metres
            bake_to(out, one, options.seconds, options.fps, one.folder or folder, options.start, style)
    else:
        seen = [
            (load_figure(one.project, one.folder or folder, options.sticks), one) for one in shown.everyone
        ]
        heard = options.out.suffix in VIDEOS
        sound = mix_sound(shown, folder, options.seconds, options.start) if heard else None
        if options.background is not None and Path(options.background).suffix:
            declare_inputs(Path(options.background))
        look = make_render_look(project, folder, options.theme, options.light, options.background)
        if options.transparent:
            look = replace(look, transparent=True)
        if options.depth_of_field:
            look = replace(look, blurred=True)
        direction = _direction(project, options, shown, folder, seen)
        shot = Shot(
            options.seconds,
            size,
            options.fps,
            options.frames,
            look,
            options.start,
            direction,
            options.seat,
            props,
        )
        draw_to(options.out, seen, shot, sound, _choose_progress(options))
    say(options, f"{options.out}", {"written": str(options.out)})
    return 0


Direction = tuple["tuple[Cut, ...]", "tuple[Caption, ...]"]  # where the camera cuts to, what is to be read


@dataclass(frozen=True)
class Shot:
    """How a performance is filmed: seconds, size in pixels, frames a second of a video or number of pictures
    of a contact sheet. start: second of the performance. direction: cuts and captions. seat: what
    a character sits on, one of `preview.looks.SEATS`. props: the meshes of props.
    """

    seconds: float
    size: tuple[int, int]
    fps: float
    frames: int
    look: SceneTheme | str
    start: float = 0.0
    direction: Direction = ((), ())
    seat: str = "stool"
    props: PropMeshes | None = None


def _list_clips(project: Project, wanted: str) -> str:
    """Return the names of a project's clips, in words: first those that have some of what was wanted in
    them.
    """
    names = sorted(
        {c.name for c in project.clips.values()}, key=lambda name: wanted.casefold() not in name.casefold()
    )
    more = f", and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"its clips are {', '.join(repr(n) for n in names[:NAMED])}{more}"


def _direction(
    project: Project, options: Namespace, shown: ShownPlayback, folder: Path, seen: Sequence[Seen]
) -> Direction:
    """Return the cuts and captions of a video, from the options or else from the timeline's notes."""
    from app.stage.cutting import list_captions
    from metagraph.graph.timeline_edits import get_timeline

    some = project.performances if options.conversation is None else project.conversations
    name = options.performance if options.conversation is None else options.conversation
    key = next((i for i, of in some.items() if name in (i, of.name)), "")
    noted = get_timeline(project, key)
    captions = noted.captions if options.captions is None else options.captions
    cuts = noted.cuts if options.cuts is not False and len(seen) > 1 else ()
    if options.cuts and not cuts and len(seen) > 1:
        from metagraph.speech.automatic_cuts import make_automatic_cuts

        cuts = make_automatic_cuts(project.conversations[key])
    talk = project.conversations.get(key) if options.conversation is not None else None
    return cuts, list_captions(shown, talk, folder) if captions else ()


def _talking(project: Project, options: Namespace, folder: Path) -> ShownPlayback:
    """Return all sides of a conversation of the project, named by id or name."""
    from app.stage.conversation_plans import ConversationPlans

    found = next((i for i, c in project.conversations.items() if options.conversation in (i, c.name)), None)
    if found is None:
        names = ", ".join(f"'{c.name}'" for c in project.conversations.values()) or "none"
        raise ValueError(f"there is no conversation '{options.conversation}' in the project; it has {names}")
    shown = ConversationPlans().show(project, found, folder)
    for note in shown.notes:
        print(f"note: {note}", file=sys.stderr)
    if options.seconds is None:
        options.seconds = max(0.1, shown.length - options.start)
    return shown


def _outs(out: Path, shown: ShownPlayback) -> list[Path]:
    """Return one file for each character that is shown, in the character's own space."""
    count = len(shown.everyone)
    return [out] if count == 1 else [out.with_stem(f"{out.stem}-{n + 1}") for n in range(count)]


def mix_sound(
    shown: ShownPlayback, folder: Path, seconds: float, start: float = 0.0
) -> tuple[np.ndarray, int] | None:
    """Return the sound of the speech from a start on, or None if nobody speaks."""
    lines = {
        s.line: line
        for one in shown.everyone
        for s in one.plan.track.speeches
        if s.line is not None and (line := one.project.lines.get(s.line)) is not None and line.audio
    }
    if not lines:
        return None
    from metagraph.speech.soundtrack import RATE, mix_track, place_line_sounds, place_lines

    sounds, notes = place_line_sounds(lines, folder)
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    return mix_track(
        [part for one in shown.everyone for part in place_lines(one.plan, sounds)],
        round(start * RATE),
        round(seconds * RATE),
    ), RATE


def _choose_progress(options: Namespace) -> Callable[[int, int], None]:
    """Return what says how far a video is: a line for each picture if asked for, else one on a terminal."""
    if not options.progress:
        return ProgressLine(options, "Drawing pictures").tell

    def tell(done: int, total: int) -> None:
        print(f"{done}/{total}", file=sys.stderr, flush=True)

    return tell


def draw_to(
    out: Path,
    seen: Sequence[Seen],
    shot: Shot,
    sound: tuple[np.ndarray, int] | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> None:
    """Write a contact sheet (.png), or a single picture, or a video with its sound. progress: called with how
    many pictures of a video are drawn, and of how many.
    """
    width, height = shot.size
    out.parent.mkdir(parents=True, exist_ok=True)
    clear = not isinstance(shot.look, str) and shot.look.transparent
    if out.suffix in VIDEOS:
        from preview.sheet import make_straight_alpha
        from preview.video import write_video

        times = shot.start + np.arange(max(1, round(shot.seconds * shot.fps))) / shot.fps

        into = np.empty((height, width, 4), np.uint8)
        drawn = render_directed(
            seen, times, shot.size, shot.look, shot.direction, into, shot.seat, shot.props
        )
        if clear:
            drawn = map(make_straight_alpha, drawn)
        write_video(out, drawn, shot.fps, shot.size, lambda count: progress(count, len(times)), sound=sound)
    elif out.suffix == ".png":
        from preview.sheet import PAPER, make_contact_sheet, make_straight_alpha, write_png

        times = shot.start + np.linspace(0, shot.seconds, max(1, shot.frames))
        small = (max(16, width * 2 * min(len(seen), 2) // 9), max(16, height * 5 // 9))
        small = shot.size if len(times) == 1 else small
        images = list(
            render_directed(seen, times, small, shot.look, shot.direction, None, shot.seat, shot.props)
        )
        images = [make_straight_alpha(image) for image in images] if clear else images
        if len(images) == 1:
            write_png(out, images[0] if clear else images[0][..., :3])
            return
        labels = [
            f"{t:.2f} s  {', '.join(filter(None, (_doing(shown, t) for _, shown in seen)))}".rstrip()
            for t in times
        ]
        paper = None if clear else PAPER
        write_png(out, make_contact_sheet(images, 8 // min(len(seen), 2), labels, paper=paper))
    else:
        raise ValueError(f"pictures are written as .png, videos as .mp4, .mov or .webm, not '{out.suffix}'")


def bake_to(
    out: Path,
    shown: ShownPlayback,
    seconds: float,
    fps: float,
    folder: Path,
    start: float = 0.0,
    bvh: tuple[str, bool] = ("ZXY", False),
) -> None:
    """Write a performance, or a clip, as plain motion: what an engine or an animation program plays without a
    planner. bvh: the order of rotations in a BVH file, and whether it is in metres.

    A GLB and a USD stage have the character in them, where the project has one.
    """
    from metagraph.formats.bvh.file import BvhStyle, write_bvh
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.formats.smpl_writer import write_smpl
    from metagraph.formats.usd.writer import write_usd

    project = shown.project
    whole = shown.clip or shown.motion
    if whole is None or (shown.clip is None and project.clips[whole].made_by):
        assert shown.evaluator is not None
        motion: Clip | None = bake(shown.evaluator, project, seconds, fps, start)
    else:
        motion = project.clips[whole].motion
    assert motion is not None
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix == ".bvh":
        write_bvh(motion, out, BvhStyle(*bvh))
    elif out.suffix == ".npz":
        write_smpl(motion, out)
    else:
        body = read_body(project, folder)
        if out.suffix == ".usda":
            write_usd(out, motion.skeleton, [motion], body)
        else:
            write_glb(out, [motion], body)


def read_body(project: Project, folder: Path) -> CharacterMesh | None:
    """Return the character that a project's motion moves; None if it has none, or one of another
    skeleton.
    """
    if project.character is None:
        return None
    from metagraph.formats.gltf.reader import read_character

    body = read_character(folder / project.character).without(project.hidden)
    return body if body.skeleton == project.skeleton and len(body.triangles) else None


def _doing(shown: ShownPlayback, seconds: float) -> str:
    """Return the name of what plays, as its node has it. For a character that a clip moves instead of the
    plan, return what the plan still says.
    """
    layers: tuple[Layer, ...] = ("arms", "head", "body")
    if shown.motion is not None:
        layers = ("body",) if shown.project.clips[shown.motion].made_by else ()
    lanes = shown.plan.layers
    cue = next((cue for n in layers if (cue := lanes[n].cue_at(seconds)) is not None), None)
    if cue is None:
        return ""
    action = cue.action
    return name_node_rows(shown.project, action.layer, action.stance, action.kind).get(action.id, action.name)
