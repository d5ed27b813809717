using System;
using System.Collections.Generic;
using System.Text;

namespace Metagraph
{
    /// <summary>A binary glTF file: its JSON, and accessors as plain numbers.</summary>
    internal sealed class Glb
    {
        private const string Again = "Export it again.";
        public readonly Node Json;
        private readonly string name;
        private readonly byte[] data;
        private readonly int start, length; // of the binary chunk
        private readonly List<Node> accessors, views;
        private readonly Dictionary<int, float[]> known = new Dictionary<int, float[]>();
        private readonly Dictionary<int, byte[]> unpacked = new Dictionary<int, byte[]>(); // views

        /// <summary>Raises MetagraphException for what is no GLB or is cut off; name: for messages.</summary>
        public Glb(byte[] data, string name)
        {
            this.data = data;
            this.name = name;
            if (data == null || data.Length < 20 || Word(0) != 0x46546C67 || Word(4) != 2)
            {
                throw new MetagraphException(name, "is not a binary glTF 2.0 file (GLB)", "Give the GLB that was exported with the JSON.");
            }
            long json = Word(12);
            if (Word(8) > data.Length || 20 + json > data.Length)
            {
                throw new MetagraphException(name, "is cut off: " + data.Length + " of " + Word(8) + " bytes are there", "Copy it again.");
            }
            int at = (int)(20 + json);
            if (Word(16) != 0x4E4F534A)
            {
                throw new MetagraphException(name, "does not begin with its JSON", Again);
            }
            if (at + 8 <= data.Length && Word(at + 4) == 0x004E4942)
            {
                start = at + 8;
                length = (int)Math.Min(Word(at), data.Length - start);
            }
            try
            {
                Json = new Node(Metagraph.Json.Parse(Encoding.UTF8.GetString(data, 20, (int)json)), name);
            }
            catch (FormatException error)
            {
                throw new MetagraphException(name, error.Message, Again);
            }
            accessors = List(Json, "accessors");
            views = List(Json, "bufferViews");
        }

        private long Word(int at)
        {
            return (uint)(data[at] | data[at + 1] << 8 | data[at + 2] << 16 | data[at + 3] << 24);
        }

        /// <summary>A field of a node of the JSON that is a list; empty where it is missing.</summary>
        public static List<Node> List(Node of, string field)
        {
            Node found;
            return of.Maybe(field, out found) ? found.Items : new List<Node>();
        }

        public static int Integer(Node of, string field, int otherwise)
        {
            Node found;
            return of.Maybe(field, out found) ? found.Count : otherwise;
        }

        /// <summary>The numbers of an accessor, one after another; normalised integers as 0..1 or -1..1.</summary>
        public float[] Numbers(int accessor)
        {
            float[] found;
            if (!known.TryGetValue(accessor, out found))
            {
                known[accessor] = found = Read(accessor);
            }
            return found;
        }

        private float[] Read(int accessor)
        {
            if (accessor < 0 || accessor >= accessors.Count)
            {
                throw new MetagraphException(name, "has no accessor " + accessor, Again);
            }
            Node of = accessors[accessor], unused;
            int place = Integer(of, "bufferView", -1);
            if (of.Maybe("sparse", out unused) || place < 0 || place >= views.Count)
            {
                throw of.Wrong("is sparse or has no data, which exports never are");
            }
            int count = of["count"].Count, type = of["componentType"].Count, width = Width(of);
            int size = type == 5126 || type == 5125 ? 4 : type == 5122 || type == 5123 ? 2 : type == 5120 || type == 5121 ? 1 : 0;
            int stride = Integer(views[place], "byteStride", size * width);
            byte[] packed = Unpacked(place);
            byte[] from = packed ?? data;
            int begin = packed == null ? start : 0, most = packed == null ? length : packed.Length;
            long at = (packed == null ? Integer(views[place], "byteOffset", 0) : 0L) + Integer(of, "byteOffset", 0);
            if (size == 0 || count < 0 || at < 0 || (count > 0 && at + (long)stride * (count - 1) + size * width > most))
            {
                throw of.Wrong("lies outside the file's data; the file is cut off or damaged");
            }
            Node normal;
            bool normalized = of.Maybe("normalized", out normal) && normal.Flag;
            var found = new float[count * width];
            for (int n = 0; n < found.Length; n++)
            {
                found[n] = Number(from, (int)(begin + at + (long)stride * (n / width) + size * (n % width)), type, normalized);
            }
            return found;
        }

        /// <summary>The bytes of a view that is packed, null where it is not.</summary>
        private byte[] Unpacked(int view)
        {
            Node extensions, packed, filter;
            byte[] found;
            if (unpacked.TryGetValue(view, out found) || !views[view].Maybe("extensions", out extensions)
                || !extensions.Maybe("EXT_meshopt_compression", out packed))
            {
                return found;
            }
            int at = Integer(packed, "byteOffset", 0), size = packed["byteLength"].Count;
            if (at < 0 || size < 0 || (long)at + size > length)
            {
                throw packed.Wrong("lies outside the file's data; the file is cut off or damaged");
            }
            string kind = packed.Maybe("filter", out filter) ? filter.Text : "NONE";
            try
            {
                int count = packed["count"].Count, stride = packed["byteStride"].Count;
                return unpacked[view] = Meshopt.Unpacked(data, start + at, size, count, stride, packed["mode"].Text, kind);
            }
            catch (FormatException error)
            {
                throw packed.Wrong(error.Message);
            }
        }

        private static int Width(Node accessor)
        {
            string type = accessor["type"].Text;
            int place = Array.IndexOf(new[] { "SCALAR", "VEC2", "VEC3", "VEC4" }, type);
            return place >= 0 ? place + 1 : type == "MAT4" ? 16 : 1;
        }

        private static float Number(byte[] data, int at, int type, bool normalized)
        {
            switch (type)
            {
                case 5126:
                    return BitConverter.ToSingle(data, at); // all that Unity runs on is little-endian, as glTF is
                case 5125:
                    return BitConverter.ToUInt32(data, at);
                case 5123:
                    return (data[at] | data[at + 1] << 8) / (normalized ? 65535f : 1f);
                case 5122:
                    return Math.Max((short)(data[at] | data[at + 1] << 8) / (normalized ? 32767f : 1f), normalized ? -1f : float.MinValue);
                case 5121:
                    return data[at] / (normalized ? 255f : 1f);
                default:
                    return Math.Max((sbyte)data[at] / (normalized ? 127f : 1f), normalized ? -1f : float.MinValue);
            }
        }
    }
}
