using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Temporal replanning: meta actions that may clash become a meta plan that does not. Greedy, by start time and then
    /// priority. Where two overlap, the more important one keeps its time; the other is delayed past it, or cut where it begins.
    /// </summary>
    internal static class Replan
    {
        /// <summary>Let new requests wait until `free` seconds, the end of the running action; what would wait too long is past.</summary>
        public static List<MetaAction> Delay(List<MetaAction> asked, double free, PlannerSettings settings, List<Report> reports)
        {
            var metas = new List<MetaAction>();
            foreach (MetaAction meta in asked)
            {
                double late = free - meta.Start;
                if (late <= 0)
                {
                    metas.Add(meta);
                }
                else if (late > settings.Wait)
                {
                    string when = Basics.Words(meta.Start) + " s, " + Basics.Words(late) + " s before anything could start";
                    reports.Add(Told(meta, "past", "asked for at " + when));
                }
                else
                {
                    metas.Add(meta.At(free, free + (meta.End - meta.Start)));
                    reports.Add(Told(meta, "late", "waits " + Basics.Words(late) + " s for the running action", true));
                }
            }
            return metas;
        }

        /// <summary>
        /// The meta plan, ascending and without overlaps. What is asked for is placed first; what a model wrote fits into the gaps,
        /// from `busy` seconds on. Meta actions that do not overlap come back as they are.
        /// </summary>
        public static List<MetaAction> Place(IEnumerable<MetaAction> metas, PlannerSettings settings, double busy, List<Report> reports)
        {
            List<MetaAction> every = metas.ToList();
            List<MetaAction> placed = Placed(every.Where(m => !m.Written), settings, reports);
            List<MetaAction> written = Fitted(every.Where(m => m.Written), placed, settings.Shortest, busy, reports);
            return placed.Concat(written).OrderBy(m => m.Start).ThenBy(m => m.End).ToList();
        }

        /// <summary>What is left of what a model wrote beside what is placed: the first stretch of each that is long enough.</summary>
        private static List<MetaAction> Fitted(
            IEnumerable<MetaAction> written, List<MetaAction> placed, double shortest, double busy, List<Report> reports)
        {
            var found = new List<MetaAction>();
            var sorted = written.ToList();
            foreach (MetaAction meta in sorted.OrderBy(m => m.Start).ThenBy(m => m.Request.Id, Comparer<string>.Create(Basics.Compare)))
            {
                double start = Math.Max(meta.Start, Math.Max(busy, found.Count > 0 ? found[found.Count - 1].End : busy));
                double end = meta.End;
                MetaAction beside = null;
                for (int n = Math.Max(0, Basics.BisectRight(placed, start, m => m.Start) - 1); n < placed.Count; n++)
                {
                    MetaAction other = placed[n];
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
                    found.Add(meta);
                }
                else if (end - start >= shortest)
                {
                    found.Add(meta.At(start, end));
                    if (end < meta.End && beside != null)
                    {
                        string why = " s for '" + beside.Request.Id + "', which is asked for";
                        reports.Add(Told(meta, "cut", "is cut at " + Basics.Words(end) + why, true));
                    }
                }
                else
                {
                    reports.Add(Told(meta, "covered", beside != null ? NoTime(beside) : "no time left beside what plays"));
                }
            }
            return found;
        }

        private static List<MetaAction> Placed(IEnumerable<MetaAction> metas, PlannerSettings settings, List<Report> reports)
        {
            var queue = new List<MetaAction>(); // the next at the end
            foreach (MetaAction meta in metas)
            {
                Push(queue, meta);
            }
            var placed = new List<MetaAction>();
            while (queue.Count > 0)
            {
                MetaAction meta = queue[queue.Count - 1];
                queue.RemoveAt(queue.Count - 1);
                MetaAction last = placed.Count > 0 ? placed[placed.Count - 1] : null;
                if (last == null || last.End <= meta.Start)
                {
                    placed.Add(meta);
                    continue;
                }
                if (meta.Request.Priority > last.Request.Priority)
                {
                    placed.RemoveAt(placed.Count - 1);
                    bool kept = meta.Start - last.Start >= settings.Shortest;
                    if (kept)
                    {
                        placed.Add(last.At(last.Start, meta.Start));
                    }
                    // What was never begun goes on as itself, so that its draws stay the same.
                    var rest = new MetaAction(last.Request, meta.End, last.End, kept ? last.Part + 1 : last.Part, last.Written);
                    bool resumes = last.Request.Resume && rest.End - rest.Start >= settings.Shortest;
                    if (resumes)
                    {
                        Push(queue, rest);
                    }
                    string outcome = resumes ? "resumed" : kept ? "cut" : "covered";
                    string why = " s for '" + meta.Request.Id + "', which is more important";
                    string after = resumes ? " and goes on at " + Basics.Words(meta.End) + " s" : "";
                    string message = (kept ? "is cut at " : "gives way at ") + Basics.Words(meta.Start) + why + after;
                    reports.Add(Told(last, outcome, message, kept || resumes));
                    Push(queue, meta); // it may reach back over what was placed before, too
                }
                else if (last.End - meta.Request.Start > settings.Wait)
                {
                    reports.Add(Told(meta, "covered", NoTime(last)));
                }
                else
                {
                    Push(queue, meta.At(last.End, last.End + (meta.End - meta.Start)));
                    string waits = "waits " + Basics.Words(last.End - meta.Request.Start) + " s for '" + last.Request.Id + "'";
                    reports.Add(Told(meta, "late", waits, true));
                }
            }
            return placed;
        }

        /// <summary>Put a meta action in line: by start, priority, id and part; of equals the first come first.</summary>
        private static void Push(List<MetaAction> queue, MetaAction meta)
        {
            int low = 0, high = queue.Count;
            while (low < high)
            {
                int middle = (low + high) / 2;
                if (Order(queue[middle], meta) > 0)
                {
                    low = middle + 1;
                }
                else
                {
                    high = middle;
                }
            }
            queue.Insert(low, meta);
        }

        private static int Order(MetaAction a, MetaAction b)
        {
            int order = a.Start.CompareTo(b.Start);
            order = order != 0 ? order : b.Request.Priority.CompareTo(a.Request.Priority);
            order = order != 0 ? order : Basics.Compare(a.Request.Id, b.Request.Id);
            return order != 0 ? order : a.Part.CompareTo(b.Part);
        }

        private static string NoTime(MetaAction other)
        {
            return "no time left beside '" + other.Request.Id + "' (" + Basics.Words(other.Start) + "-" + Basics.Words(other.End) + " s)";
        }

        private static Report Told(MetaAction meta, string outcome, string message, bool played = false)
        {
            return new Report
            {
                Request = meta.Request.Id, Outcome = outcome, Message = message, Layer = meta.Request.Layer, At = meta.Start,
                Played = played,
            };
        }
    }
}
