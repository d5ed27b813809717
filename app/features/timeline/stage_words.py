"""What is said of what is on stage: of selected requests, of the machine drawn by hand, of who talks."""

from __future__ import annotations

from app.stage.playback_source import ShownPlayback
from app.stage.session import StageSession
from app.translation import tr, tr_plural
from app.widgets.lane_geometry import RequestMark, describe_outcome, describe_wanted
from metagraph.graph.conversation.model import Conversation, get_side_name
from metagraph.graph.model import LAYERS


def count_cues(shown: ShownPlayback) -> int:
    """Return how much plays on all layers."""
    return sum(len(shown.plan.layers[layer].cues) for layer in LAYERS)


def explain_silence(shown: ShownPlayback, session: StageSession) -> str:
    """Return what is said on the empty lanes of the graph, and "" where something plays."""
    if session.onstage.mode == "manual" or shown.clip is not None or shown.others or count_cues(shown):
        return ""
    return tr("Nothing plays yet. Drop a clip on a stance and others on the nodes around it.")


def describe_marks(marks: list[RequestMark]) -> str:
    """Return what is said of selected requests."""
    if len(marks) == 1:
        return tr(
            "{outcome} Requested: {wanted}.",
            outcome=describe_outcome(marks[0].ask, marks[0].answer),
            wanted=describe_wanted(marks[0]),
        ).strip()
    unmet, chosen = (
        sum(1 for m in marks if m.lost),
        tr_plural("{count:,} request", "{count:,} requests", len(marks)),
    )
    if not unmet:
        return tr("{requests} selected", requests=chosen)
    return tr("{requests} selected, {unmet:,} of them cannot be met", requests=chosen, unmet=unmet)


def describe_machine(shown: ShownPlayback, session: StageSession) -> str:
    """Return what is said of the machine drawn by hand."""
    if session.transport.show == "context":
        return tr("Plays alone. Press Esc for the whole machine.")
    count = count_cues(shown)
    words = (
        tr(
            "{states} in {length:g} s.",
            states=tr_plural("{count:,} state", "{count:,} states", count),
            length=shown.length,
        )
        if count
        else tr("Nothing plays yet. Drop clips here and draw links between them.")
    )
    return words + "".join(f" {r.message[:1].upper()}{r.message[1:]}." for r in shown.plan.reports[-1:])


def describe_talk(shown: ShownPlayback, talk: Conversation | None) -> str:
    """Return what is said of the one whose plan of a conversation is seen."""
    who = get_side_name(talk, shown.side) if talk is not None else tr("A speaker")
    if shown.motion is not None:
        return tr(
            "{who} moves with the recording '{name}'. The graph would play this instead.",
            who=who,
            name=shown.project.clips[shown.motion].name,
        )
    gestures = sum(1 for cue in shown.plan.layers["arms"].cues if cue.action.kind == "gesture")
    nods = len(shown.plan.layers["head"].cues)
    return tr(
        "{who} in conversation: {gestures} and {nods}.",
        who=who,
        gestures=tr_plural("{count:,} hand gesture", "{count:,} hand gestures", gestures),
        nods=tr_plural("{count:,} nod", "{count:,} nods", nods),
    )
