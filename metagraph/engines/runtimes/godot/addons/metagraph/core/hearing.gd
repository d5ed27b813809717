# The effect of requests on a running plan: what they take back, what lasts from then on, and which layers have to be planned
# again.
#
# Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.

const Words = preload("words.gd")
const Items = preload("items.gd")
const Spots = preload("spots.gd")
const Track = preload("track.gd")
const Utterances = preload("utterances.gd")
const MetaPlan = preload("meta_plan.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const LISTENS = 2.0  # seconds for which the gaze stays with the partner who interrupts


# track: lasting items. fresh: requests of layers, with those that continue after a pause. withdrawn: ids of earlier requests that
# no longer hold; stopped: those of them that were taken back, not replaced. touched: layers that the requests affect.
class Heard:
	var track
	var fresh
	var withdrawn
	var stopped
	var touched

	func _init(track_, fresh_, withdrawn_, stopped_, touched_):
		self.track = track_
		self.fresh = fresh_
		self.withdrawn = withdrawn_
		self.stopped = stopped_
		self.touched = touched_


# Return the ids of the asks from which a request may come: its own id, and those of which it would be a part.
static func owners(ident):
	var out = [ident]
	var left = ident
	while true:
		var dot
		var number
		var both = Util.parted_last(left, ".")
		left = both[0]
		dot = both[1]
		number = both[2]
		if dot == "" or not Util.is_digits(number):
			return out
		out.append(left)


# Return the ids with which a request is taken back: its `owners`, and the speech that a gesture belongs to: "answer" for
# "answer/2".
static func makers(ident):
	var out = owners(ident)
	var both = Util.parted_last(out[-1], "/")
	var said = both[0]
	var slash = both[1]
	var number = both[2]
	if slash != "" and Util.is_digits(number):
		out.append(said)
	return out


# Return the effect of asks. requests, track: of the plan. meant: the meaning of the asks; speeches may overlap in it. present:
# when they became known. now: everything that begins earlier stays; soon: the same for voices. turning: layers whose models
# perform differently in different modes.
static func heard(requests, track, meant, present, now, soon, turning):
	var more = meant.track()
	var gone = Util.set_of(meant.withdrawn)
	for report in meant.refused:
		Util.add_to(gone, report.request)
	for request in meant.requests:
		Util.add_to(gone, request.id)
	for ident in more.idents():
		Util.add_to(gone, ident)
	var words = add_speeches(meant, track, present, soon)
	var before = []
	for r in requests:
		before.append(r.id)
	Util.extend(before, track.idents())
	# A client that takes everything back keeps the look at the user.
	var user = {}
	for x in track.looks:
		if x.start < now and Spots.is_same_spot(x.to, Spots.named("user")):
			Util.add_to(user, x.id)
	var taken = {}
	var stopped = {}
	var withdrawn = meant.withdrawn
	for ident in before:
		var every = withdrawn.has("") and not user.has(ident)
		var holds2 = every
		if not holds2:
			var holds = withdrawn.size() > 0
			if holds:
				var is_any = false
				for o in makers(ident):
					if withdrawn.has(o):
						is_any = true
						break
				holds = is_any
			holds2 = holds
		if holds2:
			Util.add_to(stopped, ident)
		else:
			var holds3 = words.anew.size() > 0 and not words.anew.has(ident)
			if holds3:
				var is_any2 = false
				for o in makers(ident):
					if words.anew.has(o):
						is_any2 = true
						break
				holds3 = is_any2
			if holds3:
				Util.add_to(stopped, ident)  # what was made for the words before
		var holds5 = stopped.has(ident) or gone.has(ident)
		if not holds5:
			var holds4 = ident.find(".") >= 0
			if holds4:
				var is_any3 = false
				for o in owners(ident):
					if gone.has(o):
						is_any3 = true
						break
				holds4 = is_any3
			holds5 = holds4
		if holds5:
			Util.add_to(taken, ident)
	# Leave to change stances again means nothing if the models always may.
	var staying = {}
	for s in track.stays:
		if s.on:
			Util.add_to(staying, s.layer)
	for stay in more.stays:
		if stay.on:
			Util.add_to(staying, stay.layer)
	var stays = []
	for s in more.stays:
		if staying.has(s.layer):
			stays.append(s)
	var touched = {}
	for r in meant.requests:
		Util.add_to(touched, r.layer)
	for request in requests:
		if taken.has(request.id):
			Util.add_to(touched, request.layer)
	for stay in track.stays + stays:
		if gone.has(stay.id) or taken.has(stay.id):
			Util.add_to(touched, stay.layer)
	var holds6 = more.modes.size() > 0 or more.speeches.size() > 0 or meant.steered.size() > 0
	if not holds6:
		var is_any4 = false
		for m in track.modes:
			if taken.has(m.id):
				is_any4 = true
				break
		holds6 = is_any4
	if not holds6:
		var is_any5 = false
		for s in track.speeches:
			if taken.has(s.id):
				is_any5 = true
				break
		holds6 = is_any5
	var turns = holds6
	if turns:  # talking and listening characters move differently
		for layer in turning:
			Util.add_to(touched, layer)
	var holds7 = more.moods.size() > 0
	if not holds7:
		var is_any6 = false
		for m in track.moods:
			if taken.has(m.id):
				is_any6 = true
				break
		holds7 = is_any6
	if holds7:
		for layer in Words.LAYERS:
			Util.add_to(touched, layer)
	var left = track
	for ident in Utterances.find_utterances(track, "", soon):
		if stopped.has(ident):
			left = Utterances.break_off(left, ident, now)
	var over = {}
	for ident in taken:
		if not words.on.has(ident):
			Util.add_to(over, ident)
	left = words.leave(left.without(over, now))
	for ident in over:
		var open_ = left.last_speech(ident)
		if open_ != null and open_.more:  # something else takes its place
			left = Utterances.finish_speech(left, ident, soon)
	var lasting = Track.Track.new(
		more.looks,
		Util.list(words.said),
		more.modes,
		more.places,
		more.blinks,
		Util.list(stays),
		Util.list(words.moods)
	)
	var said = Heard.new(left.joined(lasting), meant.requests, taken, stopped, touched)
	return _steer(requests, said, meant, now, soon)


# New speeches, combined with those that are being said. said: all that are new or changed. begun: ids of changed earlier ones
# among them; on: ids of those that continue. `anew`: ids under which something else was said before. moods: the moods requested
# with them.
class AddedSpeeches:
	var said
	var begun
	var on
	var anew
	var moods

	func _init(said_, begun_, on_, anew_, moods_):
		self.said = said_
		self.begun = begun_
		self.on = on_
		self.anew = anew_
		self.moods = moods_

	# Return the part of a track that stays: moods of speeches that continue last as long as these, unless another mood is
	# requested.
	func leave(track):
		if self.on.size() == 0 and self.begun.size() == 0:
			return track
		var other = {}
		for m2 in self.moods:
			Util.add_to(other, m2.id)
		var ends = {}
		for speech in self.said:
			if self.on.has(speech.id):
				ends[speech.id] = Utterances.PAUSED if speech.more else speech.end
		var speeches = []
		for s in track.speeches:
			if not self.begun.has(s.id):
				speeches.append(s)
		var moods = []
		for m in track.moods:
			if not ends.has(m.id) or other.has(m.id):
				moods.append(m)
			else:
				moods.append(Mood.MoodFrom.new(m.id, m.start, m.valence, m.arousal, m.intensity, ends[m.id]))
		return Track.Track.new(
			track.looks,
			Util.list(speeches),
			track.modes,
			track.places,
			track.blinks,
			track.stays,
			Util.list(moods)
		)


# Return the effect of asks to say something on a track: a new line, a line after another, or more of one. present: what ended by
# then is over, and its end was reported; more of it begins a new utterance.
static func add_speeches(meant, track, present, soon):
	var said = []
	var begun = {}
	var on = {}
	var anew = {}
	var later = {}  # by how much those begin that are said behind others of their id
	for told in meant.speeches:
		var taken = meant.withdrawn.has(told.id) or meant.withdrawn.has("")
		var before = null if taken else track.last_speech(told.id)
		var first = before
		for s in Util.backwards(said):
			if s.id == told.id:
				first = s
				break
		var last = first
		var asked = told
		var now = soon
		if last != null and Utterances.is_paused(last.start) and told.start <= soon and told.line == null:
			now = last.start  # it is said when that is
			asked = Items.Speech.new(
				told.id,
				now,
				told.end + now - told.start,
				told.line,
				told.text,
				told.priority,
				told.length,
				told.timing,
				told.skip,
				told.more,
				told.over,
				told.asked
			)
		var paces = told.more or (last != null and last.more)
		if paces and asked.timing == null and asked.line == null:
			asked = Items.pace_speech(meant.alphabet, asked)
		var one = Items.going_on(last, asked, now)
		var continues = false
		if one != asked and last != null and one.start == last.start:
			continues = true
			var found = []
			for s in said:
				if s.id != one.id or s.start < one.start:
					found.append(s)
			said = found
			if last == before:
				Util.add_to(begun, one.id)
				var found2 = []
				for s in track.speeches:
					if s.id == one.id and s != last:
						found2.append(s)
				Util.extend(said, found2)
		elif one == asked and last != null:
			var same = []
			for s in track.speeches + said:
				if s.id == last.id and s.asked == last.asked:
					same.append(s)
			one = Items.behind(same, asked, now)
			continues = one != asked or (Utterances.takes_more(last) and told.line == null and one.start <= now)
		var over = last != null and last.end <= present and not Utterances.takes_more(last)
		var since = find_asked(track, last, continues and not over, one.id, soon)
		if not continues:  # it replaces what was asked for at the same time
			var found3 = []
			for s in said:
				if s.id != one.id:
					found3.append(s)
			said = found3
			begun = _without(begun, one.id)
			on = _without(on, one.id)
		if before != null and since == before.asked:
			Util.add_to(on, one.id)
		if one.start != told.start:
			later[one.id] = one.start - told.start
		if not continues and not on.has(one.id) and track.last_speech(one.id) != null:
			Util.add_to(anew, one.id)
		said.append(Items.Speech.new(
			one.id,
			one.start,
			one.end,
			one.line,
			one.text,
			one.priority,
			one.length,
			one.timing,
			one.skip,
			one.more,
			one.over,
			since
		))
	var opened = {}
	for s in said:
		if s.more:
			Util.add_to(opened, s.id)
	var moods = []
	for m in meant.moods:
		var by = later[m.id] if (later.has(m.id) and not begun.has(m.id)) else 0.0
		var end = Utterances.PAUSED if opened.has(m.id) else m.end + by
		moods.append(Mood.MoodFrom.new(m.id, m.start + by, m.valence, m.arousal, m.intensity, end))
	return AddedSpeeches.new(said, begun, on, anew, moods)


static func _without(idents, ident):
	var left = {}
	for other in idents:
		if other != ident:
			Util.add_to(left, other)
	return left


# Return when the utterance of a new piece was asked for. last: the piece before it, None if that is taken back; continues:
# whether the new one goes on from it.
static func find_asked(track, last, continues, ident, soon):
	if last != null and continues:
		return last.asked
	var known = track.last_speech(ident) if last == null else last
	return soon if known == null else Util.most(soon, known.asked + Utterances.TOGETHER)


# Return the effect of asks that interrupt, pause, resume or finish speech, in order. requests: of the plan before.
static func _steer(requests, told, meant, now, soon):
	if meant.steered.size() == 0:
		return told
	var steered = SteeredSpeech.new(told.track, Util.set_of(told.withdrawn), Util.set_of(told.stopped), Util.set_of(told.touched))
	var found = []
	for r in requests:
		if not told.withdrawn.has(r.id):
			found.append(r)
	steered.requests = found
	for request in told.fresh:
		steered.requests.append(request)
		Util.add_to(steered.anew, request.id)
	for ask in meant.steered:
		var ids = Utterances.find_utterances(steered.track, ask.what, soon)
		if ask.do == "interrupt":
			if ids.size() > 0:
				var look = Items.LookAt.new(ask.id, now, now + LISTENS, Spots.named("user"), 1.0, true, ask.priority)
				steered.track = steered.track.joined(Track.Track.new([look]))
			if ask.what != "" and not ids.has(ask.what):  # it may have been said, and its gestures go on
				ids.append(ask.what)
		for ident in ids:
			var made = {}
			for x in steered.idents():
				if x.begins_with(ident) and makers(x).has(ident):
					Util.add_to(made, x)
			if ask.do == "interrupt":
				var stop = Utterances.find_stop(meant.alphabet, steered.track, ident, soon, now)
				steered.interrupt(ident, made, Util.least(stop, now), now, soon)
			elif ask.do == "pause":
				steered.pause(ident, made, Utterances.find_stop(meant.alphabet, steered.track, ident, soon, now), now)
			elif ask.do == "resume":
				steered.resume(ident, made, now, soon)
			else:
				steered.track = Utterances.finish_speech(steered.track, ident, soon)
	var fresh = []
	for r in steered.requests:
		if steered.anew.has(r.id):
			fresh.append(r)
	return Heard.new(steered.track, fresh, steered.withdrawn, steered.stopped, steered.touched)


# A track and requests while asks steer speech. `anew`: ids of the requests that are made again; the other fields are as in
# `Heard`.
class SteeredSpeech:
	var track
	var withdrawn
	var stopped
	var touched
	var requests
	var anew

	func _init(track_, withdrawn_, stopped_, touched_, requests_ = null, anew_ = null):
		self.track = track_
		self.withdrawn = withdrawn_
		self.stopped = stopped_
		self.touched = touched_
		self.requests = requests_ if requests_ != null else []
		self.anew = anew_ if anew_ != null else {}

	# Return the ids of everything in it.
	func idents():
		var found = []
		for r in self.requests:
			found.append(r.id)
		return found + self.track.idents()

	# Break off an utterance at `stop`, and the requests that belong to it at `now`.
	func interrupt(ident, made, stop, now, soon):
		if Utterances.goes_on(self.track.speeches, ident, soon):
			self.track = Utterances.break_off(self.track, ident, stop)
		var is_any = false
		for m in self.track.moods:
			if made.has(m.id):
				is_any = true
				break
		if is_any:
			for layer in Words.LAYERS:
				Util.add_to(self.touched, layer)
		self.track = self.track.without(made, now)
		for request in self.requests:
			if made.has(request.id):
				Util.add_to(self.withdrawn, request.id)
				Util.add_to(self.stopped, request.id)
				Util.add_to(self.touched, request.layer)
		var found = []
		for r in self.requests:
			if not made.has(r.id):
				found.append(r)
		self.requests = found

	# Pause an utterance, and the requests that belong to it and whose moment has not come; those that have begun go back.
	func pause(ident, made, stop, now):
		if Utterances.is_paused(stop):
			return
		var slot = Utterances.find_slot(self.track)
		self.track = Utterances.pause(self.track, ident, made, stop, slot)
		var kept = []
		for request in self.requests:
			if not made.has(request.id) or Utterances.is_paused(request.start):
				kept.append(request)
				continue
			Util.add_to(self.withdrawn, request.id)
			Util.add_to(self.touched, request.layer)
			if request.start < now:
				Util.add_to(self.stopped, request.id)
			var wanted = request.start if request.stroke == null else request.stroke
			if wanted >= stop:
				kept.append(self.move_request(request, slot - stop, 0.0))
				Util.add_to(self.anew, request.id)
		self.requests = kept

	# Resume a paused utterance, and the requests that wait for it.
	func resume(ident, made, now, soon):
		var first = null
		for s in self.track.speeches:
			if s.id == ident and Utterances.is_paused(s.start):
				first = s
				break
		var held = first
		if held == null:
			return
		self.track = Utterances.resume(self.track, ident, made, soon)
		var kept = []
		for request in self.requests:
			if made.has(request.id) and Utterances.is_paused(request.start):
				Util.add_to(self.withdrawn, request.id)
				Util.add_to(self.touched, request.layer)
				Util.add_to(self.anew, request.id)
				kept.append(self.move_request(request, soon - held.start, now))
			else:
				kept.append(request)
		self.requests = kept

	# Return a request moved by a number of seconds, but not to before `least`.
	func move_request(request, by, least):
		var stroke = null if request.stroke == null else request.stroke + by
		return MetaPlan.MetaRequest.new(
			request.id,
			request.layer,
			request.kind,
			Util.most(least, request.start + by),
			request.duration,
			request.action,
			request.tags,
			request.limb,
			request.stance,
			request.priority,
			request.resume,
			stroke,
			request.hold,
			request.prepare,
			request.among,
			request.late,
			request.valence,
			request.arousal,
			request.intensity
		)
