"""Learn from labelled clips what similar clips are: from words in names and measures of motion, counted again
for every use.

Words vote as in naive Bayes (each word's counts by label, with one added to each), measures by their nearest
neighbours. The confidence of a guess comes from the labelled clips themselves: each is guessed from all the
others, and the confidence is the share of right guesses among those as definite as this one. It is lower for
a motion unlike any of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.suggest.estimate import Belief

Array = NDArray[Any]

NEIGHBOURS = 5
LEAST = 4  # labelled clips below which there is no guess
TRIALS = 400  # examples that are guessed from the others, to measure how often that is right
CLOSE = 0.1  # standard deviations below which a motion is similar in any case
WORDS_PART = 0.6  # weight of words beside motion, if there are both


@dataclass(frozen=True, eq=False)
class LabelledExample:
    """A labelled clip.

    `words` are those of its name in lower case. `measures` `[d]` describe its motion; NaN is unknown, and
    there may be none. `labels` maps each field to its label.
    """

    words: tuple[str, ...]
    measures: Array
    labels: Mapping[str, str]

    def to_data(self) -> dict[str, Any]:
        """Return it as plain data, to keep it for later projects."""
        measures = [round(float(x), 6) if np.isfinite(x) else None for x in self.measures]
        return {"words": list(self.words), "measures": measures, "labels": dict(self.labels)}


def decode_example(data: Any) -> LabelledExample:
    """Read an example from plain data. Raises ValueError naming what is wrong."""
    if not isinstance(data, Mapping):
        raise ValueError("an example should be an object")
    words, measures, labels = data.get("words"), data.get("measures", []), data.get("labels")
    if not isinstance(words, list) or not all(isinstance(w, str) for w in words):
        raise ValueError("words: should be texts")
    if not isinstance(measures, list) or not all(x is None or _number(x) for x in measures):
        raise ValueError("measures: should be numbers")
    if not isinstance(labels, Mapping) or not all(
        isinstance(k, str) and isinstance(v, str) for k, v in labels.items()
    ):
        raise ValueError("labels: should be texts")
    return LabelledExample(
        tuple(words), np.array([np.nan if x is None else x for x in measures], float), dict(labels)
    )


def _number(x: object) -> bool:
    return isinstance(x, int | float) and not isinstance(x, bool)


class Alike:
    """Classifies all fields that examples are labelled with. For examples whose number of measures differs
    from most, only the words count.
    """

    def __init__(self, examples: Sequence[LabelledExample]) -> None:
        self.examples = tuple(examples)
        lengths = Counter(len(e.measures) for e in examples if len(e.measures))
        self.width = lengths.most_common(1)[0][0] if lengths else 0
        rows = [
            e.measures if len(e.measures) == self.width else np.full(self.width, np.nan)
            for e in self.examples
        ]
        self.measures = np.array(rows, float).reshape(len(rows), self.width)
        known = np.isfinite(self.measures)
        middle = [
            float(np.median(column[there])) if there.any() else 0.0
            for column, there in zip(self.measures.T, known.T, strict=True)
        ]
        spread = [
            float(np.std(column[there])) if there.any() else 0.0
            for column, there in zip(self.measures.T, known.T, strict=True)
        ]
        self.middle, self.spread = np.array(middle), np.maximum(np.array(spread), 1e-9)
        self._scaled = np.where(known, (self.measures - self.middle) / self.spread, 0.0)
        self._moving = known.any(1) if self.width else np.zeros(len(rows), bool)
        words: dict[str, list[int]] = {}
        for n, example in enumerate(self.examples):
            for word in set(example.words):
                words.setdefault(word, []).append(n)
        self._with = words  # word -> indices of the examples that have it, ascending

    @cached_property
    def fields(self) -> tuple[str, ...]:
        """Return the fields that examples are labelled with, in the order of their first use."""
        return tuple(dict.fromkeys(field for e in self.examples for field in e.labels))

    def guess(self, words: Sequence[str], measures: Array) -> dict[str, Belief[str]]:
        """Return a guess for a clip with these words and measures, by field. Fields with too few examples are
        left out.
        """
        out = {}
        said, away = tuple(dict.fromkeys(words)), self._away(self._scale(measures))
        for field in self.fields:
            model = self._model(field)
            if model is None:
                continue
            value, firm, near = model.best(model.scores(said, away, None), said)
            sure = model.confidence(firm) * model.familiar(away)
            out[field] = Belief(
                value,
                sure,
                phrase("like '{words}'", words=near) if near else phrase("like clips with this label"),
            )
        return out

    def _away(self, scaled: Array | None) -> Array | None:
        """Return `[n]` the distance of each example's motion from this one, infinite if it is unknown; None
        if this one is unknown.
        """
        if scaled is None:
            return None
        difference = self._scaled - scaled
        return np.asarray(
            np.where(
                self._moving, np.sqrt(np.einsum("ij,ij->i", difference, difference) / self.width), np.inf
            )
        )

    def _scale(self, measures: Array) -> Array | None:
        if len(measures) != self.width or not self.width or not np.isfinite(measures).any():
            return None
        return np.where(np.isfinite(measures), (measures - self.middle) / self.spread, 0.0)

    @cached_property
    def _models(self) -> dict[str, _Field | None]:
        return {}

    def _model(self, field: str) -> _Field | None:
        if field not in self._models:
            places = [n for n, e in enumerate(self.examples) if field in e.labels]
            model = _Field(self, field, places) if len(places) >= LEAST else None
            self._models[field] = model if model is not None and len(model.values) > 0 else None
        return self._models[field]


class _Field:
    """The model of one field: counts of words by label, and the labelled measures."""

    def __init__(self, alike: Alike, field: str, places: Sequence[int]) -> None:
        self.alike, self.places = alike, list(places)
        self.labels = [alike.examples[n].labels[field] for n in places]
        self.values = list(dict.fromkeys(self.labels))
        self.index = np.array([self.values.index(label) for label in self.labels])
        self.count = np.bincount(self.index, minlength=len(self.values)).astype(float)
        row = np.full(len(alike.examples), -1)
        row[self.places] = np.arange(len(self.places))
        self.rows: dict[str, Array] = {}  # word -> the rows of this field that have it
        self.words: dict[str, Array] = {}  # word -> its count for each value
        for word, places in alike._with.items():
            mine = row[places]
            self.rows[word] = mine[mine >= 0]
            self.words[word] = np.bincount(self.index[self.rows[word]], minlength=len(self.values)).astype(
                float
            )

    def scores(self, words: Sequence[str], away: Array | None, leave: int | None) -> Array:
        """Return the probability of each value. `words` are distinct, `away` is as in `Alike._away`, and the
        row `leave` does not count.
        """
        count = self.count.copy()
        own: set[str] = set()
        if leave is not None:
            count[self.index[leave]] -= 1
            own = set(self.alike.examples[self.places[leave]].words)
        prior = np.log((count + 1) / (count.sum() + len(count)))
        said = prior.copy()
        heard = False
        for word in words:
            seen = self.words.get(word)
            if seen is None:
                continue
            if leave is not None and word in own:
                seen = seen.copy()
                seen[self.index[leave]] -= 1
            if seen.any():
                heard = True
                said += np.log((seen + 0.5) / (count + 1.0))
        by_words = _shares(said)
        by_motion = self._near(away, leave)
        if by_motion is None:
            return by_words
        return by_words**WORDS_PART * by_motion ** (1 - WORDS_PART) if heard else by_motion

    def _near(self, away: Array | None, leave: int | None) -> Array | None:
        if away is None:
            return None
        away = away[self.places]
        if leave is not None:
            away[leave] = np.inf
        few = (
            np.argpartition(away, NEIGHBOURS)[:NEIGHBOURS] if len(away) > NEIGHBOURS else np.arange(len(away))
        )
        nearest = np.sort(few[np.isfinite(away[few])])
        if not len(nearest):
            return None
        votes = np.full(len(self.values), 0.05)
        np.add.at(votes, self.index[nearest], 1 / (0.1 + away[nearest]))
        return np.asarray(votes / votes.sum())

    def best(self, scores: Array, words: Sequence[str]) -> tuple[str, float, str]:
        """Return the most probable value, its share, and the words of the example that supports it most."""
        shares = scores / scores.sum()
        place = int(shares.argmax())
        shared = np.zeros(len(self.places), int)
        for word in words:
            if (rows := self.rows.get(word)) is not None:
                shared[rows] += 1
        shared[self.index != place] = 0
        near = int(shared.argmax())
        named = " ".join(self.alike.examples[self.places[near]].words) if shared[near] else ""
        return self.values[place], float(shares[place]), named

    def familiar(self, away: Array | None) -> float:
        """Return how well the examples cover a motion, 0..1: less, the farther the nearest one is compared
        with distances among them. A hundred labelled stances say nothing about the first gesture.
        """
        if away is None:
            return 1.0
        nearest = float(away[self.places].min())
        return min(1.0, self._usual / nearest) ** 2 if np.isfinite(nearest) and nearest > 0 else 1.0

    @cached_property
    def _usual(self) -> float:
        """Return the distance from an example to its nearest neighbour that nine of ten do not exceed."""
        moving = [n for n in self.places if self.alike._moving[n]]
        nearest = []
        for n in moving[:: max(1, -(-len(moving) // TRIALS))]:
            away = self.alike._away(self.alike._scaled[n])
            assert away is not None
            away[n] = np.inf
            nearest.append(float(away[self.places].min()))
        known = [x for x in nearest if np.isfinite(x)]
        return max(CLOSE, float(np.quantile(known, 0.9))) if known else CLOSE

    @cached_property
    def _trial(self) -> tuple[Array, Array]:
        """Return for examples, all or an even selection, each guessed from all the others: the share of the
        guess `[n]`, and whether it is right `[n]`.
        """
        firm, right = [], []
        for n in range(0, len(self.places), -(-len(self.places) // TRIALS)):
            place = self.places[n]
            away = self.alike._away(self.alike._scaled[place]) if self.alike._moving[place] else None
            shares = self.scores(tuple(dict.fromkeys(self.alike.examples[place].words)), away, n)
            shares = shares / shares.sum()
            firm.append(float(shares.max()))
            right.append(float(int(shares.argmax()) == self.index[n]))
        return np.array(firm), np.array(right)

    def confidence(self, firm: float) -> float:
        """Return how often guesses with about this share were right. One of each outcome is added, so few
        examples give a low confidence.
        """
        firmness, right = self._trial
        order = np.argsort(np.abs(firmness - firm), kind="stable")[: max(8, len(firmness) // 4)]
        return float((right[order].sum() + 1) / (len(order) + 2))


def _shares(logs: Array) -> Array:
    out = np.exp(logs - logs.max())
    return np.asarray(out / out.sum())
