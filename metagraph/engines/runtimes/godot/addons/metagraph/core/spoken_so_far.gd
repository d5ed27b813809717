# The part of an utterance that was spoken until a moment, for the history from which a language model continues.
#
# Translated from metagraph/speech/spoken_so_far.py; change that, and translate anew.

const Items = preload("items.gd")
const LineTiming = preload("line_timing.gd")
const Utterances = preload("utterances.gd")
const WordGestures = preload("word_gestures.gd")
const Util = preload("util.gd")


# Return the part of an utterance that was spoken until `seconds`, up to the word that was begun, and that word; "" if nothing was
# spoken. said: all speeches, by start.
static func spoken_until(alphabet, said, ident, seconds):
	var text = ""
	var last = ""
	var paced = false
	var pieces = _pieces(said, ident, seconds)
	for n in range(pieces.size()):
		var piece = pieces[n]
		var both = _spoken_of(alphabet, piece, Util.least(seconds, piece.end) - Items.find_line_start(piece))
		var words = both[0]
		var word = both[1]
		var joins = paced and piece.timing != null and piece.timing.paced
		if n > 0 and text != "" and words != "" and not joins:
			text += " "
		text += words
		last = last if word == "" else word
		paced = piece.timing != null and piece.timing.paced
	return [alphabet.stripped(text), last]


# Return the pieces of the last utterance with an id; one that continues after a pause is one utterance.
static func _pieces(said, ident, seconds):
	var out = []
	for piece in said:
		if piece.id != ident or piece.start >= seconds or Utterances.is_paused(piece.start):
			continue
		if out.size() > 0 and out[-1].asked != piece.asked:
			out = []
		elif out.size() > 0 and piece.skip > 0:
			out.pop_back()
		out.append(piece)
	return out


# Return the part of one piece that was spoken in its first `seconds`, and its last word.
static func _spoken_of(alphabet, piece, seconds):
	var letters = alphabet.letters(piece.text)
	var words = []
	if piece.timing != null and piece.timing.words.size() > 0:
		words = Util.list(piece.timing.words)
	elif piece.timing == null or not piece.timing.paced:
		var found = []
		for w in WordGestures.words_of(alphabet, piece.text, [], Items.measure_line(piece)):
			found.append(LineTiming.SpokenWord.new(w.text, w.start))
		words = found
	var begun = []
	for word2 in words:
		if word2.start < seconds:
			begun.append(word2.text)
	if begun.size() == 0:
		var silent = piece.timing != null and piece.timing.paced and words.size() == 0
		return [piece.text if silent else "", ""]
	var end = 0
	for word in begun:
		end = _end_of_letters(letters, alphabet.letters(word), end)
		if end < 0:  # the text says it otherwise
			return [Util.joined(begun, " "), begun[-1]]
	var stop = end
	while stop < letters.size() and not _parts(alphabet, letters[stop]):
		stop += 1
	var first = end
	while first > 0 and alphabet.stripped(letters[first - 1]) != "":
		first -= 1
	if begun.size() == words.size() and piece.timing != null and piece.timing.paced:
		stop = letters.size()
	var whole = WordGestures.words_of(alphabet, Util.joined(Util.part(letters, first, end), ""))
	return [Util.joined(Util.part(letters, 0, stop), ""), whole[-1].text if whole.size() > 0 else begun[-1]]


# Return whether a letter after a word is not a mark that belongs to it.
static func _parts(alphabet, letter):
	return alphabet.stripped(letter) == "" or WordGestures.telling(alphabet, [letter])


# Return the index after a word in a text, searching from `first`; -1 if it is not there.
static func _end_of_letters(letters, word, first):
	for start in range(first, letters.size() - word.size() + 1):
		var are_all = true
		for n in range(word.size()):
			var letter = word[n]
			if not (letters[start + n] == letter):
				are_all = false
				break
		if are_all:
			return start + word.size()
	return -1
