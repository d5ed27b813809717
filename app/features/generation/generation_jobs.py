"""What the window of generated motion works with: takes as they were read, what models make, pieces of it.

Pure functions and values; whoever calls them does so on a job's thread.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.project.new_clips import Loaded, cut_into_pieces, save
from app.translation import tr, tr_noop, tr_plural
from metagraph.errors import FileError
from metagraph.graph import edits
from metagraph.graph.conversation.edits import change_side
from metagraph.graph.generated import add_generated
from metagraph.graph.model import Kind, Limb, Project
from metagraph.motion.clip import Clip

if TYPE_CHECKING:
    from metagraph.generation.performing import Chance
    from metagraph.generation.stored import Model, ModelCard
    from metagraph.generation.take_files import TakeBatch

KINDS = {"matching": "Matching", "flow-vae": "Flow-VAE", "moglow": "MoGlow", "cvae": "CVAE"}
FOLDER = "generated"  # beside the project file, where new clips are kept
LEAST, MOST = 1.0, 8.0  # seconds of clips cut from takes
UNCUT = tr_noop("Generate more minutes, lower Randomness, or train longer.")
Progress = Callable[[int, int], None]
Cancelled = Callable[[], bool]


def as_sentence(error: Exception) -> str:
    """Return what went wrong as a sentence; a file's name stays as it is written."""
    text = str(error).rstrip(".")
    return f"{text}." if isinstance(error, FileError) else f"{text[:1].upper()}{text[1:]}."


# --- takes


@dataclass(frozen=True)
class TakeRow:
    """A take in the list. heard: what is known of its speech. wrong: what there is to know, or why it is left
    out; bad: whether it is.
    """

    name: str
    seconds: float = 0.0
    heard: str = ""
    wrong: str = ""
    bad: bool = False


@dataclass(frozen=True, eq=False)
class TakeListing:
    """What came of looking through folders. batch: takes that can be learned from, None if there are none."""

    rows: tuple[TakeRow, ...] = ()
    batch: TakeBatch | None = None

    @property
    def seconds(self) -> float:
        return sum(take.seconds for take in self.batch.takes) if self.batch is not None else 0.0


def list_takes(
    folders: Sequence[Path], project: Project, progress: Progress, cancelled: Cancelled
) -> TakeListing:
    """Look through folders, and read what can be learned from; what cannot is reported, and spoils nothing
    else. Raises CancelledError.
    """
    from metagraph.generation.take_files import find_takes, read_take_batch

    rows: list[TakeRow] = []
    files: list[Any] = []
    without: list[str] = []
    for folder in folders:  # one that is gone spoils no other
        try:
            found, alone = find_takes([folder])
        except FileError as error:
            rows.append(TakeRow(folder.name, wrong=_without_name(str(error), folder.name), bad=True))
            continue
        files += [f for f in found if f not in files]
        without += alone
    rig = _rig_for(files, project)
    batch = read_take_batch(files, rig, progress=lambda n, _: progress(n, len(files)), cancelled=cancelled)
    for take in batch.takes:
        name = take.source.name
        told = [left for n in (*take.notes, *batch.notes) if (left := _without_name(n, name)) != n]
        wordless = any("no words" in n for n in told)
        heard = tr("by loudness") if wordless else tr("words")
        rows.append(TakeRow(name, take.seconds, heard, " ".join(dict.fromkeys(told))))
    rows += [
        TakeRow(_file_of(w), wrong=_without_name(w, _file_of(w)), bad=True)
        for w in (*batch.failures, *without)
    ]
    return TakeListing(tuple(rows), batch if batch.takes else None)


def _rig_for(files: Sequence[Any], project: Project) -> Any:
    """Return the project's own joints where the takes are of its figure, None for those of another."""
    from metagraph.formats.clips import read_clips
    from metagraph.generation.performing import project_rig

    for each in files[:8]:
        try:
            clip = max(read_clips(each.clip), key=lambda c: c.frames)
        except FileError:
            continue
        return project_rig(project) if clip.skeleton == project.skeleton else None
    return None


def _file_of(words: str) -> str:
    """Return what a failure speaks of: its file, or its take."""
    return words.split("'")[1] if words.startswith("'") else words.split(":")[0].split(",")[0]


def _without_name(words: str, name: str) -> str:
    """Return words about a take without its name, which stands beside them; those about others as they
    are.
    """
    stem = re.escape(name)
    found = re.match(rf"(?:'{stem}'|{stem}(?:\.\w+)?)[:,]? +", words)
    left = words[found.end() :] if found else words
    return f"{left[:1].upper()}{left[1:]}" if found else words


# --- motion


@dataclass(frozen=True)
class Speaker:
    """Who is moved: a side of one of a project's conversations, which lies in a folder."""

    project: Project
    conversation: str
    side: int
    folder: Path


def make_side_motion(
    model: Model, named: str, speaker: Speaker, chance: Chance, progress: Progress, cancelled: Cancelled
) -> tuple[Loaded, tuple[str, ...]]:
    """Make the motion of one side of a conversation and keep it as a file; return what `add_clips` takes, and
    what there is to know. Raises what `hear_side` and `make_side_clip` of `performing` raise.
    """
    from metagraph.generation.performing import hear_side, make_side_clip

    project, side, folder = speaker.project, speaker.side, speaker.folder
    talk = project.conversations[speaker.conversation]
    name = tr("{talk} {side} by {model}", talk=talk.name, side=talk.sides[side].name or side + 1, model=named)
    heard = hear_side(project, speaker.conversation, side, folder)
    clip, notes = make_side_clip(model, project, heard, chance, name, progress, cancelled)
    if cancelled():
        raise CancelledError
    taken = {e.name for e in project.clips.values()}
    return save([clip], folder, FOLDER, taken)[0], notes


def with_side_moved(
    project: Project, loaded: Loaded, named: str, seed: int, ident: str, side: int
) -> Project:
    """Return the project in which a side moves with what was made. Raises EditError."""
    project = add_generated(project, [loaded], named, seed)
    made = next(e.id for e in project.clips.values() if e.path == loaded[0])
    return change_side(project, ident, side, motion=made)


@dataclass(frozen=True, eq=False)
class GeneratedPiece:
    """A clip cut from what was made. kind, limb: what it is taken for. sure: 0..1."""

    clip: Clip
    kind: Kind = "gesture"
    limb: Limb = "both"
    sure: float = 0.0


def cut_pieces(
    clips: Sequence[Clip], project: Project, progress: Progress, cancelled: Cancelled
) -> tuple[list[GeneratedPiece], str]:
    """Cut takes of one name at moments at which they rest alike, and say what each piece is taken for; or why
    there is none. Raises SynthesisError, and CancelledError.
    """
    from metagraph.synthesis.cut import explain_uncut, find_candidates
    from metagraph.synthesis.graph import find_threshold
    from metagraph.synthesis.states import read_states

    limit = find_threshold(read_states(clips)).limit
    cuts: list[Clip] = []
    for n, clip in enumerate(clips):
        if cancelled():
            raise CancelledError
        progress(n, len(clips))
        cuts += cut_into_pieces(
            clip, [(start, end) for start, end, _ in find_candidates(clip, limit, LEAST, MOST)]
        )
    if not cuts:
        return [], explain_uncut(max(clips, key=lambda c: c.duration), limit, LEAST, MOST)
    whole = [clip.renamed(f"{clips[0].name}_{n:02d}") for n, clip in enumerate(cuts, 1)]
    return propose_pieces(whole, project, cancelled), ""


def propose_pieces(cuts: Sequence[Clip], project: Project, cancelled: Cancelled) -> list[GeneratedPiece]:
    """Return clips with what each is taken for: a gesture or a fidget, by which arm."""
    from metagraph.suggest.propose import propose

    named = [clip.renamed(f"piece {n}") for n, clip in enumerate(cuts)]
    trial = edits.add_clips(project, [(f"//{n}", 0, "", clip) for n, clip in enumerate(named)])
    new = {e.path: e.id for e in trial.clips.values() if e.path.startswith("//")}
    ids = [new[f"//{n}"] for n in range(len(named))]
    found = propose(trial, ids, sources=("motion", "learned"), cancelled=cancelled)
    if cancelled():
        raise CancelledError
    out = []
    for ident, clip in zip(ids, cuts, strict=True):
        spare = found.spare.get(ident)
        p = found.proposals.get(ident) or (spare.proposal if spare is not None else None)
        kind: Kind = "fidget" if p is not None and p.kind.value == "fidget" else "gesture"
        limb: Limb = p.limb.value if p is not None else "both"
        out.append(GeneratedPiece(clip, kind, limb, p.kind.confidence if p is not None else 0.0))
    return out


def keep_pieces(chosen: Sequence[GeneratedPiece], project: Project, folder: Path) -> list[Loaded]:
    """Keep pieces as files; return what `add_clips` takes. Raises FileError."""
    return save([p.clip for p in chosen], folder, FOLDER, {e.name for e in project.clips.values()})


def with_pieces(
    project: Project,
    chosen: Sequence[GeneratedPiece],
    loaded: Sequence[Loaded],
    named: str,
    seed: int,
    stance: str | None,
) -> Project:
    """Return the project with pieces in its library, and dropped on a stance of the arms' layer unless that
    is None. Raises EditError.
    """
    project = add_generated(project, loaded, named, seed)
    if stance is None:
        return project
    ids = {e.path: e.id for e in project.clips.values()}
    for piece, (path, *_) in zip(chosen, loaded, strict=True):
        before, project = project, edits.place_clips(project, [ids[path]], "arms", piece.kind, stance)
        project = edits.update_actions(project, edits.find_added_actions(before, project), limb=piece.limb)
    return project


def find_first_stance(project: Project) -> str | None:
    """Return the stance of the arms' layer that pieces go to if nobody says otherwise: the one it begins
    in.
    """
    graph = project.graphs["arms"]
    return graph.start if graph.start in graph.stances else next(iter(graph.stances), None)


def describe_model(card: ModelCard, project: Project) -> str:
    """Return what a model is, in words: its kind, what it learned from, whose figure it moves."""
    hours = (
        tr("{minutes:.0f} minutes", minutes=60 * card.hours)
        if card.hours < 1
        else tr("{hours:.1f} hours", hours=card.hours)
    )
    learned = (
        tr(
            "{hours} of {takes}",
            hours=hours,
            takes=tr_plural("{count:,} take", "{count:,} takes", len(card.takes)),
        )
        if card.takes
        else tr("nothing")
    )
    own = project.skeleton is not None and card.skeleton.fingerprint == project.skeleton.fingerprint
    fits = tr("this project's skeleton") if own else tr("another skeleton (its motion is retargeted)")
    licences = sorted({t.licence for t in card.takes if t.licence and not t.licence.startswith("no licence")})
    told = (
        tr(" Licences of the takes: {licences}.", licences="; ".join(licences)[:160].rstrip(". "))
        if licences
        else ""
    )
    kind = KINDS.get(card.kind, card.kind)
    return tr(
        "{kind}, learned from {learned}, {steps}; made for {fits}.{told}",
        kind=kind,
        learned=learned,
        steps=tr_plural("{count:,} step", "{count:,} steps", card.steps),
        fits=fits,
        told=told,
    )
