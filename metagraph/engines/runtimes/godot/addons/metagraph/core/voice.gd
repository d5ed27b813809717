# What is known of a spoken line's sound: {duration, accents: times of its stressed syllables, weights [K][15]: the mouth's shapes, rows
# evenly spaced from 0 to the duration, at least 1 ms}.

const Util = preload("util.gd")
const Graphemes = preload("graphemes.gd")
const Items = preload("items.gd")
const LineTiming = preload("line_timing.gd")
const Mouth = preload("mouth.gd")
const MOST = 256  # texts remembered


# Returns the voice of something said: as its words and shapes were told, its line's, else one guessed from its text.
static func of(graph, speech):
	var timing = speech.get("timing")
	if timing == null and speech.line != null and graph.voices.has(speech.line):
		return graph.voices[speech.line]
	var duration = Util.most(0.0, Items.measure_line(speech))
	var key = timing  # which is never changed once made
	if timing == null:
		key = "%s/%s" % [str(duration), speech.text]
	if not graph.said.has(key):
		if graph.said.size() >= MOST:
			graph.said.clear()
		graph.said[key] = _voice(_sounds(graph.alphabet, speech.text, timing, duration), duration)
	return graph.said[key]


static func _sounds(alphabet, text, timing, duration):
	return Graphemes.spelled(alphabet, text, duration) if timing == null else LineTiming.timed_sounds(alphabet, timing)


static func _voice(found, duration):
	var rows = Mouth.mouth_track(found.pieces, duration if found.pieces.size() > 0 else 0.0)
	return {duration = duration, accents = Mouth.accents_of(found.peaks, found.strengths), weights = rows}


# Returns the times of the stressed syllables of something said.
static func stressed(graph, speech):
	return of(graph, speech).accents


# Returns whether lines sound the same.
static func are_same_voices(one, other):
	return one == other
