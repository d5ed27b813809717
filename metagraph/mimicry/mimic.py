"""From keypoints, frame by frame, to requests: which stance a person is in, layer by layer, told once it is
certain.

Nothing looks ahead, so that a camera and a file give the same.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metagraph.graph import anatomy
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.graph.requests import AnyRequest, Go, Look
from metagraph.mimicry.gaze_reading import HeadFollower
from metagraph.mimicry.judge import TURNS, Judge, Mean, PersonView
from metagraph.mimicry.keypoint_layouts import POINTS, choose_points, swap
from metagraph.mimicry.signatures import BodySignature, compute_signatures
from metagraph.mimicry.tuning import Tuning

Array = NDArray[Any]

FARTHEST = 1e7  # of a coordinate, in any unit; nothing is seen beyond
FIRST = 0.04  # seconds the first frame stands for
WIDTH_OFF = 0.12  # of shoulders' width among people, as a share of it
TURN_USUAL = np.radians(40.0)  # how far people turn away from a camera


@dataclass(frozen=True, slots=True)
class Sighting:
    """A stance that was seen. at: seconds; distance: how far the person was from it; id: of the request it
    became. again: whether the character had left it, or had not gone there when it was asked to.
    """

    at: float
    layer: Layer
    stance: str
    distance: float
    id: str
    again: bool = False


class Mimic:
    """One person, mimicked by a project's character.

    mirror: as somebody face to face does: the character moves its right where the person moves the left.
    layers: those that mimic. gaze: whether it looks where the person's head is turned, too. prefix: of the
    requests' ids. Raises ValueError if the project has no humanoid character or no stance.
    """

    def __init__(
        self,
        project: Project,
        mirror: bool = True,
        layers: Collection[Layer] = LAYERS,
        gaze: bool = False,
        priority: int = 1,
        prefix: str = "mimic",
        tuning: Tuning | None = None,
    ) -> None:
        self.mirror, self.priority, self.prefix, self.tuning = mirror, priority, prefix, tuning or Tuning()
        body = BodySignature(project)
        found, self.width = compute_signatures(project, body, layers)
        if not found:
            raise ValueError("the project has no stance that could be mimicked: no layer has one with a loop")
        self.judges = {
            x: Judge(x, look, self.tuning, project.graphs[x].start, self.width) for x, look in found.items()
        }
        self.sightings: list[Sighting] = []
        self.heading = 0.0  # how far the person is turned to the picture's right, radians
        self._gaze = HeadFollower(body.points(anatomy.get_base_pose(project))) if gaze else None
        self._asked: dict[
            Layer, tuple[float, float]
        ] = {}  # when each layer's stance was asked for, and how long until it may be again
        self._time: float | None = None
        self._dims = self.count = 0
        self._begin()

    def _begin(self) -> None:
        self._quick = Mean(self.tuning.quick)
        for judge in self.judges.values():
            judge.begin()
        self._turns = np.zeros(len(TURNS))
        self._weighed = self._unseen = 0.0

    @property
    def seen(self) -> dict[Layer, str]:
        """Layer -> id of the stance the person is in, if that is known."""
        return {layer: judge.stance for layer, judge in self.judges.items() if judge.stance is not None}

    def distances(self, layer: Layer) -> dict[str, float]:
        """Stance -> how far the person is from it now; empty if there is no evidence."""
        judge = self.judges[layer]
        return (
            {}
            if judge.distances is None
            else dict(zip(judge.signature.stances, map(float, judge.distances), strict=True))
        )

    def feed(
        self,
        seconds: float,
        points: ArrayLike,
        confidence: ArrayLike | None = None,
        goals: Mapping[Layer, str] | None = None,
    ) -> list[AnyRequest]:
        """Take a frame in; return what is requested because of it, mostly nothing.

        seconds: of the frame; one that is not later than the last is passed over. points: `[K, 2]` or `[K,
        3]` of a layout of K points (17, 18, 25 or 33), x right, y up, z towards the camera. confidence: `[K]`
        0..1, all 1 where it is None. goals: layer -> the stance the character is in or goes to, where the
        caller knows; where it is another than the person's, that is asked for again. Raises ValueError for
        shapes that do not fit.
        """
        weighted, dims = self._weighted(points, confidence)
        if not isfinite(seconds) or (self._time is not None and seconds <= self._time):
            return []
        elapsed = FIRST if self._time is None else seconds - self._time
        if elapsed > self.tuning.gap or dims != self._dims:
            self._begin()
        self._time, self._dims = seconds, dims
        self._quick.feed(elapsed, weighted)
        views: dict[Layer, PersonView] = {}
        for layer, judge in self.judges.items():
            judge.mean.feed(elapsed, weighted)
            view = judge.view(dims)
            if view is None:
                judge.forget()
            else:
                views[layer] = view
        if not views:
            return self._nobody(seconds, elapsed)
        self._unseen = 0.0
        return self._judge(seconds, elapsed, views, dims, goals or {})

    def _weighted(self, points: ArrayLike, confidence: ArrayLike | None) -> tuple[Array, int]:
        """Return POINTS by confidence, `[17, 4]`, and how many dimensions they have."""
        given = np.asarray(points, np.float64)
        if given.ndim != 2 or given.shape[1] not in (2, 3):
            raise ValueError(f"keypoints are [K, 2] or [K, 3], not {list(given.shape)}")
        sure = np.ones(len(given)) if confidence is None else np.asarray(confidence, np.float64)
        if sure.shape != (len(given),):
            raise ValueError(f"{len(given)} keypoints have {len(given)} confidences, not {list(sure.shape)}")
        where, sure = choose_points(given, sure)
        if self.mirror:
            where, sure = swap(where, sure)
        good = (np.abs(where) <= FARTHEST).all(1) & (sure >= 0)  # what is not a number is neither
        share = (np.where(good, np.minimum(sure, 1.0), 0.0) - self.tuning.seen) / (
            self.tuning.sure - self.tuning.seen
        )
        weights = np.clip(share, 0.0, 1.0)
        dims = where.shape[1]
        out = np.zeros((len(POINTS), 4))
        out[:, :dims] = np.where(good[:, None], where, 0.0) * weights[:, None]
        out[:, 3] = weights
        return out, dims

    def _judge(
        self,
        seconds: float,
        elapsed: float,
        views: Mapping[Layer, PersonView],
        dims: int,
        goals: Mapping[Layer, str],
    ) -> list[AnyRequest]:
        if dims == 2:
            self._weigh_turns(elapsed, views)
        else:
            self.heading = next(iter(views.values())).frame.heading
        quick = self._quick.points()
        out: list[AnyRequest] = []
        for layer, view in views.items():
            judge = self.judges[layer]
            changed = judge.judge(seconds, elapsed, view, quick, self.heading, dims)
            stance, goal = judge.stance, goals.get(layer)
            if stance is None:
                continue
            before, wait = self._asked.get(layer, (seconds, 0.0))
            missed = goal is not None and goal != stance and seconds - before >= wait
            if changed or missed:
                out.append(self._go(layer, stance, seconds, self.tuning.again if changed else 2 * wait))
        if self._gaze is not None:
            view = views.get("head") or next(iter(views.values()))
            point = self._gaze.feed(seconds, view.points, view.trust, dims)
            if point is not None:
                out.append(Look(id=self._id(), to=point, told=seconds, priority=self.priority))
        return out

    def _weigh_turns(self, elapsed: float, views: Mapping[Layer, PersonView]) -> None:
        """In a picture, take the heading under which shoulders and stances have fitted best over the last
        second or so.
        """
        self._weighed += elapsed
        if self._weighed < self.tuning.turned and self._turns.any():
            return
        width = next(iter(views.values())).frame.width
        cost = ((width - self.width * np.cos(TURNS)) / (WIDTH_OFF * self.width)) ** 2 + (
            TURNS / TURN_USUAL
        ) ** 2
        for layer, view in views.items():
            misfits = self.judges[layer].misfits(view) if layer != "head" else None  # heads turn on their own
            if misfits is not None:
                cost = cost + 2.0 * misfits
        keep = float(np.exp(-self._weighed / self.tuning.turning))
        self._weighed = 0.0
        self._turns = keep * self._turns + (1 - keep) * cost
        best = int(self._turns.argmin())
        self.heading = float(TURNS[best])
        if 0 < best < len(TURNS) - 1:  # the bottom of the parabola through the three
            a, b, c = self._turns[best - 1 : best + 2]
            self.heading += float((TURNS[1] - TURNS[0]) * 0.5 * (a - c) / max(a - 2 * b + c, 1e-9))

    def _nobody(self, seconds: float, elapsed: float) -> list[AnyRequest]:
        """Nobody is there, or shows the back: what was seen holds; after a while the models may change the
        stances as they like.
        """
        before, self._unseen = self._unseen, self._unseen + elapsed
        out: list[AnyRequest] = []
        if before <= self.tuning.lost < self._unseen:
            for layer, judge in self.judges.items():
                if judge.stance is not None:
                    out.append(
                        Go(
                            id=self._id(),
                            stance=judge.stance,
                            layer=layer,
                            told=seconds,
                            priority=self.priority,
                        )
                    )
                judge.now = None
        return out

    def _go(self, layer: Layer, stance: str, seconds: float, wait: float) -> Go:
        self._asked[layer] = (seconds, wait)
        ident, again = self._id(), wait > self.tuning.again
        self.sightings.append(
            Sighting(seconds, layer, stance, self.distances(layer).get(stance, 0.0), ident, again)
        )
        return Go(id=ident, stance=stance, layer=layer, told=seconds, priority=self.priority, stay=True)

    def _id(self) -> str:
        self.count += 1
        return f"{self.prefix}{self.count}"
