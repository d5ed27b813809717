"""What the compiled loops read: clips, rests and cues, laid out flat, for one character and for many.

Clips are laid out once for a rig and kept for as long as they live; rests and cues are laid out for a plan,
or for the part of it that is looked at.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from threading import Lock
from typing import Any
from weakref import WeakKeyDictionary, ref

import numpy as np
from numpy.typing import NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.motion.clip import Clip
from metagraph.playback.composer import ComposerRig, playable
from metagraph.playback.plan import Cue, Rest

Array = NDArray[Any]

# Records of what the loops read; a clip's `first` is its first row in the layer's tables.
CLIP = np.dtype([("first", "i8"), ("frames", "i8"), ("fps", "f8")])
REST = np.dtype(
    [(n, "f8") for n in ("start", "fade_start", "fade", "first", "length", "seam", "period")]
    + [("clip", "i8")]
)
_TIMES = ("start", "end", "entry", "blend_in", "blend_out", "extent", "tempo", "held", "hold", "rate")
CUE = np.dtype([(n, "f8") for n in _TIMES] + [("clip", "i8"), ("mask", "i8")])

LANES = 16  # joints in a block; numba does not see it change: save crowd_kernels.py anew, too
ROWS = 1024  # of a table that begins

# Of a layer, for several plans: rests `[R]` and when they begin to fade in, cues `[C]` and when they start,
# apart since they are searched; where each plan's begin, `[P + 1, 2]`; its clips,
# their turns `[rows, b, 64]` in blocks `[b]` and ways `[rows, m, 3]` of joints `[m]`; `lanes [4 + K, b, 16]`
# and `mover_lanes [4 + K, m]`, as `crowd_kernels.MASKS` has it.
LaidLayer = tuple[Array, ...]
Line = tuple[Sequence[Rest], Sequence[Cue]]  # a layer's rests and cues


class Layout:
    """A rig laid out: its base pose in blocks `[B, 64]`, joints' places in those `[J]`, parents `[J]`, and
    the clips of each layer as far as they were asked for.
    """

    def __init__(self, frame: ComposerRig) -> None:
        blocks = _Blocks(frame)
        self.places, self.base = blocks.places, blocks.base()
        self.travels = frame.ground.base.translations.astype(np.float32)
        self.parents = frame.ground.skeleton.parents.astype(np.int64)
        self._frame = ref(frame)
        self._clips = {layer: _Clips(frame, layer, blocks) for layer in LAYERS}
        self._one = Lock()

    def lay(self, project: Project, lines: Mapping[Layer, Sequence[Line]]) -> tuple[LaidLayer, ...]:
        """Return the layers, laid out, with the rests and cues of some plans."""
        frame = self._frame()
        assert frame is not None
        with self._one:
            return tuple(_lay(self._clips[layer], frame, project, lines[layer]) for layer in LAYERS)


_known: WeakKeyDictionary[ComposerRig, Layout] = WeakKeyDictionary()


def layout(frame: ComposerRig) -> Layout:
    """Return the layout of a rig; always the same."""
    found = _known.get(frame)
    return found if found is not None else _known.setdefault(frame, Layout(frame))


class _Blocks:
    """Joints in blocks of 16 that the same layers reach, so that a layer's joints are whole blocks. places
    `[J]`: of each joint's x.
    """

    def __init__(self, frame: ComposerRig) -> None:
        self.rotations = frame.ground.base.rotations
        reached = np.zeros(len(self.rotations), int)
        for n, layer in enumerate(LAYERS):
            reached[frame.reach[layer].joints] += 1 << n
        self.places = np.zeros(len(reached), np.int64)
        self.kinds: list[int] = []  # of each block, which layers reach it
        for kind in np.unique(reached):
            joints = np.flatnonzero(reached == kind)
            lane = np.arange(len(joints))
            self.places[joints] = (len(self.kinds) + lane // LANES) * 4 * LANES + lane % LANES
            self.kinds += [int(kind)] * (-(-len(joints) // LANES))

    def base(self) -> Array:
        """Return the base pose's rotations `[B, 64]`."""
        every = np.arange(len(self.kinds))
        return np.asarray(self.spread(self.rotations[None], np.arange(len(self.rotations)), every)[0])

    def of(self, layer: Layer) -> Array:
        """Return the blocks a layer reaches."""
        return np.array([b for b, kind in enumerate(self.kinds) if kind >> LAYERS.index(layer) & 1], np.int64)

    def spread(self, rotations: Array, joints: Array, own: Array) -> Array:
        """Return rotations `[F, n, 4]` of joints `[n]` in blocks `own [b]`, `[F, b, 64]`; no rotation
        elsewhere.
        """
        out = np.zeros((len(rotations), len(own), 4, LANES), np.float32)
        out[:, :, 3] = 1
        block, lane = np.divmod(self.places[joints], 4 * LANES)
        out[:, np.searchsorted(own, block), :, lane] = rotations.swapaxes(0, 1)
        return out.reshape(len(rotations), -1, 4 * LANES)

    def lanes(self, values: Array, joints: Array, own: Array, otherwise: float) -> Array:
        """Return a number for each joint, `values [n]`, in blocks `own [b]`, `[b, 16]`."""
        out = np.full((len(own), LANES), otherwise, np.float32)
        block, lane = np.divmod(self.places[joints], 4 * LANES)
        out[np.searchsorted(own, block), lane] = values
        return out


class _Clips:
    """The clips of one layer, one after the other in tables that grow. What was laid out with older tables
    keeps those.
    """

    def __init__(self, frame: ComposerRig, layer: Layer, blocks: _Blocks) -> None:
        self.reach = frame.reach[layer]
        self.blocks, self.own = blocks, blocks.of(layer)
        self._lanes: dict[tuple[bytes, float], Array] = {}
        self._begin()

    def _begin(self) -> None:
        self.known: WeakKeyDictionary[Clip, int] = WeakKeyDictionary()
        self.clips: list[tuple[int, int, float]] = []
        self.rows = 0
        self.moved = np.empty(0, np.int64)  # places among the layer's joints
        self.turns = np.zeros((0, len(self.own), 4 * LANES), np.float32)
        self.ways = np.zeros((0, 0, 3), np.float32)

    def lanes(self, scales: Array, masks: Sequence[Array]) -> tuple[Array, Array]:
        """Return numbers of joints as `crowd_kernels.MASKS` has them, in blocks and of those that move.
        scales `[2, J]`.
        """
        reach, count = self.reach, len(self.reach.joints)
        weights = np.ones(count, np.float32) if reach.weights is None else reach.weights[:, 0]
        weighed = np.full(count, float(reach.weights is not None), np.float32)
        rows = [*scales[:, reach.joints], weights, weighed, *masks]
        out = np.array([self._spread(row, n) for n, row in enumerate(rows)])
        return out, np.ascontiguousarray(np.array(rows)[:, self.moved])

    def _spread(self, row: Array, place: int) -> Array:
        otherwise = 0.0 if place < 2 else 1.0
        key = row.tobytes(), otherwise
        if key not in self._lanes:
            self._lanes[key] = self.blocks.lanes(row, self.reach.joints, self.own, otherwise)
        return self._lanes[key]

    def tidy(self) -> None:
        """Begin anew where more clips are gone than live."""
        if self.rows > ROWS and 2 * len(self.known) < len(self.clips):
            self._begin()

    def add(self, frame: ComposerRig, clip: Clip) -> int:
        """Return a clip's number; it is laid out where it has none yet."""
        known = self.known.get(clip)
        if known is not None:
            return known
        offsets = frame.ground.offsets(clip, self.reach, keep=False)
        self._grow(self.rows + clip.frames, offsets.moved)
        here = slice(self.rows, self.rows + clip.frames)
        self.turns[here] = self.blocks.spread(offsets.rotations, self.reach.joints, self.own)
        self.ways[here, np.searchsorted(self.moved, offsets.moved)] = offsets.translations
        number = self.known[clip] = len(self.clips)
        self.clips.append((self.rows, clip.frames, clip.fps))
        self.rows += clip.frames
        return number

    def _grow(self, rows: int, moved: Array) -> None:
        every = np.union1d(self.moved, moved)
        most = len(self.turns)
        if rows > most:
            most = max(ROWS if not most else most + most // 2, rows)
            turns = np.zeros((most, *self.turns.shape[1:]), np.float32)
            turns[: self.rows] = self.turns[: self.rows]
            self.turns = turns
        if most != len(self.ways) or len(every) != len(self.moved):
            ways = np.zeros((most, len(every), 3), np.float32)
            ways[: self.rows, np.searchsorted(every, self.moved)] = self.ways[: self.rows]
            self.ways, self.moved = ways, every


def _lay(clips: _Clips, frame: ComposerRig, project: Project, lines: Sequence[Line]) -> LaidLayer:
    clips.tidy()
    joints = clips.reach.joints
    numbers: dict[str, int] = {}
    masks: list[Array] = []
    mask_of: dict[bytes, int] = {}

    def number(action: Action) -> int:
        if action.id not in numbers:
            motion = playable(project, action)
            numbers[action.id] = -1 if motion is None else clips.add(frame, motion)
        return numbers[action.id]

    def mask(action: Action) -> int:
        found = anatomy.mask(project, action)
        shown = found[joints] if found is not None else None
        if shown is None or (shown == 1).all():
            return -1
        key = shown.tobytes()
        if key not in mask_of:
            mask_of[key] = len(masks)
            masks.append(shown)
        return mask_of[key]

    rests: list[tuple[float, ...]] = []
    cues: list[tuple[float, ...]] = []
    at = [(0, 0)]
    for some_rests, some_cues in lines:
        rests += [_rest(project, rest, number(rest.action)) for rest in some_rests]
        for cue in some_cues:
            times = (cue.start, cue.end, cue.entry, cue.blend_in, cue.blend_out, cue.extent, cue.tempo)
            cues.append((*times, *_held(cue), number(cue.action), mask(cue.action)))
        at.append((len(rests), len(cues)))
    rest_table, cue_table = np.array(rests, REST), np.array(cues, CUE)
    return (
        *(rest_table, rest_table["fade_start"].copy(), cue_table, cue_table["start"].copy()),
        np.array(at, np.int64),
        np.array(clips.clips, CLIP),
        clips.turns,
        clips.ways,
        clips.own,
        joints[clips.moved],
        *clips.lanes(anatomy.scales(project), masks),
    )


def _held(cue: Cue) -> tuple[float, float, float]:
    """Return clip seconds before the hold, seconds of it, and clip seconds a second in it."""
    return (
        (cue.hold_from - cue.entry, cue.hold, (cue.hold_to - cue.hold_from) / cue.hold)
        if cue.hold > 0
        else (0.0, 0.0, 1.0)
    )


def _rest(project: Project, rest: Rest, clip: int) -> tuple[float, ...]:
    first, end = project.span(rest.action)
    length = end - first
    seam = min(max(0.0, rest.action.timing.blend_in), length / 2)
    return (rest.start, rest.fade_start, rest.fade, first, length, seam, length - seam, clip)
