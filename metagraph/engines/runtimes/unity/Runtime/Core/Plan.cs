using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>What of a layer's plan shows at a time.</summary>
    public static class PlanTimes
    {
        private static readonly Func<Cue, double> CueStart = cue => cue.Start;
        private static readonly Func<Rest, double> FadeStart = rest => rest.FadeStart;

        /// <summary>The clip seconds that a cue shows.</summary>
        public static double ClipSeconds(this Cue cue, double time)
        {
            if (cue.Repeats)
            {
                return CueTimesRules.CueSeconds(cue, time);
            }
            double elapsed = time - cue.Start;
            if (cue.Hold <= 0)
            {
                return cue.Entry + elapsed * cue.Tempo;
            }
            double held = Basics.Clamp(elapsed - (cue.HoldFrom - cue.Entry) / cue.Tempo, 0.0, cue.Hold);
            return cue.Entry + (elapsed - held) * cue.Tempo + held * ((cue.HoldTo - cue.HoldFrom) / cue.Hold);
        }

        /// <summary>How much of a cue shows: 0 outside it, rising over its blend in, falling over its blend out.</summary>
        public static double Weight(this Cue cue, double time)
        {
            double rise = cue.BlendIn > 0 ? Basics.Ease((time - cue.Start) / cue.BlendIn) : time >= cue.Start ? 1.0 : 0.0;
            double fall = cue.BlendOut > 0 ? Basics.Ease((cue.End - time) / cue.BlendOut) : time < cue.End ? 1.0 : 0.0;
            return rise * fall;
        }

        /// <summary>The cue playing at a time, null while the stance rests.</summary>
        public static Cue CueAt(this LayerPlan plan, double seconds)
        {
            int place = Basics.BisectRight(plan.Cues, seconds, CueStart) - 1;
            return place >= 0 && seconds < plan.Cues[place].End ? plan.Cues[place] : null;
        }

        /// <summary>The place of the rest that lies under a time.</summary>
        public static int RestAt(this LayerPlan plan, double seconds)
        {
            return Math.Max(0, Basics.BisectRight(plan.Rests, seconds, FadeStart) - 1);
        }
    }

    /// <summary>The specific actions of every layer from 0 to End seconds, what could not be done as asked, and the life layers'.</summary>
    public sealed class Plan
    {
        public readonly uint Seed;
        public readonly double End;
        public readonly Dictionary<string, LayerPlan> Layers;
        public readonly List<Report> Reports;
        public readonly List<MetaRequest> Requests;
        public readonly Track Track;
        public readonly Schedule Life;

        public Plan(
            uint seed, double end, Dictionary<string, LayerPlan> layers, List<Report> reports, List<MetaRequest> requests, Track track,
            Schedule life)
        {
            Seed = seed;
            End = end;
            Layers = layers;
            Reports = reports;
            Requests = requests;
            Track = track;
            Life = life;
        }

        /// <summary>A plan of nothing.</summary>
        public static Plan Empty(uint seed)
        {
            var layers = new Dictionary<string, LayerPlan>();
            foreach (string layer in Basics.Layers)
            {
                layers[layer] = new LayerPlan(layer);
            }
            return new Plan(seed, 0.0, layers, new List<Report>(), new List<MetaRequest>(), new Track(), new Schedule());
        }

        internal Plan With(Track track)
        {
            return new Plan(Seed, End, Layers, Reports, Requests, track, Life);
        }
    }
}
