# From asks at any level of abstraction to what the planner and the life layers work with.

const MetaPlan = preload("meta_plan.gd")
const Util = preload("util.gd")
const Asks = preload("asks.gd")
const Graphemes = preload("graphemes.gd")
const LineTiming = preload("line_timing.gd")
const ToldTiming = preload("told_timing.gd")
const Request = preload("request.gd")
const FOREVER = 1e9  # seconds; a look that lasts until the next


# Returns what asks mean: {requests: for the layers, items: for the track, withdrawn {id: true}: taken back; everything where it has "",
# refused: reports}. now: when those begin that do not say. An ask that makes several requests gives them ids of its own:
# <id>, then <id>.1, <id>.2, ...
static func understand(graph, asks, now):
	var out = {requests = [], items = [], withdrawn = {}, refused = []}
	for ask in asks:
		var at = now if ask.at == null else ask.at
		var meant = {requests = [], items = [], withdrawn = {}}
		var why = _mean(graph, ask, at, meant)
		if why != "":
			var layer = ask.get("layer")
			out.refused.append(MetaPlan.Report.new(ask.id, "not-understood", why, "arms" if layer == null else layer, at))
			continue
		out.requests += meant.requests
		out.items += meant.items
		for ident in meant.withdrawn:
			out.withdrawn[ident] = true
	return out


# Adds what one ask means to `out`; returns why there is nothing it could mean, "" where there is.
static func _mean(graph, ask, at, out):
	match ask["do"]:
		"gesture":
			var more = {duration = ask.duration, tags = ask.tags, limb = ask.limb, resume = ask.resume, stroke = ask.stroke}
			more.hold = ask.hold
			more.prepare = ask.prepare
			var start = at if ask.stroke == null else Util.most(0.0, ask.stroke - _longest_lead(graph, ask.layer, ask.tags))
			_want(out, ask, ask.layer, "gesture", start, more)
		"fidget":
			_want(out, ask, ask.layer, "fidget", at, {duration = ask.duration, tags = ask.tags, limb = ask.limb, resume = ask.resume})
		"action":
			var action = graph.find_action(ask.action, ask.layer)
			if action == null:
				return "there is no action '%s'" % ask.action
			var start = at if ask.stroke == null else Util.most(0.0, ask.stroke - _lead(action))
			var more = {action = action.id, stroke = ask.stroke, hold = ask.hold, prepare = ask.prepare}
			_want(out, ask, action.layer, action.kind, start, more)
		"stance":
			var found = graph.find_stance(ask.stance, ask.layer)
			if found == null:
				return "there is no stance '%s'" % ask.stance
			_want(out, ask, found[0], "transition", at, {stance = found[1]})
			out.items.append({list = "stays", id = ask.id, start = at, layer = found[0], on = ask.stay, end = INF})
		"change":
			_want(out, ask, ask.layer, "transition", at, {})
		"nod", "shake":
			return _head(graph, ask, at, out)
		"look":
			var until = FOREVER if ask.duration == null else at + ask.duration
			out.items.append({
				list = "looks", id = ask.id, start = at, end = until, to = ask.to, amount = ask.amount, strict = ask.strict,
				priority = ask.priority
			})
		"blink":
			out.items.append({list = "blinks", id = ask.id, start = at})
		"mode":
			out.items.append({list = "modes", id = ask.id, start = at, mode = ask.mode})
		"place":
			out.items.append({list = "places", id = ask.id, start = at, name = ask.name, point = ask.point})
		"withdraw":
			out.withdrawn[ask.what] = true
		"say":
			return _say(graph, ask, at, out)
		"bml":
			return "BML is read by the desktop, not by runtimes; send what it stands for"
	return ""


static func _want(out, ask, layer, kind, start, more):
	more.priority = ask.priority
	more.late = ask.late
	out.requests.append(Request.make(ask.id, layer, kind, start, more))


static func _say(graph, ask, at, out):
	var line = null
	if ask.line != null:
		line = graph.lines.get(ask.line)
		if line == null:
			return "there is no line '%s'" % ask.line
	var text = ask.text
	if text == "" and line != null:
		text = line.get("text", "")
	var told = ToldTiming.told_timing(graph.alphabet, ask)
	if told[1] != "":
		return told[1]
	var timing = told[0]
	if text == "" and line == null and timing != null:
		text = LineTiming.told_text(timing)
	if line == null and text == "" and timing == null:
		return "say what: a line's id, text, or words with their times"
	var length
	if timing == null:
		length = spoken_seconds(graph, ask.line, text, ask.duration)
	else:
		length = LineTiming.timed_seconds(timing, ask.duration)
	out.items.append({
		list = "speeches", id = ask.id, start = at, end = at + length, line = ask.line, text = text, priority = ask.priority, length = null,
		timing = timing
	})
	if line == null or not ask.gestures:
		return ""
	var number = 0
	for data in line.get("asks", []):
		number += 1
		var found = Asks.read(data)
		var inner = found[0]
		if inner == null:
			return "line '%s': %s" % [ask.line, found[1]]
		if inner["do"] == "say":
			return "line '%s' would say another line; its asks may not" % ask.line
		inner.at = at + (0.0 if inner.at == null else inner.at)
		inner.id = "%s.%d" % [ask.id, number]
		inner.priority = Util.most(inner.priority, ask.priority)
		if inner.get("stroke") != null:
			inner.stroke += at
		var why = _mean(graph, inner, inner.at, out)
		if why != "":
			return why
	return ""


# Returns how long something takes to say: as asked, as its sound, as the line says, or as its text is long.
static func spoken_seconds(graph, line, text, duration):
	if duration != null:
		return Util.most(duration, 0.0)
	if line != null and graph.voices.has(line):
		return graph.voices[line].duration
	if line != null and graph.lines[line].get("duration") != null:
		return graph.lines[line].duration
	return Graphemes.read_aloud(graph.alphabet, text)


# Nods are gestures tagged so; where none is, the likeliest of those called so, whatever stance it needs.
static func _head(graph, ask, at, out):
	var word = ask["do"]
	var called = []
	for action in graph.layers.head.actions.values():
		if action.kind != "gesture" or not Util.has_all(action.tags, ask.tags):
			continue
		if action.tags.has(word):
			_want(out, ask, "head", "gesture", at, {tags = [word] + ask.tags})
			return ""
		if action.name.to_lower().find(word) >= 0:
			called.append(action.id)
	if called.size() == 0:
		return "the head layer has no gesture tagged or called '%s' with these tags" % word
	_want(out, ask, "head", "gesture", at, {among = called})
	return ""


# Returns how long before its stroke any gesture with these tags begins.
static func _longest_lead(graph, layer, tags):
	var out = 0.0
	var first = true
	for action in graph.layers[layer].actions.values():
		if action.kind == "gesture" and Util.has_all(action.tags, tags):
			out = _lead(action) if first else Util.most(out, _lead(action))
			first = false
	return out


# Returns the seconds from an action's start to its stroke; its middle where the export says nothing.
static func _lead(action):
	return action.phases.stroke - action.start
