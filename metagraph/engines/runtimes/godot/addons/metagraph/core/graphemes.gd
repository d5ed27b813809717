# From letters to mouth shapes: what a mouth does if a line has neither sound nor phones.
#
# A few rules read English spelling. Other alphabets are read by their vowels. Unknown letters open and shut the mouth in turn.
#
# Translated from metagraph/playback/life/graphemes.py; change that, and translate anew.

const Mouth = preload("mouth.gd")
const Util = preload("util.gd")
const PACE = 14.0  # characters a second: about 150 words a minute
const SHORTEST = 0.4  # seconds
# Values: shapes in turn. The longest spelling that fits is taken.
const _SPELLINGS = {
	"tion": ["CH", "nn"],
	"sch": ["CH"],
	"tch": ["CH"],
	"igh": ["aa", "I"],
	"eau": ["O"],
	"ough": ["O"],
	"th": ["TH"],
	"sh": ["CH"],
	"ch": ["CH"],
	"ph": ["FF"],
	"ck": ["kk"],
	"ng": ["nn"],
	"qu": ["kk", "U"],
	"wh": ["U"],
	"oo": ["U"],
	"ou": ["aa", "U"],
	"ow": ["O", "U"],
	"ee": ["I"],
	"ea": ["I"],
	"ai": ["E", "I"],
	"ay": ["E", "I"],
	"oi": ["O", "I"],
	"oy": ["O", "I"],
	"au": ["O"],
	"aw": ["O"],
	"ie": ["I"],
	"ei": ["E", "I"],
	"ue": ["U"],
	"oa": ["O"],
	"a": ["aa"],
	"e": ["E"],
	"i": ["I"],
	"o": ["O"],
	"u": ["U"],
	"y": ["I"],
	"ø": ["U"],
	"œ": ["U"],
	"æ": ["E"],
	"ı": ["I"],
	"b": ["PP"],
	"p": ["PP"],
	"m": ["PP"],
	"f": ["FF"],
	"v": ["FF"],
	"d": ["DD"],
	"t": ["DD"],
	"l": ["nn"],
	"n": ["nn"],
	"k": ["kk"],
	"g": ["kk"],
	"c": ["kk"],
	"q": ["kk"],
	"x": ["kk", "SS"],
	"h": ["kk"],
	"j": ["CH"],
	"s": ["SS"],
	"z": ["SS"],
	"r": ["RR"],
	"w": ["U"],
	"ß": ["SS"],
	"ð": ["TH"],
	"þ": ["TH"],
	"ł": ["nn"],
	"đ": ["DD"]
}
# Greek and Cyrillic letters, and the Latin ones they stand for.
const _ALIKE = {
	"α": "a",
	"ε": "e",
	"η": "e",
	"ι": "i",
	"ο": "o",
	"υ": "y",
	"ω": "o",
	"β": "b",
	"π": "p",
	"μ": "m",
	"φ": "f",
	"δ": "d",
	"τ": "t",
	"λ": "l",
	"ν": "n",
	"κ": "k",
	"γ": "g",
	"χ": "h",
	"ξ": "x",
	"σ": "s",
	"ς": "s",
	"ζ": "z",
	"ρ": "r",
	"θ": "þ",
	"а": "a",
	"б": "b",
	"в": "v",
	"г": "g",
	"д": "d",
	"е": "e",
	"ё": "e",
	"ж": "j",
	"з": "z",
	"и": "i",
	"й": "j",
	"к": "k",
	"л": "l",
	"м": "m",
	"н": "n",
	"о": "o",
	"п": "p",
	"р": "r",
	"с": "s",
	"т": "t",
	"у": "u",
	"ф": "f",
	"х": "h",
	"ц": "s",
	"ч": "j",
	"ш": "j",
	"щ": "j",
	"ы": "i",
	"э": "e",
	"ю": "u",
	"я": "a",
	"і": "i",
	"є": "e",
	"ї": "i"
}
const _CONSONANTS = ["DD", "nn", "SS", "kk", "PP"]  # of syllables nobody knows
const _VOWEL_LENGTH = 1.25  # of one character's time
const _CONSONANT_LENGTH = 0.8
const _STOPS = {
	",": 1.5,
	";": 2.0,
	":": 2.0,
	".": 3.0,
	"!": 3.0,
	"?": 3.0,
	"…": 3.0,
	"-": 0.3,
	"–": 1.5,
	"—": 1.5,
	"(": 1.0,
	")": 1.0,
	"，": 1.5,
	"、": 1.5,
	"。": 3.0,
	"！": 3.0,
	"？": 3.0
}
const _BLANK = 0.35  # characters' time of anything else between words


# Letters that are syllables, by their code points. size: characters' time of one.
class Syllabary:
	var first
	var last
	var size

	func _init(first_, last_, size_):
		self.first = first_
		self.last = last_
		self.size = size_


static func _SYLLABARIES():
	return [
		Syllabary.new(12353, 12543, 2.0),
		Syllabary.new(65382, 65437, 2.0),
		Syllabary.new(13312, 40959, 3.0),
		Syllabary.new(63744, 64255, 3.0),
		Syllabary.new(131072, 205743, 3.0),
		Syllabary.new(44032, 55203, 3.0)
	]


# Return the mouth shapes of a word's letters, in turn.
static func shapes(alphabet, word):
	var out = []
	var letters = []
	for c in alphabet.plain(word):
		letters.append(_ALIKE.get(c, c))
	var at = 0
	while at < letters.size():
		var size = Util.least(4, letters.size() - at)
		while size > 1 and not _SPELLINGS.has(Util.joined(Util.part(letters, at, at + size), "")):
			size -= 1
		var spelling = Util.joined(Util.part(letters, at, at + size), "")
		var found = _SPELLINGS[spelling] if _SPELLINGS.has(spelling) else _unknown(alphabet, spelling, out)
		var last = at == letters.size() - 1
		var holds = spelling == "e" and last and out.size() > 1
		if holds:
			var is_any = false
			for s in out:
				if Mouth.VOWELS.has(s):
					is_any = true
					break
			holds = is_any
		var final_e = holds
		var twice = at > 0 and size == 1 and letters[at] == letters[at - 1]
		if found.size() > 0 and not final_e and not (twice and not Mouth.VOWELS.has(found[0])):
			Util.extend(out, found)
		at += size
	return out


static func _unknown(alphabet, letter, before):
	var kind = alphabet.kind(letter)
	if kind == "syllable":
		var code = alphabet.code(letter)
		return [_CONSONANTS[posmod(code, 5)], Mouth.VOWELS[posmod(int(floor(float(code) / 5)), 5)]]
	if kind == "letter":
		return ["aa"] if (before.size() > 0 and not Mouth.VOWELS.has(before[-1])) else ["DD"]
	return []


# Return each word, and the pause after it, measured in characters.
static func split_words(alphabet, text):
	var out = []
	var word = ""
	var pause = 0.0
	for c in alphabet.letters(text):
		if alphabet.kind(c) != "" or c == "'" or c == "’":
			if pause > 0:
				out.append([word, pause])
				word = ""
				pause = 0.0
			word += c
		else:
			pause += _STOPS.get(c, _BLANK)
	if word != "" or pause > 0:
		out.append([word, pause])
	return out


# A sound of a text. shape: "" for a pause. size: characters' time. strength: of a syllable, 0 for anything else.
class SpelledSound:
	var shape
	var size
	var strength

	func _init(shape_, size_, strength_ = 0.0):
		self.shape = shape_
		self.size = size_
		self.strength = strength_


# Return a word's sounds, in turn.
#
# Content words are longer than the words between them. The first vowel usually has the stress.
static func sounds(alphabet, word):
	var out = []
	var found = shapes(alphabet, word)
	var weight = Util.least(1.0, 0.35 + 0.09 * alphabet.letters(word).size()) - 0.1 * alphabet.scatter(word) / 100
	var first = true
	var before = ""
	for shape in found:
		var vowel = Mouth.VOWELS.has(shape)
		var syllable = vowel and not Mouth.VOWELS.has(before)
		var strength = (weight if first else 0.6 * weight) if syllable else 0.0
		first = first and not syllable
		out.append(SpelledSound.new(shape, _VOWEL_LENGTH if vowel else _CONSONANT_LENGTH, strength))
		before = shape
	return out


# Something said, timed by its letters: pieces in time, and times and strengths (0..1) of its syllables.
class Spelled:
	var pieces
	var peaks
	var strengths

	func _init(pieces_ = null, peaks_ = null, strengths_ = null):
		self.pieces = pieces_ if pieces_ != null else []
		self.peaks = peaks_ if peaks_ != null else []
		self.strengths = strengths_ if strengths_ != null else []

	# Add sounds that last from `start` to `end` seconds together.
	func add(plan, start, end):
		var at = start
		var found = []
		for sound2 in plan:
			found.append(sound2.size)
		var scale = (end - start) / Util.sum(found)
		for sound in plan:
			var then = at + sound.size * scale
			if sound.shape != "":
				var fully = Util.least(1.0, 0.7 + 0.4 * sound.strength) if Mouth.VOWELS.has(sound.shape) else 1.0
				self.pieces.append(Mouth.MouthPiece.new(at, then, sound.shape, fully))
			if sound.strength > 0:
				self.peaks.append(0.5 * (at + then))
				self.strengths.append(sound.strength)
			at = then


# Return how long a text takes to say, seconds.
static func read_aloud(alphabet, text):
	var letters = alphabet.letters(alphabet.stripped(text))
	var found = []
	for letter in letters:
		found.append(measure_letter(alphabet.code(letter)))
	return Util.most(SHORTEST, Util.sum(found) / PACE)


# Return how long a letter takes, measured in characters, by its code point: a Chinese, Japanese or Korean one is a syllable.
static func measure_letter(code):
	for script in _SYLLABARIES():
		if script.first <= code and code <= script.last:
			return script.size
	return 1.0


# Return the sounds of a text that lasts `duration` seconds; none if it has no known letter.
static func spelled(alphabet, text, duration):
	var out = Spelled.new()
	var plan = []
	for pair in split_words(alphabet, alphabet.stripped(text)):
		var word = pair[0]
		var pause = pair[1]
		Util.extend(plan, sounds(alphabet, word))
		if pause > 0:
			plan.append(SpelledSound.new("", pause))
	var holds = duration >= 0.001
	if holds:
		var is_any = false
		for sound in plan:
			if sound.shape != "":
				is_any = true
				break
		holds = is_any
	if holds:
		var edge = Util.least(0.06, 0.1 * duration)
		out.add(plan, edge, duration - edge)
	return out
