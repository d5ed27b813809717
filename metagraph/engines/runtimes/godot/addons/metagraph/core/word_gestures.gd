# Gestures that go with words, from the words alone: greetings, denial, doubt, contrast, lists, persons and places, emphasis, and
# a beat where there is none of these.
#
# After the idea of BEAT (Cassell, Vilhjalmsson and Bickmore, 2001): a text's words propose gestures by rules and a lexicon that
# anybody can edit, and the weaker ones of those that would collide are left out. A gesture with a meaning precedes its word by
# more than a beat does (ter Bekke et al. 2024: its stroke by some 0.2 s). All other numbers are ours. Times are seconds from
# where the text begins.
#
# Translated from metagraph/speech/word_gestures.py; change that, and translate anew.

const Graphemes = preload("graphemes.gd")
const Choice = preload("choice.gd")
const Util = preload("util.gd")
const APART = {"arms": 2.4, "head": 1.8}  # seconds between two strokes of a layer, at least
const AGAIN = 1.6  # and so many times as far where both are of the same tag
const LATE = 0.35  # seconds that a stroke may come after its word; later than that none is made
const FIRST = 1.4  # seconds into a text up to which a stroke may come late: a hand needs as long to get there
const PLAIN = 0.55  # of the clauses that propose nothing, how many get a beat
const LEAD = 0.1  # seconds that a stroke comes before the middle of its word's vowels
const MEANING_LEAD = 0.2  # the same of a gesture that means something
const BEATS = ["beat", "emphasis", "explain", "open"]  # tags of gestures that go with any word
const NOD = 0.3  # seconds from where a nod begins to its first stroke
const CLAUSE = 3  # words of a clause that gets a beat, at least
const LONGEST = 20000  # letters of a text
const ENDS = ".?!…。？！"
const PAUSES = ",;:–—、，"
const INSIDE = "'’-"  # what a word may have in the middle
const CLOSING = "\"')”»"  # what may stand between a word and the mark behind it


# A gesture that some words propose. words: small letters; several in a row for a phrase. tags: of a gesture of the arms, the best
# first; the first one that the character has counts. head: its movement at the same time: "nod", "shake" or nothing. strength:
# the stronger of two rules wins.
class GestureRule:
	var words
	var tags
	var head
	var strength

	func _init(words_ = null, tags_ = null, head_ = "", strength_ = 1.0):
		self.words = words_ if words_ != null else []
		self.tags = tags_ if tags_ != null else []
		self.head = head_
		self.strength = strength_


# A lexicon. question, exclamation: proposed at the end of a sentence, for its last content word. clause: proposed for a clause
# without other proposals.
class GestureWords:
	var rules
	var language
	var question
	var exclamation
	var clause

	func _init(rules_, language_ = "en", question_ = null, exclamation_ = null, clause_ = null):
		self.rules = rules_
		self.language = language_
		self.question = question_ if question_ != null else GestureRule.new()
		self.exclamation = exclamation_ if exclamation_ != null else GestureRule.new()
		self.clause = clause_ if clause_ != null else GestureRule.new()


# A word of a text. plain: in small letters. mark: the punctuation after it.
class TextWord:
	var text
	var plain
	var start
	var end
	var mark

	func _init(text_, plain_, start_, end_, mark_ = ""):
		self.text = text_
		self.plain = plain_
		self.start = start_
		self.end = end_
		self.mark = mark_


# A word with the times at which a synthesiser says it.
class ToldWord:
	var start
	var end

	func _init(start_, end_):
		self.start = start_
		self.end = end_


# A gesture that goes with a word. do: "gesture", "nod" or "shake". at: time of its stroke. tags: empty for gestures of the head.
class ProposedGesture:
	var layer
	var at
	var tags
	var strength
	var word
	var do

	func _init(layer_, at_, tags_, strength_, word_, do_ = "gesture"):
		self.layer = layer_
		self.at = at_
		self.tags = tags_
		self.strength = strength_
		self.word = word_
		self.do = do_


# The request for a gesture. at: the earliest second of the session at which it may begin. stroke: the time of its stroke, None
# for the head. late: by how many seconds it may come late.
class GestureAsk:
	var do
	var layer
	var tags
	var at
	var stroke
	var late

	func _init(do_, layer_, tags_, at_, stroke_, late_):
		self.do = do_
		self.layer = layer_
		self.tags = tags_
		self.at = at_
		self.stroke = stroke_
		self.late = late_


# A word, the number of letters of the text up to its end, and the mark after it.
class SplitWord:
	var text
	var end
	var mark

	func _init(text_, end_, mark_):
		self.text = text_
		self.end = end_
		self.mark = mark_


# Return a text's words with their times: those of a synthesiser, else as long as lips would take.
#
# told: the times of the words in order; words without times are left out. seconds: how long all of it takes, if only that is
# known.
static func words_of(alphabet, text, told = null, seconds = null):
	if told == null:
		told = []
	var letters = alphabet.letters(text)
	var pace = 1.0
	if seconds != null and told.size() == 0:
		pace = seconds / Util.most(0.001, Graphemes.read_aloud(alphabet, text))
	var out = []
	for split in _split(alphabet, Util.part(letters, 0, LONGEST)):
		var small = alphabet.letters(split.text.to_lower())
		var found = []
		for letter in small:
			found.append("'" if letter == "’" else letter)
		var plain = Util.joined(found, "")
		if told.size() > 0:
			if out.size() == told.size():
				break
			var times = told[out.size()]
			out.append(TextWord.new(split.text, plain, times.start, times.end, split.mark))
		else:
			var stop = pace * Graphemes.read_aloud(alphabet, Util.joined(Util.part(letters, 0, split.end), ""))
			var before = out[out.size() - 1].end if out.size() > 0 else 0.0
			var start = Util.most(before, stop - pace * Graphemes.read_aloud(alphabet, split.text))
			out.append(TextWord.new(split.text, plain, start, stop, split.mark))
	return out


static func _is_letter(alphabet, letter):
	var kind = alphabet.kind(letter)
	return kind == "syllable" or kind == "letter"


# Return whether letters contain words, so that there is something to say.
static func telling(alphabet, letters):
	var is_any = false
	for letter in letters:
		if _is_letter(alphabet, letter):
			is_any = true
			break
	return is_any


static func _split(alphabet, letters):
	var out = []
	var at = 0
	var count = letters.size()
	while at < count:
		if not _is_letter(alphabet, letters[at]):
			at += 1
			continue
		var first = at
		while at < count:
			var goes_on = _is_letter(alphabet, letters[at])
			if not goes_on and INSIDE.find(letters[at]) >= 0 and at + 1 < count:
				goes_on = _is_letter(alphabet, letters[at + 1])
			if not goes_on:
				break
			at += 1
		var behind = at
		while behind < count and CLOSING.find(letters[behind]) >= 0:
			behind += 1
		var mark = ""
		if behind < count and (ENDS.find(letters[behind]) >= 0 or PAUSES.find(letters[behind]) >= 0):
			mark = letters[behind]
		out.append(SplitWord.new(Util.joined(Util.part(letters, first, at), ""), at, mark))
	return out


# Return the gestures that go with words, in order and without collisions.
#
# arms: tags of the character's gestures of the arms; others are not proposed. head: whether the head moves. small: words that say
# little by themselves.
static func proposed_for(words, arms, head, lexicon, small, seed_):
	var every = []
	var clause = []
	var proposes = false
	for n in range(words.size()):
		var word = words[n]
		clause.append(word)
		var both = _fitting(lexicon, words, n)
		var rule = both[0]
		var length = both[1]
		if length > 0:
			Util.extend(every, _of(rule, words[n + length - 1], arms, head))
			proposes = true
		if word.mark == "" and n + 1 < words.size():
			continue
		var large = []
		for w in clause:
			if not small.has(w.plain):
				large.append(w)
		var last = large[large.size() - 1] if large.size() > 0 else clause[clause.size() - 1]
		if word.mark == "?" or word.mark == "？":
			Util.extend(every, _of(lexicon.question, last, arms, head))
		elif word.mark == "!" or word.mark == "！":
			Util.extend(every, _of(lexicon.exclamation, last, arms, head))
		elif (not proposes and clause.size() >= CLAUSE and Choice.uniform(seed_, ["%d/%s" % [n, last.plain], "beat"]) < PLAIN):
			Util.extend(every, _of(lexicon.clause, last, arms, head))
		clause = []
		proposes = false
	var kept = _spaced(every)
	var keys = []
	for one in kept:
		keys.append(one.at)
	return Util.ordered(kept, keys)


# Return the rule with the longest phrase that begins at a word, and the number of its words; 0 if there is none.
static func _fitting(lexicon, words, n):
	var best = lexicon.clause
	var longest = 0
	for rule in lexicon.rules:
		for phrase in rule.words:
			var parts = Util.words(phrase)
			if parts.size() > longest and _says(words, n, parts):
				best = rule
				longest = parts.size()
	return [best, longest]


# Return whether a phrase begins at a word, without a pause inside it.
static func _says(words, first, parts):
	if first + parts.size() > words.size():
		return false
	for k in range(parts.size()):
		var part = parts[k]
		if words[first + k].plain != part or (k + 1 < parts.size() and words[first + k].mark != ""):
			return false
	return true


static func _of(rule, word, arms, head):
	var at = Util.most(0.0, (word.start + word.end) / 2 - LEAD)
	var out = []
	for tag in rule.tags:
		if arms.has(tag):
			var early = 0.0 if BEATS.has(tag) else MEANING_LEAD - LEAD
			out.append(ProposedGesture.new("arms", Util.most(0.0, at - early), [tag], rule.strength, word.text))
			break
	if rule.head != "" and head:
		out.append(ProposedGesture.new("head", at, [], rule.strength, word.text, rule.head))
	return out


# Leave out gestures that are too near to a stronger one of their layer; of two equal ones the earlier stays. The same tag twice
# in a row needs more room.
static func _spaced(every):
	var kept = []
	var keys = []
	for one2 in every:
		keys.append([-one2.strength, one2.at])
	for one in Util.ordered(every, keys):
		var is_any = false
		for other in kept:
			if _in_the_way(one, other):
				is_any = true
				break
		if not is_any:
			kept.append(one)
	return kept


static func _in_the_way(one, other):
	if one.layer != other.layer:
		return false
	var room = APART[one.layer]
	if one.tags.size() == 0 or (other.tags.size() > 0 and one.tags[0] == other.tags[0]):
		room *= AGAIN
	return Util.absolute(one.at - other.at) < room


# Return the requests for the gestures of a text that begins at `at` seconds of the session. Gestures that cannot be in time are
# refused, not made late.
static func gesture_asks(every, at):
	var out = []
	for one in every:
		var late = Util.most(LATE, FIRST - one.at)
		if one.do == "gesture":
			out.append(GestureAsk.new(one.do, one.layer, one.tags, at, at + one.at, late))
		else:
			out.append(GestureAsk.new(one.do, one.layer, [], at + Util.most(0.0, one.at - NOD), null, late))
	return out


# Return the number of letters after which the first sentence of a text ends, 0 if it goes on. over: whether the text is complete.
static func sentence_end(alphabet, letters, over):
	var some = false
	for n in range(letters.size()):
		var letter = letters[n]
		var blank = alphabet.stripped(letter) == ""
		if letter == "\n" and some:
			return n + 1
		# An end is one once something else follows: "3." may become "3.5".
		if (ENDS.find(letter) >= 0
			and n + 1 < letters.size()
			and ("。？！".find(letter) >= 0 or alphabet.stripped(letters[n + 1]) == "")):
			return n + 1
		some = some or not blank
	return letters.size() if (over and some) else 0
