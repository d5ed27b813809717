# What was asked of the life layers, as segments in time: which mode the character is in, and what it looks at.
#
# A target is {start, to: a point or a name, since: when the look at it began, amount, strict, asked: not of its own accord}.

const Util = preload("util.gd")
const Track = preload("track.gd")
const PARTNER = "user"  # whom the character talks with, and looks at when nothing else is asked for
const AHEAD = "ahead"  # nothing in particular: eyes and head as the layers have them


# Returns whether two targets are the same but for their times.
static func like(a, b):
	return Util.same(a.to, b.to) and a.amount == b.amount and a.strict == b.strict and a.asked == b.asked


# Returns the mode asked for; where none is, talking while something is said and idle otherwise.
static func mode_at(track, seconds):
	var mode = Track.told_mode(track, seconds)
	return "idle" if mode == null else mode


# Returns [start, place among MODES] of each mode from `start` to before `end`; the first begins at `start`.
static func modes_between(track, start, end):
	var edges = [start]
	for item in track.modes + track.speeches:
		edges.append(item.start)
	for speech in track.speeches:
		edges.append(speech.end)
	edges.sort()
	var out = []
	for edge in edges:
		if edge < start or edge >= end:
			continue
		var mode = Util.MODES.find(mode_at(track, edge))
		if out.size() == 0 or mode != out[-1][1]:
			out.append([edge, mode])
	return out


# Returns what is looked at from `start` to before `end`; the first begins at `start`. The latest look holds until it ends or
# another of its importance or more begins; a lesser one waits beneath.
static func targets_between(track, start, end):
	var changes = []
	for n in range(track.looks.size()):
		changes.append([track.looks[n].start, 1, n])
	for n in range(track.looks.size()):
		changes.append([track.looks[n].end, 0, n])
	for n in range(track.places.size()):
		changes.append([track.places[n].start, 2, n])
	changes.append([start, 3, 0])
	var keys = []
	for change in changes:
		keys.append([change[0], change[1]])
	changes = Util.ordered(changes, keys)
	var looks = []  # places of looks, the most important first; those beneath are older or lesser
	var places = {}
	var chosen = -1
	var since = 0.0
	var out = []
	for n in range(changes.size()):
		var at = changes[n][0]
		var which = changes[n][2]
		if at >= end:
			break
		if changes[n][1] == 1:
			var above = []
			for other in looks:
				if track.looks[other].priority > track.looks[which].priority:
					above.append(other)
			if track.looks[which].end > track.looks[which].start:
				above.append(which)
			looks = above
		elif changes[n][1] == 0:
			looks.erase(which)
		elif changes[n][1] == 2:
			places[track.places[which].name] = track.places[which].point
		var first = looks[0] if looks.size() > 0 else -1
		if chosen != first:
			chosen = first
			since = at
		if at < start or (n + 1 < changes.size() and changes[n + 1][0] == at):
			continue
		var target = _target(at, since, track.looks[chosen] if chosen >= 0 else null, places)
		if out.size() == 0 or not like(target, out[-1]):
			out.append(target)
	return out


static func _target(at, since, look, places):
	if look == null:
		return {start = at, to = places.get(PARTNER, PARTNER), since = since, amount = 1.0, strict = false, asked = false}
	var to = look.to
	if typeof(to) == TYPE_STRING and places.has(to):
		to = places[to]
	return {start = at, to = to, since = since, amount = look.amount, strict = look.strict, asked = true}
