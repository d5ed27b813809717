# The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.
#
# Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before it is heard and
# lingers after it; what the mouth shows is the mean of all pieces weighted by how much each rules. Lips that must meet rule more
# than a tongue nobody sees.
#
# Translated from metagraph/playback/life/mouth.py; change that, and translate anew.

const Words = preload("words.gd")
const Util = preload("util.gd")
# How much each of VISEMES rules its neighbours: closed lips and teeth on the lip must be seen, tongue and
# palate need not.
const RULE = [0.8, 6.0, 4.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9]
const EARLY = 0.075  # seconds over which a shape comes before its sound begins
const LATE = 0.065  # and goes after it ends
const STEP = 0.02  # seconds between the rows of a track
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


# Return rows `[K][15]` of the shapes' weights, summing to 1; shut at both ends. Their times are evenly spaced from 0 to the
# duration, at least 1 ms.
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
	for piece in pieces:
		var place = Words.VISEMES.find(piece.viseme)
		# Short sounds are not left out: their ramps overlap and still reach the top in the middle.
		var inside = Util.least(0.5 * (piece.end - piece.start), 0.04)
		var first = Util.most(0, int(ceil((piece.start - EARLY) / step)))
		for k in range(first, Util.least(count, int(ceil((piece.end + LATE) / step)))):
			var rise = _ease((k * step - piece.start + EARLY) / (EARLY + inside))
			var fall = _ease((piece.end + LATE - k * step) / (LATE + inside))
			var here = Util.least(rise, fall)
			made[k] += here
			rows[k][place] += here * RULE[place] * piece.strength
			rows[k][0] += here * RULE[place] * (1 - piece.strength)
	var out = [rest()]
	for k in range(1, count - 1):
		rows[k][0] += LEAST + RULE[0] * Util.most(1 - made[k], 0.0)  # where no sound rules, rest does
		var whole = Util.sum(rows[k])
		var found2 = []
		for weight in rows[k]:
			found2.append(weight / whole)
		out.append(found2)
	out.append(rest())
	return out


# Return the weights of a shut mouth.
static func rest():
	var found = []
	for n in range(Words.VISEMES.size()):
		found.append(1.0 if n == 0 else 0.0)
	return found


# Return the times of stressed syllables: the first peak, then the strongest that have no stronger one within `ACCENT` seconds.
# People blink and gesture on these, not on every syllable.
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
