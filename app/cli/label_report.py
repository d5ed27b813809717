"""Write what was labelled and why into one HTML file: clips that need a look first, then the rest."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

from app.cli.label_page import SCRIPT, STYLE
from app.cli.showing_command import list_shared_names, name_window_command
from app.look.plural import count_clips
from app.translation import tr_plural
from app.typed_command import quote_command
from metagraph.common.xml_text import escape
from metagraph.graph.model import KINDS, LAYERS, Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.flags import estimate_chance_wrong, estimate_gain, explain_doubt, needs_look
from metagraph.suggest.left_aside import group_reasons
from metagraph.suggest.propose import AcceptedProposals, Proposal, Proposals

KIND_MARKS = {
    "stance": "●",
    "gesture": "▲",
    "fidget": "◆",
    "transition": "➜",
}  # as in the window; its module needs Qt


def format_label_report(
    project: Project,
    found: Proposals,
    taken: AcceptedProposals,
    pictures: Mapping[str, Any],
    lists: Mapping[str, Sequence[str]] = {},
    path: Path | None = None,
) -> str:
    """Return the page. `pictures`: clip, or stance of the labelled project -> `[H, W, 4]` uint8, of those
    that could be drawn. `lists`: what else happened, by title; empty lists are left out. `path`: the
    project's file, which the page says how to open.
    """
    doubtful = sorted(
        (p for p in found.doubtful if needs_look(p, taken.left)), key=lambda p: -estimate_gain(p)
    )
    stances = {i: s.name for i in taken.held if (s := taken.project.stance(i)) is not None}
    held = [
        f"<li>{escape(stances[i])}: {escape(rest.reason)}</li>"
        for i, rest in taken.held.items()
        if i in stances
    ]
    parts = [
        f"<h1>{escape(project.name)}: {len(taken.placed)} of {len(found.proposals)} clips labelled</h1>",
        f"<p class='dim'>{len(doubtful)} of them need a look. Each card shows the proposal, how "
        "sure that is, and why.</p>",
        f"<h2>Stances that no clip rests in</h2><ul>{''.join(held)}</ul>" if held else "",
        *(_list(title, lines) for title, lines in lists.items() if lines),
        _overview(taken.project, pictures),
        _bar(),
        _section(
            f"<h2>Needs a look ({len(doubtful)})</h2>",
            _cards(project, found, doubtful, taken, pictures, path),
        )
        if doubtful
        else "<h2>Nothing needs a look</h2>",
    ]
    for layer in LAYERS:
        mine = [p for p in found.proposals.values() if p.layer.value == layer]
        for key, place in found.places.items():
            there = [p for p in mine if p.stance is not None and p.stance.value == key and p not in doubtful]
            if there:
                title = f"<h2>{layer.capitalize()}: {escape(place.name)} ({len(there)})</h2>"
                parts.append(_section(title, _cards(project, found, there, taken, pictures, path)))
    parts.append(_aside(project, found))
    body = "\n".join(parts)
    head = (
        f"<meta charset='utf-8'><link rel='icon' href='data:,'><title>{escape(project.name)}: "
        f"labels</title><style>{STYLE}</style>"
    )
    body += f"\n<script>{SCRIPT}</script>"
    return f"<!doctype html><html lang='en'><head>{head}</head><body>\n{body}</body></html>\n"


def _list(title: str, lines: Sequence[str]) -> str:
    return f"<h2>{escape(title)}</h2><ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"


def _aside(project: Project, found: Proposals) -> str:
    """Return the skipped clips by reason, the most frequent reason first."""
    lines = []
    for why, clips in group_reasons(found.aside):
        names = ", ".join(escape(project.clips[c].name) for c in clips)
        count = count_clips(len(clips))
        lines.append(f"<li>{count}: {escape(why)} <span class='dim'>({names})</span></li>")
    if not lines:
        return ""
    return f"<h2 id='aside'>Skipped ({len(found.aside)})</h2><ul>{''.join(lines)}</ul>"


def _section(title: str, cards: str) -> str:
    return f"<section>{title}{cards}</section>"


def _bar() -> str:
    """Return the controls that filter and sort."""

    def options(first: str, values: Iterable[str]) -> str:
        return f"<option value=''>{first}</option>" + "".join(f"<option>{v}</option>" for v in values)

    return (
        "<h2>Clips</h2><div class='bar'><input id='find' type='search' placeholder='Filter by words' "
        f"aria-label='Filter by words'><select id='kind' aria-label='Kind'>{options('All kinds', KINDS)}"
        f"</select><select id='layer' aria-label='Layer'>{options('All layers', LAYERS)}</select>"
        "<label><input id='look' type='checkbox'> needs a look</label><select id='sort' aria-label='Order'>"
        "<option value=''>As found</option><option value='sure'>Least certain first</option>"
        "<option value='name'>By name</option><option value='kind'>By kind</option></select>"
        "<button id='all'>Show all</button><span class='dim' id='count'></span></div>"
    )


def _overview(project: Project, pictures: Mapping[str, Any]) -> str:
    """Return a button for every stance, with its picture and its numbers of clips."""
    out = []
    for layer in LAYERS:
        graph = project.graphs[layer]
        for stance in graph.stances.values():
            count = {kind: len(graph.of(stance.id, kind)) for kind in KINDS}
            into = sum(a.end_stance == stance.id for a in graph.actions.values() if a.kind == "transition")
            clips = {a.clip for a in graph.actions.values() if stance.id in (a.stance, a.end_stance)}
            gestures = tr_plural("{count:,} gesture", "{count:,} gestures", count["gesture"])
            fidgets = tr_plural("{count:,} fidget", "{count:,} fidgets", count["fidget"])
            lines = (
                f"{layer}, {count_clips(len(clips))}",
                f"{KIND_MARKS['gesture']} {gestures}, {KIND_MARKS['fidget']} {fidgets}",
                f"{KIND_MARKS['transition']} {count['transition']} out, {into} in",
            )
            said = "".join(f"<span class='dim'>{line}</span>" for line in lines)
            key = escape(f"{layer}/{stance.name}", quote=True)
            out.append(
                f"<button data-stance='{key}' title='Show its clips alone'>"
                f"{_picture(pictures.get(stance.id))}<b>{escape(stance.name)}</b>{said}</button>"
            )
    return f"<h2>Stances ({len(out)})</h2><div class='stances'>{''.join(out)}</div>" if out else ""


def _cards(
    project: Project,
    found: Proposals,
    proposals: Iterable[Proposal],
    taken: AcceptedProposals,
    pictures: Mapping[str, Any],
    path: Path | None,
) -> str:
    some = list(proposals)
    commands = list_open_commands(taken.project, [p.clip for p in some], path) if path is not None else {}
    made = "".join(_card(project, found, p, taken, pictures, commands) for p in some)
    return f"<div class='cards'>{made}</div>"


def list_open_commands(project: Project, clips: Iterable[str], path: Path) -> dict[str, str]:
    """Return what to type in a terminal to see each clip in the window."""
    whole, shared = path.resolve(), list_shared_names(project)
    return {clip: quote_command(name_window_command(project, clip, whole, shared)) for clip in clips}


def _data_of(project: Project, found: Proposals, p: Proposal, taken: AcceptedProposals) -> str:
    """Return the attributes by which the page filters and sorts a card."""
    stance = f"{p.layer.value}/{found.places[p.stance.value].name}" if p.stance is not None else ""
    end = f"{p.layer.value}/{found.places[p.end_stance.value].name}" if p.end_stance is not None else ""
    values = {
        "name": project.clips[p.clip].name.lower(),
        "kind": p.kind.value,
        "layer": p.layer.value,
        "stance": stance,
        "end": end,
        "sure": f"{1 - estimate_chance_wrong(p):.3f}",
        "look": "1" if needs_look(p, taken.left) else "0",
    }
    return " ".join(f"data-{key}='{escape(value, quote=True)}'" for key, value in values.items())


def _card(
    project: Project,
    found: Proposals,
    p: Proposal,
    taken: AcceptedProposals,
    pictures: Mapping[str, Any],
    commands: Mapping[str, str],
) -> str:
    kind = p.kind.value
    where = found.places[p.stance.value].name if p.stance is not None else "no stance"
    if p.end_stance is not None:
        where += f" ➜ {found.places[p.end_stance.value].name}"
    limb = f", {p.limb.value} arm" if p.limb.value != "both" else ""
    rows: list[tuple[str, Belief[Any] | None]] = [
        ("kind", p.kind),
        ("layer", p.layer),
        ("stance", p.stance),
        ("end", p.end_stance),
    ]
    if limb:
        rows.append(("arm", p.limb))
    if p.tags is not None:
        rows.append((f"tags {', '.join(p.tags.value)}", p.tags))
    reasons = [
        f"<li>{escape(name)} {b.confidence:.0%}: {escape(b.reason)}</li>" for name, b in rows if b is not None
    ]
    details = [
        f"<li>{escape(_said(name, b.value))} {b.confidence:.0%}: {escape(b.reason)}</li>"
        for name, b in _placed_details(p, taken).items()
    ]
    if details:
        reasons.append(
            "<li><details><summary class='dim'>timing, joints, "
            f"likelihood</summary><ul>{''.join(details)}</ul></details></li>"
        )
    warnings = [
        *([explain_doubt(p)] if needs_look(p) else p.conflicts),
        *([p.timing_reason] if p.good is False else []),
        *([taken.left[p.clip]] if p.clip in taken.left else []),
    ]
    reasons = [f"<li class='warn'>{escape(words)}</li>" for words in warnings] + reasons
    title = (
        f"<b>{escape(project.clips[p.clip].name)}</b><br><span class='{kind}'>{KIND_MARKS[kind]} "
        f"{kind}</span>"
    )
    opening = ""
    if p.clip in commands:
        command = escape(commands[p.clip], quote=True)
        opening = f"<button class='open' title='{command}'>Open in the window…</button>"
        opening += f"<code hidden>{command}</code>"
    return (
        f"<div class='card' {_data_of(project, found, p, taken)}>{_picture(pictures.get(p.clip))}"
        f"<div>{title} <span class='dim'>{escape(where)}{limb}</span><ul>{''.join(reasons)}</ul>{opening}"
        "</div></div>"
    )


def _placed_details(p: Proposal, taken: AcceptedProposals) -> Mapping[str, Belief[Any]]:
    """Return the details of a proposal with the times that its action has in the labelled project."""
    action = next((a for a in taken.project.uses.get(p.clip, ()) if a.kind == p.kind.value), None)
    if action is None or p.clip not in taken.placed:
        return p.details
    out = dict(p.details)
    for name in ("blend_in", "blend_out", "repeat"):
        value = getattr(action.timing, name)
        if name in out and abs(value - (out[name].value or 0.0)) > 5e-4:
            out[name] = replace(
                out[name], value=value, reason="longer, to come from its stance and go back calmly"
            )
    if action.timing.repeat > 0:
        out.pop("loop", None)  # what repeats neither loops nor plays once
    return out


def _picture(picture: Any) -> str:
    return f"<img alt='' src='{_data(picture)}'>" if picture is not None else "<div class='none'></div>"


def _said(name: str, value: Any) -> str:
    """Return a detail and its value in words: 'blend in 0.20 s'."""
    words = name.replace("_", " ")
    if name == "mask":
        return f"joints: {', '.join(value[:4])}{' …' if len(value) > 4 else ''}" if value else "joints: all"
    if name == "loop":
        return "loops" if value else "plays once"
    if name == "likelihood":
        return f"likelihood {value:g}"
    if value is None:
        return f"{words}: the clip's" if name == "end" else f"{words}: none"
    return f"{words} {value:.2f} s"


def _data(picture: Any) -> str:
    """Return a picture as a data URL."""
    from PIL import Image

    out = BytesIO()
    Image.fromarray(picture).convert("RGB").save(out, "JPEG", quality=80)
    return f"data:image/jpeg;base64,{base64.b64encode(out.getvalue()).decode()}"
