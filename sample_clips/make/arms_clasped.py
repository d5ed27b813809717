"""The arms layer with the hands clasped in front: they open to speak and find each other again."""

from __future__ import annotations

import math

from sample_clips.make.hands import SHAPES, Finger
from sample_clips.make.key_poses import Hand
from sample_clips.make.phrases import arms_clip
from sample_clips.make.recipe import Recipe, go, home
from sample_clips.make.stage_places import BEAT, OFFERING, OPEN_PALM, READY, SHRUGGED
from sample_clips.make.stance_clips import CLASP_OVER, CLASP_UNDER, FOLD_OVER, FOLD_UNDER

S = "hands_clasped"
APART = Hand(at=(0.130, 1.035, 0.245), turn=-14, bend=6, shape="relaxed", elbow=(0.6, -0.6, -0.4))
CLOSE = APART.moved(-0.015, -0.010, -0.012, shape="open")
CLASPED = (("Right", "LeftHand"),)  # one hand carries the other
BACK = go(
    0.46,
    lf=CLOSE.moved(0.012, -0.016, -0.028),
    rt=CLOSE.moved(0.014, 0.024, 0.036),
    spine=(1, 0, 0),
    head=(-0.5, 0, 0),
    flow=0.2,
    overshoot=0.0,
)


def both(up: float, forwards: float) -> dict[str, Hand]:
    """Return both clasped hands moved together."""
    return {"lf": CLASP_UNDER.moved(0, up, forwards), "rt": CLASP_OVER.moved(0, up, forwards)}


def rubbing(slide: float, apart: float = 0.0) -> dict[str, Hand]:
    """Return flat hands, palm on palm with the fingers a little crossed, the right one slid forwards by
    metres and the left one back; each so many metres out of the middle.
    """
    left = Hand(
        at=(0.030 + apart, 1.082, 0.212 - slide),
        fingers=(-0.178, 0.205, 0.962),
        palm=(-0.978, 0.067, -0.196),
        shape="flat",
        elbow=(0.605, -0.727, -0.324),
    )
    right = Hand(
        at=(0.030 + apart, 1.106, 0.218 + slide),
        fingers=(-0.171, -0.114, 0.979),
        palm=(-0.980, 0.122, -0.157),
        shape="flat",
        elbow=(0.619, -0.722, -0.309),
    )
    return {"lf": left, "rt": right}


UNCLASP = go(
    0.20, rt=CLASP_OVER.moved(0.016, 0.014, 0.040, shape="open"), overshoot=0.0, flow=0.5
)  # the hand on top lifts first


def twiddled(turn: float, up: float = 0.0) -> dict[str, Hand]:
    """Return hands whose thumbs chase each other round, at `turn` of a round, raised by metres."""
    out = {}
    for side, hand, sign in (("lf", FOLD_UNDER, 1), ("rt", FOLD_OVER, -1)):
        oppose, abduct, middle, tip = hand.shape[0]
        angle = 2 * math.pi * turn
        thumb = (
            oppose - sign * 11 * math.cos(angle),
            abduct + (3 if side == "lf" else 7) + sign * 14 * math.sin(angle),
            middle + sign * 14 * math.cos(angle),
            tip,
        )
        out[side] = with_thumb(hand, thumb).moved(up=up)
    return out


def with_thumb(hand: Hand, thumb: Finger) -> Hand:
    """Return the hand with its thumb elsewhere."""
    rows = SHAPES[hand.shape] if isinstance(hand.shape, str) else hand.shape
    return hand.moved(shape=(thumb, *rows[1:]))


CLIPS = (
    Recipe("hands_clasped__stance", "arms", "stance", S, S, seconds=6.2),
    arms_clip(
        S,
        "gesture",
        "beat_small",
        "bt",
        go(0.38, **both(0.085, 0.035), head=(-3, 0, 0), spine=(-1, 0, 0), overshoot=0.0, flow=0.06),
        go(
            0.27, hold=0.30, **both(-0.024, 0.030), head=(4, 0, 0), spine=(4, 0, 0), peak=0.55, overshoot=0.10
        ),
        home(0.65),
        tags="beat",
        together=True,
        pins=CLASPED,
        likelihood=1.4,
    ),
    arms_clip(
        S,
        "gesture",
        "open_palms",
        "bt",
        UNCLASP,
        go(
            0.34,
            lf=APART.moved(0.02, 0.0, -0.02),
            rt=APART.moved(0.02, 0.02, 0.025),
            flow=0.18,
            overshoot=0.0,
        ),
        go(
            0.36,
            hold=0.42,
            lf=OPEN_PALM.moved(-0.04, -0.03),
            rt=OPEN_PALM.moved(-0.03, -0.02),
            head=(2, 1, 4),
            spine=(0, 0, 0),
            overshoot=0.05,
        ),
        BACK,
        home(0.44),
        tags="explain open",
        likelihood=1.2,
    ),
    arms_clip(
        S,
        "gesture",
        "beat_double",
        "rt",
        go(0.42, rt=READY.moved(-0.03, 0.0, 0.01), head=(-2, 0, 0), overshoot=0.0, flow=0.08),
        go(
            0.22,
            hold=0.08,
            rt=BEAT.moved(-0.03, 0.02),
            head=(3, 0, 0),
            spine=(3, 0, 0),
            peak=0.55,
            overshoot=0.08,
        ),
        go(
            0.24,
            rt=READY.moved(-0.01, -0.03, 0.02),
            head=(0, 0, 0),
            spine=(1, 0, 0),
            overshoot=0.0,
            flow=0.07,
        ),
        go(
            0.22,
            hold=0.30,
            rt=BEAT.moved(-0.01, 0.03),
            head=(3, 0, 1),
            spine=(2.5, 0, 0),
            peak=0.55,
            overshoot=0.08,
        ),
        go(
            0.44,
            rt=CLOSE.moved(0.0, 0.02, 0.025),
            spine=(1, 0, 0),
            head=(-0.5, 0, 0),
            flow=0.18,
            overshoot=0.0,
        ),
        home(0.44),
        tags="beat",
    ),
    arms_clip(
        S,
        "gesture",
        "shrug",
        "bt",
        go(
            0.30,
            lf=APART.moved(0.03, 0.0, 0.0, turn=24),
            rt=APART.moved(0.03, 0.01, 0.0, turn=24),
            head=(2, 0, 0),
            flow=0.2,
            overshoot=0.0,
        ),
        go(
            0.36,
            hold=0.40,
            lf=SHRUGGED.moved(-0.06, -0.04, 0.01),
            rt=SHRUGGED.moved(-0.05, -0.03, 0.01),
            head=(-3, 3, -11),
            spine=(-2, 0, 0),
            overshoot=0.05,
        ),
        BACK,
        home(0.46),
        tags="unsure",
    ),
    arms_clip(
        S,
        "gesture",
        "offer",
        "rt",
        go(0.36, rt=APART.moved(0.02, 0.02, 0.02, turn=20), flow=0.22, overshoot=0.0),
        go(
            0.36,
            hold=0.44,
            rt=OFFERING.moved(-0.01, -0.02, -0.01),
            head=(2, -2, 4),
            spine=(4, 1, 0),
            overshoot=0.045,
        ),
        go(
            0.46,
            rt=CLOSE.moved(0.0, 0.02, 0.025),
            spine=(1, 0, 0),
            head=(-0.5, 0, 0),
            flow=0.2,
            overshoot=0.0,
        ),
        home(0.46),
        tags="you open positive",
    ),
    arms_clip(
        S,
        "fidget",
        "rub_hands",
        "bt",
        UNCLASP,
        go(
            0.20,
            lf=CLOSE.moved(0.012, 0.0, -0.014),
            rt=CLOSE.moved(0.016, 0.034, 0.030),
            flow=0.3,
            overshoot=0.0,
        ),
        go(0.26, **rubbing(0.0, 0.045), head=(1, 0, 0), flow=0.2, overshoot=0.0),
        go(0.22, **rubbing(0.0), head=(3, 0, 0), spine=(2, 0, 0), overshoot=0.0, flow=0.04),
        go(0.22, **rubbing(0.028), overshoot=0.0, flow=0.04),
        go(0.24, **rubbing(-0.024), head=(4, 1, 1), overshoot=0.0, flow=0.04),
        go(0.22, **rubbing(0.026), overshoot=0.0, flow=0.04),
        go(0.24, **rubbing(-0.016), head=(2, 0, 0), overshoot=0.0, flow=0.04),
        go(0.18, **rubbing(0.0, 0.045), head=(1, 0, 0), overshoot=0.0, flow=0.3),
        go(
            0.28,
            lf=CLOSE.moved(0.022, -0.010, -0.022),
            rt=CLOSE.moved(0.024, 0.030, 0.036),
            head=(0, 0, 0),
            spine=(1, 0, 0),
            overshoot=0.0,
            flow=0.25,
        ),
        home(0.44),
        tags="eager positive",
        together=True,
        drag=0.2,
    ),
    arms_clip(
        S,
        "fidget",
        "twiddle_thumbs",
        "bt",
        UNCLASP,
        go(
            0.24,
            lf=CLOSE.moved(0.010, 0.0, -0.016),
            rt=CLOSE.moved(0.012, 0.030, 0.030),
            head=(3, 0, 0),
            flow=0.3,
            overshoot=0.0,
        ),
        go(
            0.22,
            lf=FOLD_UNDER.moved(0.030, 0.0, -0.010),
            rt=FOLD_OVER.moved(0.030, 0.006, 0.014),
            head=(5, 0, 0),
            flow=0.25,
            overshoot=0.0,
        ),
        go(0.20, **twiddled(0.0), head=(6, 0, 0), overshoot=0.0, flow=0.06),
        *(go(0.14, **twiddled(n / 4), head=(7, 0.5, 0), overshoot=0.0, flow=0.05) for n in range(1, 9)),
        go(
            0.26,
            lf=CLOSE.moved(0.012, -0.012, -0.026),
            rt=CLOSE.moved(0.014, 0.026, 0.036),
            head=(1, 0, 0),
            flow=0.25,
            overshoot=0.0,
        ),
        home(0.44),
        tags="bored",
        together=True,
        likelihood=0.6,
        drag=0.2,
    ),
    arms_clip(
        S,
        "fidget",
        "regrip",
        "bt",
        go(
            0.34,
            lf=CLOSE.moved(-0.012, -0.012, -0.02),
            rt=CLOSE.moved(-0.005, 0.012, 0.02),
            spine=(0, 0, 0),
            head=(1, 0, 0),
            flow=0.04,
        ),
        go(
            0.34,
            hold=0.12,
            lf=CLASP_UNDER.moved(0.004, 0.012, 0.008),
            rt=CLASP_OVER.moved(0.004, 0.012, 0.012),
            spine=(1.5, 0, 0),
        ),
        home(0.5),
        likelihood=0.7,
    ),
)
