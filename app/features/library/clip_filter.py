"""What the library shows: a rule that is a value, so that it can be compared, named and kept."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields

from app.features.library.clip_facts import ClipFacts
from app.look.domain_words import COLOR_TITLES, KIND_TITLES, LAYER_TITLES
from app.translation import tr
from metagraph.graph.clip_mark import COLORS, STARS
from metagraph.graph.model import KINDS, LAYERS, ClipEntry, Project
from metagraph.graph.name_search import matches_search


@dataclass(frozen=True)
class Filter:
    """What the library shows. labelled: None for both. kind, layer: None for any; they look at the actions
    that use a clip. color: a label, None for any. stars: at least so many. favourite, noted, broken: only
    those with a heart, with a note, in problems.
    """

    text: str = ""
    labelled: bool | None = None
    layer: str | None = None
    kind: str | None = None
    color: str | None = None
    stars: int = 0
    favourite: bool = False
    noted: bool = False
    broken: bool = False

    def takes(self, facts: ClipFacts, entry: ClipEntry) -> bool:
        project = facts.project
        if self.labelled is not None and is_used(project, entry) != self.labelled:
            return False
        if (self.layer or self.kind) and not any(
            (not self.layer or a.layer == self.layer) and (not self.kind or a.kind == self.kind)
            for a in project.uses.get(entry.id, ())
        ):
            return False
        if self.marked:
            mark = facts.mark(entry)
            if (self.color and mark.color != self.color) or mark.rating < self.stars:
                return False
            if (self.favourite and not mark.favourite) or (self.noted and not mark.note):
                return False
        if self.broken and not facts.problems(entry):
            return False
        return not self.text.strip(" -|") or matches_search(self.text, f"{entry.name} {entry.path}")

    @property
    def marked(self) -> bool:
        """Whether it asks for what is on clips."""
        return bool(self.color or self.stars or self.favourite or self.noted)

    @property
    def placed(self) -> bool:
        """Whether it asks for where clips are in the graph."""
        return self.labelled is not None or bool(self.layer or self.kind)

    def words(self) -> str:
        """Return in a few words what is requested besides the text and whether clips are placed."""
        some = [LAYER_TITLES[self.layer] if self.layer else "", KIND_TITLES[self.kind] if self.kind else ""]
        some += [COLOR_TITLES[self.color or ""], f"★{self.stars}" if self.stars else ""]
        some += ["♥" * self.favourite, tr("With a note") * self.noted, tr("Problems") * self.broken]
        return " ".join(filter(None, some))

    def as_text(self) -> str:
        """Return it as one line of JSON, what is as usual left out."""
        usual = asdict(Filter())
        return json.dumps({k: v for k, v in asdict(self).items() if v != usual[k]})


_ALLOWED = {"layer": LAYERS, "kind": KINDS, "color": COLORS, "stars": range(STARS + 1)}


def filter_from_text(text: str) -> Filter | None:
    """Return a filter from a line of JSON; None if it is none."""
    try:
        data = json.loads(text)
    except ValueError:
        return None
    if not isinstance(data, dict):
        return None
    usual = asdict(Filter())
    out = {}
    for field in fields(Filter):
        value = data.get(field.name, usual[field.name])
        known = _ALLOWED.get(field.name)
        either = field.name in ("labelled", "layer", "kind", "color")
        if not (either or isinstance(value, type(usual[field.name]))):
            return None
        if known is not None and value is not None and value not in known:
            return None
        out[field.name] = value
    return Filter(**out)


def is_used(project: Project, entry: ClipEntry) -> bool:
    """Return whether a clip serves as something."""
    return entry.id in project.uses or entry.id in project.drawn
