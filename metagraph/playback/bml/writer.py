"""Behaviour Markup Language out: asks as a block of BML 1.0. What BML has no word for goes into attributes of
our own.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import msgspec

from metagraph.common.xml_text import clean_xml_text
from metagraph.graph import requests as a

NAMESPACES = 'xmlns="http://www.bml-initiative.org/bml/bml-1.0" xmlns:metagraph="urn:metagraph:bml"'
_POINT = re.compile(r"[-+.\deE]+[\s,]+[-+.\deE]+[\s,]+[-+.\deE]+")


def write_bml(asks: Iterable[a.AnyRequest]) -> str:
    """Return asks as a block which reads back to the same asks; lines' numbers come back as texts, `told` is
    not kept.

    Characters that XML cannot hold are replaced, see `clean_xml_text`. Raises RequestError for what no block
    can hold: ids that are not unique, a block within a block.
    """
    rows, seen = [], set[str]()
    for ask in asks:
        ident = clean_xml_text(ask.id)
        if ident and ident in seen:
            raise a.RequestError(f"two asks are called '{ident}'; a block needs ids of their own")
        seen.add(ident)
        rows.append(f"  {_element(ask)}\n")
    return f"<bml {NAMESPACES}>\n{''.join(rows)}</bml>\n"


def _element(ask: a.AnyRequest) -> str:
    """Return one ask's element."""
    own: dict[str, Any] = {
        "id": ask.id or None,
        "metagraph:priority": str(ask.priority) if ask.priority != 1 else None,
        "metagraph:late": _number(getattr(ask, "late", None)),
    }
    mood = getattr(ask, "mood", None)
    own |= {
        "metagraph:mood": mood if isinstance(mood, str) or mood is None else " ".join(map(str, mood)),
        "metagraph:intensity": _number(getattr(ask, "intensity", None)),
    }
    times: dict[str, Any] = {"start": _number(ask.at)}
    end = _after("start", getattr(ask, "duration", None))
    match ask:
        case a.Gesture():
            return _gesture(ask, own, times)
        case a.Fidget():
            own |= _tagged(ask.tags) | {"mode": ask.limb, "metagraph:resume": _flag(ask.resume, False)}
            return _tag("metagraph:fidget", own | _layered(ask.layer) | times | {"end": end})
        case a.Play():
            own |= {"name": ask.action, "metagraph:layer": ask.layer}
            return _tag("animation", own | times | _phased(ask) | {"end": end})
        case a.Go():
            own |= {"metagraph:layer": ask.layer, "metagraph:stay": _flag(ask.stay, False)}
            return _tag("postureShift", own | times, _tag("stance", {"type": ask.stance}))
        case a.Change():
            own |= _layered(ask.layer) | {"mode": ask.limb}
            return _tag("metagraph:change", own | times | {"end": end})
        case a.Nod() | a.Shake():
            tags = msgspec.json.encode(ask.tags).decode() if ask.tags else None
            own |= {"lexeme": "NOD" if isinstance(ask, a.Nod) else "SHAKE", "metagraph:tags": tags}
            return _tag("head", own | times)
        case a.Look():
            return _look(ask, own, times | {"end": end})
        case a.Blink():
            return _tag("faceLexeme", own | {"lexeme": "BLINK"} | times)
        case a.Say():
            return _speech(ask, own, times | {"end": end})
        case a.Behave():
            return _tag("metagraph:mode", own | {"mode": ask.mode} | times)
        case a.Feel():
            return _tag("metagraph:mood", own | {"duration": _number(ask.duration)} | times)
        case a.Place():
            return _tag("metagraph:place", own | {"name": ask.name, "point": _point(ask.point)} | times)
        case a.Withdraw():
            return _tag("metagraph:withdraw", own | {"what": ask.what or None} | times)
        case _:
            raise a.RequestError("a block of BML cannot hold another; write its behaviours out")


def _gesture(ask: a.Gesture, own: dict[str, Any], times: dict[str, Any]) -> str:
    hands = f"{ask.limb.upper()}_HAND" if ask.limb in ("left", "right") else _upper(ask.limb)
    own = own | _tagged(ask.tags) | {"mode": hands} | _layered(ask.layer)
    own |= {"metagraph:resume": _flag(ask.resume, False)}
    return _tag("gesture", own | times | _phased(ask) | {"end": _after("start", ask.duration)})


def _look(ask: a.Look, own: dict[str, Any], times: dict[str, Any]) -> str:
    """Return a gaze. A name that reads as a point, or has spaces about it, goes into our own attribute."""
    to = ask.to if isinstance(ask.to, str) else _point(ask.to)
    plain = not isinstance(ask.to, str) or (ask.to == ask.to.strip() and not _POINT.fullmatch(ask.to))
    own = own | {
        "target" if plain else "metagraph:to": to,
        "metagraph:amount": _number(ask.amount) if ask.amount != 1 else None,
        "metagraph:strict": _flag(ask.strict, False),
    }
    return _tag("gazeShift" if ask.duration is None else "gaze", own | times)


def _speech(ask: a.Say, own: dict[str, Any], times: dict[str, Any]) -> str:
    own = own | {
        "ref": None if ask.line is None else str(ask.line),
        "metagraph:gestures": _flag(ask.gestures, True),
    }
    keep = {"xml:space": "preserve"} if ask.text != " ".join(ask.text.split()) else {}
    return _tag("speech", own | times, _tag("text", keep, _escaped(ask.text, False)))


def _layered(layer: str) -> dict[str, Any]:
    return {"metagraph:layer": layer if layer != "arms" else None}


def _point(point: Iterable[float]) -> str:
    return " ".join(repr(float(x)) for x in point)


def _phased(ask: a.Gesture | a.Play) -> dict[str, Any]:
    """Return stroke, hold and missing preparation in BML's way of saying them."""
    out: dict[str, Any] = {"stroke": _number(ask.stroke), "relax": _after("strokeEnd", ask.hold)}
    if not ask.prepare:
        out |= {"start": "this:ready", "ready": _number(ask.at)}
    return out


def _tagged(tags: tuple[str, ...]) -> dict[str, Any]:
    plain = all(t and t == t.strip() and "," not in t for t in tags)
    out: dict[str, Any] = {"lexeme": ",".join(tags) or None} if plain else {}
    return out if plain else {"lexeme": None, "metagraph:tags": msgspec.json.encode(tags).decode()}


def _number(value: float | None) -> str | None:
    return None if value is None else repr(float(value))


def _after(sync: str, seconds: float | None) -> str | None:
    return None if seconds is None else f"this:{sync}+{float(seconds)!r}"


def _flag(value: bool, usual: bool) -> str | None:
    return None if value == usual else str(value).lower()


def _upper(text: str | None) -> str | None:
    return f"{text.upper()}_HANDS" if text else None


def _tag(name: str, attributes: dict[str, Any], inner: str = "") -> str:
    words = "".join(
        f' {key}="{_escaped(value, True)}"' for key, value in attributes.items() if value is not None
    )
    return f"<{name}{words}>{inner}</{name}>" if inner else f"<{name}{words}/>"


def _escaped(text: str, attribute: bool) -> str:
    text = clean_xml_text(text)
    out = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace("\r", "&#13;")
    if attribute:
        out = out.replace('"', "&quot;").replace("\n", "&#10;").replace("\t", "&#9;")
    return out
