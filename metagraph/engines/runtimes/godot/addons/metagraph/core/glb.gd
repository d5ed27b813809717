# A binary glTF file, as far as motion goes: its nodes and animations. Numbers are read from the bytes when they are needed.

const Util = preload("util.gd")
const SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5126: 4}
const STEPS = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}  # of normalised integers in one
const WIDTHS = {SCALAR = 1, VEC2 = 2, VEC3 = 3, VEC4 = 4, MAT4 = 16}

var error = ""  # what is wrong with the file, in words; "" when nothing is
var nodes = []
var animations = []
var meshes = []
var _stream = StreamPeerBuffer.new()
var _data = {}
var _begin = 0  # of the binary chunk
var _size = 0
var _times = {}  # accessor -> its numbers, once read


func _init(bytes, shim):
	_stream.data_array = bytes
	error = _open(shim)
	if error != "":
		nodes = []
		animations = []


func _open(shim):
	var size = _stream.get_size()
	if size < 20 or _stream.get_u32() != 0x46546C67:
		return "it is no GLB"
	if _stream.get_u32() != 2:
		return "it is a GLB of another version than 2"
	var whole = _stream.get_u32()
	if whole > size:
		return "it is cut short: %d of %d bytes are there" % [size, whole]
	var length = _stream.get_u32()
	if _stream.get_u32() != 0x4E4F534A or 20 + length > whole:
		return "its JSON chunk is broken"
	var found = shim.parse(shim.text_of(_stream.get_data(length)[1]))
	if typeof(found) != TYPE_DICTIONARY:
		return "its JSON chunk is broken"
	_data = found
	for name in _data.get("extensionsRequired", []):
		if name != "KHR_mesh_quantization":
			return "it needs %s, which is not read here; export it without --compress" % name
	if 28 + length <= whole:
		_size = _stream.get_u32()
		if _stream.get_u32() != 0x004E4942 or 28 + length + _size > whole:
			return "its binary chunk is broken"
		_begin = 28 + length
	for name in ["nodes", "animations", "meshes", "accessors", "bufferViews"]:
		if typeof(_data.get(name, [])) != TYPE_ARRAY:
			return "'%s' is no list" % name
		for item in _data.get(name, []):
			if typeof(item) != TYPE_DICTIONARY:
				return "'%s' holds what is no record" % name
	nodes = _data.get("nodes", [])
	meshes = _data.get("meshes", [])
	for animation in _data.get("animations", []):
		var channels = []
		for channel in animation.get("channels", []):
			var sampler = animation["samplers"][int(channel["sampler"])]
			if sampler.get("interpolation", "LINEAR") != "LINEAR":
				return "animation '%s' is not LINEAR" % animation.get("name", "")
			for end in ["input", "output"]:
				var why = _wrong(int(sampler[end]))
				if why != "":
					return "animation '%s': %s" % [animation.get("name", ""), why]
			channels.append({
				node = int(channel["target"].get("node", -1)), path = channel["target"]["path"], times = int(sampler["input"]),
				rows = int(sampler["output"])
			})
		animations.append({name = animation.get("name", ""), channels = channels})
	return ""


# Returns why an accessor's numbers cannot be read, "" where they can.
func _wrong(accessor):
	var accessors = _data.get("accessors", [])
	if accessor < 0 or accessor >= accessors.size():
		return "there is no accessor %d" % accessor
	var a = accessors[accessor]
	if not a.has("bufferView") or a.has("sparse") or not SIZES.has(int(a["componentType"])) or not WIDTHS.has(a["type"]):
		return "accessor %d is of a kind that is not read" % accessor
	if int(a["bufferView"]) >= _data.get("bufferViews", []).size():
		return "accessor %d has no buffer view" % accessor
	var own = view(accessor)
	if a["count"] < 1 or own.at + own.stride * (int(a["count"]) - 1) + own.width * own.bytes > _begin + _size:
		return "accessor %d reaches beyond the file's end" % accessor
	return ""


# Returns where an accessor's numbers lie: {at: byte, stride: bytes, width: numbers a row, kind, bytes: a number's, scale}.
func view(accessor):
	var a = _data["accessors"][accessor]
	var of = _data["bufferViews"][int(a["bufferView"])]
	var kind = int(a["componentType"])
	var width = WIDTHS[a["type"]]
	var stride = int(of.get("byteStride", 0))
	return {
		at = _begin + int(of.get("byteOffset", 0)) + int(a.get("byteOffset", 0)), width = width, kind = kind, bytes = SIZES[kind],
		stride = stride if stride > 0 else width * SIZES[kind], scale = STEPS[kind] if a.get("normalized", false) else 1.0
	}


# Returns an accessor's numbers, all of them; kept, since channels share their times.
func numbers(accessor):
	if not _times.has(accessor):
		var out = []
		var own = view(accessor)
		for n in range(int(_data["accessors"][accessor]["count"])):
			out += row(own, n, own.width)
		_times[accessor] = out
	return _times[accessor]


# Returns the names of a node's morph targets.
func morphs_of(node):
	if node < 0 or node >= nodes.size() or not nodes[node].has("mesh"):
		return []
	return meshes[int(nodes[node]["mesh"])].get("extras", {}).get("targetNames", [])


# Returns row n of a view; of numbers that come one by one, the n-th `width` of them.
func row(of, n, width):
	_stream.seek(of.at + n * (of.stride * width if of.width == 1 else of.stride))
	var out = []
	for _i in range(width):
		match of.kind:
			5126:
				out.append(_stream.get_float())
			5122:
				out.append(Util.most(_stream.get_16() / of.scale, -1.0) if of.scale > 1.0 else float(_stream.get_16()))
			5123:
				out.append(_stream.get_u16() / of.scale)
			5121:
				out.append(_stream.get_u8() / of.scale)
			5120:
				out.append(Util.most(_stream.get_8() / of.scale, -1.0) if of.scale > 1.0 else float(_stream.get_8()))
	return out
