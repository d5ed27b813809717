"""Scripts of conformance for requests that say how late they may come."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from metagraph.engines.script_parts import ScriptCase, ScriptStep, ask, list_some_actions, make_case
from metagraph.graph.model import LAYERS, Project


def list_timely_cases(project: Project) -> Iterator[ScriptCase]:
    """Yield cases of requests that say how late they may come."""
    for layer in LAYERS:
        gestures = list_some_actions(project, layer, "gesture")
        if not gestures:
            continue
        one, own = gestures[0], dict[str, Any](layer=layer, late=0.0)
        tags = sorted({t for a in gestures for t in a.tags})
        many = next((a.tags for a in gestures if len(a.tags) > 1), one.tags)
        asks = [ask(f"s{n}", "gesture", stroke=2.0 + 0.8 * n, **own) for n in range(8)]
        asks += [
            ask(f"t{n}", "gesture", stroke=11.0 + 1.3 * n, tags=[tags[n % len(tags)]], layer=layer, late=0.3)
            for n in range(6 if tags else 0)
        ]
        asks += [
            ask(f"one{n}", "gesture", stroke=21.0 + 0.1 * n, tags=[tag], **own) for n, tag in enumerate(many)
        ]
        asks += [
            ask("room", "gesture", stroke=24.0, **own),
            ask("next", "action", action=one.id, stroke=25.4, late=0.0),
            ask("held", "gesture", stroke=28.0, hold=1.0, **own),
            ask("after", "gesture", stroke=29.9, layer=layer, late=2.0),
        ]
        about = "strokes on time or not at all, shared ones, and what leaves room for the next"
        yield make_case(f"{layer}: strokes that may not be late", about, asks, 36.0)
        # One that comes late, and another that could share its stroke, if it may wait.
        for wait in (0.1, 2.0):
            asks = [ask("runs", "action", 1.0, action=one.id)]
            asks += [ask("m0", "gesture", stroke=1.75, tags=[many[0]], layer=layer, late=4.0)] if many else []
            asks += (
                [ask("m1", "gesture", stroke=2.0, tags=[many[-1]], layer=layer, late=wait)] if many else []
            )
            about = "a shared stroke may be too late for one of both"
            yield make_case(f"{layer}: a late stroke that {wait} s later may be shared", about, asks, 14.0)
        now = [
            ask("n0", "gesture", stroke=6.6, **own),
            ask("n1", "gesture", stroke=7.8, layer=layer, late=0.5),
        ]
        more = [ask("n2", "gesture", stroke=8.9, **own), ask("n3", "gesture", stroke=9.0, **own)]
        steps = (
            ScriptStep(0.0, 14.0, (ask("b", "gesture", 4.9, layer=layer),)),
            ScriptStep(5.6, 14.0, tuple(now)),
            ScriptStep(7.9, 16.0, tuple(more)),
            ScriptStep(8.95, 20.0, (ask("n4", "gesture", 8.9, **own), ask("n5", "gesture", 9.5, **own))),
            ScriptStep(12.0, 24.0, (ask("n6", "gesture", stroke=12.7, **own),), forget=9.0),
        )
        about = "what runs is left for what may not be late"
        yield ScriptCase(f"{layer}: strokes that become known late", about, steps, idle=True)
        asks = [
            ask("a", "gesture", stroke=4.0, **own),
            ask("b", "gesture", stroke=4.5, layer=layer, late=4.0),
        ]
        asks += [
            ask(f"c{n}", "gesture", stroke=12.0 + 0.2 * n, tags=[t], **own) for n, t in enumerate(many[:2])
        ]
        on = [ScriptStep(now, now + 18.0) for now in (1.0, 3.0, 12.0, 13.0)]
        about = "lateness is told once, and what serves two is not played twice"
        yield ScriptCase(
            f"{layer}: strokes that are planned on", about, (ScriptStep(0.0, 20.0, tuple(asks)), *on)
        )
    for layer in LAYERS:
        graph = project.graphs[layer]
        gestures, late = list_some_actions(project, layer, "gesture"), {"late": 0.4}
        if not gestures:
            continue
        other = next((a for a in gestures if a.stance != gestures[0].stance), None)
        asks = [
            ask("plays", "action", 1.0, action=gestures[0].id),
            ask("waits", "gesture", 1.2, layer=layer, late=0.1),
            ask("fidget", "fidget", 1.4, layer=layer, **late),
            ask("soon", "action", 7.0, action=gestures[0].id),
            ask("change", "change", 7.3, layer=layer, **late),
        ]
        asks += [ask("far", "action", 13.0, action=other.id, **late)] if other else []
        asks += [
            ask(f"go{n}", "stance", 18.0 + 0.2 * n, stance=ident, **late)
            for n, ident in enumerate(list(graph.stances)[:3])
        ]
        asks += [ask("nod", "nod", 18.1, **late), ask("shake", "shake", 18.3, **late)]
        about = "of those without a stroke the start counts; transitions on the way take time"
        yield make_case(f"{layer}: starts that may not be late", about, asks, 26.0)
