"""What the planner remembers of played actions: how often each played lately, and until when."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.playback.plan import Cue

REMEMBERED = 32  # draws of a stance and kind that spacing can look back on


def node(stance: str, kind: str) -> str:
    """Return the key under which draws of a stance and kind are remembered."""
    return f"{kind} {stance}"


def rested(recent: Sequence[str], ident: str, needed: int) -> bool:
    """Return whether at least this many other draws came after an action's last one."""
    if needed <= 0:
        return True
    return needed <= REMEMBERED and ident not in recent[max(0, len(recent) - needed) :]


def remember(
    cue: Cue, uses: dict[str, int], recent: dict[str, tuple[str, ...]], ended: dict[str, float]
) -> None:
    """Note that a cue was played: count its action, and note when it ended."""
    ident = cue.action.id
    place = node(cue.stance, cue.action.kind)
    uses[ident] = uses.get(ident, 0) + 1
    recent[place] = (*recent.get(place, ())[1 - REMEMBERED :], ident)
    ended[ident] = cue.end
