"""Find the rigs that a project's poses need. They are found once and kept until something they depend on
changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from metagraph.graph.face.rig import gather_face_parts
from metagraph.graph.model import LAYERS, Project
from metagraph.graph.remembered import Remembered
from metagraph.motion.contact_solve import ContactRig
from metagraph.playback.life.body import LIFELESS, Body, find_body
from metagraph.playback.posing.composer import ComposerRig, find_composer
from metagraph.playback.posing.contacts import find_contact_rig
from metagraph.playback.posing.weight import Weight, find_weight


@dataclass(frozen=True, eq=False)
class Rigs:
    """The rigs of a project.

    `composer` says how layers reach joints. `contacts` has the arms and the body's parts, None without two
    arms. `weight` answers the arms. `body` breathes and looks.
    """

    composer: ComposerRig
    contacts: ContactRig | None
    weight: Weight
    body: Body


@dataclass(frozen=True)
class ResolvedProject(Project):
    """A project as an export has it: its rigs, and how energetic its actions are (`vigours`, by their ids),
    are given, as in runtimes, instead of found.
    """

    body: Body = field(default=LIFELESS, compare=False, repr=False)
    contact_rig: ContactRig | None = field(default=None, compare=False, repr=False)
    weight: Weight = field(default_factory=lambda: Weight(None, {}, {}), compare=False, repr=False)
    vigours: Mapping[str, float] = field(default_factory=dict, compare=False, repr=False)


_known: Remembered[Rigs] = Remembered(gather_face_parts)


def get_rigs(project: Project) -> Rigs:
    """Return the rigs of a project; the same object until something they depend on changes. Raises ValueError
    without a skeleton.
    """
    if isinstance(project, ResolvedProject):
        return Rigs(find_composer(project), project.contact_rig, project.weight, project.body)
    weights = tuple(tuple(sorted(project.graphs[layer].weights.items())) for layer in LAYERS)
    depends = (project.base, project.touch, tuple(sorted(project.touched)), weights)
    return _known.of(project, depends, lambda: _find(project))


def _find(project: Project) -> Rigs:
    composer = find_composer(project)
    return Rigs(composer, find_contact_rig(project), find_weight(project), find_body(project))
