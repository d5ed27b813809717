# One clip's motion, resampled frame by frame where it is first needed, as offsets from the base pose.
#
# A frame is {turns [J]: base^-1 * rotation, shifts {joint: translation less the base's, metres}, morphs {name: weight}}.

const Util = preload("util.gd")
const Turns = preload("turns.gd")
const MOST_FRAMES = 4096  # that all clips of a graph keep together, some 10 MB at 60 joints; then they are made anew

var fps
var frames
var moving = []  # joints whose rotation changes
var morphs = false  # whether it moves morph targets
var _glb
var _shim
var _name
var _base_rotations
var _base_translations
var _still = []  # [J] turns of joints that do not move
var _shifts = {}  # of those
var _turning = []  # [joint, times, view]
var _shifting = []
var _morphing = []  # [names, times, view]
var _kept  # frames of all clips, by clip and number


# channels: of the GLB's animation. nodes {node: joint}. pose: the nodes' rotations and translations, then the base pose's.
func _init(glb, channels, nodes, clip, pose, kept, shim):
	_glb = glb
	_shim = shim
	_name = clip.id
	_kept = kept
	_base_rotations = pose[2]
	_base_translations = pose[3]
	fps = clip.fps
	frames = int(clip.frames)
	for joint in range(pose[0].size()):
		_still.append(_turn(joint, pose[0][joint]))
		_shift(_shifts, joint, pose[1][joint])
	for channel in channels:
		var times = glb.numbers(channel.times)
		var view = glb.view(channel.rows)
		var joint = nodes.get(channel.node, -1)
		if channel.path == "weights":
			var names = glb.morphs_of(channel.node)
			if names.size() > 0:
				_morphing.append([names, times, view])
				morphs = true
		elif joint < 0:
			continue
		elif channel.path == "rotation":
			if times.size() > 1:
				moving.append(joint)
				_turning.append([joint, times, view])
			else:
				_still[joint] = _turn(joint, _rotation(view, 0))
		elif channel.path == "translation":
			if times.size() > 1:
				_shifting.append([joint, times, view])
			else:
				_shift(_shifts, joint, _translation(view, 0))


# Returns frame n.
func frame(n):
	var key_of = "%s/%d" % [_name, n]
	if _kept.has(key_of):
		return _kept[key_of]
	if _kept.size() >= MOST_FRAMES:
		_kept.clear()
	var seconds = n / float(fps)
	var out = {turns = _still.duplicate(), shifts = _shifts.duplicate(), morphs = {}}
	for track in _turning:
		var key = _between(track[1], seconds)
		var q = _rotation(track[2], key[0])
		if key[1] > 0:
			q = Turns.slerp(q, _rotation(track[2], key[0] + 1), key[1])
		out.turns[track[0]] = _turn(track[0], q)
	for track in _shifting:
		var key = _between(track[1], seconds)
		var t = _translation(track[2], key[0])
		if key[1] > 0:
			t = t + (_translation(track[2], key[0] + 1) - t) * key[1]
		_shift(out.shifts, track[0], t)
	for track in _morphing:
		var key = _between(track[1], seconds)
		var count = track[0].size()
		var low = _glb.row(track[2], key[0], count)
		var high = _glb.row(track[2], key[0] + 1, count) if key[1] > 0 else low
		for i in range(count):
			out.morphs[track[0][i]] = low[i] + (high[i] - low[i]) * key[1]
	_kept[key_of] = out
	return out


# Returns [frame before, frame behind, the part of the way between them] at clip seconds, clamped to the clip.
func locate(seconds):
	var at = Util.within(seconds * fps, 0.0, frames - 1.0)
	var low = int(Util.least(floor(at), Util.most(0, frames - 2)))
	return [low, Util.least(low + 1, frames - 1), at - low]


# Returns [the last key at or before a time, the part of the way to the next].
static func _between(times, seconds):
	var n = Util.most(0, Util.right_of(times, seconds) - 1)
	if n + 1 >= times.size():
		return [n, 0.0]
	return [n, Util.within((seconds - times[n]) / Util.most(times[n + 1] - times[n], 1e-9), 0.0, 1.0)]


func _turn(joint, q):
	return (Turns.back(_base_rotations[joint]) * q).normalized()


func _shift(into, joint, t):
	var away = t - _base_translations[joint]
	if away.length() > 1e-7:
		into[joint] = away
	else:
		into.erase(joint)


func _rotation(view, n):
	var r = _glb.row(view, n, 4)
	return _shim.quat(r[0], r[1], r[2], r[3]).normalized()


func _translation(view, n):
	var r = _glb.row(view, n, 3)
	return Vector3(r[0], r[1], r[2])
