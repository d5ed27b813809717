using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace Metagraph
{
    /// <summary>A JSON object: values by name, names in the order of the text.</summary>
    public sealed class JsonObject
    {
        public readonly List<string> Names = new List<string>();
        private readonly Dictionary<string, object> values = new Dictionary<string, object>(StringComparer.Ordinal);

        public object this[string name]
        {
            get { return values[name]; }
            set
            {
                if (!values.ContainsKey(name))
                {
                    Names.Add(name);
                }
                values[name] = value;
            }
        }

        public bool Has(string name)
        {
            return values.ContainsKey(name);
        }
    }

    /// <summary>Reads JSON (RFC 8259): null, bool, long, double, string, List of object, JsonObject. Raises FormatException.</summary>
    public sealed class Json
    {
        private const int Deepest = 100;
        private readonly string text;
        private int at;

        private Json(string text)
        {
            this.text = text;
        }

        public static object Parse(string text)
        {
            var reader = new Json(text);
            object found = reader.Value(0);
            reader.Blanks();
            if (reader.at < text.Length)
            {
                throw reader.Wrong("something follows its end");
            }
            return found;
        }

        /// <summary>A text as JSON: in quotes, with what may not stand in them escaped.</summary>
        public static string Quote(string text)
        {
            var found = new StringBuilder("\"");
            foreach (char c in text ?? "")
            {
                bool plain = c >= ' ' && c != '"' && c != '\\';
                found.Append(plain ? c.ToString() : "\\u" + ((int)c).ToString("x4", CultureInfo.InvariantCulture));
            }
            return found.Append('"').ToString();
        }

        /// <summary>The JSON of what `Parse` returns: null, bool, long, double, string, List of object, JsonObject.</summary>
        public static string Write(object value)
        {
            var fields = value as JsonObject;
            var items = value as List<object>;
            if (fields != null)
            {
                return "{" + string.Join(",", fields.Names.ConvertAll(name => Quote(name) + ":" + Write(fields[name])).ToArray()) + "}";
            }
            if (items != null)
            {
                return "[" + string.Join(",", items.ConvertAll(Write).ToArray()) + "]";
            }
            if (value is bool)
            {
                return (bool)value ? "true" : "false";
            }
            if (value is double)
            {
                return ((double)value).ToString("R", CultureInfo.InvariantCulture);
            }
            return value == null ? "null" : value is long ? ((long)value).ToString(CultureInfo.InvariantCulture) : Quote((string)value);
        }

        private FormatException Wrong(string what)
        {
            return new FormatException("not JSON: " + what + " (character " + at.ToString(CultureInfo.InvariantCulture) + ")");
        }

        private void Blanks()
        {
            while (at < text.Length && (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r'))
            {
                at++;
            }
        }

        private char Next()
        {
            Blanks();
            if (at >= text.Length)
            {
                throw Wrong("it ends too early");
            }
            return text[at];
        }

        private void Take(string word)
        {
            if (string.CompareOrdinal(text, at, word, 0, word.Length) != 0)
            {
                throw Wrong("unexpected '" + text[at] + "'");
            }
            at += word.Length;
        }

        private object Value(int depth)
        {
            if (depth > Deepest)
            {
                throw Wrong("it is nested too deeply");
            }
            switch (Next())
            {
                case '{':
                    return Object(depth);
                case '[':
                    return Array(depth);
                case '"':
                    return Text();
                case 't':
                    Take("true");
                    return true;
                case 'f':
                    Take("false");
                    return false;
                case 'n':
                    Take("null");
                    return null;
                default:
                    return Number();
            }
        }

        private JsonObject Object(int depth)
        {
            var found = new JsonObject();
            at++;
            if (Next() == '}')
            {
                at++;
                return found;
            }
            while (true)
            {
                if (Next() != '"')
                {
                    throw Wrong("a name is missing");
                }
                string name = Text();
                if (Next() != ':')
                {
                    throw Wrong("a colon is missing");
                }
                at++;
                found[name] = Value(depth + 1);
                char c = Next();
                at++;
                if (c == '}')
                {
                    return found;
                }
                if (c != ',')
                {
                    throw Wrong("a comma is missing");
                }
            }
        }

        private List<object> Array(int depth)
        {
            var found = new List<object>();
            at++;
            if (Next() == ']')
            {
                at++;
                return found;
            }
            while (true)
            {
                found.Add(Value(depth + 1));
                char c = Next();
                at++;
                if (c == ']')
                {
                    return found;
                }
                if (c != ',')
                {
                    throw Wrong("a comma is missing");
                }
            }
        }

        private object Number()
        {
            int start = at;
            bool whole = true;
            if (at < text.Length && text[at] == '-')
            {
                at++;
            }
            int first = at;
            Digits();
            if (text[first] == '0' && at > first + 1)
            {
                throw Wrong("a number begins with 0");
            }
            if (at < text.Length && text[at] == '.')
            {
                at++;
                Digits();
                whole = false;
            }
            if (at < text.Length && (text[at] == 'e' || text[at] == 'E'))
            {
                at++;
                if (at < text.Length && (text[at] == '+' || text[at] == '-'))
                {
                    at++;
                }
                Digits();
                whole = false;
            }
            string word = text.Substring(start, at - start);
            long integer;
            if (whole && long.TryParse(word, NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture, out integer))
            {
                return integer;
            }
            double value;
            if (!double.TryParse(word, NumberStyles.Float, CultureInfo.InvariantCulture, out value) || double.IsInfinity(value))
            {
                throw Wrong("a number is out of range");
            }
            return value;
        }

        private void Digits()
        {
            int start = at;
            while (at < text.Length && text[at] >= '0' && text[at] <= '9')
            {
                at++;
            }
            if (at == start)
            {
                throw Wrong(at < text.Length ? "unexpected '" + text[at] + "'" : "it ends too early");
            }
        }

        private string Text()
        {
            int start = ++at;
            while (at < text.Length && text[at] != '"' && text[at] != '\\' && text[at] >= ' ')
            {
                at++;
            }
            if (at < text.Length && text[at] == '"')
            {
                return text.Substring(start, at++ - start);
            }
            var found = new StringBuilder(text, start, at - start, 64);
            while (at < text.Length && text[at] >= ' ')
            {
                char c = text[at++];
                if (c == '"')
                {
                    return Paired(found.ToString());
                }
                found.Append(c == '\\' ? Escaped() : c);
            }
            throw Wrong("a text does not end, or holds a control character");
        }

        private char Escaped()
        {
            const string Signs = "\"\\/bfnrt", Meant = "\"\\/\b\f\n\r\t";
            char c = at < text.Length ? text[at++] : '\0';
            if (c != 'u')
            {
                int place = Signs.IndexOf(c);
                if (place < 0)
                {
                    throw Wrong("an escape is unknown");
                }
                return Meant[place];
            }
            ushort code;
            string digits = at + 4 <= text.Length ? text.Substring(at, 4) : "";
            if (!ushort.TryParse(digits, NumberStyles.AllowHexSpecifier, CultureInfo.InvariantCulture, out code))
            {
                throw Wrong("an escape is unknown");
            }
            at += 4;
            return (char)code;
        }

        /// <summary>The text, if every surrogate in it has its other half: half a character has no UTF-8 to be hashed by.</summary>
        private string Paired(string found)
        {
            for (int i = 0; i < found.Length; i++)
            {
                if (char.IsSurrogate(found[i]) && !(i + 1 < found.Length && char.IsSurrogatePair(found[i], found[++i])))
                {
                    throw Wrong("half a character");
                }
            }
            return found;
        }
    }
}
