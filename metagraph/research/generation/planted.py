"""Takes of which the truth is known: synthetic conversations, performed by the conversation driver. Clauses
draw a gesture with 75 %, its stroke on the loudest moment; responses a nod with 58 %, the partner's
hesitations with 30 %. Whoever learns from them can only find what was planted, and the same speech
performed with other seeds is what a perfect model would do.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import msgspec
from msgspec import Struct

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.conversations.writers import write_json
from metagraph.formats.gltf.writer import Keys, write_glb
from metagraph.generation.features import RATE
from metagraph.generation.networks import FPS
from metagraph.generation.poses import PoseRig, encode_clip
from metagraph.generation.takes import Take
from metagraph.graph.conversation.model import Conversation
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.playback.bake import bake
from metagraph.playback.evaluator import Evaluator
from metagraph.playback.planning.choice import key32
from metagraph.research.generation.planted_speech import SHORTEST, PlantedSpeech, make_planted_speech
from metagraph.speech.drive import drive

MINUTES = 3.0
MOST = 10_000  # conversations
AGAIN = 1_000_003  # added to moves for what stands beside planted takes
VERSION = 2  # of what is said: 1 had the same two voices in all conversations
CARD = "planted.json"  # what a folder of planted takes was made as


class Planted(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What planted takes are made of. count: conversations, two takes each. seconds: of each. seed: of what
    is said. moves: of what is done with it: others on the same speech are other draws from the truth.
    project: fingerprint of whose skeleton moves. version: of what they say and do with it.
    """

    count: int = 25
    seconds: float = MINUTES * 60
    seed: int = 1
    moves: int = 1
    project: str = ""
    version: int = VERSION


def make_planted_talk(planted: Planted, n: int) -> PlantedSpeech:
    """Return the n-th conversation, from 0, with its sound."""
    name = f"planted-{n + 1:03d}"
    said = key32(planted.seed, "speech", str(n))
    return make_planted_speech(
        planted.seconds, said, key32(planted.moves, "moves", str(planted.seed), str(n)), name
    )


def perform_planted(project: Project, conversation: Conversation, side: int) -> Clip:
    """Return how a side moves, FPS frames a second. Raises ValueError if the project has no skeleton."""
    _, plan = drive(conversation, side, project, together=False)
    return bake(Evaluator(plan, project), project, conversation.length, FPS)


def write_planted(
    project: Project,
    folder: Path,
    planted: Planted,
    licence: str = "",
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> int:
    """Write planted takes as `take_files.read_take_files` reads them; return how many conversations were
    made: those that are there already are kept, so an end midway costs one. licence: what is written beside
    them. Raises FileError, also for a folder that holds something else; ValueError for what cannot be made;
    CancelledError once `cancelled` says so.
    """
    if not 1 <= planted.count <= MOST:
        raise ValueError(f"1 to {MOST:,} conversations are planted, not {planted.count:,}")
    if project.skeleton is None:
        raise ValueError("the project has no clips: nobody can perform")
    if not {kind for _, kind in project.graphs["arms"].index} & {"gesture"}:
        raise ValueError("the project has no gestures of the arms: nothing could be planted")
    if not planted.seconds >= SHORTEST:
        raise ValueError(f"a planted conversation lasts at least {SHORTEST:g} s, not {planted.seconds:g}")
    planted = msgspec.structs.replace(planted, project=project.skeleton.fingerprint)
    _own(folder, planted)
    if licence:
        write_atomically(folder / "LICENSE.txt", (licence.rstrip() + "\n").encode())
    made = 0
    for n in range(planted.count):
        if cancelled is not None and cancelled():
            raise CancelledError
        if progress is not None:
            progress(n, planted.count)
        made += _write(project, folder, make_planted_talk, planted, n)
    return made


def perform_again(project: Project, planted: Planted, take: Take, rig: PoseRig) -> Take:
    """Return a planted take performed again, by chance of its own: what a perfect model might do. Raises
    ValueError for a take that was not planted.
    """
    if planted.version != VERSION:
        raise ValueError(f"these takes were planted by version {planted.version}, not {VERSION}: plant anew")
    number, _, side = take.source.name.removeprefix("planted-").partition("_")
    if not (number.isdigit() and side in ("1", "2") and 1 <= int(number) <= planted.count):
        raise ValueError(f"'{take.source.name}' is none of the takes that were planted")
    other = msgspec.structs.replace(planted, moves=planted.moves + AGAIN)
    clip = perform_planted(project, make_planted_talk(other, int(number) - 1).conversation, int(side) - 1)
    return replace(take, source=replace(take.source, start=0.0), poses=encode_clip(rig, clip, FPS))


def _write(
    project: Project, folder: Path, talk: Callable[[Planted, int], PlantedSpeech], planted: Planted, n: int
) -> bool:
    name = f"planted-{n + 1:03d}"
    last = folder / f"{name}.json"
    if last.exists():
        return False
    spoken = talk(planted, n)
    for side in (0, 1):
        clip = perform_planted(project, spoken.conversation, side)
        path = folder / f"{name}_{side + 1}.glb"
        # Thinning would take most of the time.
        write_glb(path, [replace(clip, name=path.stem)], keys=Keys(tolerance=0.0))
    import soundfile

    content = io.BytesIO()
    soundfile.write(content, spoken.samples.T, RATE, format="WAV", subtype="PCM_16")
    write_atomically(folder / f"{name}.wav", content.getvalue())
    write_json(spoken.conversation, last)  # a conversation that is there is whole
    return True


def read_planted(folder: Path) -> Planted | None:
    """Return what a folder's takes were planted as, None if they were not. Raises FileError."""
    path = folder / CARD
    if not path.is_file():
        return None
    try:
        return msgspec.json.decode(path.read_bytes(), type=Planted)
    except (msgspec.DecodeError, OSError) as error:
        raise FileError(
            path, f"tells of no planted takes ({error})", remedy="Choose another folder."
        ) from None


def _own(folder: Path, planted: Planted) -> None:
    """Make the folder this one's. More conversations of the same kind may be added."""
    there = read_planted(folder)
    if there is None and folder.is_dir() and any(folder.iterdir()):
        raise FileError(folder, "holds other files", remedy="Choose an empty or a new folder.")
    if there is not None and msgspec.structs.replace(there, count=planted.count) != planted:
        raise FileError(
            folder,
            f"holds takes that were planted otherwise: seed {there.seed}, moves {there.moves}, "
            f"{there.seconds:g} s each, by version {there.version}"
            + (", another character" if there.project != planted.project else ""),
            remedy="Choose another folder, or ask for the same.",
        )
    folder.mkdir(parents=True, exist_ok=True)
    more = planted if there is None or there.count < planted.count else there
    write_atomically(folder / CARD, msgspec.json.encode(more) + b"\n")
