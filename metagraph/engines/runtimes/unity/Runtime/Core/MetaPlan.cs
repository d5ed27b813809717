// Translated from metagraph/playback/plan.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A request of an agent or animator, at any level of abstraction.
    ///
    /// id: unique; it keys the random draws. start: seconds. duration: how long the activity should last, None for one action.
    /// action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the stance to go
    /// to (kind "transition"). priority: higher wins. resume: whether the remainder plays afterwards if a more important request
    /// cuts it. stroke: when a gesture's stroke should come; `start` is then the earliest it may begin. hold: seconds that its
    /// hold should last, None for its length in the clip. prepare: whether its preparation plays. among: ids of the only actions
    /// it may be; empty for any. late: by how many seconds its stroke may come late, or its start if it has no stroke; 0 for on
    /// time or not at all, None for as late as the settings allow. valence, arousal, intensity: the mood it is played in, as in
    /// `mood.Mood`; None for the mood at that time.
    /// </summary>
    public sealed class MetaRequest
    {
        public readonly string Id;
        public readonly string Layer;
        public readonly string Kind;
        public readonly double Start;
        public readonly double? Duration;
        public readonly string Action;
        public readonly List<string> Tags;
        public readonly string Limb;
        public readonly string Stance;
        public readonly int Priority;
        public readonly bool Resume;
        public readonly double? Stroke;
        public readonly double? Hold;
        public readonly bool Prepare;
        public readonly List<string> Among;
        public readonly double? Late;
        public readonly double? Valence;
        public readonly double? Arousal;
        public readonly double? Intensity;

        public MetaRequest(
            string id,
            string layer,
            string kind,
            double start,
            double? duration = null,
            string action = null,
            List<string> tags = null,
            string limb = null,
            string stance = null,
            int priority = MetaPlanRules.Asked,
            bool resume = false,
            double? stroke = null,
            double? hold = null,
            bool prepare = true,
            List<string> among = null,
            double? late = null,
            double? valence = null,
            double? arousal = null,
            double? intensity = null
        )
        {
            Id = id;
            Layer = layer;
            Kind = kind;
            Start = start;
            Duration = duration;
            Action = action;
            Tags = tags ?? new List<string>();
            Limb = limb;
            Stance = stance;
            Priority = priority;
            Resume = resume;
            Stroke = stroke;
            Hold = hold;
            Prepare = prepare;
            Among = among ?? new List<string>();
            Late = late;
            Valence = valence;
            Arousal = arousal;
            Intensity = intensity;
        }
    }

    /// <summary>
    /// Where writing continues: before meta action `number`, after state number `state` (-1: none yet), which ended at `time`
    /// seconds.
    /// </summary>
    public sealed class Cursor
    {
        public readonly int Number;
        public readonly int State;
        public readonly double Time;

        public Cursor(int number = 0, int state = -1, double time = 0.0)
        {
            Number = number;
            State = state;
            Time = time;
        }
    }

    /// <summary>
    /// A request placed in time: `start`..`end` is the window it may use. written: whether the Markov model wrote it, instead of
    /// a request. part: 0 for the request itself, n for its n-th remainder after a cut.
    /// </summary>
    public sealed class MetaAction
    {
        public readonly MetaRequest Request;
        public readonly double Start;
        public readonly double End;
        public readonly int Part;
        public readonly bool Written;

        public MetaAction(MetaRequest request, double start, double end, int part = 0, bool written = false)
        {
            Request = request;
            Start = start;
            End = end;
            Part = part;
            Written = written;
        }

        /// <summary>Its importance: its request's priority. What a model wrote gives way to all requests.</summary>
        public double Rank
        {
            get
            {
                return Written ? double.NegativeInfinity : Request.Priority;
            }
        }

        /// <summary>The key of this meta action's random draws.</summary>
        public string Key
        {
            get
            {
                return Part == 0 ? Request.Id : Request.Id + "+" + PlainText.Of(Part);
            }
        }
    }

    /// <summary>
    /// One action in the plan. It plays its clip from `entry` on during `start`..`end`, at `tempo` times its own speed but for
    /// its hold.
    ///
    /// hold_from, hold_to: clip seconds of the hold, which takes `hold` seconds; 0, 0, 0 if it is not stretched. blend_in,
    /// blend_out: seconds, fitting inside the cue. stance: before it; then: the stance it leaves the layer in. meta: key of the
    /// meta action it realises. extent: how large it is played, a factor of its turns away from the stance. cycle_from, cycle_to:
    /// clip seconds between which it repeats; 0, 0 if it plays once.
    /// </summary>
    public sealed class Cue
    {
        public readonly GraphAction Action;
        public readonly double Start;
        public readonly double End;
        public readonly double Entry;
        public readonly double BlendIn;
        public readonly double BlendOut;
        public readonly string Stance;
        public readonly string Then;
        public readonly string Meta;
        public readonly double HoldFrom;
        public readonly double HoldTo;
        public readonly double Hold;
        public readonly double Extent;
        public readonly double Tempo;
        public readonly double CycleFrom;
        public readonly double CycleTo;

        public Cue(
            GraphAction action,
            double start,
            double end,
            double entry,
            double blendIn,
            double blendOut,
            string stance,
            string then,
            string meta,
            double holdFrom = 0.0,
            double holdTo = 0.0,
            double hold = 0.0,
            double extent = 1.0,
            double tempo = 1.0,
            double cycleFrom = 0.0,
            double cycleTo = 0.0
        )
        {
            Action = action;
            Start = start;
            End = end;
            Entry = entry;
            BlendIn = blendIn;
            BlendOut = blendOut;
            Stance = stance;
            Then = then;
            Meta = meta;
            HoldFrom = holdFrom;
            HoldTo = holdTo;
            Hold = hold;
            Extent = extent;
            Tempo = tempo;
            CycleFrom = cycleFrom;
            CycleTo = cycleTo;
        }

        /// <summary>Whether it repeats a cycle.</summary>
        public bool Repeats
        {
            get
            {
                return CycleTo > CycleFrom;
            }
        }
    }

    /// <summary>
    /// The stance loop that lies under the cues from `start` on: loop seconds are `time - start`, wrapped.
    ///
    /// fade_start, fade: when and for how many seconds it takes over from the loop before.
    /// </summary>
    public sealed class Rest
    {
        public readonly string Stance;
        public readonly GraphAction Action;
        public readonly double Start;
        public readonly double FadeStart;
        public readonly double Fade;

        public Rest(string stance, GraphAction action, double start, double fadeStart, double fade)
        {
            Stance = stance;
            Action = action;
            Start = start;
            FadeStart = fadeStart;
            Fade = fade;
        }
    }

    /// <summary>
    /// The result of a meta action that does not play exactly as requested. played: whether a part of it still plays. late: by
    /// how many seconds it comes late, or would have come, if it said how late it may. by: key of the meta action whose action
    /// serves it, too.
    /// </summary>
    public sealed class Report
    {
        public readonly string Request;
        public readonly string Outcome;
        public readonly string Message;
        public readonly string Layer;
        public readonly double At;
        public readonly bool Played;
        public readonly bool Written;
        public readonly double Late;
        public readonly string By;

        public Report(
            string request,
            string outcome,
            string message,
            string layer,
            double at,
            bool played = false,
            bool written = false,
            double late = 0.0,
            string by = ""
        )
        {
            Request = request;
            Outcome = outcome;
            Message = message;
            Layer = layer;
            At = at;
            Played = played;
            Written = written;
            Late = late;
            By = by;
        }
    }

    /// <summary>
    /// What further planning needs from forgotten cues. free: when the last one ended; stance: in which stance. uses: how often
    /// each action was used. recent: the actions used last, by `remembering.node`, the latest at the end. ended: when each ended
    /// last.
    /// </summary>
    public sealed class Past
    {
        public readonly double Free;
        public readonly string Stance;
        public readonly Dictionary<string, int> Uses;
        public readonly Dictionary<string, List<string>> Recent;
        public readonly Dictionary<string, double> Ended;

        public Past(
            double free = 0.0,
            string stance = "",
            Dictionary<string, int> uses = null,
            Dictionary<string, List<string>> recent = null,
            Dictionary<string, double> ended = null
        )
        {
            Free = free;
            Stance = stance;
            Uses = uses ?? new Dictionary<string, int>();
            Recent = recent ?? new Dictionary<string, List<string>>();
            Ended = ended ?? new Dictionary<string, double>();
        }
    }

    /// <summary>
    /// cues never overlap and ascend; rests ascend by fade_start, the first covering everything before.
    ///
    /// past: what came before the first cue, if that was forgotten. cursor: where the Markov model continues to write. written:
    /// what it wrote for later, unchanged: each extension fits it in again, so that it does not matter when it was written.
    /// </summary>
    public sealed class LayerPlan
    {
        public readonly string Layer;
        public readonly List<MetaAction> Metas;
        public readonly List<Cue> Cues;
        public readonly List<Rest> Rests;
        public readonly Past Past;
        public readonly Cursor Cursor;
        public readonly List<MetaAction> Written;

        public LayerPlan(
            string layer,
            List<MetaAction> metas = null,
            List<Cue> cues = null,
            List<Rest> rests = null,
            Past past = null,
            Cursor cursor = null,
            List<MetaAction> written = null
        )
        {
            Layer = layer;
            Metas = metas ?? new List<MetaAction>();
            Cues = cues ?? new List<Cue>();
            Rests = rests ?? new List<Rest>();
            Past = past ?? new Past();
            Cursor = cursor ?? new Cursor();
            Written = written ?? new List<MetaAction>();
        }
    }

    public static class MetaPlanRules
    {
        public const int Asked = 1; // default priority of a request
        public const int Written = 0; // priority of what the Markov model writes
        // told by temporal replanning, once
        public static readonly HashSet<string> Temporal = new HashSet<string> { "late", "cut", "resumed", "past" };
    }
}
