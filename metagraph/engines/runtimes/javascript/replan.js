/**
 * Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).
 *
 * Greedy, by start time and then priority. The running action is never touched. If two overlap, the more important one keeps
 * its time. The other is delayed past it, or cut where it begins; its remainder then plays afterwards if the request says
 * so.
 *
 * Translated from metagraph/playback/planning/replan.py; change that, and translate anew.
 */

import { Report } from "./meta_plan.js";
import { bisectRight, but, insort, sortedBy } from "./basics.js";

/**
 * Let new requests wait until `free` seconds, the end of the running action, and drop those that would wait too long.
 * Requests that say how late they may be are judged later, when their lateness is known.
 * @param {MetaAction[]} asked
 * @param {number} free
 * @param {Settings} settings
 * @returns {[MetaAction[], Report[]]}
 */
export function delay(asked, free, settings) {
  const metas = [];
  const reports = [];
  for (const meta of asked) {
    const late = free - meta.start;
    if (late <= 0) {
      metas.push(meta);
    } else if (meta.request.late !== null) {
      metas.push(_after(meta, free));
    } else if (late > settings.wait) {
      reports.push(_told(
        meta,
        "past",
        `asked for at ${meta.start.toFixed(2)} s, ${late.toFixed(1)} s before anything could start`,
      ));
    } else {
      metas.push(_after(meta, free));
      reports.push(_told(meta, "late", `waits ${late.toFixed(2)} s for the running action`, true));
    }
  }
  return [metas, reports];
}

/**
 * Return the meta plan, ascending and without overlaps, and what became of the rest.
 *
 * Requests are placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions that do not overlap
 * stay as they are, so a plan that is placed again does not change. If start and priority are equal, the id that sorts first
 * goes first.
 * @param {MetaAction[]} metas
 * @param {Settings} settings
 * @param {number} busy
 * @returns {[MetaAction[], Report[]]}
 */
export function replan(metas, settings, busy = -Infinity) {
  const every = [...metas];
  const { 0: placed, 1: reports } = _placed(every.filter((m) => !m.written), settings);
  const { 0: written, 1: told } = _fitted(every.filter((m) => m.written), placed, settings.shortest, busy);
  return [sortedBy([...placed, ...written], (m) => [m.start, m.end]), [...reports, ...told]];
}

/**
 * Return the parts of written meta actions that fit beside the placed ones: the first stretch of each that is long enough.
 * @param {MetaAction[]} written
 * @param {MetaAction[]} placed
 * @param {number} shortest
 * @param {number} busy
 * @returns {[MetaAction[], Report[]]}
 */
function _fitted(written, placed, shortest, busy) {
  const out = [];
  const reports = [];
  const starts = placed.map((m) => m.start);
  for (const meta of sortedBy(written, (m) => [m.start, m.request.id])) {
    let start = Math.max(meta.start, busy, out.length > 0 ? out[out.length - 1].end : busy);
    let end = meta.end;
    let beside = null;
    for (const other of placed.slice(Math.max(0, bisectRight(starts, start) - 1))) {
      if (other.start >= end) {
        break;
      }
      if (other.end <= start) {
        continue;
      }
      beside = other;
      if (other.start - start >= shortest) {
        end = other.start;
        break;
      }
      start = other.end;
    }
    if (start === meta.start && end === meta.end) {
      out.push(meta);
    } else if (end - start >= shortest) {
      out.push(but(meta, { start: start, end: end }));
      if (end < meta.end && beside !== null) {
        reports.push(_told(
          meta,
          "cut",
          `is cut at ${end.toFixed(2)} s for '${beside.request.id}', which is asked for`,
          true,
        ));
      }
    } else {
      const words = beside !== null ? _noTime(beside) : "no time left beside what plays";
      reports.push(_told(meta, "covered", words));
    }
  }
  return [out, reports];
}

/**
 * Return the sort key that decides which is placed first.
 * @param {MetaAction} meta
 * @returns {[number, number, string, number]}
 */
function _order(meta) {
  return [meta.start, -meta.request.priority, meta.request.id, meta.part];
}

/**
 * @param {MetaAction[]} metas
 * @param {Settings} settings
 * @returns {[MetaAction[], Report[]]}
 */
function _placed(metas, settings) {
  const queue = sortedBy(metas, _order);
  let at = 0; // what is before it was looked at
  const placed = [];
  const reports = [];
  while (at < queue.length) {
    const meta = queue[at];
    at += 1;
    const last = placed.length > 0 ? placed[placed.length - 1] : null;
    if (last === null || last.end <= meta.start) {
      placed.push(meta);
      continue;
    }
    if (meta.request.priority > last.request.priority) {
      placed.pop();
      const kept = meta.start - last.start >= settings.shortest;
      if (kept) {
        placed.push(but(last, { end: meta.start }));
      }
      // What was never begun goes on as itself, so that its draws stay the same.
      const rest = but(last, { start: meta.end, part: kept ? last.part + 1 : last.part });
      const resumes = last.request.resume && rest.end - rest.start >= settings.shortest;
      if (resumes) {
        insort(queue, rest, at, _order);
      }
      const word = kept ? "is cut" : "gives way";
      const after = resumes ? ` and goes on at ${meta.end.toFixed(2)} s` : "";
      const outcome = resumes ? "resumed" : kept ? "cut" : "covered";
      const message = `${word} at ${meta.start.toFixed(2)} s for '${meta.request.id}', which is more important${after}`;
      reports.push(_told(last, outcome, message, kept || resumes));
      insort(queue, meta, at, _order); // it may reach back over what was placed before, too
    } else if (meta.request.late !== null) {
      insort(queue, _after(meta, last.end), at, _order);
    } else if (last.end - meta.request.start > settings.wait) {
      reports.push(_told(meta, "covered", _noTime(last)));
    } else {
      insort(queue, _after(meta, last.end), at, _order);
      reports.push(_told(
        meta,
        "late",
        `waits ${(last.end - meta.request.start).toFixed(2)} s for '${last.request.id}'`,
        true,
      ));
    }
  }
  return [placed, reports];
}

/**
 * Return a meta action that begins at `free` instead.
 * @param {MetaAction} meta
 * @param {number} free
 * @returns {MetaAction}
 */
function _after(meta, free) {
  return but(meta, { start: free, end: free + (meta.end - meta.start) });
}

/**
 * @param {MetaAction} other
 * @returns {string}
 */
function _noTime(other) {
  return `no time left beside '${other.request.id}' (${other.start.toFixed(2)}-${other.end.toFixed(2)} s)`;
}

/**
 * @param {MetaAction} meta
 * @param {string} outcome
 * @param {string} message
 * @param {boolean} played
 * @returns {Report}
 */
function _told(meta, outcome, message, played = false) {
  return new Report(meta.request.id, outcome, message, meta.request.layer, meta.start, played, meta.written);
}
