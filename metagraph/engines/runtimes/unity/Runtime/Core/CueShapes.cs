// Translated from metagraph/playback/planning/cue_shapes.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// How an action would play: from `start` on, for `length` seconds, at least `shortest`; the other fields are those of a cue.
    /// </summary>
    public sealed class CueShape
    {
        public readonly double Start;
        public readonly double Entry;
        public readonly double Length;
        public readonly double Shortest;
        public readonly double HoldFrom;
        public readonly double HoldTo;
        public readonly double Hold;
        public readonly double Tempo;

        public CueShape(
            double start,
            double entry,
            double length,
            double shortest,
            double holdFrom = 0.0,
            double holdTo = 0.0,
            double hold = 0.0,
            double tempo = 1.0
        )
        {
            Start = start;
            Entry = entry;
            Length = length;
            Shortest = shortest;
            HoldFrom = holdFrom;
            HoldTo = holdTo;
            Hold = hold;
            Tempo = tempo;
        }
    }

    public static class CueShapesRules
    {
        public const double Fits = 1e-06; // seconds by which sums of times may be off
        public const double Hurry = 2.0; // a hold is played at most this many times as fast as it was made
        // seconds in which an action that is taken back goes back to its stance, from where it is
        public const double Stopped = 0.3;
        // seconds in which an action whose retraction is cut goes back to its stance, at the least
        public const double Retraction = 0.4;
        public const double Shared = 0.25; // seconds within which two strokes may be one

        /// <summary>
        /// Return how an action would play for a request from `now` on, or as a step on the way to it. speed: a factor of the
        /// action's own speed.
        /// </summary>
        public static CueShape ShapeOf(Graph project, GraphAction action, MetaRequest request, double now, double speed)
        {
            var both = project.Span(action);
            double start = both.Item1;
            double end = both.Item2;
            var begin = now;
            var entry = start;
            var holdFrom = 0.0;
            var holdTo = 0.0;
            var hold = 0.0;
            var cycle = RepeatingRules.CycleOf(action.Kind, action.Timing, start, end);
            if (request != null
                && action.Kind == "gesture"
                && (request.Hold != null || request.Stroke != null || !request.Prepare))
            {
                var found = PhasesRules.FindPhases(project, action);
                var latest = found.Skip(action.Timing.BlendIn);
                entry = request.Prepare ? start : latest;
                // Wait for the stroke, or catch up with it by cutting the preparation.
                if (request.Stroke != null)
                {
                    begin = Math.Max(now, request.Stroke.Value - (found.Stroke - entry) / speed);
                    var missed = found.Stroke - Math.Max(0.0, request.Stroke.Value - begin) * speed;
                    entry = Math.Min(Math.Max(entry, missed), Math.Max(entry, latest));
                }
                if (request.Hold != null && cycle <= 0)
                {
                    holdFrom = found.StrokeEnd;
                    holdTo = found.Relax;
                    hold = Math.Max(request.Hold.Value, (holdTo - holdFrom) / Hurry);
                    if (hold <= 0)
                    {
                        holdFrom = 0.0;
                        holdTo = 0.0;
                    }
                }
            }
            var natural = holdTo - holdFrom;
            var length = end - entry + hold - natural + MoodRules.Drag(end - entry - natural, speed);
            var shortest = length;
            var exitAt = action.Timing.EarliestExit;
            if (cycle > 0)
            {
                var wanted = Math.Min(action.Timing.Repeat, RepeatingRules.LongestRepeat);
                if (request != null && request.Hold != null)
                {
                    wanted = request.Hold.Value; // what repeats goes on for as long as another gesture would be held
                }
                if (request != null && request.Duration != null)
                {
                    wanted = request.Duration.Value;
                }
                length += (RepeatingRules.TimesPlayed(cycle, wanted * speed) - 1.0) * cycle / speed;
                exitAt = exitAt == null ? end : exitAt.Value;
            }
            if (exitAt != null)
            {
                var left = exitAt.Value - entry + (exitAt.Value >= holdTo ? hold - natural : 0.0);
                left += MoodRules.Drag(exitAt.Value - entry - (exitAt.Value >= holdTo ? natural : 0.0), speed);
                shortest = Math.Min(length, Math.Max(0.0, left) + action.Timing.BlendOut);
            }
            return new CueShape(begin, entry, length, shortest, holdFrom, holdTo, hold, speed);
        }

        /// <summary>Return whether something with this shape is over by a limit.</summary>
        public static bool FitsBefore(CueShape shape, double limit)
        {
            return shape.Start + shape.Shortest <= limit + Fits;
        }

        /// <summary>
        /// Return by how many seconds an action with this shape comes late, measured at its stroke if the request has one; below
        /// 0 if it comes early.
        /// </summary>
        public static double Lateness(Graph project, GraphAction action, MetaRequest request, CueShape shape)
        {
            if (request.Stroke != null && action.Kind == "gesture")
            {
                var found = PhasesRules.FindPhases(project, action);
                var until = found.Stroke - shape.Entry;
                return shape.Start + found.Stroke - shape.Entry + MoodRules.Drag(until, shape.Tempo) - request.Stroke.Value;
            }
            return shape.Start - request.Start;
        }

        /// <summary>Return by how many seconds a request may come late, 0 if it does not say.</summary>
        public static double SlackOf(MetaRequest request)
        {
            return request.Late == null ? 0.0 : request.Late.Value;
        }

        /// <summary>
        /// Return how many seconds a gesture takes if its retraction is cut and its hold is left out, unless the request has a
        /// hold.
        /// </summary>
        public static double Hurried(Graph project, GraphAction action, CueShape shape)
        {
            var both = project.Span(action);
            double start = both.Item1;
            double end = both.Item2;
            var repeats = RepeatingRules.CycleOf(action.Kind, action.Timing, start, end) > 0;
            if (action.Kind != "gesture" || action.Timing.EarliestExit != null || repeats)
            {
                return shape.Shortest;
            }
            var found = PhasesRules.FindPhases(project, action);
            var left = found.Relax - shape.Entry + shape.Hold - (shape.HoldTo - shape.HoldFrom);
            var moving = found.Relax - shape.Entry - (shape.HoldTo - shape.HoldFrom);
            if (shape.Hold <= 0)
            {
                left = found.StrokeEnd - shape.Entry;
                moving = left;
            }
            left += MoodRules.Drag(moving, shape.Tempo);
            return Math.Min(shape.Length, left + Math.Max(action.Timing.BlendOut, Retraction));
        }

        /// <summary>Return whether one stroke may meet two requests.</summary>
        public static bool MayShare(MetaRequest request, MetaRequest other)
        {
            if (request.Stroke == null || other.Stroke == null)
            {
                return false;
            }
            return request.Action == null
                && other.Action == null
                && request.Kind == other.Kind
                && (other.Hold == null || other.Hold.Value == request.Hold)
                && Math.Abs(request.Stroke.Value - other.Stroke.Value) <= Shared;
        }

        /// <summary>Return whether an action fits a request that does not name one.</summary>
        public static bool Meets(GraphAction action, MetaRequest request)
        {
            return request.Tags.All(tag => action.Tags.Contains(tag))
                && (request.Limb == null || action.Limb == request.Limb)
                && (request.Among.Count == 0 || request.Among.Contains(action.Id));
        }

        /// <summary>
        /// Return the request of a meta action; for a remainder, with the duration that is left. What a model wrote has no
        /// duration.
        /// </summary>
        public static MetaRequest Remaining(MetaAction meta, double now)
        {
            var request = meta.Request;
            if (request.Duration == null || (meta.Part == 0 && !meta.Written))
            {
                return request;
            }
            return new MetaRequest(
                request.Id,
                request.Layer,
                request.Kind,
                request.Start,
                meta.Written ? (double?)null : Math.Max(0.0, meta.End - now),
                request.Action,
                request.Tags,
                request.Limb,
                request.Stance,
                request.Priority,
                request.Resume,
                request.Stroke,
                request.Hold,
                request.Prepare,
                request.Among,
                request.Late,
                request.Valence,
                request.Arousal,
                request.Intensity
            );
        }
    }
}
