using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>
    /// One action in the plan: it plays its clip from Entry on during Start..End, at its own speed but for its hold: clip seconds
    /// HoldFrom..HoldTo take Hold seconds. Stance: before it; Then: the stance it leaves the layer in. Meta: key of what it realises.
    /// </summary>
    public sealed class Cue
    {
        public GraphAction Action;
        public double Start, End, Entry, BlendIn, BlendOut, HoldFrom, HoldTo, Hold;
        public string Stance, Then, Meta;

        public double ClipSeconds(double time)
        {
            double elapsed = time - Start;
            if (Hold <= 0)
            {
                return Entry + elapsed;
            }
            double held = Basics.Clamp(elapsed - (HoldFrom - Entry), 0.0, Hold);
            return Entry + elapsed - held + held * ((HoldTo - HoldFrom) / Hold);
        }

        /// <summary>How much of it shows: 0 outside it, rising over its blend in, falling over its blend out.</summary>
        public double Weight(double time)
        {
            double rise = BlendIn > 0 ? Basics.Ease((time - Start) / BlendIn) : time >= Start ? 1.0 : 0.0;
            double fall = BlendOut > 0 ? Basics.Ease((End - time) / BlendOut) : time < End ? 1.0 : 0.0;
            return rise * fall;
        }
    }

    /// <summary>The stance loop that lies under the cues: loop seconds are time - Start. It takes over during Fade seconds.</summary>
    public sealed class Rest
    {
        public readonly string Stance;
        public readonly GraphAction Action;
        public readonly double Start, FadeStart, Fade;

        public Rest(string stance, GraphAction action, double start, double fadeStart, double fade)
        {
            Stance = stance;
            Action = action;
            Start = start;
            FadeStart = fadeStart;
            Fade = fade;
        }
    }

    /// <summary>What planning on needs of cues that were forgotten.</summary>
    public sealed class Past
    {
        public const int Remembered = 32; // draws of a stance and kind that spacing can look back on
        public double Free;
        public string Stance = "";
        public Dictionary<string, int> Uses = new Dictionary<string, int>();
        public Dictionary<string, List<string>> Recent = new Dictionary<string, List<string>>();
        public Dictionary<string, double> Ended = new Dictionary<string, double>();

        public Past Copy()
        {
            var copy = new Past { Free = Free, Stance = Stance };
            copy.Uses = new Dictionary<string, int>(Uses);
            copy.Ended = new Dictionary<string, double>(Ended);
            foreach (KeyValuePair<string, List<string>> one in Recent)
            {
                copy.Recent[one.Key] = new List<string>(one.Value);
            }
            return copy;
        }

        /// <summary>Note that a cue was played: how often its action was, lately, and until when.</summary>
        public void Remember(Cue cue)
        {
            int uses;
            Uses.TryGetValue(cue.Action.Id, out uses);
            Uses[cue.Action.Id] = uses + 1;
            string node = LayerGraph.Node(cue.Stance, cue.Action.Kind);
            if (!Recent.ContainsKey(node))
            {
                Recent[node] = new List<string>();
            }
            Recent[node].Add(cue.Action.Id);
            if (Recent[node].Count > Remembered)
            {
                Recent[node].RemoveAt(0);
            }
            Ended[cue.Action.Id] = cue.End;
        }
    }

    /// <summary>Cues never overlap and ascend; rests ascend by FadeStart, the first covering everything before.</summary>
    public sealed class LayerPlan
    {
        public readonly string Layer;
        public readonly List<MetaAction> Metas, Written;
        public readonly List<Cue> Cues;
        public readonly List<Rest> Rests;
        public readonly Past Past;
        public readonly Cursor Cursor;
        private static readonly Func<Cue, double> CueStart = cue => cue.Start;
        private static readonly Func<Rest, double> FadeStart = rest => rest.FadeStart;

        public LayerPlan(
            string layer, List<MetaAction> metas, List<Cue> cues, List<Rest> rests, Past past, Cursor cursor, List<MetaAction> written)
        {
            Layer = layer;
            Metas = metas;
            Cues = cues;
            Rests = rests;
            Past = past;
            Cursor = cursor;
            Written = written;
        }

        /// <summary>The cue playing at a time, null while the stance rests.</summary>
        public Cue CueAt(double seconds)
        {
            int place = Basics.BisectRight(Cues, seconds, CueStart) - 1;
            return place >= 0 && seconds < Cues[place].End ? Cues[place] : null;
        }

        /// <summary>The place of the rest that lies under a time.</summary>
        public int RestAt(double seconds)
        {
            return Math.Max(0, Basics.BisectRight(Rests, seconds, FadeStart) - 1);
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
                layers[layer] = new LayerPlan(
                    layer, new List<MetaAction>(), new List<Cue>(), new List<Rest>(), new Past(), MarkovRules.Begin, new List<MetaAction>());
            }
            return new Plan(seed, 0.0, layers, new List<Report>(), new List<MetaRequest>(), Track.Empty, Schedule.Empty);
        }

        internal Plan With(Track track)
        {
            return new Plan(Seed, End, Layers, Reports, Requests, track, Life);
        }
    }
}
