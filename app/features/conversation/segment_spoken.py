"""What screen readers report about a conversation's lanes: the segments of each speaker."""

from __future__ import annotations

from collections.abc import Sequence

from app.features.conversation.addressees import describe_addressee
from app.features.conversation.segment_editing import Editing
from app.features.conversation.segment_lanes import (
    describe_segment,
    measure_segment_rect,
    place_segment_lanes,
)
from app.translation import tr
from app.widgets.lane_geometry import LaneScale
from app.widgets.spoken_items import SpokenItem
from metagraph.graph.conversation.model import Conversation, get_side_name


def list_segment_items(
    of: Conversation, scale: LaneScale, size: tuple[float, float], editing: Editing
) -> Sequence[SpokenItem]:
    """Return the segments of a conversation, speaker by speaker. size: of all lanes, pixels."""
    out = []
    for side, lane in enumerate(place_segment_lanes(*size, len(of.sides))):
        for place, segment in enumerate(of.sides[side].segments):
            words = (describe_segment(segment) + describe_addressee(of, side, place)).splitlines()
            name = tr("{speaker}: {what}", speaker=get_side_name(of, side), what=words[0])
            rect = measure_segment_rect(segment, scale, lane)
            selected, focused = (side, place) in editing.chosen, (side, place) == editing.last
            more = ", ".join(words[1:])
            out.append(SpokenItem(name, rect, description=more, selected=selected, focused=focused))
    return out
