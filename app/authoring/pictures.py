"""Draw what plays for a program that looks: clips in their clearest poses, and strips of moments."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from msgspec import Meta, Struct

from app.authoring.finding import find_actions, find_clips, name_stance
from app.authoring.tool import AuthorError, AuthorTool, ToolOutcome, ToolWork
from app.stage.filming import make_project_figure, render_pictures
from app.stage.playback_source import ShownPlayback, play_clip_alone, play_in_context
from metagraph.graph.model import LAYERS, Project
from metagraph.playback.planning.running_plan import improvise, list_kept_asks, plan_performance

SIZE = 192  # pixels of a clip's picture
LONGEST = 3600.0  # seconds of a performance that may be looked at
COLUMNS = 6


class LookCall(Struct, forbid_unknown_fields=True, omit_defaults=True):
    """What to look at: one of `clip`, `action` and `performance`, or nothing for what plays by itself. at:
    seconds from its beginning. seconds: look on for so long; 0 looks at one moment. pictures: how many of
    them. width: pixels of each.
    """

    clip: str | None = None
    action: str | None = None
    performance: str | None = None
    at: Annotated[float, Meta(ge=0, le=LONGEST)] = 0.0
    seconds: Annotated[float, Meta(ge=0, le=LONGEST)] = 0.0
    pictures: Annotated[int, Meta(ge=1, le=24)] = 1
    width: Annotated[int, Meta(ge=64, le=960)] = 320
    seed: int | None = None


class Moment(Struct, omit_defaults=True):
    """A moment that was drawn. playing: the action of each layer, the stance where none plays."""

    at: float
    playing: dict[str, str]


class LookReport(Struct, omit_defaults=True):
    """What is on the picture: its moments, from left to right and top to bottom. length: seconds of what was
    looked at. notes: how it is drawn.
    """

    moments: list[Moment]
    length: float
    notes: list[str] = []


def _look(work: ToolWork, given: LookCall) -> ToolOutcome:
    """Draw a moment, or a strip of several, as one picture."""
    shown = _find_shown(work.project, given)
    if shown.skeleton is None:
        raise AuthorError("there is nothing to draw: the project has no clips. import_clips brings some")
    if given.at > shown.length:
        raise AuthorError(f"at: it lasts {shown.length:.2f} s, so nothing plays at {given.at:g} s")
    end = min(given.at + given.seconds, shown.length)
    count = max(2, given.pictures) if given.seconds > 0 else 1
    times = np.linspace(given.at, end, count)
    figure = _make_figure(work)
    size = (given.width, round(given.width * 9 / 8))
    drawn = []
    try:
        for picture in render_pictures([(figure, shown)], times, size, "dark"):
            drawn.append(picture.copy())
            work.report(len(drawn), count, f"drew {len(drawn)} of {count} pictures")
    except RuntimeError as error:
        raise _explain(error) from error
    labels = [f"{t:.2f} s" for t in times]
    told = LookReport(
        [Moment(round(float(t), 3), _name_playing(shown, float(t))) for t in times],
        round(shown.length, 3),
        [str(figure.instead)] if figure.instead else [],
    )
    return ToolOutcome(told, pictures=(_make_strip(drawn, labels),))


def draw_clips(work: ToolWork, clips: Sequence[str]) -> tuple[dict[str, bytes], list[str]]:
    """Return a PNG for each clip that can be drawn, and why others cannot."""
    from preview.offscreen import Offscreen
    from preview.thumbnail import ThumbnailStyle, draw_clip_thumbnail

    project, out = work.project, dict[str, bytes]()
    if project.skeleton is None:
        return {}, ["there is nothing to draw: the project has no clips"]
    figure, style = _make_figure(work), ThumbnailStyle(SIZE, scale=1)
    strangers = []
    try:
        with Offscreen(SIZE, SIZE) as stage:
            for number, clip in enumerate(clips):
                work.report(number, len(clips), f"drawing clip {number + 1} of {len(clips)}")
                motion = project.clips[clip].motion
                if motion is None or motion.skeleton != project.skeleton:
                    strangers.append(project.clips[clip].name)
                    continue
                out[clip] = encode_png(draw_clip_thumbnail(stage, figure, motion, style))
    except RuntimeError as error:
        raise _explain(error) from error
    lacking = f"not drawn, because their files or skeletons are missing: {', '.join(strangers)}"
    return out, [lacking] if strangers else []


def encode_png(picture: Any) -> bytes:
    """Return a picture, uint8 `[H, W, 3 or 4]`, as a PNG file."""
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture)).save(out, "PNG", compress_level=6)
    return out.getvalue()


def _make_strip(drawn: Sequence[Any], labels: Sequence[str]) -> bytes:
    from preview.sheet import make_contact_sheet

    return encode_png(make_contact_sheet(drawn, min(COLUMNS, len(drawn)), labels))


def _make_figure(work: ToolWork) -> Any:
    return make_project_figure(work.project, work.folder)


def _explain(error: RuntimeError) -> Exception:
    """Return why nothing can be drawn, for a model."""
    from preview.offscreen import OpenGLError

    if not isinstance(error, OpenGLError):
        return error
    return AuthorError(f"no picture can be drawn on this computer: {error}. Measures work without pictures")


def _find_shown(project: Project, given: LookCall) -> ShownPlayback:
    """Return what is to be looked at. Raises AuthorError."""
    named = [x for x in (given.clip, given.action, given.performance) if x is not None]
    if len(named) > 1:
        raise AuthorError("name one of clip, action and performance, not several")
    if given.clip is not None:
        (clip,) = find_clips(project, [given.clip])
        if project.clips[clip].motion is None:
            raise AuthorError(f"the file of clip '{project.clips[clip].name}' is missing")
        return play_clip_alone(project, clip)
    if given.action is not None:
        (action,) = find_actions(project, [given.action])
        starts = {
            layer: graph.start for layer in LAYERS if (graph := project.graphs[layer]).start is not None
        }
        return play_in_context(project, action.id, action.layer, {k: v for k, v in starts.items() if v})
    if given.performance is not None:
        kept = next((p for i, p in project.performances.items() if given.performance in (i, p.name)), None)
        if kept is None:
            names = ", ".join(f"'{p.name}'" for p in project.performances.values()) or "none"
            raise AuthorError(f"there is no performance '{given.performance}'; the project has {names}")
        seed = kept.seed if given.seed is None else given.seed
        length = max(kept.length, given.at + given.seconds)
        plan = plan_performance(project, list_kept_asks(kept), length, seed, dict(kept.stances), kept.idle)
        return ShownPlayback(project, plan, length)
    length = max(1.0, given.at + given.seconds)
    return ShownPlayback(project, improvise(project, length, given.seed, "talking"), length)


def _name_playing(shown: ShownPlayback, seconds: float) -> dict[str, str]:
    if shown.clip is not None:
        return {"clip": shown.project.clips[shown.clip].name}
    out: dict[str, str] = {}
    for layer in LAYERS:
        lane = shown.plan.layers[layer]
        cue = lane.cue_at(seconds)
        name = cue.action.name if cue is not None else name_stance(shown.project, lane.stance_at(seconds))
        if name:
            out[layer] = name
    return out


TOOLS = (
    AuthorTool(
        "look",
        "Look at the character: a picture of one moment, or a strip of several, of a clip, an action between "
        "its stances, a performance, or what plays by itself.",
        LookCall,
        LookReport,
        _look,
        long=True,
    ),
)
