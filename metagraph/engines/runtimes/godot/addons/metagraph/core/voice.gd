# What is known of a spoken line's sound: {duration, accents: times of its stressed syllables, weights [K][15]: the mouth's shapes, rows
# evenly spaced from 0 to the duration, at least 1 ms}.
#
# Coarticulation: every sound rules the mouth around its own time, begins before it is heard and lingers after it; what the mouth shows
# is the mean of all sounds weighted by how much each rules.

const Util = preload("util.gd")
const Letters = preload("letters.gd")
const VISEMES = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"]
const RULES = [0.8, 6.0, 4.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9]  # how much each rules its neighbours
const EARLY = 0.075  # seconds over which a shape comes before its sound begins
const LATE = 0.065  # and goes after it ends
const STEP = 0.02  # seconds between rows
const LEAST = 0.02  # how much rest rules everywhere
const ACCENT = 2.0  # seconds round a stressed syllable without another
const MOST = 256  # texts remembered


# Returns the voice of something said: its line's, else one guessed from its text.
static func of(graph, speech):
	if speech.line != null and graph.voices.has(speech.line):
		return graph.voices[speech.line]
	var duration = Util.most(0.0, speech.end - speech.start if speech.length == null else speech.length)
	var key = "%s/%s" % [str(duration), speech.text]
	if not graph.said.has(key):
		if graph.said.size() >= MOST:
			graph.said.clear()
		graph.said[key] = _of_text(graph.text, speech.text, duration)
	return graph.said[key]


static func _of_text(text, said, duration):
	var found = Letters.spelled(text, said, duration)
	if found.pieces.size() == 0:
		return {duration = duration, accents = [], weights = [_rest(), _rest()]}
	return {duration = duration, accents = _accents(found.peaks, found.strengths), weights = _track(found.pieces, duration)}


# Returns the first peak, then the loudest ones that have no louder one within ACCENT seconds; in time.
static func _accents(peaks, strengths):
	var keys = []
	for i in range(peaks.size()):
		keys.append([1 if i > 0 else 0, -strengths[i], peaks[i]])
	var taken = []
	for i in Util.ordered(range(peaks.size()), keys):
		var free_of_others = true
		for other in taken:
			free_of_others = free_of_others and abs(peaks[i] - other) >= ACCENT
		if free_of_others:
			taken.append(peaks[i])
	taken.sort()
	return taken


# Returns rows of the shapes' weights, summing to 1; shut at both ends. pieces: [start, end, shape, strength].
static func _track(pieces, duration):
	var count = int(Util.most(2, ceil(duration / STEP) + 1))
	var step = Util.most(duration, 1e-3) / (count - 1)
	var out = []
	var made = []
	for _n in range(count):
		var row = []
		for _shape in VISEMES:
			row.append(0.0)
		out.append(row)
		made.append(0.0)
	for piece in pieces:
		var shape = VISEMES.find(piece[2])
		var top = Util.least(0.5 * (piece[1] - piece[0]), 0.04)
		for n in range(int(Util.most(0, ceil((piece[0] - EARLY) / step))), int(Util.least(count - 1, floor((piece[1] + LATE) / step))) + 1):
			var rise = Util.smooth((n * step - piece[0] + EARLY) / (EARLY + top))
			var fall = Util.smooth((piece[1] + LATE - n * step) / (LATE + top))
			var here = Util.least(rise, fall)
			made[n] += here
			out[n][shape] += here * RULES[shape] * piece[3]
			out[n][0] += here * RULES[shape] * (1.0 - piece[3])
	for n in range(count):
		out[n][0] += LEAST + RULES[0] * Util.most(1.0 - made[n], 0.0)  # where no sound rules, rest does
		var whole = 0.0
		for weight in out[n]:
			whole += weight
		for shape in range(VISEMES.size()):
			out[n][shape] /= whole
	out[0] = _rest()
	out[count - 1] = _rest()
	return out


static func _rest():
	var out = [1.0]
	for _n in range(VISEMES.size() - 1):
		out.append(0.0)
	return out
