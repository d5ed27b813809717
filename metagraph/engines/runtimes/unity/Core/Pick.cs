using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>From a meta plan to specific actions: one layer being planned, cue after cue. Nothing of it leaves the planner.</summary>
    internal sealed partial class Performer
    {
        public const double Fits = 1e-6; // seconds by which sums of times may be off

        /// <summary>How an action would play: from Start on, Length seconds, at least Shortest; the rest as in a cue.</summary>
        private struct Shape
        {
            public double Start, Entry, Length, Shortest, HoldFrom, HoldTo, Hold;
        }

        public readonly List<Cue> Cues = new List<Cue>();
        public readonly List<Report> Reports = new List<Report>();
        public List<Rest> Rests = new List<Rest>();
        public HashSet<string> Begun = new HashSet<string>(); // keys of meta actions whose chain of transitions plays already
        private readonly PlannerSettings settings;
        private readonly LayerGraph graph;
        private readonly uint seed;
        private readonly Past past; // how often actions were used, lately, and until when; where the layer is and since when

        /// <summary>The performer that stands where cues have been played after a past.</summary>
        public Performer(PlannerSettings settings, LayerGraph graph, uint seed, string begin, Past past, IEnumerable<Cue> cues)
        {
            this.settings = settings;
            this.graph = graph;
            this.seed = seed;
            this.past = past.Copy();
            this.past.Stance = graph.HasStance(past.Stance) ? past.Stance : begin;
            foreach (Cue cue in cues)
            {
                Note(cue, graph.HasStance(cue.Then) ? cue.Then : begin);
            }
        }

        /// <summary>When the layer is free again.</summary>
        public double Free
        {
            get { return past.Free; }
            set { past.Free = value; }
        }

        /// <summary>When the next action may begin at the earliest.</summary>
        public double Ready
        {
            get { return past.Free + (past.Ended.Count > 0 ? settings.Rest : 0.0); }
        }

        private void Note(Cue cue, string then)
        {
            Cues.Add(cue);
            past.Free = cue.End;
            past.Stance = then;
            past.Remember(cue);
        }

        /// <summary>Lay the first loop down; whether the layer can perform at all.</summary>
        public bool Begin(string stance)
        {
            GraphAction loop = Loop(stance, "rest/" + graph.Layer);
            if (loop != null)
            {
                Rests.Add(new Rest(stance, loop, 0.0, 0.0, 0.0));
            }
            return loop != null;
        }

        /// <summary>Realise what starts before `end` of a conflict-free meta plan, in order.</summary>
        public void Perform(List<MetaAction> metas, double end)
        {
            double[] limits = new double[metas.Count], wishes = new double[metas.Count];
            Bounds(metas, limits, wishes);
            for (int n = 0; n < metas.Count && metas[n].Start < end; n++)
            {
                MetaAction meta = metas[n];
                if (meta.End <= Ready + Fits && meta.Start < Ready && !Begun.Contains(meta.Key))
                {
                    string running = Cues.Count > 0 ? "'" + Cues[Cues.Count - 1].Action.Name + "'" : "the running action";
                    double waits = Ready - meta.Request.Start;
                    // What is wanted for a certain time is over; what is wanted once may come late.
                    if (meta.Written || meta.Request.Duration != null || waits > settings.Wait)
                    {
                        Tell(meta, "covered", "wholly covered by " + running + ", which plays until " + Basics.Words(Free) + " s");
                        continue;
                    }
                    Tell(meta, "queued", "waits " + Basics.Words(waits) + " s for " + running, true);
                }
                Realise(meta, Math.Max(Ready, meta.Start), limits[n], wishes[n]);
            }
        }

        /// <summary>For each meta action: when the next more important one begins, and the next as important that was asked for.</summary>
        private static void Bounds(List<MetaAction> metas, double[] limits, double[] wishes)
        {
            var first = new List<MetaAction>(); // the next of each rank
            for (int n = metas.Count - 1; n >= 0; n--)
            {
                MetaAction meta = metas[n];
                limits[n] = wishes[n] = double.PositiveInfinity;
                foreach (MetaAction other in first)
                {
                    limits[n] = other.Rank > meta.Rank ? Math.Min(limits[n], other.Start) : limits[n];
                    wishes[n] = other.Rank >= meta.Rank && !other.Written ? Math.Min(wishes[n], other.Start) : wishes[n];
                }
                first.RemoveAll(other => other.Rank == meta.Rank);
                first.Add(meta);
            }
        }

        private void Realise(MetaAction meta, double now, double limit, double wish)
        {
            List<Step> steps = Steps(meta);
            if (steps == null)
            {
                return;
            }
            var cues = new List<Cue>();
            string stance = past.Stance;
            foreach (Step step in steps)
            {
                MetaRequest asked = step.Hop != null ? null : meta.Request;
                List<GraphAction> fitting = step.Candidates;
                if (limit < double.PositiveInfinity)
                {
                    fitting = fitting.FindAll(a => EndsBy(ShapeOf(a, asked, now), limit));
                }
                if (fitting.Count == 0)
                {
                    string before = meta.Written ? "" : " before something more important";
                    Tell(meta, "no-room", "nothing fits into the " + Basics.Words(Math.Max(0.0, limit - now)) + " s" + before);
                    return;
                }
                if (step.Hop == null && meta.Request.Action == null)
                {
                    List<GraphAction> warm = fitting.FindAll(a => a.Cooldown <= 0 || Cooled(a) <= ShapeOf(a, asked, now).Start + Fits);
                    if (warm.Count == 0)
                    {
                        string soonest = Basics.Words(fitting.Min(a => Cooled(a)));
                        Tell(meta, "cooling", "all that fit are cooling down; the first may play again at " + soonest + " s");
                        return;
                    }
                    fitting = warm;
                }
                GraphAction action = Draw(fitting, step.Hop != null ? meta.Key + "/" + step.Hop : meta.Key, now);
                double until = Math.Min(limit, step.Hop != null ? double.PositiveInfinity : wish);
                Cue cue = CueOf(action, ShapeOf(action, asked, now), until, stance, meta.Key);
                cues.Add(cue);
                now = cue.End;
                stance = cue.Then;
            }
            cues.ForEach(Keep);
        }

        private static bool EndsBy(Shape shape, double limit)
        {
            return shape.Start + shape.Shortest <= limit + Fits;
        }

        /// <summary>When an action may be drawn again.</summary>
        private double Cooled(GraphAction action)
        {
            double ended;
            return action.Cooldown > 0 && past.Ended.TryGetValue(action.Id, out ended) ? ended + action.Cooldown : double.NegativeInfinity;
        }

        /// <summary>How an action would play for a request from `now` on, or, without one, as a step on the way to it.</summary>
        private Shape ShapeOf(GraphAction action, MetaRequest request, double now)
        {
            var shape = new Shape { Start = now, Entry = action.Start };
            bool special = request != null && (request.Hold != null || request.Stroke != null || !request.Prepare);
            if (special && action.Kind == "gesture")
            {
                Phases found = action.Phases;
                double latest = Math.Max(action.Start, found.Ready - Math.Max(action.BlendIn, settings.LeastBlend));
                shape.Entry = request.Prepare ? action.Start : latest;
                if (request.Stroke != null) // wait for the stroke, or catch up with it by cutting the preparation
                {
                    double stroke = request.Stroke.Value;
                    shape.Start = Math.Max(now, stroke - (found.Stroke - shape.Entry));
                    double late = found.Stroke - Math.Max(0.0, stroke - shape.Start);
                    shape.Entry = Math.Min(Math.Max(shape.Entry, late), Math.Max(shape.Entry, latest));
                }
                if (request.Hold != null)
                {
                    shape.HoldFrom = found.StrokeEnd;
                    shape.HoldTo = found.Relax;
                    shape.Hold = Math.Max(request.Hold.Value, (shape.HoldTo - shape.HoldFrom) / settings.Hurry);
                    if (shape.Hold <= 0)
                    {
                        shape.HoldFrom = shape.HoldTo = 0.0;
                    }
                }
            }
            double longer = shape.Hold - (shape.HoldTo - shape.HoldFrom);
            shape.Length = shape.Shortest = action.End - shape.Entry + shape.Hold - (shape.HoldTo - shape.HoldFrom);
            if (action.EarliestExit != null)
            {
                double exit = action.EarliestExit.Value;
                double left = exit - shape.Entry + (exit >= shape.HoldTo ? longer : 0.0);
                shape.Shortest = Math.Min(shape.Length, Math.Max(0.0, left) + action.BlendOut);
            }
            return shape;
        }

        /// <summary>Draw with p_k ~ likelihood_k / max(c_k, 1), leaving out those used too recently while any others are left.</summary>
        private GraphAction Draw(List<GraphAction> candidates, string key, double now)
        {
            List<GraphAction> left = Spaced(candidates);
            return Picked(left, key, "action", a => a.Likelihood / Math.Max(Count(a.Id, now), 1.0));
        }

        /// <summary>One of some actions, drawn by weight; the first where none has any.</summary>
        private GraphAction Picked(List<GraphAction> actions, string key, string purpose, Func<GraphAction, double> weight)
        {
            Dictionary<string, double> weights = actions.ToDictionary(a => a.Id, weight);
            if (!weights.Values.Any(w => w > 0))
            {
                return actions.FirstOrDefault();
            }
            string chosen = ChoiceRules.Pick(seed, key, purpose, weights);
            return actions.Find(a => a.Id == chosen);
        }

        /// <summary>Leave out what needs more other actions before it plays again; where nothing is left, all need one less, etc.</summary>
        private List<GraphAction> Spaced(List<GraphAction> candidates)
        {
            List<string> before;
            if (candidates.Count < 2 || !past.Recent.TryGetValue(LayerGraph.Node(candidates[0].Stance, candidates[0].Kind), out before))
            {
                return candidates;
            }
            int usual = settings.NeverTwice ? 1 : 0;
            int most = candidates.Max(a => a.Spacing ?? usual);
            for (int less = 0; less <= most; less++)
            {
                List<GraphAction> left = candidates.FindAll(a => Since(before, a.Id) >= (a.Spacing ?? usual) - less);
                if (left.Count > 0)
                {
                    return left;
                }
            }
            return candidates;
        }

        /// <summary>How many draws came after an action's last.</summary>
        private static int Since(List<string> before, string id)
        {
            int place = before.LastIndexOf(id);
            return place < 0 ? Past.Remembered : before.Count - 1 - place;
        }

        /// <summary>Alpha times the uses of an action, over the settings' memory.</summary>
        private double Count(string id, double now)
        {
            int used = 0;
            if (settings.Memory <= 0)
            {
                past.Uses.TryGetValue(id, out used);
                return settings.Alpha * used;
            }
            for (int n = Cues.Count - 1; n >= 0 && Cues[n].Start >= now - settings.Memory; n--)
            {
                used += Cues[n].Action.Id == id ? 1 : 0;
            }
            return settings.Alpha * used;
        }

        /// <summary>The cue of an action; until: when it should be over, if it may be left early.</summary>
        private Cue CueOf(GraphAction action, Shape shape, double until, string stance, string meta)
        {
            double length = shape.Length;
            if (action.EarliestExit != null)
            {
                length = Math.Min(length, Math.Max(shape.Shortest, until - shape.Start));
            }
            double into = shape.Entry > action.Start ? Math.Max(action.BlendIn, settings.LeastBlend) : action.BlendIn;
            double blends = into + action.BlendOut;
            double squeeze = blends > 0 ? Math.Min(1.0, length / blends) : 1.0;
            return new Cue
            {
                Action = action, Start = shape.Start, End = shape.Start + length, Entry = shape.Entry, BlendIn = into * squeeze,
                BlendOut = action.BlendOut * squeeze, Stance = stance, Meta = meta,
                Then = action.Kind == "transition" && !string.IsNullOrEmpty(action.EndStance) ? action.EndStance : stance,
                HoldFrom = shape.HoldFrom, HoldTo = shape.HoldTo, Hold = shape.Hold,
            };
        }

        private void Keep(Cue cue)
        {
            Note(cue, cue.Then);
            GraphAction loop = Loop(cue.Then, cue.Meta);
            if (loop == null)
            {
                return;
            }
            // The loop begins anew under the action, so that the action's last pose meets the loop's first. Where the action leaves
            // joints alone the change shows, and takes its time: a transition all of its own.
            double begin = cue.Start + cue.BlendIn, until = cue.End - cue.BlendOut;
            double fade = Math.Max(0.0, until - begin);
            if (cue.Action.Limb != "both" || cue.Action.Joints.Length > 0)
            {
                fade = cue.Then != cue.Stance ? cue.End - cue.Start : Math.Min(settings.LoopFade, cue.End - cue.Start);
                begin = Math.Max(cue.Start, until - fade);
            }
            Rests.Add(new Rest(cue.Then, loop, until, begin, fade));
        }

        private GraphAction Loop(string stance, string key)
        {
            return Picked(graph.Of(stance, "stance"), key, "loop", a => a.Likelihood);
        }

        /// <summary>Where a stance has several loops, change between them in long rests, at a loop's end.</summary>
        public void VaryRests(double end)
        {
            var found = new List<Rest>();
            for (int place = 0; place < Rests.Count; place++)
            {
                Rest rest = Rests[place], current = rest;
                found.Add(rest);
                if (graph.Of(rest.Stance, "stance").Count < 2)
                {
                    continue;
                }
                double until = place + 1 < Rests.Count ? Rests[place + 1].FadeStart : end, change = rest.Start;
                while (true)
                {
                    change += Math.Max(1.0, current.Action.Length - current.Action.BlendIn);
                    if (change > until)
                    {
                        break;
                    }
                    GraphAction loop = Loop(rest.Stance, graph.Layer + "/" + Basics.ThreeDecimals(change));
                    if (loop != null && loop.Id != current.Action.Id)
                    {
                        current = new Rest(rest.Stance, loop, change, change - settings.LoopFade, settings.LoopFade);
                        found.Add(current);
                    }
                }
            }
            Rests = found;
        }

        private void Tell(MetaAction meta, string outcome, string message, bool played = false)
        {
            Reports.Add(new Report(meta.Request.Id, outcome, message, graph.Layer, meta.Start, played, meta.Written));
        }
    }
}
