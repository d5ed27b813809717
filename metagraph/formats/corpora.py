"""Recorded conversations of two, with the motion of one or both, read from folders as corpora publish them.

Nothing of any corpus comes with the program. Layouts that are known by their names of files:

- `genea`: GENEA 2023's cut of *Talking With Hands*: `main-agent` and `interloctr`, each with bvh, wav and
  tsv, `trn_2023_v0_000_main-agent.bvh`.
- `talking-with-hands`: the corpus itself, unpacked: `session1/take1`, persons by their marks,
  `..._deep5_...`.
- `beat`: one side of a conversation, `1_wayne_0_1_1.bvh`, with wav and TextGrid; the partner is not heard.
- `pairs`: anything else: `talk_1.bvh`, `talk_2.bvh`, `talk.wav` with two channels or one file a side, and
  words. The mark that tells sides apart may also be a and b, left and right, male and female.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from numpy.typing import NDArray

from metagraph.common.files import make_unforeseen_error
from metagraph.errors import FileError
from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.formats.conversations.files import SOUNDS, read_conversation
from metagraph.formats.transcripts.registry import TRANSCRIPT_SUFFIXES
from metagraph.graph.conversation.model import Conversation
from metagraph.motion.clip import Clip

Array = NDArray[Any]
Layout = Literal["genea", "talking-with-hands", "beat", "pairs"]
Place = tuple[str, str]  # of which conversation a file is, and whose it is, "" for both

_GENEA = re.compile(r"(.+)_(main-agent|interloctr)")
_SESSION, _TAKE = re.compile(r"session ?_?\d+", re.I), re.compile(r"take ?_?\d+", re.I)
_PERSON = re.compile(r"(deep|shallow)_?\d+", re.I)
_BEAT = re.compile(r"\d+_[a-z]+_\d+_\d+_\d+", re.I)
_MARK = re.compile(
    r"[ ._-]+((?:speaker|actor|person|side)?[ ._-]?[12ab]|left|right|male|female)$|(?<=\D)[12]$", re.I
)
RATES = (
    12.0,
    15.0,
    20.0,
    24.0,
    25.0,
    30.0,
    48.0,
    50.0,
    60.0,
    72.0,
    90.0,
    100.0,
    120.0,
    240.0,
)  # frames a second
CAPTURED = (30.0, 60.0, 120.0)  # at which most corpora are: these need not fit as closely
UNEVEN = 3.0  # seconds by which motion and sound may differ in length without a word
_WORDS = [s.lower() for s in TRANSCRIPT_SUFFIXES]  # of several, the first counts


@dataclass(frozen=True, eq=False)
class Recorded:
    """A conversation, and how each side moved, None if nobody knows. samples: `[2, N]` of both voices at
    `generation.features.RATE`, None if they are in the conversation's files. notes: what there is to know
    about how it was read. files: what it was read from.
    """

    name: str
    clips: tuple[Clip | None, Clip | None]
    conversation: Conversation
    samples: Array | None = None
    notes: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()


@dataclass(frozen=True, eq=False)
class CorpusReading:
    """What was read of a folder. failures: conversations that could not be, and why, in words."""

    layout: Layout
    recorded: tuple[Recorded, ...]
    failures: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass
class _Found:
    """Files of one conversation by whose they are."""

    clips: dict[str, Path] = field(default_factory=dict)
    sounds: dict[str, Path] = field(default_factory=dict)
    words: dict[str, Path] = field(default_factory=dict)
    left: list[Path] = field(default_factory=list)  # others of the same side

    @property
    def files(self) -> tuple[Path, ...]:
        return (*self.clips.values(), *self.sounds.values(), *self.words.values())


def read_corpus(
    folder: str | Path,
    layout: Layout | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> CorpusReading:
    """Read every conversation of a folder and below; one that cannot be read fails alone. layout: as told
    above, else what most files look like. Raises FileError if there is no folder, or nothing in it can be
    read.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise FileError(folder, "there is no such folder", remedy="Check where the corpus is.")
    clips = find_clip_files(folder)
    if not clips:
        raise FileError(
            folder,
            "it holds no motion that can be read",
            remedy="Give BVH, FBX, glTF, SMPL's .npz, or markers (.trc, .c3d).",
        )
    layout = _layout(clips) if layout is None else layout
    found = _grouped(folder, clips, layout)
    recorded, failures, notes = [], [], []
    for n, (name, files) in enumerate(sorted(found.items())):
        if progress is not None:
            progress(n, len(found))
        try:
            one = _read(name, files)
        except FileError as error:
            failures.append(f"{name}: {error}")
        except Exception as error:  # one bad conversation spoils no other
            failures.append(str(make_unforeseen_error(next(iter(files.files)), error)))
        else:
            recorded.append(one)
            notes += [f"{name}: {told}" for told in one.notes]
    if not recorded:
        raise FileError(
            folder,
            f"none of its {len(found)} conversations can be read, taken as '{layout}'; the first: "
            f"{failures[0].rstrip('.')}",
            remedy="Each needs motion, sound beside it of the same name, and best its words.",
        )
    return CorpusReading(layout, tuple(recorded), tuple(failures), tuple(dict.fromkeys(notes)))


# --- where things are


def _layout(clips: Sequence[Path]) -> Layout:
    kinds: Mapping[Layout, int] = {
        "genea": sum(_GENEA.fullmatch(p.stem) is not None for p in clips),
        "talking-with-hands": sum(_hands(p) is not None for p in clips),
        "beat": sum(_BEAT.fullmatch(p.stem) is not None for p in clips),
    }
    best = max(kinds, key=lambda k: kinds[k])
    return best if 2 * kinds[best] > len(clips) else "pairs"


def _hands(path: Path) -> Place | None:
    parts = [*path.parts[:-1], path.stem]
    session = next((p for p in parts if _SESSION.fullmatch(p)), None)
    take = next((t[0] for p in reversed(parts) if (t := _TAKE.search(p))), None)
    if session is None or take is None:
        return None
    person = _PERSON.search(path.stem)
    return f"{session} {take}".casefold(), person[0].casefold() if person else ""


def _placed(path: Path, layout: Layout) -> Place | None:
    """Return where a file belongs, None if nothing tells."""
    if layout == "genea":
        told = _GENEA.fullmatch(path.stem)
        return None if told is None else (told[1], "2" if told[2] == "interloctr" else "1")
    if layout == "talking-with-hands":
        return _hands(path)
    mark = _MARK.search(path.stem) if layout == "pairs" else None
    if mark is None:
        return path.stem, ""
    return path.stem[: mark.start()], mark[0].strip(" ._-").casefold()


def _grouped(folder: Path, clips: Sequence[Path], layout: Layout) -> dict[str, _Found]:
    """Return the files of each conversation. A mark of a side counts where another file has the other's, or
    what it goes with is called without it.
    """
    every = [p for p in sorted(folder.rglob("*")) if p.is_file() and not _hidden(p, folder)]
    sounds = [p for p in every if p.suffix.lower() in SOUNDS]
    known = [s for s in _WORDS if layout != "beat" or s != ".json"]  # there JSON is the face
    words = [p for p in every if p.suffix.lower() in known]
    words.sort(key=lambda p: known.index(p.suffix.lower()))
    bare = {_placed(p, layout) for p in (*clips, *sounds)}
    called = {b[0] for p in clips if (b := _placed(p, layout)) is not None and b[1]}

    def placed(path: Path) -> Place | None:
        place = _placed(path, layout)
        if place is None or layout != "pairs" or not place[1]:
            return place
        alone = not any(b is not None and b[0] == place[0] and b[1] != place[1] for b in bare)
        return (path.stem, "") if alone or path.stem in called else place

    homes: dict[Place, set[Path]] = {}
    for path in clips:
        if (place := placed(path)) is not None:
            homes.setdefault(place, set()).add(path.parent)
    apart = layout in ("pairs", "beat")  # of the others motion and sound lie in folders of their own
    twice = {name for (name, _), places in homes.items() if apart and len(places) > 1}
    out: dict[str, _Found] = {}
    for kind, paths in (("clips", clips), ("sounds", sounds), ("words", words)):
        for path in paths:
            if (place := placed(path)) is None:
                continue
            name, who = place
            if name in twice:  # the same name in several folders is several conversations
                name = f"{path.parent.relative_to(folder).as_posix()}/{name}"
            found = out.setdefault(name, _Found())
            kept: dict[str, Path] = getattr(found, kind)
            if kept.setdefault(who, path) != path and kind != "words":
                found.left.append(path)
    return {n: f for n, f in out.items() if f.clips}


def _hidden(path: Path, folder: Path) -> bool:
    return any(part.startswith(".") for part in path.relative_to(folder).parts)


# --- one conversation


def _read(name: str, files: _Found) -> Recorded:
    people = sorted(w for w in {*files.clips, *files.sounds, *files.words} if w) or [""]
    first = next(iter(files.clips.values()))
    if len(people) > 2:
        raise FileError(
            first, f"has {len(people)} people ({', '.join(people)})", remedy="Two talk with each other here."
        )
    own = [files.sounds[w] for w in people if w in files.sounds]
    both = files.sounds.get("")
    if not own and both is None:
        raise FileError(
            first, "there is no sound beside it", remedy="Give one the same name: who speaks when is heard."
        )
    audio = own if len(own) == 2 or both is None else [both]
    notes = [f"{p.name} is left out: another file of the same side is taken" for p in files.left]
    if len(audio) == 1 and own and len(people) == 2:
        notes.append(f"only {audio[0].name} is there: the other side is not heard")
    if len(audio) == 1 and audio[0] != both and people.index(_of(files.sounds, audio[0])) == 1:
        people.reverse()  # whoever is heard comes first
    told = [files.words[w] for w in people if w and w in files.words]
    if not told and "" in files.words:
        told = [files.words[""]]
    read = read_conversation(audio, told, None, name, most=2)
    clips: list[Clip | None] = [None, None]
    for side, who in enumerate(people):
        path = files.clips.get(who, files.clips.get("") if side == 0 else None)
        if path is None:
            notes.append(f"nobody knows how side {side + 1} moved")
            continue
        clip, odd = _as_long(max(read_clips(path), key=lambda c: c.frames), read.conversation.length)
        clips[side] = clip
        notes += [f"{path.name}: {words}" for words in odd]
    if told:
        notes += _early_words(read.conversation)
    else:
        notes.append("no words are beside it: loudness tells clauses, hesitations are not found")
    return Recorded(name, (clips[0], clips[1]), read.conversation, None, (*notes, *read.notes), files.files)


def _early_words(conversation: Conversation) -> list[str]:
    """Return what there is to say of words that end long before their sound does."""
    last = max((w.end for side in conversation.sides for w in side.words), default=0.0)
    if not last or conversation.length - last <= max(2 * UNEVEN, 0.4 * conversation.length):
        return []
    return [
        f"its words end at {last:.0f} s, its sound lasts {conversation.length:.0f} s: check that they belong "
        "together"
    ]


def _as_long(clip: Clip, seconds: float) -> tuple[Clip, list[str]]:
    """Return a clip at the rate at which it is as long as its sound, where it is not and another usual rate
    makes it so; and what there is to say of their lengths.
    """
    length = clip.frames / clip.fps
    if seconds <= 0 or abs(length - seconds) <= max(UNEVEN, 0.1 * seconds):
        return clip, []
    rate = min(RATES, key=lambda fps: abs(clip.frames / fps - seconds))
    near = min(CAPTURED, key=lambda fps: abs(clip.frames / fps - seconds))
    if abs(clip.frames / near - seconds) <= max(UNEVEN, 0.1 * seconds):
        rate = near
    told = f"its motion lasts {length:.0f} s at {clip.fps:.4g} frames a second, its sound {seconds:.0f} s"
    allowed = max(UNEVEN, 0.1 * seconds) if rate == near else max(0.5, 0.01 * seconds)
    if abs(clip.frames / rate - seconds) <= allowed:
        return replace(clip, fps=rate), [
            f"{told}: read at {rate:.4g} frames a second, at which it is as long"
        ]
    return clip, [f"{told}: check that they belong together"]


def _of(files: Mapping[str, Path], path: Path) -> str:
    return next(who for who, p in files.items() if p == path)
