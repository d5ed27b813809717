"""The videos of a perceptual study, drawn as `render` draws: one camera for an item in all conditions, one
length, one loudness; names that reveal nothing.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.command_output import choose_plan, open_for_command
from app.cli.render_command import load_figure, mix_sound
from app.stage.conversation_plans import ConversationPlans
from app.stage.filming import measure_bounds, render_pictures
from app.stage.playback_source import ASIDE, ShownPlayback, play_clip_alone
from metagraph.errors import FileError
from metagraph.formats.gltf.reader import has_skinned_mesh
from metagraph.graph.model import ClipEntry, Project
from metagraph.motion.clip import Clip
from metagraph.research.study.perceive.perceive_plan import Condition, PerceivePlan, Stretch
from metagraph.speech.loudness import level_sounds
from metagraph.speech.soundtrack import RATE

NEW = "perceived.{}"  # ids of clips that are put into a project for its pictures alone
LATE = 0.05  # seconds by which an item may reach beyond its source: the last frame stands
Sounds = dict[tuple[str, str], np.ndarray | None]


@dataclass(frozen=True)
class StimulusSource:
    """What a condition shows of an item. seen: figures and what they play, or the video there is. start:
    seconds into it. sound: of a moment on, so long, mono at RATE; None if nothing is heard.
    """

    start: float
    length: float
    sound: Callable[[float, float], np.ndarray | None]
    seen: tuple[tuple[Any, ShownPlayback], ...] = ()
    video: Path | None = None


class Stimuli:
    """Reads what conditions show, each thing once. Raises FileError for what cannot be shown, naming
    condition and item.
    """

    def __init__(self, path: Path, plan: PerceivePlan) -> None:
        self.path, self.plan = path, plan
        self._projects: dict[Path, Project] = {}
        self._figures: dict[tuple[Any, ...], Any] = {}
        self._whole: dict[str, StimulusSource] = {}
        self._plans = ConversationPlans()

    def source(self, name: str, item: Stretch) -> StimulusSource:
        """Return what a condition shows for an item."""
        made = self.plan.conditions[name]
        # Of what is not made for each item one whole is kept.
        apart = any("{item}" in p for p in _paths(made))
        if apart or name not in self._whole:
            self._whole[name] = self._read(name, made, item, apart)
        found = self._whole[name]
        start = found.start if apart else item.start
        if start + item.seconds > found.length + LATE:
            raise self._failure(
                name,
                f"lasts {found.length:.2f} s, but item '{item.id}' ends at {start + item.seconds:.2f} s",
            )
        return replace(found, start=start)

    def sounds(self) -> Sounds:
        """Return (condition, item) -> samples, all as loud as each other; None for silence."""
        out: dict[tuple[str, str], np.ndarray] = {}
        items = self.plan.items
        for name, made in self.plan.conditions.items():
            for n, item in enumerate(items):
                heard = items[(n + 1) % len(items)] if made.sound == "mismatched" else item
                found = self.source(name, heard)
                samples = found.sound(found.start, item.seconds) if made.sound != "none" else None
                if samples is not None:
                    out[name, item.id] = samples
        levels = level_sounds({"\n".join(k): v for k, v in out.items()}, RATE, self.plan.video.loudness)
        return {(c, i.id): levels.get(f"{c}\n{i.id}") for c in self.plan.conditions for i in items}

    def camera(self, item: Stretch) -> Any:
        """Return the camera that sees an item in all conditions; None if nothing is drawn."""
        from preview.camera import make_whole_figure_camera

        boxes, several = [], False
        for name in self.plan.conditions:
            found = self.source(name, item)
            if found.seen:
                boxes.append(measure_bounds(found.seen, found.start + np.arange(0, item.seconds, 1 / 15)))
                several |= len(found.seen) > 1
        if not boxes:
            return None
        box = np.min([b[0] for b in boxes], 0), np.max([b[1] for b in boxes], 0)
        look = self.plan.video
        return make_whole_figure_camera(box, look.width / look.height, ASIDE if several else 0.0)

    def pictures(self, name: str, item: Stretch, camera: Any) -> Iterator[np.ndarray]:
        """Yield the pictures that a condition shows for an item."""
        from preview.video_reading import read_pictures

        look, found = self.plan.video, self.source(name, item)
        times = found.start + np.arange(max(1, round(item.seconds * look.fps))) / look.fps
        size = (look.width, look.height)
        if found.video is not None:
            yield from read_pictures(found.video, times, size)
        else:
            yield from render_pictures(found.seen, times, size, look.theme, camera)

    # --- what is read

    def _failure(self, name: str, cause: str, remedy: str = "") -> FileError:
        return FileError(
            self.path,
            cause,
            f"conditions.{name}",
            remedy or "Correct it. docs/researchers/perceptual-plan.md describes every field.",
        )

    def _file(self, path: str, item: Stretch) -> Path:
        return self.path.parent / path.replace("{item}", item.id)

    def _project(self, made: Condition) -> tuple[Project, Path]:
        path = (self.path.parent / (made.project or self.plan.project or "")).resolve()
        if path not in self._projects:
            self._projects[path] = open_for_command(path)
        return self._projects[path], path.parent

    def _figure(self, project: Project, folder: Path) -> Any:
        key = str(folder), project.character, project.hidden, project.skeleton
        if key not in self._figures:
            self._figures[key] = load_figure(project, folder)
        return self._figures[key]

    def _read(self, name: str, made: Condition, item: Stretch, apart: bool) -> StimulusSource:
        if made.video is not None:
            return self._video(name, made, item, apart)
        if made.conversation is not None:
            shown, folder = self._conversation(name, made, item)
        elif made.performance is not None:
            shown, folder = self._performance(made)
        else:
            shown, folder = self._motion(name, made, item)
        shown = make_face_still(shown) if made.face == "still" else shown
        if shown.skeleton is None:
            raise self._failure(name, "its project has no clips to draw")
        start = item.start if made.conversation is not None or not apart else 0.0

        def spoken(begin: float, seconds: float) -> np.ndarray | None:
            found = mix_sound(shown, folder, seconds, begin)
            return found[0] if found is not None else None

        sound = spoken if made.audio is None else self._audio(made.audio, item)
        seen = tuple((self._figure(one.project, one.folder or folder), one) for one in shown.everyone)
        return StimulusSource(start, shown.length, sound, seen)

    def _conversation(self, name: str, made: Condition, item: Stretch) -> tuple[ShownPlayback, Path]:
        project, folder = self._project(made)
        ident = _named(project.conversations, made.conversation)
        if ident is None:
            kept = ", ".join(f"'{c.name}'" for c in project.conversations.values()) or "none"
            raise self._failure(
                name, f"there is no conversation '{made.conversation}' in the project; it has {kept}"
            )
        talk = project.conversations[ident]
        sides = []
        for n, side in enumerate(talk.sides):
            rates = {
                "clause": side.rates.clause,
                "response": side.rates.response,
                "hesitation": side.rates.hesitation,
            }
            rates |= dict.fromkeys(made.without, 0.0)
            motion = side.motion
            if made.taken:
                if side.take is None or side.take not in project.clips:
                    raise self._failure(name, f"side {n + 1} of '{talk.name}' has no take recorded with it")
                motion = side.take
            elif isinstance(made.motion, tuple):
                path = made.motion[n]
                clip = self._clip(name, self._file(path, item), project)
                if "{item}" in path:
                    clip = delay_clip(clip, item.start)
                motion = NEW.format(n)
                project = with_clip(project, motion, clip)
            sides.append(replace_struct(side, motion=motion, rates=replace_struct(side.rates, **rates)))
        talk = replace_struct(talk, sides=tuple(sides), **({} if made.seed is None else {"seed": made.seed}))
        project = replace(project, conversations={**project.conversations, ident: talk})
        shown = self._plans.show(project, ident, folder)
        if shown.notes:
            raise self._failure(
                name, shown.notes[0], "Repair it in the project. A study cannot be made with missing files."
            )
        return shown, folder

    def _performance(self, made: Condition) -> tuple[ShownPlayback, Path]:
        project, folder = self._project(made)
        wanted = Namespace(
            performance=made.performance, seconds=None, seed=made.seed, usual_seconds=10.0, mode=None
        )
        plan = choose_plan(project, wanted)
        return ShownPlayback(project, plan, wanted.seconds), folder

    def _motion(self, name: str, made: Condition, item: Stretch) -> tuple[ShownPlayback, Path]:
        """Return a clip of a project, or a file's motion on its character, or on the default body."""
        if made.clip is not None:
            project, folder = self._project(made)
            wanted = made.clip.replace("{item}", item.id)
            ident = next((e.id for e in project.clips.values() if wanted in (e.name, e.id)), None)
            if ident is None or project.clips[ident].motion is None:
                raise self._failure(name, f"there is no clip '{wanted}' in the project")
            return play_clip_alone(project, ident), folder
        assert isinstance(made.motion, str)
        path = self._file(made.motion, item)
        if made.project or self.plan.project:
            project, folder = self._project(made)
            clip = self._clip(name, path, project)
        else:
            clip, folder = self._clip(name, path, None), path.parent
            own = path if path.is_file() else Path(str(path).partition("#")[0])
            drawn = own.suffix.lower() in (".glb", ".gltf", ".vrm") and has_skinned_mesh(own)
            project = Project(skeleton=clip.skeleton, character=own.name if drawn else None)
        return play_clip_alone(with_clip(project, NEW.format(0), clip), NEW.format(0)), folder

    def _clip(self, name: str, path: Path, project: Project | None) -> Clip:
        from metagraph.formats.clips import read_clips

        named, _, take = str(path).partition("#")
        path = path if path.is_file() else Path(named)
        found = read_clips(path)
        clips = [c for c in found if not take or c.name == take]
        if len(clips) != 1:
            kept = ", ".join(f"'{c.name}'" for c in found[:8])
            raise FileError(
                path,
                f"has no take '{take}'" if take else f"holds {len(found)} takes",
                f"conditions.{name}",
                f"Add its name after '#', as in {path.name}#{found[0].name}; it has {kept}.",
            )
        clip = clips[0]
        if project is not None and clip.skeleton != project.skeleton:
            raise FileError(
                path,
                "has another skeleton than the project",
                f"conditions.{name}",
                "Import it and give it as a clip, or remove 'project' to use the default body.",
            )
        return clip

    def _audio(self, audio: str, item: Stretch) -> Callable[[float, float], np.ndarray | None]:
        from metagraph.speech.sound import read_sound
        from metagraph.speech.soundtrack import resample_sound

        samples, rate = read_sound(self._file(audio, item), None)
        whole = resample_sound(samples, rate, RATE)
        return lambda begin, seconds: _cut(whole, begin, seconds)

    def _video(self, name: str, made: Condition, item: Stretch, apart: bool) -> StimulusSource:
        from preview.video_reading import measure_video_seconds, read_video_sound

        assert made.video is not None
        path = self._file(made.video, item)
        whole = read_video_sound(path, RATE)

        def sound(begin: float, seconds: float) -> np.ndarray | None:
            return None if whole is None else _cut(whole, begin, seconds)

        return StimulusSource(0.0 if apart else item.start, measure_video_seconds(path), sound, video=path)


def _paths(made: Condition) -> tuple[str, ...]:
    motion = (made.motion,) if isinstance(made.motion, str) else made.motion or ()
    return (*motion, *(p for p in (made.video, made.clip, made.audio) if p is not None))


def _named(kept: Any, name: str | None) -> str | None:
    return next((i for i, one in kept.items() if name in (i, one.name)), None)


def replace_struct(value: Any, **fields: Any) -> Any:
    from msgspec.structs import replace as changed

    return changed(value, **fields)


def make_face_still(shown: ShownPlayback) -> ShownPlayback:
    """Return the same with faces that do not follow speech, of all who are seen."""
    still = {"lips": 0.0, "expressions": 0.0, "accent_brows": 0.0, "accent_blinks": 0.0}
    project = replace(shown.project, life=replace_struct(shown.project.life, **still))
    return replace(shown, project=project, others=tuple(make_face_still(one) for one in shown.others))


def with_clip(project: Project, ident: str, clip: Clip) -> Project:
    """Return a project with one more clip, which is never saved."""
    entry = ClipEntry(ident, ident, "", frames=clip.frames, fps=clip.fps, motion=clip)
    return replace(project, clips={**project.clips, ident: entry})


def delay_clip(clip: Clip, seconds: float) -> Clip:
    """Return a clip that holds its first frame for a while before it plays."""
    count = round(seconds * clip.fps)
    if count <= 0:
        return clip

    def held(values: Any) -> Any:
        return None if values is None else np.concatenate([np.repeat(values[:1], count, 0), values])

    return replace(
        clip,
        rotations=held(clip.rotations),
        translations=held(clip.translations),
        weights=held(clip.weights),
    )


def _cut(whole: np.ndarray, begin: float, seconds: float) -> np.ndarray:
    first, count = round(begin * RATE), round(seconds * RATE)
    out = np.zeros(count, np.float32)
    part = whole[first : first + count]
    out[: len(part)] = part
    return out
