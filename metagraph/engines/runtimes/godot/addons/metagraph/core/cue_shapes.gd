# How an action would play for a request: when it begins, how long it lasts and how late it is.
#
# A gesture waits for its stroke or cuts its preparation to catch up with it; its hold is stretched, and its retraction may be cut
# (Borer et al., section 6.2).
#
# Translated from metagraph/playback/planning/cue_shapes.py; change that, and translate anew.

const Repeating = preload("repeating.gd")
const MetaPlan = preload("meta_plan.gd")
const Mood = preload("mood.gd")
const Phases = preload("phases.gd")
const Util = preload("util.gd")
const FITS = 1e-06  # seconds by which sums of times may be off
const HURRY = 2.0  # a hold is played at most this many times as fast as it was made
const STOPPED = 0.3  # seconds in which an action that is taken back goes back to its stance, from where it is
const RETRACTION = 0.4  # seconds in which an action whose retraction is cut goes back to its stance, at the least
const SHARED = 0.25  # seconds within which two strokes may be one


# How an action would play: from `start` on, for `length` seconds, at least `shortest`; the other fields are those of a cue.
class CueShape:
	var start
	var entry
	var length
	var shortest
	var hold_from
	var hold_to
	var hold
	var tempo

	func _init(start_, entry_, length_, shortest_, hold_from_ = 0.0, hold_to_ = 0.0, hold_ = 0.0, tempo_ = 1.0):
		self.start = start_
		self.entry = entry_
		self.length = length_
		self.shortest = shortest_
		self.hold_from = hold_from_
		self.hold_to = hold_to_
		self.hold = hold_
		self.tempo = tempo_


# Return how an action would play for a request from `now` on, or as a step on the way to it. speed: a factor of the action's own
# speed.
static func shape_of(project, action, request, now, speed):
	var both = project.span(action)
	var start = both[0]
	var end = both[1]
	var begin = now
	var entry = start
	var hold_from = 0.0
	var hold_to = 0.0
	var hold = 0.0
	var cycle = Repeating.cycle_of(action.kind, action.timing, start, end)
	if (request != null and action.kind == "gesture" and (request.hold != null or request.stroke != null or not request.prepare)):
		var found = Phases.find_phases(project, action)
		var latest = found.skip(action.timing.blend_in)
		entry = start if request.prepare else latest
		# Wait for the stroke, or catch up with it by cutting the preparation.
		if request.stroke != null:
			begin = Util.most(now, request.stroke - (found.stroke - entry) / speed)
			var missed = found.stroke - Util.most(0.0, request.stroke - begin) * speed
			entry = Util.least(Util.most(entry, missed), Util.most(entry, latest))
		if request.hold != null and cycle <= 0:
			hold_from = found.stroke_end
			hold_to = found.relax
			hold = Util.most(request.hold, (hold_to - hold_from) / HURRY)
			if hold <= 0:
				hold_from = 0.0
				hold_to = 0.0
	var natural = hold_to - hold_from
	var length = end - entry + hold - natural + Mood.drag(end - entry - natural, speed)
	var shortest = length
	var exit_at = action.timing.earliest_exit
	if cycle > 0:
		var wanted = Util.least(action.timing.repeat, Repeating.LONGEST_REPEAT)
		if request != null and request.hold != null:
			wanted = request.hold  # what repeats goes on for as long as another gesture would be held
		if request != null and request.duration != null:
			wanted = request.duration
		length += (Repeating.times_played(cycle, wanted * speed) - 1.0) * cycle / speed
		exit_at = end if exit_at == null else exit_at
	if exit_at != null:
		var left = exit_at - entry + (hold - natural if exit_at >= hold_to else 0.0)
		left += Mood.drag(exit_at - entry - (natural if exit_at >= hold_to else 0.0), speed)
		shortest = Util.least(length, Util.most(0.0, left) + action.timing.blend_out)
	return CueShape.new(begin, entry, length, shortest, hold_from, hold_to, hold, speed)


# Return whether something with this shape is over by a limit.
static func fits_before(shape, limit):
	return shape.start + shape.shortest <= limit + FITS


# Return by how many seconds an action with this shape comes late, measured at its stroke if the request has one; below 0 if it
# comes early.
static func lateness(project, action, request, shape):
	if request.stroke != null and action.kind == "gesture":
		var found = Phases.find_phases(project, action)
		var until = found.stroke - shape.entry
		return shape.start + found.stroke - shape.entry + Mood.drag(until, shape.tempo) - request.stroke
	return shape.start - request.start


# Return by how many seconds a request may come late, 0 if it does not say.
static func slack_of(request):
	return 0.0 if request.late == null else request.late


# Return how many seconds a gesture takes if its retraction is cut and its hold is left out, unless the request has a hold.
static func hurried(project, action, shape):
	var both = project.span(action)
	var start = both[0]
	var end = both[1]
	var repeats = Repeating.cycle_of(action.kind, action.timing, start, end) > 0
	if action.kind != "gesture" or action.timing.earliest_exit != null or repeats:
		return shape.shortest
	var found = Phases.find_phases(project, action)
	var left = found.relax - shape.entry + shape.hold - (shape.hold_to - shape.hold_from)
	var moving = found.relax - shape.entry - (shape.hold_to - shape.hold_from)
	if shape.hold <= 0:
		left = found.stroke_end - shape.entry
		moving = left
	left += Mood.drag(moving, shape.tempo)
	return Util.least(shape.length, left + Util.most(action.timing.blend_out, RETRACTION))


# Return whether one stroke may meet two requests.
static func may_share(request, other):
	if request.stroke == null or other.stroke == null:
		return false
	return (request.action == null
		and other.action == null
		and request.kind == other.kind
		and (other.hold == null or other.hold == request.hold)
		and Util.absolute(request.stroke - other.stroke) <= SHARED)


# Return whether an action fits a request that does not name one.
static func meets(action, request):
	var are_all = true
	for tag in request.tags:
		if not action.tags.has(tag):
			are_all = false
			break
	return (are_all
		and (request.limb == null or action.limb == request.limb)
		and (request.among.size() == 0 or request.among.has(action.id)))


# Return the request of a meta action; for a remainder, with the duration that is left. What a model wrote has no duration.
static func remaining(meta, now):
	var request = meta.request
	if request.duration == null or (meta.part == 0 and not meta.written):
		return request
	return MetaPlan.MetaRequest.new(
		request.id,
		request.layer,
		request.kind,
		request.start,
		null if meta.written else Util.most(0.0, meta.end - now),
		request.action,
		request.tags,
		request.limb,
		request.stance,
		request.priority,
		request.resume,
		request.stroke,
		request.hold,
		request.prepare,
		request.among,
		request.late,
		request.valence,
		request.arousal,
		request.intensity
	)
