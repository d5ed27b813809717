"""What people were seen to do: tiers of intervals, and what tiers and labels are taken for.

A tier is read as one of `ROLES` (Borer et al., section 7.2: a stance and an action layer for the head, one
layer for each arm, one for the body), a label as one of `MEANINGS`, with tags behind it: "gesture positive".
Both are guessed from words and can be said otherwise; what was said is remembered as plain texts.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from metagraph.common.wording import Phrase, phrase
from metagraph.graph.model import Layer, Limb

_SOUNDS = (".wav", ".flac", ".ogg", ".mp3", ".m4a", ".aac", ".aif", ".aiff")
IGNORE = "ignore"
ROLES: Mapping[str, tuple[Layer, Limb]] = {
    "left arm": ("arms", "left"), "right arm": ("arms", "right"), "arms": ("arms", "both"),
    "head action": ("head", "both"), "head stance": ("head", "both"), "body": ("body", "both"),
}  # fmt: skip
SPEECH = (
    "speech",
    "partner's speech",
)  # roles of tiers that tell who talks when: their labels are what is said
STANCES = ("head stance", "body")  # roles whose intervals are changes of stance, or the stances themselves
PHASES = ("preparation", "stroke", "hold", "retraction")  # of one gesture
MEANINGS = ("gesture", "fidget", "transition", "stance", *PHASES, IGNORE)
COVERED = (
    0.6  # of its span that a tier covers when its intervals are the stances, not the changes between them
)


@dataclass(frozen=True, slots=True)
class AnnotationInterval:
    """start, end: seconds, start < end."""

    start: float
    end: float
    text: str


@dataclass(frozen=True)
class AnnotationTier:
    """intervals: ascending by start. participant: whose tier it is, "" if the file does not say. parent: the
    tier it refers to. annotator: who wrote it, "" if the file does not say.
    """

    name: str
    intervals: tuple[AnnotationInterval, ...] = ()
    participant: str = ""
    parent: str = ""
    annotator: str = ""

    @cached_property
    def labels(self) -> Mapping[str, int]:
        """Label, as `label_of` spells it -> how often it occurs, in the order of their first occurrence."""
        return Counter(label_of(i.text) for i in self.intervals)

    @property
    def whose(self) -> str:
        """Return the participant, or what stands behind an @ in the name, as is the custom."""
        return self.participant or self.name.partition("@")[2].strip()


@dataclass(frozen=True)
class Annotation:
    """media: the sound and video files it is about, as named in it. origins: of each medium, which of its
    seconds is 0 here; empty where all begin at 0. vocabularies: name -> labels. notes: what was left out.
    """

    tiers: tuple[AnnotationTier, ...] = ()
    media: tuple[str, ...] = ()
    vocabularies: Mapping[str, tuple[str, ...]] | None = None
    notes: tuple[str, ...] = ()
    origins: tuple[float, ...] = ()

    def offset_of(self, names: Sequence[str]) -> tuple[float, tuple[Phrase, ...]]:
        """Return the seconds to add to a time here for the time in one of several files, and notes about
        that.

        The medium that is called as a file counts; else the one that all media share, else that of the first
        sound among them.
        """
        if not any(self.origins):
            return 0.0, ()
        called = {_stem(name) for name in names}
        own = [n for n, medium in enumerate(self.media) if _stem(medium) in called]
        sounds = [n for n, m in enumerate(self.media) if m.casefold().endswith(_SOUNDS)]
        chosen = (own or sounds or [0])[0]
        late, name = self.origins[chosen], self.media[chosen].replace("\\", "/").rsplit("/", 1)[-1]
        told = []
        if len(set(self.origins)) > 1 and not own and names:
            told.append(
                phrase(
                    "its media begin at different times, and none has the name of the sound: read as times "
                    "in '{name}'",
                    name=name,
                )
            )
        if late:
            told.append(
                phrase(
                    "its times count from {late:.3f} s of '{name}' (its time origin), so they were read that "
                    "much later",
                    late=late,
                    name=name,
                )
            )
        return late, tuple(told)

    @property
    def end(self) -> float:
        """When the last interval ends, seconds; 0 without any."""
        return max((i.end for tier in self.tiers for i in tier.intervals), default=0.0)


def _stem(name: str) -> str:
    """Return a file's name without its folder and ending."""
    return name.replace("\\", "/").rsplit("/", 1)[-1].rpartition(".")[0].casefold() or name.casefold()


def label_of(text: str) -> str:
    """Return how a label is spelled in tables: blanks as one, capitals as small letters."""
    return " ".join(text.split()).casefold()


def _words(text: str) -> list[str]:
    """Return the words of a name in small letters: "LeftHand_phase-2" -> left, hand, phase, 2."""
    spaced = re.sub(r"(?<=[a-zäöüéèß])(?=[A-ZÄÖÜ])|(?<=\D)(?=\d)|(?<=\d)(?=\D)", " ", text)
    return [w for w in re.split(r"[\W_]+", spaced.casefold()) if w]


def _set(text: str) -> frozenset[str]:
    return frozenset(text.split())


# --- tiers

# English, German, French, Spanish and Italian, as tiers are named in published corpora of gesture.
_LEFT = _set("left l lh la links linke linker linkehand gauche izquierda izq izquierdo sinistra sx")
_RIGHT = _set("right r rh ra rechts rechte rechter rechtehand droite droit derecha derecho destra dx")
_ARMS = _set("""
    hand hands arm arms gesture gestures gest geste gesten gesto gestos gesti phase phases manual bimanual bh hände haende arme main
    mains bras mano manos mani brazo braccio
""")
_HEAD = _set("head kopf tête tete cabeza testa nod nods nodding headmovement headmovements hm")
_STANCE = _set("stance stances pose position posture haltung kopfhaltung tilt orientation lean direction")
_BODY = _set("""
    body torso trunk leg legs feet hips posture weight körper koerper rumpf beine haltung corps jambes cuerpo piernas corpo gambe
    körperhaltung oberkörper
""")
_ELSE = _set("""
    text word words speech utterance utterances transcription transcript translation gloss glosses pos comment comments note notes
    gaze eye eyes mouth face facial brow brows meaning handedness handshape orthography marker language tokens lemma syntax blick
    shape
""")
_SPOKEN = _set("speech utterance utterances")
_SIDES = _set("lh rh linkehand rechtehand left right links rechts")  # enough without a word for hand


# Who annotated, at the end of a tier's name: "LH rater 2", "gesture (coder B)", "gesture_annotatorAK".
_ANNOTATOR = re.compile(
    r"[\s_.(\[-]+(?:annotator|annot|rater|coder|codeur|kodierer|transcriber)[\s_-]*(\w{1,12})[)\]]?\s*$", re.I
)
# The same in short, which counts only where there is another with the same beginning: "LH_R1" and "LH_R2".
_SHORT = re.compile(r"[\s_.(\[-]+([RAC][\s_-]?\d)[)\]]?\s*$", re.I)


@dataclass(frozen=True)
class TierName:
    """stem: a tier's name without who annotated it. annotator: who did, "" if nothing says it."""

    stem: str
    annotator: str


def split_tier_names(annotation: Annotation) -> dict[str, TierName]:
    """Return for each tier, by its name, what it is called and who annotated it: as its file says, else as
    the end of its name does.
    """
    short = {t.name: _SHORT.search(t.name) for t in annotation.tiers}
    stems = Counter(t.name[: m.start()].casefold() for t in annotation.tiers if (m := short[t.name]))
    out = {}
    for tier in annotation.tiers:
        found = _ANNOTATOR.search(tier.name)
        brief = short[tier.name]
        if found is None and brief is not None and stems[tier.name[: brief.start()].casefold()] > 1:
            found = brief
        stem = tier.name[: found.start()].strip() if found else ""
        out[tier.name] = TierName(
            stem or tier.name, tier.annotator or (found[1].strip() if found and stem else "")
        )
    return out


def guess_role(tier: AnnotationTier, stem: str = "") -> str:
    """Return one of `ROLES` or `IGNORE`, from the tier's name or, where it says nothing, from its labels.
    stem: its name without who annotated it, if that is part of it.
    """
    words = set(_words((stem or tier.name).partition("@")[0]))
    if words & _ELSE:
        return IGNORE
    left, right, arms = bool(words & _LEFT), bool(words & _RIGHT), bool(words & _ARMS)
    if words & _HEAD:
        return "head stance" if words & _STANCE else "head action"
    if words & _BODY and not arms:
        return "body"
    if (arms or words & _SIDES) and left != right:
        return "left arm" if left else "right arm"
    if arms:
        return "arms"
    known = Counter[str]()
    for label, count in tier.labels.items():
        meaning = _known(label)
        if meaning != IGNORE:
            head = set(_words(label)) & {"nod", "nods", "nodding", "shake", "shaking"}
            known[IGNORE if meaning is None else "head action" if head else "arms"] += count
    role, count = max(known.items(), key=lambda x: x[1], default=(IGNORE, 0))
    return role if count > known.total() / 2 else IGNORE


def guess_roles(annotation: Annotation, *remembered: Mapping[str, str]) -> dict[str, str]:
    """Return tier -> role for every tier: as remembered (the earlier mapping counts), else as guessed.

    Of the people in an annotation only the one with most intervals is taken; of several annotators of what
    they did, the one with most intervals too; of several tiers that would be the same to both, the one whose
    labels are best known.
    """
    names = split_tier_names(annotation)
    said = {
        t.name: next((m[t.name] for m in remembered if m.get(t.name) in (*ROLES, *SPEECH, IGNORE)), None)
        for t in annotation.tiers
    }
    guessed = {t.name: guess_role(t, names[t.name].stem) for t in annotation.tiers}
    people = Counter[str]()
    for tier in annotation.tiers:
        if (said[tier.name] or guessed[tier.name]) != IGNORE:
            people[tier.whose] += len(tier.intervals) or 0
    who = people.most_common(1)[0][0] if people else ""
    work = Counter[str]()
    for tier in annotation.tiers:
        if tier.whose == who and guessed[tier.name] != IGNORE:
            work[names[tier.name].annotator] += len(tier.intervals)
    main = work.most_common(1)[0][0] if work else ""

    def rank(tier: AnnotationTier) -> tuple[bool, bool, float]:
        filled, clear = _clarity(tier)
        return filled, names[tier.name].annotator == main, clear

    best: dict[str, AnnotationTier] = {}
    for tier in annotation.tiers:
        spoken = set(_words(tier.name.partition("@")[0])) & _SPOKEN
        if people and said[tier.name] is None and spoken and tier.intervals:
            guessed[tier.name] = SPEECH[tier.whose != who]
            best.setdefault(guessed[tier.name], tier)
        elif said[tier.name] is None and tier.whose == who and guessed[tier.name] != IGNORE:
            other = best.get(guessed[tier.name])
            if other is None or rank(tier) > rank(other):
                best[guessed[tier.name]] = tier
    out = {}
    for tier in annotation.tiers:
        guess = guessed[tier.name]
        out[tier.name] = said[tier.name] or (
            guess if best.get(guess) is tier and guess not in said.values() else IGNORE
        )
    return out


@dataclass(frozen=True)
class AnnotatedAgain:
    """A tier that is not read since another one, by another annotator, is read for the same. role: of both.
    read: the other tier's name.
    """

    tier: str
    annotator: str
    role: str
    read: str


def find_annotated_again(annotation: Annotation, roles: Mapping[str, str]) -> list[AnnotatedAgain]:
    """Return the tiers that are ignored because another annotator's tier is read for the same person and
    role; of several by one annotator, the one whose labels are best known.
    """
    names = split_tier_names(annotation)
    used = [t for t in annotation.tiers if roles[t.name] != IGNORE]
    found: dict[tuple[str, str], tuple[AnnotationTier, AnnotationTier]] = {}
    for tier in annotation.tiers:
        role, annotator = guess_role(tier, names[tier.name].stem), names[tier.name].annotator
        if roles[tier.name] != IGNORE or not tier.intervals:
            continue
        for other in used:  # one that does not say whose it is may be anyone's
            same = other.whose == tier.whose or not (other.whose and tier.whose)
            if roles[other.name] == role and same and names[other.name].annotator != annotator:
                key = (other.name, annotator)
                if key not in found or _clarity(tier) > _clarity(found[key][0]):
                    found[key] = tier, other
    return [
        AnnotatedAgain(tier.name, annotator, roles[other.name], other.name)
        for (_, annotator), (tier, other) in found.items()
    ]


def find_other_people(annotation: Annotation, roles: Mapping[str, str]) -> tuple[str, list[str]]:
    """Return the person whose tiers are read, "" if the file does not say, and the tiers of others that tell
    what these did and are not read.
    """
    names = split_tier_names(annotation)
    read = {t.whose for t in annotation.tiers if roles[t.name] in ROLES}
    if len(read) != 1 or "" in read:
        return "", []
    unread = [
        t.name
        for t in annotation.tiers
        if t.whose and t.whose not in read and t.intervals and roles[t.name] == IGNORE
        and guess_role(t, names[t.name].stem) in ROLES
    ]  # fmt: skip
    return next(iter(read)), unread


def read_other_annotator(annotation: Annotation, roles: Mapping[str, str], annotator: str) -> dict[str, str]:
    """Return the roles with one annotator's tiers read instead of those of others for the same. Raises
    ValueError if nobody of that name annotated anything that is read otherwise.
    """
    again = [x for x in find_annotated_again(annotation, roles) if x.annotator == annotator]
    if not again:
        raise ValueError(f"no tier of annotator '{annotator}' is left out for another's")
    out = dict(roles)
    for one in again:
        out[one.read], out[one.tier] = IGNORE, one.role
    return out


def _clarity(tier: AnnotationTier) -> tuple[bool, float]:
    """Return how well a tier's labels say what was done: gestures as a whole come before their phases."""
    total = sum(tier.labels.values())
    known = [(_known(label), count) for label, count in tier.labels.items()]
    return total > 0, round(
        sum(n * (1.0 if k not in PHASES else 0.9) for k, n in known if k) / max(1, total), 6
    )


# --- labels

_NOTHING = frozenset(
    """
    |no movement|rest|resting|rest position|rp|home|home position|still|none|no|no gesture|n a|na|xxx|x|idle|nothing|neutral|stance
    |ruhe|ruheposition|keine|repos|aucun|reposo|ninguno
""".replace("\n", "")
    .replace("    ", "")
    .split("|")
)
# The first that is found decides: a "pre-stroke hold" is a hold, a "stance-transition" a transition.
_SIGNS: tuple[tuple[str, str], ...] = (
    ("transition", r"trans|chang(e|ing)|shift|switch|wechsel|verlagerung|cambio"),
    (
        "fidget",
        r"fidget|scratch|adapt[oe]r|self "
        r"?touch|touch(es|ing)?|groom|rub(s|bing)?|fiddl|tics?|ticks?|kratz|nestel|autoadap|irregular|aborted",
    ),
    ("hold", r"hold|holding|psh|halten|houd|tenue"),
    ("preparation", r"prep|vorb|anlauf"),
    ("retraction", r"retr|recover|relax|rück|terug|ritraz"),
    ("stroke", r"stroke|strk"),
    (
        "gesture",
        r"gest|beats?|batons?|iconic|ikonisch|deictic|deiktisch|metaphori|emblem|pragmatic|point|wav(e|es|ing)|shrug|nod|nick"
        r"|shak(e|es|ing)|schüttel|clap|thumb|illustrator|raise|count|phasic|repetitive|emphasis|pantomime"
        r"|(form|spatial relation|motion quality) presentation|egocentric",
    ),
)
_POSITIVE = _set("positive pos yes ja oui sí agree agreement affirm affirmative affirmation nod nods nodding")
_NEGATIVE = _set("negative neg no nein non disagree disagreement negation shake shakes shaking headshake")


def _known(label: str) -> str | None:
    """Return what a label surely means, None if its words say nothing."""
    parts = _words(label)
    words = " ".join(parts)
    if words in _NOTHING:
        return IGNORE
    if len(parts) > 6:  # speech
        return None
    return next((meaning for meaning, sign in _SIGNS if re.search(rf"(^| )({sign})", words)), None)


def guess_meaning(label: str, role: str, stance: bool = False) -> str:
    """Return one of `MEANINGS`, tags behind it, for a label on a tier of a role.

    stance: on a tier of stances, labels that name no change are the stances themselves. On tiers of arms and
    head actions any other short label is a gesture; a long one is speech.
    """
    words = _words(label)
    known = _known(label)
    if role == "head action" and known == IGNORE and words == ["no"]:
        known = "gesture"
    if known is None:
        if role in STANCES:
            known = "stance" if stance else "transition"
        elif role == "head action" and set(words) & {"tilt", "turn", "lean"}:
            known = "transition"
        else:
            known = "gesture" if len(words) <= 4 and len(label) <= 40 else IGNORE
    elif role in STANCES and known not in ("transition", "fidget", IGNORE):
        known = "stance" if stance else "transition"
    elif role in STANCES and stance and label_of(label) in ("neutral", "rest", "home"):
        known = "stance"
    if known != "gesture":
        return known
    tag = "positive" if set(words) & _POSITIVE else "negative" if set(words) & _NEGATIVE else ""
    return f"gesture {tag}".rstrip()


@dataclass(frozen=True, slots=True)
class Label:
    """A label on a layer. count: how often it occurs there. meaning: what it is taken for."""

    layer: Layer
    text: str
    count: int
    meaning: str

    @property
    def key(self) -> str:
        """What it is remembered by."""
        return f"{self.layer}: {self.text}"


def list_labels(
    annotation: Annotation, roles: Mapping[str, str], *remembered: Mapping[str, str]
) -> tuple[Label, ...]:
    """Return the labels of every layer that is read, the most frequent first, each as remembered (by `layer:
    text` or text) or guessed.
    """
    found: dict[tuple[Layer, str], int] = {}
    guess: dict[tuple[Layer, str], str] = {}
    for tier in annotation.tiers:
        role = roles.get(tier.name, IGNORE)
        if role not in ROLES:
            continue
        layer, stance = ROLES[role][0], role in STANCES and is_covering(tier)
        for text, count in tier.labels.items():
            found[layer, text] = found.get((layer, text), 0) + count
            guess.setdefault((layer, text), guess_meaning(text, role, stance))
    out = []
    for (layer, text), count in sorted(
        found.items(), key=lambda x: (tuple(LAYER_ORDER).index(x[0][0]), -x[1])
    ):
        said = next(
            (m[k] for m in remembered for k in (f"{layer}: {text}", text) if is_meaning(m.get(k, ""))), None
        )
        out.append(Label(layer, text, count, said or guess[layer, text]))
    return tuple(out)


LAYER_ORDER: Sequence[Layer] = ("arms", "head", "body")


def is_covering(tier: AnnotationTier) -> bool:
    """Return whether a tier's intervals fill most of its span and say different things: they are stances, not
    changes.
    """
    if len(tier.labels) < 2:
        return False
    span = tier.intervals[-1].end - tier.intervals[0].start
    return sum(i.end - i.start for i in tier.intervals) > COVERED * span


def is_meaning(text: str) -> bool:
    """Return whether a text says what a label means: one of `MEANINGS`, then tags."""
    return text.split(" ")[0] in MEANINGS


def split_meaning(meaning: str) -> tuple[str, tuple[str, ...]]:
    """Return the kind (or phase) and the tags of a meaning."""
    first, *tags = meaning.split()
    return first, tuple(tags)


def label_notes(labels: Iterable[Label]) -> dict[str, str]:
    """Return what to remember of labels."""
    return {label.key: label.meaning for label in labels}
