# The life layers at a time: what they add to the pose the layers have composed. A turn is multiplied on the right of a joint's composed
# rotation, a shift is added to its translation.

const Expressions = preload("expressions.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const Turns = preload("turns.gd")
const Gaze = preload("gaze.gd")
const Schedule = preload("schedule.gd")
const Solve = preload("solve.gd")
const Lips = preload("lips.gd")
const LIDS = 4  # channels: the lids, the blink, the jaw, then the mouth's shapes but silence
const MOUTH = [
	"jaw_open", "viseme_PP", "viseme_FF", "viseme_TH", "viseme_DD", "viseme_kk", "viseme_CH", "viseme_SS", "viseme_nn", "viseme_RR",
	"viseme_aa", "viseme_E", "viseme_I", "viseme_O", "viseme_U"
]
const FEELS = ["smile", "frown", "brow_down", "brow_up", "brows", "cheeks"]  # what moods and expressions show
const INHALE = 0.4  # of a breath
const MORPH_LOOK = 30.0 * PI / 180.0  # the turn of an eye that a morph target of a look stands for
const MORPH_FOLLOWS = 0.6 / (40.0 * PI / 180.0)  # how far a morph target shuts for an eye that looks down a radian
const MORPH_WIDE = 0.6  # of a target that opens wide, for a lid as far open as it would be shut


# Returns what the life layers make of a composed pose {rotations, translations}: {rotations, translations, morphs {name: weight}}.
# cues: those that play then.
static func enliven(graph, plan, time, pose, cues = []):
	var rig = graph.rig
	var found = _found(graph, plan, time, pose)
	var rotations = pose.rotations.duplicate()
	var translations = pose.translations
	for n in range(rig.chain.size()):
		rotations[rig.chain[n]] = found.chain[n] * Turns.of(found.turns[n], rig.one)
	for n in range(rig.shoulders.size()):
		var joint = rig.shoulders[n].joint
		var turn = rig.shoulders[n].turn * (found.full + found.bears.lift) + rig.shoulders[n].tense * found.bears.tension
		turn += rig.shoulders[n].closed * found.bears.closed
		rotations[joint] = pose.rotations[joint] * Turns.of(turn, rig.one)
	for n in range(2):
		var eye = rig.eyes[n]
		if eye.joint >= 0:
			var turn = eye.turn_left * found.eyes[n][0] + eye.turn_up * found.eyes[n][1]
			rotations[eye.joint] = pose.rotations[eye.joint] * Turns.of(turn, rig.one)
	var turns = _sums(rig.face.turns, found.channels)
	for place in range(rig.face.joints.size()):
		var joint = rig.face.joints[place]
		rotations[joint] = pose.rotations[joint] * Turns.of(turns.get(place, Vector3()), rig.one)
	var shifts = _sums(rig.face.shifts, found.channels)
	if shifts.size() > 0:
		translations = translations.duplicate()
		for place in shifts:
			translations[rig.face.joints[place]] += shifts[place]
	return {rotations = rotations, translations = translations, morphs = _morphs(graph, plan, time, cues, found)}


# Returns {chain: rotations as breathing has them, turns of the chain, full: how full the chest is, eyes [left, up] of both, shut: how far
# each lid is, blink, channels, bears: the posture and face of the mood}.
static func _found(graph, plan, time, pose):
	var rig = graph.rig
	var life = graph.life
	var schedule = plan.life
	var full = breath_at(schedule.breaths, life, time)
	var mood = Mood.shown(schedule.moods.times, schedule.moods.rows, time)
	var bears = Mood.Bearing.new() if mood.neutral else Mood.bearing(mood)
	var chain = []
	var places = []
	var turns = []
	for n in range(rig.chain.size()):
		var joint = rig.chain[n]
		var turn = rig.breath[n] * full + rig.bowed[n] * bears.droop + rig.thrust[n] * bears.thrust
		chain.append(pose.rotations[joint] * Turns.of(turn, rig.one) if turn != Vector3() else pose.rotations[joint])
		places.append(pose.translations[joint])
		turns.append(Vector3())
	var eyes = [[0.0, 0.0], [0.0, 0.0]]
	if rig.lookers.size() > 0 and schedule.targets.size() > 0:
		if plan.gaze.get("of") != schedule:  # kept for as long as the schedule is the same
			plan.gaze.of = schedule
			plan.gaze.made = Gaze.new(graph, schedule)
		var looked = Solve.look(rig, chain, places, plan.gaze.made.at(time), life.gaze, 1.0 - life.stillness, life.head_share)
		eyes = looked.eyes
		for n in range(rig.lookers.size()):
			turns[rig.lookers[n].place] = looked.turns[n]
	var down = [-eyes[0][1], -eyes[1][1]]
	for n in range(2):
		if rig.eyes[n].joint >= 0:
			down[n] += Solve.part_along(pose.rotations[rig.eyes[n].joint], rig.eyes[n].down)
	var blink = Mood.shut_in(blink_at(schedule.blinks, life, time), bears.lids)
	var lids = rig.face.lid_joints
	var follows = rig.face.follows
	if lids.max() < 0:
		follows = [MORPH_FOLLOWS, MORPH_FOLLOWS, 0.0, 0.0]
	var shut = []
	var channels = []
	for k in range(LIDS):
		var already = Solve.part_along(pose.rotations[lids[k]], rig.face.shut_by[k]) if lids[k] >= 0 else 0.0
		shut.append(Solve.lid(down[k % 2], life.lids * follows[k], already, blink))
		channels.append(shut[k] - already)
	channels.append(blink)
	channels.append(0.0)
	var shown = Lips.mouth(graph, plan.track, life.lip_smoothing, time) if life.lips > 0 else null
	for n in range(MOUTH.size() - 1):
		channels.append(shown[n] * life.lips if shown != null else 0.0)
	return {chain = chain, turns = turns, full = full, eyes = eyes, shut = shut, blink = blink, channels = channels, bears = bears}


# Returns {place: sum of the channels' shapes}.
static func _sums(shapes, channels):
	var out = {}
	for n in range(shapes.size()):
		if channels[n] != 0:
			for each in shapes[n]:
				out[each[0]] = out.get(each[0], Vector3()) + each[1] * channels[n]
	return out


# Returns how full the chest is, 0 at rest, about 1 at the top of a breath.
static func breath_at(lane, life, time):
	var n = Util.right_of(lane.times, time) - 1
	if n < 0:
		return 0.0
	var gone = (time - lane.times[n]) / lane.rows[n][0]
	var curve = Util.smooth(Util.least(gone / INHALE, (1.0 - gone) / (1.0 - INHALE)))
	return life.breathing * (1.0 - life.stillness) * lane.rows[n][1] * curve


# Returns how far a blink has shut the eyes, 0..1.
static func blink_at(lane, life, time):
	var whole = life.blink_close + life.blink_open
	var out = 0.0
	var n = Util.right_of(lane.times, time) - 1
	while n >= 0 and time - lane.times[n] < whole:  # a slow one may still be opening when the next begins
		var gone = time - lane.times[n]
		var far = Schedule.HALF if lane.rows[n][0] == 3.0 else 1.0  # some are incomplete
		var shut = Util.smooth(Util.least(gone / life.blink_close, (whole - gone) / life.blink_open))
		out = Util.most(out, far * shut)
		n -= 1
	return out


static func _morphs(graph, plan, time, cues, found):
	var face = graph.rig.face
	if face.morphs.size() == 0:
		return {}
	var values = {blink = Util.most((found.shut[0] + found.shut[1]) / 2.0, found.blink)}
	for n in range(2):
		var side = "_left" if n == 0 else "_right"
		var left = found.eyes[n][0] / MORPH_LOOK
		var up = found.eyes[n][1] / MORPH_LOOK
		values["blink" + side] = found.shut[n]
		values["wide" + side] = -MORPH_WIDE * found.shut[n]
		values["look_left" + side] = left
		values["look_right" + side] = -left
		values["look_up" + side] = up
		values["look_down" + side] = -up
	for n in range(MOUTH.size()):
		values[MOUTH[n]] = found.channels[LIDS + 1 + n]
	var shown = Expressions.FaceShown.new()
	Expressions.shown_face(shown, graph.life, plan.life.swells, plan.life.emphases, found.bears, time)
	for cue in cues:
		Expressions.answer(shown, graph.life, cue.action.tags, cue.start, cue.end, time)
	Expressions.settle(shown)
	for name in FEELS:
		values[name] = shown[name]
	var out = {}
	for channel in face.morphs:
		var value = values.get(channel, 0.0)
		if value > 1e-4:
			for name in face.morphs[channel]:
				out[name] = out.get(name, 0.0) + value * face.morphs[channel][name]
	for name in out:
		out[name] = Util.least(1.0, out[name])
	return out
