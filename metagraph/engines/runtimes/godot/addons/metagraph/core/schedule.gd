# The events of the life layers: drawn from the seed one by one, and then a function of time.
#
# Each event depends only on the previous one and on the requests meanwhile; its random draw depends on its number. So a schedule
# grows as a plan does: events that have begun stay, many short extensions give the same as one long one, and past events can be
# forgotten.
#
# Translated from metagraph/playback/life/schedule.py; change that, and translate anew.

const Life = preload("life.gd")
const Words = preload("words.gd")
const Expressions = preload("expressions.gd")
const Items = preload("items.gd")
const Lane = preload("lane.gd")
const Voice = preload("voice.gd")
const Wanted = preload("wanted.gd")
const Choice = preload("choice.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const BLOCK = 8.0  # seconds drawn at a time, so that a running plan need not draw at every tick
const RECALL = 4.0  # seconds of looks kept when the past is forgotten: longer than any turn of the head takes
# Blinks: on stressed syllables at least so many seconds after the last (Yang et al., section 7.3); of
# themselves after gaps that spread as people's do, log-normal, a few of them doubles.
const AFTER_BLINK = 1.0
const BLINK_SPREAD = 0.7  # standard deviation of the gaps, times their mean
const DOUBLES = 0.06  # share of blinks that follow the one before at once
const DOUBLE = 0.4  # seconds after which they do
const HALVES = 0.12  # share of blinks by themselves that are incomplete
const HALF = 0.6  # how far these shut the eyes
# Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
# with what they look at.
const FIXATION = 0.2
const SACCADE = 1.2  # degrees on average
const LARGEST_SACCADE = 4.0  # degrees
const UPRIGHT = 0.6  # how much of an offset goes up and down
# Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
const AVERSION_GAP = 0.6
const AVERSION_CHANCE = 0.8
const BETWEEN_AVERSIONS = 0.6  # seconds at least
const SHORTEST_AVERSION = 0.25
const BREATH = 0.85  # of the mean length and depth: the least
const BREATH_CHANCE = 0.3  # and what chance adds
# A character breathes in before it speaks: a breath begins so long before the first word, and the one before
# it is shortened or drawn out by so much of its length at most. Ours.
const BREATHES_IN = 0.55  # seconds
const STRETCH = 0.5


# Everything that the life layers do by themselves from 0 to `end` seconds, in lanes. The columns of a lane's rows are listed
# here.
#
# modes: index in MODES. moods: valence, arousal, intensity. targets: what the gaze looks at. breaths: length s, depth. aversions:
# end s, right-to-left and upward part of the offset (of life's angle). saccades: offset to the left and up, degrees. blinks: 0
# spontaneous, 1 on a stressed syllable, 2 requested, 3 spontaneous and incomplete. swells, emphases: of the face (`expressions`).
# drawn: seconds up to which the lanes are filled; the rest is what they were drawn from.
class Schedule:
	var end
	var drawn
	var modes
	var moods
	var targets
	var breaths
	var aversions
	var saccades
	var blinks
	var swells
	var emphases
	var life
	var track
	var voices
	var seed_

	func _init(
		end_ = 0.0,
		drawn_ = 0.0,
		modes_ = null,
		moods_ = null,
		targets_ = null,
		breaths_ = null,
		aversions_ = null,
		saccades_ = null,
		blinks_ = null,
		swells_ = null,
		emphases_ = null,
		life_ = null,
		track_ = null,
		voices_ = null,
		seed_ = 0
	):
		self.end = end_
		self.drawn = drawn_
		self.modes = modes_ if modes_ != null else Lane.Lane.new([], [], 0, 1)
		self.moods = moods_ if moods_ != null else Lane.Lane.new([], [], 0, 3)
		self.targets = targets_ if targets_ != null else []
		self.breaths = breaths_ if breaths_ != null else Lane.Lane.new([], [], 0, 2)
		self.aversions = aversions_ if aversions_ != null else Lane.Lane.new([], [], 0, 3)
		self.saccades = saccades_ if saccades_ != null else Lane.Lane.new([], [], 0, 2)
		self.blinks = blinks_ if blinks_ != null else Lane.Lane.new([], [], 0, 1)
		self.swells = swells_ if swells_ != null else Lane.Lane.new([], [], 0, 3)
		self.emphases = emphases_ if emphases_ != null else Lane.Lane.new([], [], 0, 3)
		self.life = life_
		self.track = track_
		self.voices = voices_
		self.seed_ = seed_

	# Return the schedule without events that ended before `seconds`; later draws do not change.
	func since(seconds):
		var breaths = self.breaths.since(seconds)
		var aversions = self.aversions.since(seconds)
		var saccades = self.saccades.since(seconds)
		var blinks = self.blinks.since(seconds)
		var rates = [1.0, 1.0, 1.0, 1.0]
		if self.life != null:
			rates = [self.life.breath_rate, self.life.aversion_rate, self.life.saccade_rate, self.life.blinks]
		# Gaps run in modes' time from the event before, so the modes since then are needed.
		var lanes = [breaths, aversions, saccades, blinks]
		var firsts = []
		for kept in lanes:
			if kept.times.size() > 0:
				firsts.append(kept.times[0])
		var needed = Util.least_of(firsts) if firsts.size() > 0 else seconds
		var is_any = false
		for n in range(lanes.size()):
			var kept = lanes[n]
			var rate = rates[n]
			if kept.times.size() == 0 and rate > 0:
				is_any = true
				break
		if is_any:
			needed = 0.0
		var found = []
		for t in self.targets:
			found.append(t.start)
		var looked = Util.right_of(found, Util.least(needed, seconds - RECALL)) - 1
		return Schedule.new(
			self.end,
			self.drawn,
			self.modes.since(needed, 0),
			self.moods.since(Util.least(needed, seconds - RECALL), 0),
			Util.part(self.targets, Util.most(0, looked), self.targets.size()),
			breaths,
			aversions,
			saccades,
			blinks,
			self.swells.since(seconds),
			self.emphases.since(seconds, 3),
			self.life,
			self.track,
			self.voices,
			self.seed_
		)


# Return the schedule to `end` seconds. Events of `before` that begin before `now` stay exactly as they were.
#
# Its later events stay, too, if nothing that they were drawn from has changed.
static func schedule(life, track, voices, seed_, end, before, now):
	if not life.on:
		return Schedule.new(
			end,
			before.drawn,
			before.modes,
			before.moods,
			before.targets,
			before.breaths,
			before.aversions,
			before.saccades,
			before.blinks,
			before.swells,
			before.emphases,
			life,
			track,
			voices,
			seed_
		)
	var drawn = Util.most(BLOCK, int(ceil(end / BLOCK)) * BLOCK)
	var change = _change(before, life, track, voices, seed_)
	if change == "" and drawn == before.drawn:
		return Schedule.new(
			end,
			before.drawn,
			before.modes,
			before.moods,
			before.targets,
			before.breaths,
			before.aversions,
			before.saccades,
			before.blinks,
			before.swells,
			before.emphases,
			before.life,
			before.track,
			before.voices,
			before.seed_
		)
	var cut = Util.most(0.0, Util.least(before.drawn, drawn if change == "" else now))
	var chance = Util.least(before.drawn, drawn) if change == "places" else cut
	var draw = _draw(life, track, voices, seed_, cut, drawn, before)
	var breaths = before.breaths.until(chance)
	var aversions = before.aversions.until(chance)
	var saccades = before.saccades.until(chance)
	var blinks = before.blinks.until(chance)
	var swells = before.swells.until(chance)
	var emphases = before.emphases.until(chance)
	if chance < drawn:
		draw.begin(chance)
		breaths = draw.breaths(breaths)
		aversions = draw.aversions(aversions)
		saccades = draw.saccades(saccades)
		blinks = draw.blinks(blinks)
		swells = Expressions.swells_on(track, seed_, chance, drawn, swells)
		emphases = Expressions.emphases_on(life, track, voices, seed_, chance, drawn, emphases)
	return Schedule.new(
		end,
		drawn,
		draw.modes,
		draw.moods,
		draw.targets,
		breaths,
		aversions,
		saccades,
		blinks,
		swells,
		emphases,
		life,
		track,
		voices,
		seed_
	)


# Return "" if nothing that a schedule was drawn from has changed, "places" if only places have, else "all".
static func _change(before, life, track, voices, seed_):
	if before.track == null or before.seed_ != seed_ or not Life.is_same_life(before.life, life):
		return "all"
	if not Voice.are_same_voices(before.voices, voices):
		return "all"
	if before.track == track or before.track.like(track):
		return ""
	return "places" if before.track.draws_like(track) else "all"


# One extension: lanes filled from `cut` to `drawn` seconds. edges: when modes, moods or strict looks change; manners: the factors
# of the amounts from each edge on; strict: 1 if the look is strict from there on, else 0. phrases: when the character begins to
# speak.
class LifeDraw:
	var life
	var track
	var voices
	var seed_
	var cut
	var drawn
	var calm
	var modes
	var moods
	var targets
	var edges
	var manners
	var strict
	var phrases

	func _init(
		life_,
		track_,
		voices_,
		seed_,
		cut_,
		drawn_,
		calm_,
		modes_,
		moods_,
		targets_,
		edges_ = null,
		manners_ = null,
		strict_ = null,
		phrases_ = null
	):
		self.life = life_
		self.track = track_
		self.voices = voices_
		self.seed_ = seed_
		self.cut = cut_
		self.drawn = drawn_
		self.calm = calm_
		self.modes = modes_
		self.moods = moods_
		self.targets = targets_
		self.edges = edges_ if edges_ != null else []
		self.manners = manners_ if manners_ != null else []
		self.strict = strict_ if strict_ != null else []
		self.phrases = phrases_ if phrases_ != null else []

	# Combine modes, moods and strict looks into one list of segments.
	func begin(cut):
		self.cut = cut
		var talks = []
		for change in self.track.modes:
			if change.mode == "talking":
				talks.append(change.start)
		var found = []
		for speech in self.track.speeches:
			found.append(speech.start)
		self.phrases = Util.in_order(found + talks)
		var edges = Util.list(self.modes.times)
		Util.extend(edges, self.moods.times)
		for n in range(self.targets.size()):
			var target = self.targets[n]
			if n == 0 or target.strict != self.targets[n - 1].strict:
				edges.append(target.start)
		var begun = []
		for t in self.targets:
			begun.append(t.start)
		for edge in Util.in_order(edges):
			if self.edges.size() > 0 and self.edges[-1] == edge:
				continue
			var mode = Util.most(0, Util.right_of(self.modes.times, edge) - 1)
			var look = Util.most(0, Util.right_of(begun, edge) - 1)
			self.edges.append(edge)
			var felt = self.moods.rows[Util.most(0, Util.right_of(self.moods.times, edge) - 1)]
			var ways = Life.get_manner(self.life, Words.MODES[int(self.modes.rows[mode][0])])
			self.manners.append(Wanted.ways_in(ways, Mood.Mood.new(felt[0], felt[1], felt[2])))
			self.strict.append(1 if self.targets[look].strict else 0)

	# Return the key of an event's random numbers, for `chance_of`.
	func key(what, number):
		return Choice.keyed(self.seed_, [what, str(number)])

	# Return the index of the segment that contains a time.
	func place_at(seconds):
		return Util.most(0, Util.right_of(self.edges, seconds) - 1)

	# Return whether the character is thinking at a time: then it looks up and aside, never down.
	func thinks(seconds):
		var mode = Util.most(0, Util.right_of(self.modes.times, seconds) - 1)
		return Words.MODES[int(self.modes.rows[mode][0])] == "thinking"

	# Return when `need` seconds have passed since `seconds` on a clock that runs at these rates, one for each segment; infinity
	# if that is after the end.
	func after(seconds, need, rates):
		var at = seconds
		var left = need
		var place = self.place_at(at)
		while at < self.drawn:
			var end = self.edges[place + 1] if place + 1 < self.edges.size() else self.drawn
			var rate = rates[place]
			if rate > 0 and at + left / rate < end:
				return at + left / rate
			left -= rate * Util.most(0.0, end - at)
			at = end
			place += 1
		return INF

	# Draw breaths, each after the previous one. The first began before time 0, so that characters do not breathe in step.
	func breaths(lane):
		var times = []
		var rows = []
		var number = lane.next
		var begun = lane.times.size() > 0
		var at = lane.times[-1] + lane.rows[-1][0] if begun else 0.0
		while true:
			if begun:
				at = Util.most(at, self.cut)
			var ways = self.manners[self.place_at(at)]
			var rate = self.life.breath_rate * ways.breath_rate / 60.0
			if rate <= 0:  # no breath until another mode begins
				var later = Util.right_of(self.edges, at)
				if self.life.breath_rate <= 0 or later == self.edges.size():
					break
				at = self.edges[later]
				begun = true
				continue
			var key = self.key("breath", number)
			var length = (BREATH + BREATH_CHANCE * Choice.chance_of(key, "length")) / rate
			length *= 1.0 + 2.0 * self.life.stillness  # slower, too, but never halting
			length = self.to_phrase(at, length) if begun else length
			var depth = ways.breathing * (BREATH + BREATH_CHANCE * Choice.chance_of(key, "depth"))
			if not begun:
				at = -length * Choice.uniform(self.seed_, ["breath", "first"])
				begun = true
			if at >= self.drawn:
				break
			times.append(at)
			rows.append([length, depth])
			at += length
			number += 1
		return lane.plus(times, rows)

	# Return the length of a breath that begins at `at`, so that the next one begins right before the character speaks.
	func to_phrase(at, length):
		var place = Util.left_of(self.phrases, at + (1.0 - STRETCH) * length + BREATHES_IN)
		if place == self.phrases.size():
			return length
		var wanted = self.phrases[place] - BREATHES_IN - at
		return wanted if wanted <= (1.0 + STRETCH) * length else length

	# Draw the small jumps of the eyes.
	func saccades(lane):
		if self.life.saccade_rate <= 0 or self.calm <= 0:
			return lane
		var mean = Util.most(60.0 / self.life.saccade_rate, FIXATION + 0.01)
		var rates = []
		for ways in self.manners:
			rates.append(ways.saccade_rate * self.calm)
		var times = []
		var rows = []
		var number = lane.next
		var last = lane.times[-1] if lane.times.size() > 0 else 0.0
		while true:
			var key = self.key("saccade", number)
			var need = FIXATION + (mean - FIXATION) * Util.least(4.0, -log(Choice.chance_of(key, "gap")))
			last = Util.most(self.cut, self.after(last, need, rates))
			if not (last < self.drawn):
				return lane.plus(times, rows)
			var size = Util.least(LARGEST_SACCADE, -SACCADE * log(Choice.chance_of(key, "size")))
			size *= self.manners[self.place_at(last)].saccades
			var turn = 2.0 * PI * Choice.chance_of(key, "way")
			times.append(last)
			rows.append([size * sin(turn + PI / 2.0), UPRIGHT * size * sin(turn)])
			number += 1

	# Draw short looks away.
	func aversions(lane):
		var life = self.life
		if life.aversion_rate <= 0 or life.aversion_length <= 0 or life.aversion_angle <= 0 or self.calm <= 0:
			return lane
		var rates = []
		for n in range(self.manners.size()):
			var ways = self.manners[n]
			var strict = self.strict[n]
			var rate = life.aversion_rate * ways.aversion_rate
			if strict == 1 or rate <= 0:
				rates.append(0.0)
			else:
				var mean = Util.most(BETWEEN_AVERSIONS, 60.0 / rate - life.aversion_length * ways.aversion_length)
				rates.append(self.calm / mean)
		var times = []
		var rows = []
		var number = lane.next
		var last = lane.rows[-1][0] if lane.rows.size() > 0 else 0.0
		while true:
			var key = self.key("aversion", number)
			var need = AVERSION_GAP + AVERSION_CHANCE * Choice.chance_of(key, "gap")
			var at = Util.most(self.cut, Util.most(last + BETWEEN_AVERSIONS, self.after(last, need, rates)))
			if not (at < self.drawn):
				return lane.plus(times, rows)
			var own = self.manners[self.place_at(at)]
			var length = life.aversion_length * own.aversion_length
			length *= 0.6 + 0.8 * Choice.chance_of(key, "length")
			last = at + Util.most(SHORTEST_AVERSION, length)
			var size = own.aversion_angle * (0.7 + 0.6 * Choice.chance_of(key, "size"))
			var turn = 2.0 * PI * Choice.chance_of(key, "way")
			var up = UPRIGHT * size * sin(turn)
			times.append(at)
			rows.append([last, size * sin(turn + PI / 2.0), Util.absolute(up) if self.thinks(at) else up])
			number += 1

	# Draw blinks: spontaneous ones, those on stressed syllables and requested ones, in the order in which they come.
	func blinks(lane):
		var life = self.life
		var shut = life.blink_close + life.blink_open
		var mean = 60.0 / life.blinks if (life.blinks > 0 and self.calm > 0) else INF
		var rates = []
		for ways in self.manners:
			rates.append(ways.blinks * self.calm)
		var last = -0.5 * Util.least(mean, 10.0) * Choice.uniform(self.seed_, ["blink", "first"])
		if lane.times.size() > 0:
			last = lane.times[-1]
		var accents = []
		if self.calm > 0 and life.accent_blinks > 0:
			accents = self.accents(Util.most(0.0, Util.least(self.cut, last)))
		var asked = []
		for b in self.track.blinks:
			asked.append(b.start)
		var times = []
		var rows = []
		var number = lane.next
		var place = 0
		while true:
			var own = INF
			if mean < INF:
				var key = self.key("blink", number)
				var drawn = Choice.log_normal(
					mean,
					BLINK_SPREAD * mean,
					Choice.chance_of(key, "gap"),
					Choice.chance_of(key, "gap2")
				)
				var need = DOUBLE if Choice.chance_of(key, "double") < DOUBLES else Util.most(DOUBLE, drawn)
				own = Util.most(self.cut, self.after(last, need, rates))
			# A stressed syllable may bring a blink: the first of a speech always, the others some time after
			# the last blink.
			while place < accents.size():
				var both = accents[place]
				var accent = both[0]
				var first = both[1]
				if accent >= self.cut and accent >= last + (shut + 0.1 if first else AFTER_BLINK / self.calm):
					break
				place += 1
			var heard = accents[place][0] if place < accents.size() else INF
			var wish = Util.left_of(asked, Util.most(self.cut, last + shut))
			var wanted = asked[wish] if wish < asked.size() else INF
			var at = Util.least(own, Util.least(heard, wanted))
			if at >= self.drawn:
				return lane.plus(times, rows)
			times.append(at)
			var kind = 1.0 if at == heard else 0.0
			if at == own and at != heard and Choice.chance_of(self.key("blink", number), "half") < HALVES:
				kind = 3.0
			rows.append([2.0 if at == wanted else kind])
			last = at
			number += 1

	# Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first.
	func accents(start):
		var out = []
		for speech in self.track.speeches:
			if speech.end <= start or speech.start >= self.drawn:
				continue
			var end = Util.least(speech.end, self.drawn)
			for n in range(Voice.stressed(self.voices, speech).size()):
				var peak = Voice.stressed(self.voices, speech)[n]
				var at = Items.find_line_start(speech) + peak
				if at < Util.most(start, speech.start) or at >= end:
					continue
				if n == 0 or Choice.uniform(self.seed_, [speech.id, "accent", str(n)]) < self.life.accent_blinks:
					out.append([at, n == 0])
		return out


# Return the draw that extends a schedule from `cut` to `drawn` seconds, with modes and looks filled in.
static func _draw(life, track, voices, seed_, cut, drawn, before):
	var modes = before.modes.until(cut)
	var last = int(modes.rows[-1][0]) if modes.rows.size() > 0 else -1
	var times = []
	var rows = []
	for pair in Wanted.modes_between(track, cut, drawn):
		var at = pair[0]
		var mode = pair[1]
		if times.size() > 0 or mode != last:
			times.append(at)
			rows.append([float(mode)])
	var moods = before.moods.until(cut)
	var felt = []
	if moods.rows.size() > 0:
		felt = Util.list(moods.rows[-1])
	var changes = []
	var wanted = []
	for pair in Wanted.moods_between(Wanted.moods_of(life, track), cut, drawn):
		var at = pair[0]
		var mood = pair[1]
		var same = felt.size() > 0 and felt[0] == mood.valence and felt[1] == mood.arousal and felt[2] == mood.intensity
		if changes.size() > 0 or not same:
			changes.append(at)
			wanted.append([mood.valence, mood.arousal, mood.intensity])
	var found = []
	for t in before.targets:
		found.append(t.start)
	var begun = Util.left_of(found, cut)
	var targets = Util.part(before.targets, 0, begun)
	for target in Wanted.targets_between(track, cut, drawn):
		if targets.size() == 0 or not target.like(targets[-1]):
			targets.append(target)
	return LifeDraw.new(
		life,
		track,
		voices,
		seed_,
		cut,
		drawn,
		1.0 - life.stillness,
		modes.plus(times, rows),
		moods.plus(changes, wanted),
		Util.list(targets)
	)
