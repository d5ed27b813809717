"""Draw the default body on a skeleton. Half-way joints keep elbows, knees and wrists round when they bend."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.motion import rotation
from metagraph.motion.fitting.bind import bind_pose
from metagraph.motion.fitting.fit import Fit
from metagraph.motion.fitting.footing import Footing
from metagraph.motion.joint_map import SIDES
from metagraph.motion.skeleton import Skeleton
from preview.default_body.sculpture import read_sculpture
from preview.figure import MeshFigure, SkinnedFigure
from preview.levels import make_levels
from preview.mesh import VERTEX, SkinnedMesh, TriangleBatch

Array = NDArray[Any]

SKIN, JOINTS = (178, 174, 168, 70), (152, 148, 142, 60)  # sRGB and shininess, of the body and of its joints
# Parts between which a half-way joint lies: the upper one (the trunk where it is ""), and the lower one.
HALVES = (
    ("shoulder", "upper_arm"),
    ("upper_arm", "lower_arm"),
    ("lower_arm", "hand"),
    ("", "upper_leg"),
    ("upper_leg", "lower_leg"),
    ("lower_leg", "foot"),
)
BANDED = np.tile([lower in ("lower_arm", "hand", "lower_leg", "foot") for _, lower in HALVES], 2)
SMOOTH = 0.5  # of the error that other meshes may have: on plain skin facets are seen
UNTURNED = rotation.IDENTITY.astype(np.float32)
TWIST = (0.15, 0.85)  # shares of a forearm from which on, and to which, it turns with the hand by half


@dataclass(frozen=True)
class Half:
    """A joint half-way between two. `upper` and `lower` are columns of what carries the body; `joint` is
    where it turns.
    """

    upper: int
    lower: int
    joint: int


class DefaultBody(MeshFigure):
    """The default body on a skeleton of a person. Raises ValueError, with the reason in words, for others.

    `footing` says how the skeleton stands; by default it stands as it rests.
    """

    def __init__(self, skeleton: Skeleton, footing: Footing | None = None) -> None:
        bind = bind_pose(skeleton, read_sculpture().at, footing)
        if isinstance(bind, str):
            raise ValueError(bind)
        fit = Fit(skeleton, bind, read_sculpture(), None if footing is None else footing.ankle)
        carriers, weights = fit.slots()
        halves, twists, weights = _with_halves(carriers, weights, fit)
        self._twisted = tuple(np.array([getattr(h, end) for h in twists]) for end in ("upper", "lower"))
        self._halved = tuple(np.array([getattr(h, end) for h in halves]) for end in ("upper", "lower"))
        count = len(carriers)
        sources = [*carriers, *(h.joint for h in twists), *(h.joint for h in halves)]
        self._carriers, self._pivots = np.array(carriers), np.array(sources)
        self._back = rotation.conjugate(bind.rotations[carriers]).astype(np.float32)
        self._pivots_at = bind.positions[self._pivots].astype(np.float32)
        self._axes = _unit(
            np.array([bind.positions[carriers[h.lower]] - bind.positions[carriers[h.upper]] for h in twists])
        ).astype(np.float32)
        mesh = _mesh(fit, weights, count + len(twists))
        super().__init__(skeleton, mesh, np.array(sources), (bind.rotations, bind.positions))

    def palette(self, rotations: Array, positions: Array) -> Array:
        turns = np.asarray(rotations, np.float32)[..., self._carriers, :]
        own = rotation.multiply(turns, self._back)
        arm, hand = own[..., self._twisted[0], :], own[..., self._twisted[1], :]
        turned = rotation.multiply(rotation.conjugate(arm), hand)
        along = np.einsum("...ti,ti->...t", turned[..., :3], self._axes)[..., None]
        twist = np.concatenate([along * self._axes, turned[..., 3:]], -1)
        own = np.concatenate([own, rotation.multiply(arm, _half_way(UNTURNED, twist))], -2)
        half = _half_way(own[..., self._halved[0], :], own[..., self._halved[1], :])
        matrix = rotation.to_matrix(np.concatenate([own, half], -2))
        out = np.empty((*matrix.shape[:-1], 4), np.float32)
        out[..., :3] = matrix
        places = np.asarray(positions, np.float32)[..., self._pivots, :]
        out[..., 3] = places - (matrix @ self._pivots_at[..., None])[..., 0]
        return out

    def simplify(self, cancelled: Callable[[], bool] = lambda: False) -> None:
        """Make the `levels`: the same triangles for every skeleton, so that they are made once."""
        if not self.levels:
            body = read_sculpture().character
            model = SkinnedFigure(body)
            self.levels = make_levels(self.mesh, self.height, cancelled, (model.mesh, model.height))

    def finest(self, error: float) -> SkinnedMesh:
        return super().finest(SMOOTH * error)


def _half_way(a: Array, b: Array) -> Array:
    """Return the rotations half-way between `a` and `b` `[..., 4]`, the short way; `b` of any length."""
    b = b / np.maximum(np.sqrt(np.einsum("...i,...i->...", b, b)), 1e-9)[..., None]
    out = a + np.where(np.einsum("...i,...i->...", a, b)[..., None] < 0, -b, b)
    return np.asarray(out / np.maximum(np.sqrt(np.einsum("...i,...i->...", out, out)), 1e-9)[..., None])


def _unit(v: Array) -> Array:
    return np.asarray(v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12))


def _with_halves(carriers: list[int], weights: Array, fit: Fit) -> tuple[list[Half], list[Half], Array]:
    """Return half-way joints, joints that turn half-way with the hands, and the weights with them, `[V, M]`.

    Where a point is carried by two parts in the shares 1 - t and t, the joint between them takes what is
    nearer to a half of both, so that the parts bend in two steps.
    """
    roles = fit.bind.roles
    column = {role: carriers.index(joint) for role, joint in roles.items() if joint in carriers}
    spine, _ = fit.trunk_and_neck()
    top, base = carriers.index(spine[-1]), carriers.index(spine[0])
    twists: list[Half] = []
    columns = [weights[:, k] for k in range(weights.shape[1])]
    for side in SIDES:
        low, hand = column[f"{side}_lower_arm"], column[f"{side}_hand"]
        start, end = fit.own[f"{side}_lower_arm"], fit.own[f"{side}_hand"]
        line = end - start
        share = (fit.positions - start) @ line / float(line @ line)
        t = np.clip((share - TWIST[0]) / (TWIST[1] - TWIST[0]), 0, 1)
        twists.append(Half(low, hand, roles[f"{side}_lower_arm"]))
        columns.append(columns[low] * t)
        columns[low] = columns[low] * (1 - t)
    halves: list[Half] = []
    for side in SIDES:
        for upper, lower in HALVES:
            b = column[f"{side}_{lower}"]
            above = column.get(f"{side}_{upper}", top if lower == "upper_arm" else base)
            if lower == "hand":
                above = len(carriers) + SIDES.index(side)
            halves.append(Half(above, b, roles[f"{side}_{lower}"]))
            columns.append(_take_half(columns, b, fit, side, lower, column, len(carriers)))
    return halves, twists, np.stack(columns, 1)


def _take_half(
    columns: list[Array], b: int, fit: Fit, side: str, lower: str, column: dict[str, int], fit_carriers: int
) -> Array:
    """Return the weight of the joint above a part, taken from that part, what is below it, and the rest."""
    below = {b} | {
        column[role]
        for role in column
        if role.startswith(side)
        and fit.bind.roles[role] in fit.skeleton.descendants(fit.bind.roles[f"{side}_{lower}"])
    }
    if lower in ("upper_arm", "lower_arm"):
        below.add(fit_carriers + SIDES.index(side))
    count = len(columns)
    total = np.sum(columns, 0)
    part = np.sum([columns[k] for k in sorted(below)], 0)
    t = part / np.maximum(total, 1e-9)
    for k in range(count):
        left = (
            np.clip(2 * t - 1, 0, 1) / np.maximum(t, 1e-9)
            if k in below
            else np.clip(1 - 2 * t, 0, 1) / np.maximum(1 - t, 1e-9)
        )
        columns[k] = columns[k] * left
    return np.asarray(total * (1 - np.abs(2 * t - 1)))


def _mesh(fit: Fit, weights: Array, first_half: int) -> SkinnedMesh:
    """Return the surface with its normals, its four strongest joints a point, and its colours."""
    triangles = np.asarray(fit.body.character.triangles)
    most = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    kept = np.take_along_axis(weights, most, 1)
    kept = np.where(kept < 0.01, 0, kept)
    kept /= kept.sum(1, keepdims=True)
    out = np.zeros(len(fit.positions), VERTEX)
    out["position"], out["normal"] = fit.positions, _normals(fit.positions, triangles)
    out["bones"], out["weights"] = np.where(kept > 0, most, 0), kept
    bent = np.clip((weights[:, first_half:] * BANDED).max(1), 0, 1)
    bent = np.clip((bent - 0.35) / 0.3, 0, 1)
    out["color"] = np.round(np.array(SKIN) + bent[:, None] * (np.array(JOINTS) - np.array(SKIN)))
    return SkinnedMesh(
        out, triangles.astype(np.uint32), (TriangleBatch(0, len(triangles)),), weights.shape[1]
    )


def _normals(positions: Array, triangles: Array) -> Array:
    """Return unit normals `[V, 3]`: those of the triangles round a point, larger ones counting more."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    out = np.stack(
        [np.bincount(triangles.ravel(), np.repeat(across[:, k], 3), len(positions)) for k in range(3)], 1
    )
    return _unit(out)
