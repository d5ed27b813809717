# The one evaluator: what pose a plan gives at a time. Layers add their offsets from the base pose, base * body^w * arms^w * head^w; the
# life layers come on top. Each pose depends on its own time alone.

const Util = preload("util.gd")
const Turns = preload("turns.gd")
const Mood = preload("mood.gd")
const Evaluate = preload("evaluate.gd")
const Contacts = preload("contacts.gd")
const Weight = preload("weight.gd")
const CueTimes = preload("cue_times.gd")

# A clip is led while no joint is farther from the stance than the first, and crossfaded where one is farther than the second: cosines
# of half that turn.
const LEAD_WITHIN = 0.966
const FADE_BEYOND = 0.866


# Returns {rotations [J] local quaternions, translations [J] local, metres, morphs {name: weight 0..1}} at a time. alive: with the life
# layers, as far as the export has them on. Actions whose clip is missing show their stance.
static func pose_at(graph, plan, time, alive = true):
	var composed = _compose(graph, plan, time)
	var morphs = _layers_morphs(graph, plan, time)
	if alive and plan.life.end > 0 and graph.weight_rig != null and graph.life.on:
		_weigh(graph, plan, time, composed)
	if alive and graph.life.on and graph.rig != null and not graph.rig.empty and plan.life.end > 0:
		var cues = []
		for layer in Util.LAYERS:
			var cue = cue_at(plan.layers[layer], time)
			if cue != null:
				cues.append(cue)
		composed = Evaluate.enliven(graph, plan, time, composed, cues)
		for name in composed.morphs:
			var played = morphs.get(name, 0.0)  # clips leave the rest of it to life
			morphs[name] = played + composed.morphs[name] * (1.0 - Util.least(1.0, Util.most(0.0, played)))
	if graph.contact_rig != null:
		Contacts.touch(graph, _playing(graph, plan, time), time, composed)
	for name in morphs:
		morphs[name] = Util.least(1.0, Util.most(0.0, morphs[name]))
	composed.morphs = morphs
	return composed


# Returns of each layer [its plan, the cue with motion that plays or null, the place of its rest or -1, its strength on the arms].
static func _playing(graph, plan, time):
	var out = []
	for layer in Util.LAYERS:
		var of = plan.layers[layer]
		var cue = cue_at(of, time)
		if cue != null and not graph.clips.has(cue.action.clip):
			cue = null
		var place = Util.most(Util.after(of.rests, "fade_start", time) - 1, 0) if of.rests.size() > 0 else -1
		out.append([of, cue, int(place), graph.layers[layer].strength])
	return out


# Lets the feet of a composed pose stay planted, and its body answer its arms.
static func _weigh(graph, plan, time, composed):
	var playing = []
	if Weight.sways(graph) and plan.layers.arms.cues.size() > 0:
		for at in Weight.knots(time):
			var found = _playing(graph, plan, at)
			playing.append([found[Util.LAYERS.find("arms")], found[Util.LAYERS.find("body")]])
	Weight.answer(graph, playing, _playing(graph, plan, time)[Util.LAYERS.find(graph.feet_layer)], time, composed)


static func _compose(graph, plan, time):
	var rotations = graph.base_rotations.duplicate()
	var translations = graph.base_translations.duplicate()
	for layer in Util.LAYERS:
		if plan.layers[layer].rests.size() == 0:
			continue
		var shown = _layer(graph, plan.layers[layer], time)
		for each in graph.layers[layer].reach:
			var joint = each[0]
			var turn = shown.turns[joint]
			rotations[joint] = rotations[joint] * (turn if each[1] == 1 else Turns.power(turn, each[1]))
			if shown.shifts.has(joint):
				translations[joint] += shown.shifts[joint] * each[1]
	for joint in range(rotations.size()):
		rotations[joint] = rotations[joint].normalized()
	return {rotations = rotations, translations = translations}


# Returns how much of a cue shows: 0 outside it, rising over its blend in, falling over its blend out.
static func cue_weight(cue, time):
	var rise = Util.smooth((time - cue.start) / cue.blend_in) if cue.blend_in > 0 else (1.0 if time >= cue.start else 0.0)
	var fall = Util.smooth((cue.end - time) / cue.blend_out) if cue.blend_out > 0 else (1.0 if time < cue.end else 0.0)
	return rise * fall


# Returns the clip second that a cue shows at a time within it.
static func clip_seconds(cue, time):
	if cue.repeats:
		return CueTimes.cue_seconds(cue, time)
	var elapsed = time - cue.start
	if cue.hold <= 0:
		return cue.entry + elapsed * cue.tempo
	var held = Util.within(elapsed - (cue.hold_from - cue.entry) / cue.tempo, 0.0, cue.hold)
	return cue.entry + (elapsed - held) * cue.tempo + held * ((cue.hold_to - cue.hold_from) / cue.hold)


# Returns for seconds since a loop began: [clip second, clip second of the seam's other side, how much of that shows]. With a seam of x
# seconds the loop's last x seconds fade into its first, and its period is x shorter.
static func loop_seconds(action, elapsed):
	var length = action.end - action.start
	var seam = Util.least(action.timing.blend_in, length / 2.0)
	var period = length - seam
	if period <= 0:
		return [action.start, action.start, 0.0]
	if seam <= 0:
		var at = action.start + fposmod(elapsed, period)
		return [at, at, 0.0]
	var phase = fposmod(Util.most(elapsed, 0.0), period)
	var old = 1.0 - Util.smooth(phase / seam) if elapsed >= period else 0.0
	return [action.start + phase, action.start + Util.least(period + phase, length), old]


# Returns the cue that plays at a time, null while the stance rests.
static func cue_at(plan, time):
	var place = Util.after(plan.cues, "start", time) - 1
	return plan.cues[place] if place >= 0 and time < plan.cues[place].end else null


# Returns a layer's offsets {turns [J], shifts {joint: metres}} at a time.
static func _layer(graph, plan, time):
	var cue = cue_at(plan, time)
	var clip = graph.clips.get(cue.action.clip) if cue != null else null
	if clip == null:
		return _stance(graph, plan, time)
	var shown = _sample(clip, clip_seconds(cue, time))
	var left = CueTimes.seam_left(cue, time)
	if left > 0:  # it goes on from where the cycle before it ended
		shown = _lead(graph, plan, shown, _sample(clip, cue.cycle_from), _sample(clip, cue.cycle_to), left)
	var entering = time < cue.start + cue.blend_in
	var blending = entering or time >= cue.end - cue.blend_out
	var partly = cue.action.partly
	if not blending and partly == null and cue.extent == 1:
		return shown
	var stance = _stance(graph, plan, time)
	var out = {turns = shown.turns.duplicate(), shifts = shown.shifts.duplicate()}
	if blending and cue.repeats:  # at its ends it moves
		out = _mix(stance, shown, cue_weight(cue, time))
	elif blending:
		var edge = _sample(clip, cue.entry if entering else clip_seconds(cue, cue.end))
		out = _blend(graph, plan, shown, edge, stance, cue_weight(cue, time))
	if cue.extent != 1:
		_extend(graph, plan.layer, out, stance, cue.extent)
	if partly != null:
		for joint in partly:
			out.turns[joint] = Turns.nlerp(stance.turns[joint], out.turns[joint], partly[joint])
			if stance.shifts.has(joint) or out.shifts.has(joint):
				var rest = stance.shifts.get(joint, Vector3())
				out.shifts[joint] = rest + (out.shifts.get(joint, Vector3()) - rest) * partly[joint]
	return out


# Returns what is shown, blended in from or out to its stance; edge is the clip's pose there. Where that is near the
# stance, what the stance differs from it is added, so that the clip keeps its own speed. Where a joint has far to turn,
# they are crossfaded: it would do its whole movement around a pose that the clip never has.
static func _blend(graph, plan, shown, edge, stance, weight):
	var near = 1.0
	for each in graph.layers[plan.layer].reach:
		near = Util.least(near, abs(edge.turns[each[0]].dot(stance.turns[each[0]])))
	var far = Util.smooth((LEAD_WITHIN - near) / (LEAD_WITHIN - FADE_BEYOND))
	var led = _lead(graph, plan, shown, edge, stance, 1.0 - weight)
	return _mix(led, _mix(stance, shown, weight), far) if far > 0.0 else led


# Returns what is shown with a part of the way from a pose to another added.
static func _lead(graph, plan, shown, from, to, weight):
	var out = {turns = shown.turns.duplicate(), shifts = shown.shifts.duplicate()}
	for each in graph.layers[plan.layer].reach:
		var joint = each[0]
		out.turns[joint] = shown.turns[joint] * Turns.part(Turns.back(from.turns[joint]) * to.turns[joint], weight)
	for joint in to.shifts:
		out.shifts[joint] = out.shifts.get(joint, Vector3()) + to.shifts[joint] * weight
	for joint in from.shifts:
		out.shifts[joint] = out.shifts.get(joint, Vector3()) - from.shifts[joint] * weight
	return out


# Plays what is shown larger or smaller round the stance.
static func _extend(graph, layer, out, stance, extent):
	var takes_part = graph.larger if extent > 1 else graph.smaller
	for each in graph.layers[layer].reach:
		var joint = each[0]
		if takes_part[joint]:
			var apart = Turns.back(stance.turns[joint]) * out.turns[joint]
			out.turns[joint] = stance.turns[joint] * Turns.power(apart, Mood.turn_extent(extent, apart.w))
			var away = out.shifts.get(joint, Vector3())
			var rest = stance.shifts.get(joint, Vector3())
			if away != rest:
				out.shifts[joint] = rest + (away - rest) * extent


# Returns the offsets of the stance that lies under the cues.
static func _stance(graph, plan, time):
	var place = Util.most(Util.after(plan.rests, "fade_start", time) - 1, 0)
	var rest = plan.rests[place]
	var found = _rest(graph, rest, time)
	if place == 0 or rest.fade_start + rest.fade <= time:
		return found
	var before = _rest(graph, plan.rests[place - 1], time)
	return _mix(before, found, Util.smooth((time - rest.fade_start) / rest.fade))


static func _rest(graph, rest, time):
	var clip = graph.clips.get(rest.action.clip)
	if clip == null:
		return graph.still_frame
	var at = loop_seconds(rest.action, time - rest.start)
	var found = _sample(clip, at[0])
	return _mix(found, _sample(clip, at[1]), at[2]) if at[2] > 0 else found


# Crossfades two layers' offsets, `weight` of the second.
static func _mix(a, b, weight):
	var turns = []
	for joint in range(a.turns.size()):
		turns.append(Turns.nlerp(a.turns[joint], b.turns[joint], weight))
	var shifts = {}
	for joint in a.shifts:
		shifts[joint] = a.shifts[joint] * (1.0 - weight)
	for joint in b.shifts:
		shifts[joint] = shifts.get(joint, Vector3()) + b.shifts[joint] * weight
	return {turns = turns, shifts = shifts}


# Returns a clip's offsets at clip seconds; what it returns is not to be changed.
static func _sample(clip, seconds):
	var at = clip.locate(seconds)
	var low = clip.frame(at[0])
	if at[2] <= 0:
		return low
	var high = clip.frame(at[1])
	var turns = low.turns.duplicate()
	for joint in clip.moving:
		turns[joint] = Turns.nlerp(low.turns[joint], high.turns[joint], at[2])
	var shifts = {}
	for joint in low.shifts:
		shifts[joint] = low.shifts[joint] * (1.0 - at[2])
	for joint in high.shifts:
		shifts[joint] = shifts.get(joint, Vector3()) + high.shifts[joint] * at[2]
	return {turns = turns, shifts = shifts}


# Returns the layers' morph target weights: their clips', by how much of each shows.
static func _layers_morphs(graph, plan, time):
	var out = {}
	for layer in Util.LAYERS:
		var of = plan.layers[layer]
		var cue = cue_at(of, time)
		var weight = cue_weight(cue, time) if cue != null else 0.0
		if cue != null:
			_add_morphs(out, graph.clips.get(cue.action.clip), clip_seconds(cue, time), weight)
		if of.rests.size() > 0:
			var rest = of.rests[Util.most(Util.after(of.rests, "fade_start", time) - 1, 0)]
			var looped = loop_seconds(rest.action, time - rest.start)
			_add_morphs(out, graph.clips.get(rest.action.clip), looped[0], (1.0 - weight) * (1.0 - looped[2]))
			_add_morphs(out, graph.clips.get(rest.action.clip), looped[1], (1.0 - weight) * looped[2])
	return out


static func _add_morphs(out, clip, seconds, share):
	if clip == null or not clip.morphs or share <= 0:
		return
	var at = clip.locate(seconds)
	var low = clip.frame(at[0]).morphs
	var high = clip.frame(at[1]).morphs
	for name in low:
		out[name] = out.get(name, 0.0) + share * (low[name] * (1.0 - at[2]) + high.get(name, 0.0) * at[2])


# Returns the joints' positions in the character's space [J], metres.
static func positions(graph, pose):
	var turned = []
	var out = []
	for joint in range(graph.names.size()):
		var parent = graph.parents[joint]
		if parent < 0:
			turned.append(pose.rotations[joint])
			out.append(pose.translations[joint])
		else:
			turned.append(turned[parent] * pose.rotations[joint])
			out.append(out[parent] + Turns.rotate(turned[parent], pose.translations[joint]))
	return out
