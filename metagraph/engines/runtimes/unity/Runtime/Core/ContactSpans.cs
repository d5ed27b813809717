// Translated from metagraph/motion/contact_spans.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Where a hand is on a joint at a moment. time: clip seconds. at: the wrist in the joint's own space, metres. turn: how the
    /// hand is turned there, xyzw.
    /// </summary>
    public sealed class ContactKey
    {
        public readonly double Time;
        public readonly (double, double, double) At;
        public readonly (double, double, double, double) Turn;

        public ContactKey(double time, (double, double, double) at, (double, double, double, double) turn)
        {
            Time = time;
            At = at;
            Turn = turn;
        }
    }

    /// <summary>
    /// A hand that stays at a place on the body.
    ///
    /// hand: left or right. place: the part of the hand that touches: palm, fingertips, back, wrist. to: the name of the joint it
    /// stays with. start, end: clip seconds. keys: one for a hand that stays, more, in order, for one that moves over the body.
    /// ease_in, ease_out: seconds inside the span in which the contact sets in and fades out; they do not apply if the action
    /// begins, or ends, within the span.
    /// </summary>
    public sealed class ContactSpan
    {
        public readonly string Hand;
        public readonly string Place;
        public readonly string To;
        public readonly double Start;
        public readonly double End;
        public readonly List<ContactKey> Keys;
        public readonly double EaseIn;
        public readonly double EaseOut;

        public ContactSpan(
            string hand,
            string place,
            string to,
            double start,
            double end,
            List<ContactKey> keys,
            double easeIn = ContactSpansRules.Ease,
            double easeOut = ContactSpansRules.Ease
        )
        {
            Hand = hand;
            Place = place;
            To = to;
            Start = start;
            End = end;
            Keys = keys;
            EaseIn = easeIn;
            EaseOut = easeOut;
        }
    }

    public static class ContactSpansRules
    {
        public static readonly List<string> Hands = new List<string> { "left", "right" };
        public static readonly List<string> Places = new List<string> { "palm", "fingertips", "back", "wrist" };
        public const double Ease = 0.15; // seconds in which a hand comes to a contact, and leaves it, by default
        // seconds it takes at least where the contact lasts: what it touches may be far from its place
        public const double Settles = 0.3;

        /// <summary>
        /// Return how much a hand is held at a second of the clip, 0..1. first, last: the seconds of the clip that play.
        /// </summary>
        public static double ContactWeight(ContactSpan span, double seconds, double first, double last)
        {
            if (seconds < span.Start || seconds > span.End)
            {
                return 0.0;
            }
            var shown = 1.0;
            var comes = span.Start > first && span.EaseIn > 0.0;
            var goes = span.End < last && span.EaseOut > 0.0;
            var least = Math.Min(Settles, (span.End - span.Start) / ((comes && goes) ? 2.0 : 1.0));
            if (comes)
            {
                shown = Math.Min(shown, (seconds - span.Start) / Math.Max(span.EaseIn, least));
            }
            if (goes)
            {
                shown = Math.Min(shown, (span.End - seconds) / Math.Max(span.EaseOut, least));
            }
            return shown * shown * (3.0 - 2.0 * shown);
        }

        /// <summary>Return where a hand is at a second of the clip, interpolated linearly between two keys.</summary>
        public static ContactKey ContactKey(ContactSpan span, double seconds)
        {
            var before = span.Keys[0];
            foreach (ContactKey after in span.Keys)
            {
                if (after.Time >= seconds)
                {
                    if (after.Time <= before.Time)
                    {
                        return after;
                    }
                    var part = (seconds - before.Time) / (after.Time - before.Time);
                    var found = before.At;
                    double ax = found.Item1;
                    double ay = found.Item2;
                    double az = found.Item3;
                    var found2 = after.At;
                    double bx = found2.Item1;
                    double by = found2.Item2;
                    double bz = found2.Item3;
                    var at = (ax + (bx - ax) * part, ay + (by - ay) * part, az + (bz - az) * part);
                    var found3 = before.Turn;
                    double px = found3.Item1;
                    double py = found3.Item2;
                    double pz = found3.Item3;
                    double pw = found3.Item4;
                    var found4 = after.Turn;
                    double qx = found4.Item1;
                    double qy = found4.Item2;
                    double qz = found4.Item3;
                    double qw = found4.Item4;
                    var other = px * qx + py * qy + pz * qz + pw * qw < 0.0 ? -part : part;
                    var own = 1.0 - part;
                    var x = px * own + qx * other;
                    var y = py * own + qy * other;
                    var z = pz * own + qz * other;
                    var w = pw * own + qw * other;
                    var size = 1.0 / Math.Max(Math.Sqrt(x * x + y * y + z * z + w * w), 1e-12);
                    return new ContactKey(seconds, at, (x * size, y * size, z * size, w * size));
                }
                before = after;
            }
            return before;
        }
    }
}
