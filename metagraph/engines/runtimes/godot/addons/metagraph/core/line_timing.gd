# The times of a line's words and mouth shapes, as a synthesiser reports them: the mouth follows them and is shut in between.
# Times are seconds from the line's start.
#
# Translated from metagraph/playback/life/line_timing.py; change that, and translate anew.

const Graphemes = preload("graphemes.gd")
const Mouth = preload("mouth.gd")
const Util = preload("util.gd")
const WORD = 0.15  # seconds that a word takes if only its start is known and nothing comes sooner
const LETTER = 0.07  # and seconds for each of its letters
const SHAPE = 0.2  # seconds for which the last shape of a line stays
const FARTHEST = 3600.0  # seconds of a line
const AGAIN = 0.1  # a later piece belongs to a line from this many seconds before its last shape on
const SLACK = 0.05  # seconds by which times may exceed the given end
const MISSED = 0.1  # seconds by which a word may come late and only be cut short
# What each viseme of a set shows of the mouth shapes, and how fully.
const OCULUS = {
	"sil": "sil",
	"PP": "PP",
	"FF": "FF",
	"TH": "TH",
	"DD": "DD",
	"kk": "kk",
	"CH": "CH",
	"SS": "SS",
	"nn": "nn",
	"RR": "RR",
	"aa": "aa",
	"E": "E",
	"ih": "I",
	"oh": "O",
	"ou": "U",
	"I": "I",
	"O": "O",
	"U": "U"
}
# SAPI's numbers, which Azure has, too.
const AZURE = {
	"0": "sil",
	"1": "E",
	"2": "aa",
	"3": "O",
	"4": "E",
	"5": "RR",
	"6": "I",
	"7": "U",
	"8": "O",
	"9": "aa",
	"10": "O",
	"11": "aa",
	"12": "kk",
	"13": "RR",
	"14": "nn",
	"15": "SS",
	"16": "CH",
	"17": "TH",
	"18": "FF",
	"19": "DD",
	"20": "kk",
	"21": "PP"
}
# Amazon Polly's speech marks.
const POLLY = {
	"sil": "sil",
	"p": "PP",
	"t": "DD",
	"S": "CH",
	"T": "TH",
	"f": "FF",
	"k": "kk",
	"i": "I",
	"r": "RR",
	"s": "SS",
	"u": "U",
	"@": "E",
	"a": "aa",
	"e": "E",
	"E": "E",
	"o": "O",
	"O": "O"
}
# Of ARKit's blend shapes those that make the mouth.
const ARKIT = {
	"jawOpen": "aa",
	"mouthClose": "PP",
	"mouthPressLeft": "PP",
	"mouthPressRight": "PP",
	"mouthFunnel": "O",
	"mouthPucker": "U",
	"mouthRollLower": "FF",
	"mouthRollUpper": "PP",
	"mouthStretchLeft": "E",
	"mouthStretchRight": "E",
	"mouthSmileLeft": "I",
	"mouthSmileRight": "I",
	"mouthShrugUpper": "CH",
	"tongueOut": "TH"
}
const SETS = ["oculus", "azure", "sapi", "polly", "arkit"]
const WEAK = {"@": 0.6, "12": 0.5, "1": 0.8, "mouthSmileLeft": 0.3, "mouthSmileRight": 0.3}


# A word from `start` to `end`; `end` is None if only its start is known.
class SpokenWord:
	var text
	var start
	var end

	func _init(text_, start_, end_ = null):
		self.text = text_
		self.start = start_
		self.end = end_


# A mouth shape from `at` until the next mark of a later time. viseme: its name in its set; in a `LineTiming`, one of `VISEMES`.
# weight: how fully it is made, 0..1.
class VisemeMark:
	var at
	var viseme
	var weight

	func _init(at_, viseme_, weight_ = 1.0):
		self.at = at_
		self.viseme = viseme_
		self.weight = weight_


# A line's words and mouth shapes, each by time. later: seconds by which later pieces are delayed, because one came after its
# time. paced: whether the times are estimated from the letters.
class LineTiming:
	var words
	var marks
	var later
	var paced

	func _init(words_ = null, marks_ = null, later_ = 0.0, paced_ = false):
		self.words = words_ if words_ != null else []
		self.marks = marks_ if marks_ != null else []
		self.later = later_
		self.paced = paced_


# Return whether two lines have the same words and shapes at the same times.
static func alike_timings(one, other):
	if one == null or other == null:
		return one == null and other == null
	if one.words.size() != other.words.size() or one.marks.size() != other.marks.size():
		return false
	var are_all = true
	for n in range(one.words.size()):
		var a = one.words[n]
		var b = other.words[n]
		if not (a.text == b.text and a.start == b.start and a.end == b.end):
			are_all = false
			break
	var words = are_all
	var holds = words
	if holds:
		var are_all2 = true
		for n in range(one.marks.size()):
			var a = one.marks[n]
			var b = other.marks[n]
			if not (a.at == b.at and a.viseme == b.viseme and a.weight == b.weight):
				are_all2 = false
				break
		holds = are_all2
	return holds


static func _table(name):
	if name == "oculus":
		return OCULUS
	if name == "polly":
		return POLLY
	return ARKIT if name == "arkit" else AZURE


# Return the first set that has all of the visemes, "" if none has.
static func set_of(marks):
	for name in SETS:
		var are_all = true
		for mark in marks:
			if not _table(name).has(mark.viseme):
				are_all = false
				break
		if are_all:
			return name
	return ""


# Return what is wrong with a line's times, where, and what would be right; "" if nothing is wrong.
#
# name: of the visemes' set, "" to find it by their names. duration: seconds of its sound, None if unknown.
static func wrong_in(words, marks, name, duration):
	var last = 0.0
	var why
	for n in range(words.size()):
		var word = words[n]
		var place = "words[%d] '%s'" % [n, word.text]
		why = _out_of_range(word.start)
		if why == "" and word.start < last:
			why = "begins at %s s, before the one before it; put words in order" % [Util.thousandths(word.start)]
		var end = word.start if word.end == null else word.end
		if why == "" and not (end >= word.start):
			why = "ends at %s s, before it begins; give [word, start, end] in seconds" % [Util.thousandths(end)]
		if why == "" and duration != null and end > duration + SLACK:
			why = "ends at %s s, past the end at %s s; give a longer duration" % [
				Util.thousandths(end),
				Util.thousandths(duration)
			]
		if why != "":
			return "%s: %s" % [place, why]
		last = word.start
	if name != "" and not SETS.has(name):
		return "set: '%s' is no set of visemes; there are %s" % [name, Util.joined(SETS, ", ")]
	var found = set_of(marks) if name == "" else name
	last = 0.0
	for n in range(marks.size()):
		var mark = marks[n]
		why = _out_of_range(mark.at)
		if why == "" and mark.at < last:
			why = "comes at %s s, before the one before it; put visemes in order" % [Util.thousandths(mark.at)]
		if why == "" and duration != null and mark.at > duration + SLACK:
			why = "comes at %s s, past the end at %s s; give a longer duration" % [
				Util.thousandths(mark.at),
				Util.thousandths(duration)
			]
		if why == "" and not (0 <= mark.weight and mark.weight <= 1):
			why = "has the weight %s; weights are from 0 to 1" % [Util.thousandths(mark.weight)]
		if why == "" and found == "" and set_of([mark]) == "":
			why = "is in no set of visemes; there are %s" % [Util.joined(SETS, ", ")]
		if why == "" and found != "" and not _table(found).has(mark.viseme):
			why = "is not in the set '%s', which has %s" % [found, Util.joined(Util.list(_table(found).keys()), ", ")]
		if why != "":
			return "visemes[%d] '%s': %s" % [n, mark.viseme, why]
		last = mark.at
	if found == "":
		return "visemes: no set has all of them; there are %s" % [Util.joined(SETS, ", ")]
	return ""


static func _out_of_range(seconds):
	if 0 <= seconds and seconds <= FARTHEST:
		return ""
	return "is at %s s; times are from 0 to %.1f s from the line's start" % [Util.thousandths(seconds), FARTHEST]


# Return the timing of words and visemes that are valid. name: as for `wrong_in`.
static func timing_of(alphabet, words, marks, name):
	var table = _table(set_of(marks) if name == "" else name)
	var shown = []
	for m in marks:
		shown.append(VisemeMark.new(m.at, table[m.viseme], m.weight * WEAK.get(m.viseme, 1.0)))
	var said = []
	for n in range(words.size()):
		var word = words[n]
		var end = word.start + WORD + LETTER * alphabet.letters(word.text).size() if word.end == null else word.end
		if n + 1 < words.size():
			end = Util.least(end, words[n + 1].start)
		if word.end == null:  # a pause ends it
			var first = end
			for m in shown:
				if m.viseme == "sil" and m.at > word.start:
					first = m.at
					break
			end = Util.least(end, first)
		said.append(SpokenWord.new(word.text, word.start, Util.most(end, word.start)))
	return LineTiming.new(Util.list(said), Util.list(shown))


# Return how many seconds a text takes as a part of a longer text.
static func measure_text(alphabet, text):
	var out = 0.0
	for pair in Graphemes.split_words(alphabet, text):
		var word = pair[0]
		var pause = pair[1]
		out += _measure_word(alphabet, word) + pause / Graphemes.PACE
	return out


# Return the words of a text, one after the other. seconds: how long all of it takes, None to estimate it from the letters.
static func pace_text(alphabet, text, seconds):
	var scale = 1.0 if seconds == null else seconds / Util.most(measure_text(alphabet, text), 0.001)
	var at = 0.0
	var words = []
	for pair in Graphemes.split_words(alphabet, text):
		var word = pair[0]
		var pause = pair[1]
		var end = at + scale * _measure_word(alphabet, word)
		if word != "":
			words.append(SpokenWord.new(word, at, end))
		at = end + scale * pause / Graphemes.PACE
	return LineTiming.new(Util.list(words), [], 0.0, true)


# Return how long a word takes, seconds.
static func _measure_word(alphabet, word):
	var found = []
	for letter in alphabet.letters(word):
		found.append(Graphemes.measure_letter(alphabet.code(letter)))
	return Util.sum(found) / Graphemes.PACE


# Return the words of letters that have a time each. Blanks separate words, and so does each letter that is a syllable.
static func join_letters(alphabet, letters):
	var out = []
	var parted = true
	for letter in letters:
		if alphabet.stripped(letter.text) == "":
			parted = true
			continue
		var alone = Graphemes.measure_letter(alphabet.code(alphabet.letters(letter.text)[0])) > 1
		if parted or alone:
			out.append(letter)
		else:
			var last = out[-1]
			out[out.size() - 1] = SpokenWord.new(last.text + letter.text, last.start, letter.end)
		parted = alone
	return out


# Return the words of a line as its text.
static func told_text(timing):
	var found = []
	for word in timing.words:
		found.append(word.text)
	return Util.joined(found, " ")


# Return how long a line lasts, rounded to whole rows of the mouth's track, so that later additions move nothing. duration: of its
# sound, None for as long as its words and shapes need.
static func timed_seconds(timing, duration):
	var last = _end_of(timing)
	return (int(ceil((last + Mouth.LATE if duration == null else Util.most(duration, last)) / Mouth.STEP - 1e-06)) * Mouth.STEP)


# Return the mouth's pieces and the syllables of a line's words and shapes: the mouth follows the shapes if there are any;
# gestures and blinks follow the words.
static func timed_sounds(alphabet, timing):
	var out = Graphemes.Spelled.new()
	for word in timing.words:
		var plan = Graphemes.sounds(alphabet, word.text)
		var over = word.start if word.end == null else word.end
		if plan.size() > 0 and over > word.start:
			out.add(plan, word.start, over)
	if timing.marks.size() == 0:
		return out
	var shown = Graphemes.Spelled.new()
	var before = "sil"
	for n in range(timing.marks.size()):
		var mark = timing.marks[n]
		var end = _ends(timing.marks)[n]
		if mark.viseme != "sil" and end > mark.at:
			shown.pieces.append(Mouth.MouthPiece.new(mark.at, end, mark.viseme, mark.weight))
			if Mouth.VOWELS.has(mark.viseme) and not Mouth.VOWELS.has(before) and mark.weight > 0:
				shown.peaks.append(0.5 * (mark.at + end))
				shown.strengths.append(mark.weight * Util.least(1.0, 0.3 + 4 * (end - mark.at)))
		before = mark.viseme
	if out.peaks.size() > 0:
		return Graphemes.Spelled.new(shown.pieces, out.peaks, out.strengths)
	return shown


# Return when each mark ends: marks at the same time show together.
static func _ends(marks):
	var out = []
	var end = 0.0
	var at = -1.0
	for mark in Util.backwards(marks):
		if mark.at != at:
			end = mark.at + SHAPE if at < 0 else at
			at = mark.at
		out.append(end)
	return Util.list(Util.backwards(out))


# Return whether a piece that comes after the end of a line belongs to the same line: it begins after the last known word or
# shape, or repeats all with more behind it. Otherwise it is something else under the same id.
static func tells_on(old, new):
	if new.words.size() > 0 and old.words.size() > 0:
		var first = new.words[0]
		if first.start > old.words[-1].start:
			return true
		var same = first.text == old.words[0].text and first.start == old.words[0].start
		return same and new.words.size() > old.words.size()
	if new.marks.size() > 0 and old.marks.size() > 0:
		var shape = new.marks[0]
		if shape.at >= old.marks[-1].at - AGAIN:
			return true
		return shape.at == old.marks[0].at and new.marks.size() > old.marks.size()
	return false


# Return a timing `by` seconds later.
static func shifted(timing, by):
	if by == 0:
		return timing
	var words = []
	for word in timing.words:
		words.append(SpokenWord.new(word.text, word.start + by, null if word.end == null else word.end + by))
	var found = []
	for mark in timing.marks:
		found.append(VisemeMark.new(mark.at + by, mark.viseme, mark.weight))
	return LineTiming.new(Util.list(words), found)


# Return a later piece of a line with the times at which it is said. A piece that counts from its own beginning follows the
# earlier pieces. A piece that comes too late, because the voice had stopped, is said at once, and everything after it is delayed.
# said: seconds of the line that are over.
static func place_told(old, new, said):
	var end = _end_of(old)
	if restarts(old, new, said):
		return LineTiming.new(
			shifted(new, Util.most(said, end)).words,
			shifted(new, Util.most(said, end)).marks,
			old.later,
			shifted(new, Util.most(said, end)).paced
		)
	var told = shifted(new, old.later)
	var by = 0.0
	if old.words.size() > 0 and told.words.size() > 0:
		var words = []
		for word in told.words:
			if word.start > old.words[-1].start:
				words.append(word)
		var holds = words.size() > 0
		if holds:
			var found = []
			for word in words:
				found.append(_end(word))
			holds = comes_late(words[0].start, Util.most_of(found), end, said)
		if holds:
			by = Util.most(said, end) - words[0].start
	elif old.marks.size() > 0 and told.marks.size() > 0:
		var marks = []
		for mark in told.marks:
			if mark.at > old.marks[-1].at:
				marks.append(mark)
		if marks.size() > 0 and comes_late(marks[0].at, marks[-1].at + SHAPE, end, said):
			by = Util.most(said, end) - marks[0].at
	return LineTiming.new(shifted(told, by).words, shifted(told, by).marks, old.later + by, shifted(told, by).paced)


# Return whether what is new of a line comes too late: all of it, or its beginning after the voice had stopped. first, last: when
# it would begin and end; silent: when what was known before ends; said: as for `place_told`.
static func comes_late(first, last, silent, said):
	return last <= said or (first < said - MISSED and silent <= said)


# Return whether a piece of a line counts its times from 0 again: it lies at the beginning of the line, but does not repeat it.
static func restarts(old, new, said):
	var again
	if old.words.size() > 0 and new.words.size() > 0:
		var same = 0
		while same < Util.least(old.words.size(), new.words.size()) and _alike(old.words[same], new.words[same]):
			same += 1
		again = same > 0 and new.words.size() >= old.words.size()
		return same < new.words.size() and not again and new.words[0].start < _end(old.words[0])
	if old.marks.size() > 0 and new.marks.size() > 0:
		var are_all = true
		for n in range(old.marks.size()):
			var a = old.marks[n]
			var b = new.marks[n]
			if not (a.viseme == b.viseme and Util.absolute(a.at - b.at) < SLACK):
				are_all = false
				break
		again = are_all
		var first = new.marks[0].at
		return not again and first < old.marks[0].at + SLACK and first < said
	return false


static func _alike(one, other):
	return one.text == other.text and Util.absolute(one.start - other.start) < SLACK


static func _end(word):
	return word.start if word.end == null else word.end


# Return when the last word or shape ends.
static func _end_of(timing):
	var found = []
	for word in timing.words:
		found.append(_end(word))
	var end = Util.most_of([0.0] + found)
	if timing.marks.size() > 0:
		var mark = timing.marks[-1]
		end = Util.most(end, mark.at + (0.0 if mark.viseme == "sil" else SHAPE))
	return end


# Return a line's timing with a later piece: the old timing stays up to `said` seconds, and up to the beginning of the new piece.
# Of a word or shape that has begun meanwhile, the rest is said.
static func extended(old, new, said):
	var words = Util.list(old.words)
	var found = []
	for word in old.words:
		if word.start < said:
			found.append(word.start)
	var begun = Util.most_of([-1.0] + found)
	var coming = []
	for word in new.words:
		if word.start >= said or (word.start > begun and (word.start if word.end == null else word.end) > said):
			coming.append(word)
	var until
	if coming.size() > 0:
		until = Util.most(said, new.words[0].start)
		var first = Util.most(coming[0].start, said)
		var found2 = []
		for word in old.words:
			if word.start < until:
				found2.append(SpokenWord.new(word.text, word.start, Util.least(first if word.end == null else word.end, first)))
		words = found2
		var found3 = []
		for word in coming:
			found3.append(SpokenWord.new(word.text, Util.most(word.start, said), word.end))
		Util.extend(words, found3)
	var marks = Util.list(old.marks)
	var found4 = []
	for mark in new.marks:
		if mark.at < said:
			found4.append(mark.at)
	var now = Util.most_of([-1.0] + found4)
	var found5 = []
	for mark in old.marks:
		if mark.at < said:
			found5.append(mark.at)
	var over = Util.most_of([-1.0] + found5)
	var shown = []
	for mark in new.marks:
		if mark.at >= said or (mark.at == now and now >= over and not _told(old.marks, mark)):
			shown.append(VisemeMark.new(Util.most(mark.at, said), mark.viseme, mark.weight))
	if shown.size() > 0:
		until = Util.most(said, new.marks[0].at)
		var found6 = []
		for mark in old.marks:
			if mark.at < until:
				found6.append(mark)
		marks = found6
		Util.extend(marks, shown)
	return LineTiming.new(Util.list(words), Util.list(marks), new.later)


static func _told(marks, mark):
	var is_any = false
	for m in marks:
		if m.at == mark.at and m.viseme == mark.viseme:
			is_any = true
			break
	return is_any
