# One layer being planned, cue after cue: candidates, the temporal cases, the draw. Nothing of it leaves the planner.
#
# A cue is {action, start, end, entry: clip second it begins with, blend_in, blend_out, stance: before it, then: the stance it
# leaves the layer in, meta: key of what it realises, hold_from, hold_to: clip seconds that take `hold` seconds; 0, 0, 0 where not
# stretched}. A rest is {stance, action, start: when its loop begins, fade_start, fade: how it takes over from the loop before}.

const Util = preload("util.gd")
const Choice = preload("choice.gd")
const MetaPlan = preload("meta_plan.gd")
const Shape = preload("shape.gd")
const FITS = 1e-6  # seconds by which sums of times may be off
const REMEMBERED = 32  # draws of a stance and kind that spacing can look back on

var graph  # all of it
var of  # the layer's part
var settings
var seed32
var stance
var clear_from = 0.0
var uses = {}  # action id -> how often
var recent = {}  # kind/stance -> the last draws
var ended = {}  # action id -> when last
var cues = []
var rests = []
var reports = []
var begun = {}  # keys of meta actions whose chain of transitions plays already


func _init(whole, layer, key_seed, begin, past, played):
	graph = whole
	of = graph.layers[layer]
	settings = graph.settings
	seed32 = key_seed
	stance = past.stance if of.stances.has(past.stance) else begin
	clear_from = past.free
	uses = past.uses.duplicate()
	recent = past.recent.duplicate()
	ended = past.ended.duplicate()
	for cue in played:
		note(cue, cue.then if of.stances.has(cue.then) else begin)


# Takes a cue as played.
func note(cue, then):
	cues.append(cue)
	clear_from = cue.end
	stance = then
	remember(cue, uses, recent, ended)


# Notes that a cue was played: how often its action was, lately, and until when.
static func remember(cue, used, lately, until):
	var ident = cue.action.id
	var node = cue.action.kind + "/" + cue.stance
	used[ident] = used.get(ident, 0) + 1
	var before = lately.get(node, [])
	lately[node] = Util.part(before, Util.most(0, before.size() - (REMEMBERED - 1)), before.size()) + [ident]
	until[ident] = cue.end


# Returns when the next action may begin at the earliest.
func ready():
	return clear_from + (settings.rest if ended.size() > 0 else 0.0)


# Lays the first loop down; returns whether the layer can perform at all.
func begin_in(first):
	var loop = _loop(first, "rest/" + of.layer)
	if loop == null:
		return false
	rests.append({stance = first, action = loop, start = 0.0, fade_start = 0.0, fade = 0.0})
	return true


# Realises what starts before `end` of a conflict-free meta plan, in order.
func perform(metas, end):
	for bound in _bounds(metas):
		var meta = bound[0]
		if meta.start >= end:
			return
		if meta.end <= ready() + FITS and meta.start < ready() and not begun.has(meta.key):
			var running = "'%s'" % cues[-1].action.name if cues.size() > 0 else "the running action"
			var waits = ready() - meta.request.start
			# What is wanted for a certain time is over; what is wanted once may come late.
			if meta.written or meta.request.duration != null or waits > settings.wait:
				_tell(meta, "covered", "wholly covered by %s, which plays until %.2f s" % [running, clear_from])
				continue
			_tell(meta, "queued", "waits %.2f s for %s" % [waits, running], true)
		_realise(meta, Util.most(ready(), meta.start), bound[1], bound[2])


func _realise(meta, now, limit, wish):
	var steps = _steps(meta)
	if steps == null:
		return
	var made = []
	var at = stance
	for step in steps:
		var asked = meta.request if step.hop == "" else null
		var fitting = []
		for action in step.candidates:
			if limit < INF:  # else all fit
				var likely = Shape.shape_of(action, asked, now, settings)
				if likely.start + likely.shortest > limit + FITS:
					continue
			fitting.append(action)
		if fitting.size() == 0:
			_tell(meta, "no-room", "nothing fits into the %.2f s before what follows" % Util.most(0.0, limit - now))
			return
		if step.hop == "" and meta.request.action == null:
			var warm = []
			var soonest = INF
			for action in fitting:
				soonest = Util.least(soonest, _cooled(action))
				if action.cooldown <= 0 or _cooled(action) <= Shape.shape_of(action, asked, now, settings).start + FITS:
					warm.append(action)
			if warm.size() == 0:
				_tell(meta, "cooling", "all that fit are cooling down; the first may play again at %.2f s" % soonest)
				return
			fitting = warm
		var chosen = _draw(fitting, meta.key + "/" + step.hop if step.hop != "" else meta.key, now)
		var shape = Shape.shape_of(chosen, asked, now, settings)
		var cue = Shape.cue_of(chosen, shape, limit, INF if step.hop != "" else wish, at, meta.key, settings)
		made.append(cue)
		now = cue.end
		at = cue.then
	for cue in made:
		_keep(cue)


# Returns when an action may be drawn again.
func _cooled(action):
	return ended[action.id] + action.cooldown if action.cooldown > 0 and ended.has(action.id) else -INF


# Returns each action in turn, {candidates, hop: the stance a transition on the way leads to, ""}: the transitions to get there,
# then the action itself; null if impossible or needless.
func _steps(meta):
	var request = meta.request
	if request.action != null:
		var action = of.actions.get(request.action)
		if action == null or not of.stances.has(action.stance):
			_tell(meta, "unknown-action", "there is no action '%s' in the %s layer" % [request.action, of.layer])
			return null
		if action.kind == "stance":
			return _way(meta, action.stance)
		if not _arrives(action):
			_tell(meta, "no-stance", "'%s' ends in a stance that has no loop" % action.name)
			return null
		var way = [] if action.stance == stance else _way(meta, action.stance)
		return null if way == null else way + [{candidates = [action], hop = ""}]
	if request.stance != null and (request.kind == "transition" or request.kind == "stance"):
		if not of.stances.has(request.stance):
			_tell(meta, "no-stance", "there is no stance '%s' in the %s layer" % [request.stance, of.layer])
			return null
		return _way(meta, request.stance)
	var every = []
	var found = []
	var exact = []
	for action in graph.of(of, stance, request.kind):
		if not _usable(action) or (request.among.size() > 0 and not request.among.has(action.id)):
			continue
		every.append(action)
		if Util.has_all(action.tags, request.tags):
			found.append(action)
			if request.limb == null or action.limb == request.limb:
				exact.append(action)
	if meta.written:  # the model's limb and tags are wishes, not orders, nor worth playing the same again
		exact = _first_other([exact, found, every])
	if exact.size() == 0:
		var lacks = "stance '%s' has no such %s" % [of.stances[stance], request.kind]
		if found.size() == 0:
			_tell(meta, "no-candidate", lacks)
			return null
		_tell(meta, "other-limb", lacks + " of that limb; another will do", true)  # a limb is a wish, too
		exact = found
	return [{candidates = exact, hop = ""}]


# Returns the first list that has something else than what was drawn last, the last list where none has.
func _first_other(lists):
	for some in lists:
		for action in some:
			var last = recent.get(action.kind + "/" + stance, [])
			if last.size() == 0 or last[-1] != action.id:
				return some
	return lists[-1]


# Returns the transitions hop by hop from the current stance to `goal`.
func _way(meta, goal):
	if goal == stance:
		_tell(meta, "already-there", "the layer is in '%s' already" % of.stances[goal], true)
		return null
	var hops = _chain(goal)
	if hops == null:
		_tell(meta, "no-way", "no chain of transitions leads from '%s' to '%s'" % [of.stances[stance], of.stances[goal]])
		return null
	var steps = []
	var at = stance
	for following in hops:
		var candidates = []
		for action in graph.of(of, at, "transition"):
			if action.end_stance == following and _usable(action):
				candidates.append(action)
		steps.append({candidates = candidates, hop = following})
		at = following
	return steps


# Returns the stances behind the current one on the shortest way of usable transitions to `goal`, null if there is no way. Among
# equally short ways the one whose transitions were placed first is taken.
func _chain(goal):
	var came_from = {stance: stance}
	var queue = [stance]
	var place = 0
	while place < queue.size():
		for action in graph.of(of, queue[place], "transition"):
			var end = action.end_stance
			if end == null or came_from.has(end) or not of.stances.has(end) or not _usable(action):
				continue
			came_from[end] = queue[place]
			if end == goal:
				var way = [end]
				while came_from[way[0]] != stance:
					way.push_front(came_from[way[0]])
				return way
			queue.append(end)
		place += 1
	return null


# Returns whether an action leaves the layer in a stance that can rest.
func _arrives(action):
	if action.kind != "transition":
		return true
	return action.end_stance != null and of.stances.has(action.end_stance) and graph.of(of, action.end_stance, "stance").size() > 0


func _usable(action):
	return action.likelihood > 0 and _arrives(action)


# Draws with p_k ~ likelihood_k / Util.most(c_k, 1), leaving out those used too recently as long as any others are left.
func _draw(candidates, key, now):
	candidates = _spaced(candidates)
	var weights = {}
	for action in candidates:
		weights[action.id] = action.likelihood / Util.most(_count(action.id, now), 1.0)
	return _picked(candidates, key, "action", weights)


# Draws one of some actions by weights {id: weight}; the first where none has any.
func _picked(actions, key, purpose, weights):
	for ident in weights:
		if weights[ident] > 0:
			return of.actions[Choice.pick(seed32, key, purpose, weights)]
	return actions[0]


# Leaves out what needs more other actions before it plays again; where that leaves nothing, all need one less, and so on.
func _spaced(candidates):
	var default = 1 if settings.never_twice else 0
	var drawn = recent.get(candidates[0].kind + "/" + candidates[0].stance, [])
	if candidates.size() < 2 or drawn.size() == 0:
		return candidates
	var since = {}  # how many came after it
	for place in range(drawn.size()):
		since[drawn[place]] = drawn.size() - 1 - place
	var most = 0
	for action in candidates:
		most = int(Util.most(most, default if action.spacing == null else action.spacing))
	for less in range(most + 1):
		var left = []
		for action in candidates:
			if since.get(action.id, REMEMBERED) >= (default if action.spacing == null else action.spacing) - less:
				left.append(action)
		if left.size() > 0:
			return left
	return candidates


# Returns c_k: alpha times the uses, over the settings' memory.
func _count(ident, now):
	if settings.memory <= 0:
		return settings.alpha * uses.get(ident, 0)
	var used = 0
	for n in range(cues.size() - 1, -1, -1):
		if cues[n].start < now - settings.memory:
			break
		if cues[n].action.id == ident:
			used += 1
	return settings.alpha * used


func _keep(cue):
	note(cue, cue.then)
	var loop = _loop(cue.then, cue.meta)
	if loop == null:
		return
	# The loop begins anew under the action, so that the action's last pose meets the loop's first. Where the action leaves
	# joints alone the change shows, and takes its time: a transition all of its own.
	var begin = cue.start + cue.blend_in
	var until = cue.end - cue.blend_out
	var fade = Util.most(0.0, until - begin)
	if cue.action.limb != "both" or cue.action.joints.size() > 0:
		fade = cue.end - cue.start
		if cue.then == cue.stance:
			fade = Util.least(settings.loop_fade, fade)
		begin = Util.most(cue.start, until - fade)
	rests.append({stance = cue.then, action = loop, start = until, fade_start = begin, fade = fade})


func _loop(at, key):
	var loops = graph.of(of, at, "stance")
	if loops.size() == 0:
		return null
	var weights = {}
	for action in loops:
		weights[action.id] = action.likelihood
	return _picked(loops, key, "loop", weights)


# Where a stance has several loops, changes between them in long rests, at a loop's end.
func vary_rests(end):
	var out = []
	for place in range(rests.size()):
		var rest = rests[place]
		out.append(rest)
		if graph.of(of, rest.stance, "stance").size() < 2:
			continue
		var until = rests[place + 1].fade_start if place + 1 < rests.size() else end
		var current = rest
		var change = rest.start
		while true:
			change += Util.most(1.0, current.action.end - current.action.start - current.action.blend_in)
			if change > until:
				break
			var loop = _loop(rest.stance, of.layer + "/" + Util.thousandths(change))
			if loop != null and loop.id != current.action.id:
				current = {
					stance = rest.stance, action = loop, start = change, fade_start = change - settings.loop_fade, fade = settings.loop_fade
				}
				out.append(current)
	rests = out


func _tell(meta, outcome, message, played = false):
	reports.append(MetaPlan.Report.new(meta.request.id, outcome, message, of.layer, meta.start, played, meta.written))


# Returns each meta action with when the next more important one begins, and the next as important that was asked for.
static func _bounds(metas):
	var out = []
	var first = []  # [rank, written, start] of the next such
	for n in range(metas.size() - 1, -1, -1):
		var meta = metas[n]
		var rank = meta.rank
		var limit = INF
		var wish = INF
		var own = null
		for entry in first:
			if entry[0] > rank:
				limit = Util.least(limit, entry[2])
			if entry[0] >= rank and not entry[1]:
				wish = Util.least(wish, entry[2])
			if entry[0] == rank and entry[1] == meta.written:
				own = entry
		if own == null:
			first.append([rank, meta.written, meta.start])
		else:
			own[2] = meta.start
		out.push_front([meta, limit, wish])
	return out
