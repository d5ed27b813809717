"""`metagraph generate sample`, `cut` and `info`: motion made by a model, and what a model is."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.outputs import ProjectOutput

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from app.cli.generate_life import LivingClip
    from metagraph.generation.stored import Model, ModelCard
    from metagraph.generation.take_files import TakeFiles, TakeSpeech
    from metagraph.graph.conversation.model import Conversation
    from metagraph.motion.clip import Clip

OUT = (".bvh", ".glb")
ROLES = ("speaking", "listening", "both", "none")
LEAST = 1.0  # seconds of sound
MINUTES = 60.0  # at most


def add_model_argument(parser: ArgumentParser) -> None:
    parser.add_argument("model", type=Path, help="a model (.mgmodel)")


def add_heard_arguments(parser: ArgumentParser, needed: bool) -> None:
    """Add the options that say what is heard, and how motion is made of it."""
    from app.cli.language_options import add_language_arguments

    more = "" if needed else " (default: planted speech)"
    parser.add_argument(
        "--speech",
        type=Path,
        nargs="+",
        required=needed,
        metavar="FILE",
        help=f"a sound with one channel a speaker, or one file for each of the two{more}",
    )
    parser.add_argument(
        "--words",
        type=Path,
        nargs="+",
        metavar="FILE",
        help="transcripts with times: TextGrid, ELAN, subtitles, JSON of a speech service and others "
        "(default: a file named like the sound, else loudness)",
    )
    add_language_arguments(parser)
    parser.add_argument(
        "--side", type=int, choices=(1, 2), default=1, help="the speaker who moves (default: 1)"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="random seed; another seed gives another take (default: 1)"
    )
    parser.add_argument(
        "--temperature", type=float, default=1.0, help="how much the motion varies, 0 to 1.2 (default: 1)"
    )
    parser.add_argument(
        "--guidance", type=float, help="how closely a matching model or a flow-vae follows the speech"
    )
    parser.add_argument(
        "--lookahead",
        type=int,
        help="frames of sound the model hears ahead; 0 for live use (default: as many as the model uses)",
    )
    parser.add_argument(
        "--activity",
        choices=ROLES,
        help="play this role throughout: 'listening' makes a listener (default: the role of the recording)",
    )
    parser.add_argument(
        "--from",
        dest="first",
        type=Path,
        metavar="CLIP",
        help="start from the first pose of this clip, such as a stance (default: the mean pose)",
    )


def cut_arguments(parser: ArgumentParser) -> None:
    """Add the options of `cut`."""
    add_model_argument(parser)
    add_heard_arguments(parser, needed=False)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the folder for the clips")
    parser.add_argument(
        "--minutes",
        type=float,
        default=3.0,
        help="minutes of motion to generate, from several seeds (default: 3)",
    )
    parser.add_argument("--least", type=float, default=1.0, help="seconds of the shortest clip (default: 1)")
    parser.add_argument("--most", type=float, default=8.0, help="seconds of the longest clip (default: 8)")
    parser.add_argument("--project", type=Path, help="add the clips to this project")


@dataclass(frozen=True, eq=False)
class HeardInput:
    """What a model is given. samples: `[C, N]`, own voice first; activity: marks and who speaks `[T, TOLD]`,
    or who speaks alone `[T, 4]`. sounds: the files that were heard, the conversation's sides in order; side:
    who moves; talk: who says what when, where words tell it.
    """

    samples: Any
    activity: Any
    name: str
    sounds: tuple[Path, ...] = ()
    side: int = 0
    talk: Conversation | None = None


def read_heard(options: Namespace, tracks: int) -> HeardInput:
    """Return what is heard. Raises FileError, ValueError."""
    import numpy as np

    from app.cli.language_options import read_speaking
    from metagraph.generation.features import count_sound_frames
    from metagraph.generation.take_files import read_speech

    paths: list[Path] = options.speech or []
    if len(paths) > 2 or len(options.words or ()) > 2:
        raise ValueError("give one or two sounds and at most two transcripts for a conversation of two")
    files: TakeFiles | None = None
    if paths:
        files = _find_speech(options, paths)
        speech, name = read_speech(files, read_speaking(options)), paths[0].stem
    else:
        speech, name = _planted_speech(options)
    for note in speech.notes:
        print(f"note: {note}", file=sys.stderr)
    samples = np.atleast_2d(speech.samples)
    _check(speech, samples, str(paths[0]) if paths else name)
    activity = _activity(options, speech, samples, count_sound_frames(samples.shape[1]))
    if options.activity is not None:
        activity = as_role(activity, options.activity)
    if tracks == 2 and len(samples) == 1:
        samples = np.concatenate([samples, np.zeros_like(samples)])
    sounds, side = ((), 0) if files is None else (files.sounds, files.side)
    return HeardInput(samples, activity, name, sounds, side, speech.conversation)


def _planted_speech(options: Namespace) -> tuple[TakeSpeech, str]:
    """Return speech that was made up, with its name."""
    from metagraph.generation.take_files import TakeSpeech
    from metagraph.research.generation.planted_speech import make_planted_speech

    name = "planted speech"
    spoken = make_planted_speech(min(options.minutes, 3.0) * 60, options.seed, 1, name)
    samples = spoken.samples[::-1] if options.side == 2 else spoken.samples
    return TakeSpeech(samples, (0.0, 0.0), spoken.conversation), name


def _find_speech(options: Namespace, paths: list[Path]) -> TakeFiles:
    """Return the files of speech, checked. Raises FileError."""
    from metagraph.errors import FileError
    from metagraph.formats.conversations.files import SOUNDS
    from metagraph.generation.take_files import TakeFiles

    for path in paths:
        if not path.is_file():
            raise FileError(path, "the sound file does not exist", remedy="Check the path of the speech.")
        if path.suffix.lower() not in SOUNDS:
            raise FileError(path, "is not a sound file", remedy=f"Sounds are {', '.join(SOUNDS)} files.")
    words = _words_beside(paths[0]) if options.words is None else options.words
    swapped = options.side == 2 and len(paths) == 2 and not words
    sounds = tuple(reversed(paths)) if swapped else tuple(paths)
    side = options.side - 1 if len(sounds) == 1 or words else 0
    return TakeFiles(paths[0], sounds, tuple(words), side)


def _words_beside(sound: Path) -> list[Path]:
    """Return the transcript that has a sound's name, if there is one."""
    from metagraph.formats.transcripts.registry import TRANSCRIPT_SUFFIXES

    known = {s.lower() for s in TRANSCRIPT_SUFFIXES}
    beside = sorted(sound.parent.glob("*"))
    return [p for p in beside if p.suffix.lower() in known and p.stem == sound.stem][:1]


def _check(speech: TakeSpeech, samples: Any, place: str) -> None:
    """Raise FileError if a sound cannot be used; warn if it clips."""
    import numpy as np

    from metagraph.errors import FileError
    from metagraph.generation.features import RATE
    from metagraph.generation.loudness import measure_integrated_loudness

    seconds = samples.shape[1] / RATE
    if not np.isfinite(samples).all():
        raise FileError(place, "holds a sample that is not a number", remedy="Export it again.")
    if seconds < LEAST:
        raise FileError(place, f"lasts {seconds:.2f} s", remedy=f"Give at least {LEAST:g} s of speech.")
    if not any(np.isfinite(measure_integrated_loudness(channel, RATE)) for channel in samples):
        raise FileError(place, "is silent", remedy="Check the microphone, or what was exported.")
    if max(speech.clipped, default=0.0) > 1e-4:
        share = 100 * max(speech.clipped)
        print(f"note: {share:.2g} % of the sound clips. Record it at a lower level", file=sys.stderr)


def _activity(options: Namespace, speech: TakeSpeech, samples: Any, frames: int) -> Any:
    """Return marks and who speaks when `[T, TOLD]`, of the words if there are any, else of the sound."""
    from metagraph.generation.features import tell_conversation
    from metagraph.generation.sampler import hear_activity

    if speech.conversation is None:
        if len(samples) == 1:
            print("note: the sound has only the speaker's voice; the partner stays silent", file=sys.stderr)
        return hear_activity(samples)
    if not speech.conversation.sides[options.side - 1].segments:
        print(f"note: side {options.side} does not speak, so it listens", file=sys.stderr)
    return tell_conversation(speech.conversation, options.side - 1, frames)


def as_role(activity: Any, role: str) -> Any:
    """Return activity `[T, 4]` that gives the speaker this role throughout; the marks, which are those of
    another role, are left out.
    """
    import numpy as np

    from metagraph.generation.features import BOTH, NONE, PARTNER, SELF
    from metagraph.generation.networks import ACTIVITY

    activity = np.asarray(activity)[:, -ACTIVITY:]
    out = np.zeros_like(activity)
    quiet = activity[:, NONE] > 0.5
    chosen = {"speaking": SELF, "listening": PARTNER, "both": BOTH, "none": NONE}[role]
    out[:, chosen] = ~quiet
    out[:, NONE] = np.maximum(out[:, NONE], quiet)
    return out


def make_motion(options: Namespace, model: Model, heard: HeardInput, seed: int) -> Clip:
    """Return a model's motion. Raises ValueError, FileError."""
    from metagraph.errors import FileError
    from metagraph.formats.clips import read_clips
    from metagraph.generation.chunks import GUIDANCE
    from metagraph.generation.sampler import read_first_pose, sample_whole

    first = None
    if options.first is not None:
        stance = read_clips(options.first)[0]
        if stance.skeleton != model.rig.skeleton:
            raise FileError(
                options.first,
                "has another skeleton than the model",
                remedy="Retarget it to the model's skeleton.",
            )
        first = read_first_pose(stance)
    return sample_whole(
        model,
        heard.samples,
        heard.activity,
        seed=seed,
        temperature=options.temperature,
        lookahead=options.lookahead,
        guidance=GUIDANCE if options.guidance is None else options.guidance,
        first=first,
        name=f"{heard.name}, {options.model.stem}, seed {seed}",
    )


def write_motion(options: Namespace) -> int:
    """Make motion to speech and write it."""
    from app.cli.command_output import say
    from metagraph.formats.bvh.file import write_bvh
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.generation.stored import read_model

    out: Path = options.out
    if out.suffix.lower() not in OUT:
        raise ValueError(f"motion can be written as {' or '.join(OUT)}, not as '{out.suffix or out.name}'")
    model = read_model(options.model)
    heard = read_heard(options, model.card.tracks)
    clip = make_motion(options, model, heard, options.seed)
    body = None
    if not options.bare:
        living = _with_life(options, heard, clip)
        clip, body = living.clip, living.body
    out.parent.mkdir(parents=True, exist_ok=True)
    if out.suffix.lower() == ".bvh":
        write_bvh(clip, out)
    else:
        write_glb(out, [clip], body)
    shares = {r: round(float(heard.activity[:, n - len(ROLES)].mean()), 3) for n, r in enumerate(ROLES)}
    data = {
        "out": str(out),
        "frames": clip.frames,
        "fps": clip.fps,
        "seconds": round(clip.duration, 3),
        "seed": options.seed,
        "model": str(options.model),
        "activity": shares,
    }
    words = ", ".join(f"{r} {100 * s:.0f} %" for r, s in shares.items())
    say(options, f"{out}: {clip.duration:.1f} s by {options.model.name}, seed {options.seed} ({words})", data)
    return 0


def _with_life(options: Namespace, heard: HeardInput, clip: Clip) -> LivingClip:
    """Return a clip with hips, legs, fingers, gaze and face as the project has them."""
    from app.cli.demo_command import SAMPLE
    from app.cli.generate_life import compose_with_life
    from metagraph.errors import FileError
    from metagraph.formats.conversations.files import read_conversation
    from metagraph.graph.conversation.model import Conversation, Side

    talk, side = heard.talk, heard.side
    if options.activity is not None:  # who plays another's role says nothing that is known
        talk = None
    elif talk is None:
        with suppress(FileError, ValueError):  # a sound in which nobody is heard
            talk = read_conversation(heard.sounds).conversation
    if talk is None:
        talk, side = Conversation(name=heard.name, length=clip.duration, sides=(Side(), Side())), 0
    living = compose_with_life(options.project or SAMPLE, clip, talk, side)
    for note in living.notes:
        print(f"note: {note}", file=sys.stderr)
    return living


def write_pieces(options: Namespace) -> int:
    """Make motion, cut it if that is safe, and write the pieces."""
    with ProjectOutput(options.project) if options.project is not None else nullcontext() as output:
        return _cut(options, output)


def _cut(options: Namespace, output: ProjectOutput | None) -> int:
    """output: the project that the pieces are added to, if any."""
    import json

    from app.cli.command_output import say
    from metagraph.formats.atomic import write_atomically
    from metagraph.formats.clips import digest
    from metagraph.formats.gltf.writer import write_glb
    from metagraph.formats.outputs import claim
    from metagraph.generation.stored import read_model
    from metagraph.synthesis.cut import explain_uncut, find_candidates

    if not 0 < options.minutes <= MINUTES:
        raise ValueError(f"--minutes must be more than 0 and at most {MINUTES:g}, not {options.minutes:g}")
    model = read_model(options.model)
    heard = read_heard(options, model.card.tracks)
    out: Path = options.out
    claim(out / "pieces.json")
    out.mkdir(parents=True, exist_ok=True)
    known = digest(options.model)
    entries: list[dict[str, Any]] = []
    left, seed, why = options.minutes * 60, options.seed, ""
    while left > 0:
        clip = make_motion(options, model, heard, seed)
        if clip.duration > left:
            clip = clip.trimmed(0, max(2, round(left * clip.fps)))
        left -= max(clip.duration, 0.1)
        found = find_candidates(clip, None, options.least, options.most)
        why = why or ("" if found else explain_uncut(clip, None, options.least, options.most))
        for start, end, score in found:
            piece = clip.trimmed(round(start * clip.fps), round(end * clip.fps) + 1)
            name = f"{options.model.stem}_seed{seed}_{round(start * 10):05d}"
            path = out / f"{name}.glb"
            write_glb(path, [piece.renamed(name)])
            told = {"file": path.name, "model": options.model.name, "sha256": known, "seed": seed}
            entries.append({**told, "start": start, "end": end, "score": score, "speech": heard.name})
        seed += 1
    write_atomically(out / "pieces.json", (json.dumps(entries, indent=1) + "\n").encode())
    lines = [
        f"{len(entries)} pieces in {out}, {sum(e['end'] - e['start'] for e in entries):.1f} s of "
        f"{options.minutes * 60:.0f} s, seeds {options.seed} to {seed - 1}"
    ]
    if not entries:
        lines.append(f"{why}. Ask for more minutes, a lower temperature or longer pieces, or train longer")
    added = _added(output, [out / e["file"] for e in entries]) if output is not None and entries else 0
    if added:
        lines.append(f"{added} added to {options.project}")
    data = {"folder": str(out), "pieces": entries, "minutes": options.minutes, "added": added}
    data |= {} if entries else {"why": why}
    say(options, "\n".join(lines), data)
    return 0 if entries else 3


def _added(output: ProjectOutput, files: list[Path]) -> int:
    """Add pieces to a project and return how many. Their names have the model and the seed."""
    from app.cli.command_output import open_for_command
    from metagraph.formats.imports import import_files

    project = open_for_command(output.path)
    result = import_files(project, output.path.resolve().parent, files)
    for failure in result.failures:
        print(f"left out: {failure}", file=sys.stderr)
    if result.loaded:
        output.save(result.into(project))
    return len(result.loaded)


def print_model(options: Namespace) -> int:
    """Describe a model."""
    import msgspec

    from app.cli.command_output import say
    from metagraph.generation.networks import count_parameters
    from metagraph.generation.stored import read_model

    card = read_model(options.model).card  # its weights are read as well: a damaged file is reported here
    count = count_parameters(card.sizes)
    data = {**msgspec.to_builtins(card), "parameters": count}
    say(options, "\n".join(_told(options.model, card, count)), data)
    return 0


def _told(path: Path, card: ModelCard, count: int) -> list[str]:
    roles = [r for r in card.skeleton.roles if r != "hips"]
    lines = [
        f"{path.name}: {card.kind}, {count:,} parameters, {path.stat().st_size / 2**20:.2f} MiB",
        f"  moves {len(roles)} joints of {len(card.skeleton.names)} at {card.fps:g} frames a second: "
        f"{', '.join(r.replace('_', ' ') for r in roles)}",
        f"  hears {'both voices apart' if card.tracks == 2 else 'both voices mixed'}, and who speaks",
        f"  loss '{card.loss or 'unknown'}', seed {card.seed}, {card.steps:,} steps on {card.hours:.2f} h",
        f"  made with {', '.join(f'{n} {v}' for n, v in sorted(card.versions.items())) or 'unknown'}",
    ]
    for what, takes in (("learned from", card.takes), ("held out", card.held_out)):
        licences = sorted({t.licence or "no licence given" for t in takes})
        minutes = sum(t.seconds for t in takes) / 60
        lines.append(f"  {what} {len(takes)} takes, {minutes:.1f} min" + (": " if takes else ""))
        lines += [f"    {t.name}{' (mirrored)' if t.mirrored else ''}, {t.seconds:.1f} s" for t in takes[:10]]
        lines += [f"    and {len(takes) - 10} more"] if len(takes) > 10 else []
        lines += [f"    licence: {words}" for words in licences]
    lines += [f"  {name}: {value:.4g}" for name, value in card.statistics.items()]
    return lines + [f"  note: {note}" for note in card.notes]
