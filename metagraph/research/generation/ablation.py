"""What each part of a model is good for: it is trained again and again on the same takes for the same time,
one thing changed at a time. The paper changes several at once: its CVAE has neither past poses nor a flow,
and MoGlow is six times as large.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

import msgspec
import numpy as np
from msgspec import Struct
from msgspec.structs import replace as changed
from numpy.typing import NDArray

from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.generation.features import (
    BOTH,
    HESITATION,
    MELS,
    NONE,
    PARTNER,
    PARTNER_STRESS,
    SELF,
    TOLD,
    compute_features,
)
from metagraph.generation.networks import (
    ACTIVITY,
    FPS,
    CvaeSizes,
    FlowSizes,
    Kind,
    MatchingSizes,
    Sizes,
    make_sizes,
)
from metagraph.generation.poses import PoseRig
from metagraph.generation.statistics import (
    DRAWS,
    MeasureRow,
    MotionSample,
    make_motion_sample,
    tabulate_measures,
)
from metagraph.generation.stored import SUFFIX, Model, read_model
from metagraph.generation.take_files import TakeFiles, read_speech
from metagraph.generation.takes import Take
from metagraph.research.generation.evaluation import HeldOut, SamplingManner, generate_poses, make_truth_row

Array = NDArray[Any]

CARD = "ablation.json"
WHOLE = "whole"


@dataclass(frozen=True)
class AblationChange:
    """One thing that is changed. name: short; words: what it is. settings: of the training. hearing: what
    of a take is left out. mirrored: twins of the takes are learned from as well. guidance: how it is
    sampled.
    """

    name: str
    words: str
    settings: Mapping[str, Any] = field(default_factory=dict)
    hearing: str = ""
    mirrored: bool = False
    guidance: float | None = None


@dataclass(frozen=True, eq=False)
class AblationJob:
    """One training. seconds: of the processor. out: the model's file."""

    kind: Kind
    sizes: Sizes
    settings: Mapping[str, Any]
    seed: int
    seconds: float
    learned: tuple[Take, ...]
    held: tuple[Take, ...]
    out: Path


class Trainer(Protocol):
    """Trains, and writes the model whole or not at all."""

    def __call__(self, job: AblationJob) -> None: ...


CHANGES = (
    AblationChange(WHOLE, "nothing changed"),
    AblationChange(
        "paper's loss", "the model and its loss as in the paper, nothing added", {"loss": "paper"}
    ),
    AblationChange("no third term", "the same without its third term", {"loss": "paper", "third": 0.0}),
    AblationChange("no guess", "no linear guess of the next code: the flow is told the poses before"),
    AblationChange("frame by frame", "codes of single frames instead of pieces of motion"),
    AblationChange("not tuned", "the code is of principal components alone", {"tuned": 0}),
    AblationChange(
        "one step",
        "a flow of a single step: the nearest to a Gaussian code that the same network can be, with the same "
        "control and past poses",
    ),
    AblationChange("no vae", "the flow on poses themselves, as many steps and units"),
    AblationChange("no past", "no past poses"),
    AblationChange("no partner", "the partner neither heard nor known to speak", hearing="partner"),
    AblationChange("no activity", "nobody tells who speaks", hearing="activity"),
    AblationChange("no ahead", "no sound after the frame; as many frames before it instead"),
    AblationChange("past told", "past poses are never dropped in training", {"past_dropped": 0.0}),
    AblationChange("no head", "no head that predicts how fast joints move", {"head": 0.0}),
    AblationChange(
        "own sounds", "no sounds but the takes' own: no other voices, rooms or noise", {"voices": 0.0}
    ),
    AblationChange("any crop", "crops in which who speaks changes are as likely as others", {"turns": 0.0}),
    AblationChange("any moment", "moments of a flow as likely late as early", {"early": 0.0, "spread": 1.0}),
    AblationChange("apart", "pieces are told by their own tokens alone, and do not meet"),
    AblationChange("no guidance", "follows the speech as it has learned to, no more", guidance=1.0),
    AblationChange("no lengths", "how far it moves is not brought to what the takes do"),
    AblationChange("mirrored", "mirror twins are learned from as well", mirrored=True),
)
NAMES = tuple(c.name for c in CHANGES)


def choose_sizes(change: AblationChange, kind: Kind, sizes: Sizes) -> tuple[Kind, Sizes] | None:
    """Return what is trained, None if the change says nothing about such a model."""
    name = change.name
    if name == "no guidance" and isinstance(sizes, FlowSizes):
        return (kind, sizes) if sizes.guided else None
    if name in ("no guidance", "any moment", "apart"):
        return _of_matching(name, kind, sizes)
    if name in ("paper's loss", "no third term", "no guess", "frame by frame", "not tuned", "no lengths"):
        return _of_flow_vae(name, kind, sizes)
    if name == "one step":
        return (kind, changed(sizes, steps=1)) if isinstance(sizes, FlowSizes) else None
    if name == "no vae":
        if not isinstance(sizes, FlowSizes) or sizes.code == "none":
            return None
        alone = {"code": "none", "dims": sizes.pose, "span": 1, "guess": False, "knots": 0}
        return "moglow", changed(sizes, **alone)
    if name == "no past":
        if isinstance(sizes, MatchingSizes):  # its tokens go on from each other; nothing else joins them
            return None
        if isinstance(sizes, CvaeSizes):
            return None
        return kind, _control(changed(sizes, guess=False, knots=0), past=0)
    if name == "past told":
        return None if isinstance(sizes, CvaeSizes) else (kind, sizes)
    if name == "no ahead":
        if isinstance(sizes, MatchingSizes):  # a chunk hears itself
            return None
        control = sizes.control
        return kind, _control(sizes, before=control.before + control.ahead, ahead=0)
    return kind, sizes


def _of_matching(name: str, kind: Kind, sizes: Sizes) -> tuple[Kind, Sizes] | None:
    if not isinstance(sizes, MatchingSizes) or (name == "apart" and not sizes.around):
        return None
    return kind, changed(sizes, around=0) if name == "apart" else sizes


def _of_flow_vae(name: str, kind: Kind, sizes: Sizes) -> tuple[Kind, Sizes] | None:
    if not isinstance(sizes, FlowSizes) or sizes.code != "variational":
        return None
    if name in ("paper's loss", "no third term"):
        published = make_sizes("flow-vae", "small", sizes.pose, sizes.control.audio, as_published=True)
        return kind, published if sizes.guess else sizes
    if not sizes.guess:
        return (kind, sizes) if name == "not tuned" else None
    if name == "frame by frame":
        return kind, changed(sizes, span=1)
    if name == "no lengths":
        return (kind, changed(sizes, knots=0)) if sizes.knots else None
    return kind, changed(sizes, guess=False, knots=0) if name == "no guess" else sizes


def _control(sizes: FlowSizes | CvaeSizes, **new: int) -> FlowSizes | CvaeSizes:
    return changed(sizes, control=changed(sizes.control, **new))


def ablate_features(change: AblationChange, take: Take, files: Mapping[str, TakeFiles]) -> Array:
    """Return what is left of a take's features `[T, ...]`. files: by the takes' names, whose sounds are
    heard again without the partner. Raises FileError.
    """
    out = take.features.copy()
    activity = out[:, -ACTIVITY:]
    if change.hearing == "activity":
        activity[:] = 0
        activity[:, NONE] = 1
        out[:, -TOLD:-ACTIVITY] = 0
    elif change.hearing == "partner":
        activity[:, SELF] += activity[:, BOTH]
        activity[:, NONE] += activity[:, PARTNER]
        activity[:, [PARTNER, BOTH]] = 0
        out[:, -TOLD:][:, [PARTNER_STRESS, HESITATION]] = 0
        found = files.get(take.source.name)
        samples = read_speech(found).samples if found is not None else None
        tracks = (out.shape[1] - ACTIVITY) // MELS
        if samples is not None and len(samples) == 2:
            samples = np.stack([samples[0], np.zeros_like(samples[0])])
            first = round(take.source.start * FPS)
            alone = compute_features(samples, np.zeros((0, ACTIVITY)), tracks)
            out[:, :-TOLD] = alone[first : first + len(out), :-TOLD]
    return out


class Asked(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What an ablation's folder is of. takes: hashes of their files."""

    format: int = 1
    kind: Kind
    sizes: Sizes
    seconds: float
    trainings: int
    takes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Ablated:
    """rows: the table, what stands beside first. ran: what was trained just now; kept: what was there. left:
    changes that say nothing about such a model.
    """

    rows: tuple[MeasureRow, ...]
    ran: tuple[str, ...]
    kept: tuple[str, ...]
    left: tuple[str, ...]


def make_ablation_path(folder: Path, change: AblationChange, training: int) -> Path:
    """Return where a model of an ablation is kept."""
    return folder / f"{change.name.replace(' ', '-').replace(chr(39), '')}-{training}{SUFFIX}"


@dataclass(frozen=True, eq=False)
class AblationMaterial:
    """What models are trained and judged on. files: by the takes' names. twins: mirror twins of what is
    learned from, made where they are needed.
    """

    rig: PoseRig
    learned: Sequence[Take]
    held: HeldOut
    files: Mapping[str, TakeFiles]
    twins: Callable[[], Sequence[Take]]

    def heard(self, change: AblationChange, takes: Sequence[Take]) -> list[Take]:
        """Return takes with what a change leaves of their sound."""
        if not change.hearing:
            return list(takes)
        return [replace(t, features=ablate_features(change, t, self.files)) for t in takes]


@dataclass(frozen=True)
class AblationTraining:
    """How each model is trained. seconds: of the processor. trainings: how many of each, by other seeds."""

    kind: Kind
    sizes: Sizes
    seconds: float = 60.0
    trainings: int = 1


def ablate_model(
    folder: Path,
    trainer: Trainer,
    material: AblationMaterial,
    training: AblationTraining,
    changes: Sequence[AblationChange] = CHANGES,
    manner: SamplingManner = SamplingManner(),  # noqa: B008
    draws: int = DRAWS,
    progress: Callable[[str], None] | None = None,
) -> Ablated:
    """Train and judge a model with one thing changed at a time. folder: where models are kept, and found
    again by the next run. Raises FileError if the folder is of another ablation, and what trainings raise.
    """
    seconds, trainings = training.seconds, training.trainings
    if not seconds > 0 or not 1 <= trainings <= 20:
        raise ValueError("an ablation has 1 to 20 trainings of each kind, of more than 0 s")
    rig, held, floor = material.rig, material.held.takes, material.held.floor
    _own(folder, _asked(material, training))
    true = tuple(make_motion_sample(rig, t.poses, t) for t in held)
    systems: dict[str, list[tuple[MotionSample, ...]]] = {}
    ran, kept, left = [], [], []
    for change in changes:
        wanted = choose_sizes(change, training.kind, training.sizes)
        if wanted is None:
            left.append(change.name)
            continue
        hearing = material.heard(change, held)
        systems[change.name] = []
        for seed in range(1, trainings + 1):
            # What differs in how it is sampled alone is not trained again.
            out = make_ablation_path(folder, change if change.guidance is None else CHANGES[0], seed)
            name = f"{change.name}, seed {seed}"
            if progress is not None:
                progress(name)
            if out.exists():
                kept.append(name)
            else:
                some = material.heard(change, material.learned)
                if change.mirrored:
                    some += material.twins()
                trainer(
                    AblationJob(*wanted, change.settings, seed, seconds, tuple(some), tuple(hearing), out)
                )
                ran.append(name)
            how = manner if change.guidance is None else replace(manner, guidance=change.guidance)
            systems[change.name] += _made(rig, read_model(out), how, hearing, held)
    other = (
        None if floor is None else [make_motion_sample(rig, p, t) for p, t in zip(floor, held, strict=True)]
    )
    rows = [make_truth_row(true, other, draws), *tabulate_measures(systems, true, other, draws)]
    return Ablated(tuple(rows), tuple(ran), tuple(kept), tuple(left))


def _asked(material: AblationMaterial, training: AblationTraining) -> Asked:
    takes = (*material.learned, *material.held.takes)
    return Asked(
        kind=training.kind,
        sizes=training.sizes,
        seconds=training.seconds,
        trainings=training.trainings,
        takes=tuple(t.source.digests[0] if t.source.digests else t.source.name for t in takes),
    )


def _made(
    rig: PoseRig, model: Model, manner: SamplingManner, hearing: Sequence[Take], held: Sequence[Take]
) -> list[tuple[MotionSample, ...]]:
    """Return a model's motion to what it hears, each seed's. What is judged is the motion beside all that was
    said, whatever the model heard of it.
    """
    out = []
    for seed in range(1, manner.seeds + 1):
        poses = [generate_poses(model, t.features, seed, n, manner) for n, t in enumerate(hearing)]
        out.append(tuple(make_motion_sample(rig, p, t) for p, t in zip(poses, held, strict=True)))
    return out


def _own(folder: Path, asked: Asked) -> None:
    path = folder / CARD
    text = msgspec.json.encode(asked)
    if path.is_file():
        try:
            there = msgspec.json.decode(path.read_bytes(), type=Asked)
        except msgspec.DecodeError as error:
            raise FileError(
                path, f"tells of no ablation ({error})", remedy="Choose another folder."
            ) from None
        # More trainings of the same may be added.
        if changed(there, trainings=asked.trainings) != asked:
            what = [
                n for n in ("kind", "sizes", "seconds", "takes") if getattr(there, n) != getattr(asked, n)
            ]
            raise FileError(
                folder,
                f"is of an ablation with other {', '.join(what) or 'format'}",
                remedy="Choose another folder, or ask for the same.",
            )
    elif folder.is_dir() and any(folder.iterdir()):
        raise FileError(folder, "holds other files", remedy="Choose an empty or a new folder.")
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(path, text + b"\n")
