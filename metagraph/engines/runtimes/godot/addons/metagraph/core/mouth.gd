# The mouth over time: turn pieces of speech, each with one mouth shape, into smooth weights of all shapes.
#
# Coarticulation after Cohen and Massaro (1993): every piece dominates the mouth around its own time, begins before it is heard
# and lingers after it. The mouth shows the mean of all pieces, weighted by their dominance. A mean never closes a mouth. So lips
# that meet (p, b, m) and teeth on the lip (f, v) are added on top (`_closed`): in their middle nothing else shows, however quick
# the speech is. Lips round for a rounded vowel as soon as the consonants before it begin (look-ahead, Henke 1966), at most a
# quarter of a second before it (Bell-Berti and Harris 1981 found it begin at about a fixed time before the vowel). The numbers
# are ours.
#
# Translated from metagraph/playback/life/mouth.py; change that, and translate anew.

const Words = preload("words.gd")
const Util = preload("util.gd")
# How much each of VISEMES rules its neighbours: tongue and palate need not be seen. What closes the mouth
# does not take part in the mean.
const RULE = [0.8, 0.0, 0.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9]
const CLOSURES = ["PP", "FF"]
const VOWELS = ["aa", "E", "I", "O", "U"]
const ROUNDED = ["O", "U"]
const EARLY = 0.075  # seconds over which a shape comes before its sound begins
const LATE = 0.065  # and goes after it ends
const STEP = 0.02  # seconds between the rows of a track
const LOOK_AHEAD = 0.25  # seconds by which a rounded vowel may come before its sound
const PAUSE = 0.03  # seconds without a sound that end a run of consonants
const HELD = 0.02  # seconds before and after its middle that a closure lasts at least: a row on each side
const SHUTTING = 0.09  # seconds it takes to close and to open again
const PARTING = 0.03  # seconds one closure takes to make way for the other
const LEAST = 0.02  # how much rest rules everywhere
const ACCENT = 2.0  # seconds round a stressed syllable without another: blinks come as often as people's


# A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1.
class MouthPiece:
	var start
	var end
	var viseme
	var strength

	func _init(start_, end_, viseme_, strength_ = 1.0):
		self.start = start_
		self.end = end_
		self.viseme = viseme_
		self.strength = strength_


# Return rows `[K][15]` of the shapes' weights, which sum to 1; the mouth is shut at both ends. Their times are evenly spaced from
# 0 to the duration, at least 1 ms.
static func mouth_track(pieces, duration):
	var count = Util.most(2, int(ceil(duration / STEP - 1e-06)) + 1)  # as many for 0.88 s as languages that divide otherwise
	var step = Util.most(duration, 0.001) / (count - 1)
	var rows = []
	for row in range(count):
		var found = []
		for shape in range(Words.VISEMES.size()):
			found.append(0.0)
		rows.append(found)
	var made = []
	for row in range(count):
		made.append(0.0)
	var begun = 0.0
	var last = -1.0  # of a run of consonants; where the sound before ended
	for piece in pieces:
		var place = Words.VISEMES.find(piece.viseme)
		if piece.start - last > PAUSE:
			begun = piece.start
		var early = EARLY
		if ROUNDED.has(piece.viseme):
			early = Util.least(Util.most(piece.start - begun, EARLY), LOOK_AHEAD)
		last = piece.end
		if VOWELS.has(piece.viseme):
			begun = piece.end
		# Short sounds are not left out: their ramps overlap and still reach the top in the middle.
		var inside = Util.least(0.5 * (piece.end - piece.start), 0.04)
		var first = Util.most(0, int(ceil((piece.start - early) / step)))
		for k in range(first, Util.least(count, int(ceil((piece.end + LATE) / step)))):
			var rise = _ease((k * step - piece.start + early) / (early + inside))
			var fall = _ease((piece.end + LATE - k * step) / (LATE + inside))
			var here = Util.least(rise, fall)
			made[k] += here
			rows[k][place] += here * RULE[place] * piece.strength
			rows[k][0] += here * RULE[place] * (1 - piece.strength)
	var shut = []
	for name in CLOSURES:
		shut.append(_gates(pieces, name, count, step))
	var out = [rest()]
	for k in range(1, count - 1):
		rows[k][0] += LEAST + RULE[0] * Util.most(1 - made[k], 0.0)  # where no sound rules, rest does
		var whole = Util.sum(rows[k])
		var found2 = []
		for weight in rows[k]:
			found2.append(weight / whole)
		out.append(_closed(found2, shut[0][k], shut[1][k]))
	out.append(rest())
	return out


# Return rows (how far a closure has progressed, how far it suppresses the other one), 0..1.
static func _gates(pieces, viseme, count, step):
	var out = []
	for row in range(count):
		out.append([0.0, 0.0])
	for piece in pieces:
		if piece.viseme != viseme:
			continue
		var middle = 0.5 * (piece.start + piece.end)
		var held = Util.most(HELD, 0.5 * (piece.end - piece.start) - 0.01)
		var first = Util.most(0, int(ceil((middle - held - SHUTTING) / step)))
		for k in range(first, Util.least(count, int(ceil((middle + held + SHUTTING) / step)))):
			var away = Util.most(0.0, Util.absolute(k * step - middle) - held)
			var wide = piece.strength * _ease(1 - away / SHUTTING)
			var narrow = piece.strength * _ease(1 - away / PARTING)
			out[k] = [Util.most(out[k][0], wide), Util.most(out[k][1], narrow)]
	return out


# Return a row with the closures on top: they suppress the rest as far as they are closed.
static func _closed(row, lips, teeth):
	var most = Util.most(lips[0], teeth[0])
	if most <= 0:
		return row
	var one = lips[0] * (1 - teeth[1])
	var other = teeth[0] * (1 - lips[1])
	if one + other <= 0:
		one = lips[0]
		other = teeth[0]
	var out = []
	for weight in row:
		out.append((1 - most) * weight)
	out[1] += most * one / (one + other)
	out[2] += most * other / (one + other)
	return out


# Write the shapes without silence `[14]`, smoothed over three moments. Shapes that close the mouth keep their present weights,
# and the others share what is left: smoothing must not part lips that meet.
static func soften(out, before, now, after):
	for n in range(out.size()):
		out[n] = 0.25 * before[n] + 0.5 * now[n] + 0.25 * after[n]
	var open_ = 1 - out[0] - out[1]
	out[0] = now[0]
	out[1] = now[1]
	var left = Util.most(0.0, 1 - out[0] - out[1]) / open_ if open_ > 1e-09 else 0.0
	for n in range(2, out.size()):
		out[n] *= Util.least(1.0, left)


# Return the weights of a shut mouth.
static func rest():
	var found = []
	for n in range(Words.VISEMES.size()):
		found.append(1.0 if n == 0 else 0.0)
	return found


# Return the times of stressed syllables: the first peak, then those with no stronger one within `ACCENT` seconds. People blink
# and gesture on these, not on every syllable.
static func accents_of(peaks, strengths):
	var taken = []
	var keys = []
	for i2 in range(peaks.size()):
		keys.append([0 if i2 == 0 else 1, -strengths[i2], peaks[i2]])
	for i in Util.ordered(range(peaks.size()), keys):
		var are_all = true
		for t in taken:
			if not (Util.absolute(peaks[i] - t) >= ACCENT):
				are_all = false
				break
		if are_all:
			taken.append(peaks[i])
	return Util.in_order(taken)


static func _ease(x):
	if x <= 0:
		return 0.0
	return 1.0 if x >= 1 else x * x * (3 - 2 * x)
