// Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
    /// </summary>
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
    /// One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
    ///
    /// uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun: keys of
    /// meta actions whose chain of transitions already plays. served: keys of those that the action of another one serves, too.
    /// moods: the mood over time. candidates: the actions of each `node` that may be drawn, for the nodes needed so far.
    /// prominences: of actions, as far as needed. acted: when the last action ended. track: what lasts. model: the one that wrote
    /// what was not requested, None if there is none. beats: seconds after which a gesture that hardly shows may be done again.
    /// </summary>
    public sealed class Performer
    {
        public Graph Project;
        public LayerGraph Graph;
        public uint Seed;
        public string Stance;
        public Moods Moods;
        public Track Track;
        public double Free;
        public double Acted;
        public Dictionary<string, int> Uses;
        public Dictionary<string, List<string>> Recent;
        public Dictionary<string, double> Ended;
        public List<Cue> Cues;
        public List<Rest> Rests;
        public List<Report> Reports;
        public HashSet<string> Begun;
        public HashSet<string> Served;
        public Dictionary<string, List<GraphAction>> Candidates;
        public Dictionary<string, double> Prominences;
        public Markov Model;
        public double Beats;

        public Performer(
            Graph project,
            LayerGraph graph,
            uint seed,
            string stance,
            Moods moods,
            Track track,
            double free = 0.0,
            double acted = 0.0,
            Dictionary<string, int> uses = null,
            Dictionary<string, List<string>> recent = null,
            Dictionary<string, double> ended = null,
            List<Cue> cues = null,
            List<Rest> rests = null,
            List<Report> reports = null,
            HashSet<string> begun = null,
            HashSet<string> served = null,
            Dictionary<string, List<GraphAction>> candidates = null,
            Dictionary<string, double> prominences = null,
            Markov model = null,
            double beats = DirectorRules.LeastBeats
        )
        {
            Project = project;
            Graph = graph;
            Seed = seed;
            Stance = stance;
            Moods = moods;
            Track = track;
            Free = free;
            Acted = acted;
            Uses = uses ?? new Dictionary<string, int>();
            Recent = recent ?? new Dictionary<string, List<string>>();
            Ended = ended ?? new Dictionary<string, double>();
            Cues = cues ?? new List<Cue>();
            Rests = rests ?? new List<Rest>();
            Reports = reports ?? new List<Report>();
            Begun = begun ?? new HashSet<string>();
            Served = served ?? new HashSet<string>();
            Candidates = candidates ?? new Dictionary<string, List<GraphAction>>();
            Prominences = prominences ?? new Dictionary<string, double>();
            Model = model;
            Beats = beats;
        }

        /// <summary>Note that a cue is played.</summary>
        public void Note(Cue cue, string then)
        {
            Cues.Add(cue);
            Free = cue.End;
            Acted = cue.End;
            Stance = then;
            RememberingRules.Remember(cue, Uses, Recent, Ended);
        }

        /// <summary>The earliest time at which the next action may begin.</summary>
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

        /// <summary>Realise in order those meta actions of a conflict-free meta plan that start before `end`.</summary>
        public void Perform(List<MetaAction> metas, double end)
        {
            var performed = metas.Where(m => !m.Written || Performs(m, m.Start)).ToList();
            foreach (Bound bound in BoundsRules.Bounds(performed))
            {
                var meta = bound.Meta;
                if (BoundsRules.Begins(meta) >= end)
                {
                    continue;
                }
                if (Served.Count > 0 && Served.Contains(meta.Key))
                {
                    continue;
                }
                if (meta.Request.Late != null)
                {
                    Realise(bound, Math.Max(Ready, BoundsRules.Begins(meta)));
                    continue;
                }
                var ready = Ready;
                if (meta.Start < ready && !Begun.Contains(meta.Key))
                {
                    var running = "the running action";
                    if (Cues.Count > 0)
                    {
                        running = "'" + Cues[Cues.Count - 1].Action.Name + "'";
                    }
                    var waits = ready - meta.Start;
                    if (meta.End <= ready + CueShapesRules.Fits)
                    {
                        waits = ready - meta.Request.Start;
                        // What is wanted for a certain time is over; what is wanted once may come late.
                        var wanted = meta.Written || meta.Request.Duration != null;
                        if (wanted || waits > Project.Settings.Wait)
                        {
                            var why = "wholly covered by " + running + ", which plays until " + PlainText.Fixed(Free, 2) + " s";
                            Tell(meta, "covered", why);
                            continue;
                        }
                    }
                    // What a model wrote is wanted at no certain time.
                    if (!meta.Written && waits > SamplingRules.OnTime)
                    {
                        Tell(meta, "queued", "waits " + PlainText.Fixed(waits, 2) + " s for " + running, true);
                    }
                }
                Realise(bound, Math.Max(ready, meta.Start));
            }
        }

        public void Realise(Bound bound, double now)
        {
            var meta = bound.Meta;
            var limit = bound.Limit;
            if (meta.Written && !Begun.Contains(meta.Key) && !MayBegin(meta, now))
            {
                return;
            }
            var steps = Steps(meta, now);
            if (steps == null)
            {
                return;
            }
            var cues = new List<Cue>();
            var stance = Stance;
            foreach (SamplingStep step in steps)
            {
                var hops = step.Hop != "";
                var asked = hops ? null : CueShapesRules.Remaining(meta, now);
                var mood = Mood(asked, now);
                var fitting = step.Candidates.ToList();
                if (limit < double.PositiveInfinity) // else all fit
                {
                    fitting = step.Candidates.Where(a => CueShapesRules.FitsBefore(Shape(a, asked, now, mood), limit)).ToList();
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
                        || Cooled(a) <= Shape(a, asked, now, mood).Start + CueShapesRules.Fits).ToList();
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
                // On the way to a stance it counts when that begins.
                if (meta.Request.Late != null && (!hops || (cues.Count == 0 && steps[steps.Count - 1].Hop != "")))
                {
                    fitting = Timely(bound, fitting, now);
                    if (fitting.Count == 0)
                    {
                        return;
                    }
                }
                var action = Draw(fitting, hops ? meta.Key + "/" + step.Hop : meta.Key, now, mood);
                var shape = Shape(action, asked, now, mood);
                var cue = Cue(action, shape, bound, hops, stance, mood);
                cues.Add(cue);
                now = cue.End;
                stance = cue.Then;
            }
            foreach (Cue one in cues)
            {
                Keep(one);
            }
        }

        /// <summary>
        /// Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as
        /// mode and mood say. Anything may begin a long thought, or end it.
        /// </summary>
        public bool Performs(MetaAction meta, double now)
        {
            if (!MoodRules.Stirs(MoodRules.MoodAt(Moods, now), Seed, meta.Request.Id))
            {
                return false;
            }
            if (meta.Request.Kind == "transition" && Track.StaysAt(Graph.Layer, now))
            {
                return false;
            }
            if (Model == null || Muses(now) || HasMused(now))
            {
                return true;
            }
            return MarkovRules.Performs(Model, Seed, meta, WantedRules.ModeAt(Track, now));
        }

        /// <summary>
        /// Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
        /// interruption, and nothing that would end a thought.
        /// </summary>
        public bool MayBegin(MetaAction meta, double now)
        {
            if (Track.HushedAt(now) || !Performs(meta, now))
            {
                return false;
            }
            if (Model == null || Leads(now) != "")
            {
                return true;
            }
            if (Lulls(now))
            {
                return false;
            }
            var there = Stance == DirectorRules.Musing(Graph.Stances);
            if (there && meta.Request.Kind == "transition" && Muses(now))
            {
                return false;
            }
            return MarkovRules.Performs(Model, Seed, meta, WantedRules.ModeAt(Track, now));
        }

        /// <summary>
        /// Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare
        /// anyway.
        /// </summary>
        public bool Lulls(double now)
        {
            var variety = Project.Settings.Variety;
            if (Graph.Layer != "arms" || variety <= 0 || Cues.Count == 0 || HasMused(now))
            {
                return false;
            }
            var last = Cues[Cues.Count - 1];
            var mode = WantedRules.ModeAt(Track, now);
            if (now >= last.End + DirectorRules.MostLull || mode == "thinking")
            {
                return false;
            }
            var talks = mode == "talking";
            if (talks && last.Action.Kind == "transition") // it opens a burst
            {
                return false;
            }
            return now < last.End + DirectorRules.FindLull(Seed, last.Meta, talks, variety);
        }

        /// <summary>Return whether the arms take or keep the stance in which the character thinks.</summary>
        public bool Muses(double now)
        {
            if (WantedRules.ModeAt(Track, now) != "thinking"
                || WantedRules.ModeAt(Track, now + DirectorRules.Muses) != "thinking")
            {
                return false;
            }
            if (Graph.Layer != "arms" || Project.Settings.Variety <= 0)
            {
                return false;
            }
            return !Track.StaysAt("arms", now) && DirectorRules.Musing(Graph.Stances) != "";
        }

        /// <summary>Return whether a thought of the character has ended just now.</summary>
        public bool HasMused(double now)
        {
            if (Graph.Layer != "arms" || WantedRules.ModeAt(Track, now) == "thinking")
            {
                return false;
            }
            return Project.Settings.Variety > 0 && WantedRules.ModeAt(Track, now - DirectorRules.Mused) == "thinking";
        }

        /// <summary>
        /// Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there
        /// home as soon as the thought is over; "" for none.
        /// </summary>
        public string Leads(double now)
        {
            if (Graph.Layer != "arms" || Project.Settings.Variety <= 0)
            {
                return "";
            }
            var muses = DirectorRules.Musing(Graph.Stances);
            if (muses == "" || Track.StaysAt("arms", now))
            {
                return "";
            }
            var home = Graph.Start;
            var goal = "";
            if (Muses(now))
            {
                goal = muses;
            }
            else if (Stance == muses && home != null && WantedRules.ModeAt(Track, now) != "thinking")
            {
                var came = Moved();
                if (came >= 0 && WantedRules.ModeAt(Track, came) == "thinking")
                {
                    goal = home;
                }
            }
            if (goal == Stance || goal == "" || Chain(goal).Count == 0)
            {
                return "";
            }
            return goal;
        }

        /// <summary>
        /// Return the candidates that come least late, if that is not too late; among them those that leave the following
        /// requests the most time and serve the most of them.
        /// </summary>
        public List<GraphAction> Timely(Bound bound, List<GraphAction> fitting, double now)
        {
            var meta = bound.Meta;
            var request = meta.Request;
            var allowed = CueShapesRules.SlackOf(request);
            var mood = Mood(request, now);
            var late = fitting.Select(a => (
                a.Id,
                CueShapesRules.Lateness(Project, a, request, Shape(a, request, now, mood))
            )).ToMap();
            var least = PlainNumbers.MinOf(fitting.Select(a => late[a.Id]).ToList());
            string waits = default(string);
            if (least > allowed + CueShapesRules.Fits)
            {
                waits = Cause(request, now);
                Tell(
                    meta,
                    "too-late",
                    "would come "
                        + PlainText.Fixed(least, 2)
                        + " s late, "
                        + PlainText.Fixed(allowed, 2)
                        + " s are allowed; it waits for "
                        + waits,
                    false,
                    least
                );
                return new List<GraphAction>();
            }
            if (least > CueShapesRules.Fits)
            {
                waits = Cause(request, now);
                Tell(meta, "late", "comes " + PlainText.Fixed(least, 2) + " s late; it waits for " + waits, true, least);
            }
            var timely = fitting.Where(a => late[a.Id] <= Math.Max(least, 0.0) + CueShapesRules.Fits).ToList();
            foreach (MetaAction other in bound.After)
            {
                if (!CueShapesRules.MayShare(request, other.Request))
                {
                    continue;
                }
                var both = timely.Where(a => CueShapesRules.Meets(a, other.Request)).ToList();
                var behind = 0.0;
                if (request.Stroke != null && other.Request.Stroke != null)
                {
                    behind = Math.Max(0.0, request.Stroke.Value + Math.Max(least, 0.0) - other.Request.Stroke.Value);
                }
                if (both.Count > 0 && other.Request.Late != null && behind <= other.Request.Late.Value + CueShapesRules.Fits)
                {
                    timely = both;
                    Served.Add(other.Key);
                    var message = "shares the stroke of '" + request.Id + "'";
                    Tell(other, "shared", message, true, behind, meta.Key);
                }
            }
            var following = bound.After.Where(other => !Served.Contains(other.Key)).ToList();
            foreach (MetaAction other in following)
            {
                foreach (double slack in new List<double> { 0.0, CueShapesRules.SlackOf(other.Request) })
                {
                    var by = Latest(other.Request) + slack;
                    var over = timely.Where(a => Over(a, request, now) <= by).ToList();
                    if (over.Count > 0)
                    {
                        return over;
                    }
                }
            }
            return timely;
        }

        /// <summary>Return the reason why a request comes late.</summary>
        public string Cause(MetaRequest request, double now)
        {
            if (now <= request.Start + CueShapesRules.Fits)
            {
                return "its own preparation";
            }
            if (Cues.Count > 0 && Ready >= now - CueShapesRules.Fits && Cues[Cues.Count - 1].End >= Free - CueShapesRules.Fits)
            {
                return "'" + Cues[Cues.Count - 1].Action.Name + "', which plays until " + PlainText.Fixed(Free, 2) + " s";
            }
            return Cues.Count > 0 ? "what comes before it" : "the time it became known at";
        }

        /// <summary>
        /// Return the latest time at which a requested action has to begin to be on time; never in the past.
        /// </summary>
        public double Latest(MetaRequest request)
        {
            if (request.Stroke == null)
            {
                return request.Start;
            }
            var least = double.PositiveInfinity;
            foreach (GraphAction action in Graph.Of(Stance, request.Kind))
            {
                var fits = CueShapesRules.Meets(action, request);
                if (request.Action != null)
                {
                    fits = action.Id == request.Action;
                }
                if (fits && Usable(action))
                {
                    var found = PhasesRules.FindPhases(Project, action);
                    var lead = found.Stroke - found.Skip(action.Timing.BlendIn);
                    var speed = Tempo(action, Mood(request, request.Stroke.Value));
                    least = Math.Min(least, lead + MoodRules.Drag(lead, speed));
                }
            }
            return request.Stroke.Value - least;
        }

        /// <summary>Return the earliest time at which the next action could begin after this one.</summary>
        public double Over(GraphAction action, MetaRequest request, double now)
        {
            var shape = Shape(action, request, now, Mood(request, now));
            return shape.Start + CueShapesRules.Hurried(Project, action, shape) + Project.Settings.Rest - CueShapesRules.Fits;
        }

        /// <summary>
        /// Return when an action that should play to its end is left early all the same: early enough for the first following
        /// request that can then be in time, late enough for its own stroke; infinity for never.
        /// </summary>
        public double Until(GraphAction action, CueShape shape, Bound bound)
        {
            if (bound.After.Count == 0)
            {
                return double.PositiveInfinity;
            }
            var rest = Project.Settings.Rest;
            var soonest = shape.Start + CueShapesRules.Hurried(Project, action, shape);
            foreach (MetaAction other in bound.After)
            {
                var inTime = Latest(other.Request) + CueShapesRules.SlackOf(other.Request);
                if (!Served.Contains(other.Key) && soonest + rest <= inTime + CueShapesRules.Fits)
                {
                    return Math.Max(soonest, BoundsRules.Begins(other) - rest);
                }
            }
            return double.PositiveInfinity;
        }

        /// <summary>
        /// Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that
        /// a model wrote, or that is less important, is left at once; others are left where their retraction begins.
        /// </summary>
        public void MakeWay(MetaAction running, List<MetaAction> asked, double now, bool stopped)
        {
            if (stopped)
            {
                Retract(now);
                return;
            }
            var cue = Cues[Cues.Count - 1];
            if (running == null || cue.Action.Kind == "transition" || cue.End - cue.BlendOut <= now)
            {
                return;
            }
            var atOnce = now + Math.Max(cue.BlendOut, CueShapesRules.Retraction);
            var retracts = atOnce;
            if (!running.Written)
            {
                var once = cue.End - cue.Start;
                if (cue.Repeats)
                {
                    once = Math.Min(
                        once,
                        (cue.CycleTo - cue.Entry) / cue.Tempo + Math.Max(cue.BlendOut, CueShapesRules.Retraction)
                    );
                }
                var shape = new CueShape(
                    cue.Start,
                    cue.Entry,
                    cue.End - cue.Start,
                    once,
                    cue.HoldFrom,
                    cue.HoldTo,
                    cue.Hold,
                    cue.Tempo
                );
                retracts = Math.Max(atOnce, cue.Start + CueShapesRules.Hurried(Project, cue.Action, shape));
            }
            var rest = Project.Settings.Rest;
            foreach (MetaAction meta in asked)
            {
                var request = meta.Request;
                var inTime = Latest(request) + CueShapesRules.SlackOf(request);
                var soonest = meta.Rank > running.Rank ? atOnce : retracts;
                if (request.Late == null || meta.Rank < running.Rank || inTime < soonest + rest - CueShapesRules.Fits)
                {
                    continue;
                }
                var end = Math.Max(soonest, BoundsRules.Begins(meta) - rest);
                if (end < cue.End)
                {
                    var out_ = Math.Max(cue.BlendOut, CueShapesRules.Retraction);
                    var into = Math.Min(cue.BlendIn, Math.Max(0.0, end - out_ - cue.Start));
                    Cues[Cues.Count - 1] = new Cue(
                        cue.Action,
                        cue.Start,
                        end,
                        cue.Entry,
                        into,
                        out_,
                        cue.Stance,
                        cue.Then,
                        cue.Meta,
                        cue.HoldFrom,
                        cue.HoldTo,
                        cue.Hold,
                        cue.Extent,
                        cue.Tempo,
                        cue.CycleFrom,
                        cue.CycleTo
                    );
                    Free = end;
                    Ended[cue.Action.Id] = end;
                }
                return;
            }
        }

        /// <summary>
        /// Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
        /// </summary>
        public void Retract(double now)
        {
            var cue = Cues[Cues.Count - 1];
            var end = now + CueShapesRules.Stopped;
            if (cue.Action.Kind == "transition" || cue.End - cue.BlendOut <= now || cue.End <= end)
            {
                return;
            }
            Cues[Cues.Count - 1] = new Cue(
                cue.Action,
                cue.Start,
                end,
                cue.Entry,
                cue.BlendIn,
                CueShapesRules.Stopped,
                cue.Stance,
                cue.Then,
                cue.Meta,
                cue.HoldFrom,
                cue.HoldTo,
                cue.Hold,
                cue.Extent,
                cue.Tempo,
                cue.CycleFrom,
                cue.CycleTo
            );
            Free = end;
            Ended[cue.Action.Id] = end;
        }

        /// <summary>Return the time from which an action may be drawn again.</summary>
        public double Cooled(GraphAction action)
        {
            if (action.Cooldown > 0 && Ended.ContainsKey(action.Id))
            {
                return Ended[action.Id] + action.Cooldown;
            }
            return double.NegativeInfinity;
        }

        /// <summary>
        /// Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not
        /// needed, or if the model wrote it and every candidate played too recently.
        /// </summary>
        public List<SamplingStep> Steps(MetaAction meta, double now)
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
            var leads = meta.Written ? Leads(now) : "";
            if (leads != "")
            {
                return Way(meta, leads);
            }
            var here = RememberingRules.Node(Stance, request.Kind);
            if (!Candidates.ContainsKey(here))
            {
                Candidates[here] = graph.Of(Stance, request.Kind).Where(a => Usable(a)).ToList();
            }
            var every = Candidates[here];
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
            var directed = meta.Written && Project.Settings.Variety > 0;
            if (directed) // the model's limb and tags are wishes, not orders
            {
                every = Fresh(meta, every, now);
                var fresh = new HashSet<string>(every.Select(a => a.Id));
                found = found.Where(a => fresh.Contains(a.Id)).ToList();
                exact = exact.Where(a => fresh.Contains(a.Id)).ToList();
                if (every.Count == 0)
                {
                    var moves = MovesOn(meta, now);
                    return moves.Count > 0 ? new List<SamplingStep> { new SamplingStep(moves) } : null;
                }
                if (exact.Count == 0)
                {
                    exact = found.Count > 0 ? found : every;
                }
            }
            else if (meta.Written) // nor worth playing the same again
            {
                var again = PlainLists.Part(PlainMaps.GetOr(Recent, here, new List<string>()), -1);
                if (!exact.Any(a => !again.Contains(a.Id)))
                {
                    exact = found.Any(a => !again.Contains(a.Id)) ? found : every;
                }
            }
            exact = Modest(meta, exact, now);
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
        /// Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if
        /// there is no way. Among equally short ways, the one whose transitions were placed first.
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

        /// <summary>Return whether an action leaves the layer in a stance that has a loop.</summary>
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
        public CueShape Shape(GraphAction action, MetaRequest request, double now, Mood mood)
        {
            return CueShapesRules.ShapeOf(Project, action, request, now, Tempo(action, mood));
        }

        /// <summary>Return the mood in which a request is played from `at` on, or at its stroke.</summary>
        public Mood Mood(MetaRequest request, double at)
        {
            if (request == null)
            {
                return MoodRules.MoodAt(Moods, at);
            }
            var mood = MoodRules.MoodAt(Moods, request.Stroke == null ? at : request.Stroke.Value);
            if (request.Valence == null && request.Arousal == null && request.Intensity == null)
            {
                return mood;
            }
            return MoodRules.Changed(mood, request.Valence, request.Arousal, request.Intensity);
        }

        /// <summary>Return the speed of an action in a mood, 1 if it was made for the mood.</summary>
        public double Tempo(GraphAction action, Mood mood)
        {
            return (mood.Neutral || MoodRules.MadeFor(mood, action.Tags)) ? 1.0 : MoodRules.Tempo(mood);
        }

        /// <summary>
        /// Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were
        /// made for the mood keep their extent.
        /// </summary>
        public double Extent(GraphAction action, Mood mood)
        {
            if (Graph.Layer == "body" || action.Kind == "transition" || mood.Neutral)
            {
                return 1.0;
            }
            return (action.Contacts.Count > 0 || action.Tags.Contains(MoodRules.Held) || MoodRules.MadeFor(mood, action.Tags))
                ? 1.0
                : MoodRules.Extent(mood);
        }

        /// <summary>
        /// Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left
        /// out as long as others are left.
        /// </summary>
        public GraphAction Draw(List<GraphAction> candidates, string key, double now, Mood mood)
        {
            var left = Spaced(candidates);
            if (left.Count == 1)
            {
                return left[0];
            }
            var neutral = mood.Neutral;
            var weights = new Dictionary<string, double>();
            foreach (GraphAction a in left)
            {
                var favoured = neutral ? 1.0 : MoodRules.Favour(mood, a.Tags, VigourRules.MeasureVigour(Project, a));
                var weight = a.Likelihood / Math.Max(Count(a.Id, now), 1.0) * favoured;
                weights[a.Id] = weight * Variety(a, now);
            }
            if (!weights.Values.ToList().Any(w => w > 0))
            {
                return left[0];
            }
            var chosen = ChoiceRules.Pick(Seed, key, "action", weights);
            return left.Where(a => a.Id == chosen).First();
        }

        /// <summary>Return the factor by which variety changes an action's likelihood.</summary>
        public double Variety(GraphAction action, double now)
        {
            var variety = Project.Settings.Variety;
            if (variety <= 0)
            {
                return 1.0;
            }
            if (action.Kind == "transition")
            {
                var talks = Graph.Layer == "arms" && WantedRules.ModeAt(Track, now) == "talking";
                return talks ? 1.0 + CountFresh(action.EndStance, now) : 1.0;
            }
            if (!Ended.ContainsKey(action.Id))
            {
                return 1.0;
            }
            var shows = Shows(action);
            var needed = DirectorRules.RepeatInterval(action.Kind, shows, Beats) * variety;
            return DirectorRules.Freshness(now - Ended[action.Id], needed);
        }

        /// <summary>Return how much an action stands out.</summary>
        public double Shows(GraphAction action)
        {
            if (!Prominences.ContainsKey(action.Id))
            {
                Prominences[action.Id] = ProminenceRules.MeasureProminence(Project, action);
            }
            return Prominences[action.Id];
        }

        /// <summary>Return the actions that the character may do by itself; see `director`.</summary>
        public List<GraphAction> Fresh(MetaAction meta, List<GraphAction> candidates, double now)
        {
            var variety = Project.Settings.Variety;
            var layer = Graph.Layer;
            if (meta.Request.Kind == "transition")
            {
                if (now < Moved() + DirectorRules.Posture(layer) * variety)
                {
                    return new List<GraphAction>();
                }
                if (layer == "arms" && now < Acted + DirectorRules.LeastLull * variety)
                {
                    return new List<GraphAction>();
                }
                if (layer != "head")
                {
                    return candidates.ToList();
                }
                if (Stance == Graph.Start)
                {
                    var leaves = ChoiceRules.Uniform(Seed, meta.Key, "leaves") < DirectorRules.LeavesHome;
                    return leaves ? candidates.ToList() : new List<GraphAction>();
                }
                var home = candidates.Where(a => a.EndStance == Graph.Start).ToList();
                var returns = home.Count > 0 && ChoiceRules.Uniform(Seed, meta.Key, "home") < DirectorRules.GoesHome;
                return returns ? home : candidates.ToList();
            }
            var share = now < Acted + DirectorRules.LongRest * variety ? variety : variety * DirectorRules.Shorter;
            var reminded = Shown(now - DirectorRules.Apart * variety);
            var converses = meta.Request.Kind == "fidget" && WantedRules.ModeAt(Track, now) != "idle";
            var out_ = new List<GraphAction>();
            foreach (GraphAction action in candidates)
            {
                var shows = Shows(action);
                if ((reminded || converses) && shows >= DirectorRules.StandsOut)
                {
                    continue;
                }
                var needed = DirectorRules.RepeatInterval(action.Kind, shows, Beats) * share;
                if (!Ended.ContainsKey(action.Id) || now >= Ended[action.Id] + needed)
                {
                    out_.Add(action);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no
        /// tags are requested; else all.
        /// </summary>
        public List<GraphAction> Modest(MetaAction meta, List<GraphAction> candidates, double now)
        {
            var request = meta.Request;
            var every = candidates.ToList();
            if (request.Kind != "fidget" || request.Tags.Count > 0 || Project.Settings.Variety <= 0)
            {
                return every;
            }
            if (meta.Written || WantedRules.ModeAt(Track, now) == "idle")
            {
                return every;
            }
            var left = every.Where(a => Shows(a) < DirectorRules.StandsOut).ToList();
            return left.Count > 0 ? left : every;
        }

        /// <summary>
        /// Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too
        /// recently, and others of another stance have not.
        /// </summary>
        public List<GraphAction> MovesOn(MetaAction meta, double now)
        {
            var out_ = new List<GraphAction>();
            if (Graph.Layer != "arms" || meta.Request.Kind != "gesture" || Track.StaysAt("arms", now))
            {
                return out_;
            }
            var variety = Project.Settings.Variety;
            if (now < Moved() + DirectorRules.Posture("arms") * variety || now < Acted + DirectorRules.LeastLull * variety)
            {
                return out_;
            }
            foreach (GraphAction action in Graph.Of(Stance, "transition"))
            {
                if (Usable(action) && CountFresh(action.EndStance, now) > 0)
                {
                    out_.Add(action);
                }
            }
            return out_;
        }

        /// <summary>Return how many gestures of a stance have not played for long enough.</summary>
        public int CountFresh(string stance, double now)
        {
            if (stance == null)
            {
                return 0;
            }
            var variety = Project.Settings.Variety;
            var count = Graph.Of(stance, "gesture").Count;
            foreach (var one in Ended)
            {
                var ident = one.Key;
                var end = one.Value;
                var action = PlainMaps.Get(Graph.Actions, ident);
                if (action == null || action.Kind != "gesture" || action.Stance != stance)
                {
                    continue;
                }
                var shows = Shows(action);
                if (now < end + DirectorRules.RepeatInterval("gesture", shows, Beats) * variety)
                {
                    count -= 1;
                }
            }
            return count;
        }

        /// <summary>Return when the stance was last changed; minus infinity for never.</summary>
        public double Moved()
        {
            var latest = double.NegativeInfinity;
            foreach (var one in Ended)
            {
                var ident = one.Key;
                var end = one.Value;
                var action = PlainMaps.Get(Graph.Actions, ident);
                if (action != null && action.Kind == "transition")
                {
                    latest = Math.Max(latest, end);
                }
            }
            return latest;
        }

        /// <summary>Return whether an act that stands out was done since a time.</summary>
        public bool Shown(double since)
        {
            foreach (var one in Ended)
            {
                var ident = one.Key;
                var end = one.Value;
                var action = PlainMaps.Get(Graph.Actions, ident);
                if (action == null || action.Kind == "transition" || end < since)
                {
                    continue;
                }
                if (Shows(action) >= DirectorRules.StandsOut)
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>
        /// Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so
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
            var needs = candidates.Select(a => (a.Id, a.Spacing == null ? default_ : a.Spacing.Value)).ToMap();
            for (int less = 0; less < PlainNumbers.MaxOf(candidates.Select(a => needs[a.Id]).ToList()) + 1; less++)
            {
                var left = candidates.Where(a => RememberingRules.Rested(before, a.Id, needs[a.Id] - less)).ToList();
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

        /// <summary>hops: whether it is a transition on the way to the requested action.</summary>
        public Cue Cue(GraphAction action, CueShape shape, Bound bound, bool hops, string stance, Mood mood)
        {
            var length = shape.Length;
            var into = Math.Max(0.0, action.Timing.BlendIn);
            var out_ = Math.Max(0.0, action.Timing.BlendOut);
            var found = Project.Span(action);
            double begin = found.Item1;
            double until = found.Item2;
            var cycle = RepeatingRules.CycleOf(action.Kind, action.Timing, begin, until);
            if (action.Timing.EarliestExit != null || cycle > 0)
            {
                var wish = hops ? double.PositiveInfinity : bound.Wish;
                length = Math.Min(length, Math.Max(shape.Shortest, Math.Min(bound.Limit, wish) - shape.Start));
            }
            else if (!hops)
            {
                length = Math.Min(length, Until(action, shape, bound) - shape.Start);
                if (length < shape.Length)
                {
                    out_ = Math.Max(out_, CueShapesRules.Retraction);
                }
            }
            if (shape.Entry > begin)
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
                bound.Meta.Key,
                shape.HoldFrom,
                shape.HoldTo,
                shape.Hold,
                Extent(action, mood),
                shape.Tempo,
                cycle > 0 ? begin : 0.0,
                cycle > 0 ? begin + cycle : 0.0
            );
        }

        public void Keep(Cue cue)
        {
            Note(cue, cue.Then);
            var loop = Loop(cue.Then, cue.Meta);
            if (loop != null)
            {
                // The loop begins again under the action, so that the action's last pose meets the loop's first.
                // On joints that the action does not move, the change shows. It takes its time there, like a
                // transition.
                var partial = cue.Action.Limb != "both" || cue.Action.Joints.Count > 0 || cue.Action.JointWeights.Count > 0;
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

        /// <summary>Return one of a stance's loops, drawn by likelihood; None if it has none.</summary>
        public GraphAction Loop(string stance, string key)
        {
            var loops = Graph.Of(stance, "stance");
            if (loops.Count == 1)
            {
                return loops[0];
            }
            var weights = loops.Where(a => a.Likelihood > 0).Select(a => (a.Id, a.Likelihood)).ToMap();
            if (weights.Count == 0)
            {
                return loops.Count > 0 ? loops[0] : null;
            }
            var chosen = ChoiceRules.Pick(Seed, key, "loop", weights);
            return loops.Where(a => a.Id == chosen).First();
        }

        /// <summary>Change between the loops of a stance in long rests, at the end of a loop.</summary>
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

        public void Tell(MetaAction meta, string outcome, string message, bool played = false, double late = 0.0, string by = "")
        {
            var layer = Graph.Layer;
            Reports.Add(new Report(meta.Request.Id, outcome, message, layer, meta.Start, played, meta.Written, late, by));
        }
    }

    public static class SamplingRules
    {
        public const double OnTime = 0.1; // seconds by which a request may begin later and still be on time
        // seconds of crossfade when a long rest changes from one loop of its stance to another
        public const double LoopFade = 0.6;

        /// <summary>Return the performer as it is after a past and the cues that played since.</summary>
        public static Performer PerformerAfter(
            Graph project,
            LayerGraph graph,
            uint seed,
            string begin,
            Past past,
            List<Cue> cues,
            Moods moods,
            Track track
        )
        {
            var stance = graph.Stances.ContainsKey(past.Stance) ? past.Stance : begin;
            var out_ = new Performer(
                project,
                graph,
                seed,
                stance,
                moods,
                track,
                past.Free,
                past.Free,
                new Dictionary<string, int>(past.Uses),
                new Dictionary<string, List<string>>(past.Recent),
                new Dictionary<string, double>(past.Ended)
            );
            out_.Beats = DirectorRules.BeatInterval(
                graph.Layer,
                graph.Actions.Values.ToList().Where(a => a.Kind == "gesture").ToList().Count
            );
            foreach (Cue cue in cues)
            {
                out_.Note(cue, graph.Stances.ContainsKey(cue.Then) ? cue.Then : begin);
            }
            return out_;
        }
    }
}
