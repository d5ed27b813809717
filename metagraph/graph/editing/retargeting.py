"""Clips of other skeletons in a project: which joint map would fit, and bringing them over as the project
knows its own figure.
"""

from __future__ import annotations

from functools import cached_property

from metagraph.graph import anatomy
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import JointMap, RetargetError, make_fingerprint, propose_joint_map
from metagraph.motion.retarget import retarget
from metagraph.motion.skeleton import Pose, Skeleton
from metagraph.motion.standing import find_standing_pose, is_standing


class Bringing:
    """Brings clips onto a project's skeleton. Where its rest pose does not stand, the first of its own clips
    says how it stands.
    """

    def __init__(self, project: Project) -> None:
        self.project = project
        self.roles = anatomy.project_roles(project)

    @cached_property
    def pose(self) -> Pose | None:
        """How the project's figure stands, None for its rest pose."""
        skeleton = self.project.skeleton
        if skeleton is None or is_standing(skeleton, self.roles):
            return None
        own = (e.motion for e in self.project.clips.values() if e.motion is not None and not e.brought_from)
        clip = next((motion for motion in own if motion.skeleton == skeleton), None)
        return None if clip is None else find_standing_pose(clip, self.roles)

    def known(self, clip: Clip) -> JointMap | None:
        """Return the project's joint map for the clip's skeleton."""
        return self.project.joint_maps.get(make_fingerprint(clip.skeleton))

    def propose(self, source: Skeleton) -> JointMap:
        """Raises RetargetError in a project without a skeleton."""
        if self.project.skeleton is None:
            raise RetargetError("a project without clips has no skeleton to bring others onto")
        return propose_joint_map(source, self.project.skeleton, target_roles=self.roles)

    def bring(self, clip: Clip, joint_map: JointMap) -> Clip:
        """Return the clip on the project's skeleton. Raises RetargetError."""
        if self.project.skeleton is None:
            raise RetargetError("a project without clips has no skeleton to bring others onto")
        return retarget(clip, self.project.skeleton, joint_map, target_pose=self.pose)
