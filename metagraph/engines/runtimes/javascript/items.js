/**
 * Requests that last: where to look, what to say, which mode to be in, which stance to stay in. Values; times are seconds.
 *
 * Translated from metagraph/playback/life/items.py; change that, and translate anew.
 */

import { 
  alikeTimings,
  extended,
  measureText,
  paceText,
  placeTold,
  shifted,
  tellsOn,
  timedSeconds,
  toldText,
} from "./line_timing.js";
import { isSameSpot } from "./spots.js";
import { but, zip } from "./basics.js";

/**
 * Look at a point or a named point from `start` until `end`, or until the next look. strict: without looking away.
 *
 * id: string; start: number; end: number; to: Spot; amount: number; strict: boolean; priority: number.
 */
export class LookAt {
  constructor(id, start, end, to, amount = 1, strict = false, priority = 1) {
    this.id = id;
    this.start = start;
    this.end = end;
    this.to = to;
    this.amount = amount;
    this.strict = strict;
    this.priority = priority;
  }
}

/**
 * Something said. line: id of the project's line, None for `text` alone. priority: a higher one interrupts a lower one.
 * length: seconds that all of it would have taken, if it was cut short. timing: the times of its words and mouth shapes, if
 * known. skip: seconds of it that were said before a pause. more: whether more of it may come, so that it is not over when
 * it falls silent. over: when it was finished, if it had fallen silent before. asked: when the first piece of its utterance
 * was asked for, which all its pieces share and no other utterance of its id has.
 *
 * id: string; start: number; end: number; line: ?string; text: string; priority: number; length: ?number; timing:
 * ?LineTiming; skip: number; more: boolean; over: ?number; asked: number.
 */
export class Speech {
  constructor(
    id,
    start,
    end,
    line = null,
    text = "",
    priority = 1,
    length = null,
    timing = null,
    skip = 0,
    more = false,
    over = null,
    asked = 0,
  ) {
    this.id = id;
    this.start = start;
    this.end = end;
    this.line = line;
    this.text = text;
    this.priority = priority;
    this.length = length;
    this.timing = timing;
    this.skip = skip;
    this.more = more;
    this.over = over;
    this.asked = asked;
  }
}

/**
 * The mode from `start` on; None for talking while something is said and idling otherwise.
 *
 * id: string; start: number; mode: ?string.
 */
export class ModeFrom {
  constructor(id, start, mode) {
    this.id = id;
    this.start = start;
    this.mode = mode;
  }
}

/**
 * Where a named point is from `start` on.
 *
 * id: string; start: number; name: string; point: number[].
 */
export class PlaceFrom {
  constructor(id, start, name, point) {
    this.id = id;
    this.start = start;
    this.name = name;
    this.point = point;
  }
}

/**
 * A requested blink.
 *
 * id: string; start: number.
 */
export class BlinkAt {
  constructor(id, start) {
    this.id = id;
    this.start = start;
  }
}

/**
 * From `start` on, the models change no stance of a layer, or may do so again with `on` false, until `end` or the next item
 * of this kind.
 *
 * id: string; start: number; layer: string; on: boolean; end: number.
 */
export class StayFrom {
  constructor(id, start, layer, on = true, end = Infinity) {
    this.id = id;
    this.start = start;
    this.layer = layer;
    this.on = on;
    this.end = end;
  }
}

/**
 * Return the second from which the times of a speech count: before its start if it continues after a pause.
 * @param {Speech} speech
 * @returns {number}
 */
export function findLineStart(speech) {
  return speech.start - speech.skip;
}

/**
 * Return how many seconds all of a speech takes, with the part before a pause and the part that was cut off.
 * @param {Speech} speech
 * @returns {number}
 */
export function measureLine(speech) {
  return speech.length === null ? speech.end - findLineStart(speech) : speech.length;
}

/**
 * Return the speech, ending no later than `at`; it remembers its full length.
 * @param {Speech} speech
 * @param {number} at
 * @returns {Speech}
 */
export function cut(speech, at) {
  return speech.end <= at ? speech : but(speech, { end: at, length: measureLine(speech) });
}

/**
 * Return speeches, given in order, without overlaps: one of equal or higher importance cuts the running one, with its later
 * pieces; a less important one is dropped.
 * @param {Speech[]} speeches
 * @returns {Speech[]}
 */
export function apart(speeches) {
  const out = [];
  const ends = new Map(); // when what was cut would have ended
  for (const speech of speeches) {
    if (ends.has(speech.id) && speech.start === ends.get(speech.id)) {
      ends.set(speech.id, speech.end);
      continue;
    }
    if (out.length > 0 && out[out.length - 1].end > speech.start) {
      const last = out[out.length - 1];
      if (speech.priority < last.priority) {
        continue;
      }
      out.pop();
      if (last.id !== speech.id) {
        ends.set(last.id, last.end);
      }
      if (last.start < speech.start) {
        out.push(but(cut(last, speech.start), { more: false }));
      }
    }
    out.push(speech);
  }
  return out;
}

/**
 * Return a text moved to after another one of its id that is being said, also if more of it may come. said: in order.
 * @param {Speech[]} said
 * @param {Speech} new_
 * @param {number} now
 * @returns {Speech}
 */
export function behind(said, new_, now) {
  if ((new_.timing !== null && !new_.timing.paced) || new_.line !== null || new_.start > now) {
    return new_;
  }
  let end = new_.start;
  for (const speech of said) {
    const paced = speech.timing === null || speech.timing.paced;
    const plain = paced && speech.line === null && speech.length === null;
    if (speech.id === new_.id && plain && speech.start <= end && end < speech.end) {
      end = speech.end;
    }
  }
  return end === new_.start ? new_ : but(new_, { start: end, end: end + (new_.end - new_.start) });
}

/**
 * Return a line as the continuation of the last one with the same id, if that has begun by `now` or begins with it: it keeps
 * the start and what has been said. Only lines whose words or shapes have times continue.
 * @param {?Speech} old
 * @param {Speech} new_
 * @param {number} now
 * @returns {Speech}
 */
export function goingOn(old, new_, now) {
  if (old === null || old.timing === null || new_.timing === null || old.length !== null) {
    return new_;
  }
  if (new_.timing.paced) {
    return old.end <= now ? new_ : _behindWords(old, old.timing, new_, new_.timing, now);
  }
  if (Math.max(old.start, new_.start) > now && old.start !== new_.start) {
    return new_;
  }
  const said = Math.max(now - findLineStart(old), old.skip);
  if (old.end <= now && !tellsOn(old.timing, shifted(new_.timing, old.timing.later))) {
    return new_;
  }
  const told = (old.start > now && old.skip === 0) ? new_.timing : placeTold(old.timing, new_.timing, said);
  const timing = extended(old.timing, told, said);
  const length = Math.max(timedSeconds(timing, null), new_.end - new_.start);
  const more = new_.text === "" || new_.text === toldText(new_.timing);
  return but(new_, { start: old.start, end: findLineStart(old) + length, text: more ? toldText(timing) : new_.text, timing: timing, skip: old.skip });
}

/**
 * Return a text with times estimated from its letters, so that later pieces can be added.
 * @param {Alphabet} alphabet
 * @param {Speech} new_
 * @returns {Speech}
 */
export function paceSpeech(alphabet, new_) {
  const timing = paceText(alphabet, new_.text, null);
  const length = timedSeconds(timing, measureText(alphabet, new_.text));
  return but(new_, { end: new_.start + length, timing: timing });
}

/**
 * Return a line with a text after its known words. told, more: the words of both.
 * @param {Speech} old
 * @param {LineTiming} told
 * @param {Speech} new_
 * @param {LineTiming} more
 * @param {number} now
 * @returns {Speech}
 */
function _behindWords(old, told, new_, more, now) {
  const begin = findLineStart(old);
  const at = Math.max(now - begin, old.skip, old.end - begin);
  const timing = but(told, { words: [...told.words, ...shifted(more, at).words], paced: true });
  const length = timedSeconds(timing, at + new_.end - new_.start);
  return but(new_, { start: old.start, end: begin + length, text: old.text + new_.text, timing: timing, skip: old.skip });
}

/**
 * Return whether the looks of two tracks are the same. The functions below compare other items.
 * @param {LookAt[]} one
 * @param {LookAt[]} other
 * @returns {boolean}
 */
export function alikeLooks(one, other) {
  return one.length === other.length && zip(one, other).every(({ 0: a, 1: b }) => a === b || _sameLook(a, b));
}

/**
 * @param {LookAt} a
 * @param {LookAt} b
 * @returns {boolean}
 */
function _sameLook(a, b) {
  if (!isSameSpot(a.to, b.to) || a.amount !== b.amount || a.strict !== b.strict) {
    return false;
  }
  return a.id === b.id && a.start === b.start && a.end === b.end && a.priority === b.priority;
}

/**
 * @param {Speech[]} one
 * @param {Speech[]} other
 * @returns {boolean}
 */
export function alikeSpeeches(one, other) {
  return one.length === other.length && zip(one, other).every(({ 0: a, 1: b }) => a === b || _sameSpeech(a, b));
}

/**
 * @param {Speech} a
 * @param {Speech} b
 * @returns {boolean}
 */
function _sameSpeech(a, b) {
  if (a.line !== b.line || a.text !== b.text || a.length !== b.length || a.priority !== b.priority) {
    return false;
  }
  if (a.skip !== b.skip || a.more !== b.more || a.over !== b.over || a.asked !== b.asked) {
    return false;
  }
  return a.id === b.id && a.start === b.start && a.end === b.end && alikeTimings(a.timing, b.timing);
}

/**
 * @param {ModeFrom[]} one
 * @param {ModeFrom[]} other
 * @returns {boolean}
 */
export function alikeModes(one, other) {
  return one.length === other.length
    && zip(one, other).every(({ 0: a, 1: b }) => a === b || (a.id === b.id && a.start === b.start && a.mode === b.mode));
}

/**
 * @param {PlaceFrom[]} one
 * @param {PlaceFrom[]} other
 * @returns {boolean}
 */
export function alikePlaces(one, other) {
  return one.length === other.length && zip(one, other).every(({ 0: a, 1: b }) => a === b || _samePlace(a, b));
}

/**
 * @param {PlaceFrom} a
 * @param {PlaceFrom} b
 * @returns {boolean}
 */
function _samePlace(a, b) {
  if (a.id !== b.id || a.start !== b.start || a.name !== b.name) {
    return false;
  }
  return zip(a.point, b.point).every(({ 0: x, 1: y }) => x === y);
}

/**
 * @param {BlinkAt[]} one
 * @param {BlinkAt[]} other
 * @returns {boolean}
 */
export function alikeBlinks(one, other) {
  return one.length === other.length
    && zip(one, other).every(({ 0: a, 1: b }) => a === b || (a.id === b.id && a.start === b.start));
}

/**
 * @param {StayFrom[]} one
 * @param {StayFrom[]} other
 * @returns {boolean}
 */
export function alikeStays(one, other) {
  return one.length === other.length && zip(one, other).every(({ 0: a, 1: b }) => a === b || _sameStay(a, b));
}

/**
 * @param {StayFrom} a
 * @param {StayFrom} b
 * @returns {boolean}
 */
function _sameStay(a, b) {
  if (a.layer !== b.layer || a.on !== b.on || a.end !== b.end) {
    return false;
  }
  return a.id === b.id && a.start === b.start;
}

/**
 * @param {MoodFrom[]} one
 * @param {MoodFrom[]} other
 * @returns {boolean}
 */
export function alikeFelt(one, other) {
  return one.length === other.length && zip(one, other).every(({ 0: a, 1: b }) => a === b || _sameFelt(a, b));
}

/**
 * @param {MoodFrom} a
 * @param {MoodFrom} b
 * @returns {boolean}
 */
function _sameFelt(a, b) {
  if (a.valence !== b.valence || a.arousal !== b.arousal || a.intensity !== b.intensity) {
    return false;
  }
  return a.id === b.id && a.start === b.start && a.end === b.end;
}
