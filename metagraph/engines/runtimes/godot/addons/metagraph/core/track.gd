# All requests that last, in order; see `items`. Times are seconds.
#
# Translated from metagraph/playback/life/track.py; change that, and translate anew.

const Items = preload("items.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const HUSHED = 1.5  # seconds after what was said is broken off in which the models begin nothing


# All lasting requests, each kind sorted by start. Speeches do not overlap.
class Track:
	var looks
	var speeches
	var modes
	var places
	var blinks
	var stays
	var moods

	func _init(looks_ = null, speeches_ = null, modes_ = null, places_ = null, blinks_ = null, stays_ = null, moods_ = null):
		self.looks = looks_ if looks_ != null else []
		self.speeches = speeches_ if speeches_ != null else []
		self.modes = modes_ if modes_ != null else []
		self.places = places_ if places_ != null else []
		self.blinks = blinks_ if blinks_ != null else []
		self.stays = stays_ if stays_ != null else []
		self.moods = moods_ if moods_ != null else []

	# Return the ids of all items.
	func idents():
		var out = []
		for x in self.looks:
			out.append(x.id)
		var found = []
		for x in self.speeches:
			found.append(x.id)
		Util.extend(out, found)
		var found2 = []
		for x in self.modes:
			found2.append(x.id)
		Util.extend(out, found2)
		var found3 = []
		for x in self.places:
			found3.append(x.id)
		Util.extend(out, found3)
		var found4 = []
		for x in self.blinks:
			found4.append(x.id)
		Util.extend(out, found4)
		var found5 = []
		for x in self.stays:
			found5.append(x.id)
		Util.extend(out, found5)
		var found6 = []
		for x in self.moods:
			found6.append(x.id)
		Util.extend(out, found6)
		return out

	# Return whether the models may not change a layer's stance at a time.
	func stays_at(layer, seconds):
		var first = null
		for s in Util.backwards(self.stays):
			if s.layer == layer and s.start <= seconds:
				first = s
				break
		var last = first
		return last != null and last.on and seconds < last.end

	# Return whether what was said was broken off shortly before a time, and nothing is said since: then the models begin nothing.
	func hushed_at(seconds):
		var found = []
		for s in self.speeches:
			found.append(s.start)
		var place = Util.right_of(found, seconds) - 1
		if place < 0 or self.speeches[place].length == null:
			return false
		var last = self.speeches[place]
		var silent = last.end if last.over == null else Util.most(last.end, last.over)
		return last.end <= seconds and seconds < silent + HUSHED

	# Return the mode requested at a time, or talking while something is said; None if neither applies.
	func told_mode(seconds):
		var found = []
		for m in self.modes:
			found.append(m.start)
		var asked = Util.right_of(found, seconds) - 1
		if asked >= 0 and self.modes[asked].mode != null:
			return self.modes[asked].mode
		var found2 = []
		for s in self.speeches:
			found2.append(s.start)
		var said = Util.right_of(found2, seconds) - 1
		return "talking" if (said >= 0 and seconds < self.speeches[said].end) else null

	# Return the track without items of these ids that begin at `now` or later; those that have begun end now, if they can.
	func without(idents, now = -INF):
		var holds = idents.size() == 0
		if not holds:
			var is_any = false
			for ident in self.idents():
				if idents.has(ident):
					is_any = true
					break
			holds = not is_any
		if holds:
			return self
		var found = []
		for x in self.looks:
			if not idents.has(x.id) or x.start < now:
				found.append(Items.LookAt.new(
					x.id,
					x.start,
					Util.least(x.end, now),
					x.to,
					x.amount,
					x.strict,
					x.priority
				) if idents.has(x.id) else x)
		var found2 = []
		for x in self.speeches:
			if not idents.has(x.id) or x.start < now:
				found2.append(Items.cut(x, now) if idents.has(x.id) else x)
		var found3 = []
		for x in self.modes:
			if not idents.has(x.id) or x.start < now:
				found3.append(x)
		var found4 = []
		for x in self.places:
			if not idents.has(x.id) or x.start < now:
				found4.append(x)
		var found5 = []
		for x in self.blinks:
			if not idents.has(x.id) or x.start < now:
				found5.append(x)
		var found6 = []
		for x in self.stays:
			if not idents.has(x.id) or x.start < now:
				found6.append(Items.StayFrom.new(x.id, x.start, x.layer, x.on, Util.least(x.end, now)) if idents.has(x.id) else x)
		var found7 = []
		for x in self.moods:
			if not idents.has(x.id) or x.start < now:
				found7.append(Mood.MoodFrom.new(
					x.id,
					x.start,
					x.valence,
					x.arousal,
					x.intensity,
					Util.least(x.end, now)
				) if idents.has(x.id) else x)
		return Track.new(found, found2, found3, found4, found5, found6, found7)

	# Return the track with the items of another one, whose speeches may overlap.
	func joined(more):
		if more.idents().size() == 0:
			return self
		var looks = Util.list(self.looks)
		for look in more.looks:
			var own = [look.start, look.id]
			var place2 = looks.size()
			while place2 > 0 and Util.less(own, [looks[place2 - 1].start, looks[place2 - 1].id]):
				place2 -= 1
			looks.insert(place2, look)
		var speeches = Util.list(self.speeches)
		for speech in more.speeches:
			var own2 = [speech.start, speech.id]
			var place3 = speeches.size()
			while place3 > 0 and Util.less(own2, [speeches[place3 - 1].start, speeches[place3 - 1].id]):
				place3 -= 1
			speeches.insert(place3, speech)
		var modes = Util.list(self.modes)
		for mode in more.modes:
			var own3 = [mode.start, mode.id]
			var place4 = modes.size()
			while place4 > 0 and Util.less(own3, [modes[place4 - 1].start, modes[place4 - 1].id]):
				place4 -= 1
			modes.insert(place4, mode)
		var places = Util.list(self.places)
		for place in more.places:
			var own4 = [place.start, place.id]
			var place5 = places.size()
			while place5 > 0 and Util.less(own4, [places[place5 - 1].start, places[place5 - 1].id]):
				place5 -= 1
			places.insert(place5, place)
		var blinks = Util.list(self.blinks)
		for blink in more.blinks:
			var own5 = [blink.start, blink.id]
			var place6 = blinks.size()
			while place6 > 0 and Util.less(own5, [blinks[place6 - 1].start, blinks[place6 - 1].id]):
				place6 -= 1
			blinks.insert(place6, blink)
		var stays = Util.list(self.stays)
		for stay in more.stays:
			var own6 = [stay.start, stay.id]
			var place7 = stays.size()
			while place7 > 0 and Util.less(own6, [stays[place7 - 1].start, stays[place7 - 1].id]):
				place7 -= 1
			stays.insert(place7, stay)
		var moods = Util.list(self.moods)
		for mood in more.moods:
			var own7 = [mood.start, mood.id]
			var place8 = moods.size()
			while place8 > 0 and Util.less(own7, [moods[place8 - 1].start, moods[place8 - 1].id]):
				place8 -= 1
			moods.insert(place8, mood)
		var said = Items.apart(speeches) if more.speeches.size() > 0 else speeches
		return Track.new(
			Util.list(looks),
			Util.list(said),
			Util.list(modes),
			Util.list(places),
			Util.list(blinks),
			Util.list(stays),
			Util.list(moods)
		)

	# Return the track without items that are not needed from `seconds` on.
	func since(seconds):
		# Those that no later one has replaced; also what is over: it tells since when what shows has shown.
		var looks = []
		for look in self.looks:
			if look.start <= seconds:
				var found = []
				for x in looks:
					if x.priority > look.priority:
						found.append(x)
				looks = found
			looks.append(look)
		var latest = {}
		for x in self.speeches:
			latest[x.id] = x
		var lasts = {}
		for ident in latest:
			var x = latest[ident]
			if x.more or x.end > seconds:
				Util.add_to(lasts, ident)
		var found2 = []
		for m in self.modes:
			found2.append(m.start)
		var mode = Util.most(0, Util.right_of(found2, seconds) - 1)
		var places = {}
		for n in range(self.places.size()):
			var x = self.places[n]
			if x.start <= seconds:
				places[x.name] = n
		var stays = {}
		for n in range(self.stays.size()):
			var x = self.stays[n]
			if x.start <= seconds:
				stays[x.layer] = n
		var found3 = []
		for x in self.speeches:
			if (x.start > seconds
				or x.end > seconds
				or (x.more and lasts.has(x.id))
				or (x.over != null and x.over > seconds - HUSHED)
				or (x.length != null and x.end > seconds - HUSHED)):
				found3.append(x)
		var found4 = []
		for n in range(self.places.size()):
			var x = self.places[n]
			if x.start > seconds or places[x.name] == n:
				found4.append(x)
		var found5 = []
		for x in self.blinks:
			if x.start > seconds:
				found5.append(x)
		var found6 = []
		for n in range(self.stays.size()):
			var x = self.stays[n]
			if x.start > seconds or stays[x.layer] == n:
				found6.append(x)
		return Track.new(
			Util.list(looks),
			found3,
			Util.part(self.modes, mode, self.modes.size()),
			found4,
			found5,
			found6,
			Util.list(Mood.lasting(self.moods, seconds))
		)

	# Return the last speech with an id.
	func last_speech(ident):
		var first = null
		for s in Util.backwards(self.speeches):
			if s.id == ident:
				first = s
				break
		return first

	# Return whether everything is the same that random draws depend on. Places and stays are not part of it.
	func draws_like(other):
		if not Items.alike_looks(self.looks, other.looks) or not Items.alike_speeches(self.speeches, other.speeches):
			return false
		if not Items.alike_felt(self.moods, other.moods):
			return false
		return Items.alike_modes(self.modes, other.modes) and Items.alike_blinks(self.blinks, other.blinks)

	# Return whether everything is the same.
	func like(other):
		if not Items.alike_places(self.places, other.places) or not Items.alike_stays(self.stays, other.stays):
			return false
		return self.draws_like(other)
