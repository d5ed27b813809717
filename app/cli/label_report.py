"""What was labelled and why, as one HTML file that needs nothing beside it: what needs a person first, then
all the rest by stance.
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from html import escape
from io import BytesIO
from typing import Any

from metagraph.graph.model import LAYERS, Project
from metagraph.suggest.estimate import Belief
from metagraph.suggest.propose import Proposal, Proposals, Taken

KIND_MARKS = {
    "stance": "●",
    "gesture": "▲",
    "fidget": "◆",
    "transition": "➜",
}  # as in the window; its module needs Qt
SURE = 0.9  # from here on a proposal needs no second look

STYLE = """
:root { color-scheme: dark light; --ground: #17181b; --card: #25282d; --line: #34383f; --text: #dfe3e8; --dim: #9aa1ab; --warn: #e8c24a;
  --stance: #3fb8a6; --gesture: #f0a63c; --fidget: #a98bf0; --transition: #5aa3f0; }
@media (prefers-color-scheme: light) {
  :root { --ground: #f6f7f8; --card: #fff; --line: #cdd2d8; --text: #1d2126; --dim: #59616b; --warn: #7d5b00;
    --stance: #127065; --gesture: #8f5a00; --fidget: #6a45c4; --transition: #1a63b8; }
}
body { margin: 0 auto; max-width: 1180px; padding: 24px; background: var(--ground); color: var(--text);
  font: 14px/1.45 system-ui, sans-serif; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 36px; } h3 { font-size: 14px; color: var(--dim); margin: 22px 0 8px; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(360px, 1fr)); gap: 10px; }
.card { display: grid; grid-template-columns: 96px 1fr; gap: 12px; padding: 10px;
  background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
.card img, .card .none { width: 96px; height: 96px; border-radius: 6px; }
.card b { overflow-wrap: anywhere; } .dim { color: var(--dim); } .warn { color: var(--warn); }
.stance { color: var(--stance); } .gesture { color: var(--gesture); }
.fidget { color: var(--fidget); } .transition { color: var(--transition); }
ul { margin: 4px 0 0; padding-left: 18px; font-size: 13px; }
"""


def report(
    project: Project, found: Proposals, taken: Taken, pictures: Mapping[str, Any], notes: Iterable[str] = ()
) -> str:
    """Return the page. pictures: clip -> `[H, W, 4]` uint8, of those that could be drawn."""
    doubtful = [p for p in found.doubtful if needs_a_look(p, taken)]
    told = [f"<li>{escape(note)}</li>" for note in notes]
    stances = {i: s.name for i in taken.held if (s := taken.project.stance(i)) is not None}
    held = [
        f"<li>{escape(stances[i])}: {escape(rest.reason)}</li>"
        for i, rest in taken.held.items()
        if i in stances
    ]
    parts = [
        f"<h1>{escape(project.name)}: {len(taken.placed)} of {len(found.proposals)} clips labelled</h1>",
        f"<p class='dim'>{len(doubtful)} of them need a person's look. Each says what it was taken for, how "
        "sure that is, and why.</p>",
        f"<h2>Stances that no clip rests in</h2><ul>{''.join(held)}</ul>" if held else "",
        f"<h2>While importing</h2><ul>{''.join(told)}</ul>" if told else "",
        f"<h2>Needs a look ({len(doubtful)})</h2>" if doubtful else "<h2>Nothing needs a look</h2>",
        _cards(project, found, doubtful, taken, pictures),
    ]
    for layer in LAYERS:
        mine = [p for p in found.proposals.values() if p.layer.value == layer]
        if not mine:
            continue
        parts.append(f"<h2>{layer.capitalize()}</h2>")
        for key, place in found.places.items():
            there = [p for p in mine if p.stance is not None and p.stance.value == key and p not in doubtful]
            if there:
                parts.append(
                    f"<h3>{escape(place.name)} "
                    f"({len(there)})</h3>{_cards(project, found, there, taken, pictures)}"
                )
    body = "\n".join(parts)
    head = (
        f"<meta charset='utf-8'><link rel='icon' href='data:,'><title>{escape(project.name)}: "
        f"labels</title><style>{STYLE}</style>"
    )
    return f"<!doctype html><html lang='en'><head>{head}</head><body>\n{body}\n</body></html>\n"


def needs_a_look(p: Proposal, taken: Taken) -> bool:
    """Whether somebody should look at a proposal: it is unsure, its sources disagree, it would jump, or it
    was not placed.
    """
    return p.confidence < SURE or bool(p.conflicts) or p.good is False or p.clip in taken.left


def _cards(
    project: Project,
    found: Proposals,
    proposals: Iterable[Proposal],
    taken: Taken,
    pictures: Mapping[str, Any],
) -> str:
    return f"<div class='cards'>{''.join(_card(project, found, p, taken, pictures) for p in proposals)}</div>"


def _card(project: Project, found: Proposals, p: Proposal, taken: Taken, pictures: Mapping[str, Any]) -> str:
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
        for name, b in p.details.items()
    ]
    if details:
        reasons.append(
            "<li><details><summary class='dim'>timing, joints, "
            f"likelihood</summary><ul>{''.join(details)}</ul></details></li>"
        )
    warnings = [
        *p.conflicts,
        *([p.timing_reason] if p.good is False else []),
        *([taken.left[p.clip]] if p.clip in taken.left else []),
    ]
    reasons = [f"<li class='warn'>{escape(words)}</li>" for words in warnings] + reasons
    picture = (
        f"<img alt='' src='{_data(pictures[p.clip])}'>" if p.clip in pictures else "<div class='none'></div>"
    )
    title = (
        f"<b>{escape(project.clips[p.clip].name)}</b><br><span class='{kind}'>{KIND_MARKS[kind]} "
        f"{kind}</span>"
    )
    return (
        f"<div class='card'>{picture}<div>{title} <span "
        f"class='dim'>{escape(where)}{limb}</span><ul>{''.join(reasons)}</ul></div></div>"
    )


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
    """Return a picture as an address that holds it."""
    from PIL import Image

    out = BytesIO()
    Image.fromarray(picture).convert("RGB").save(out, "JPEG", quality=80)
    return f"data:image/jpeg;base64,{base64.b64encode(out.getvalue()).decode()}"
