# Which shape the mouth has: the voices of what is said, at any time.

const Items = preload("items.gd")
const Mouth = preload("mouth.gd")
const Util = preload("util.gd")
const Voice = preload("voice.gd")
const Words = preload("words.gd")
const CLOSING = 0.12  # seconds the mouth takes to close where speech was cut


# Returns how much of each shape but silence the mouth shows at a time [14]; null where nothing is said.
static func mouth(graph, track, smoothing, time):
	var out = null
	for speech in track.speeches:
		if time > speech.start - smoothing and time < speech.end + CLOSING + smoothing:
			if out == null:
				out = []
				for _n in range(Words.VISEMES.size() - 1):
					out.append(0.0)
			var voice = Voice.of(graph, speech)
			var now = _shown(speech, voice, time)
			if smoothing > 0:
				var soft = now.duplicate()
				Mouth.soften(soft, _shown(speech, voice, time - smoothing), now, _shown(speech, voice, time + smoothing))
				now = soft
			for n in range(out.size()):
				out[n] += now[n]
	if out != null:  # two speeches may meet; together they are one mouth
		var whole = 0.0
		for weight in out:
			whole += weight
		if whole > 1.0:
			for n in range(out.size()):
				out[n] /= whole
	return out


# Returns a speech's shapes at a time.
static func _shown(speech, voice, time):
	var out = []
	for _n in range(Words.VISEMES.size() - 1):
		out.append(0.0)
	if time < speech.start:
		return out
	var rows = voice.weights
	var step = Util.most(voice.duration, 1e-3) / (rows.size() - 1)
	var at = (Util.least(time, speech.end) - Items.find_line_start(speech)) / step
	var low = int(Util.within(floor(at), 0.0, rows.size() - 2.0))
	var part = Util.within(at - low, 0.0, 1.0)
	var kept = 1.0 - Util.smooth((time - speech.end) / CLOSING)
	for n in range(out.size()):
		out[n] = kept * (rows[low][n + 1] * (1.0 - part) + rows[low + 1][n + 1] * part)
	return out
