// Translated from metagraph/playback/sampling.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>One action of a chain: who may play it, and for a transition on the way the stance it leads to.</summary>
    public sealed class SamplingStep
    {
        public readonly List<GraphAction> Candidates;
        public readonly string Hop;

        public SamplingStep(List<GraphAction> candidates, string hop = "")
        {
            Candidates = candidates;
            Hop = hop;
        }
    }

    /// <summary>
    /// How an action would play: from `start` on, `length` seconds, at least `shortest`; the rest as in a cue.
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

        public CueShape(
            double start,
            double entry,
            double length,
            double shortest,
            double holdFrom = 0.0,
            double holdTo = 0.0,
            double hold = 0.0
        )
        {
            Start = start;
            Entry = entry;
            Length = length;
            Shortest = shortest;
            HoldFrom = holdFrom;
            HoldTo = holdTo;
            Hold = hold;
        }
    }

    /// <summary>
    /// One layer being planned, cue after cue. Mutable while planning; nothing of it leaves the planner.
    ///
    /// uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun: keys of
    /// meta actions whose chain of transitions plays already.
    /// </summary>
    public sealed class Performer
    {
        public Graph Project;
        public LayerGraph Graph;
        public uint Seed;
        public string Stance;
        public double Free;
        public Dictionary<string, int> Uses;
        public Dictionary<string, List<string>> Recent;
        public Dictionary<string, double> Ended;
        public List<Cue> Cues;
        public List<Rest> Rests;
        public List<Report> Reports;
        public HashSet<string> Begun;

        public Performer(
            Graph project,
            LayerGraph graph,
            uint seed,
            string stance,
            double free = 0.0,
            Dictionary<string, int> uses = null,
            Dictionary<string, List<string>> recent = null,
            Dictionary<string, double> ended = null,
            List<Cue> cues = null,
            List<Rest> rests = null,
            List<Report> reports = null,
            HashSet<string> begun = null
        )
        {
            Project = project;
            Graph = graph;
            Seed = seed;
            Stance = stance;
            Free = free;
            Uses = uses ?? new Dictionary<string, int>();
            Recent = recent ?? new Dictionary<string, List<string>>();
            Ended = ended ?? new Dictionary<string, double>();
            Cues = cues ?? new List<Cue>();
            Rests = rests ?? new List<Rest>();
            Reports = reports ?? new List<Report>();
            Begun = begun ?? new HashSet<string>();
        }

        /// <summary>Take a cue as played.</summary>
        public void Note(Cue cue, string then)
        {
            Cues.Add(cue);
            Free = cue.End;
            Stance = then;
            RememberingRules.Remember(cue, Uses, Recent, Ended);
        }

        /// <summary>When the next action may begin at the earliest.</summary>
        public double Ready
        {
            get
            {
                return Free + (Ended.Count > 0 ? Project.Settings.Rest : 0.0);
            }
        }

        /// <summary>Lay the first loop down; return whether the layer can perform at all.</summary>
        public bool Begin(string stance)
        {
            var loop = Loop(stance, "rest/" + Graph.Layer);
            if (loop == null)
            {
                return false;
            }
            Rests.Add(new Rest(stance, loop, 0.0, 0.0, 0.0));
            return true;
        }

        /// <summary>Realise what starts before `end` of a conflict-free meta plan, in order.</summary>
        public void Perform(List<MetaAction> metas, double end)
        {
            foreach (Bound bound in BoundsRules.Bounds(metas))
            {
                var meta = bound.Meta;
                if (meta.Start >= end)
                {
                    return;
                }
                if (meta.End <= Ready + SamplingRules.Fits && meta.Start < Ready && !Begun.Contains(meta.Key))
                {
                    var running = "the running action";
                    if (Cues.Count > 0)
                    {
                        running = "'" + Cues[Cues.Count - 1].Action.Name + "'";
                    }
                    var waits = Ready - meta.Request.Start;
                    // What is wanted for a certain time is over; what is wanted once may come late.
                    if (meta.Written || meta.Request.Duration != null || waits > Project.Settings.Wait)
                    {
                        Tell(
                            meta,
                            "covered",
                            "wholly covered by " + running + ", which plays until " + PlainText.Fixed(Free, 2) + " s"
                        );
                        continue;
                    }
                    Tell(meta, "queued", "waits " + PlainText.Fixed(waits, 2) + " s for " + running, true);
                }
                Realise(meta, Math.Max(Ready, meta.Start), bound.Limit, bound.Wish);
            }
        }

        public void Realise(MetaAction meta, double now, double limit, double wish)
        {
            var steps = Steps(meta);
            if (steps == null)
            {
                return;
            }
            var cues = new List<Cue>();
            var stance = Stance;
            foreach (SamplingStep step in steps)
            {
                var hops = step.Hop != "";
                var asked = hops ? null : meta.Request;
                var fitting = step.Candidates.ToList();
                if (limit < double.PositiveInfinity) // else all fit
                {
                    fitting = step.Candidates.Where(a => Fits(Shape(a, asked, now), limit)).ToList();
                }
                if (fitting.Count == 0)
                {
                    var before = meta.Written ? "" : " before something more important";
                    Tell(
                        meta,
                        "no-room",
                        "nothing fits into the " + PlainText.Fixed(Math.Max(0.0, limit - now), 2) + " s" + before
                    );
                    return;
                }
                if (!hops && meta.Request.Action == null)
                {
                    var warm = fitting.Where(a => a.Cooldown <= 0
                        || Cooled(a) <= Shape(a, asked, now).Start + SamplingRules.Fits).ToList();
                    if (warm.Count == 0)
                    {
                        var soonest = PlainNumbers.MinOf(fitting.Select(a => Cooled(a)).ToList());
                        Tell(
                            meta,
                            "cooling",
                            "all that fit are cooling down; the first may play again at " + PlainText.Fixed(soonest, 2) + " s"
                        );
                        return;
                    }
                    fitting = warm;
                }
                var action = Draw(fitting, hops ? meta.Key + "/" + step.Hop : meta.Key, now);
                var shape = Shape(action, asked, now);
                var cue = Cue(action, shape, limit, hops ? double.PositiveInfinity : wish, stance, meta.Key);
                cues.Add(cue);
                now = cue.End;
                stance = cue.Then;
            }
            foreach (Cue one in cues)
            {
                Keep(one);
            }
        }

        /// <summary>Whether something that plays so is over by a limit.</summary>
        public bool Fits(CueShape shape, double limit)
        {
            return shape.Start + shape.Shortest <= limit + SamplingRules.Fits;
        }

        /// <summary>Return when an action may be drawn again.</summary>
        public double Cooled(GraphAction action)
        {
            if (action.Cooldown > 0 && Ended.ContainsKey(action.Id))
            {
                return Ended[action.Id] + action.Cooldown;
            }
            return double.NegativeInfinity;
        }

        /// <summary>
        /// Return each action in turn: the transitions to get there, then the action itself; None if impossible or needless.
        /// </summary>
        public List<SamplingStep> Steps(MetaAction meta)
        {
            var request = meta.Request;
            var graph = Graph;
            if (request.Action != null)
            {
                var action = PlainMaps.Get(graph.Actions, request.Action);
                if (action == null || !graph.Stances.ContainsKey(action.Stance))
                {
                    Tell(meta, "unknown-action", "there is no action '" + request.Action + "' in the " + graph.Layer + " layer");
                    return null;
                }
                if (action.Kind == "stance")
                {
                    return Way(meta, action.Stance);
                }
                if (!Arrives(action))
                {
                    Tell(meta, "no-stance", "'" + action.Name + "' ends in a stance that has no loop");
                    return null;
                }
                if (action.Stance == Stance)
                {
                    return new List<SamplingStep> { new SamplingStep(new List<GraphAction> { action }) };
                }
                var way = Way(meta, action.Stance);
                return way == null
                    ? null
                    : way.Concat(new List<SamplingStep> { new SamplingStep(new List<GraphAction> { action }) }).ToList();
            }
            if (request.Stance != null && new List<string> { "transition", "stance" }.Contains(request.Kind))
            {
                if (!graph.Stances.ContainsKey(request.Stance))
                {
                    Tell(meta, "no-stance", "there is no stance '" + request.Stance + "' in the " + graph.Layer + " layer");
                    return null;
                }
                return Way(meta, request.Stance);
            }
            var every = graph.Of(Stance, request.Kind).Where(a => Usable(a)).ToList();
            if (request.Among.Count > 0)
            {
                every = every.Where(a => request.Among.Contains(a.Id)).ToList();
            }
            var found = every;
            if (request.Tags.Count > 0)
            {
                found = every.Where(a => request.Tags.All(tag => a.Tags.Contains(tag))).ToList();
            }
            var exact = found;
            if (request.Limb != null)
            {
                exact = found.Where(a => a.Limb == request.Limb).ToList();
            }
            if (meta.Written) // the model's limb and tags are wishes, not orders, nor worth playing the same again
            {
                var again = PlainLists.Part(
                    PlainMaps.GetOr(Recent, RememberingRules.Node(Stance, request.Kind), new List<string>()),
                    -1
                );
                if (!exact.Any(a => !again.Contains(a.Id)))
                {
                    exact = found.Any(a => !again.Contains(a.Id)) ? found : every;
                }
            }
            if (exact.Count == 0)
            {
                var name = graph.Stances[Stance].Name;
                var asked = string.Join(" ", request.Tags.Concat(new List<string> { request.Kind }).ToList());
                if (request.Limb != null)
                {
                    asked = request.Limb + " " + asked;
                }
                if (found.Count > 0) // whose limb is a wish, too
                {
                    Tell(meta, "other-limb", "stance '" + name + "' has no " + asked + "; another will do", true);
                    return new List<SamplingStep> { new SamplingStep(found) };
                }
                var hint = meta.Written ? "" : Elsewhere(request);
                Tell(meta, "no-candidate", "stance '" + name + "' has no " + asked + hint);
                return null;
            }
            return new List<SamplingStep> { new SamplingStep(exact) };
        }

        public string Elsewhere(MetaRequest request)
        {
            foreach (GraphAction action in Graph.Actions.Values.ToList())
            {
                var fits = action.Kind == request.Kind
                    && request.Tags.All(tag => action.Tags.Contains(tag))
                    && (request.Limb == null || request.Limb == action.Limb);
                if (fits && Graph.Stances.ContainsKey(action.Stance))
                {
                    return "; there is one in '" + Graph.Stances[action.Stance].Name + "'";
                }
            }
            return "";
        }

        /// <summary>Return the transitions hop by hop from the current stance to `goal`.</summary>
        public List<SamplingStep> Way(MetaAction meta, string goal)
        {
            if (goal == Stance)
            {
                var name = Graph.Stances[goal].Name;
                Tell(meta, "already-there", "the layer is in '" + name + "' already", true);
                return null;
            }
            var stances = Chain(goal);
            if (stances.Count == 0)
            {
                var a = Graph.Stances[Stance].Name;
                var b = Graph.Stances[goal].Name;
                Tell(meta, "no-way", "no chain of transitions leads from '" + a + "' to '" + b + "'");
                return null;
            }
            var steps = new List<SamplingStep>();
            var at = Stance;
            foreach (string following in stances)
            {
                var hops = Graph.Of(at, "transition").Where(a => a.EndStance == following && Usable(a)).ToList();
                steps.Add(new SamplingStep(hops, following));
                at = following;
            }
            return steps;
        }

        /// <summary>
        /// Return the stances after the current one on the shortest way of transitions that can play, the goal last; none where
        /// there is no way. Among equally short ones that whose transitions were placed first.
        /// </summary>
        public List<string> Chain(string goal)
        {
            var before = new Dictionary<string, string> { { Stance, "" } };
            var queue = new List<string> { Stance };
            var at = 0; // what is before it was looked at
            while (at < queue.Count && !before.ContainsKey(goal))
            {
                var stance = queue[at];
                at += 1;
                foreach (GraphAction action in Graph.Of(stance, "transition"))
                {
                    var end = action.EndStance;
                    if (end == null || before.ContainsKey(end) || !Graph.Stances.ContainsKey(end))
                    {
                        continue;
                    }
                    if (Usable(action))
                    {
                        before[end] = stance;
                        queue.Add(end);
                    }
                }
            }
            var way = new List<string>();
            if (!before.ContainsKey(goal))
            {
                return way;
            }
            var step = goal;
            while (step != Stance)
            {
                way.Add(step);
                step = before[step];
            }
            return way.AsEnumerable().Reverse().ToList().ToList();
        }

        /// <summary>Whether an action leaves the layer in a stance that can rest.</summary>
        public bool Arrives(GraphAction action)
        {
            var end = action.EndStance;
            if (action.Kind != "transition")
            {
                return true;
            }
            return end != null && Graph.Stances.ContainsKey(end) && Graph.Of(end, "stance").Count > 0;
        }

        public bool Usable(GraphAction action)
        {
            return action.Likelihood > 0 && Arrives(action);
        }

        /// <summary>Return how an action would play for a request from `now` on, or as a step on the way to it.</summary>
        public CueShape Shape(GraphAction action, MetaRequest request, double now)
        {
            var both = Project.Span(action);
            double start = both.Item1;
            double end = both.Item2;
            var begin = now;
            var entry = start;
            var holdFrom = 0.0;
            var holdTo = 0.0;
            var hold = 0.0;
            if (request != null
                && action.Kind == "gesture"
                && (request.Hold != null || request.Stroke != null || !request.Prepare))
            {
                var found = PhasesRules.Phases(Project, action);
                var latest = found.Skip(action.Timing.BlendIn);
                entry = request.Prepare ? start : latest;
                // Wait for the stroke, or catch up with it by cutting the preparation.
                if (request.Stroke != null)
                {
                    begin = Math.Max(now, request.Stroke.Value - (found.Stroke - entry));
                    entry = Math.Min(
                        Math.Max(entry, found.Stroke - Math.Max(0.0, request.Stroke.Value - begin)),
                        Math.Max(entry, latest)
                    );
                }
                if (request.Hold != null)
                {
                    holdFrom = found.StrokeEnd;
                    holdTo = found.Relax;
                    hold = Math.Max(request.Hold.Value, (holdTo - holdFrom) / SamplingRules.Hurry);
                    if (hold <= 0)
                    {
                        holdFrom = 0.0;
                        holdTo = 0.0;
                    }
                }
            }
            var length = end - entry + hold - (holdTo - holdFrom);
            var shortest = length;
            var exitAt = action.Timing.EarliestExit;
            if (exitAt != null)
            {
                var left = exitAt.Value - entry + (exitAt.Value >= holdTo ? hold - (holdTo - holdFrom) : 0.0);
                shortest = Math.Min(length, Math.Max(0.0, left) + action.Timing.BlendOut);
            }
            return new CueShape(begin, entry, length, shortest, holdFrom, holdTo, hold);
        }

        /// <summary>
        /// Draw with p_k ~ likelihood_k / max(c_k, 1), leaving out those used too recently as long as any others are left.
        /// </summary>
        public GraphAction Draw(List<GraphAction> candidates, string key, double now)
        {
            var left = Spaced(candidates);
            var weights = left.Select(a => (a.Id, a.Likelihood / Math.Max(Count(a.Id, now), 1.0))).ToMap();
            if (!weights.Values.ToList().Any(w => w > 0))
            {
                return left[0];
            }
            var chosen = ChoiceRules.Pick(Seed, key, "action", weights);
            return left.Where(a => a.Id == chosen).First();
        }

        /// <summary>
        /// Leave out what needs more other actions before it plays again; where that leaves nothing, all need one less, and so
        /// on.
        /// </summary>
        public List<GraphAction> Spaced(List<GraphAction> candidates)
        {
            var default_ = Project.Settings.NeverTwice ? 1 : 0;
            var first = candidates[0];
            var before = PlainMaps.GetOr(Recent, RememberingRules.Node(first.Stance, first.Kind), new List<string>());
            if (candidates.Count < 2 || before.Count == 0)
            {
                return candidates;
            }
            // How many came after each.
            var since = before.Select((ident, place) => (ident, before.Count - 1 - place)).ToMap();
            var needs = candidates.Select(a => (a.Id, a.Spacing == null ? default_ : a.Spacing.Value)).ToMap();
            for (int less = 0; less < PlainNumbers.MaxOf(candidates.Select(a => needs[a.Id]).ToList()) + 1; less++)
            {
                var left = candidates.Where(a => PlainMaps.GetOr(since, a.Id, RememberingRules.Remembered)
                    >= needs[a.Id] - less).ToList();
                if (left.Count > 0)
                {
                    return left;
                }
            }
            return candidates;
        }

        /// <summary>Return c_k of section 6.2, alpha times the uses, over the settings' memory.</summary>
        public double Count(string ident, double now)
        {
            var memory = Project.Settings.Memory;
            var alpha = Project.Settings.Alpha;
            if (memory <= 0)
            {
                return alpha * PlainMaps.GetOr(Uses, ident, 0);
            }
            var used = 0;
            foreach (Cue cue in Cues.AsEnumerable().Reverse().ToList())
            {
                if (cue.Start < now - memory)
                {
                    break;
                }
                if (cue.Action.Id == ident)
                {
                    used += 1;
                }
            }
            return alpha * used;
        }

        public Cue Cue(GraphAction action, CueShape shape, double limit, double wish, string stance, string meta)
        {
            var length = shape.Length;
            if (action.Timing.EarliestExit != null)
            {
                length = Math.Min(length, Math.Max(shape.Shortest, Math.Min(limit, wish) - shape.Start));
            }
            var into = Math.Max(0.0, action.Timing.BlendIn);
            var out_ = Math.Max(0.0, action.Timing.BlendOut);
            if (shape.Entry > Project.Span(action).Item1)
            {
                into = Math.Max(into, PhaseTimesRules.LeastBlend);
            }
            var squeeze = into + out_ > 0 ? Math.Min(1.0, length / (into + out_)) : 1.0;
            var then = stance;
            if (action.Kind == "transition" && action.EndStance != null)
            {
                then = action.EndStance;
            }
            var end = shape.Start + length;
            return new Cue(
                action,
                shape.Start,
                end,
                shape.Entry,
                into * squeeze,
                out_ * squeeze,
                stance,
                then,
                meta,
                shape.HoldFrom,
                shape.HoldTo,
                shape.Hold
            );
        }

        public void Keep(Cue cue)
        {
            Note(cue, cue.Then);
            var loop = Loop(cue.Then, cue.Meta);
            if (loop != null)
            {
                // The loop begins anew under the action, so that the action's last pose meets the loop's first.
                // Where the action leaves joints alone the change shows, and takes its time: a transition all of
                // its own.
                var partial = cue.Action.Limb != "both" || cue.Action.Joints.Count > 0;
                var begin = cue.Start + cue.BlendIn;
                var until = cue.End - cue.BlendOut;
                var fade = Math.Max(0.0, until - begin);
                if (partial)
                {
                    fade = cue.Then != cue.Stance ? cue.End - cue.Start : Math.Min(SamplingRules.LoopFade, cue.End - cue.Start);
                    begin = Math.Max(cue.Start, until - fade);
                }
                Rests.Add(new Rest(cue.Then, loop, until, begin, fade));
            }
        }

        /// <summary>Return one of a stance's loops, drawn by likelihood; None where it has none.</summary>
        public GraphAction Loop(string stance, string key)
        {
            var loops = Graph.Of(stance, "stance");
            var weights = loops.Where(a => a.Likelihood > 0).Select(a => (a.Id, a.Likelihood)).ToMap();
            if (weights.Count == 0)
            {
                return loops.Count > 0 ? loops[0] : null;
            }
            var chosen = ChoiceRules.Pick(Seed, key, "loop", weights);
            return loops.Where(a => a.Id == chosen).First();
        }

        /// <summary>Where a stance has several loops, change between them in long rests, at a loop's end.</summary>
        public void VaryRests(double end)
        {
            var out_ = new List<Rest>();
            foreach (var one in Rests.Select((item, n) => (n, item)))
            {
                var place = one.Item1;
                var rest = one.Item2;
                out_.Add(rest);
                var loops = Graph.Of(rest.Stance, "stance");
                if (loops.Count < 2)
                {
                    continue;
                }
                var until = place + 1 < Rests.Count ? Rests[place + 1].FadeStart : end;
                var current = rest;
                var change = rest.Start;
                while (true)
                {
                    var found = Project.Span(current.Action);
                    double start = found.Item1;
                    double stop = found.Item2;
                    change += Math.Max(1.0, stop - start - current.Action.Timing.BlendIn);
                    if (!(change <= until)) // nor when it is no number
                    {
                        break;
                    }
                    var loop = Loop(rest.Stance, Graph.Layer + "/" + PlainText.Fixed(change, 3));
                    if (loop != null && loop.Id != current.Action.Id)
                    {
                        current = new Rest(rest.Stance, loop, change, change - SamplingRules.LoopFade, SamplingRules.LoopFade);
                        out_.Add(current);
                    }
                }
            }
            Rests = out_;
        }

        public void Tell(MetaAction meta, string outcome, string message, bool played = false)
        {
            var layer = Graph.Layer;
            Reports.Add(new Report(meta.Request.Id, outcome, message, layer, meta.Start, played, meta.Written));
        }
    }

    public static class SamplingRules
    {
        public const double Fits = 1e-06; // seconds by which sums of times may be off
        public const double Hurry = 2.0; // a hold is played at most this many times as fast as it was made
        // seconds of crossfade when a long rest changes from one loop of its stance to another
        public const double LoopFade = 0.6;

        /// <summary>Return the performer that stands where cues have been played after a past.</summary>
        public static Performer PerformerAfter(
            Graph project,
            LayerGraph graph,
            uint seed,
            string begin,
            Past past,
            List<Cue> cues
        )
        {
            var stance = graph.Stances.ContainsKey(past.Stance) ? past.Stance : begin;
            var out_ = new Performer(
                project,
                graph,
                seed,
                stance,
                past.Free,
                new Dictionary<string, int>(past.Uses),
                new Dictionary<string, List<string>>(past.Recent),
                new Dictionary<string, double>(past.Ended)
            );
            foreach (Cue cue in cues)
            {
                out_.Note(cue, graph.Stances.ContainsKey(cue.Then) ? cue.Then : begin);
            }
            return out_;
        }
    }
}
