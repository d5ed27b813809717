"""Texts of a review: the headline over the picture, the timing, the keys, and rounded lengths of time."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from html import escape

from app.look.theme import KIND_MARKS, KIND_TITLES, WindowTheme
from app.translation import format_number, make_lazy_texts, tr, tr_noop, tr_phrase, tr_plural
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import Project
from metagraph.suggest.accept import AcceptedProposals
from metagraph.suggest.proposal import Proposal
from metagraph.suggest.review import Review

KEYS = make_lazy_texts(
    lambda: (
        (tr("Enter"), tr("accept")),
        ("↑ ↓", tr("field")),
        ("← → 1–9", tr("change")),
        ("Tab", tr("next")),
        ("⇧Tab", tr("back")),
        (tr("Backspace"), tr("undo")),
        (tr("Space"), tr("pause")),
        (", .", tr("frame")),
        ("[ ]", tr("set start, end")),
        ("C", tr("clip only")),
        ("N", tr("find or add a stance")),
        ("T", tr("tags")),
        ("A", tr("accept certain ones")),
        ("G", tr("groups")),
        ("W", tr("watch all")),
        ("B", tr("bridge stances")),
    )
)
ANYWAY = tr_noop("Skipped. To label it anyway, choose its kind.")


def format_keys(look: WindowTheme) -> str:
    """Return the keys as rich text, without line breaks between a key and its word."""
    return " &nbsp; ".join(
        f'<span style="color:{look.text}">{key.replace(" ", "&nbsp;")}</span>&nbsp;'
        f'<span style="color:{look.dim}">{words.replace(" ", "&nbsp;")}</span>'
        for key, words in KEYS
    )


def write_headline(review: Review, project: Project, clip: str, look: WindowTheme) -> str:
    """Return the proposal for a clip as rich text, with the evidence against it."""
    if clip not in review.found.proposals:
        return (
            f'<span style="font-size:17px; font-weight:600">{tr("Skipped")}</span><br>'
            f'<span style="color:{look.dim}">{escape(project.clips[clip].name)}</span><br>'
            f"{escape(tr_phrase(review.found.aside.get(clip, '')))}"
        )
    p, places = review.found.proposals[clip], review.found.places
    kind = p.kind.value
    where = [get_vocabulary_title(p.layer.value)]
    if p.stance is not None:
        where.append(places[p.stance.value].name)
    if p.end_stance is not None:
        where[-1] += f" ➜ {places[p.end_stance.value].name}"
    lines = [
        f'<span style="font-size:17px; font-weight:600; color:{look.kinds[kind]}">{KIND_MARKS[kind]} '
        f"{tr(KIND_TITLES[kind])}</span>"
        f'<span style="font-size:15px"> &nbsp;{escape("  ·  ".join(where))}</span>',
        f'<span style="color:{look.dim}">{escape(project.clips[clip].name)}</span>',
    ]
    against = [*p.conflicts, *([p.timing_reason] if p.good is False else [])]
    lines += [f'<span style="color:{look.warning}">⚠ {escape(tr_phrase(words))}</span>' for words in against]
    return "<br>".join(lines)


def describe_placing(taken: AcceptedProposals, clips: Collection[str]) -> str:
    """Return what a user would not expect of the `clips` that were accepted: which one was not placed,
    and which others were placed, too; "" if nothing. The stance of a gesture is placed with it.
    """
    name = lambda clip: taken.project.clips[clip].name  # noqa: E731
    along = [clip for clip in taken.placed if clip not in clips]
    words = []
    if along:
        words.append(
            tr_plural(
                "Placed {name}, too: the others need its stance.",
                "Placed {count:,} more ({name}): the others need their stances.",
                len(along),
                name=", ".join(map(name, along)),
            )
        )
    if taken.left:
        clip, why = next(iter(taken.left.items()))
        words.append(tr("{name} was not placed: {why}.", name=name(clip), why=tr_phrase(why)))
    return " ".join(words)


def describe_skipped(aside: Sequence[str]) -> str:
    """Return the text for a review in which only skipped clips remain."""
    return tr_plural(
        "<b>All clips are placed</b> except {count:,} skipped clip.",
        "<b>All clips are placed</b> except {count:,} skipped clips.",
        len(aside),
    )


def describe_proposed_times(p: Proposal, duration: float) -> str:
    """Return a proposal's times as rich text. duration: of the clip, in seconds."""
    t, end = p.timing, p.timing.get("end")
    parts = [
        tr(
            "From {start:.2f} to {end:.2f} s of {duration:.2f} s",
            start=t.get("start") or 0.0,
            end=duration if end is None else end,
            duration=duration,
        )
    ]
    if t.get("blend_in") or t.get("blend_out"):
        parts.append(
            tr(
                "blends in {begin:.2f} s, out {end:.2f} s",
                begin=t.get("blend_in") or 0.0,
                end=t.get("blend_out") or 0.0,
            )
        )
    if t.get("earliest_exit") is not None:
        parts.append(tr("can exit from {seconds:.2f} s", seconds=t["earliest_exit"]))
    if t.get("repeat"):
        parts.append(tr("repeats for {seconds:.2f} s", seconds=t["repeat"]))
    if t.get("loop"):
        parts.append(tr("loops"))
    words = [", ".join(parts)]
    if p.timing_reason and p.good is not False:
        words[0] += f": {tr_phrase(p.timing_reason)}"
    for name, belief in ((name, p.details.get(name)) for name in ("stroke", "mask", "likelihood")):
        if belief is not None and (name != "mask" or belief.value):
            value = (
                format_number(belief.value, "g")
                if name == "likelihood"
                else tr("{seconds:.2f} s", seconds=belief.value)
                if name == "stroke"
                else tr("some joints")
            )
            words.append(f"{get_vocabulary_title(name)} {value}: {tr_phrase(belief.reason)}")
    return "<br>".join(map(escape, words))


def describe_length(seconds: float) -> str:
    """Return a rounded length of time in words."""
    return (
        tr("about {minutes} min", minutes=round(seconds / 60))
        if seconds >= 90
        else tr("about {seconds} s", seconds=max(5, round(seconds / 5) * 5))
    )
