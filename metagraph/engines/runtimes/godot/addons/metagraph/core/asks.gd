# What can be asked of a character: records with `do`, as agents send them and lines hold them. Times are seconds, points metres in the
# character's space.

const Mood = preload("mood.gd")
const Util = preload("util.gd")
# Field -> what it may be; a question mark allows null.
const COMMON = {id = "text200", at = "seconds?", told = "seconds?", priority = "priority"}
const FIELDS = {
	gesture = {
		layer = "layer", tags = "tags", limb = "limb?", duration = "seconds?", stroke = "seconds?", hold = "hold?", prepare = "switch",
		resume = "switch", late = "hold?", mood = "mood?", intensity = "intensity?"
	},
	fidget = {
		layer = "layer", tags = "tags", limb = "limb?", duration = "seconds?", resume = "switch", late = "hold?", mood = "mood?",
		intensity = "intensity?"
	},
	action = {
		action = "name", layer = "layer?", duration = "seconds?", stroke = "seconds?", hold = "hold?", prepare = "switch", late = "hold?",
		mood = "mood?", intensity = "intensity?"
	},
	stance = {stance = "name", layer = "layer?", stay = "switch", late = "hold?"},
	change = {layer = "layer", limb = "limb?", duration = "seconds?", late = "hold?"},
	nod = {tags = "tags", late = "hold?", mood = "mood?", intensity = "intensity?"},
	shake = {tags = "tags", late = "hold?", mood = "mood?", intensity = "intensity?"},
	look = {to = "spot", duration = "seconds?", amount = "share", strict = "switch"},
	blink = {},
	say = {
		"line": "line?", "text": "text20000", "duration": "seconds?", "gestures": "switch", "words": "entries4000",
		"visemes": "entries20000", "characters": "entries20000", "more": "switch", "set": "set?", "mood": "mood?", "intensity": "intensity?"
	},
	mode = {mode = "mode?"},
	mood = {mood = "mood?", intensity = "intensity?", duration = "seconds?"},
	place = {name = "name", point = "point"},
	withdraw = {what = "text200"},
	interrupt = {what = "text200"},
	pause = {what = "text200"},
	resume = {what = "text200"},
	finish = {what = "text200"},
	bml = {bml = "text200000"}
}
# What fields are where nothing is said; those that are not here are null, or must be said.
const USUAL = {
	id = "", priority = 1, layer = "arms", tags = [], prepare = true, resume = false, stay = false, to = "user", amount = 1.0,
	strict = false, text = "", gestures = true, what = "", words = [], visemes = [], characters = [], more = false
}
const WORDS = {
	"set": ["oculus", "azure", "sapi", "polly", "arkit"], "layer": ["body", "arms", "head"], "limb": ["left", "right", "both"],
	"mode": ["idle", "listening", "talking", "thinking", "reacting"]
}


# Returns [the ask with all its fields, ""] or, where it cannot be read, [null, why].
static func read(data):
	if typeof(data) != TYPE_DICTIONARY:
		return [null, "a request should be a record with 'do'"]
	var what = data.get("do")
	if typeof(what) != TYPE_STRING or not FIELDS.has(what):
		return [null, "do: one of %s" % str(FIELDS.keys())]
	var known = Util.but(COMMON, FIELDS[what])
	for name in data:
		if typeof(name) != TYPE_STRING or (name != "do" and not known.has(name)):
			return [null, "there is no field '%s' in '%s'" % [str(name), what]]
	var out = {}
	out["do"] = what
	for name in known:
		var kind = known[name]
		var nullable = kind.ends_with("?")
		if not data.has(name):
			if not nullable and not USUAL.has(name):
				return [null, "%s: it must be said" % name]
			out[name] = null if nullable else USUAL[name]
			continue
		if nullable and data[name] == null:
			out[name] = null
			continue
		var found = _read(data[name], kind.trim_suffix("?"))
		if found == null:
			return [null, "%s: should be a %s" % [name, kind]]
		out[name] = found
	return [out, ""]


# Returns a field's value, null where it is none of its kind.
static func _read(value, kind):
	var text = typeof(value) == TYPE_STRING
	match kind:
		"seconds":
			return _number(value, 0.0, 1e6)
		"hold":
			return _number(value, 0.0, 600.0)
		"share":
			return _number(value, 0.0, 1.0)
		"intensity":
			return _number(value, 0.0, 2.0)
		"mood":
			if text:
				return value if Mood.MOODS.has(value) else null
			if typeof(value) != TYPE_ARRAY or value.size() != 2:
				return null
			for part in value:
				if _number(part, -1.0, 1.0) == null:
					return null
			return [float(value[0]), float(value[1])]
		"priority":
			var whole = _number(value, -1000.0, 1000.0)
			return int(whole) if whole != null and whole == floor(whole) else null
		"switch":
			return value if typeof(value) == TYPE_BOOL else null
		"layer", "limb", "mode", "set":
			return value if text and WORDS[kind].has(value) else null
		"name":
			return value if text and value.length() >= 1 and value.length() <= 200 else null
		"text200", "text20000", "text200000":
			return value if text and value.length() <= int(kind.trim_prefix("text")) else null
		"entries4000", "entries20000":
			return value if typeof(value) == TYPE_ARRAY and value.size() <= int(kind.trim_prefix("entries")) else null
		"line":
			if Util.is_number(value):
				return str(int(value)) if value == floor(value) else null
			return _read(value, "name")
		"spot":
			return _read(value, "name") if text else _read(value, "point")
		"point":
			if typeof(value) != TYPE_ARRAY or value.size() != 3:
				return null
			var point = []
			for part in value:
				if _number(part, -1e6, 1e6) == null:
					return null
				point.append(float(part))
			return point
		"tags":
			if typeof(value) != TYPE_ARRAY:
				return null
			for tag in value:
				if typeof(tag) != TYPE_STRING or tag.length() > 200:
					return null
			return value.duplicate()
	return null


static func _number(value, low, high):
	return float(value) if Util.is_number(value) and value >= low and value <= high else null
