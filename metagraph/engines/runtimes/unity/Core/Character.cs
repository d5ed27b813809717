using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace Metagraph
{
    /// <summary>How a character performs. Seed: null for the project's. Idle: the models fill the time nobody asks for.</summary>
    public sealed class CharacterOptions
    {
        public uint? Seed;
        public bool Idle = true;
        /// <summary>Layer -> id of the stance it begins in.</summary>
        public Dictionary<string, string> Stances = new Dictionary<string, string>();
        /// <summary>Seconds that are planned ahead, and seconds of past that answers know of.</summary>
        public double Ahead = 20.0, Recent = 30.0;
    }

    /// <summary>
    /// What began or ended. Kind: begin or end. Layer: body, arms, head, or speech. Action: name of the action; of a speech the id of
    /// its line, or its text. Meta: key of what it realises; an ask's id, followed by + or / where it is a part.
    /// </summary>
    public struct CharacterEvent
    {
        public string Kind, Layer, Action, Meta;
        public double At;
    }

    /// <summary>
    /// One character, played live: requests come in between two updates, are worked into the plan at the next, and each is told what
    /// became of it. Nothing here throws once it is made.
    /// </summary>
    public sealed class Character
    {
        private const double Slack = 2.0; // seconds by which the plan may fall behind its horizon before it is extended
        private const double Cut = 15.0; // seconds between two cuts
        private const int Remembered = 1000; // refusals

        public readonly Graph Graph;
        private readonly CharacterOptions options;
        private readonly Player player;
        private readonly BodyPose pose;
        private readonly List<KeyValuePair<Ask, double?>> queue = new List<KeyValuePair<Ask, double?>>(); // with "after"
        private readonly Dictionary<string, string> refused = new Dictionary<string, string>();
        private readonly List<CharacterEvent> events = new List<CharacterEvent>();
        private int count;
        private double cutAt;

        public Character(Graph graph, CharacterOptions options = null)
        {
            Graph = graph;
            this.options = options ?? new CharacterOptions();
            player = new Player(graph);
            pose = new BodyPose(graph);
            Plan = Plan.Empty(this.options.Seed ?? graph.Planner.Seed);
            Plan = Hearing.Hear(graph, Plan, 0.0, new Ask[0], this.options.Ahead, this.options.Stances, this.options.Idle);
            Now = double.NegativeInfinity; // so that what begins at 0 is told of at the first update
        }

        public Plan Plan { get; private set; }

        /// <summary>Seconds of the performance at the last update; negative infinity before the first.</summary>
        public double Now { get; private set; }

        /// <summary>
        /// Ask for something; taken up at the next update. The request is JSON with "do", as an agent sends it; "after": seconds from
        /// now, instead of "at". Returns its id, made up where it has none. What cannot be read is refused: see `AnswerTo`.
        /// </summary>
        public string Ask(string json)
        {
            string id = "";
            try
            {
                object parsed = Json.Parse(json ?? "");
                var fields = parsed as JsonObject;
                double? after = null;
                if (fields != null)
                {
                    id = fields.Has("id") ? fields["id"] as string ?? "" : "";
                    parsed = Without(fields, "after");
                    after = fields.Has("after") && fields["after"] != null ? Metagraph.Ask.Number("after", fields["after"], 0, 1e6) : after;
                }
                Ask ask = Metagraph.Ask.From(parsed);
                if (after != null && ask.At != null)
                {
                    throw new AskException("after: says something else than 'at'; give one of them");
                }
                id = ask.Id.Length > 0 ? ask.Id : NextId();
                ask.Id = id;
                queue.Add(new KeyValuePair<Ask, double?>(ask, after));
                refused.Remove(id);
            }
            catch (Exception error) when (error is AskException || error is FormatException)
            {
                id = id.Length > 0 ? id : NextId();
                if (refused.Count >= Remembered)
                {
                    refused.Clear();
                }
                refused[id] = error.Message;
            }
            return id;
        }

        private string NextId()
        {
            count++;
            return "#" + count.ToString(CultureInfo.InvariantCulture);
        }

        private static JsonObject Without(JsonObject fields, string gone)
        {
            var kept = new JsonObject();
            foreach (string name in fields.Names)
            {
                if (name != gone)
                {
                    kept[name] = fields[name];
                }
            }
            return kept;
        }

        /// <summary>Move on to a time, seconds since the performance began; time never goes back. Works in what was asked.</summary>
        public void Update(double now)
        {
            double before = Now;
            now = double.IsNaN(now) || double.IsInfinity(now) ? Math.Max(before, 0.0) : Math.Max(Math.Max(before, now), 0.0);
            Now = now;
            events.Clear();
            double horizon = now + options.Ahead;
            bool far = Plan.End >= horizon - Slack;
            if (queue.Count > 0 || !far)
            {
                List<Ask> asks = queue.Select(one => one.Value == null ? one.Key : one.Key.With(one.Key.Id, now + one.Value.Value)).ToList();
                queue.Clear();
                Plan = Hearing.Hear(Graph, Plan, now, asks, far ? Plan.End : horizon, options.Stances, options.Idle);
            }
            Notice(before, now);
            if (now - cutAt >= Cut)
            {
                cutAt = now;
                Plan = Hearing.Since(Plan, now - options.Recent);
            }
        }

        /// <summary>Note what began or ended after `before`, until `now`.</summary>
        private void Notice(double before, double now)
        {
            foreach (string layer in Basics.Layers)
            {
                List<Cue> cues = Plan.Layers[layer].Cues;
                for (int n = cues.Count - 1; n >= 0 && cues[n].End > before; n--)
                {
                    Note(cues[n].Start, cues[n].End, before, now, layer, cues[n].Action.Name, cues[n].Meta);
                }
            }
            foreach (Speech speech in Plan.Track.Speeches)
            {
                Note(speech.Start, speech.End, before, now, "speech", speech.LineId ?? speech.Text, speech.Id);
            }
        }

        private void Note(double start, double end, double before, double now, string layer, string action, string meta)
        {
            if (end > before && end <= now)
            {
                Insert(new CharacterEvent { Kind = "end", Layer = layer, Action = action, Meta = meta, At = end });
            }
            if (start > before && start <= now)
            {
                Insert(new CharacterEvent { Kind = "begin", Layer = layer, Action = action, Meta = meta, At = start });
            }
        }

        /// <summary>Put an event in its place: by time.</summary>
        private void Insert(CharacterEvent one)
        {
            int place = events.Count;
            while (place > 0 && events[place - 1].At > one.At)
            {
                place--;
            }
            events.Insert(place, one);
        }

        /// <summary>What began or ended at the last update, in order; the list is filled anew by the next.</summary>
        public IList<CharacterEvent> Events
        {
            get { return events; }
        }

        /// <summary>What became of an ask: when it will play, or why it will not. Known for as long as the past is kept.</summary>
        public Answer AnswerTo(string id)
        {
            string why;
            if (refused.TryGetValue(id ?? "", out why))
            {
                return new Answer { Id = id, State = "refused", Why = why };
            }
            if (queue.Exists(one => one.Key.Id == id))
            {
                return new Answer { Id = id, State = "planned", Why = "taken up at the next update" };
            }
            return Hearing.AnswerTo(Plan, id ?? "");
        }

        /// <summary>The pose at the updated time; the same arrays each time. alive: with the life layers.</summary>
        public BodyPose Pose(bool alive = true)
        {
            player.PoseAt(Plan, Math.Max(Now, 0.0), alive, pose);
            return pose;
        }
    }
}
