using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A value of an export with its place in the JSON, so that what is wrong can be named.</summary>
    internal sealed class Node
    {
        private const string Remedy = "Export it again.";
        public readonly object Value;
        private readonly Node parent;
        private readonly string name; // of the file, or the field in the parent
        private readonly int place; // in the parent, -1 for a field

        public Node(object value, string name)
        {
            Value = value;
            this.name = name;
        }

        private Node(object value, Node parent, string name, int place)
        {
            Value = value;
            this.parent = parent;
            this.name = name;
            this.place = place;
        }

        /// <summary>Put together only for messages: an export has a hundred thousand values.</summary>
        public string Where
        {
            get { return parent == null ? name : parent.Where + (place >= 0 ? "[" + place + "]" : "." + name); }
        }

        public MetagraphException Wrong(string what)
        {
            return new MetagraphException(Where, what, Remedy);
        }

        public bool IsNull
        {
            get { return Value == null; }
        }

        /// <summary>A field that must be there.</summary>
        public Node this[string name]
        {
            get
            {
                Node found;
                if (!Maybe(name, out found))
                {
                    throw Wrong("'" + name + "' is missing");
                }
                return found;
            }
        }

        /// <summary>A field that may be missing; whether it is there.</summary>
        public bool Maybe(string name, out Node found)
        {
            JsonObject fields = Object;
            bool there = fields.Has(name);
            found = new Node(there ? fields[name] : null, this, name, -1);
            return there;
        }

        private JsonObject Object
        {
            get
            {
                var fields = Value as JsonObject;
                if (fields == null)
                {
                    throw Wrong("should be an object");
                }
                return fields;
            }
        }

        public IEnumerable<string> Names
        {
            get { return Object.Names; }
        }

        public List<Node> Items
        {
            get
            {
                var values = Value as List<object>;
                if (values == null)
                {
                    throw Wrong("should be a list");
                }
                var found = new List<Node>(values.Count);
                for (int n = 0; n < values.Count; n++)
                {
                    found.Add(new Node(values[n], this, null, n));
                }
                return found;
            }
        }

        public string Text
        {
            get
            {
                var text = Value as string;
                if (text == null)
                {
                    throw Wrong("should be a text");
                }
                return text;
            }
        }

        public string TextOrNull
        {
            get { return Value == null ? null : Text; }
        }

        public string OneOf(string[] words)
        {
            if (Array.IndexOf(words, Text) < 0)
            {
                throw Wrong("should be one of " + string.Join(", ", words));
            }
            return Text;
        }

        public double Number
        {
            get
            {
                if (Value is long)
                {
                    return (long)Value;
                }
                if (Value is double)
                {
                    return (double)Value;
                }
                throw Wrong("should be a number");
            }
        }

        /// <summary>A number of a range.</summary>
        public double Within(double low, double high)
        {
            if (!(Number >= low && Number <= high))
            {
                throw Wrong("is out of range");
            }
            return Number;
        }

        public double? NumberOrNull
        {
            get { return Value == null ? (double?)null : Number; }
        }

        public int Count
        {
            get
            {
                double number = Number;
                if (number != Math.Floor(number) || number < -1 || number > 1e9)
                {
                    throw Wrong("should be a whole number");
                }
                return (int)number;
            }
        }

        public bool Flag
        {
            get
            {
                if (!(Value is bool))
                {
                    throw Wrong("should be true or false");
                }
                return (bool)Value;
            }
        }

        public string[] Texts
        {
            get { return Items.ConvertAll(item => item.Text).ToArray(); }
        }

        /// <summary>A list of so many numbers; any number of them where count is negative.</summary>
        public double[] Numbers(int count)
        {
            double[] found = Items.ConvertAll(item => item.Number).ToArray();
            if (count >= 0 && found.Length != count)
            {
                throw Wrong("should have " + count + " numbers");
            }
            return found;
        }
    }
}
