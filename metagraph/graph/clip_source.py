"""A clip as it was read, beside the clip as it plays."""

from __future__ import annotations

from dataclasses import replace

from metagraph.graph.model import ClipEntry
from metagraph.motion.clip import Clip
from metagraph.motion.in_place import keep_in_place, stand_elsewhere
from metagraph.motion.retime import Course, apply_retiming


def get_source_clip(entry: ClipEntry) -> Clip | None:
    """Return a clip as it was read, None while its file is missing."""
    return entry.source if entry.source is not None else entry.motion


def get_clip_course(entry: ClipEntry) -> Course | None:
    """Return which moment of the clip as it was read plays when; None while its file is missing."""
    source = get_source_clip(entry)
    return None if source is None else Course(entry.retime, source.duration, source.fps)


def with_changed_file(entry: ClipEntry, source: Clip, digest: str) -> ClipEntry:
    """Return an entry whose file was read again. Where the file is another than before and as long no more,
    the entry remembers the length that its actions were timed on.
    """
    after = with_source(replace(entry, digest=digest), source)
    before = entry.timed_on or entry.duration
    if entry.frames < 2 or not entry.digest or (digest == entry.digest and not entry.timed_on):
        return after
    other = abs(after.duration - before) > 1.5 / after.fps
    return replace(after, timed_on=before if other else 0.0)


def with_source(entry: ClipEntry, source: Clip) -> ClipEntry:
    """Return an entry whose clip was read, kept in place if it is to be, where it is to stand, with its
    retiming made.
    """
    kept = keep_in_place(source) if entry.in_place else source
    stands = stand_elsewhere(kept, entry.turned, entry.moved_x, entry.moved_z)
    motion = apply_retiming(stands, entry.retime)
    return replace(
        entry,
        frames=motion.frames,
        fps=motion.fps,
        motion=motion,
        source=None if motion is source else source,
    )
