using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A named value that a game sets without knowing any clip, stance or graph: a typed name for a request. Type: number, boolean, enum,
    /// list, point or trigger. Request, Field: what setting it asks for, and which field its value goes into. Choices: words and what
    /// they put there; of a boolean for off, then for on. Beside: parameters that fill other fields of the same.
    /// Replaces: those that are bound to the same.
    /// </summary>
    public sealed class Parameter
    {
        private static readonly string[] Types = { "number", "boolean", "enum", "list", "point", "trigger" };

        public string Type, Field = "", About = "";
        public JsonObject Request;
        public object Initial;
        public readonly List<KeyValuePair<string, object>> Choices = new List<KeyValuePair<string, object>>();
        public double Least, Most = 1.0;
        public string[] Beside = new string[0], Replaces = new string[0];

        internal static Parameter Read(Node json)
        {
            Node found;
            var one = new Parameter { Type = json["type"].OneOf(Types), Request = json["request"].Value as JsonObject };
            if (one.Request == null)
            {
                throw json.Wrong("should have a request");
            }
            one.Field = json.Maybe("field", out found) ? found.Text : "";
            one.About = json.Maybe("about", out found) ? found.Text : "";
            one.Initial = json.Maybe("initial", out found) ? Plain(found.Value) : null;
            one.Least = json.Maybe("least", out found) ? found.Number : 0.0;
            one.Most = json.Maybe("most", out found) ? found.Number : 1.0;
            one.Beside = json.Maybe("beside", out found) ? found.Texts : new string[0];
            one.Replaces = json.Maybe("replaces", out found) ? found.Texts : new string[0];
            if (json.Maybe("choices", out found))
            {
                found.Items.ForEach(item => one.Choices.Add(new KeyValuePair<string, object>(item["name"].Text, item["value"].Value)));
            }
            if (one.Type == "boolean" && one.Choices.Count != 2)
            {
                throw json.Wrong("should have two choices");
            }
            return one;
        }

        /// <summary>A value as JSON has it: null, bool, double, string, List of object.</summary>
        internal static object Plain(object value)
        {
            if (value is long || value is int || value is float || value is double)
            {
                return Convert.ToDouble(value, CultureInfo.InvariantCulture);
            }
            var several = value as System.Collections.IEnumerable;
            if (value is string || several == null)
            {
                return value;
            }
            return several.Cast<object>().Select(Plain).ToList();
        }

        internal List<object> Names
        {
            get { return Choices.ConvertAll(choice => (object)choice.Key); }
        }

        /// <summary>A value as it is kept. Raises AskException for one of another type.</summary>
        internal object Kept(object given)
        {
            object value = Plain(given);
            var items = value as List<object>;
            string names = string.Join(", ", Names.Cast<string>().ToArray());
            switch (Type)
            {
                case "trigger":
                    return value == null ? value : throw Wrong("a trigger has none");
                case "number":
                    bool number = value is double && !double.IsNaN((double)value);
                    return number ? Math.Min(Math.Max((double)value, Least), Most) : throw Wrong("should be a number");
                case "boolean":
                    return value is bool ? value : throw Wrong("should be true or false");
                case "enum":
                    return value is string && Names.Contains(value) ? value : throw Wrong("should be one of " + names);
                case "list":
                    bool known = items != null && items.TrueForAll(Names.Contains);
                    return known ? Names.FindAll(items.Contains) : throw Wrong("should be a list of " + names);
                default:
                    bool point = items != null && items.Count == 3 && items.TrueForAll(x => x is double && Math.Abs((double)x) <= 1e6);
                    return point ? value : throw Wrong("should be three numbers, metres");
            }
        }

        private static AskException Wrong(string what)
        {
            return new AskException("value: " + what);
        }

        /// <summary>What a value puts into the request's field.</summary>
        internal object Filled(object value)
        {
            switch (Type)
            {
                case "boolean":
                    return Choices[(bool)value ? 1 : 0].Value;
                case "enum":
                    return Choices.Find(choice => choice.Key == (string)value).Value;
                case "list":
                    return Choices.FindAll(choice => ((List<object>)value).Contains(choice.Key)).ConvertAll(choice => choice.Value);
                default:
                    return value;
            }
        }

        internal JsonObject Described()
        {
            var found = new JsonObject();
            found["type"] = Type;
            found["about"] = About;
            if (Type != "trigger")
            {
                found["initial"] = Initial;
            }
            if (Type == "number")
            {
                found["least"] = Least;
                found["most"] = Most;
            }
            if (Type == "enum" || Type == "list")
            {
                found["choices"] = Names;
            }
            return found;
        }

        internal static bool Same(object a, object b)
        {
            var first = a as List<object>;
            var second = b as List<object>;
            return first != null && second != null ? first.SequenceEqual(second) : Equals(a, b);
        }
    }

    /// <summary>The values that a character's parameters were set to.</summary>
    public sealed class ParameterValues
    {
        private readonly Dictionary<string, Parameter> parameters;
        private readonly Dictionary<string, object> values = new Dictionary<string, object>();
        private readonly Dictionary<string, string> made = new Dictionary<string, string>(); // ids of the latest requests

        public ParameterValues(Dictionary<string, Parameter> parameters)
        {
            this.parameters = parameters;
        }

        public object Get(string name)
        {
            Parameter parameter;
            object value;
            if (!parameters.TryGetValue(name ?? "", out parameter))
            {
                return null;
            }
            return values.TryGetValue(name, out value) ? value : parameter.Initial;
        }

        /// <summary>Set one; returns the request's id. Raises AskException for what cannot be set.</summary>
        public string Set(string name, object given, Func<string, string> ask)
        {
            Parameter parameter;
            if (!parameters.TryGetValue(name ?? "", out parameter))
            {
                throw new AskException("name: there is no parameter '" + name + "'");
            }
            object value = parameter.Kept(given), before;
            if (parameter.Type == "trigger")
            {
                return ask(Json.Write(parameter.Request));
            }
            if (values.TryGetValue(name, out before) && Parameter.Same(before, value))
            {
                return made[name];
            }
            var request = new JsonObject();
            parameter.Request.Names.ForEach(field => request[field] = parameter.Request[field]);
            request[parameter.Field] = parameter.Filled(value);
            foreach (string other in parameter.Beside)
            {
                if (parameters.ContainsKey(other) && values.TryGetValue(other, out before))
                {
                    request[parameters[other].Field] = parameters[other].Filled(before);
                }
            }
            foreach (string other in parameter.Replaces)
            {
                values.Remove(other);
            }
            values[name] = value;
            made[name] = ask(Json.Write(request));
            return made[name];
        }
    }
}
