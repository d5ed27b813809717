"""What the three papers print in numbers, as they print it.

Meta-graph: Borer, Lutz, Sumner, Guay, *Animating an Autonomous 3D Talking Avatar*. Conversations: Yang, Yang,
Hodgins, *Statistics-based Motion Synthesis for Social Conversations* (2020). Generator: Taylor, Windle,
Greenwood, Matthews, *Speech-Driven Conversational Agents using Conditional Flow-VAEs* (2021).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

PAPERS: Mapping[str, str] = {
    "meta-graph": "Borer et al., Animating an Autonomous 3D Talking Avatar",
    "conversation": "Yang et al. 2020, Statistics-based Motion Synthesis for Social Conversations",
    "generator": "Taylor et al. 2021, Speech-Driven Conversational Agents using Conditional Flow-VAEs",
}

# --- the meta-graph paper

# How many clips, and how long they took, stands in `metagraph.research.study.analysis.example`.
TIMES_FASTER = 7
EXAMPLE_STANCES, EXAMPLE_ON_EACH = 9, 5  # section 3: what figure 1 imagines
ALPHA = 4.0  # section 6.2

STATES = ("L, G", "L, F", "L, T", "R, G", "R, F", "R, T", "LR, G", "LR, F", "LR, T")
FIGURE_11: tuple[tuple[float, ...], ...] = (
    (25, 37.5, 12.5, 12.5, 0, 0, 12.5, 0, 0),
    (26.7, 33.3, 6.7, 13.3, 20, 0, 0, 0, 0),
    (20, 20, 0, 0, 60, 0, 0, 0, 0),
    (0, 28.6, 0, 42.9, 0, 0, 14.3, 0, 14.3),
    (0, 42.9, 14.3, 0, 0, 0, 14.3, 14.3, 14.3),
    (0, 0, 100, 0, 0, 0, 0, 0, 0),
    (25, 0, 0, 25, 25, 0, 0, 25, 0),
    (0, 33.3, 33.3, 0, 0, 0, 33.3, 0, 0),
    (0, 0, 0, 0, 20, 20, 0, 0, 60),
)  # percent, a row each state, a column what follows it

# --- the conversation paper


@dataclass(frozen=True, slots=True)
class PublishedRate:
    """A row of table 1. printed: percent."""

    actor: str
    hypothesis: str
    matched: int
    total: int
    printed: int


TABLE_1: tuple[PublishedRate, ...] = (
    PublishedRate("female", "clause with the left hand", 319, 515, 62),
    PublishedRate("female", "clause with the right hand", 336, 515, 65),
    PublishedRate("female", "clause with either hand", 387, 515, 75),
    PublishedRate("female", "response with a nod", 70, 121, 58),
    PublishedRate("female", "partner's hesitation with a nod", 21, 69, 30),
    PublishedRate("male", "clause with the left hand", 314, 614, 51),
    PublishedRate("male", "clause with the right hand", 309, 614, 50),
    PublishedRate("male", "clause with either hand", 382, 614, 62),
    PublishedRate("male", "response with a nod", 81, 152, 53),
    PublishedRate("male", "partner's hesitation with a nod", 14, 40, 35),
)
# Table 2: k -> states and edges before, and after what is not in the largest component is removed.
TABLE_2: Mapping[int, tuple[int, int, int, int]] = {
    2: (50_568, 130_397, 3_899, 13_182),
    3: (50_568, 408_234, 40_673, 376_300),
    4: (50_568, 1_823_041, 47_854, 1_810_036),
}
# Table 3: what -> mean and standard deviation, seconds.
TABLE_3: Mapping[str, tuple[float, float]] = {"graph construction": (47.94, 3.30), "search": (1.16, 0.56)}
CASES, FOUND, FOUND_WITHOUT_HESITATION = 116, 81, 100  # section 8.1
TAKES = 17  # conversations that were recorded; each graph is of all but one
WORDS_A_CLAUSE: Mapping[str, tuple[float, float]] = {"female": (4.29, 2.16), "male": (3.86, 1.36)}
SEARCH_STEPS = (3, 4)  # figure 5 draws n_start and n_save so small
SAVED = 200  # n_save, section 7.1


@dataclass(frozen=True, slots=True)
class PublishedRating:
    """A row of figure 6. chosen: of so many `answers`, how often the first of the two was preferred. printed:
    percent. chi, p: the published test. starred: whether the figure calls it significant.
    """

    first: str
    second: str
    chosen: int
    answers: int
    printed: int
    chi: float
    p: float
    starred: bool


FIGURE_6: tuple[PublishedRating, ...] = (
    PublishedRating("motion capture", "all constraints", 206 - 64, 206, 69, 57.563, 3.272e-14, True),
    PublishedRating("all constraints", "without responses", 108, 193, 56, 5.0155, 0.02512, True),
    PublishedRating("all constraints", "without hesitations", 94, 201, 47, 1.4328, 0.2313, False),
    PublishedRating("all constraints", "no constraints", 116, 200, 58, 9.61, 0.001935, True),
)

# --- the third paper

PARAMETERS: Mapping[str, float] = {"flow-vae": 34e6, "moglow": 180e6, "cvae": 3e6}  # section 7
HELD_OUT = 300.0  # seconds that are judged
JOINTS = 9
