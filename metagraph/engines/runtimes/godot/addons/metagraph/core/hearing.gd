# What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned again.
#
# Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.

const Words = preload("words.gd")
const Items = preload("items.gd")
const Track = preload("track.gd")
const Util = preload("util.gd")


# track: what lasts. withdrawn: ids of what was asked for before and is not any more. touched: layers that asks have to do with.
class Heard:
	var track
	var withdrawn
	var touched

	func _init(track_, withdrawn_, touched_):
		self.track = track_
		self.withdrawn = withdrawn_
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
	var before = []
	for r in requests:
		before.append(r.id)
	Util.extend(before, track.idents())
	var taken = {}
	for ident in before:
		var holds2 = withdrawn.has("") or gone.has(ident)
		if not holds2:
			var holds = ident.find(".") >= 0
			if holds:
				var is_any = false
				for o in owners(ident):
					if gone.has(o):
						is_any = true
						break
				holds = is_any
			holds2 = holds
		if holds2:
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
	var holds3 = more.modes.size() > 0 or more.speeches.size() > 0
	if not holds3:
		var is_any2 = false
		for m in track.modes:
			if taken.has(m.id):
				is_any2 = true
				break
		holds3 = is_any2
	if not holds3:
		var is_any3 = false
		for s in track.speeches:
			if taken.has(s.id):
				is_any3 = true
				break
		holds3 = is_any3
	var turns = holds3
	if turns:  # who talks moves otherwise than who listens
		for layer in turning:
			Util.add_to(touched, layer)
	var holds4 = more.moods.size() > 0
	if not holds4:
		var is_any4 = false
		for m in track.moods:
			if taken.has(m.id):
				is_any4 = true
				break
		holds4 = is_any4
	if holds4:
		for layer in Words.LAYERS:
			Util.add_to(touched, layer)
	var said = []
	for s in more.speeches:
		said.append(Items.going_on(track.last_speech(s.id), s, now))
	var begun = {}  # of which more is said
	for n in range(said.size()):
		var new = said[n]
		var asked = more.speeches[n]
		if new != asked:
			Util.add_to(begun, new.id)
	var over = {}
	for ident in taken:
		if not begun.has(ident):
			Util.add_to(over, ident)
	var left = track.without(over, now).without(begun)
	var lasting = Track.Track.new(more.looks, Util.list(said), more.modes, more.places, more.blinks, Util.list(stays), more.moods)
	return Heard.new(left.joined(lasting), taken, touched)
