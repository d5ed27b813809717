# Requests of the life layers as segments in time: the mode of the character, and what it looks at.
#
# Translated from metagraph/playback/life/wanted.py; change that, and translate anew.

const Life = preload("life.gd")
const Words = preload("words.gd")
const Spots = preload("spots.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const PARTNER = "user"  # whom the character talks with, and looks at when nothing else is asked for
const AHEAD = "ahead"  # nothing in particular: eyes and head as the layers have them
# What changes what is looked at; of one time in this order.
const OVER = 0
const LOOK = 1
const PLACE = 2
const BEGIN = 3


# The target of the gaze from `start` on: a point, or a name whose place the project knows. since: when the look at it began; its
# place may have changed meanwhile. asked: whether a request set it.
class GazeTarget:
	var start
	var to
	var since
	var amount
	var strict
	var asked

	func _init(start_, to_, since_ = 0.0, amount_ = 1.0, strict_ = false, asked_ = false):
		self.start = start_
		self.to = to_
		self.since = since_
		self.amount = amount_
		self.strict = strict_
		self.asked = asked_

	# Return whether it is the same apart from its times.
	func like(other):
		if self.amount != other.amount or self.strict != other.strict or self.asked != other.asked:
			return false
		return Spots.is_same_spot(self.to, other.to)


# Return the requested mode; without one, talking while something is said and idle otherwise.
static func mode_at(track, seconds):
	var told = track.told_mode(seconds)
	return "idle" if told == null else told


# Return (start, place among MODES) of each mode from `start` to before `end`; the first begins at `start`.
static func modes_between(track, start, end):
	var edges = [start]
	var found = []
	for m in track.modes:
		found.append(m.start)
	Util.extend(edges, found)
	var found2 = []
	for s in track.speeches:
		found2.append(s.start)
	Util.extend(edges, found2)
	var found3 = []
	for s in track.speeches:
		found3.append(s.end)
	Util.extend(edges, found3)
	var out = []
	var last = -1
	var found4 = []
	for e in edges:
		if start <= e and e < end:
			found4.append(e)
	for edge in Util.in_order(found4):
		var mode = Words.MODES.find(mode_at(track, edge))
		if mode != last:
			out.append([edge, mode])
		last = mode
	return out


# Return the moods of a character: the one set in its life layers, and those requested over time.
static func moods_of(life, track):
	return Mood.Moods.new(Mood.Mood.new(life.valence, life.arousal, life.intensity), track.moods)


# Return (start, mood) of each mood from `start` to before `end`; the first begins at `start`.
static func moods_between(moods, start, end):
	var out = []
	for edge in Mood.mood_edges(moods, start, end):
		var mood = Mood.mood_at(moods, edge)
		if out.size() == 0 or not mood.like(out[-1][1]):
			out.append([edge, mood])
	return out


# Return the factors of the amounts for a mode and a mood.
static func ways_in(ways, mood):
	if mood.neutral:
		return ways
	var of = Mood.life_of(mood)
	return Life.scaled(ways, of.breathing, of.breath_rate, of.aversion_rate, of.saccade_rate, of.blinks)


# Return the targets of the gaze from `start` to before `end`; the first begins at `start`.
#
# The latest look holds until it ends or another of at least the same importance begins; a less important one waits.
static func targets_between(track, start, end):
	var changes = []
	for n2 in range(track.looks.size()):
		var x = track.looks[n2]
		changes.append([x.start, LOOK, n2])
	var found = []
	for n3 in range(track.looks.size()):
		var x = track.looks[n3]
		found.append([x.end, OVER, n3])
	Util.extend(changes, found)
	var found2 = []
	for n4 in range(track.places.size()):
		var p = track.places[n4]
		if p.start >= start:
			found2.append([p.start, PLACE, n4])
	Util.extend(changes, found2)
	changes.append([start, BEGIN, 0])
	var keys = []
	for c in changes:
		keys.append([c[0], c[1]])
	changes = Util.ordered(changes, keys)
	var looks = []  # indices of looks, the most important first; the others are older or less important
	var places = {}
	for place in track.places:  # a point that is sent again and again has thousands
		if place.start < start:
			places[place.name] = place.point
	var chosen = -1
	var since = 0.0
	var out = []
	for n in range(changes.size()):
		var both = changes[n]
		var at = both[0]
		var kind = both[1]
		var which = both[2]
		if at >= end:
			break
		if kind == LOOK:
			var look = track.looks[which]
			var found3 = []
			for x in looks:
				if track.looks[x].priority > look.priority:
					found3.append(x)
			looks = found3
			if look.end > look.start:
				looks.append(which)
		elif kind == OVER:
			var found4 = []
			for x in looks:
				if x != which:
					found4.append(x)
			looks = found4
		elif kind == PLACE:
			places[track.places[which].name] = track.places[which].point
		var first = looks[0] if looks.size() > 0 else -1
		if chosen != first:
			chosen = first
			since = at
		if at < start or (n + 1 < changes.size() and changes[n + 1][0] == at):
			continue
		var target = _target(at, since, null if chosen < 0 else track.looks[chosen], places)
		if out.size() == 0 or not target.like(out[-1]):
			out.append(target)
	return out


static func _target(at, since, look, places):
	if look == null:
		return GazeTarget.new(at, Spots.placed(places, Spots.named(PARTNER)), since)
	return GazeTarget.new(at, Spots.placed(places, look.to), since, look.amount, look.strict, true)
