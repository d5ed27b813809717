"""Joints that steer a rig and are no part of the body: goals of inverse kinematics, poles, handles. Files
from animation programs often hold them. Nobody sees where they are, so no measure of a pose counts them.
"""

from __future__ import annotations

from metagraph.motion.joint_names import split_joint_name
from metagraph.motion.roles import find_roles
from metagraph.motion.skeleton import Skeleton

_WORDS = frozenset(("ik", "fk", "pole", "poletarget", "target", "ctrl", "control", "controller")) | frozenset(
    ("effector", "goal", "helper", "locator", "mch", "dummy", "handle")
)


def find_rig_controls(skeleton: Skeleton) -> frozenset[int]:
    """Return the joints that are a rig's controls by their names. What the body hangs on is none, whatever it
    is called.
    """
    body = {k for joint in find_roles(skeleton).values() for k in skeleton.chain(joint)}
    named = {j for j, name in enumerate(skeleton.names) if _WORDS & set(split_joint_name(name).words)}
    return frozenset(named - body)
