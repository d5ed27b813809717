"""What a session is reported about its partner's mood and laughter, as the ask that its own mood becomes."""

from __future__ import annotations

from metagraph.graph.conversation.model import Rates
from metagraph.graph.model import Project
from metagraph.graph.requests import Feel
from metagraph.live.messages import Partner
from metagraph.playback.life.sympathy import DELAY, Laugh, laughs_along, taken_up
from metagraph.playback.life.track import Track
from metagraph.playback.life.wanted import moods_of
from metagraph.playback.planning.mood import Mood, Moods, mood_at
from metagraph.playback.planning.understand import read_mood

MOOD, LAUGH = "partner", "partner laugh"  # ids, where the client gives none
# How far, or how often, where the client does not say.
MOOD_SHARE, LAUGH_SHARE = Rates().mood, Rates().laugh


def find_partner_feel(
    message: Partner, ident: str, key: str, project: Project, track: Track, now: float
) -> Feel | None:
    """Return what a character feels that is reported about its partner; None if it does not laugh along.

    ident: of the ask, which a later one replaces. key: the ask's in the plan: what it told before is not
    counted as the character's own.
    """
    told = moods_of(project.life, track)
    own = Moods(told.base, [m for m in told.told if not m.id.startswith(key)])
    if message.laughs is not None:
        seed = project.settings.seed
        share = LAUGH_SHARE if message.share is None else message.share
        found = laughs_along(own, [Laugh(now, now + message.laughs)], share, seed, f"{ident} {now:.3f}")
        if not found:
            return None
        one = found[0]
        assert one.valence is not None and one.arousal is not None
        return Feel(id=ident, at=one.start, mood=(one.valence, one.arousal), duration=one.end - one.start)
    other = read_mood(message.mood, None)
    mine = mood_at(own, now)
    seen = Mood(other.get("valence", 0.0), other.get("arousal", 0.0))
    mood = taken_up(mine, seen, MOOD_SHARE if message.share is None else message.share)
    return Feel(id=ident, at=now + DELAY, mood=(round(mood.valence, 4), round(mood.arousal, 4)))
