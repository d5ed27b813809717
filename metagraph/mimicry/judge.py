"""One layer of one person: the running mean of the points, how far each stance is, which one they are in."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, exp, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.graph.words import Layer
from metagraph.mimicry.keypoint_layouts import POINTS
from metagraph.mimicry.pose_measures import (
    COUNT,
    LEAST_EVIDENCE,
    MOVED,
    MOVING,
    SCALE,
    SHARP,
    MeasuredFrame,
    measure_body_frame,
    measure_pose,
    measure_trust,
    turn_about_y,
    weigh_in_picture,
)
from metagraph.mimicry.signatures import Signature
from metagraph.mimicry.tuning import Tuning

Array = NDArray[Any]

TURNS = np.radians(np.arange(-60, 61, 10))  # headings that are tried in a picture
ALIKE = 0.5  # distance below which two stances are not distinguished in a picture
AWAY = 0.15  # width of the shoulders in a picture, torso lengths, below which somebody turns the back
LEAST_TRUST = 0.1  # of a running mean in a point, below which it is almost not seen
SIDEWAYS = np.array([1.0, 1.0, 0.3])  # how much speed counts along each axis; depth jitters


class Mean:
    """A running mean of POINTS by confidence; what is not seen stays where it was and is trusted less and
    less.
    """

    def __init__(self, constant: float) -> None:
        self.constant = constant
        self._sums = np.zeros((len(POINTS), 4))  # x, y, z by confidence, and confidence

    def feed(self, elapsed: float, weighted: Array) -> None:
        """Take points in, `[17, 4]`: x, y, z, each times the confidence, and the confidence."""
        keep = exp(-elapsed / self.constant)
        self._sums *= keep
        self._sums += (1.0 - keep) * weighted

    def points(self) -> Array:
        """Return the mean `[17, 3]`."""
        return np.asarray(self._sums[:, :3] / np.maximum(self._sums[:, 3:], 1e-9))

    @property
    def trust(self) -> Array:
        """How far each point can be trusted, `[17]`, 0 or LEAST_TRUST to 1."""
        sure = self._sums[:, 3]
        return np.where(sure > LEAST_TRUST, sure, 0.0)


@dataclass(slots=True)
class PersonView:
    """A person as a layer sees them now: points `[17, 3]`, what they are trusted `[17]`, measures `[N, 3]`
    and their trust `[N, 1]`.
    """

    points: Array
    trust: Array
    frame: MeasuredFrame
    measures: Array
    share: Array


class Judge:
    """Tells a layer's stances apart. start: the stance the character is in before anything is known.

    now: place of the stance the person is in, among the signature's; None if that is not known. distances:
    `[S]` from each stance, None without evidence. bias `[N, 3]`: what of the person's difference from the
    character is got used to.
    """

    def __init__(
        self, layer: Layer, signature: Signature, tuning: Tuning, start: str | None, width: float
    ) -> None:
        self.layer, self.signature, self.tuning, self.how, self.width = (
            layer,
            signature,
            tuning,
            tuning.layers[layer],
            width,
        )
        self.start = signature.stances.index(start) if start in signature.stances else None
        self.now: int | None = None
        self.distances: Array | None = None
        self.moving = False
        self.bias = np.zeros(signature.measures.shape[1:])
        self.flat = np.stack([turn_about_y(signature.measures, angle)[..., :2] for angle in TURNS])
        self._alike = self._confused()
        self._first = np.searchsorted(
            signature.of, np.arange(len(signature.stances))
        )  # looks of one stance stand together
        self._known = 0.0  # seconds for which the person could be got used to
        self._coming: int | None = None
        self._since = 0.0
        self.begin()

    def begin(self) -> None:
        """Forget where the points were."""
        self.mean = Mean(self.how.smooth)
        self.forget()

    def forget(self) -> None:
        """Know nothing of this moment; what was known of the stance holds."""
        self.distances, self._coming = None, None

    @property
    def stance(self) -> str | None:
        """Id of the stance the person is in."""
        return None if self.now is None else self.signature.stances[self.now]

    def view(self, dims: int) -> PersonView | None:
        """Return the person as they are now; None if they cannot be made out or show the back."""
        points, trust = self.mean.points(), self.mean.trust
        frame = measure_body_frame(points, trust, dims, self.width)
        if frame is None or (dims == 2 and frame.width < AWAY):
            return None
        return PersonView(
            points,
            trust,
            frame,
            measure_pose(self.layer, points, frame),
            measure_trust(self.layer, trust)[:, None],
        )

    def misfits(self, view: PersonView) -> Array | None:
        """Return how badly the best stance fits a picture under each of the TURNS, a squared distance; None
        without evidence.
        """
        count = float((COUNT[self.layer][:, :2] * view.share).sum())
        if count <= 0:
            return None
        apart = self.flat - view.measures[:, :2] + self.bias[:, :2]
        sharp = (SHARP[self.layer][:, :2] * view.share).reshape(-1)
        return np.asarray(((apart.reshape(*apart.shape[:2], -1) ** 2) @ sharp).min(1) / count)

    def judge(
        self, seconds: float, elapsed: float, view: PersonView, quick: Array, heading: float, dims: int
    ) -> bool:
        """Take a moment in; return whether the person is in another stance from now on. quick `[17, 3]`: the
        points, hardly smoothed. heading: of somebody in a picture, radians.
        """
        self.moving = self._moves(view, quick)
        found = self._measure(view, heading, dims)
        if found is None:
            self.forget()
            return False
        apart, far, sharp = found
        self.distances = np.minimum.reduceat(far, self._first)
        if self.moving:
            self._coming = None
            return False
        changed = self._decide(seconds, self.distances, apart, far, sharp)
        if self.now is not None and self._coming is None and self.distances[self.now] < self.how.near:
            self._get_used(elapsed, apart, far, view.share, dims)
        return changed

    def _moves(self, view: PersonView, quick: Array) -> bool:
        """Whether the layer moves too fast for a stance."""
        rows = MOVING[self.layer]
        known = np.where(MOVED[self.layer], view.trust, 1.0).min(1) > 0
        way = rows @ (quick - view.points) * SIDEWAYS
        most = (self.how.still * (self.how.smooth - self.tuning.quick) * view.frame.size) ** 2
        return bool((((way * way).sum(1) > most) & known).any())

    def _measure(self, view: PersonView, heading: float, dims: int) -> tuple[Array, Array, Array] | None:
        """Return by how much the person differs from each look of a stance, `[T, N, dims]`, how far that is,
        `[T]`, and what squared differences count for, `[N * dims]`; None without enough evidence.
        """
        every = COUNT[self.layer][:, :dims]
        count = float((every * view.share).sum())
        if count < LEAST_EVIDENCE * float(every.sum()):
            return None
        sharp, usual, extra = SHARP[self.layer], self.signature.measures, self.signature.extra
        if dims == 2:
            sharp, usual = weigh_in_picture(self.layer, heading), usual[..., :2] * [cos(heading), 1.0]
            usual[..., 0] += sin(heading) * self.signature.measures[..., 2]
            extra = extra + self._alike[int(np.abs(TURNS - heading).argmin())]
        apart = view.measures[:, :dims] - usual
        off = (apart - self.bias[:, :dims]).reshape(len(apart), -1)
        sharp = (sharp[:, :dims] * view.share).reshape(-1) / count
        return apart, np.sqrt(off**2 @ sharp) + extra, sharp

    def _decide(self, seconds: float, near: Array, apart: Array, far: Array, sharp: Array) -> bool:
        """Change over to the nearest stance once it has been nearest for long enough; return whether that is
        now.
        """
        best = int(near.argmin())
        here = self.now if self.now is not None else self.start
        if here is not None and here != best and near[here] < self.tuning.left:
            least = self.how.way if self.now is not None else self.tuning.way_first
            if self._way(here, best, apart, far, sharp) < least:
                best = here
        if best == self.now or near[best] > self.how.near:
            self._coming = None
            return False
        if self._coming != best:
            self._coming, self._since = best, seconds
        if seconds - self._since < self.how.dwell - 1e-9:
            return False
        self.now, self._coming = best, None
        return True

    def _way(self, here: int, other: int, apart: Array, far: Array, sharp: Array) -> float:
        """Return how much of the way from one stance to another somebody has gone, whatever they do beside
        it.
        """
        a, b = self._look(here, far), self._look(other, far)
        between = float(((apart[a] - apart[b]) ** 2).reshape(-1) @ sharp)
        return 0.5 + float(far[a] ** 2 - far[b] ** 2) / max(2.0 * between, 1e-9)

    def _look(self, stance: int, far: Array) -> int:
        """Return the place of a stance's nearest look."""
        first = int(self._first[stance])
        last = int(self._first[stance + 1]) if stance + 1 < len(self._first) else len(far)
        return first + int(far[first:last].argmin())

    def _get_used(self, elapsed: float, apart: Array, far: Array, share: Array, dims: int) -> None:
        """Get used to how the person differs from the character in the stance they are in, within limits."""
        assert self.now is not None
        off = apart[self._look(self.now, far)]
        most = self.how.used * SCALE[self.layer][:, :dims]
        self._known += elapsed
        step = min(1.0, elapsed / min(self.tuning.using, self.tuning.using_first + self._known)) * share
        bias = self.bias[:, :dims]
        bias += step * (off - bias)
        np.minimum(np.maximum(bias, -most, out=bias), most, out=bias)

    def _confused(self) -> Array:
        """Return `[H, T]` infinity where a picture under a heading cannot tell a stance from one before it,
        the start stance first.
        """
        signature = self.signature
        order = sorted(range(len(signature.stances)), key=lambda s: s != self.start)
        out = np.zeros((len(TURNS), len(signature.of)))
        for n, flat in enumerate(self.flat):
            near = self.flat[max(0, n - self.how.mistaken) : n + self.how.mistaken + 1]
            apart = flat[None, :, None] - near[:, None]
            far = np.sqrt(
                (apart**2 * SHARP[self.layer][:, :2]).sum((3, 4)).min(0) / COUNT[self.layer][:, :2].sum()
            )
            for place, stance in enumerate(order):
                mine = signature.of == stance
                before = np.isin(signature.of, order[:place]) & (out[n] == 0)
                if before.any() and float(far[np.ix_(mine, before)].min()) < ALIKE:
                    out[n, mine] = np.inf
        return out
