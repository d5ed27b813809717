"""Exhibits of the third paper: how far a generator's motion goes from the mean pose, how it speaks and
listens, and how large the models are.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from msgspec.structs import replace

from metagraph.formats.clips import digest
from metagraph.generation.features import PARTNER, RATE, SELF
from metagraph.generation.landmarks import LANDMARKS
from metagraph.generation.networks import Kind, count_parameters, make_sizes
from metagraph.generation.performing import moves_skeleton, read_side_sound
from metagraph.generation.statistics import mean_landmarks, measure_wasserstein
from metagraph.generation.takes import SplitError, Take, TakeError, TakeSound, TakeSource, make_take
from metagraph.graph.editing.retargeting import Bringing
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial
from metagraph.research.exhibits.published import HELD_OUT, JOINTS, PARAMETERS
from metagraph.research.generation import figures
from metagraph.research.generation.evaluation import (
    HeldOut,
    JudgedModels,
    SamplingManner,
    find_unseen_takes,
    judge_on_takes,
)

NO_MODEL = (
    "there is no learned generator: it comes with the program where it is installed (sample_clips/models), "
    "or train one with `metagraph generate train` and name it with --model"
)
QUICK = 100.0  # seconds that are judged, where not all is
KINDS: tuple[Kind, ...] = ("flow-vae", "moglow", "cvae")


def exhibit_distance(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 6: how far landmarks are from the mean pose."""
    found = _judged(material)
    if isinstance(found, str):
        return MadeExhibit(_about(material), missing=found)
    mean = mean_landmarks(found.true)
    motion = {"recorded": found.true, "generated": next(iter(found.made.values()))[0]}
    far = {name: figures.measure_landmark_distances(m, mean) for name, m in motion.items()}
    top = max(float(v.max()) for v in far.values())
    rows = []
    for n, landmark in enumerate(LANDMARKS):
        true, ours = (far[name][:, n] for name in motion)
        cells = (_quartiles(true), _quartiles(ours), f"{measure_wasserstein(true, ours):.2f}")
        rows.append((landmark.replace("_", " "), *cells))
    parts = [
        ExhibitDrawing(f"{name}: the first take", figures.draw_over_time(m[0], mean, top))
        for name, m in motion.items()
    ]
    parts.append(ExhibitDrawing("Notched boxes; whiskers by Tukey", figures.draw_boxes(far, "cm")))
    parts.append(
        ExhibitDrawing(
            "Poses of the first take, one a second, from the front",
            figures.draw_overlaid({n: m[0] for n, m in motion.items()}),
        )
    )
    wrists = {name: np.percentile(v[:, 5:7], (25, 75)) for name, v in far.items()}
    spans = {name: float(b - a) for name, (a, b) in wrists.items()}
    says = (
        "The paper prints this figure without numbers: its ground truth, Flow-VAE, MoGlow and CVAE cannot "
        "be laid beside ours but by eye, and are of another person. Each column here is beside the "
        "recorded motion it should look like.",
        f"Wrists' range between quartiles: {spans['generated']:.1f} cm generated, {spans['recorded']:.1f} "
        "cm recorded. The paper finds its own 'at a similar scale' and its CVAE less active.",
    )
    head = ("landmark", "recorded: quartiles, cm", "generated: quartiles, cm", "apart (W1), cm")
    return MadeExhibit(
        _about(material),
        says,
        (ExhibitTable("Distance from the mean pose", head, tuple(rows)), *parts),
        {"wrists": spans},
    )


def exhibit_roles(material: ExhibitMaterial) -> MadeExhibit:
    """Figures 7 and 8: how fast that distance changes while speaking and while listening."""
    found = _judged(material)
    if isinstance(found, str):
        return MadeExhibit(_about(material), missing=found)
    mean = mean_landmarks(found.true)
    motion = {"recorded": found.true, "generated": next(iter(found.made.values()))[0]}
    parts, rows = [], []
    means: dict[str, list[float]] = {}
    for who, words in ((SELF, "speaking"), (PARTNER, "listening")):
        grown = {name: figures.measure_distance_changes(m, mean, who) for name, m in motion.items()}
        parts.append(ExhibitDrawing(f"While {words}", figures.draw_boxes(grown, "cm/s")))
        for name, values in grown.items():
            fast = float(np.abs(values).mean()) if len(values) else float("nan")
            means.setdefault(name, []).append(fast)
            signed = float(np.median(values)) if len(values) else float("nan")
            rows.append((words, name, f"{len(values)}", f"{fast:.2f}", f"{signed:+.3f}"))
    ratios = {name: a / b if b else float("nan") for name, (a, b) in means.items()}
    says = (
        "Speaking over listening, by the mean change without its sign: "
        + ", ".join(f"{name} {r:.2f}" for name, r in ratios.items())
        + ". The paper draws figures 7 and 8 and says that both behave alike.",
        "It also says that gradients become negative while listening, since the actor moves towards the "
        "mean pose. Over a whole conversation positive and negative changes must nearly cancel; medians "
        "stand in the table.",
    )
    head = ("while", "", "frames", "mean change, cm/s", "median with its sign, cm/s")
    return MadeExhibit(
        _about(material),
        says,
        (ExhibitTable("Change of the distance", head, tuple(rows)), *parts),
        {"ratio": ratios},
    )


def exhibit_sizes(material: ExhibitMaterial) -> MadeExhibit:
    """Section 7: trainable parameters."""
    rows: list[tuple[str, ...]] = []
    numbers: dict[str, list[float]] = {}
    for kind in KINDS:
        same, small = (
            count_parameters(make_sizes(kind, "paper", 6 * JOINTS)),
            count_parameters(make_sizes(kind, "small")),
        )
        there = PARAMETERS[kind]
        rows.append(
            (kind, f"{there / 1e6:g} M", f"{same / 1e6:.2f} M", f"{same / there:.2f}", f"{small / 1e6:.2f} M")
        )
        numbers[kind] = [there, same, small]
    ours = count_parameters(make_sizes("matching"))
    rows.append(("matching", "-", "-", "-", f"{ours / 1e6:.2f} M"))
    one = count_parameters(replace(make_sizes("flow-vae", "paper", 6 * JOINTS), layers=1))
    less = 1 - PARAMETERS["flow-vae"] / PARAMETERS["moglow"]
    says = (
        "Counted for 9 joints of 6 numbers and the sizes the text gives: 1,231 numbers of control (31 "
        "frames of 31, 5 poses of 54), K = 8 and 16 steps, 400 and 800 units. The text does not tell how "
        f"many layers each LSTM has: two here; with one the Flow-VAE would have {one / 1e6:.1f} M.",
        f"The paper says 80 % fewer than MoGlow; by its own counts {less:.0%}. CVAE and MoGlow come out, "
        f"its Flow-VAE counts {numbers['flow-vae'][1] / 1e6:.1f} M here: what makes the rest is not told.",
    )
    head = ("model", "there", "here, the paper's sizes", "ratio", "here, for a processor")
    return MadeExhibit("the papers' sizes", says, (ExhibitTable("Parameters", head, tuple(rows)),), numbers)


@lru_cache(maxsize=1)
def _judged(material: ExhibitMaterial) -> JudgedModels | str:
    """Return the model judged on takes that it has not seen, or why it cannot be."""
    model = material.learned
    if model is None:
        return NO_MODEL
    takes: list[Take] = []
    bringing = Bringing(material.project) if moves_skeleton(model, material.project) else None
    brought = 0
    for recorded in material.conversations:
        for side in (0, 1):
            clip = recorded.clips[side]
            if clip is None or sum(t.seconds for t in takes) > (HELD_OUT if material.full else QUICK):
                continue
            digests = tuple(digest(p) for p in recorded.files)
            source = TakeSource(f"{recorded.name} {side + 1}", digests or (recorded.name,), "")
            if recorded.samples is not None:
                samples = recorded.samples[::-1] if side else recorded.samples
            else:
                samples, told = read_side_sound(recorded.conversation, side, Path())
                material.notes.extend(told)
            try:
                if clip.skeleton != model.rig.skeleton and bringing is not None:
                    known = bringing.known(clip) or bringing.propose(clip.skeleton)
                    clip, brought = bringing.bring(clip, known), brought + 1
                heard = TakeSound(samples, RATE)
                takes.append(make_take(model.rig, clip, heard, source, recorded.conversation, side))
            except (TakeError, ValueError) as error:
                material.notes.append(str(error))
    if not takes:
        return (
            "no take can be judged by this model"
            + (f" ({material.notes[-1]})" if material.notes else "")
            + ": train one of these takes with `metagraph generate train`, and name it with --model"
        )
    if brought:
        material.notes.append(f"{brought} takes were retargeted onto the model's figure to be judged")
    try:
        fresh, left = find_unseen_takes(model, takes)
    except SplitError as error:
        return str(error)
    if left:
        material.notes.append(f"{len(left)} takes are left out, since the model has learned from them")
    return judge_on_takes(model.rig, {"generated": model}, HeldOut(fresh), SamplingManner(seeds=1), draws=0)


def _about(material: ExhibitMaterial) -> str:
    seen = (
        "the model has not learned from them, though from takes of the same maker"
        if material.made_up
        else ("takes that the model has learned from are left out")
    )
    name = material.model.name if material.model is not None else "none"
    return f"{material.about}; model: {name}; {seen}"


def _quartiles(values: np.ndarray) -> str:
    a, b, c = np.percentile(values, (25, 50, 75))
    return f"{a:.1f}, {b:.1f}, {c:.1f}"
