using System;

namespace Metagraph
{
    /// <summary>
    /// Animations' buffer views packed as EXT_meshopt_compression says: attributes, and the filters that turns and moves have. After the
    /// specification of the extension (Khronos Group, appendices A and B).
    /// </summary>
    internal static class Meshopt
    {
        private const int Group = 16;

        /// <summary>`count` elements of `size` bytes. Raises FormatException for what is cut short or not known.</summary>
        public static byte[] Unpacked(byte[] data, int start, int length, int count, int size, string mode, string filter)
        {
            if (mode != "ATTRIBUTES" || size <= 0 || size % 4 != 0 || size > 256)
            {
                throw new FormatException("is packed in a way that animations are not");
            }
            byte[] values;
            try
            {
                values = Attributes(data, start, length, count, size);
            }
            catch (IndexOutOfRangeException)
            {
                throw new FormatException("has packed attributes that are cut short");
            }
            Unfilter(values, size, filter);
            return values;
        }

        private static byte[] Attributes(byte[] data, int start, int length, int count, int size)
        {
            int tail = Math.Max(32, size), end = start + length - tail;
            int block = Math.Min(8192 / size & ~(Group - 1), 256);
            // A block has a header of some bits for each group at least.
            if (length < 1 + tail || count < 0 || (long)(count / block) * size > length || data[start] != 0xA0)
            {
                throw new FormatException("has packed attributes that are cut short");
            }
            var found = new byte[count * size];
            var before = new byte[size];
            Array.Copy(data, start + length - size, before, 0, size);
            int at = start + 1;
            for (int first = 0; first < count; first += block)
            {
                int elements = Math.Min(block, count - first), groups = (elements + Group - 1) / Group;
                for (int k = 0; k < size; k++)
                {
                    int head = at, value = before[k];
                    at += (groups + 3) / 4;
                    for (int g = 0, n = 0; g < groups; g++)
                    {
                        int mode = data[head + g / 4] >> g % 4 * 2 & 3, bits = 1 << mode, most = (1 << bits) - 1, later = at + 4 * mode;
                        for (int i = 0; i < Group; i++, n++)
                        {
                            int delta = 0;
                            if (mode == 3)
                            {
                                delta = data[at + i];
                            }
                            else if (mode != 0)
                            {
                                delta = data[at + i * bits / 8] >> 8 - bits - i * bits % 8 & most;
                                delta = delta == most ? data[later++] : delta;
                            }
                            value = value + ((delta & 1) != 0 ? ~(delta >> 1) : delta >> 1) & 255;
                            if (n < elements)
                            {
                                found[(first + n) * size + k] = (byte)value;
                                before[k] = (byte)value;
                            }
                        }
                        at = mode == 3 ? at + Group : later;
                    }
                }
            }
            if (at != end)
            {
                throw new FormatException("has packed attributes that are cut short");
            }
            return found;
        }

        private static void Unfilter(byte[] bytes, int size, string filter)
        {
            if (filter == "EXPONENTIAL")
            {
                for (int n = 0; n + 4 <= bytes.Length; n += 4)
                {
                    int mantissa = bytes[n] | bytes[n + 1] << 8 | (sbyte)bytes[n + 2] << 16;
                    BitConverter.GetBytes((float)(mantissa * Math.Pow(2.0, (sbyte)bytes[n + 3]))).CopyTo(bytes, n);
                }
            }
            else if (filter == "QUATERNION" && size == 8)
            {
                var values = new double[4];
                for (int n = 0; n + 8 <= bytes.Length; n += 8)
                {
                    int told = BitConverter.ToInt16(bytes, n + 6);
                    double left = 1, scale = Math.Sqrt(0.5) / (told | 3);
                    for (int k = 0; k < 3; k++)
                    {
                        values[k] = BitConverter.ToInt16(bytes, n + 2 * k) * scale;
                        left -= values[k] * values[k];
                    }
                    values[3] = Math.Sqrt(Math.Max(0, left));
                    for (int k = 0; k < 4; k++)
                    {
                        int place = n + 2 * (told + 1 + k & 3);
                        var whole = (short)Math.Round(values[k] * 32767);
                        bytes[place] = (byte)(whole & 255);
                        bytes[place + 1] = (byte)(whole >> 8 & 255);
                    }
                }
            }
            else if (filter != "NONE")
            {
                throw new FormatException("is packed with a filter that animations do not have here");
            }
        }
    }
}
