// Translated from metagraph/playback/planning/replan.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).
    ///
    /// Greedy, by start time and then priority. The running action is never touched. If two overlap, the more important one keeps
    /// its time. The other is delayed past it, or cut where it begins; its remainder then plays afterwards if the request says
    /// so.
    /// </summary>
    public static class ReplanRules
    {
        /// <summary>
        /// Let new requests wait until `free` seconds, the end of the running action, and drop those that would wait too long.
        /// Requests that say how late they may be are judged later, when their lateness is known.
        /// </summary>
        public static (List<MetaAction>, List<Report>) Delay(List<MetaAction> asked, double free, PlannerSettings settings)
        {
            var metas = new List<MetaAction>();
            var reports = new List<Report>();
            foreach (MetaAction meta in asked)
            {
                var late = free - meta.Start;
                if (late <= 0)
                {
                    metas.Add(meta);
                }
                else if (meta.Request.Late != null)
                {
                    metas.Add(After(meta, free));
                }
                else if (late > settings.Wait)
                {
                    reports.Add(Told(
                        meta,
                        "past",
                        "asked for at "
                            + PlainText.Fixed(meta.Start, 2)
                            + " s, "
                            + PlainText.Fixed(late, 1)
                            + " s before anything could start"
                    ));
                }
                else
                {
                    metas.Add(After(meta, free));
                    reports.Add(Told(meta, "late", "waits " + PlainText.Fixed(late, 2) + " s for the running action", true));
                }
            }
            return (metas, reports);
        }

        /// <summary>
        /// Return the meta plan, ascending and without overlaps, and what became of the rest.
        ///
        /// Requests are placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions that do not
        /// overlap stay as they are, so a plan that is placed again does not change. If start and priority are equal, the id that
        /// sorts first goes first.
        /// </summary>
        public static (List<MetaAction>, List<Report>) Replan(
            List<MetaAction> metas,
            PlannerSettings settings,
            double busy = double.NegativeInfinity
        )
        {
            var every = metas.ToList();
            var found = Placed(every.Where(m => !m.Written).ToList(), settings);
            List<MetaAction> placed = found.Item1;
            List<Report> reports = found.Item2;
            var found2 = Fitted(every.Where(m => m.Written).ToList(), placed, settings.Shortest, busy);
            List<MetaAction> written = found2.Item1;
            List<Report> told = found2.Item2;
            return (
                placed.Concat(written).ToList().OrderBy(m => m.Start).ThenBy(m => m.End).ToList(),
                reports.Concat(told).ToList()
            );
        }

        /// <summary>
        /// Return the parts of written meta actions that fit beside the placed ones: the first stretch of each that is long
        /// enough.
        /// </summary>
        private static (List<MetaAction>, List<Report>) Fitted(
            List<MetaAction> written,
            List<MetaAction> placed,
            double shortest,
            double busy
        )
        {
            var out_ = new List<MetaAction>();
            var reports = new List<Report>();
            var starts = placed.Select(m => m.Start).ToList();
            foreach (MetaAction meta in written.OrderBy(m => m.Start).ThenBy(m => m.Request.Id, PlainText.Order).ToList())
            {
                var start = Math.Max(meta.Start, Math.Max(busy, out_.Count > 0 ? out_[out_.Count - 1].End : busy));
                var end = meta.End;
                MetaAction beside = null;
                foreach (MetaAction other in PlainLists.Part(placed, Math.Max(0, PlainLists.Right(starts, start) - 1)))
                {
                    if (other.Start >= end)
                    {
                        break;
                    }
                    if (other.End <= start)
                    {
                        continue;
                    }
                    beside = other;
                    if (other.Start - start >= shortest)
                    {
                        end = other.Start;
                        break;
                    }
                    start = other.End;
                }
                if (start == meta.Start && end == meta.End)
                {
                    out_.Add(meta);
                }
                else if (end - start >= shortest)
                {
                    out_.Add(new MetaAction(meta.Request, start, end, meta.Part, meta.Written));
                    if (end < meta.End && beside != null)
                    {
                        reports.Add(Told(
                            meta,
                            "cut",
                            "is cut at " + PlainText.Fixed(end, 2) + " s for '" + beside.Request.Id + "', which is asked for",
                            true
                        ));
                    }
                }
                else
                {
                    var words = beside != null ? NoTime(beside) : "no time left beside what plays";
                    reports.Add(Told(meta, "covered", words));
                }
            }
            return (out_, reports);
        }

        /// <summary>Return the sort key that decides which is placed first.</summary>
        private static (double, int, string, int) Order(MetaAction meta)
        {
            return (meta.Start, -meta.Request.Priority, meta.Request.Id, meta.Part);
        }

        private static (List<MetaAction>, List<Report>) Placed(List<MetaAction> metas, PlannerSettings settings)
        {
            var queue = PlainLists.By(metas, item => Order(item));
            var at = 0; // what is before it was looked at
            var placed = new List<MetaAction>();
            var reports = new List<Report>();
            while (at < queue.Count)
            {
                var meta = queue[at];
                at += 1;
                var last = placed.Count > 0 ? placed[placed.Count - 1] : null;
                if (last == null || last.End <= meta.Start)
                {
                    placed.Add(meta);
                    continue;
                }
                if (meta.Request.Priority > last.Request.Priority)
                {
                    placed.RemoveAt(placed.Count - 1);
                    var kept = meta.Start - last.Start >= settings.Shortest;
                    if (kept)
                    {
                        placed.Add(new MetaAction(last.Request, last.Start, meta.Start, last.Part, last.Written));
                    }
                    // What was never begun goes on as itself, so that its draws stay the same.
                    var rest = new MetaAction(last.Request, meta.End, last.End, kept ? last.Part + 1 : last.Part, last.Written);
                    var resumes = last.Request.Resume && rest.End - rest.Start >= settings.Shortest;
                    if (resumes)
                    {
                        PlainLists.Insert(queue, rest, at, item => Order(item));
                    }
                    var word = kept ? "is cut" : "gives way";
                    var after = resumes ? " and goes on at " + PlainText.Fixed(meta.End, 2) + " s" : "";
                    var outcome = resumes ? "resumed" : kept ? "cut" : "covered";
                    var message = word
                        + " at "
                        + PlainText.Fixed(meta.Start, 2)
                        + " s for '"
                        + meta.Request.Id
                        + "', which is more important"
                        + after;
                    reports.Add(Told(last, outcome, message, kept || resumes));
                    // it may reach back over what was placed before, too
                    PlainLists.Insert(queue, meta, at, item => Order(item));
                }
                else if (meta.Request.Late != null)
                {
                    PlainLists.Insert(queue, After(meta, last.End), at, item => Order(item));
                }
                else if (last.End - meta.Request.Start > settings.Wait)
                {
                    reports.Add(Told(meta, "covered", NoTime(last)));
                }
                else
                {
                    PlainLists.Insert(queue, After(meta, last.End), at, item => Order(item));
                    reports.Add(Told(
                        meta,
                        "late",
                        "waits " + PlainText.Fixed(last.End - meta.Request.Start, 2) + " s for '" + last.Request.Id + "'",
                        true
                    ));
                }
            }
            return (placed, reports);
        }

        /// <summary>Return a meta action that begins at `free` instead.</summary>
        private static MetaAction After(MetaAction meta, double free)
        {
            return new MetaAction(meta.Request, free, free + (meta.End - meta.Start), meta.Part, meta.Written);
        }

        private static string NoTime(MetaAction other)
        {
            return "no time left beside '"
                + other.Request.Id
                + "' ("
                + PlainText.Fixed(other.Start, 2)
                + "-"
                + PlainText.Fixed(other.End, 2)
                + " s)";
        }

        private static Report Told(MetaAction meta, string outcome, string message, bool played = false)
        {
            return new Report(meta.Request.Id, outcome, message, meta.Request.Layer, meta.Start, played, meta.Written);
        }
    }
}
