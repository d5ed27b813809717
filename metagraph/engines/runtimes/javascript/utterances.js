/**
 * Break off, pause, resume and finish utterances. An utterance is everything that is said under one id, piece by piece,
 * until it is over. Times are seconds.
 *
 * A paused utterance is moved to a time that never comes (`PAUSED`), each to a slot of its own.
 *
 * Translated from metagraph/playback/life/utterances.py; change that, and translate anew.
 */

import { spelled } from "./graphemes.js";
import { Speech, cut, findLineStart, measureLine } from "./items.js";
import { timedSounds } from "./line_timing.js";
import { Track } from "./track.js";
import { but, maxOf, minOf, range } from "./basics.js";

export const PAUSED = 1000000000; // seconds from which on lies what is paused
export const VOICE = 0.04; // seconds in which a voice can begin; more than lips look ahead
export const EARLIER = 0.03; // seconds by which it can stop sooner, since a mouth takes its time to close
export const FORGOTTEN = 60; // seconds of silence after which nothing more is awaited of what was promised to go on
export const TOGETHER = 0.001; // seconds between two pieces of one utterance, at most

/**
 * Return when a voice can begin: sooner than gestures, which blend. At the very beginning it can begin at once, because
 * nothing has been shown.
 * @param {number} now
 * @param {number} lookahead
 * @returns {number}
 */
export function findSoon(now, lookahead) {
  return now > 0 ? now + Math.min(lookahead, VOICE) : 0;
}

/**
 * Return whether an item with this start is paused.
 * @param {number} start
 * @returns {boolean}
 */
export function isPaused(start) {
  return start >= PAUSED;
}

/**
 * Return whether more can be added to a piece that is not being said: more was announced, or it is paused.
 * @param {Speech} speech
 * @returns {boolean}
 */
export function takesMore(speech) {
  return speech.more || speech.start >= PAUSED;
}

/**
 * Return whether an utterance is not over at `now`: it is being said, will be said, is paused, or expects more.
 * @param {Speech[]} speeches
 * @param {string} ident
 * @param {number} now
 * @returns {boolean}
 */
export function goesOn(speeches, ident, now) {
  const last = [...speeches].reverse().find((s) => s.id === ident) ?? null;
  return last !== null && (last.end > now || last.more);
}

/**
 * Return the ids of the utterances that are not over at `now`; what: of one, "" for all.
 * @param {Track} track
 * @param {string} what
 * @param {number} now
 * @returns {string[]}
 */
export function findUtterances(track, what, now) {
  if (what !== "") {
    return goesOn(track.speeches, what, now) ? [what] : [];
  }
  const last = new Map(track.speeches.map((s) => [s.id, s]));
  const lasting = new Set(track.speeches.filter((s) => (s.end > now || s.more) && last.get(s.id) === s).map((s) => s.id));
  const out = [];
  for (const speech of track.speeches) {
    if (lasting.has(speech.id) && !out.includes(speech.id)) {
      out.push(speech.id);
    }
  }
  return out;
}

/**
 * Return the ids of the utterances of which more was promised, and nothing has come for `FORGOTTEN`.
 * @param {Track} track
 * @param {number} now
 * @returns {string[]}
 */
export function findForgotten(track, now) {
  const silent = track.speeches.filter((s) => s.more && s.end < now - FORGOTTEN);
  return silent.filter((s) => track.lastSpeech(s.id) === s).map((s) => s.id);
}

/**
 * Return when the voice of an utterance stops: at the end of the current sound, at `soon` at the latest; at once if its
 * sounds are unknown or it is in a pause; at its start if it has not begun. now: when gestures can stop.
 * @param {Alphabet} alphabet
 * @param {Track} track
 * @param {string} ident
 * @param {number} soon
 * @param {number} now
 * @returns {number}
 */
export function findStop(alphabet, track, ident, soon, now) {
  const first = now > soon ? soon - EARLIER : soon;
  const running = track.speeches.find((s) => s.id === ident && s.start < first && first < s.end) ?? null;
  if (running === null) {
    const coming = track.speeches.filter((s) => s.id === ident && s.start >= first).map((s) => s.start);
    return coming.length > 0 ? minOf([...coming, PAUSED]) : soon;
  }
  if (running.line !== null && running.timing === null) {
    return first;
  }
  const begin = findLineStart(running);
  const said = running.timing === null
    ? spelled(alphabet, running.text, measureLine(running))
    : timedSounds(alphabet, running.timing);
  const ends = said.pieces.filter((p) => begin + p.start < first && first < begin + p.end).map((p) => begin + p.end);
  return ends.length > 0 ? minOf([soon, running.end, ...ends]) : first;
}

/**
 * Return a free slot among the times that never come.
 * @param {Track} track
 * @returns {number}
 */
export function findSlot(track) {
  return maxOf([PAUSED, ...track.speeches.filter((s) => s.start >= PAUSED).map((s) => s.end + 1)]);
}

/**
 * Return the track with an utterance ended at `stop`: its later pieces are not said.
 * @param {Track} track
 * @param {string} ident
 * @param {number} stop
 * @returns {Track}
 */
export function breakOff(track, ident, stop) {
  const last = track.lastSpeech(ident);
  const speeches = [];
  for (const speech of track.speeches) {
    if (speech.id !== ident || speech.end <= stop) {
      speeches.push(speech);
    } else if (speech.start < stop) {
      speeches.push(cut(speech, stop));
    }
  }
  return last === null ? track : _closed(track, speeches, last, stop, true);
}

/**
 * Return the track with an utterance that is over once all its known pieces are said.
 * @param {Track} track
 * @param {string} ident
 * @param {number} soon
 * @returns {Track}
 */
export function finishSpeech(track, ident, soon) {
  const last = track.lastSpeech(ident);
  return last === null ? track : _closed(track, [...track.speeches], last, soon, false);
}

/**
 * Return the track with these speeches, in which an utterance expects no more pieces. of: its last piece before. cuts:
 * whether it was broken off.
 * @param {Track} track
 * @param {Speech[]} speeches
 * @param {Speech} of
 * @param {number} now
 * @param {boolean} cuts
 * @returns {Track}
 */
function _closed(track, speeches, of, now, cuts) {
  const out = [...speeches];
  let end = now;
  for (const n of [...range(out.length)].reverse()) {
    const last = out[n];
    if (last.id !== of.id || last.asked !== of.asked) {
      continue;
    }
    const held = cuts && last.length !== null; // it was paused
    const silent = last.end < now && (last.more || held);
    const length = (cuts && last.more) ? measureLine(last) : last.length;
    out[n] = but(last, { more: false, over: silent ? now : last.over, length: length });
    end = Math.max(last.end, now);
    break;
  }
  const moods = track.moods.map((m) => (m.id === of.id && m.end === PAUSED) ? _until(m, end) : m);
  return new Track(track.looks, [...out], track.modes, track.places, track.blinks, track.stays, [...moods]);
}

/**
 * @param {MoodFrom} mood
 * @param {number} end
 * @returns {MoodFrom}
 */
function _until(mood, end) {
  return but(mood, { end: end });
}

/**
 * Return the track with an utterance paused from `stop` on, in `slot` (`find_slot`). made: ids of requests that belong to
 * it; they wait, too, if they have not begun.
 * @param {Track} track
 * @param {string} ident
 * @param {Set<string>} made
 * @param {number} stop
 * @param {number} slot
 * @returns {Track}
 */
export function pause(track, ident, made, stop, slot) {
  const by = slot - stop;
  const kept = [];
  const held = [];
  for (const speech of track.speeches) {
    if (speech.id !== ident || speech.start >= PAUSED || speech.end <= stop) {
      kept.push(speech);
    } else if (speech.start < stop) {
      kept.push(but(cut(speech, stop), { more: false }));
      const skip = stop - findLineStart(speech);
      held.push(but(speech, { start: slot, end: speech.end + by, skip: skip }));
    } else {
      held.push(but(speech, { start: speech.start + by, end: speech.end + by }));
    }
  }
  const last = track.lastSpeech(ident);
  if (held.length === 0 && last !== null && last.more && last.start < PAUSED) {
    held.push(new Speech(ident, slot, slot, null, "", last.priority, null, null, 0, true, null, last.asked));
  }
  if (held.length === 0) {
    return track;
  }
  const moods = track.moods.map((m) => (m.id === ident && m.start < stop && m.end > stop) ? _until(m, PAUSED) : m);
  const left = new Track(track.looks, [...kept], track.modes, track.places, track.blinks, track.stays, [...moods]);
  return _moved(left, held, made, stop, PAUSED, by);
}

/**
 * Return the track with an utterance that continues at `soon`. made: as for `pause`.
 * @param {Track} track
 * @param {string} ident
 * @param {Set<string>} made
 * @param {number} soon
 * @returns {Track}
 */
export function resume(track, ident, made, soon) {
  const held = track.speeches.filter((s) => s.id === ident && s.start >= PAUSED);
  if (held.length === 0) {
    return track;
  }
  const by = soon - held[0].start;
  const kept = track.speeches.filter((s) => s.id !== ident || s.start < PAUSED);
  const on = held.filter((s) => s.end > s.start).map((s) => but(s, { start: s.start + by, end: s.end + by }));
  const end = held[held.length - 1].more ? PAUSED : held[held.length - 1].end + by;
  const moods = track.moods.map((m) => (m.id === ident && m.end === PAUSED) ? _until(m, end) : m);
  let left = new Track(track.looks, [...kept], track.modes, track.places, track.blinks, track.stays, [...moods]);
  if (on.length === 0) { // it had fallen silent when it was paused
    left = held[held.length - 1].more ? left : finishSpeech(left, ident, soon);
  }
  return _moved(left, on, made, PAUSED, Infinity, by);
}

/**
 * Return the track with more speeches, and with the looks and moods of `made` that begin from `low` to before `high` moved
 * by a number of seconds.
 * @param {Track} track
 * @param {Speech[]} speeches
 * @param {Set<string>} made
 * @param {number} low
 * @param {number} high
 * @param {number} by
 * @returns {Track}
 */
function _moved(track, speeches, made, low, high, by) {
  const looks = [];
  for (const x of track.looks) {
    if (made.has(x.id) && low <= x.start && x.start < high) {
      looks.push(but(x, { start: x.start + by, end: x.end + by }));
    }
  }
  const moods = [];
  for (const m of track.moods) {
    if (made.has(m.id) && low <= m.start && m.start < high) {
      moods.push(but(m, { start: m.start + by, end: m.end + by }));
    }
  }
  const gone = new Set(looks.map((x) => x.id));
  const over = new Set(moods.map((m) => m.id));
  const left = new Track(
    track.looks.filter((x) => !gone.has(x.id) || x.start < low || x.start >= high),
    track.speeches,
    track.modes,
    track.places,
    track.blinks,
    track.stays,
    track.moods.filter((m) => !over.has(m.id) || m.start < low || m.start >= high),
  );
  return left.joined(new Track([...looks], [...speeches], [], [], [], [], [...moods]));
}

/**
 * Return why an utterance is over at the end of a piece: "finished", "interrupted" or "replaced"; "" if it is not over
 * there.
 * @param {Speech[]} speeches
 * @param {Speech} speech
 * @returns {string}
 */
export function explainEnd(speeches, speech) {
  const coming = speeches.find((s) => s.id === speech.id && s.start > speech.start) ?? null;
  if (coming !== null && coming.asked === speech.asked) {
    return "";
  }
  if (speech.more) {
    return coming === null ? "" : "replaced";
  }
  if (speech.length === null) {
    return "finished";
  }
  return (coming === null || coming.start > speech.end + TOGETHER) ? "interrupted" : "replaced";
}
