# The model that performs when nobody asks for anything: a first-order chain over (limb, kind), see docs/format.md.

const Request = preload("request.gd")
const Util = preload("util.gd")
const PERFORMED = ["gesture", "fidget", "transition"]  # as in a row of `modes`
const START = {number = 0, state = -1, time = 0.0}  # before meta action `number`, in state `state` (-1: none yet), which ended at `time`


# Returns [meta actions that start before `until` seconds, the cursor behind them], writing on from a cursor.
# Each draw is keyed by the meta action's number, so writing in many goes gives what writing in one does. kinds {kind: true}:
# what the graph has; states of other kinds are passed over.
static func write(choice, model, layer, seed32, until, kinds, cursor):
	var number = cursor.number
	var state = cursor.state
	var time = cursor.time
	var open_to = []
	for each in model.states:
		open_to.append(1.0 if kinds.has(each[1]) else 0.0)
	var out = []
	while _any(open_to):
		var key = "auto/%s/%d" % [layer, number]
		var row = open_to
		if state >= 0 and state < open_to.size():
			row = []
			for i in range(open_to.size()):
				row.append(model.matrix[state][i] * open_to[i])
			if not _any(row):
				row = open_to
		var weights = {}
		for i in range(row.size()):
			weights[str(i)] = row[i]
		var start = time + model.gap * (0.35 + 1.3 * choice.uniform(seed32, [key, "gap"]))
		if start >= until:
			break
		state = int(choice.pick(seed32, key, "state", weights))
		var limb = model.states[state][0]
		var kind = model.states[state][1]
		var seconds = _length(choice, model, state, seed32, key)
		var tags = []
		if model.tags.size() > 0:
			for tag in model.tags[state].split(" ", false):
				tags.append(tag)
		elif kind == "gesture":
			var draw = choice.uniform(seed32, [key, "tag"])
			if draw < model.positive:
				tags = ["positive"]
			elif draw < model.positive + model.negative:
				tags = ["negative"]
		var asked = Request.make(key, layer, kind, start, {duration = seconds, tags = tags, limb = limb, priority = 0})
		out.append({request = asked, start = start, end = start + seconds, part = 0, written = true, key = key})
		number += 1
		time = start + seconds
	return [out, {number = number, state = state, time = time}]


# Returns whether something the model wrote is performed while somebody idles, listens or talks; null where that is not known.
static func performs(choice, model, seed32, meta, mode):
	var place = PERFORMED.find(meta.request.kind)
	if model.modes.size() == 0 or mode == null or place < 0:
		return true
	var share = model.modes[Util.MODES.find(mode)][place]
	return share >= 1 or choice.uniform(seed32, [meta.request.id, "mode"]) < share


static func _any(weights):
	for weight in weights:
		if weight > 0:
			return true
	return false


# Returns how many seconds a meta action lasts: 1 to 3, or log-normal where the model has lengths.
static func _length(choice, model, state, seed32, key):
	var u = choice.uniform(seed32, [key, "length"])
	if model.lengths.size() == 0:
		return 1.0 + 2.0 * u
	var mean = model.lengths[state][0]
	var share = model.lengths[state][1] / mean
	var spread = _log1p(share * share)
	var z = sqrt(-2.0 * log(u)) * cos(2.0 * PI * choice.uniform(seed32, [key, "length2"]))
	return mean * exp(sqrt(spread) * z - spread / 2.0)


static func _log1p(x):
	var u = 1.0 + x
	return x if u == 1.0 else log(u) * x / (u - 1.0)
