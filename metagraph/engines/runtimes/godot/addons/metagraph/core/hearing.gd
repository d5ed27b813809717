# What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned again.
#
# Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.

const Words = preload("words.gd")
const Items = preload("items.gd")
const Spots = preload("spots.gd")
const Track = preload("track.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")


# track: what lasts. withdrawn: ids of what was asked for before and is not any more; stopped: those of them that were taken back
# and not asked for anew. touched: layers that asks have to do with.
class Heard:
	var track
	var withdrawn
	var stopped
	var touched

	func _init(track_, withdrawn_, stopped_, touched_):
		self.track = track_
		self.withdrawn = withdrawn_
		self.stopped = stopped_
		self.touched = touched_


# Return the asks a request may have been made by: that of its own id, and those of which it would be a part.
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


# Return what a request goes with when it is taken back: its `owners`, and what is said that a gesture was made for: "answer" for
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


# Return what asks do. requests, track: of the plan. fresh, more: what is asked for, where speeches may overlap. withdrawn: ids
# taken back; every one where it holds "". refused: ids of what could not be understood. now: what begins before stays. turning:
# layers whose models perform one thing in one mode and another in another.
static func heard(requests, track, fresh, more, withdrawn, refused, now, turning):
	var gone = Util.set_of(withdrawn)
	for ident in refused:
		Util.add_to(gone, ident)
	for request in fresh:
		Util.add_to(gone, request.id)
	for ident in more.idents():
		Util.add_to(gone, ident)
	var said = []
	var begun = {}  # of which more is said
	var anew = {}  # of which something else was said before
	var later = {}  # by how much those begin that are said behind others of their id
	for asked in more.speeches:
		var before_it = null if withdrawn.has(asked.id) else track.last_speech(asked.id)
		var first = before_it
		for s in Util.backwards(said):
			if s.id == asked.id:
				first = s
				break
		var last = first
		var one = Items.going_on(last, asked, now)
		if one != asked and last != null and one.start == last.start:
			Util.add_to(begun, one.id)
			var found = []
			for s in said:
				if s.id != one.id:
					found.append(s)
			said = found
		elif one == asked and not withdrawn.has(asked.id):
			one = Items.behind(track.speeches + said, asked, now)
			if one != asked:
				later[one.id] = one.start - asked.start
		if one == asked and track.last_speech(one.id) != null:
			Util.add_to(anew, one.id)
		said.append(one)
	var before = []
	for r in requests:
		before.append(r.id)
	Util.extend(before, track.idents())
	# Who takes everything back still looks at whom it talks with.
	var user = {}
	for x in track.looks:
		if x.start < now and Spots.is_same_spot(x.to, Spots.named("user")):
			Util.add_to(user, x.id)
	var taken = {}
	var stopped = {}
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
			var holds3 = anew.size() > 0 and not anew.has(ident)
			if holds3:
				var is_any2 = false
				for o in makers(ident):
					if anew.has(o):
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
	# Where the models may change stances again means nothing where they always might.
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
	for r in fresh:
		Util.add_to(touched, r.layer)
	for request in requests:
		if taken.has(request.id):
			Util.add_to(touched, request.layer)
	for stay in track.stays + stays:
		if gone.has(stay.id) or taken.has(stay.id):
			Util.add_to(touched, stay.layer)
	var holds6 = more.modes.size() > 0 or more.speeches.size() > 0
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
	if turns:  # who talks moves otherwise than who listens
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
	var over = {}
	for ident in taken:
		if not begun.has(ident) and not later.has(ident):
			Util.add_to(over, ident)
	var moods = []
	for m in more.moods:
		moods.append(Mood.MoodFrom.new(
			m.id,
			m.start + later[m.id],
			m.valence,
			m.arousal,
			m.intensity,
			m.end + later[m.id]
		) if later.has(m.id) else m)
	var left = track.without(over, now).without(begun)
	var lasting = Track.Track.new(
		more.looks,
		Util.list(said),
		more.modes,
		more.places,
		more.blinks,
		Util.list(stays),
		Util.list(moods)
	)
	return Heard.new(left.joined(lasting), taken, stopped, touched)
