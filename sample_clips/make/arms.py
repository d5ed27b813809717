"""The arms layer: eighty clips."""

from __future__ import annotations

from sample_clips.make import arms_chin, arms_clasped, arms_crossed, arms_hips, arms_sides, arms_transitions

CLIPS = (
    *arms_sides.CLIPS,
    *arms_hips.CLIPS,
    *arms_crossed.CLIPS,
    *arms_chin.CLIPS,
    *arms_clasped.CLIPS,
    *arms_transitions.CLIPS,
)
