# Small events of the face: drawn with the other life layers, shown by `shown_face`, `answer` and `settle`.
#
# What is known and followed here: speakers raise their brows on stressed words (Cave et al. 1996), from about 60 ms before the
# accent (Flecha-Garcia 2010), and where they ask (Ekman 1979); greeting, people flash their brows for about a third of a second
# (Eibl-Eibesfeldt 1972); felt smiles come and go in 2/3 to 4 s and raise the cheeks (Ekman and Friesen 1982), posed ones may
# stay. So the face of a mood rises and falls back to a part of it, instead of being constant. How much, how often and for which
# tags is ours.
#
# If `Life.expressions` is 0, or at full stillness, the face of a mood is constant and nothing else is added.
#
# Translated from metagraph/playback/life/expressions.py; change that, and translate anew.

const Items = preload("items.gd")
const Voice = preload("voice.gd")
const Choice = preload("choice.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
# Swells: how the face of a mood comes up; rows: length s, amount, 1 where the mode was listening.
const SWELL_GAP = 3.5  # seconds between two, on average
const SHORTEST_SWELL = 0.9
const LONGEST_SWELL = 4.0
const SWELL_RISES = 0.35  # of its length
const KEPT = 0.75  # of a mood's face between swells
const WARMTH = 0.35  # of a smile that a listener's swell is
# Emphases: brows raised in speech, and where somebody reacts to something; rows: length s, amount, rise s.
const EARLY = 0.06  # seconds a raise begins before its syllable
const RAISE = 0.35  # seconds it takes at least
const RAISE_CHANCE = 0.3  # and what chance adds
const RAISE_RISES = 0.12
const ASKING = 0.8  # seconds before the end of a question that its brows begin to rise, but in its second half
const ASKING_ON = 0.5  # seconds they take to sink after it
const ASKING_LIFTS = 0.8  # of a full raise
const REACTING = 1.2  # seconds they take where a reaction begins
const LONGEST_EMPHASIS = 1.5  # seconds
# Cues: what those with certain tags show.
const CUE_RISES = 0.25  # seconds
const CUE_LASTS = 1.8
const CUE_FALLS = 0.6
const FLASH_FROM = 0.1  # seconds after a greeting begins
const FLASH_RISES = 0.08
const FLASH_LASTS = 0.4
const GREETING = "greeting"
# Of smile, frown, brow_down, brow_up, brows.
const SHOWN = {
	"greeting": [0.6, 0.0, 0.0, 0.0, 0.1],
	"positive": [0.3, 0.0, 0.0, 0.0, 0.15],
	"agree": [0.1, 0.0, 0.0, 0.0, 0.1],
	"negative": [0.0, 0.2, 0.35, 0.0, 0.0],
	"surprise": [0.0, 0.0, 0.0, 0.0, 0.9],
	"question": [0.0, 0.0, 0.0, 0.0, 0.6],
	"unsure": [0.0, 0.3, 0.0, 0.2, 0.5],
	"thinking": [0.0, 0.1, 0.35, 0.0, 0.0]
}
const MARKS = ["?", "？", "؟"]  # at the end of questions
const DUCHENNE = 0.2  # the smile from which on cheeks rise


# The weights of a face's channels, without lids and lips. brow_up raises only the inner ends of the brows, brows the whole of
# them. The same object is filled again for each time (`shown_face`, `answer`, `settle`).
class FaceShown:
	var smile
	var frown
	var brow_down
	var brow_up
	var brows
	var cheeks

	func _init(smile_ = 0.0, frown_ = 0.0, brow_down_ = 0.0, brow_up_ = 0.0, brows_ = 0.0, cheeks_ = 0.0):
		self.smile = smile_
		self.frown = frown_
		self.brow_down = brow_down_
		self.brow_up = brow_up_
		self.brows = brows_
		self.cheeks = cheeks_


# Return the lane of swells filled from `cut` to `drawn` seconds.
static func swells_on(track, seed_, cut, drawn, before):
	var times = []
	var rows = []
	var number = before.next
	var over = before.times[-1] + before.rows[-1][0] if before.times.size() > 0 else 0.0
	while true:
		var key = Choice.keyed(seed_, ["swell", str(number)])
		var gap = SWELL_GAP * (0.3 + 1.4 * Choice.chance_of(key, "gap"))
		var at = Util.most(cut, over + gap)
		if at >= drawn:
			return before.plus(times, rows)
		var length = SHORTEST_SWELL
		length += (LONGEST_SWELL - SHORTEST_SWELL) * Choice.chance_of(key, "length")
		var amount = 0.6 + 0.4 * Choice.chance_of(key, "amount")
		times.append(at)
		rows.append([length, amount, 1.0 if track.told_mode(at) == "listening" else 0.0])
		over = at + length
		number += 1


# Return the lane of emphases filled from `cut` to `drawn` seconds: on the share of stressed syllables that `accent_brows` says,
# at the end of questions, and where a reaction begins.
static func emphases_on(life, track, voices, seed_, cut, drawn, before):
	var found = []
	var chance
	for speech in track.speeches:
		if speech.end <= cut or speech.start >= drawn:
			continue
		var at
		for n in range(Voice.stressed(voices, speech).size()):
			var peak = Voice.stressed(voices, speech)[n]
			var begin = Items.find_line_start(speech)
			at = Util.most(speech.start, begin + peak - EARLY)
			if at >= speech.end or begin + peak < speech.start:
				continue
			if Choice.uniform(seed_, [speech.id, "brows", str(n)]) >= life.accent_brows:
				continue
			chance = Choice.uniform(seed_, [speech.id, "raise", str(n)])
			found.append([at, RAISE + RAISE_CHANCE * chance, 0.5 + 0.5 * chance, RAISE_RISES])
		if asks(speech):
			var length = Items.measure_line(speech)
			var lead = Util.least(ASKING, 0.5 * length)
			at = Util.most(speech.start, Items.find_line_start(speech) + length - lead)
			if at < speech.end:
				found.append([at, lead + ASKING_ON, ASKING_LIFTS, lead])
	for change in track.modes:
		if change.mode == "reacting" and life.accent_brows > 0:
			chance = Choice.uniform(seed_, [change.id, "raise"])
			found.append([change.start, REACTING, 0.6 + 0.4 * chance, RAISE_RISES])
	var times = []
	var rows = []
	var keys = []
	for x in found:
		keys.append([x[0], x[3]])
	for event in Util.ordered(found, keys):
		if cut <= event[0] and event[0] < drawn:
			times.append(event[0])
			rows.append(Util.part(event, 1, event.size()))
	return before.plus(times, rows)


# Return whether a speech is a question, by its last sign.
static func asks(speech):
	var text = speech.text.strip_edges()
	var holds = text != ""
	if holds:
		var is_any = false
		for mark in MARKS:
			if Util.parted_last(text, mark)[2] == "":
				is_any = true
				break
		holds = is_any
	return holds


# Fill in the face at a time, from the mood and the drawn events.
static func shown_face(face, life, swells, emphases, bears, seconds):
	var calm = 1 - life.stillness
	var swell = 0.0
	var warm = 0.0
	var n = Util.right_of(swells.times, seconds) - 1
	var length
	var amount
	var gone
	var rise
	if n >= 0:
		length = swells.rows[n][0]
		amount = swells.rows[n][1]
		var listens = swells.rows[n][2]
		gone = seconds - swells.times[n]
		rise = SWELL_RISES * length
		swell = amount * Mood.faded(Util.least(gone / rise, (length - gone) / (length - rise)))
		warm = listens * swell
	var share = 1 - calm * Util.least(1.0, life.expressions) * (1 - KEPT) * (1 - swell)
	var much = calm * life.expressions
	var brows = 0.0
	n = Util.right_of(emphases.times, seconds) - 1
	while n >= 0 and seconds - emphases.times[n] < LONGEST_EMPHASIS:
		length = emphases.rows[n][0]
		amount = emphases.rows[n][1]
		rise = emphases.rows[n][2]
		gone = seconds - emphases.times[n]
		brows = Util.most(brows, amount * Mood.faded(Util.least(gone / rise, (length - gone) / (length - rise))))
		n -= 1
	face.smile = share * bears.smile + much * WARMTH * warm * (1 - bears.frown)
	face.frown = share * bears.frown
	face.brow_down = share * bears.brow_down
	face.brow_up = share * bears.brow_up
	face.brows = share * bears.brows + much * brows


# Add what a cue with these tags, from `start` to `end`, shows on a face at a time.
static func answer(face, life, tags, start, end, seconds):
	var much = (1 - life.stillness) * life.expressions
	if much <= 0 or seconds <= start or seconds >= Util.least(end, start + CUE_LASTS):
		return
	var gone = seconds - start
	var shows = much * Mood.faded(Util.least(gone / CUE_RISES, (Util.least(end, start + CUE_LASTS) - seconds) / CUE_FALLS))
	for tag in tags:
		if SHOWN.has(tag):
			var of = SHOWN[tag]
			face.smile += shows * of[0]
			face.frown += shows * of[1]
			face.brow_down += shows * of[2]
			face.brow_up += shows * of[3]
			face.brows += shows * of[4]
		if tag == GREETING:
			var flash = gone - FLASH_FROM
			var left = FLASH_LASTS - flash
			face.brows += much * Mood.faded(Util.least(flash / FLASH_RISES, left / (FLASH_LASTS - FLASH_RISES)))


# Clamp all weights to 0..1, and raise the cheeks with a smile.
static func settle(face):
	face.smile = Mood.within(face.smile, 0.0, 1.0)
	face.frown = Mood.within(face.frown, 0.0, 1.0)
	face.brow_down = Mood.within(face.brow_down, 0.0, 1.0)
	face.brow_up = Mood.within(face.brow_up, 0.0, 1.0)
	face.brows = Mood.within(face.brows, 0.0, 1.0)
	face.cheeks = Mood.within((face.smile - DUCHENNE) / (1 - DUCHENNE), 0.0, 1.0)
