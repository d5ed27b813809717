/**
 * Buffer views packed as EXT_meshopt_compression says: attributes, triangles, indices, and the filters. After the specification of the
 * extension (Khronos Group, appendices A and B). `MeshoptDecoder` is what three.js's GLTFLoader takes by `setMeshoptDecoder`.
 */

const GROUP = 16; // elements whose deltas are stored together

/** Packed data is damaged, or of a kind that is not known; the message says how. */
export class MeshoptError extends Error {}

/** Return `count` elements of `size` bytes. @param {Uint8Array} data @param {string} mode @param {string} [filter] @returns {Uint8Array} */
export function unpacked(data, count, size, mode, filter = "NONE") {
  const out = new Uint8Array(count * size);
  if (mode === "ATTRIBUTES") {
    attributes(out, data, count, size);
    unfilter(out, size, filter);
    return out;
  }
  const read = { TRIANGLES: triangles, INDICES: indices }[mode];
  if (!read || (size !== 2 && size !== 4)) throw new MeshoptError(`is packed in a way that is not known (${mode}, ${size} bytes)`);
  read(size === 2 ? new Uint16Array(out.buffer) : new Uint32Array(out.buffer), data);
  return out;
}

export const MeshoptDecoder = {
  supported: true,
  ready: Promise.resolve(),
  decodeGltfBuffer: (target, count, size, source, mode, filter) => target.set(unpacked(source, count, size, mode, filter)),
};

function attributes(out, data, count, size) {
  const tail = Math.max(32, size);
  if (size <= 0 || size % 4 || size > 256 || data.length < 1 + tail || data[0] !== 0xa0) throw new MeshoptError("has packed attributes that are cut short");
  const block = Math.min(Math.floor(8192 / size) & ~(GROUP - 1), 256), end = data.length - tail;
  const before = Uint8Array.from(data.subarray(data.length - size)); // the element before; Node's buffers are not copied by slice
  let at = 1;
  for (let first = 0; first < count; first += block) {
    const elements = Math.min(block, count - first), groups = Math.ceil(elements / GROUP);
    for (let k = 0; k < size; k++) {
      const head = at;
      let value = before[k];
      at += Math.ceil(groups / 4);
      for (let g = 0, n = 0; g < groups; g++) {
        const mode = (data[head + (g >> 2)] >> ((g & 3) * 2)) & 3;
        const bits = 1 << mode, most = (1 << bits) - 1; // for modes 1 and 2
        let later = at + 4 * mode;
        for (let i = 0; i < GROUP; i++, n++) {
          let delta = 0;
          if (mode === 3) delta = data[at + i];
          else if (mode) {
            delta = (data[at + ((i * bits) >> 3)] >> (8 - bits - ((i * bits) & 7))) & most;
            if (delta === most) delta = data[later++];
          }
          value = (value + ((delta & 1) !== 0 ? ~(delta >> 1) : delta >> 1)) & 255;
          if (n < elements) {
            out[(first + n) * size + k] = value;
            before[k] = value;
          }
        }
        at = mode === 3 ? at + GROUP : later;
      }
      if (at > end) throw new MeshoptError("has packed attributes that are cut short");
    }
  }
  if (at !== end) throw new MeshoptError("has packed attributes that end too early");
}

/** Turn attributes into what they were before a filter. */
function unfilter(bytes, size, filter) {
  if (filter === "EXPONENTIAL") {
    const whole = new Int32Array(bytes.buffer), floats = new Float32Array(bytes.buffer);
    for (let n = 0; n < whole.length; n++) floats[n] = ((whole[n] << 8) >> 8) * 2 ** (whole[n] >> 24);
  } else if (filter === "QUATERNION" && size === 8) {
    const values = new Int16Array(bytes.buffer);
    for (let n = 0; n < values.length; n += 4) {
      const largest = values[n + 3] & 3, scale = Math.SQRT1_2 / (values[n + 3] | 3);
      const x = values[n] * scale, y = values[n + 1] * scale, z = values[n + 2] * scale;
      values[n + ((largest + 1) & 3)] = Math.round(x * 32767);
      values[n + ((largest + 2) & 3)] = Math.round(y * 32767);
      values[n + ((largest + 3) & 3)] = Math.round(z * 32767);
      values[n + largest] = Math.round(Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z)) * 32767);
    }
  } else if (filter === "OCTAHEDRAL" && (size === 4 || size === 8)) {
    const values = size === 4 ? new Int8Array(bytes.buffer) : new Int16Array(bytes.buffer), most = size === 4 ? 127 : 32767;
    for (let n = 0; n < values.length; n += 4) {
      let [x, y] = [values[n] / values[n + 2], values[n + 1] / values[n + 2]];
      const z = 1 - Math.abs(x) - Math.abs(y), fold = Math.min(z, 0);
      x -= x < 0 ? fold : -fold;
      y -= y < 0 ? fold : -fold;
      const scale = most / Math.hypot(x, y, z);
      [values[n], values[n + 1], values[n + 2]] = [Math.round(x * scale), Math.round(y * scale), Math.round(z * scale)];
    }
  } else if (filter !== "NONE") throw new MeshoptError(`is packed with a filter that is not known (${filter}, ${size} bytes)`);
}

/** Bytes read one after another. */
class Source {
  constructor(data, at) {
    Object.assign(this, { data, at });
  }

  byte() {
    if (this.at >= this.data.length) throw new MeshoptError("has packed indices that are cut short");
    return this.data[this.at++];
  }

  /** An integer of 7 bits a byte, the lowest first, with its sign in its lowest bit. */
  number() {
    let out = 0;
    for (let shift = 0, byte = 128; byte > 127 && shift < 35; shift += 7) {
      byte = this.byte();
      out |= (byte & 127) << shift;
    }
    return out >>> 0;
  }
}

const signed = (value) => (value & 1 ? ~(value >>> 1) : value >>> 1);

function indices(out, data) {
  if (data.length < 5 || data[0] !== 0xd1) throw new MeshoptError("has packed indices that are cut short");
  const source = new Source(data.subarray(0, data.length - 4), 1), last = [0, 0];
  for (let n = 0; n < out.length; n++) {
    const value = source.number();
    out[n] = last[value & 1] = last[value & 1] + signed(value >>> 1);
  }
}

function triangles(out, data) {
  const count = out.length / 3;
  if (count % 1 || data.length < 17 + count || data[0] !== 0xe1) throw new MeshoptError("has packed triangles that are cut short");
  const table = data.subarray(data.length - 16), source = new Source(data.subarray(0, data.length - 16), 1 + count);
  const edges = new Int32Array(32), recent = new Int32Array(16); // each a ring; the place behind the latest
  let edge = 0, vertex = 0, next = 0, last = 0;
  const push = (a, b) => {
    [edges[2 * edge], edges[2 * edge + 1]] = [a, b];
    edge = (edge + 1) & 15;
  };
  const keep = (a) => {
    recent[vertex] = a;
    vertex = (vertex + 1) & 15;
  };
  const known = (place) => recent[(vertex - 1 - place) & 15];
  const told = () => (last += signed(source.number()));
  for (let n = 0; n < count; n++) {
    const high = data[1 + n] >> 4, low = data[1 + n] & 15;
    let a, b, c;
    if (high < 15) {
      const place = 2 * ((edge - 1 - high) & 15);
      [a, b] = [edges[place], edges[place + 1]];
      if (low > 0 && low < 13) c = known(low);
      else {
        c = low === 0 ? next++ : low === 15 ? told() : (last += low === 14 ? 1 : -1);
        keep(c);
      }
    } else {
      const extra = low < 14 ? table[low] : source.byte();
      if (low >= 14 && extra === 0) next = 0;
      a = low === 15 ? told() : next++;
      const other = (place) => (place === 0 ? next++ : place === 15 && low >= 14 ? told() : known(place - 1));
      b = other(extra >> 4);
      c = other(extra & 15);
      keep(a);
      if (extra >> 4 === 0 || extra >> 4 === 15) keep(b);
      if ((extra & 15) === 0 || (extra & 15) === 15) keep(c);
      push(b, a);
    }
    push(c, b);
    push(a, c);
    [out[3 * n], out[3 * n + 1], out[3 * n + 2]] = [a, b, c];
  }
}
