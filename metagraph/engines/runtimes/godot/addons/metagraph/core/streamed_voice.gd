# The mouth shapes of a voice, detected from its samples as they come in, from the levels of four bands relative to the loudest so
# far. The only delay is the shortest length of a shape, so every engine can analyse the sound that it plays.
#
# Open vowels have more energy around 800 Hz, the first formant of an open mouth, than around 300 Hz. Front vowels have more
# around 2200 Hz, their second formant. Sibilants have most above 3500 Hz. The bounds are ours, chosen by comparison with the
# results of `speech.sound` on whole recordings.
#
# Translated from metagraph/playback/life/streamed_voice.py; change that, and translate anew.

const LineTiming = preload("line_timing.gd")
const Util = preload("util.gd")
const HOP = 0.01  # seconds that are judged together
const HERTZ = [300.0, 800.0, 2200.0, 5000.0]  # middles of the bands
const QUALITY = [0.7, 1.0, 1.0, 0.7]  # and how narrow they are
const HIGHEST = 0.42  # of the rate: bands higher than this are left out
const LOUDEST = -32.0  # dB of full scale: a voice is taken to be at least as loud as this
const FORGET = 3.0  # dB a second by which the loudest is forgotten
const SHUT = -25.0  # dB beside the loudest: softer than this the mouth is shut
const SONOROUS = -16.0  # louder than this it is open
const HISSING = -33.0  # softer than this nothing hisses
const HISS = 3.0  # dB by which the highest band is above the lower ones where it does
const OPEN = -1.7  # dB of the second band beside the first: an open mouth, and
const HALF = -5.0  # half open
const FRONT_HALF = -6.0  # dB of the third band beside the second: the tongue is in front, of half open mouths
const FRONT = -8.5  # and of others
const LEAST = 0.03  # seconds: anything shorter is not a shape
const STEP = 0.06  # seconds after which a shape that gets stronger or weaker
const GROWS = 0.15  # by this much is reported again
const BEHIND = 0.25  # seconds by which a piece may come late; a later one is heard when it comes


# The state of a voice that is analysed. rate: samples a second, 8000 or more. seconds: how much of it was heard. missed: seconds
# of the line in which no sound came. The other fields are memory.
class StreamedVoice:
	var rate
	var seconds
	var missed
	var shape
	var told
	var weight
	var coming
	var since
	var loudest
	var judged
	var inside
	var filters
	var memory
	var energy

	func _init(
		rate_,
		seconds_ = 0.0,
		missed_ = 0.0,
		shape_ = "sil",
		told_ = 0.0,
		weight_ = 1.0,
		coming_ = "sil",
		since_ = 0.0,
		loudest_ = -120.0,
		judged_ = 0,
		inside_ = 0,
		filters_ = null,
		memory_ = null,
		energy_ = null
	):
		self.rate = rate_
		self.seconds = seconds_
		self.missed = missed_
		self.shape = shape_
		self.told = told_
		self.weight = weight_
		self.coming = coming_
		self.since = since_
		self.loudest = loudest_
		self.judged = judged_
		self.inside = inside_
		self.filters = filters_ if filters_ != null else []
		self.memory = memory_ if memory_ != null else []
		self.energy = energy_ if energy_ != null else []

	# Analyse the next samples, -1..1; return the shapes that begin in them: visemes of the set "oculus", at seconds from the
	# line's start.
	func hear(samples):
		var out = []
		if self.filters.size() == 0:
			self._begin()
		var size = Util.most(1, int(HOP * self.rate))
		var count = self.energy.size()
		for sample in samples:
			for band in range(count):
				# A band-pass of two poles, in the transposed direct form II.
				var f = 3 * band
				var m = 2 * band
				var y = self.filters[f] * sample + self.memory[m]
				self.memory[m] = self.memory[m + 1] - self.filters[f + 1] * y
				self.memory[m + 1] = -self.filters[f] * sample - self.filters[f + 2] * y
				self.energy[band] = self.energy[band] + y * y
			self.inside += 1
			if self.inside == size and self._judge(size):
				out.append(LineTiming.VisemeMark.new(self.told + self.missed, self.shape, self.weight))
		self.seconds = (float(self.judged * size + self.inside) / self.rate) + self.missed
		return out

	# Skip to where the line is if its sound came too late. said: seconds of the line that are over.
	func follow(said):
		if self.seconds < said - BEHIND:
			self.missed += said - self.seconds
			self.seconds = said

	func _begin():
		for n in range(HERTZ.size()):
			var hertz = HERTZ[n]
			var quality = QUALITY[n]
			if hertz <= HIGHEST * self.rate:
				var turn = 2.0 * PI * hertz / self.rate
				var wide = sin(turn) / (2.0 * quality)
				self.filters.append(wide / (1.0 + wide))
				self.filters.append(-2.0 * cos(turn) / (1.0 + wide))
				self.filters.append((1.0 - wide) / (1.0 + wide))
				self.memory.append(0.0)
				self.memory.append(0.0)
				self.energy.append(0.0)

	# Classify the last moment; return whether a shape begins or changes, at `told`.
	func _judge(size):
		var now = (float(self.judged * size) / self.rate)
		var levels = []
		for energy in self.energy:
			levels.append(10.0 / log(10.0) * log(energy / size + 1e-12))
		for band in range(self.energy.size()):
			self.energy[band] = 0.0
		self.inside = 0
		self.judged += 1
		var voiced = Util.most(levels[0], Util.most(levels[1], levels[2]))
		self.loudest = Util.most(voiced, Util.most(LOUDEST, self.loudest - FORGET * size / self.rate))
		var shape = self._shape_of(levels)
		if shape != self.coming:
			self.coming = shape
			self.since = now
		var weight = 1.0
		if shape != "sil" and shape != "SS" and shape != "nn":
			weight = 0.35 + 0.65 * Util.least(1.0, Util.most(0.0, 1.0 + (voiced - self.loudest) / -SONOROUS))
		var begins = shape != self.shape and now + (float(size) / self.rate) - self.since >= LEAST
		if begins or (shape == self.shape and Util.absolute(weight - self.weight) >= GROWS and now - self.told >= STEP):
			self.shape = shape
			self.told = self.since if begins else now
			self.weight = weight
			return true
		return false

	# Return the shape of a moment. levels: dB of the bands, without the highest band at low rates.
	func _shape_of(levels):
		var low = levels[0]
		var middle = levels[1]
		var high = levels[2]
		if levels.size() > 3 and levels[3] > self.loudest + HISSING and levels[3] > Util.most(low, middle) + HISS:
			return "SS"
		var loud = Util.most(low, Util.most(middle, high)) - self.loudest
		if loud < SHUT:
			return "sil"
		if loud < SONOROUS:
			return "nn"
		if middle - low > OPEN:
			return "aa"
		if middle - low > HALF:
			return "E" if high - middle > FRONT_HALF else "O"
		return "I" if high - middle > FRONT else "U"
