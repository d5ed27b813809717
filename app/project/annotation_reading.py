"""Read an annotation into a project: which tiers and labels mean what, and what is made of it. Used by the
window and the command line.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from app.look.plural import list_in_words
from app.translation import tr
from metagraph.graph import edits
from metagraph.graph.editing import performances as performance_edits
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.playback.learning.annotation import (
    SPEECH,
    AnnotatedAgain,
    Annotation,
    Label,
    find_annotated_again,
    find_other_people,
    guess_roles,
    list_labels,
    read_other_annotator,
    split_tier_names,
)
from metagraph.playback.learning.learn import Act, as_performance, find_act_sequences, learn_model
from metagraph.playback.planning.markov import DEFAULTS
from metagraph.playback.planning.mode_shares import with_modes
from metagraph.playback.planning.running_plan import list_kept_asks, plan_performance

FEW = 30  # acts below which a model is a rough one


@dataclass(frozen=True)
class AnnotationReading:
    """How an annotation is read.

    `roles` has the role of each tier. `said` has meanings by label, or by `layer: label`; they come before
    remembered and guessed ones.
    """

    annotation: Annotation
    roles: Mapping[str, str]
    said: Mapping[str, str] = field(default_factory=dict)
    memory: tuple[Mapping[str, str], ...] = ()

    @cached_property
    def labels(self) -> tuple[Label, ...]:
        return list_labels(self.annotation, self.roles, self.said, *self.memory)

    @cached_property
    def observed(self) -> dict[Layer, tuple[Act, ...]]:
        """Return for each layer what it was seen to do. Layers without a tier are left out."""
        found = find_act_sequences(self.annotation, self.roles, self.labels)
        return {layer: found[layer] for layer in LAYERS if layer in found}

    @cached_property
    def spoken(self) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
        """Return when the observed person speaks, and when the partner does, in seconds; empty if no tier
        says it.
        """
        own, partner = (
            [
                (i.start, i.end)
                for tier in self.annotation.tiers
                if self.roles.get(tier.name) == role
                for i in tier.intervals
                if i.text.strip()
            ]
            for role in SPEECH
        )
        return own, partner

    @cached_property
    def again(self) -> list[AnnotatedAgain]:
        """Return the tiers of other annotators that are left out for those that are read."""
        return find_annotated_again(self.annotation, self.roles)

    @property
    def annotators(self) -> list[str]:
        """Return who annotated what is read, then who annotated the same again; "" is someone without a name.
        Empty if nobody did so again.
        """
        if not self.again:
            return []
        names = split_tier_names(self.annotation)
        read = [names[one.read].annotator for one in self.again]
        return list(dict.fromkeys((*read, *(one.annotator for one in self.again))))

    def with_annotator(self, name: str) -> AnnotationReading:
        """Read the tiers of an annotator instead of others'. Raises ValueError if there is none to read."""
        return replace(self, roles=read_other_annotator(self.annotation, self.roles, name))

    def with_role(self, tier: str, role: str) -> AnnotationReading:
        return replace(self, roles={**self.roles, tier: role})

    def with_meaning(self, label: Label, meaning: str) -> AnnotationReading:
        return replace(self, said={**self.said, label.key: meaning})


def begin_reading(
    annotation: Annotation, *tiers: Mapping[str, str], labels: tuple[Mapping[str, str], ...] = ()
) -> AnnotationReading:
    """Return a reading as remembered, with the earlier memories first, and otherwise as guessed."""
    return AnnotationReading(annotation, guess_roles(annotation, *tiers), {}, labels)


@dataclass(frozen=True)
class ReadingResult:
    """The result of a reading. `learned` has the layers that have a model of their own now, `performance` is
    the id of the kept performance.
    """

    project: Project
    learned: tuple[Layer, ...] = ()
    performance: str | None = None


def apply_reading(
    project: Project,
    reading: AnnotationReading,
    learned: Collection[Layer],
    tagged: bool,
    name: str | None,
    smoothing: float = 0.0,
) -> ReadingResult:
    """Apply a reading to a project: remember how it was read, learn models, keep it as a performance.

    `learned` has the layers to learn, if they were seen to do something. With `tagged`, positive and negative
    become states of their own, otherwise shares of gestures. `name` is the performance's, None to keep none.
    """
    project = remember_reading(project, reading)
    done = []
    for layer in LAYERS:
        if layer in learned and reading.observed.get(layer):
            acts = reading.observed[layer]
            model = with_modes(
                learn_model(layer, [acts], tagged, smoothing), acts, *reading.spoken, reading.annotation.end
            )
            model = model if model.modes else replace(model, modes=DEFAULTS[layer].modes)
            project = edits.set_markov(project, model)
            done.append(layer)
    kept = None
    if name is not None and any(reading.observed.values()):
        project, kept = performance_edits.add_performance(
            project, as_performance(name, reading.observed, reading.annotation.end)
        )
    return ReadingResult(project, tuple(done), kept)


def count_replayed(project: Project, ident: str) -> dict[Layer, dict[str, int]]:
    """Return for each layer how many acts a kept performance asks for, how many of them play, and how many of
    those with another limb than was seen.
    """
    kept = project.performances[ident]
    plan = plan_performance(
        project, list_kept_asks(kept), kept.length, kept.seed, dict(kept.stances), kept.idle
    )
    out: dict[Layer, dict[str, int]] = {}
    for layer in LAYERS:
        asked = {ask.id for ask in kept.asks if getattr(ask, "layer", None) == layer}
        played = {cue.meta.partition("+")[0] for cue in plan.layers[layer].cues}
        other = {r.request for r in plan.reports if r.layer == layer and r.outcome == "other-limb"}
        if asked:
            out[layer] = {
                "asked": len(asked),
                "played": len(asked & played),
                "other_limb": len(asked & played & other),
            }
    return out


def remember_reading(project: Project, reading: AnnotationReading) -> Project:
    """Note in a project what tiers are read as, and labels whose meaning is not what would be guessed."""
    guessed = {label.key: label.meaning for label in list_labels(reading.annotation, reading.roles)}
    noted = {key: meaning for key, meaning in project.labels.items() if key not in guessed}
    noted |= {label.key: label.meaning for label in reading.labels if label.meaning != guessed[label.key]}
    return replace(project, tiers={**project.tiers, **reading.roles}, labels=noted)


def describe_doubts(reading: AnnotationReading) -> list[str]:
    """Return in words what is doubtful about a reading."""
    out = list(reading.annotation.notes)
    if reading.again:
        first = reading.annotators[0]
        out.append(
            tr(
                "Several annotators: {read} is read. Not read: {tiers}. You can choose another annotator, or "
                "measure their agreement with 'metagraph study agreement'.",
                read=first or tr("the one without a name"),
                tiers=list_in_words([one.tier for one in reading.again]),
            )
        )
    who, unread = find_other_people(reading.annotation, reading.roles)
    if unread:
        out.append(
            tr(
                "Several people: {read} is read. Not read: {tiers}. Give their tiers roles to read them "
                "instead.",
                read=who,
                tiers=list_in_words(unread),
            )
        )
    if not reading.observed:
        out.append(tr("No tier is read as arms, head or body yet. Choose what each tier stands for."))
    for layer, acts in reading.observed.items():
        if not acts:
            out.append(
                tr(
                    "The {layer} tiers contain no usable labels. Check what their labels mean.",
                    layer=tr(layer),
                )
            )
        elif len(acts) < FEW:
            out.append(
                tr(
                    "Only {acts} actions of the {layer}, so its model will be rough.",
                    acts=len(acts),
                    layer=tr(layer),
                )
            )
    return out
