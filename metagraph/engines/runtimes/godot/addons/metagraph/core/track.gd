# What was asked for and lasts: where to look, what to say, which mode to be in, which stance to stay in.
#
# A track is {looks, speeches, modes, places, blinks, stays}, each by start; speeches do not overlap. Items have `list` (which of
# these), id, start, and: looks end, to (a name or [x, y, z] metres), amount, strict, priority; speeches end, line, text, priority, length
# (seconds it would have taken, where something cut it short), timing (when its words and mouth shapes come, null where that was not
# told); modes mode; places name, point; stays layer, on, end.

const LineTiming = preload("line_timing.gd")
const Util = preload("util.gd")
const LISTS = ["looks", "speeches", "modes", "places", "blinks", "stays"]


static func empty_track():
	return {looks = [], speeches = [], modes = [], places = [], blinks = [], stays = []}


# Returns all items.
static func items(track):
	var out = []
	for list in LISTS:
		out += track[list]
	return out


# Returns whether the models may not change a layer's stance at a time.
static func stays_at(track, layer, seconds):
	for n in range(track.stays.size() - 1, -1, -1):
		var stay = track.stays[n]
		if stay.layer == layer and stay.start <= seconds:
			return stay.on and seconds < stay.end
	return false


# Returns the mode asked for at a time, or talking while something is said; null where neither tells.
static func told_mode(track, seconds):
	var asked = Util.after(track.modes, "start", seconds) - 1
	if asked >= 0 and track.modes[asked].mode != null:
		return track.modes[asked].mode
	var said = Util.after(track.speeches, "start", seconds) - 1
	return "talking" if said >= 0 and seconds < track.speeches[said].end else null


# Returns the track without items of these ids {id: true} that begin at `now` or later; what has begun ends now, if it can.
static func without(track, idents, now):
	var out = {}
	for list in LISTS:
		out[list] = []
		for item in track[list]:
			if not idents.has(item.id):
				out[list].append(item)
			elif item.start < now:
				if list == "speeches":
					item = _cut(item, now)
				elif list == "looks" or list == "stays":
					item = Util.but(item, {end = Util.least(item.end, now)})
				out[list].append(item)
	return out


# Returns the track with more items; of speeches that overlap the later or more important cuts the other short.
static func plus(track, more):
	var out = {}
	for list in LISTS:
		out[list] = track[list].duplicate()
	var spoken = false
	for item in Util.by(more, "start", "id"):
		var into = out[item.list]
		var place = into.size()
		while place > 0 and Util.less([item.start, item.id], [into[place - 1].start, into[place - 1].id]):
			place -= 1
		into.insert(place, item)
		spoken = spoken or item.list == "speeches"
	if spoken:
		out.speeches = _apart(out.speeches)
	return out


# Returns an item as it goes on where a line of the same id has begun by `now`, or begins with it: it keeps its start and what has been said of it. Only
# lines whose words or shapes were told with their times do.
static func going_on(track, item, now):
	if item.list != "speeches" or item.timing == null:
		return item
	var old = null
	for speech in track.speeches:
		if speech.id == item.id:
			old = speech
	if old == null or old.timing == null or old.length != null:
		return item
	if Util.most(old.start, item.start) > now and old.start != item.start:
		return item
	var timing = LineTiming.extended(old.timing, item.timing, Util.most(now - old.start, 0.0))
	var length = Util.most(LineTiming.timed_seconds(timing, null), item.end - item.start)
	var text = item.text
	if text == "" or text == LineTiming.told_text(item.timing):
		text = LineTiming.told_text(timing)
	return Util.but(item, {start = old.start, end = old.start + length, text = text, timing = timing})


# Returns the track without what no time from `seconds` on needs.
static func since(track, seconds):
	var out = {}
	for list in LISTS:
		out[list] = []
		var last = {}  # of each thing, the place of the item that holds at `seconds`
		for n in range(track[list].size()):
			if track[list][n].start <= seconds:
				last[_thing(track[list][n])] = n
		for n in range(track[list].size()):
			var item = track[list][n]
			var goes_on = list == "speeches" and item.end > seconds
			var holds = ["modes", "places", "stays"].has(list) and last.get(_thing(item), -1) == n
			if item.start > seconds or goes_on or holds:
				out[list].append(item)
	out.looks = _standing(track.looks, seconds) + out.looks
	return out


# Returns the looks begun by `seconds` that no later one has replaced; what is over, too: it tells since when what shows has shown.
static func _standing(looks, seconds):
	var out = []
	for look in looks:
		if look.start <= seconds:
			while out.size() > 0 and out[-1].priority <= look.priority:
				out.pop_back()
			out.append(look)
	return out


static func _thing(item):
	return item.name if item.list == "places" else (item.layer if item.list == "stays" else "")


# Returns a speech ending no later than `at`; how long it would have been is remembered.
static func _cut(speech, at):
	if speech.end <= at:
		return speech
	return Util.but(speech, {end = at, length = speech.end - speech.start if speech.length == null else speech.length})


# Returns speeches without overlaps: one that is at least as important cuts the running one, a lesser one is not said.
static func _apart(speeches):
	var out = []
	for speech in speeches:
		if out.size() > 0 and out[-1].end > speech.start:
			if speech.priority < out[-1].priority:
				continue
			if out[-1].start >= speech.start:
				out.pop_back()
			else:
				out[-1] = _cut(out[-1], speech.start)
		out.append(speech)
	return out
