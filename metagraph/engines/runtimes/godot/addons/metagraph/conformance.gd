extends SceneTree
# Checks this runtime against conformance vectors: folders with an export, its GLB and vectors.json.
#
#     godot3-server --no-window -s addons/metagraph/conformance.gd FOLDER...     (Godot 4: godot --headless -s ... -- FOLDER...)
#
# Prints a line for each case that fails and exits with 1; `--only WORD` checks cases whose name has the word.

const CORE = "res://addons/metagraph/core/"
const VERSION = 1
const Answers = preload("core/answers.gd")
const Choice = preload("core/choice.gd")
const Graph = preload("core/graph.gd")
const Asks = preload("core/asks.gd")
const Describe = preload("core/describe.gd")
const Hear = preload("core/hear.gd")
const Mood = preload("core/mood.gd")
const Parameters = preload("core/parameters.gd")
const Planner = preload("core/planner.gd")
const Pose = preload("core/pose.gd")
const SingleRules = preload("core/single_rules.gd")
const SpeechWatch = preload("core/speech_watch.gd")
const SpokenSoFar = preload("core/spoken_so_far.gd")
const StreamedVoice = preload("core/streamed_voice.gd")
const Sympathy = preload("core/sympathy.gd")
const Util = preload("core/util.gd")
const Utterances = preload("core/utterances.gd")
const Turns = preload("core/turns.gd")
const Talk = preload("core/talk.gd")
const WordGestures = preload("core/word_gestures.gd")

var _shim
var _passed = 0
var _failed = 0
var _poses = 0
var _posed = 0  # microseconds
var _planned = 0
var _steps = 0


func _init():
	_shim = load(CORE + "shim%d.gd" % Engine.get_version_info()["major"])
	var only = ""
	var folders = []
	var skip = true
	var args = OS.get_cmdline_args()
	if OS.has_method("get_cmdline_user_args"):
		args = OS.call("get_cmdline_user_args")
		skip = false
	for n in range(args.size()):
		if skip:
			skip = not args[n].ends_with("conformance.gd")
		elif n > 0 and args[n - 1] == "--only":
			only = args[n]
		elif args[n] != "--only":
			folders.append(args[n])
	for folder in folders:
		_check(folder, only)
	if folders.size() == 0:
		_fail("", "which folders? Give them behind the script's name")
	print("%d passed, %d failed" % [_passed, _failed])
	if _poses > 0:
		print("%.2f ms a pose, %.2f ms a step of planning" % [_posed / 1000.0 / _poses, _planned / 1000.0 / Util.most(_steps, 1)])
	quit(1 if _failed > 0 else 0)


func _fail(name, words):
	_failed += 1
	print("FAIL %s: %s" % [name, words])


func _text(path):
	return _shim.text_of(_shim.read_bytes(path))


func _check(folder, only):
	var data = _shim.parse(_text(folder + "/vectors.json"))
	if typeof(data) != TYPE_DICTIONARY or not Util.is_number(data.get("vectors")):
		_fail(folder, "vectors.json cannot be read")
		return
	if data.vectors != VERSION:
		_fail(folder, "the vectors are of version %s, this checks %d" % [str(data.vectors), VERSION])
		return
	var begun = _micros()
	var json = _text(folder + "/" + data.export)
	var found = _shim.parse(json)
	var glb = found.get("glb", "") if typeof(found) == TYPE_DICTIONARY else ""
	var graph = Graph.new(json, _shim.read_bytes(folder + "/" + glb))
	if graph.error != "":
		_fail(folder, graph.error)
		return
	print("%s: read in %.0f ms" % [folder, (_micros() - begun) / 1000.0])
	for each in data.hashes:
		if Choice.key32(int(each[0]), each[1]) != int(each[2]):
			_fail("hashes", str(each))
	if data.has("described"):
		var unlike = _unlike(Describe.describe(graph), data.described, "described", data.tolerance.seconds)
		if unlike != "":
			_fail("described", unlike)
	for sound in data.get("heard", []):
		var voice = StreamedVoice.StreamedVoice.new(float(sound.rate))
		var marks = []
		var seconds = []
		for n in range(sound.pieces.size()):
			voice.follow(sound.said[n])
			var samples = []
			for sample in sound.pieces[n]:
				samples.append(sample / 128.0)
			var told = []
			for mark in voice.hear(samples):
				told.append([mark.at, mark.viseme, mark.weight])
			marks.append(told)
			seconds.append(voice.seconds)
		var apart = _unlike([marks, seconds], [sound.marks, sound.seconds], "heard", data.tolerance.seconds)
		if apart != "":
			_fail("heard", apart)
	for row in data.get("talked", []):
		var wanted = {"sentences": row.sentences, "words": row.words, "asks": row.asks}
		var apart = _unlike(_talk_of(graph.alphabet, row), wanted, "talked", data.tolerance.seconds)
		if apart != "":
			_fail("talked", apart)
	for row in data.get("sympathies", []):
		var apart = _unlike(_sympathies_of(row), [row.taken, row.along], "sympathies", data.tolerance.seconds)
		if apart != "":
			_fail("sympathies", apart)
	for row in data.get("rules", []):
		var numbers = []
		for number in row[2]:
			numbers.append(float(number))
		var answer = SingleRules.answer_rule(graph.alphabet, int(row[1]), row[0], numbers, row[3])
		var apart = _unlike(answer, row[4], "rules, %s" % row[0], data.tolerance.seconds)
		if apart != "":
			_fail("rules", apart)
	var parameters = Parameters.new(graph.parameters)
	for row in data.get("settings", []):
		var made = parameters.request_for(row.name, row.value)
		var now = {}
		for name in graph.parameters:
			now[name] = parameters.value_of(name)
		var apart = _unlike([made[0], made[1], now], [row.request, row.wrong, row.now], "settings", data.tolerance.seconds)
		if apart != "":
			_fail("settings", apart)
	for case in data.cases:
		if only != "" and case.name.find(only) < 0:
			continue
		var wrong = _differences(graph, case, data.tolerance)
		if wrong == "":
			_passed += 1
		else:
			_fail(case.name, wrong)


# Returns what comes of a text: its sentences, words and gestures.
func _talk_of(alphabet, row):
	var sentences = []
	var letters = alphabet.letters(row.text)
	var end = WordGestures.sentence_end(alphabet, letters, true)
	while end > 0:
		sentences.append(Util.joined(Util.part(letters, 0, end), ""))
		letters = Util.part(letters, end, letters.size())
		end = WordGestures.sentence_end(alphabet, letters, true)
	var told = []
	for one in row.told:
		told.append(WordGestures.ToldWord.new(one[0], one[1]))
	var found = WordGestures.words_of(alphabet, row.text, told, row.seconds)
	var both = Talk.lexicon_of(row.language)
	var arms = {}
	for tag in row.arms:
		arms[tag] = true
	var made = WordGestures.proposed_for(found, arms, row.head, both[0], both[1], int(row["seed"]))
	var words = []
	for w in found:
		words.append([w.text, w.plain, w.start, w.end, w.mark])
	var asks = []
	for ask in WordGestures.gesture_asks(made, row.at):
		asks.append([ask.do, ask.layer, ask.tags, ask.at, ask.stroke, ask.late])
	return {"sentences": sentences, "words": words, "asks": asks}


# Returns what is taken up of another's moods, and whose laughs are joined in.
func _sympathies_of(row):
	var own = Mood.Moods.new(Mood.Mood.new(row.base[0], row.base[1], row.base[2]), _told_of(row.own))
	var others = Mood.Moods.new(Mood.Mood.new(), _told_of(row.others))
	var laughs = []
	for one in row.laughs:
		laughs.append(Sympathy.Laugh.new(one[0], one[1]))
	var out = []
	for moods in [
		Sympathy.moods_taken_up(own, others, row.end, row.share, int(row["seed"]), row.who),
		Sympathy.laughs_along(own, laughs, row.share, int(row["seed"]), row.who)
	]:
		var rows = []
		for m in moods:
			rows.append([m.id, m.start, m.valence, m.arousal, m.end])
		out.append(rows)
	return out


func _told_of(rows):
	var out = []
	for x in rows:
		out.append(Mood.MoodFrom.new("told", x[0], x[1], x[2], null, x[3]))
	return out


# Looks at what is said: after a step of a case, or later. watch: what was seen so far.
func _look(watch, graph, plan, now, asks):
	var speeches = plan.track.speeches
	var ids = []
	for ask in asks:
		ids.append(ask.id)
		if ask.do == "say" and not watch.said.has(ask.id):
			watch.said.append(ask.id)
	var spoken = []
	for id in watch.said:
		var told = SpokenSoFar.spoken_until(graph.alphabet, speeches, id, now)
		if told[0] != "":
			spoken.append([id, told[0], told[1]])
	var events = []
	for e in watch.speech.watch(speeches, watch.seen, now):
		events.append([e.kind, e.at, e.id, e.said, e.reason])
	var answers = []
	for a in Answers.answers(plan, ids).values():
		answers.append([a.id, a.state, _maybe(a.at), _maybe(a.until), a.what])
	var silent = Utterances.find_forgotten(plan.track, now)
	watch.rows.append({now = now, events = events, spoken = spoken, silent = silent, answers = answers})
	watch.seen = now


func _maybe(seconds):
	return null if seconds == null or seconds > 1e8 else seconds


func _micros():
	return _shim.micros()


# Returns how what this runtime makes of a case differs, "" where it does not.
func _differences(graph, case, tolerance):
	var plan = Planner.empty_plan(int(case["seed"]))
	var unread = []
	var watched = case.get("watched", [])
	var watch = {speech = SpeechWatch.SpeechWatch.new(), seen = -1.0, said = [], rows = []}
	for step in case.steps:
		var asks = []
		for data in step.asks:
			var ask = Asks.read(data)
			if ask[0] == null:
				var at = step.now + graph.settings.lookahead if step.now > 0 else 0.0
				var told = {request = data.id, outcome = "not-understood", layer = "arms", at = at, played = false}
				unread.append(told)
			else:
				asks.append(ask[0])
		var begun = _micros()
		plan = Hear.hear(graph, plan, step.now, asks, step.end, case.stances, case.idle)
		if watched.size() > 0:
			_look(watch, graph, plan, step.now, step.asks)
		if step.forget != null:
			plan = Planner.since(plan, step.forget)
		_planned += _micros() - begun
		_steps += 1
	for n in range(case.steps.size(), watched.size()):
		_look(watch, graph, plan, watched[n].now, [])
	var wrong = _unlike(watch.rows, watched, "watched", tolerance.seconds)
	if wrong == "":
		wrong = _unlike(_plan_data(plan, unread), case.plan, "plan", tolerance.seconds)
	if wrong == "":
		wrong = _unlike(_life_data(plan.life, case.life), case.life, "life", tolerance.seconds)
	for expected in case.poses:
		if wrong == "":
			wrong = _apart(graph, plan, expected, tolerance)
	return wrong


func _plan_data(plan, unread):
	var layers = {}
	for layer in Util.LAYERS:
		var of = plan.layers[layer]
		var metas = []
		for m in of.metas:
			metas.append([m.key, m.start, m.end, m.written])
		var cues = []
		for c in of.cues:
			cues.append({
				action = c.action.id, start = c.start, end = c.end, entry = c.entry, blend_in = c.blend_in, blend_out = c.blend_out,
				stance = c.stance, then = c.then, meta = c.meta, hold_from = c.hold_from, hold_to = c.hold_to, hold = c.hold
			})
			if c.extent != 1:
				cues[-1].extent = c.extent
			if c.tempo != 1:
				cues[-1].tempo = c.tempo
			if c.repeats:
				cues[-1].cycle_from = c.cycle_from
				cues[-1].cycle_to = c.cycle_to
		var rests = []
		for r in of.rests:
			rests.append([r.stance, r.action.id, r.start, r.fade_start, r.fade])
		layers[layer] = {metas = metas, cues = cues, rests = rests}
	var reports = []
	var keys = []
	for r in plan.reports + unread:
		reports.append([r.request, r.outcome, r.layer, r.at, r.played])
		keys.append([r.request, r.outcome, r.layer, r.at])
	return {layers = layers, reports = Util.ordered(reports, keys)}


func _life_data(life, expected):
	var out = {targets = []}
	for t in life.targets:
		out.targets.append([t.start, t.to, t.since, t.amount, t.strict, t.asked])
	for name in ["modes", "breaths", "aversions", "saccades", "blinks", "swells", "emphases"] + (["moods"] if expected.has("moods") else []):
		out[name] = []
		for n in range(life[name].times.size()):
			out[name].append([life[name].times[n]] + life[name].rows[n])
	return out


func _unlike(ours, theirs, where, seconds):
	if Util.is_number(ours) and Util.is_number(theirs):
		return "" if abs(ours - theirs) <= seconds else "%s: %s instead of %s" % [where, str(ours), str(theirs)]
	if typeof(ours) != typeof(theirs):
		return "%s: %s instead of %s" % [where, str(ours), str(theirs)]
	if typeof(ours) == TYPE_ARRAY:
		for n in range(Util.least(ours.size(), theirs.size())):
			var wrong = _unlike(ours[n], theirs[n], "%s[%d]" % [where, n], seconds)
			if wrong != "":
				return wrong
		return "" if ours.size() == theirs.size() else "%s: %d instead of %d" % [where, ours.size(), theirs.size()]
	if typeof(ours) == TYPE_DICTIONARY:
		if ours.size() != theirs.size():
			return "%s: %s instead of %s" % [where, str(ours.keys()), str(theirs.keys())]
		for name in theirs:
			var wrong = _unlike(ours.get(name), theirs[name], "%s.%s" % [where, name], seconds)
			if wrong != "":
				return wrong
		return ""
	return "" if ours == theirs else "%s: %s instead of %s" % [where, str(ours), str(theirs)]


func _apart(graph, plan, expected, tolerance):
	var begun = _micros()
	var pose = Pose.pose_at(graph, plan, expected.time, expected.alive)
	_posed += _micros() - begun
	_poses += 1
	var places = Pose.positions(graph, pose)
	for joint in range(graph.names.size()):
		var far = places[joint].distance_to(Util.vector(expected.positions[joint]))
		var d = Turns.back(pose.rotations[joint]) * Util.quaternion(expected.rotations[joint], _shim)
		var turn = 2.0 * atan2(Vector3(d.x, d.y, d.z).length(), abs(d.w)) * 180.0 / PI
		if not (far <= tolerance.metres and turn <= tolerance.degrees):
			return "pose at %s s: %s is %f m and %f degrees apart" % [str(expected.time), graph.names[joint], far, turn]
	for name in pose.morphs.keys() + expected.morphs.keys():
		if not abs(pose.morphs.get(name, 0.0) - expected.morphs.get(name, 0.0)) <= tolerance.weight:
			return "pose at %s s: morph target %s is %s" % [str(expected.time), name, str(pose.morphs.get(name))]
	return ""
