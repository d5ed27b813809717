# Single rules, asked with numbers and texts alone: what vectors ask beside plans and poses, so that each rule of geometry, of the
# mouth, of moods and of times meets both sides of its boundaries.
#
# Translated from metagraph/engines/single_rules.py; change that, and translate anew.

const Words = preload("words.gd")
const ContactSolve = preload("contact_solve.gd")
const ContactSpans = preload("contact_spans.gd")
const FeetSolve = preload("feet_solve.gd")
const PlainVectors = preload("plain_vectors.gd")
const WeightSolve = preload("weight_solve.gd")
const Graphemes = preload("graphemes.gd")
const LineTiming = preload("line_timing.gd")
const Mouth = preload("mouth.gd")
const Choice = preload("choice.gd")
const Director = preload("director.gd")
const Mood = preload("mood.gd")
const CueTimes = preload("cue_times.gd")
const FollowThrough = preload("follow_through.gd")
const PlantedFeet = preload("planted_feet.gd")
const Util = preload("util.gd")
const OPEN = 1000000000.0  # in the place of an end that is not known


# What a rule is asked with: numbers and texts, which are taken one after the other.
class RuleInput:
	var numbers
	var texts
	var at
	var told

	func _init(numbers_, texts_, at_ = 0, told_ = 0):
		self.numbers = numbers_
		self.texts = texts_
		self.at = at_
		self.told = told_

	# Take the next number.
	func number():
		self.at += 1
		return self.numbers[self.at - 1]

	# Take the next text.
	func text():
		self.told += 1
		return self.texts[self.told - 1]


# Return what a rule makes of numbers and texts; nothing for a rule that is not known.
static func answer_rule(alphabet, seed_, rule, numbers, texts):
	var given = RuleInput.new(numbers, texts)
	if ["between", "apart", "unit", "contacts", "bring", "weight", "feet"].has(rule):
		return _geometry(rule, given)
	if ["way", "steps", "track", "driven", "span", "key"].has(rule):
		return _places(rule, given)
	if ["mouth", "soften", "accents", "spelled", "letters"].has(rule):
		return _mouth(alphabet, rule, given)
	if ["timing", "piece"].has(rule):
		return _timing(alphabet, rule, given)
	if ["mood", "moods", "shown", "lasting"].has(rule):
		return _mood(seed_, rule, given)
	return _times(seed_, rule, given)


static func _vector(given):
	var x = given.number()
	var y = given.number()
	var z = given.number()
	return [x, y, z]


static func _turn(given):
	var x = given.number()
	var y = given.number()
	var z = given.number()
	var w = given.number()
	return PlainVectors.unit_turn([x, y, z, w])


static func _count(given):
	return int(floor(given.number() + 0.5))


static func _put(out, v):
	var both = v
	var x = both[0]
	var y = both[1]
	var z = both[2]
	Util.extend(out, [x, y, z])


static func _put_turn(out, q):
	var both = q
	var x = both[0]
	var y = both[1]
	var z = both[2]
	var w = both[3]
	Util.extend(out, [x, y, z, w])


# --- limbs
# Read a rig and a pose of it.
static func _rig(given, pose):
	var parents = []
	var joints = []
	var size = _count(given)
	for n in range(size):
		joints.append(n)
		parents.append(_count(given))
		pose.moved.append(_vector(given))
		pose.local.append(_turn(given))
	var limbs = []
	for _side in range(2):
		var upper = _count(given)
		var lower = _count(given)
		var hand = _count(given)
		var below = []
		size = _count(given)
		for _n in range(size):
			below.append(_count(given))
		limbs.append(ContactSolve.ContactArm.new(upper, lower, hand, Util.list(below)))
	var capsules = []
	size = _count(given)
	for _n in range(size):
		var joint = _count(given)
		var a = _vector(given)
		var to = _count(given)
		var b = _vector(given)
		var radius = given.number()
		var arm = _count(given)
		capsules.append(ContactSolve.BodyCapsule.new(joint, a, to, b, radius, arm, _count(given)))
	var guard = given.number() > 0.0
	var places = {}
	return ContactSolve.ContactRig.new(
		Util.list(joints),
		Util.list(parents),
		places,
		Util.list(limbs),
		["left", "right"],
		Util.list(capsules),
		true,
		guard
	)


static func _weight_rig(given, body):
	var bends = []
	var size = _count(given)
	var place
	for _n in range(size):
		place = _count(given)
		var left = _vector(given)
		var up = _vector(given)
		var ahead = _vector(given)
		bends.append(WeightSolve.WeightBend.new(place, left, up, ahead, given.number()))
	var collars = []
	size = _count(given)
	for _n in range(size):
		place = _count(given)
		var upper = _count(given)
		var axis = _vector(given)
		collars.append(WeightSolve.WeightCollar.new(place, upper, axis, _count(given)))
	var knees = []
	var levers = []
	for _side in range(2):
		knees.append(_vector(given))
		var aside = given.number()
		levers.append([aside, given.number()])
	var height = given.number()
	return WeightSolve.WeightRig.new(
		body,
		Util.list(bends),
		Util.list(collars),
		Util.list(knees),
		Util.list(levers),
		[0.0, 1.0, 0.0],
		height,
		given.number()
	)


static func _posed(pose):
	var out = []
	for place in range(pose.local.size()):
		_put_turn(out, pose.local[place])
		_put(out, pose.at[place])
	return out


static func _geometry(rule, given):
	var out = []
	if rule == "between":
		var a = PlainVectors.unit(_vector(given))
		_put_turn(out, PlainVectors.between(a, PlainVectors.unit(_vector(given))))
	elif rule == "unit":
		_put(out, PlainVectors.unit(_vector(given)))
		_put_turn(out, _turn(given))
	elif rule == "apart":
		var ends = []
		for _n in range(4):
			ends.append(_vector(given))
		_put_turn(out, ContactSolve.apart(ends, 0, 2))
	else:
		var pose = ContactSolve.ContactPose.new()
		var rig = _rig(given, pose)
		ContactSolve.spread(rig, pose)
		var moved = false
		if rule == "bring":
			var side = _count(given)
			var goal = _vector(given)
			var turn = _turn(given)
			ContactSolve.bring(rig, pose, side, goal, turn, _vector(given))
		elif rule == "contacts":
			var goals = []
			var size = _count(given)
			for _n in range(size):
				var arm = _count(given)
				var to = _count(given)
				var at = _vector(given)
				var turn = _turn(given)
				goals.append(ContactSolve.HandGoal.new(arm, to, at, turn, given.number()))
			moved = ContactSolve.solve_contacts(rig, pose, goals)
			for end in ContactSolve.capsule_ends(rig, pose):
				_put(out, end)
		else:
			var body = _weight_rig(given, rig)
			out.append(WeightSolve.stands_by(body, pose))
			if rule == "weight":
				var drive = []
				for _n in range(16):
					drive.append(given.number())
				var follow = given.number()
				moved = WeightSolve.answer_arms(body, pose, drive, follow, given.number())
			else:
				for side in range(2):
					var foot = _vector(given)
					var reach = given.number()
					out.append(WeightSolve.hips_sink(body, pose, side, foot, reach, given.number()))
				var feet = []
				var size = _count(given)
				for _n in range(size):
					feet.append(_foot(given))
				moved = FeetSolve.plant_feet(body, pose, feet, given.number())
		out.append(1.0 if moved else 0.0)
		ContactSolve.spread(rig, pose)
		Util.extend(out, _posed(pose))
	return out


# --- where hands and feet are
static func _foot(given):
	var at = _vector(given)
	var turn = _turn(given)
	var planted = given.number()
	return FeetSolve.FootGoal.new(at, turn, planted, given.number())


static func _feet(given):
	var out = []
	var size = _count(given)
	for _n in range(size):
		out.append(_foot(given))
	return out


static func _put_feet(out, feet):
	for foot in feet:
		_put(out, foot.at)
		_put_turn(out, foot.turn)
		Util.extend(out, [foot.planted, foot.lift])


static func _rows(given, count, width):
	var out = []
	for _n in range(count):
		var row = []
		for _k in range(width):
			row.append(given.number())
		out.append(row)
	return out


static func _span(given):
	var start = given.number()
	var end = given.number()
	var ease_in = given.number()
	var ease_out = given.number()
	var keys = []
	var size = _count(given)
	for _n in range(size):
		var time = given.number()
		var at = _vector(given)
		keys.append(ContactSpans.ContactKey.new(time, at, _turn(given)))
	return ContactSpans.ContactSpan.new("left", "palm", "Chest", start, end, Util.list(keys), ease_in, ease_out)


static func _places(rule, given):
	var out = []
	if rule == "way":
		var one = _foot(given)
		out.append(FeetSolve.foot_way(one, _foot(given)))
	elif rule == "steps":
		var height = given.number()
		var before = _feet(given)
		var after = _feet(given)
		var first = _feet(given)
		var last = _feet(given)
		var passed = given.number()
		_put_feet(out, PlantedFeet.stepped(height, before, after, first, last, passed, given.number()))
	elif rule == "track":
		var rows = _rows(given, _count(given), 16)
		_put_feet(out, PlantedFeet.foot_row(PlantedFeet.FootTrack.new(rows), given.number()))
	elif rule == "driven":
		var sways = _rows(given, 4, 8)
		Util.extend(out, FollowThrough.driven(sways, given.number()))
	elif rule == "span":
		var span = _span(given)
		var first_ = given.number()
		var last_ = given.number()
		var size = _count(given)
		for _n in range(size):
			out.append(ContactSpans.contact_weight(span, given.number(), first_, last_))
	else:
		var span = _span(given)
		var size = _count(given)
		for _n in range(size):
			var key = ContactSpans.contact_key(span, given.number())
			out.append(key.time)
			_put(out, key.at)
			_put_turn(out, key.turn)
	return out


# --- the mouth
static func _put_spelled(out, found):
	for piece in found.pieces:
		Util.extend(out, [piece.start, piece.end, float(Words.VISEMES.find(piece.viseme)), piece.strength])
	Util.extend(out, found.peaks)
	Util.extend(out, found.strengths)


static func _mouth(alphabet, rule, given):
	var out = []
	if rule == "mouth":
		var pieces = []
		var size = _count(given)
		for _n in range(size):
			var start = given.number()
			var end = given.number()
			var strength = given.number()
			pieces.append(Mouth.MouthPiece.new(start, end, given.text(), strength))
		for row in Mouth.mouth_track(pieces, given.number()):
			Util.extend(out, row)
	elif rule == "soften":
		var rows = _rows(given, 3, 14)
		Util.extend(out, rows[1])
		Mouth.soften(out, rows[0], rows[1], rows[2])
	elif rule == "accents":
		var count = _count(given)
		var rows = _rows(given, 2, count)
		Util.extend(out, Mouth.accents_of(rows[0], rows[1]))
	elif rule == "letters":
		var size = _count(given)
		for _n in range(size):
			out.append(Graphemes.measure_letter(_count(given)))
	else:
		var text = given.text()
		out.append(Graphemes.read_aloud(alphabet, text))
		_put_spelled(out, Graphemes.spelled(alphabet, text, given.number()))
	return out


# --- the times of lines
static func _line(given):
	var words = []
	var size = _count(given)
	for _n in range(size):
		var start = given.number()
		var end = given.number()
		words.append(LineTiming.SpokenWord.new(given.text(), start, null if end >= OPEN else end))
	var marks = []
	size = _count(given)
	for _n in range(size):
		var at = given.number()
		var weight = given.number()
		marks.append(LineTiming.VisemeMark.new(at, given.text(), weight))
	return LineTiming.LineTiming.new(Util.list(words), Util.list(marks), given.number())


static func _put_line(alphabet, out, line):
	for word in line.words:
		Util.extend(out, [word.start, OPEN if word.end == null else word.end, float(alphabet.letters(word.text).size())])
	for mark in line.marks:
		Util.extend(out, [mark.at, float(mark.viseme.length()), mark.weight])
	out.append(line.later)


static func _yes(which):
	return 1.0 if which else 0.0


static func _timing(alphabet, rule, given):
	var out = []
	if rule == "timing":
		var name = given.text()
		var duration = given.number()
		var raw = _line(given)
		var wrong = LineTiming.wrong_in(raw.words, raw.marks, name, null if duration >= OPEN else duration)
		Util.extend(out, [float(wrong.length()), float(LineTiming.set_of(raw.marks).length())])
		_put_line(alphabet, out, LineTiming.LineTiming.new(Util.list(LineTiming.join_letters(alphabet, raw.words))))
		var paced = LineTiming.pace_text(alphabet, given.text(), null if duration >= OPEN else duration)
		_put_line(alphabet, out, paced)
		if wrong != "":
			return out
		var line = LineTiming.timing_of(alphabet, raw.words, raw.marks, name)
		_put_line(alphabet, out, line)
		_put_line(alphabet, out, LineTiming.shifted(line, 0.5))
		out.append(LineTiming.timed_seconds(line, null if duration >= OPEN else duration))
		_put_spelled(out, LineTiming.timed_sounds(alphabet, line))
	else:
		var old = _line(given)
		var new = _line(given)
		var said = given.number()
		out.append(_yes(LineTiming.alike_timings(old, new)))
		out.append(_yes(LineTiming.alike_timings(old, null)))
		out.append(_yes(LineTiming.alike_timings(null, null)))
		out.append(_yes(LineTiming.tells_on(old, new)))
		out.append(_yes(LineTiming.restarts(old, new, said)))
		var first = given.number()
		var last = given.number()
		out.append(_yes(LineTiming.comes_late(first, last, given.number(), said)))
		_put_line(alphabet, out, LineTiming.place_told(old, new, said))
		_put_line(alphabet, out, LineTiming.extended(old, new, said))
	return out


# --- moods
static func _mood_of(given):
	var valence = given.number()
	var arousal = given.number()
	return Mood.Mood.new(valence, arousal, given.number())


# Read moods; numbers above 8 stand for what is not told.
static func _told(given):
	var out = []
	var size = _count(given)
	for _n in range(size):
		var start = given.number()
		var valence = given.number()
		var arousal = given.number()
		var intensity = given.number()
		var end = given.number()
		out.append(Mood.MoodFrom.new(
			"told",
			start,
			null if valence > 8 else valence,
			null if arousal > 8 else arousal,
			null if intensity > 8 else intensity,
			INF if end >= OPEN else end
		))
	return out


static func _put_mood(out, mood):
	Util.extend(out, [mood.valence, mood.arousal, mood.intensity])


static func _mood(seed_, rule, given):
	var out = []
	if rule == "mood":
		var mood = _mood_of(given)
		var tags = [given.text(), given.text()]
		var life = Mood.life_of(mood)
		var how = Mood.bearing(mood)
		Util.extend(out, [Mood.liveliness(mood), Mood.fear(mood), Mood.anger(mood), Mood.extent(mood), Mood.tempo(mood)])
		Util.extend(out, [life.breathing, life.breath_rate, life.aversion_rate, life.saccade_rate, life.blinks])
		Util.extend(out, [how.droop, how.lift, how.lids, how.smile, how.frown, how.brow_down])
		Util.extend(out, [how.brow_up, how.thrust, how.tension, how.brows, how.closed])
		out.append(Mood.favour(mood, tags, given.number()))
		out.append(_yes(Mood.made_for(mood, tags)))
		out.append(Mood.distance(mood, "happy"))
		for n in range(4):
			out.append(_yes(Mood.stirs(mood, seed_, "%s%d" % [tags[0], n])))
		var valence = given.number()
		var arousal = given.number()
		_put_mood(out, Mood.changed(mood, valence, arousal, given.number()))
	elif rule == "moods":
		var base = _mood_of(given)
		var moods = Mood.Moods.new(base, _told(given))
		var start = given.number()
		var edges = Mood.mood_edges(moods, start, given.number())
		Util.extend(out, edges)
		for edge in edges:
			_put_mood(out, Mood.mood_at(moods, edge))
	elif rule == "shown":
		var count = _count(given)
		var starts = _rows(given, 1, count)
		var values = _rows(given, count, 3)
		_put_mood(out, Mood.shown(starts[0], values, given.number()))
	else:
		var told = _told(given)
		for one in Mood.lasting(told, given.number()):
			Util.extend(out, [one.start, OPEN if one.end > OPEN else one.end])
	return out


# --- times
static func _times(seed_, rule, given):
	var out = []
	if rule == "lull":
		var key = given.text()
		var talks = given.number() > 0.0
		out.append(Director.find_lull(seed_, key, talks, given.number()))
	elif rule == "intervals":
		var count = _count(given)
		var share = given.number()
		var beats = Director.beat_interval("arms", count)
		Util.extend(out, [
			beats,
			Director.beat_interval("head", count),
			Director.posture("body"),
			Director.posture("arms"),
			Director.posture("head")
		])
		Util.extend(out, [Director.repeat_interval("gesture", share, beats), Director.repeat_interval("fidget", share, beats)])
		out.append(Director.freshness(given.number(), beats))
	elif rule == "curves":
		var x = given.number()
		Util.extend(out, [Mood.faded(x), CueTimes.ease_(x), Mood.leaning(x, 4.0), Mood.turn_extent(1.25, x)])
		Util.extend(out, [Mood.shut_in(0.25, x), Mood.shut_in(0.75, x), Mood.drag(2.0, 1.0 + 0.5 * x * x)])
		out.append(Choice.log_normal(8.0, 14.0, 0.25 + 0.125 * x * x, 0.5))
	return out
