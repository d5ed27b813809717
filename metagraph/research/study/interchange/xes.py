"""A study's logs for process mining: XES, the eXtensible Event Stream (IEEE 1849-2016). A trace is a task
of a participant; an event is what they did.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from metagraph import __version__
from metagraph.common.xml_text import clean_xml_text
from metagraph.formats.atomic import write_atomically
from metagraph.research.study.logs.log import StudyLog, read_log
from metagraph.research.study.scores.tasks import Event, list_event_steps
from metagraph.research.study.study_plan import Study

EXTENSIONS = {
    "Concept": ("concept", "http://www.xes-standard.org/concept.xesext"),
    "Time": ("time", "http://www.xes-standard.org/time.xesext"),
    "Organizational": ("org", "http://www.xes-standard.org/org.xesext"),
    "Lifecycle": ("lifecycle", "http://www.xes-standard.org/lifecycle.xesext"),
}
TOLD = frozenset(
    {
        "edit",
        "undo",
        "redo",
        "view",
        "playback",
        "dialog",
        "error",
        "import",
        "save",
        "export",
        "pause",
        "idle",
    }
)


def write_xes(study: Study, out: Path) -> int:
    """Write the tasks of everybody who did not withdraw as one XES file; return how many traces there are.
    Raises FileError.
    """
    root = ElementTree.Element(
        "log",
        {
            "xes.version": "1849-2016",
            "xes.features": "nested-attributes",
            "xmlns": "http://www.xes-standard.org/",
        },
    )
    for name, (prefix, uri) in EXTENSIONS.items():
        ElementTree.SubElement(root, "extension", {"name": name, "prefix": prefix, "uri": uri})
    for scope in ("trace", "event"):
        node = ElementTree.SubElement(root, "global", {"scope": scope})
        _string(node, "concept:name", "unknown")
        if scope == "event":
            ElementTree.SubElement(
                node, "date", {"key": "time:timestamp", "value": "1970-01-01T00:00:00.000Z"}
            )
    ElementTree.SubElement(root, "classifier", {"name": "Activity", "keys": "concept:name"})
    _string(root, "concept:name", study.plan.title)
    _string(root, "source:program", f"metagraph {__version__}")
    count = 0
    for who in study.plan.ids:
        if not study.log(who).is_file():
            continue
        log = read_log(study.log(who))
        if log.standing == "withdrawn":
            continue
        for begun, events in _tasks(log):
            trace = ElementTree.SubElement(root, "trace")
            _string(trace, "concept:name", f"{who} {begun.get('task')} {begun.get('condition')}")
            for key in ("condition", "task"):
                _string(trace, key, str(begun.get(key, "")))
            _string(trace, "participant", who)
            for event, seconds in events:
                _event(trace, event, seconds, who)
            count += 1
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    write_atomically(out, f"<?xml version='1.0' encoding='UTF-8'?>\n{text}\n".encode())
    return count


def _tasks(log: StudyLog) -> Iterator[tuple[Event, list[tuple[Event, float]]]]:
    begun: Event | None = None
    kept: list[tuple[Event, float]] = []
    waited = 0.0
    for event, seconds, _ in list_event_steps(log.events):
        waited += seconds
        if begun is not None and event["type"] in TOLD:
            kept.append((event, waited))
            waited = 0.0
        if event["type"] == "phase":
            if begun is not None:
                yield begun, kept
            begins = event.get("name") == "task" and event.get("state") == "begin"
            begun, kept, waited = (event if begins else None), [], 0.0
    if begun is not None:
        yield begun, kept


def _event(trace: ElementTree.Element, event: Event, seconds: float, who: str) -> None:
    node = ElementTree.SubElement(trace, "event")
    what = event.get("what", event.get("state", event.get("name")))
    _string(node, "concept:name", f"{event['type']} {what}" if what else event["type"])
    ElementTree.SubElement(
        node, "date", {"key": "time:timestamp", "value": clean_xml_text(str(event["wall"]))}
    )
    _string(node, "org:resource", who)
    _string(node, "lifecycle:transition", "complete")
    _string(node, "sort", event["type"])
    ElementTree.SubElement(node, "float", {"key": "seconds", "value": f"{seconds:.3f}"})
    clips: Any = event.get("clips")
    if isinstance(clips, list) and clips:
        _string(node, "clips", " ".join(map(str, clips)))
    for key in ("layer", "words"):
        if event.get(key):
            _string(node, key, str(event[key]))


def _string(node: ElementTree.Element, key: str, value: str) -> None:
    ElementTree.SubElement(node, "string", {"key": key, "value": clean_xml_text(value)})
