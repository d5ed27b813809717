using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The words and visemes of a line as synthesisers tell them in JSON: pairs and triples, Amazon Polly's speech marks, Azure's
    /// events.
    /// </summary>
    internal static class ToldTiming
    {
        private const double Thousand = 1e3, Ticks = 1e7; // of a second, in which Polly and Azure count

        /// <summary>When a line's words and shapes come; null where that is not told. Raises AskException naming the entry.</summary>
        public static LineTiming Of(
            List<object> words, List<object> visemes, List<object> characters, string set, double? duration)
        {
            var said = new List<SpokenWord>();
            var marks = new List<VisemeMark>();
            for (int n = 0; n < words.Count; n++)
            {
                if (!AddWord(words[n], said, false))
                {
                    throw new AskException("words[" + n + "]: should be [word, start, end], seconds from the line's start");
                }
            }
            var letters = new List<SpokenWord>();
            for (int n = 0; n < characters.Count; n++)
            {
                if (!AddWord(characters[n], letters, false))
                {
                    throw new AskException("characters[" + n + "]: should be [letter, start, end], seconds from the line's start");
                }
            }
            if (said.Count == 0)
            {
                said = LineTimingRules.JoinLetters(Alphabet.Common, letters);
            }
            for (int n = 0; n < visemes.Count; n++)
            {
                if (!AddMark(visemes[n], marks) && !AddWord(visemes[n], said, true))
                {
                    throw new AskException("visemes[" + n + "]: should be [seconds, viseme], or with its weight from 0 to 1");
                }
            }
            if (said.Count == 0 && marks.Count == 0)
            {
                return null;
            }
            string why = LineTimingRules.WrongIn(said, marks, set ?? "", duration);
            if (why != "")
            {
                throw new AskException(why);
            }
            return LineTimingRules.TimingOf(Alphabet.Common, said, marks, set ?? "");
        }

        private static double? Number(object value, double of = 1.0)
        {
            return value is long ? (long)value / of : value is double ? (double)value / of : (double?)null;
        }

        private static object Field(JsonObject entry, params string[] names)
        {
            string name = names.FirstOrDefault(entry.Has);
            return name == null ? null : entry[name];
        }

        /// <summary>Add the word an entry tells; whether it is one. named: only where it says so itself.</summary>
        private static bool AddWord(object entry, List<SpokenWord> words, bool named)
        {
            object text;
            double? start, end = null;
            var fields = entry as JsonObject;
            var items = entry as List<object>;
            if (fields != null)
            {
                string kind = Field(fields, "type") as string ?? "";
                if (kind == "sentence" || kind == "ssml") // marks of Polly's that no mouth needs
                {
                    return true;
                }
                if (named && kind != "word")
                {
                    return false;
                }
                if (kind == "word")
                {
                    text = Field(fields, "value");
                    start = Number(Field(fields, "time"), Thousand);
                }
                else if (fields.Has("audioOffset"))
                {
                    text = Field(fields, "text");
                    start = Number(fields["audioOffset"], Ticks);
                    end = (Number(fields["audioOffset"]) + Number(Field(fields, "duration"))) / Ticks;
                }
                else
                {
                    text = Field(fields, "word", "text", "character");
                    start = Number(Field(fields, "start"));
                    end = Number(Field(fields, "end"));
                    if (end == null && Field(fields, "end") != null)
                    {
                        return false;
                    }
                }
            }
            else if (!named && items != null && (items.Count == 2 || items.Count == 3))
            {
                text = items[0];
                start = Number(items[1]);
                end = items.Count == 3 ? Number(items[2]) : null;
                if (items.Count == 3 && end == null && items[2] != null)
                {
                    return false;
                }
            }
            else
            {
                return false;
            }
            if (!(text is string) || start == null)
            {
                return false;
            }
            words.Add(new SpokenWord((string)text, start.Value, end));
            return true;
        }

        /// <summary>Add the visemes an entry tells; whether it tells any.</summary>
        private static bool AddMark(object entry, List<VisemeMark> marks)
        {
            object id;
            double? at, weight = 1.0;
            var fields = entry as JsonObject;
            var items = entry as List<object>;
            if (fields != null)
            {
                if ((Field(fields, "type") ?? "viseme") as string != "viseme")
                {
                    return false;
                }
                var weights = Field(fields, "weights") as JsonObject;
                if (fields.Has("type"))
                {
                    at = Number(Field(fields, "time"), Thousand);
                    id = Field(fields, "value");
                }
                else if (fields.Has("audioOffset"))
                {
                    at = Number(fields["audioOffset"], Ticks);
                    id = Field(fields, "visemeId");
                }
                else if (weights != null)
                {
                    object time = Field(fields, "time");
                    return weights.Names.All(name => AddMark(new List<object> { time, name, weights[name] }, marks));
                }
                else
                {
                    at = Number(Field(fields, "time"));
                    id = Field(fields, "viseme", "id");
                    weight = fields.Has("weight") ? Number(fields["weight"]) : 1.0;
                }
            }
            else if (items != null && (items.Count == 2 || items.Count == 3))
            {
                at = Number(items[0]);
                id = items[1];
                weight = items.Count == 3 ? Number(items[2]) : 1.0;
            }
            else
            {
                return false;
            }
            double? number = Number(id);
            string viseme = number != null && number == Math.Floor(number.Value)
                ? number.Value.ToString("0", CultureInfo.InvariantCulture)
                : id as string;
            if (at == null || weight == null || viseme == null)
            {
                return false;
            }
            marks.Add(new VisemeMark(at.Value, viseme, weight.Value));
            return true;
        }
    }
}
