"""The arms layer's ways from stance to stance: out of the one, across, and into the other.

From a hand at the chin there is no straight way to the hips or to clasped hands, and none back; those go by
another stance, as a person's would.
"""

from __future__ import annotations

from sample_clips.make import arms_chin, arms_clasped, arms_crossed, arms_hips
from sample_clips.make.key_poses import Hand
from sample_clips.make.motion_tracks import Step
from sample_clips.make.recipe import HOME, Recipe, go, home
from sample_clips.make.stance_clips import FOLD_OVER, FOLD_UNDER, LAP, SIDE, STANCES, SUPPORT

# Where both hands (left, right) are just before they arrive in a stance and just after they leave it.
NEAR: dict[str, tuple[Hand, Hand]] = {
    "hands_at_sides": (
        SIDE.moved(0.02, 0.09, 0.09, shape="relaxed"),
        SIDE.moved(0.02, 0.10, 0.10, shape="relaxed"),
    ),
    "on_hips": (arms_hips.OFF.moved(0.03), arms_hips.OFF.moved(0.028, 0.01, 0.005)),
    "arms_crossed": (arms_crossed.LEFT_OUT, arms_crossed.OUT),
    "hand_to_chin": (
        SUPPORT.moved(0.03, -0.045, 0.03, shape="relaxed"),
        arms_chin.over_elbow(0.0, 0.62, 0.78, bend=4, shape="relaxed"),
    ),
    "on_lap": (
        LAP.moved(0.006, 0.100, 0.015, shape="relaxed"),
        LAP.moved(0.010, 0.110, 0.035, shape="relaxed"),
    ),
    "hands_folded": (
        FOLD_UNDER.moved(0.034, 0.022, -0.010, shape="relaxed"),
        FOLD_OVER.moved(0.036, 0.034, 0.016, shape="relaxed"),
    ),
    "hands_clasped": (
        arms_clasped.CLOSE.moved(0.022, -0.014, -0.030),
        arms_clasped.CLOSE.moved(0.026, 0.026, 0.040),
    ),
}
# Moods in which one comes to stand so: open and large, guarded, or small (Wallbott 1998).
FELT = {"on_hips": ("happy",), "arms_crossed": ("tense",), "hands_clasped": ("sad",)}
# (leaves, arrives): seconds out, across, in; and how the head goes along (pitch, turn, lean).
WAYS: dict[tuple[str, str], tuple[float, float, float, tuple[float, float, float]]] = {
    ("hands_at_sides", "on_hips"): (0.34, 0.34, 0.40, (-1, 0, 0)),
    ("on_hips", "hands_at_sides"): (0.28, 0.34, 0.52, (2, 0, 0)),
    ("hands_at_sides", "arms_crossed"): (0.34, 0.38, 0.40, (3, 0, 0)),
    ("arms_crossed", "hands_at_sides"): (0.30, 0.40, 0.52, (2, 2, 0)),
    ("hands_at_sides", "hand_to_chin"): (0.34, 0.42, 0.42, (4, 2, 1)),
    ("hand_to_chin", "hands_at_sides"): (0.30, 0.42, 0.54, (-1, -1, 0)),
    ("hands_at_sides", "hands_clasped"): (0.32, 0.36, 0.38, (3, 0, 0)),
    ("hands_clasped", "hands_at_sides"): (0.28, 0.34, 0.52, (1, 0, 1)),
    ("on_hips", "arms_crossed"): (0.28, 0.40, 0.36, (2, -1, 0)),
    ("arms_crossed", "on_hips"): (0.30, 0.42, 0.42, (-2, 0, 0)),
    ("on_hips", "hands_clasped"): (0.28, 0.40, 0.40, (2, 1, 0)),
    ("hands_clasped", "on_hips"): (0.30, 0.38, 0.42, (-2, 0, 1)),
    ("arms_crossed", "hand_to_chin"): (0.30, 0.34, 0.40, (3, 2, 1)),
    ("hand_to_chin", "arms_crossed"): (0.26, 0.34, 0.36, (0, 0, 0)),
    ("arms_crossed", "hands_clasped"): (0.30, 0.38, 0.42, (2, 0, 0)),
    ("hands_clasped", "arms_crossed"): (0.26, 0.40, 0.36, (-1, 1, 0)),
}


def way(
    leaves: str, arrives: str, timing: tuple[float, float, float, tuple[float, float, float]], over: str = ""
) -> Recipe:
    """Return the transition between two stances. timing: seconds out, across, in, and how the head goes.
    over: as in `Recipe`.
    """
    out, across, into, head = timing
    first, last = NEAR[leaves], NEAR[arrives]
    spine = tuple(
        (a + b) / 2 - 1.0 * (i == 0)
        for i, (a, b) in enumerate(
            zip(STANCES["arms"][leaves].spine, STANCES["arms"][arrives].spine, strict=True)
        )
    )
    steps: list[Step] = []
    if leaves == "hands_at_sides":
        steps.append(
            go(
                across * 1.15,
                lf=last[0],
                rt=last[1],
                spine=spine,
                head=head,
                overshoot=0.0,
                flow=0.2,
                peak=0.46,
            )
        )
    else:
        if leaves == "arms_crossed":  # the arm on top goes first
            steps.append(go(out * 0.7, rt=first[1], overshoot=0.0, flow=0.5))
        if leaves == "hand_to_chin":  # the hand that carries lets go first
            steps.append(go(out * 0.7, lf=first[0], overshoot=0.0, flow=0.55))
        steps.append(go(out, lf=first[0], rt=first[1], spine=spine, head=head, overshoot=0.0, flow=0.4))
        if arrives != "hands_at_sides":
            steps.append(go(across, lf=last[0], rt=last[1], overshoot=0.0, flow=0.24))
    if arrives == "arms_crossed":  # and the arm beneath arrives first
        steps.append(go(into * 0.7, lf=HOME, overshoot=0.0, flow=0.6))
        steps.append(go(0.24, rt=arms_crossed.ABOVE, overshoot=0.0, flow=0.36))
    if arrives == "hand_to_chin":  # while the elbow is there before the hand that carries it
        steps.append(go(into * 0.8, rt=HOME, overshoot=0.0, flow=0.5))
    steps.append(home(into * (1.25 if arrives == "hands_at_sides" else 1.0), overshoot=0.025))
    return Recipe(
        f"{leaves}__to__{arrives}",
        "arms",
        "transition",
        leaves,
        arrives,
        tuple(steps),
        tags=FELT.get(arrives, ()),
        later="Left",
        over=over,
    )


CLIPS = tuple(way(*pair, timing) for pair, timing in WAYS.items())
