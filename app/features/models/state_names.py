"""A model's states in the window's language: "left gesture, positive", and as a sentence has them."""

from __future__ import annotations

from app.translation import tr, tr_noop
from metagraph.graph.model import Layer
from metagraph.playback.learning.learn import State

STATES = (
    tr_noop("left gesture"),
    tr_noop("left fidget"),
    tr_noop("left transition"),
    tr_noop("left stance"),
    tr_noop("right gesture"),
    tr_noop("right fidget"),
    tr_noop("right transition"),
    tr_noop("right stance"),
    tr_noop("both gesture"),
    tr_noop("both fidget"),
    tr_noop("both transition"),
    tr_noop("both stance"),
)  # of the arms, which have sides


def describe_tag(state: State) -> str:
    """Return a state's tags: "positive, big"."""
    return ", ".join(tr(tag) for tag in state[2].split())


def name_state(state: State, layer: Layer) -> str:
    """Return a state for people, as `learn.describe_state` has it in English."""
    limb, kind, _ = state
    words = tr(f"{limb} {kind}") if layer == "arms" else tr(kind)
    return ", ".join(filter(None, (words, describe_tag(state))))


def name_state_in_sentence(state: State, layer: Layer) -> str:
    """Return a state as it stands in a sentence: "a positive left gesture"."""
    limb, kind, tags = state
    both = layer == "arms" and limb == "both"
    words = tr("{kind} of both arms", kind=tr(kind)) if both else name_state((limb, kind, ""), layer)
    if tags:
        words = tr("{tags} {words}", tags=" ".join(tr(tag) for tag in tags.split()), words=words)
    return tr("a {words}", words=words)
