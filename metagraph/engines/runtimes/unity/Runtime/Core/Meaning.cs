// Translated from metagraph/playback/planning/meaning.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// An ask with the fields of all kinds of asks; `do` says which of them count. line: id; said: that line, None if there is
    /// none. text: the words, or a block of BML. timing: the times of its words and shapes.
    /// </summary>
    public sealed class PlainAsk
    {
        public readonly string Do;
        public readonly string Id;
        public readonly double? At;
        public readonly int Priority;
        public readonly string Layer;
        public readonly List<string> Tags;
        public readonly string Limb;
        public readonly double? Duration;
        public readonly double? Stroke;
        public readonly double? Hold;
        public readonly double? Late;
        public readonly double? Valence;
        public readonly double? Arousal;
        public readonly double? Intensity;
        public readonly bool Prepare;
        public readonly bool Resume;
        public readonly bool Stay;
        public readonly string Action;
        public readonly string Stance;
        public readonly Spot To;
        public readonly double Amount;
        public readonly bool Strict;
        public readonly string Line;
        public readonly SaidLine Said;
        public readonly string Text;
        public readonly bool Gestures;
        public readonly LineTiming Timing;
        public readonly string Mode;
        public readonly string Name;
        public readonly List<double> Point;
        public readonly string What;
        public readonly bool More;

        public PlainAsk(
            string do_,
            string id = "",
            double? at = null,
            int priority = MetaPlanRules.Asked,
            string layer = null,
            List<string> tags = null,
            string limb = null,
            double? duration = null,
            double? stroke = null,
            double? hold = null,
            double? late = null,
            double? valence = null,
            double? arousal = null,
            double? intensity = null,
            bool prepare = true,
            bool resume = false,
            bool stay = false,
            string action = "",
            string stance = "",
            Spot to = null,
            double amount = 1.0,
            bool strict = false,
            string line = null,
            SaidLine said = null,
            string text = "",
            bool gestures = true,
            LineTiming timing = null,
            string mode = null,
            string name = "",
            List<double> point = null,
            string what = "",
            bool more = false
        )
        {
            Do = do_;
            Id = id;
            At = at;
            Priority = priority;
            Layer = layer;
            Tags = tags ?? new List<string>();
            Limb = limb;
            Duration = duration;
            Stroke = stroke;
            Hold = hold;
            Late = late;
            Valence = valence;
            Arousal = arousal;
            Intensity = intensity;
            Prepare = prepare;
            Resume = resume;
            Stay = stay;
            Action = action;
            Stance = stance;
            To = to;
            Amount = amount;
            Strict = strict;
            Line = line;
            Said = said;
            Text = text;
            Gestures = gestures;
            Timing = timing;
            Mode = mode;
            Name = name;
            Point = point ?? new List<double>();
            What = what;
            More = more;
        }
    }

    /// <summary>
    /// A line of dialogue. seconds: its length, None if unknown. asks: its own requests, in seconds from its start. valence,
    /// arousal, intensity: of the mood it is said in.
    /// </summary>
    public sealed class SaidLine
    {
        public readonly string Text;
        public readonly double? Seconds;
        public readonly List<PlainAsk> Asks;
        public readonly double? Valence;
        public readonly double? Arousal;
        public readonly double? Intensity;

        public SaidLine(
            string text = "",
            double? seconds = null,
            List<PlainAsk> asks = null,
            double? valence = null,
            double? arousal = null,
            double? intensity = null
        )
        {
            Text = text;
            Seconds = seconds;
            Asks = asks ?? new List<PlainAsk>();
            Valence = valence;
            Arousal = arousal;
            Intensity = intensity;
        }
    }

    /// <summary>A requested block of BML: its behaviours become asks `&lt;id&gt;.1`, `&lt;id&gt;.2`, ...</summary>
    public sealed class AskedBlock
    {
        public readonly string Id;
        public readonly double At;
        public readonly int Priority;
        public readonly string Text;

        public AskedBlock(string id, double at, int priority, string text)
        {
            Id = id;
            At = at;
            Priority = priority;
            Text = text;
        }
    }

    /// <summary>
    /// An ask that steers speech. do: "interrupt", "pause", "resume" or "finish". what: the id of the speech, "" for all speech.
    /// </summary>
    public sealed class SteeringAsk
    {
        public readonly string Do;
        public readonly string Id;
        public readonly string What;
        public readonly int Priority;

        public SteeringAsk(string do_, string id, string what, int priority)
        {
            Do = do_;
            Id = id;
            What = what;
            Priority = priority;
        }
    }

    /// <summary>
    /// The meaning of asks, so far. graphs: of the layers, in their order. withdrawn: ids taken back; "" stands for all. steered:
    /// the asks that steer speech, in order. unknown: the kind of thing that an ask names and that does not exist: "action",
    /// "stance" or "line". Speeches may overlap. fixed: the earliest second at which a gesture of a line can begin; the line
    /// itself may begin earlier.
    /// </summary>
    public sealed class Meaning
    {
        public Graph Project;
        public List<LayerGraph> Graphs;
        public Alphabet Alphabet;
        public List<MetaRequest> Requests;
        public List<LookAt> Looks;
        public List<Speech> Speeches;
        public List<ModeFrom> Modes;
        public List<PlaceFrom> Places;
        public List<BlinkAt> Blinks;
        public List<StayFrom> Stays;
        public List<MoodFrom> Moods;
        public List<AskedBlock> Blocks;
        public HashSet<string> Withdrawn;
        public List<SteeringAsk> Steered;
        public List<Report> Refused;
        public string Unknown;
        public double Fixed;

        public Meaning(
            Graph project,
            List<LayerGraph> graphs,
            Alphabet alphabet,
            List<MetaRequest> requests = null,
            List<LookAt> looks = null,
            List<Speech> speeches = null,
            List<ModeFrom> modes = null,
            List<PlaceFrom> places = null,
            List<BlinkAt> blinks = null,
            List<StayFrom> stays = null,
            List<MoodFrom> moods = null,
            List<AskedBlock> blocks = null,
            HashSet<string> withdrawn = null,
            List<SteeringAsk> steered = null,
            List<Report> refused = null,
            string unknown = "",
            double fixed_ = 0.0
        )
        {
            Project = project;
            Graphs = graphs;
            Alphabet = alphabet;
            Requests = requests ?? new List<MetaRequest>();
            Looks = looks ?? new List<LookAt>();
            Speeches = speeches ?? new List<Speech>();
            Modes = modes ?? new List<ModeFrom>();
            Places = places ?? new List<PlaceFrom>();
            Blinks = blinks ?? new List<BlinkAt>();
            Stays = stays ?? new List<StayFrom>();
            Moods = moods ?? new List<MoodFrom>();
            Blocks = blocks ?? new List<AskedBlock>();
            Withdrawn = withdrawn ?? new HashSet<string>();
            Steered = steered ?? new List<SteeringAsk>();
            Refused = refused ?? new List<Report>();
            Unknown = unknown;
            Fixed = fixed_;
        }

        /// <summary>Return the track of lasting items.</summary>
        public Track Track()
        {
            return new Track(
                Looks.ToList(),
                Speeches.ToList(),
                Modes.ToList(),
                Places.ToList(),
                Blinks.ToList(),
                Stays.ToList(),
                Moods.ToList()
            );
        }

        /// <summary>Add the meaning of other asks.</summary>
        public void Take(Meaning other)
        {
            Requests.AddRange(other.Requests);
            Looks.AddRange(other.Looks);
            Speeches.AddRange(other.Speeches);
            Modes.AddRange(other.Modes);
            Places.AddRange(other.Places);
            Blinks.AddRange(other.Blinks);
            Stays.AddRange(other.Stays);
            Moods.AddRange(other.Moods);
            Blocks.AddRange(other.Blocks);
            Steered.AddRange(other.Steered);
            foreach (string ident in other.Withdrawn)
            {
                Withdrawn.Add(ident);
            }
        }

        /// <summary>Report that an ask was not understood.</summary>
        public void Refuse(string ident, string why, string layer, double at)
        {
            Refused.Add(new Report(ident, "not-understood", why, layer == null ? "arms" : layer, at));
        }

        /// <summary>Return a layer's graph.</summary>
        public LayerGraph GraphOf(string layer)
        {
            return Graphs.Where(graph => graph.Layer == layer).First();
        }

        /// <summary>
        /// Add the meaning of an ask; return why it has none, "" if it has one. ident, at, priority: its own, or as the line
        /// changed them that it belongs to. shift: the second at which that line begins, else 0.
        /// </summary>
        public string Add(PlainAsk ask, string ident, double at, int priority, double shift)
        {
            var where = ask.Layer == null ? "" : " in the " + ask.Layer + " layer";
            var stroke = ask.Stroke == null ? (double?)null : ask.Stroke.Value + shift;
            var start = at;
            if (ask.Do == "gesture" || ask.Do == "fidget")
            {
                var kind = ask.Do == "gesture" ? "gesture" : "fidget";
                var layer = ask.Layer == null ? "arms" : ask.Layer;
                if (stroke != null)
                {
                    start = Math.Max(0.0, stroke.Value - PhasesRules.FindLongestLead(Project, GraphOf(layer), ask.Tags));
                }
                var request = new MetaRequest(
                    ident,
                    layer,
                    kind,
                    start,
                    ask.Duration,
                    null,
                    ask.Tags,
                    ask.Limb,
                    null,
                    priority,
                    ask.Resume,
                    stroke,
                    ask.Hold,
                    ask.Prepare,
                    new List<string>(),
                    ask.Late,
                    ask.Valence,
                    ask.Arousal,
                    ask.Intensity
                );
                Requests.Add(request);
            }
            else if (ask.Do == "action")
            {
                var action = FindingRules.ActionCalled(Graphs, ask.Action, ask.Layer);
                if (action == null)
                {
                    Unknown = "action";
                    return "there is no action '" + ask.Action + "'" + where;
                }
                if (stroke != null)
                {
                    start = Math.Max(0.0, stroke.Value - PhasesRules.Lead(Project, action));
                }
                var found = Project.Span(action);
                double begins = found.Item1;
                double ends = found.Item2;
                var repeats = RepeatingRules.CycleOf(action.Kind, action.Timing, begins, ends) > 0;
                var duration = repeats ? ask.Duration : (double?)null;
                var request = new MetaRequest(
                    ident,
                    action.Layer,
                    action.Kind,
                    start,
                    duration,
                    action.Id,
                    new List<string>(),
                    null,
                    null,
                    priority,
                    false,
                    stroke,
                    ask.Hold,
                    ask.Prepare,
                    new List<string>(),
                    ask.Late,
                    ask.Valence,
                    ask.Arousal,
                    ask.Intensity
                );
                Requests.Add(request);
            }
            else if (ask.Do == "stance")
            {
                var stance = FindingRules.StanceCalled(Graphs, ask.Stance, ask.Layer);
                if (stance == null)
                {
                    Unknown = "stance";
                    return "there is no stance '" + ask.Stance + "'" + where;
                }
                Requests.Add(new MetaRequest(
                    ident,
                    stance.Layer,
                    "transition",
                    at,
                    null,
                    null,
                    new List<string>(),
                    null,
                    stance.Id,
                    priority,
                    false,
                    null,
                    null,
                    true,
                    new List<string>(),
                    ask.Late
                ));
                Stays.Add(new StayFrom(ident, at, stance.Layer, ask.Stay));
            }
            else if (ask.Do == "change")
            {
                // Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
                var layer = ask.Layer == null ? "arms" : ask.Layer;
                Requests.Add(new MetaRequest(
                    ident,
                    layer,
                    "transition",
                    at,
                    null,
                    null,
                    new List<string>(),
                    null,
                    null,
                    priority,
                    false,
                    null,
                    null,
                    true,
                    new List<string>(),
                    ask.Late
                ));
            }
            else if (ask.Do == "nod" || ask.Do == "shake")
            {
                return Head(ask, ident, at, priority);
            }
            else if (ask.Do == "look")
            {
                var end = ask.Duration == null ? MeaningRules.Forever : at + ask.Duration.Value;
                var to = ask.To == null ? SpotsRules.Named("user") : ask.To;
                Looks.Add(new LookAt(ident, at, end, to, ask.Amount, ask.Strict, priority));
            }
            else if (ask.Do == "blink")
            {
                Blinks.Add(new BlinkAt(ident, at));
            }
            else if (ask.Do == "mood")
            {
                var until = ask.Duration == null ? double.PositiveInfinity : at + ask.Duration.Value;
                Moods.Add(new MoodFrom(ident, at, ask.Valence, ask.Arousal, ask.Intensity, until));
            }
            else if (ask.Do == "mode")
            {
                Modes.Add(new ModeFrom(ident, at, ask.Mode));
            }
            else if (ask.Do == "place")
            {
                Places.Add(new PlaceFrom(ident, at, ask.Name, ask.Point));
            }
            else if (ask.Do == "withdraw")
            {
                Withdrawn.Add(ask.What);
            }
            else if (ask.Do == "interrupt" || ask.Do == "pause" || ask.Do == "resume" || ask.Do == "finish")
            {
                Steered.Add(new SteeringAsk(ask.Do, ident, ask.What, priority));
            }
            else if (ask.Do == "say")
            {
                return Say(ask, ident, at, priority);
            }
            else if (ask.Do == "bml")
            {
                Blocks.Add(new AskedBlock(ident, at, priority, ask.Text));
            }
            else
            {
                return "nothing is known of '" + ask.Do + "'";
            }
            return "";
        }

        /// <summary>
        /// Nods are gestures with that tag; if there is none, the likeliest one with that name, whatever stance it needs.
        /// </summary>
        public string Head(PlainAsk ask, string ident, double at, int priority)
        {
            var gestures = GraphOf("head").Actions.Values.ToList().Where(x => x.Kind == "gesture"
                && ask.Tags.All(tag => x.Tags.Contains(tag))).ToList();
            var tags = new List<string>();
            var called = new List<string>();
            if (gestures.Any(x => x.Tags.Contains(ask.Do)))
            {
                tags = new List<string> { ask.Do }.Concat(ask.Tags).ToList();
            }
            else
            {
                called = gestures.Where(x => x.Name.ToLowerInvariant().Contains(ask.Do)).Select(x => x.Id).ToList();
                if (called.Count == 0)
                {
                    var told = ask.Tags.Count > 0 ? " with the tags " + string.Join(", ", ask.Tags) : "";
                    return "the head layer has no gesture tagged or called '" + ask.Do + "'" + told;
                }
            }
            Requests.Add(new MetaRequest(
                ident,
                "head",
                "gesture",
                at,
                null,
                null,
                tags,
                null,
                null,
                priority,
                false,
                null,
                null,
                true,
                called.ToList(),
                ask.Late,
                ask.Valence,
                ask.Arousal,
                ask.Intensity
            ));
            return "";
        }

        /// <summary>Say a line, with its own requests, or other words.</summary>
        public string Say(PlainAsk ask, string ident, double at, int priority)
        {
            var line = ask.Said;
            if (ask.Line != null && line == null)
            {
                Unknown = "line";
                return "there is no line '" + ask.Line + "'";
            }
            var text = ask.Text;
            if (text == "" && line != null)
            {
                text = line.Text;
            }
            if (text == "" && line == null && ask.Timing != null)
            {
                text = LineTimingRules.ToldText(ask.Timing);
            }
            if (line == null && text == "" && ask.Timing == null)
            {
                return "say what: a line's id, text, or words with their times";
            }
            var timing = ask.Timing;
            if (timing == null && line == null && ask.More && ask.Duration != null)
            {
                timing = LineTimingRules.PaceText(Alphabet, text, ask.Duration.Value);
            }
            double length = default(double);
            if (timing != null)
            {
                length = LineTimingRules.TimedSeconds(timing, ask.Duration);
            }
            else if (ask.Duration != null)
            {
                length = Math.Max(ask.Duration.Value, 0.0);
            }
            else if (line != null && line.Seconds != null)
            {
                length = line.Seconds.Value;
            }
            else
            {
                length = GraphemesRules.ReadAloud(Alphabet, text);
            }
            Speeches.Add(new Speech(ident, at, at + length, ask.Line, text, priority, null, timing, 0.0, ask.More));
            var told = ask.Valence != null || line == null;
            var valence = (told || line == null) ? ask.Valence : line.Valence;
            var arousal = (told || line == null) ? ask.Arousal : line.Arousal;
            var intensity = (ask.Intensity == null && line != null) ? line.Intensity : ask.Intensity;
            if (valence != null || intensity != null)
            {
                Moods.Add(new MoodFrom(ident, at, valence, arousal, intensity, at + length));
            }
            if (line == null || !ask.Gestures)
            {
                return "";
            }
            foreach (var one in line.Asks.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var inner = one.Item2;
                if (inner.Do == "say")
                {
                    return "a line would say another line; its asks may not";
                }
                var begins = inner.At == null ? at : at + inner.At.Value;
                if (ask.At == null)
                {
                    begins = Math.Max(begins, Fixed);
                }
                var why = Add(inner, ident + "." + PlainText.Of(n + 1), begins, Math.Max(inner.Priority, priority), at);
                if (why != "")
                {
                    return why;
                }
            }
            return "";
        }
    }

    public static class MeaningRules
    {
        public const double Forever = 1000000000.0; // seconds; a look that lasts until the next

        /// <summary>
        /// Add the meaning of an ask, or refuse all of it. now: when it begins if it does not say; soon: the same for speech.
        /// </summary>
        public static void Understood(Meaning whole, PlainAsk ask, double now, double soon)
        {
            var one = new Meaning(
                whole.Project,
                whole.Graphs,
                whole.Alphabet,
                new List<MetaRequest>(),
                new List<LookAt>(),
                new List<Speech>(),
                new List<ModeFrom>(),
                new List<PlaceFrom>(),
                new List<BlinkAt>(),
                new List<StayFrom>(),
                new List<MoodFrom>(),
                new List<AskedBlock>(),
                new HashSet<string>(),
                new List<SteeringAsk>(),
                new List<Report>(),
                "",
                now
            );
            var at = ask.At == null ? ask.Do == "say" ? soon : now : ask.At.Value;
            var why = one.Add(ask, ask.Id, at, ask.Priority, 0.0);
            if (why == "")
            {
                whole.Take(one);
            }
            else
            {
                whole.Refuse(ask.Id, why, ask.Layer, at);
            }
        }
    }
}
