# From asks at any level of abstraction to what the planner and the life layers work with.

const Util = preload("util.gd")
const Asks = preload("asks.gd")
const Meaning = preload("meaning.gd")
const Mood = preload("mood.gd")
const ToldTiming = preload("told_timing.gd")


# Returns what asks mean, see meaning.gd. now: when those begin that do not say; soon: when it is said, for what is said. An ask that
# makes several requests gives them ids of its own: <id>, then <id>.1, <id>.2, ...
static func understand(graph, asks, now, soon):
	var graphs = []
	for layer in Util.LAYERS:
		graphs.append(graph.layers[layer])
	var out = Meaning.Meaning.new(graph, graphs, graph.alphabet)
	for ask in asks:
		var found = _plain(graph, ask)
		if found[1] == "":
			Meaning.understood(out, found[0], now, soon)
		else:
			out.refuse(ask.id, found[1], ask.get("layer"), now if ask.at == null else ask.at)
	for block in out.blocks:
		out.refuse(block.id, "BML is read by the desktop, not by runtimes; send what it stands for", null, block.at)
	return out


# Returns [an ask with every field that any has, what is wrong with it, else ""].
static func _plain(graph, ask):
	var out = Meaning.PlainAsk.new(ask["do"])
	for name in ask:
		if name != "mood":
			out.set(name, ask[name])
	var felt = _felt(ask.get("mood"))
	out.valence = felt[0]
	out.arousal = felt[1]
	if ask["do"] != "say":
		return [out, ""]
	var told = ToldTiming.told_timing(graph.alphabet, ask)
	if told[1] != "":
		return [null, told[1]]
	out.timing = told[0]
	if ask.line != null and graph.lines.has(ask.line):
		var said = _said(graph, ask.line, ask.gestures)
		if said[1] != "":
			return [null, said[1]]
		out.said = said[0]
	return [out, ""]


# Returns [a line as it is said, what is wrong with what it asks for, else ""].
static func _said(graph, ident, gestures):
	var line = graph.lines[ident]
	var asks = []
	for data in line.get("asks", []) if gestures else []:
		var found = Asks.read(data)
		if found[0] == null:
			return [null, "line '%s': %s" % [ident, found[1]]]
		asks.append(Meaning.PlainAsk.new("say") if found[0]["do"] == "say" else _plain(graph, found[0])[0])
	var seconds = graph.voices[ident].duration if graph.voices.has(ident) else line.get("duration")
	var mood = Asks.read({"do": "mood", "mood": line.get("mood"), "intensity": line.get("intensity")})
	if mood[0] == null:
		return [null, "line '%s': %s" % [ident, mood[1]]]
	var felt = _felt(mood[0].mood)
	return [Meaning.SaidLine.new(line.get("text", ""), seconds, asks, felt[0], felt[1], mood[0].intensity), ""]


# Returns [valence, arousal] of a mood that is asked for, nulls where it tells nothing.
static func _felt(mood):
	if mood == null:
		return [null, null]
	return Mood.MOODS[mood] if typeof(mood) == TYPE_STRING else mood
