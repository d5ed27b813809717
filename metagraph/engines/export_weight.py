"""What answers the arms in an export, and where feet stand, and both read back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from metagraph.engines import contract as c
from metagraph.engines.export_contacts import list_below
from metagraph.formats.project.fields import DataError
from metagraph.graph.model import Project
from metagraph.motion.contact_solve import ContactArm, ContactRig
from metagraph.motion.plain_vectors import Vector
from metagraph.motion.skeleton import Skeleton
from metagraph.motion.weight_solve import WeightBend, WeightCollar, WeightRig
from metagraph.playback.posing.rigs import get_rigs
from metagraph.playback.posing.weight import (
    Weight,
    find_arm_track_rows,
    find_foot_rows,
    has_planted_feet,
    has_sway,
)


def export_weight_rig(project: Project) -> c.ExportedWeightRig | None:
    """Return what runtimes need for bodies that answer their arms or whose feet stay planted, None if none
    does.
    """
    weight = get_rigs(project).weight
    rig = weight.rig
    if rig is None or not (_sways(project, rig) or _plants(project)):
        return None
    return c.ExportedWeightRig(
        list(rig.body.joints),
        list(rig.body.parents),
        [[leg.upper, leg.lower, leg.hand] for leg in rig.body.arms],
        list(rig.body.hands),
        [c.ExportedWeightBend(b.place, list(b.left), list(b.up), list(b.ahead), b.share) for b in rig.bends],
        [c.ExportedWeightCollar(x.place, x.upper, list(x.axis), x.side) for x in rig.collars],
        [list(knee) for knee in rig.knees],
        [list(lever) for lever in rig.levers],
        list(rig.up),
        rig.height,
        rig.strength,
        weight.feet_layer or "body",
    )


def find_arm_rows(project: Project) -> dict[str, list[list[int]]]:
    """Return the rows of the clips that the arms' layer plays, none where no body answers its arms."""
    weight = get_rigs(project).weight
    if weight.rig is None or not _sways(project, weight.rig):
        return {}
    clips = {action.clip for action in project.graphs["arms"].actions.values()}
    return {
        clip: [[int(x) for x in row] for row in find_arm_track_rows(weight, project, clip)] for clip in clips
    }


def find_planted_feet(project: Project) -> dict[str, list[list[int]]]:
    """Return where the feet are in the clips of the layer that moves the legs; none where none is planted."""
    weight = get_rigs(project).weight
    if weight.feet_layer is None or not _plants(project):
        return {}
    clips = {action.clip for action in project.graphs[weight.feet_layer].actions.values()}
    return {clip: [[int(x) for x in row] for row in find_foot_rows(weight, project, clip)] for clip in clips}


def _sways(project: Project, rig: WeightRig) -> bool:
    return has_sway(project) and rig.strength > 0


def _plants(project: Project) -> bool:
    return has_planted_feet(project) and get_rigs(project).weight.feet_layer is not None


def read_weight(
    rig: c.ExportedWeightRig | None, clips: Sequence[c.ExportedClip], skeleton: Skeleton
) -> Weight:
    """Return an exported weight rig as the player takes it. Raises DataError if it does not fit the
    joints.
    """
    rows: Mapping[str, list[list[int]]] = {clip.id: clip.arms for clip in clips}
    feet: Mapping[str, list[list[int]]] = {clip.id: clip.feet for clip in clips}
    if rig is None:
        return Weight(None, {}, {})
    count = len(rig.joints)
    places = [
        *(p for leg in rig.legs for p in leg),
        *(b.place for b in rig.bends),
        *(p for x in rig.collars for p in (x.place, x.upper)),
    ]
    fits = (
        len(rig.parents) == count
        and all(j < len(skeleton) for j in rig.joints)
        and all(p < n for n, p in enumerate(rig.parents))
        and all(p < count for p in places)
    )
    if not fits:
        raise DataError("$.weight_rig", "does not fit the joints")
    legs = tuple(ContactArm(leg[0], leg[1], leg[2], list_below(rig.parents, leg[0])) for leg in rig.legs)
    body = ContactRig(
        tuple(rig.joints), tuple(rig.parents), {}, legs, (rig.hands[0], rig.hands[1]), (), False, False
    )
    found = WeightRig(
        body,
        tuple(WeightBend(b.place, _three(b.left), _three(b.up), _three(b.ahead), b.share) for b in rig.bends),
        tuple(WeightCollar(x.place, x.upper, _three(x.axis), x.side) for x in rig.collars),
        tuple(_three(knee) for knee in rig.knees),
        tuple((lever[0], lever[1]) for lever in rig.levers),
        _three(rig.up),
        rig.height,
        rig.strength,
    )
    return Weight(found, _floats(rows), _floats(feet), rig.feet_layer)


def _floats(rows: Mapping[str, list[list[int]]]) -> dict[str, Sequence[Sequence[float]]]:
    return {clip: [[float(x) for x in row] for row in each] for clip, each in rows.items()}


def _three(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z
