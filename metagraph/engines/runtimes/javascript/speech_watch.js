/**
 * Notice when what is said begins and ends, from one moment to the next.
 *
 * Translated from metagraph/playback/life/speech_watch.py; change that, and translate anew.
 */

import { explainEnd } from "./utterances.js";

/**
 * A piece of something said that begins or ends. kind: "begin" or "end". at: seconds. said: the line's id, or the text.
 * reason: why the whole utterance is over; "" at a beginning, and where more of it comes.
 *
 * kind: string; at: number; id: string; said: string; reason: string.
 */
export class SpeechEvent {
  constructor(kind, at, id, said, reason) {
    this.kind = kind;
    this.at = at;
    this.id = id;
    this.said = said;
    this.reason = reason;
  }
}

/**
 * Notices what is said, and the end of each utterance once. lasting: the last known piece of each utterance that has begun
 * and is not over.
 *
 * lasting: Speech[].
 */
export class SpeechWatch {
  constructor(lasting = []) {
    this.lasting = lasting;
  }

  /** Return what began and ended after `seen`, until `now`, seconds. speeches: all that are said, by start. */
  watch(speeches, seen, now) {
    const out = [];
    for (const speech of speeches) {
      if (speech.end <= seen || speech.start > now) {
        continue;
      }
      this.follow(speech);
      if (speech.start > seen) {
        out.push(this.note("begin", speech, speech.start, ""));
      }
      if (speech.end <= now && (speech.over !== null || explainEnd(speeches, speech) === "")) {
        out.push(this.note("end", speech, speech.end, ""));
      }
    }
    const lasting = [];
    for (const one of this.lasting) {
      const last = this.findLast(speeches, one);
      if (last === null) { // something else took its place before it could go on
        out.push(this.note("end", one, now, "replaced"));
        continue;
      }
      const reason = explainEnd(speeches, last);
      const until = last.over === null ? last.end : Math.max(last.end, last.over);
      if (reason === "" || until > now) {
        lasting.push(last);
      } else {
        out.push(this.note("end", last, until > seen ? until : now, reason));
      }
    }
    this.lasting = lasting;
    return out;
  }

  /** Take note that an utterance has begun, or goes on. */
  follow(speech) {
    for (const one of this.lasting) {
      if (one.id === speech.id && one.asked === speech.asked) {
        return;
      }
    }
    this.lasting.push(speech);
  }

  note(kind, speech, at, reason) {
    const said = speech.line === null ? speech.text : speech.line;
    return new SpeechEvent(kind, at, speech.id, said, reason);
  }

  /** Return the last piece of the utterance that a piece belongs to; None if none is left. */
  findLast(speeches, one) {
    let last = null;
    for (const speech of speeches) {
      if (speech.id === one.id && speech.asked === one.asked) {
        last = speech;
      }
    }
    return last;
  }
}
