/**
 * The Markov model that performs when there are no requests: a first-order chain over (limb, kind).
 *
 * The arms matrix is the paper's (Borer et al., figure 11), learned from annotated casual conversation. Body and head have
 * no published matrix; theirs are ours, shaped on the paper's labels: the head nods and now and then changes its tilt, the
 * body mostly rests, shifts and fidgets. The shares of what is performed in the modes idle, listening and talking are ours,
 * too: the hands gesture with the character's own speech, and the head nods at the other's.
 *
 * Translated from metagraph/playback/planning/markov.py; change that, and translate anew.
 */

import { MODES } from "./words.js";
import { Cursor, MetaAction, MetaRequest, WRITTEN } from "./meta_plan.js";
import { chanceOf, keyed, logNormal, picked, uniform } from "./choice.js";
import { splitWords, zip } from "./basics.js";

export const KINDS = ["gesture", "fidget", "transition"]; // as in `Markov.modes`
export const LISTENS = 1; // place of the row that stands for modes of which a model says nothing
export const BEGIN = new Cursor();
export const RESTS = 0.9; // standard deviation of rests, times their mean

/**
 * Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before the first one left
 * out.
 *
 * Rests are log-normal about the mean gap (`rest_length`): most are short, some long, as people's are. Windows are as
 * `length` says. kinds: those that the graph has; states of other kinds are passed over, so that half-filled graphs perform,
 * too.
 *
 * Each draw is keyed by the meta action's number. So a longer horizon only appends, and continuing from a cursor gives bit
 * for bit the same as writing in one go. After a row of zeros, the chain starts again from any state.
 * @param {Markov} chain
 * @param {number} seed
 * @param {number} until
 * @param {?Set<string>} kinds
 * @param {Cursor} cursor
 * @returns {[MetaAction[], Cursor]}
 */
export function write(chain, seed, until, kinds = null, cursor = BEGIN) {
  let number = cursor.number;
  let state = cursor.state;
  let time = cursor.time;
  const openTo = chain.states.map(({ 1: kind }) => (kinds === null || kinds.has(kind)) ? 1 : 0);
  const rows = new Map();
  const out = [];
  const able = openTo.some((p) => p > 0);
  while (able) {
    const ident = `auto/${chain.layer}/${number}`;
    const key = keyed(seed, ident);
    const start = time + restLength(chain, key);
    if (!(start < until)) { // nor when it is no number
      break;
    }
    if (!rows.has(state)) {
      rows.set(state, _row(chain, state, openTo));
    }
    state = Number(picked(key, "state", rows.get(state)));
    const { 0: limb, 1: kind } = chain.states[state];
    const seconds = length(chain, state, key);
    let tags = [...splitWords(chain.tag(state))];
    if (kind === "gesture" && chain.tags.length === 0) {
      const draw = chanceOf(key, "tag");
      if (draw < chain.positive) {
        tags = ["positive"];
      } else if (draw < chain.positive + chain.negative) {
        tags = ["negative"];
      }
    }
    const request = new MetaRequest(ident, chain.layer, kind, start, seconds, null, tags, limb, null, WRITTEN);
    out.push(new MetaAction(request, start, start + seconds, 0, true));
    number = number + 1;
    time = start + seconds;
  }
  return [out, new Cursor(number, state, time)];
}

/**
 * Return the probability of each state that may follow a state (-1: before the first), by its index; of all allowed states
 * if none may follow.
 * @param {Markov} chain
 * @param {number} state
 * @param {number[]} openTo
 * @returns {Map<string, number>}
 */
function _row(chain, state, openTo) {
  let row = [...openTo];
  if (0 <= state && state < row.length) {
    row = zip(chain.matrix[state], openTo).map(({ 0: p, 1: may }) => p * may);
  }
  if (!row.some((p) => p > 0)) {
    row = [...openTo];
  }
  return new Map([...row.entries()].filter(({ 0: i, 1: p }) => p > 0).map(({ 0: i, 1: p }) => [String(i), p]));
}

/**
 * Return whether something that the model wrote is performed in a mode (`Markov.modes`). What is left out does not change
 * the rest, so it does not matter when a mode became known.
 * @param {Markov} chain
 * @param {number} seed
 * @param {MetaAction} meta
 * @param {string} mode
 * @returns {boolean}
 */
export function performs(chain, seed, meta, mode) {
  if (chain.modes.length === 0 || !KINDS.includes(meta.request.kind)) {
    return true;
  }
  const place = MODES.indexOf(mode);
  const row = chain.modes[place < chain.modes.length ? place : LISTENS];
  const share = row[KINDS.indexOf(meta.request.kind)];
  return share >= 1 || uniform(seed, meta.request.id, "mode") < share;
}

/**
 * Return how many seconds a meta action of a key lasts: uniform from 1 to 3 if the model has no lengths; else log-normal
 * with the state's mean and standard deviation.
 * @param {Markov} chain
 * @param {number} state
 * @param {number} key
 * @returns {number}
 */
export function length(chain, state, key) {
  if (chain.lengths.length === 0) {
    return 1 + 2 * chanceOf(key, "length");
  }
  const { 0: mean, 1: deviation } = chain.lengths[state];
  return logNormal(mean, deviation, chanceOf(key, "length"), chanceOf(key, "length2"));
}

/**
 * Return how many seconds of rest come before a meta action of a key: log-normal with the mean `chain.gap`, between a fifth
 * and five times of it.
 * @param {Markov} chain
 * @param {number} key
 * @returns {number}
 */
export function restLength(chain, key) {
  const drawn = logNormal(chain.gap, RESTS * chain.gap, chanceOf(key, "gap"), chanceOf(key, "gap2"));
  return Math.min(5 * chain.gap, Math.max(0.2 * chain.gap, drawn));
}
