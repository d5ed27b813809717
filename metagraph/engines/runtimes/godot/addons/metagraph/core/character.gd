# One character at play: takes requests, keeps its plan some seconds ahead of the clock, and has the pose of now. Nothing here fails while
# it plays: what cannot be done is refused, and `answer` says why.

const Util = preload("util.gd")
const Asks = preload("asks.gd")
const Hear = preload("hear.gd")
const Planner = preload("planner.gd")
const Pose = preload("pose.gd")
const SLACK = 2.0  # seconds by which the horizon may fall behind before it is moved
const FORGET_EVERY = 15.0  # seconds
const REMEMBERED = 256  # answers kept of what is over or was never understood

var graph
var plan
var now = 0.0
var alive = true  # whether the life layers play
var ahead
var recent
var idle
var stances
var _queue = []
var _answers = {}  # of what is over, or was refused at once
var _asked = {}
var _number = 0
var _forgot_at = 0.0
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


# Takes a request, to be worked in at the next update; returns its id. In place of `at` it may have `after`: seconds from now.
func ask(request):
	var data = request.duplicate() if typeof(request) == TYPE_DICTIONARY else request
	if typeof(data) == TYPE_DICTIONARY and data.has("after"):
		if Util.is_number(data["after"]):
			data["at"] = now + Util.most(0.0, data["after"])
			data.erase("after")
	var found = Asks.read(data)
	var ident = ""
	if found[0] != null:
		ident = found[0].id
	elif typeof(data) == TYPE_DICTIONARY and typeof(data.get("id")) == TYPE_STRING:
		ident = data["id"]
	if ident == "":
		_number += 1
		ident = "#%d" % _number
	if found[0] == null:
		_keep_answer(ident, {state = "refused", at = null, until = null, what = [], why = found[1]})
		return ident
	found[0].id = ident
	_answers.erase(ident)
	_asked[ident] = true
	_queue.append(found[0])
	return ident


# Moves the clock on to `seconds`, never back, and plans what is to be planned.
func update(seconds):
	if graph.error != "":
		return
	var before = now
	var first = plan.end <= 0
	now = Util.most(now, float(seconds))
	_pose = null
	var short = plan.end < now + ahead - SLACK
	if _queue.size() > 0 or short or first:
		var asks = _queue
		_queue = []
		plan = Hear.hear(graph, plan, now, asks, now + ahead if short or first else plan.end, stances, idle)
	_events = []
	for layer in Util.LAYERS:
		for cue in plan.layers[layer].cues:
			if cue.start <= now and (cue.start > before or first):
				_events.append({kind = "begin", layer = layer, action = cue.action.name, meta = cue.meta, at = cue.start})
			if cue.end <= now and (cue.end > before or first):
				_events.append({kind = "end", layer = layer, action = cue.action.name, meta = cue.meta, at = cue.end})
	_events = Util.by(_events, "at")
	if now - _forgot_at >= FORGET_EVERY:
		_forgot_at = now
		_remember_answers(now - recent)
		plan = Planner.since(plan, now - recent)


# Returns what became of a request: {state: planned, late, done or refused, at, until: seconds or null, what: names of what plays, why}.
func answer(ident):
	if _answers.has(ident):
		return _answers[ident]
	for waiting in _queue:
		if waiting.id == ident:
			return {state = "planned", at = null, until = null, what = [], why = "taken up at the next update"}
	if not _asked.has(ident):
		return {state = "refused", at = null, until = null, what = [], why = "nothing of this id was asked"}
	return Hear.answer(plan, ident)


# Returns what began and what ended in the last update: [{kind: "begin" or "end", layer, action: its name, meta, at}].
func events():
	return _events


# Returns the pose of now: {rotations [J] local quaternions, translations [J] local metres, morphs {name: weight}}, of `graph.names`.
func pose():
	if _pose == null and graph.error == "":
		_pose = Pose.pose_at(graph, plan, now, alive)
	return _pose


func morphs():
	var found = pose()
	return found.morphs if found != null else {}


# Keeps the answers of what will be forgotten.
func _remember_answers(seconds):
	for ident in _asked.keys():
		var found = Hear.answer(plan, ident)
		if found.until != null and found.until < seconds:
			_asked.erase(ident)
			found.state = "done"
			_keep_answer(ident, found)
		elif found.until == null and found.state != "planned" and found.state != "late":
			_asked.erase(ident)
			_keep_answer(ident, found)


func _keep_answer(ident, found):
	_answers.erase(ident)
	_answers[ident] = found
	while _answers.size() > REMEMBERED:
		_answers.erase(_answers.keys()[0])
