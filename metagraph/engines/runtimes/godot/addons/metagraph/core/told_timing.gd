# The words and visemes of a line as synthesisers tell them: pairs and triples, Amazon Polly's speech marks, Azure's events.

const LineTiming = preload("line_timing.gd")
const Util = preload("util.gd")
const THOUSAND = 1e3  # of a second, in which Polly counts
const TICKS = 1e7  # and Azure


# Returns [when a line's words and shapes come, null where that is not told; why that cannot be read, else ""].
static func told_timing(alphabet, ask):
	var words = []
	var marks = []
	for n in range(ask.words.size()):
		if not _add_spoken(ask.words[n], words, false):
			return [null, "words[%d]: should be [word, start, end], seconds from the line's start" % n]
	var letters = []
	for n in range(ask.characters.size()):
		if not _add_spoken(ask.characters[n], letters, false):
			return [null, "characters[%d]: should be [letter, start, end], seconds from the line's start" % n]
	if words.size() == 0:
		words = LineTiming.join_letters(alphabet, letters)
	for n in range(ask.visemes.size()):
		if not _add_mark(ask.visemes[n], marks) and not _add_spoken(ask.visemes[n], words, true):
			return [null, "visemes[%d]: should be [seconds, viseme], or with its weight from 0 to 1" % n]
	if words.size() == 0 and marks.size() == 0:
		return [null, ""]
	var of_set = "" if ask["set"] == null else ask["set"]
	var why = LineTiming.wrong_in(words, marks, of_set, ask.duration)
	if why != "":
		return [null, why]
	return [LineTiming.timing_of(alphabet, words, marks, of_set), ""]


static func _seconds(value, of):
	return value / of if Util.is_number(value) else null


# Adds the word an entry tells; returns whether it is one. named: only where it says so itself.
static func _add_spoken(entry, out, named):
	var told = entry
	if typeof(entry) == TYPE_DICTIONARY:
		var kind = entry.get("type", "")
		if typeof(kind) != TYPE_STRING:
			return false
		if kind == "sentence" or kind == "ssml":  # marks of Polly's that no mouth needs
			return true
		if named and kind != "word":
			return false
		if kind == "word":
			told = [entry.get("value"), _seconds(entry.get("time"), THOUSAND)]
		elif entry.has("audioOffset"):
			var start = entry.audioOffset
			var length = entry.get("duration")
			var end = (start + length) / TICKS if Util.is_number(start) and Util.is_number(length) else null
			told = [entry.get("text"), _seconds(start, TICKS), end]
		else:
			told = [entry.get("word", entry.get("text", entry.get("character"))), entry.get("start"), entry.get("end")]
	elif named:
		return false
	if typeof(told) != TYPE_ARRAY or told.size() < 2 or told.size() > 3 or typeof(told[0]) != TYPE_STRING:
		return false
	var over = told[2] if told.size() == 3 else null
	if not Util.is_number(told[1]) or not (over == null or Util.is_number(over)):
		return false
	out.append(LineTiming.SpokenWord.new(told[0], float(told[1]), null if over == null else float(over)))
	return true


# Adds the visemes an entry tells; returns whether it tells any.
static func _add_mark(entry, out):
	var told = entry
	if typeof(entry) == TYPE_DICTIONARY:
		var kind = entry.get("type", "viseme")
		if typeof(kind) != TYPE_STRING or kind != "viseme":
			return false
		if entry.has("type"):
			told = [_seconds(entry.get("time"), THOUSAND), entry.get("value")]
		elif entry.has("audioOffset"):
			told = [_seconds(entry.audioOffset, TICKS), entry.get("visemeId")]
		elif typeof(entry.get("weights")) == TYPE_DICTIONARY:
			for name in entry.weights:
				if not _add_mark([entry.get("time"), name, entry.weights[name]], out):
					return false
			return true
		else:
			told = [entry.get("time"), entry.get("viseme", entry.get("id")), entry.get("weight", 1.0)]
	if typeof(told) != TYPE_ARRAY or told.size() < 2 or told.size() > 3 or not Util.is_number(told[0]):
		return false
	var name = told[1]
	var weight = told[2] if told.size() == 3 else 1.0
	if Util.is_number(name) and name == floor(name):
		name = str(int(name))
	if typeof(name) != TYPE_STRING or not Util.is_number(weight):
		return false
	out.append(LineTiming.VisemeMark.new(float(told[0]), name, float(weight)))
	return true
