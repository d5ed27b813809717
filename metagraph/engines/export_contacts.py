"""Contacts and the parts of the body in an export, and read back."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.engines import contract as c
from metagraph.formats.project.fields import DataError
from metagraph.graph.model import Action, Project
from metagraph.motion.contact_solve import BodyCapsule, ContactArm, ContactRig
from metagraph.motion.contact_spans import ContactKey, ContactSpan
from metagraph.motion.plain_vectors import Vector
from metagraph.motion.skeleton import Skeleton
from metagraph.playback.posing.contacts import has_contacts
from metagraph.playback.posing.rigs import get_rigs


def export_contacts(action: Action) -> list[c.ExportedContact]:
    """Return an action's contacts as they are exported."""
    return [
        c.ExportedContact(
            s.hand,  # type: ignore[arg-type]
            s.place,  # type: ignore[arg-type]
            s.to,
            s.start,
            s.end,
            s.ease_in,
            s.ease_out,
            [[k.time, *k.at, *k.turn] for k in s.keys],
        )
        for s in action.contacts
    ]


def read_contacts(contacts: Sequence[c.ExportedContact]) -> tuple[ContactSpan, ...]:
    """Return exported contacts as the player takes them."""
    return tuple(
        ContactSpan(
            s.hand,
            s.place,
            s.to,
            s.start,
            s.end,
            tuple(ContactKey(k[0], (k[1], k[2], k[3]), (k[4], k[5], k[6], k[7])) for k in s.keys),
            s.ease_in,
            s.ease_out,
        )
        for s in contacts
    )


def export_contact_rig(project: Project) -> c.ExportedContactRig | None:
    """Return what runtimes need for contacts and the guard, None if neither does anything."""
    rig = get_rigs(project).contacts if has_contacts(project) else None
    if rig is None:
        return None
    return c.ExportedContactRig(
        rig.contacts,
        rig.guard,
        list(rig.joints),
        list(rig.parents),
        [[arm.upper, arm.lower, arm.hand] for arm in rig.arms],
        [
            c.ExportedCapsule(x.joint, list(x.a), x.to, list(x.b), x.radius, x.arm, x.kind)
            for x in rig.capsules
        ],
    )


def read_contact_rig(rig: c.ExportedContactRig, skeleton: Skeleton) -> ContactRig:
    """Return an exported contact rig as the player takes it. Raises DataError if it does not fit
    the joints.
    """
    count = len(rig.joints)
    places = [
        *(p for arm in rig.arms for p in arm),
        *(p for x in rig.capsules for p in (x.joint, x.to)),
    ]
    fits = (
        len(rig.parents) == count
        and all(j < len(skeleton) for j in rig.joints)
        and all(p < n for n, p in enumerate(rig.parents))
        and all(p < count for p in places)
    )
    if not fits:
        raise DataError("$.contact_rig", "does not fit the joints")
    arms = tuple(ContactArm(arm[0], arm[1], arm[2], list_below(rig.parents, arm[0])) for arm in rig.arms)
    return ContactRig(
        tuple(rig.joints),
        tuple(rig.parents),
        {skeleton.names[j]: n for n, j in enumerate(rig.joints)},
        arms,
        tuple(skeleton.names[rig.joints[arm.hand]] for arm in arms),
        tuple(
            BodyCapsule(x.joint, _three(x.a), x.to, _three(x.b), x.radius, x.arm, x.kind)
            for x in rig.capsules
        ),
        rig.contacts,
        rig.guard,
    )


def list_below(parents: Sequence[int], place: int) -> tuple[int, ...]:
    """Return a place and all below it, parents first."""
    out = [place]
    for n in range(place + 1, len(parents)):
        if parents[n] in out:
            out.append(n)
    return tuple(out)


def _three(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z
