# Text, whole or piece by piece, as speech with the gestures that go with its words. Times are seconds of the character's own.

const Util = preload("util.gd")
const Graphemes = preload("graphemes.gd")
const WordGestures = preload("word_gestures.gd")
const Lists = preload("gesture_words.gd")
const START = 0.35  # seconds before a text begins, so that a hand can be where its first stroke needs it
const BETWEEN = 0.25  # seconds between two sentences

var character
var free_from = 0.0  # from when on nothing is said yet
var _alphabet
var _lexicon
var _small
var _arms = {}
var _head = false
var _seed
var _name
var _count = 0
var _text = ""  # what came in and is no whole sentence


# options: language: "en" or "de_AT", English where there is no lexicon of it; lexicon: one of your own, a Dictionary as the files have
# it; seed: 0..2^32 - 1; name: what ids begin with.
func _init(of, options = {}):
	character = of
	_alphabet = of.graph.alphabet
	_seed = int(options.get("seed", 1))
	_name = options.get("name", "talk")
	var both = lexicon_of(options.get("language", "en"), options.get("lexicon"))
	_lexicon = both[0]
	_small = both[1]
	for action in of.graph.layers.arms.actions.values():
		if action.kind == "gesture":
			for tag in action.tags:
				_arms[tag] = true
	for action in of.graph.layers.head.actions.values():
		_head = _head or (action.kind == "gesture" and action.tags.size() > 0)


# Says a text, with gestures on its words. more: further fields of the request `say`: `words` that are told with starts and ends tell
# when gestures come, else `duration`, else how long lips take. Returns {id, gestures: their ids}.
func say(text, more = {}):
	_count += 1
	var request = more.duplicate()
	request.erase("after")
	request["do"] = "say"
	request["text"] = text
	if typeof(more.get("id")) != TYPE_STRING or more["id"] == "":
		request["id"] = "%s%d" % [_name, _count]
	var after = more.get("after")
	if more.get("at") == null:
		request["at"] = character.now + (after if Util.is_finite_number(after) else START)
	var ident = character.ask(request)
	if character.answer(ident).state == "refused":
		return {id = ident, gestures = []}
	var at = float(request.at)
	var told = _times(more.get("words", []))
	var duration = more.get("duration")
	var aloud = told[told.size() - 1].end if told.size() > 0 else Graphemes.read_aloud(_alphabet, text)
	free_from = at + (aloud if duration == null else duration) + BETWEEN
	var gestures = []
	for one in WordGestures.gesture_asks(proposed(WordGestures.words_of(_alphabet, text, told, duration)), at):
		var gesture = {"do": one.do, "id": "%s/%d" % [ident, gestures.size()], "at": one.at, "late": one.late}
		if one.stroke != null:
			gesture["layer"] = one.layer
			gesture["tags"] = one.tags
			gesture["stroke"] = one.stroke
		gestures.append(character.ask(gesture))
	return {id = ident, gestures = gestures}


# Breaks off all that is said, because the other speaks, and forgets what came in and is not said yet. What is said next begins at
# once. Returns the request's id.
func interrupt():
	_text = ""
	free_from = 0.0
	return character.ask({"do": "interrupt"})


# Returns the gestures that go with words.
func proposed(words):
	return WordGestures.proposed_for(words, _arms, _head, _lexicon, _small, (_seed + _count) & 0xFFFFFFFF)


# Takes in what comes next of a text, as a language model writes it: each sentence is said when it is whole, after the one before. over:
# whether the text ends here. Returns what was said by it, as `say` does.
func take(piece, over = false):
	_text += piece
	var out = []
	while true:
		var letters = _alphabet.letters(_text)
		var end = WordGestures.sentence_end(_alphabet, letters, over)
		if end == 0:
			return out
		var sentence = Util.part(letters, 0, end)
		_text = Util.joined(Util.part(letters, end, letters.size()), "")
		if WordGestures.telling(_alphabet, sentence):
			out.append(say(_alphabet.stripped(Util.joined(sentence, "")), {"at": Util.most(free_from, character.now + START)}))


# Returns a language's lexicon, and a set of its words that say little by themselves. own: a lexicon as the files have them, instead.
static func lexicon_of(language, own = null):
	var code = language.to_lower().replace("_", "-").split("-")[0]
	var known = Lists.GESTURE_WORDS[code if Lists.GESTURE_WORDS.has(code) else "en"]
	var given = known if own == null else own
	var rules = []
	for rule in given.get("rules", []):
		rules.append(_rule(rule))
	var lexicon = WordGestures.GestureWords.new(
		rules, code, _rule(given.get("question", {})), _rule(given.get("exclamation", {})), _rule(given.get("clause", {}))
	)
	var small = {}
	for word in given.get("small", known.small):
		small[word] = true
	return [lexicon, small]


# Returns words' times, as requests have them; none where an end is not told.
static func _times(words):
	var out = []
	for word in words:
		var row = typeof(word) == TYPE_ARRAY
		var start = word[1] if row and word.size() > 2 else (null if row else word.get("start"))
		var end = word[2] if row and word.size() > 2 else (null if row else word.get("end"))
		if not Util.is_finite_number(start) or not Util.is_finite_number(end):
			return []
		out.append(WordGestures.ToldWord.new(float(start), float(end)))
	return out


static func _rule(fields):
	var head = fields.get("head")
	return WordGestures.GestureRule.new(
		fields.get("words", []), fields.get("tags", []), head if head != null else "", float(fields.get("strength", 1.0))
	)
