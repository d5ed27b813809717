/**
 * Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).
 *
 * Greedy, by start time and then priority. The running action is never touched. Where two overlap, the more important one keeps
 * its time; the other is delayed past it, or cut where it begins, and then goes on with its remainder if it asked to.
 */

import { begunBy, compareText } from "./choice.js";
import { report } from "./plan.js";

/** Let new requests wait until `free` seconds, the end of the running action; what would wait too long is past. */
export function delay(asked, free, settings) {
  const metas = [];
  const reports = [];
  for (const meta of asked) {
    const late = free - meta.start;
    if (late <= 0) {
      metas.push(meta);
    } else if (late > settings.wait) {
      reports.push(report(meta, "past", `asked for at ${s(meta.start)}, ${s(late)} before anything could start`));
    } else {
      metas.push({ ...meta, start: free, end: free + (meta.end - meta.start) });
      reports.push(report(meta, "late", `waits ${s(late)} for the running action`, true));
    }
  }
  return { metas, reports };
}

/**
 * Return the meta plan, ascending and without overlaps, and what became of the rest.
 *
 * What is asked for is placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions that do not
 * overlap come back as they are, so a plan that is placed again stays as it is.
 */
export function replan(metas, settings, busy = -Infinity) {
  const reports = [];
  const placed = place(metas.filter((m) => !m.written), settings, reports);
  const written = fit(metas.filter((m) => m.written), placed, settings.shortest, busy, reports);
  return { metas: [...placed, ...written].sort((a, b) => a.start - b.start || a.end - b.end), reports };
}

/** Return what is left of what a model wrote beside what is placed: the first stretch of each that is long enough. */
function fit(written, placed, shortest, busy, reports) {
  const out = [];
  for (const meta of written.sort((a, b) => a.start - b.start || compareText(a.request.id, b.request.id))) {
    let start = Math.max(meta.start, busy, out.length ? out[out.length - 1].end : busy);
    let end = meta.end;
    let beside = null;
    for (let n = Math.max(0, begunBy(placed, start) - 1); n < placed.length; n++) {
      const other = placed[n];
      if (other.start >= end) break;
      if (other.end <= start) continue;
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
      out.push({ ...meta, start, end });
      if (end < meta.end && beside) reports.push(report(meta, "cut", `is cut at ${s(end)} for '${beside.request.id}'`, true));
    } else {
      reports.push(report(meta, "covered", beside ? noTime(beside) : "no time left beside what plays"));
    }
  }
  return out;
}

/** Of equal start and priority, the id that sorts first goes first. */
function order(a, b) {
  const [x, y] = [a.meta, b.meta];
  const first = x.start - y.start || y.request.priority - x.request.priority || compareText(x.request.id, y.request.id);
  return first || x.part - y.part || a.serial - b.serial;
}

function place(metas, settings, reports) {
  const queue = metas.map((meta, serial) => ({ meta, serial })).sort((a, b) => order(b, a)); // the next one at the end
  let serial = metas.length;
  const push = (meta) => {
    const entry = { meta, serial: serial++ };
    let n = queue.length;
    while (n > 0 && order(queue[n - 1], entry) < 0) n--;
    queue.splice(n, 0, entry);
  };
  const placed = [];
  while (queue.length) {
    const { meta } = queue.pop();
    const last = placed[placed.length - 1];
    if (!last || last.end <= meta.start) {
      placed.push(meta);
    } else if (meta.request.priority > last.request.priority) {
      placed.pop();
      const kept = meta.start - last.start >= settings.shortest;
      if (kept) placed.push({ ...last, end: meta.start });
      // What was never begun goes on as itself, so that its draws stay the same.
      const rest = { ...last, start: meta.end, part: kept ? last.part + 1 : last.part };
      const resumes = last.request.resume && rest.end - rest.start >= settings.shortest;
      if (resumes) push(rest);
      const outcome = resumes ? "resumed" : kept ? "cut" : "covered";
      const words = `${kept ? "is cut" : "gives way"} at ${s(meta.start)} for '${meta.request.id}', which is more important`;
      reports.push(report(last, outcome, resumes ? `${words} and goes on at ${s(meta.end)}` : words, kept || resumes));
      push(meta); // it may reach back over what was placed before, too
    } else if (last.end - meta.request.start > settings.wait) {
      reports.push(report(meta, "covered", noTime(last)));
    } else {
      push({ ...meta, start: last.end, end: last.end + (meta.end - meta.start) });
      reports.push(report(meta, "late", `waits ${s(last.end - meta.request.start)} for '${last.request.id}'`, true));
    }
  }
  return placed;
}

const noTime = (other) => `no time left beside '${other.request.id}' (${s(other.start)} to ${s(other.end)})`;
export const s = (seconds) => `${seconds.toFixed(2)} s`;
