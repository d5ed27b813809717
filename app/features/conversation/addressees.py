"""Show and set the addressee of a segment in a conversation of three or more."""

from __future__ import annotations

from functools import partial

from PySide6.QtWidgets import QMenu

from app.features.conversation.segment_editing import Editing
from app.translation import tr
from metagraph.graph.conversation.model import EVERYBODY, Conversation, get_side_name, list_other_sides
from metagraph.speech.addressing import list_addressed_turns


def offer_addressees(menu: QMenu, editing: Editing) -> None:
    """Add the addressees of the selected segments to a menu, if there is a choice."""
    of, sides = editing.conversation, {side for side, _ in editing.chosen}
    if of is None or len(of.sides) < 3:
        return
    whom = menu.addMenu(tr("Said to"))
    whom.setEnabled(len(sides) == 1)
    if len(sides) != 1:
        return
    side = next(iter(sides))
    now = {of.sides[side].segments[at].to for _, at in editing.chosen}
    choices: list[tuple[str, int | None]] = [(tr("Automatic"), None), (tr("Everyone"), EVERYBODY)]
    choices += [(get_side_name(of, n), n) for n in list_other_sides(of, side)]
    for words, to in choices:
        action = whom.addAction(words, partial(editing.address, to))
        action.setCheckable(True)
        action.setChecked(now == {to})


def describe_addressee(conversation: Conversation, side: int, at: int) -> str:
    """Return a line with the addressee of a segment, or "" in a conversation of two and for segments that
    take no turn.
    """
    segment = conversation.sides[side].segments[at]
    if len(conversation.sides) < 3:
        return ""
    turn = next(
        (
            t
            for t in list_addressed_turns(conversation)
            if t.side == side and t.start <= segment.start < t.end
        ),
        None,
    )
    to = segment.to if segment.to is not None else turn.to if turn is not None else None
    if to is None:
        return ""
    whom = tr("everyone") if to == EVERYBODY else get_side_name(conversation, to)
    if segment.to is None:
        return tr("\nTo {whom} (detected)", whom=whom)
    return tr("\nTo {whom}", whom=whom)
