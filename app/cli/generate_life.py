"""Put life over what a model made: hips, legs, fingers, gaze and face, as viewers of the project see them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from metagraph.common.wording import phrase

if TYPE_CHECKING:  # reading a command line must not wait for arrays
    from metagraph.graph.conversation.model import Conversation
    from metagraph.motion.character_mesh import CharacterMesh
    from metagraph.motion.clip import Clip

IDENT = "made"  # of the clip and the conversation in the project that both are put into


@dataclass(frozen=True, eq=False)
class LivingClip:
    """Motion with life. body: the character that it moves, None if there is none. notes: what there is to
    know, in words.
    """

    clip: Clip
    body: CharacterMesh | None = None
    notes: tuple[str, ...] = ()


def compose_with_life(path: Path, clip: Clip, talk: Conversation, side: int) -> LivingClip:
    """Return a clip with all that the project at `path` adds to one who moves so in a conversation; the clip
    itself where the project has another skeleton.
    """
    from app.cli.command_output import open_for_command
    from app.cli.render_command import read_body
    from app.stage.conversation_plans import ConversationPlans
    from metagraph.graph.model import ClipEntry
    from metagraph.playback.bake import bake

    project = open_for_command(path)
    if project.skeleton != clip.skeleton:
        told = phrase(
            "the motion is bare, without hips, legs, fingers and face: {name} has another skeleton than the "
            "model. Name the project of the model's character with --project",
            name=path.name,
        )
        return LivingClip(clip, notes=(told,))
    entry = ClipEntry(IDENT, clip.name, "", frames=clip.frames, fps=clip.fps, motion=clip, made_by=clip.name)
    sides = list(talk.sides)
    sides[side] = msgspec.structs.replace(sides[side], motion=IDENT)
    whole = msgspec.structs.replace(talk, sides=tuple(sides), length=max(talk.length, clip.duration))
    project = replace(
        project,
        clips={**project.clips, IDENT: entry},
        conversations={**project.conversations, IDENT: whole},
    )
    shown = ConversationPlans().show(project, IDENT, path.resolve().parent, side)
    assert shown.evaluator is not None
    alive = bake(shown.evaluator, shown.project, clip.duration, clip.fps)
    body = read_body(shown.project, path.resolve().parent)
    return LivingClip(replace(alive, name=clip.name, notes=clip.notes), body, shown.notes)
