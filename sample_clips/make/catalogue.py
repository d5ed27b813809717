"""What every clip is for: the lists from which the sample projects are made."""

from __future__ import annotations

from dataclasses import dataclass

from sample_clips.make import arms, body_clips, head, motion_tracks, seated_arms, seated_body
from sample_clips.make.recipe import Recipe

RECIPES: tuple[Recipe, ...] = (*body_clips.CLIPS, *arms.CLIPS, *head.CLIPS)
SEATED: tuple[Recipe, ...] = (*seated_body.CLIPS, *seated_arms.CLIPS)

BASE = ("hands_at_sides__stance", 0)
"""The base pose: a clip's name and a frame."""


@dataclass(frozen=True)
class Entry:
    """One clip. layer: body, arms or head. kind: stance, gesture, fidget or transition. stance, end_stance:
    where it begins and ends. limb: left, right or both. start, end, blend_in, blend_out: suggested timing,
    seconds in the clip. likelihood: how often it is picked against others of its kind; 1 is usual.
    """

    name: str
    layer: str
    kind: str
    stance: str
    end_stance: str
    limb: str
    tags: tuple[str, ...]
    start: float
    end: float
    blend_in: float
    blend_out: float
    likelihood: float

    @property
    def file(self) -> str:
        """The clip's file name in the folder of clips."""
        return f"{self.name}.glb"


BLENDS = {"stance": (0.30, 0.30), "gesture": (0.20, 0.25), "fidget": (0.25, 0.30), "transition": (0.15, 0.20)}
MOTION_STARTS = motion_tracks.LEAD_IN  # every clip but a stance rests so long before anything moves


def catalogue(recipes: tuple[Recipe, ...] = RECIPES) -> tuple[Entry, ...]:
    """Return the entries of clips, body first, then arms and head; the stances' names carry no layer."""
    return tuple(_entry(recipe) for recipe in recipes)


def _entry(recipe: Recipe) -> Entry:
    seconds = (
        motion_tracks.schedule(recipe.steps, motion_tracks.lead_of(recipe.layer))[1]
        if recipe.steps
        else recipe.seconds
    )
    start = 0.0 if recipe.kind == "stance" else MOTION_STARTS
    blend_in, blend_out = BLENDS[recipe.kind]
    return Entry(
        recipe.name,
        recipe.layer,
        recipe.kind,
        recipe.stance,
        recipe.end,
        recipe.limb,
        recipe.tags,
        round(start, 4),
        round(float(seconds), 4),
        blend_in,
        blend_out,
        recipe.likelihood,
    )
