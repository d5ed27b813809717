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
        private const double Latest = 1e9; // seconds; no time comes after
        private const int Remembered = 1000; // answers kept after that

        public readonly Graph Graph;
        private readonly CharacterOptions options;
        private readonly Player player;
        private readonly BodyPose pose;
        private readonly List<KeyValuePair<Ask, double?>> queue = new List<KeyValuePair<Ask, double?>>(); // with "after"
        private readonly HashSet<string> asked = new HashSet<string>(); // ids that the plan can tell of
        private readonly Dictionary<string, Answer> settled = new Dictionary<string, Answer>(); // of what it forgot or never heard of
        private readonly Queue<string> settling = new Queue<string>(); // their ids, the oldest first
        private readonly List<CharacterEvent> events = new List<CharacterEvent>();
        private int count;
        private double seen = double.NegativeInfinity, cutAt;

        public Character(Graph graph, CharacterOptions options = null)
        {
            Graph = graph;
            this.options = options ?? new CharacterOptions();
            player = new Player(graph);
            pose = new BodyPose(graph);
            Plan = Plan.Empty(this.options.Seed ?? graph.Planner.Seed);
        }

        public Plan Plan { get; private set; }

        /// <summary>Seconds of the performance at the last update.</summary>
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
                settled.Remove(id);
                asked.Add(id);
            }
            catch (Exception error) when (error is AskException || error is FormatException)
            {
                id = id.Length > 0 ? id : NextId();
                Settle(new Answer { Id = id, State = "refused", Why = error.Message });
            }
            return id;
        }

        /// <summary>Keep an answer that will not change any more.</summary>
        private void Settle(Answer answer)
        {
            asked.Remove(answer.Id);
            settled[answer.Id] = answer;
            settling.Enqueue(answer.Id);
            if (settling.Count > Remembered)
            {
                settled.Remove(settling.Dequeue());
            }
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
            Now = now > Now ? Math.Min(now, Latest) : Now;
            try
            {
                PlanOn();
            }
            catch (Exception error) // a fault of the runtime's own must not stop the game: the plan stays as it is
            {
                queue.ForEach(one => Settle(new Answer { Id = one.Key.Id, State = "refused", Why = "the runtime failed: " + error }));
                queue.Clear();
            }
            events.Clear();
            Notice(seen, Now);
            seen = Now;
        }

        private void PlanOn()
        {
            bool far = Plan.End >= Now + options.Ahead - Math.Min(Slack, options.Ahead / 2);
            if (queue.Count > 0 || !far)
            {
                List<Ask> asks = queue.ConvertAll(one => one.Value == null ? one.Key : one.Key.With(one.Key.Id, Now + one.Value.Value));
                double end = far ? Plan.End : Now + options.Ahead;
                Plan = Hearing.Hear(Graph, Plan, Now, asks, end, options.Stances, options.Idle);
                asks.FindAll(ask => ask.Do == "withdraw").ForEach(ask => Settle(new Answer { Id = ask.Id, State = "done" }));
                queue.Clear();
            }
            if (Now - cutAt >= Cut)
            {
                cutAt = Now;
                Forget(Now - options.Recent);
            }
        }

        /// <summary>Forget what is over, and settle the answers of what was asked for then.</summary>
        private void Forget(double over)
        {
            foreach (string id in asked.ToList())
            {
                Answer answer = Hearing.AnswerTo(Plan, id);
                bool played = answer.Until < over;
                if (played || answer.State == "refused" || answer.State == "done")
                {
                    answer.State = played ? "done" : answer.State;
                    Settle(answer);
                }
            }
            Plan = Hearing.Since(Plan, over);
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

        /// <summary>What became of an ask: when it will play, or why it will not.</summary>
        public Answer AnswerTo(string id)
        {
            Answer known;
            if (settled.TryGetValue(id ?? "", out known))
            {
                return known;
            }
            if (!asked.Contains(id ?? ""))
            {
                return new Answer { Id = id, State = "refused", Why = "nothing was asked for as '" + id + "'" };
            }
            if (queue.Exists(one => one.Key.Id == id))
            {
                return new Answer { Id = id, State = "planned", Why = "taken up at the next update" };
            }
            return Hearing.AnswerTo(Plan, id);
        }

        /// <summary>The pose at the updated time; the same arrays each time. alive: with the life layers.</summary>
        public BodyPose Pose(bool alive = true)
        {
            player.PoseAt(Plan, Now, alive, pose);
            return pose;
        }
    }
}
