# From letters to mouth shapes: what a mouth may do when neither sound nor phones of a line are there. English spelling is read by a
# few rules; other alphabets by their vowels, what is unknown by turns of open and shut.

const Util = preload("util.gd")
# Longest first. Values: shapes in turn.
const SPELLINGS = {
	"tion": "CH nn", "sch": "CH", "tch": "CH", "igh": "aa I", "eau": "O", "ough": "O", "th": "TH", "sh": "CH", "ch": "CH", "ph": "FF",
	"ck": "kk", "ng": "nn", "qu": "kk U", "wh": "U", "oo": "U", "ou": "aa U", "ow": "O U", "ee": "I", "ea": "I", "ai": "E I", "ay": "E I",
	"oi": "O I", "oy": "O I", "au": "O", "aw": "O", "ie": "I", "ei": "E I", "ue": "U",
	"oa": "O", "a": "aa", "e": "E", "i": "I",
	"o": "O", "u": "U", "y": "I", "ø": "U", "œ": "U", "æ": "E", "ı": "I", "b": "PP", "p": "PP", "m": "PP", "f": "FF", "v": "FF", "d": "DD", "t": "DD",
	"l": "nn", "n": "nn", "k": "kk", "g": "kk", "c": "kk", "q": "kk", "x": "kk SS", "h": "kk", "j": "CH", "s": "SS", "z": "SS", "r": "RR",
	"w": "U", "ß": "SS", "ð": "TH", "þ": "TH", "ł": "nn", "đ": "DD"
}
# Greek and Cyrillic letters that stand for the Latin ones.
const ALIKE = {
	"α": "a", "ε": "e", "η": "e", "ι": "i", "ο": "o", "υ": "y", "ω": "o", "β": "b", "π": "p", "μ": "m", "φ": "f", "δ": "d",
	"τ": "t", "λ": "l", "ν": "n", "κ": "k", "γ": "g", "χ": "h", "ξ": "x", "σ": "s", "ς": "s", "ζ": "z", "ρ": "r", "θ": "þ",
	"а": "a", "б": "b", "в": "v", "г": "g", "д": "d", "е": "e", "ё": "e", "ж": "j", "з": "z", "и": "i", "й": "j", "к": "k",
	"л": "l", "м": "m", "н": "n", "о": "o", "п": "p", "р": "r", "с": "s", "т": "t", "у": "u", "ф": "f", "х": "h", "ц": "s",
	"ч": "j", "ш": "j", "щ": "j", "ы": "i", "э": "e", "ю": "u", "я": "a", "і": "i", "є": "e", "ї": "i"
}
const VOWELS = ["aa", "E", "I", "O", "U"]
const LENGTH_VOWEL = 1.25  # of one character's time
const LENGTH_CONSONANT = 0.8
const STOPS = {
	",": 1.5, ";": 2.0, ":": 2.0, ".": 3.0, "!": 3.0, "?": 3.0, "…": 3.0, "-": 0.3, "–": 1.5, "—": 1.5, "(": 1.0, ")": 1.0
}


# Returns the mouth shapes of a word's letters, in turn.
static func shapes(text, word):
	var plain = text.plain(word)
	var letters = ""
	for n in range(plain.length()):
		letters += ALIKE.get(plain[n], plain[n])
	var out = []
	var at = 0
	while at < letters.length():
		var found = null
		var count = 4
		while count > 0 and found == null:
			if at + count <= letters.length() and SPELLINGS.has(letters.substr(at, count)):
				found = SPELLINGS[letters.substr(at, count)].split(" ")
			else:
				count -= 1
		if found == null:
			count = 1
			found = _unknown(text, text.shim.code_at(letters, at), out)
		var last = at == letters.length() - 1
		var final_e = letters[at] == "e" and count == 1 and last and out.size() > 1 and _any_vowel(out)
		if found.size() > 0 and not final_e:
			var doubled = at > 0 and letters[at] == letters[at - 1] and count == 1 and not VOWELS.has(found[0])
			if not doubled:
				for shape in found:
					out.append(shape)
		at += count
	return out


static func _any_vowel(found):
	for shape in found:
		if VOWELS.has(shape):
			return true
	return false


static func _unknown(text, code, before):
	if not text.is_a("letter", code):
		return []
	if text.is_a("digit", code) or text.is_a("syllable", code):  # a syllable each
		return [["DD", "nn", "SS", "kk", "PP"][code % 5], VOWELS[int(floor(code / 5.0)) % 5]]
	return ["aa"] if before.size() > 0 and not VOWELS.has(before[-1]) else ["DD"]


# Returns each [word, how many characters' time of pause follows it].
static func _words(text, said):
	var out = []
	var word = ""
	var pause = 0.0
	for n in range(said.length()):
		var code = text.shim.code_at(said, n)
		if text.is_a("letter", code) or said[n] == "'" or said[n] == "’" or text.is_a("mark", code):
			if pause > 0:
				out.append([word, pause])
				word = ""
				pause = 0.0
			word += said[n]
		else:
			pause += STOPS.get(said[n], 0.35)
	if word != "" or pause > 0:
		out.append([word, pause])
	return out


# Returns {pieces: [start, end, shape, strength], peaks, strengths: times and strengths (0..1) of its syllables, length: seconds}.
# duration: how long it takes.
static func spelled(text, said, duration):
	var plan = []  # [shape or "" for a pause, characters' time, strength of a syllable]
	var total = 0.0
	var voiced = false
	for each in _words(text, text.stripped(said)):
		var word = each[0]
		var found = shapes(text, word)
		# Content words are longer than the words between them; the first vowel bears the stress more often than not.
		var weight = Util.least(1.0, 0.35 + 0.09 * word.length()) - 0.1 * (_crc32(text.shim.utf8(word)) % 100) / 100.0
		var first = true
		for n in range(found.size()):
			var vowel = VOWELS.has(found[n])
			var strength = 0.0
			if vowel and (n == 0 or not VOWELS.has(found[n - 1])):
				strength = weight if first else 0.6 * weight
				first = false
			plan.append([found[n], LENGTH_VOWEL if vowel else LENGTH_CONSONANT, strength])
			voiced = true
		if each[1] > 0:
			plan.append(["", each[1], 0.0])
	for each in plan:
		total += each[1]
	var out = {pieces = [], peaks = [], strengths = [], length = duration}
	if not voiced or duration < 1e-3:
		return out
	var at = Util.least(0.06, 0.1 * duration)
	var scale = (duration - 2.0 * at) / total
	for each in plan:
		var end = at + each[1] * scale
		if each[0] != "":
			out.pieces.append([at, end, each[0], Util.least(1.0, 0.7 + 0.4 * each[2]) if VOWELS.has(each[0]) else 1.0])
		if each[2] > 0:
			out.peaks.append(0.5 * (at + end))
			out.strengths.append(each[2])
		at = end
	return out


# Returns the checksum of bytes that ZIP files use.
static func _crc32(bytes):
	var out = 0xFFFFFFFF
	for byte in bytes:
		out ^= byte
		for _bit in range(8):
			out = (out >> 1) ^ (0xEDB88320 if out & 1 else 0)
	return out ^ 0xFFFFFFFF
