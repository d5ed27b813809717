// Translated from metagraph/playback/life/speech_watch.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A piece of something said that begins or ends. kind: "begin" or "end". at: seconds. said: the line's id, or the text.
    /// reason: why the whole utterance is over; "" at a beginning, and where more of it comes.
    /// </summary>
    public sealed class SpeechEvent
    {
        public readonly string Kind;
        public readonly double At;
        public readonly string Id;
        public readonly string Said;
        public readonly string Reason;

        public SpeechEvent(string kind, double at, string id, string said, string reason)
        {
            Kind = kind;
            At = at;
            Id = id;
            Said = said;
            Reason = reason;
        }
    }

    /// <summary>
    /// Notices what is said, and the end of each utterance once. lasting: the last known piece of each utterance that has begun
    /// and is not over.
    /// </summary>
    public sealed class SpeechWatch
    {
        public List<Speech> Lasting;

        public SpeechWatch(List<Speech> lasting = null)
        {
            Lasting = lasting ?? new List<Speech>();
        }

        /// <summary>
        /// Return what began and ended after `seen`, until `now`, seconds. speeches: all that are said, by start.
        /// </summary>
        public List<SpeechEvent> Watch(List<Speech> speeches, double seen, double now)
        {
            var out_ = new List<SpeechEvent>();
            foreach (Speech speech in speeches)
            {
                if (speech.End <= seen || speech.Start > now)
                {
                    continue;
                }
                Follow(speech);
                if (speech.Start > seen)
                {
                    out_.Add(Note("begin", speech, speech.Start, ""));
                }
                if (speech.End <= now && (speech.Over != null || UtterancesRules.ExplainEnd(speeches, speech) == ""))
                {
                    out_.Add(Note("end", speech, speech.End, ""));
                }
            }
            var lasting = new List<Speech>();
            foreach (Speech one in Lasting)
            {
                var last = FindLast(speeches, one);
                if (last == null) // something else took its place before it could go on
                {
                    out_.Add(Note("end", one, now, "replaced"));
                    continue;
                }
                var reason = UtterancesRules.ExplainEnd(speeches, last);
                var until = last.Over == null ? last.End : Math.Max(last.End, last.Over.Value);
                if (reason == "" || until > now)
                {
                    lasting.Add(last);
                }
                else
                {
                    out_.Add(Note("end", last, until > seen ? until : now, reason));
                }
            }
            Lasting = lasting;
            return out_;
        }

        /// <summary>Take note that an utterance has begun, or goes on.</summary>
        public void Follow(Speech speech)
        {
            foreach (Speech one in Lasting)
            {
                if (one.Id == speech.Id && one.Asked == speech.Asked)
                {
                    return;
                }
            }
            Lasting.Add(speech);
        }

        public SpeechEvent Note(string kind, Speech speech, double at, string reason)
        {
            var said = speech.Line == null ? speech.Text : speech.Line;
            return new SpeechEvent(kind, at, speech.Id, said, reason);
        }

        /// <summary>Return the last piece of the utterance that a piece belongs to; None if none is left.</summary>
        public Speech FindLast(List<Speech> speeches, Speech one)
        {
            Speech last = null;
            foreach (Speech speech in speeches)
            {
                if (speech.Id == one.Id && speech.Asked == one.Asked)
                {
                    last = speech;
                }
            }
            return last;
        }
    }
}
