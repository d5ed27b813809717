# One character at play: takes requests, keeps its plan some seconds ahead of the clock, and has the pose of now. Nothing here fails while
# it plays: what cannot be done is refused, and `answer` says why.

const Util = preload("util.gd")
const Asks = preload("asks.gd")
const Describe = preload("describe.gd")
const Answers = preload("answers.gd")
const Hear = preload("hear.gd")
const Items = preload("items.gd")
const Parameters = preload("parameters.gd")
const Planner = preload("planner.gd")
const Pose = preload("pose.gd")
const SpeechWatch = preload("speech_watch.gd")
const SpokenSoFar = preload("spoken_so_far.gd")
const StreamedVoice = preload("streamed_voice.gd")
const Utterances = preload("utterances.gd")
const SLACK = 2.0  # seconds by which the horizon may fall behind before it is moved
const FORGET_EVERY = 15.0  # seconds
const LEAP = 3600.0  # seconds an update may move on: all that lies between is planned
const SOUNDS = 16  # lines whose sound is remembered
const TAKING = ["withdraw", "interrupt", "pause", "resume", "finish"]  # what is done as soon as it is taken up
const REMEMBERED = 1000  # answers kept of what is over or was never understood, and happenings nobody asked for

var graph
var plan
var now = 0.0
var alive = true  # whether the life layers play
var ahead
var recent
var idle
var stances
var _queue = []
var _asked = {}  # ids that the plan can tell of
var _settled = {}  # answers of those it has forgotten or never heard of
var _sounds = {}  # of lines that are heard, by their ids
var _count = 0
var _parameters
var _forgot_at = 0.0
var _speech = SpeechWatch.SpeechWatch.new()
var _seen = -1.0  # when the update before was
var _events = []
var _pose = null


# options: seed: 0..2^32 - 1, the project's when left out; idle: whether the models fill the time nobody asks for; stances {layer:
# stance id}; ahead: seconds planned; recent: seconds of the past kept.
func _init(read_graph, options = {}):
	graph = read_graph
	idle = options.get("idle", true)
	stances = options.get("stances", {})
	ahead = float(options.get("ahead", 20.0))
	recent = float(options.get("recent", 30.0))
	plan = Planner.empty_plan(int(options.get("seed", graph.settings.get("seed32", 1))))
	_parameters = Parameters.new(graph.parameters)
	if graph.error == "":
		plan = Hear.hear(graph, plan, 0.0, [], ahead, stances, idle)


# Returns what may be asked for, as plain data (describe.gd); nothing where the export was not read.
func describe():
	return {} if graph.error != "" else Describe.describe(graph)


# Takes a request, to be worked in at the next update; returns its id, made where there is none. It may have `after`: seconds from now,
# which wins over `at`.
func ask(request):
	_count += 1
	var ident = "#%d" % _count
	if graph.error != "":
		return _refuse(ident, graph.error)
	if typeof(request) != TYPE_DICTIONARY:
		return _refuse(ident, "a request should be a record with 'do'")
	var data = request.duplicate()
	if typeof(data.get("id")) == TYPE_STRING and data["id"] != "":
		ident = data["id"]
	data["id"] = ident
	if data.has("after"):
		var after = data["after"]
		if not Util.is_finite_number(after) or after < 0:
			return _refuse(ident, "after: should be a number of seconds from now")
		data["at"] = now + after
		data.erase("after")
	var found = Asks.read(data)
	if found[0] == null:
		return _refuse(ident, found[1])
	_settled.erase(ident)
	_asked[ident] = true
	_queue.append(found[0])
	return ident


# Sets a parameter of the project; returns the id of the request that this makes. A number outside of its range becomes the nearest inside,
# a trigger has no value, and what is set to the value that it has makes no request again. What cannot be set is refused.
func set_parameter(name, value = null):
	var found = _parameters.request_for(name, value)
	if found[1] != "":
		_count += 1
		return _refuse("#%d" % _count, found[1])
	if found[0] == null:
		return _parameters.made[name]
	var ident = ask(found[0])
	_parameters.made[name] = ident
	return ident


# Returns the value that a parameter was set to, else its first one; null for a trigger, and where there is none of that name.
func get_parameter(name):
	return _parameters.value_of(name)


# Says a line whose sound comes in while it is said: with each call its next samples, -1..1. The lips do what is heard in them. An id
# is one line's; returns it, as `ask` does. rate: samples a second, 8000 to 48000.
func say_sound(ident, samples, rate):
	if not Util.is_finite_number(rate) or rate < 8000 or rate > 48000:
		return _refuse(ident, "rate: should be a number from 8000 to 48000")
	var begun = plan.track.last_speech(ident)
	var before = null
	for waiting in _queue:  # of the same update
		if waiting.id == ident and waiting["do"] == "say":
			before = waiting
	var voice = _sounds.get(ident)
	if voice == null or voice.rate != float(rate) or (begun == null and before == null):
		voice = StreamedVoice.StreamedVoice.new(float(rate))
	if begun != null:
		voice.follow(Utterances.find_soon(now, graph.settings.lookahead) - Items.find_line_start(begun))
	_sounds.erase(ident)
	_sounds[ident] = voice
	if _sounds.size() > SOUNDS:
		_sounds.erase(_sounds.keys()[0])
	var visemes = []
	if before != null:
		visemes = before.visemes.duplicate()
		_queue.erase(before)
	var from = voice.seconds
	var marks = voice.hear(samples)
	for mark in marks:
		visemes.append([mark.at, mark.viseme, mark.weight])
	if marks.size() == 0:
		visemes.append([from, voice.shape, voice.weight])  # what goes on
	return ask({"do": "say", "id": ident, "visemes": visemes, "set": "oculus"})


func _refuse(ident, why):
	_settle(_told(ident, "refused", why))
	return ident


# Keeps an answer that will not change any more.
func _settle(found):
	_asked.erase(found.id)
	_settled.erase(found.id)
	_settled[found.id] = found
	if _settled.size() > REMEMBERED:
		_settled.erase(_settled.keys()[0])


static func _told(ident, state, why):
	return {id = ident, state = state, at = null, until = null, what = [], why = why}


# Moves on to `seconds` of the character's own time, which begins at 0, never goes backwards, and leaps an hour at most. Plans what is
# needed.
func update(seconds):
	if graph.error != "":
		return
	if Util.is_finite_number(seconds) and seconds > now:
		now = Util.least(float(seconds), now + LEAP)
	_pose = null
	_plan_on()
	_listen()


func _plan_on():
	for what in Utterances.find_forgotten(plan.track, now):
		_queue.append(Asks.read({"do": "finish", "id": what + ".0", "what": what})[0])
	var far = plan.end >= now + ahead - Util.least(SLACK, ahead / 2.0)
	if _queue.size() > 0 or not far:
		var asks = _queue
		_queue = []
		var heard = Hear.hear(graph, plan, now, asks, plan.end if far else now + ahead, stances, idle)
		if heard != null:
			plan = heard
		for request in asks:
			if heard == null:  # a fault of the runtime's own must not stop the game: the character goes on with the plan it has
				_refuse(request.id, "the runtime failed")
			elif TAKING.has(request["do"]):
				_settle(_told(request.id, "done", ""))
	if _seen - _forgot_at >= FORGET_EVERY:
		_forgot_at = _seen  # what has begun and ended since then is still to be told
		_forget(_seen - recent)


# Forgets what is over, and settles the answers of what was asked for then.
func _forget(over):
	var known = Answers.answers(plan, _asked)
	plan = Planner.since(plan, over)
	var left = Answers.answers(plan, _asked)
	for ident in known:
		var found = known[ident]
		# What the plan no longer knows was played; so was a look without an end that another has replaced.
		if found.until != null and (found.until < over or left[ident].until == null):
			found.state = "done"
			_settle(found)
		elif found.state == "refused" or found.state == "done":
			_settle(found)


# Notes what has begun or ended since the update before.
func _listen():
	var new = []
	for layer in Util.LAYERS:
		for cue in plan.layers[layer].cues:
			if cue.start > now:
				break
			if cue.end > _seen and (cue.start > _seen or cue.end <= now):
				_note(new, cue.start, cue.end, layer, cue.action.name, cue.meta.split("+")[0])  # what goes on after a cut is the same
	for event in _speech.watch(plan.track.speeches, _seen, now):
		new.append({kind = event.kind, at = event.at, layer = "speech", action = event.said, meta = event.id, reason = event.reason})
	_seen = now
	if new.size() > 0:
		_events += Util.by(new, "at")
		_events = Util.part(_events, Util.most(0, _events.size() - REMEMBERED), _events.size())


func _note(into, start, end, layer, action, meta):
	if start > _seen and start <= now:
		into.append({kind = "begin", at = start, layer = layer, action = action, meta = meta, reason = ""})
	if end > _seen and end <= now:
		into.append({kind = "end", at = end, layer = layer, action = action, meta = meta, reason = ""})


# Returns what became of a request: {id, state: planned, late, done or refused, at, until: seconds or null, what: names of what plays, why}.
func answer(ident):
	if _settled.has(ident):
		return _settled[ident]
	if not _asked.has(ident):
		return _told(ident, "refused", "nothing was asked for as '%s'" % str(ident))
	for waiting in _queue:
		if waiting.id == ident:
			return _told(ident, "planned", "taken up at the next update")
	return Answers.answer(plan, ident)


# Returns what began and ended since this was last asked for, by time, of more than 1000 the latest: [{kind: "begin" or "end", at, layer:
# "speech" for what is said, action: its name, of what is said the line's id, else the text, meta: the request's id, reason: where all
# that is said under an id is over, finished, interrupted or replaced, else ""}].
func events():
	var happened = _events
	_events = []
	return happened


# Returns [what of something said was spoken until now, up to the word that was begun, that word]; "" where nothing was.
func spoken(ident):
	return SpokenSoFar.spoken_until(graph.alphabet, plan.track.speeches, ident, now)


# Returns the pose of now: {rotations [J] local quaternions, translations [J] local metres, morphs {name: weight}}, of `graph.names`.
func pose():
	if _pose == null and graph.error == "":
		_pose = Pose.pose_at(graph, plan, now, alive)
	return _pose


func morphs():
	var found = pose()
	return found.morphs if found != null else {}
