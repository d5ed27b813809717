// Translated from metagraph/playback/planning/layer_state.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
    ///
    /// moods: the mood over time. track: what lasts, such as the mode. free: when the next action may begin. acted: when the last
    /// action ended. uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended.
    /// begun: keys of meta actions whose chain of transitions already plays. served: keys of those that the action of another one
    /// serves, too. candidates: the actions of each `node` that may be drawn, for the nodes needed so far. prominences: of
    /// actions, as far as needed. model: the one that wrote what was not requested, None if there is none. beats: seconds after
    /// which a gesture that hardly shows may be done again.
    /// </summary>
    public sealed class LayerState
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

        public LayerState(
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

        public void Tell(MetaAction meta, string outcome, string message, bool played = false, double late = 0.0, string by = "")
        {
            var layer = Graph.Layer;
            Reports.Add(new Report(meta.Request.Id, outcome, message, layer, meta.Start, played, meta.Written, late, by));
        }
    }
}
