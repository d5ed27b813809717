# How a mood shows: which actions become likelier, how large and fast they are played, and what it makes of breath, blinks, gaze,
# posture and face.
#
# A mood is a point in Russell's circumplex (1980): valence, how pleasant, and arousal, how excited, both -1..1; with it, an
# intensity, 0..2; 1 is normal. Neutral (0, 0, 1) changes nothing, to the last digit: every factor is 1 and every offset is 0.
#
# What is known and followed here: arousal goes with the speed, acceleration and jerk of movements (Pollick et al. 2001, of arms
# that knock and drink); elated joy and hot anger are expansive and full of movement, sadness and boredom neither (Wallbott 1998);
# the sad walk slowly, with small movements and bowed heads (Roether et al. 2009). Anger and fear lie close together here, at 99
# and 116 degrees; people tell them apart by power (Fontaine et al. 2007). So here, mild unpleasant excitement is anger and strong
# unpleasant excitement is fear: the body draws back (Coulson 2004), with the shoulders up and the arms close. Faces follow the
# prototypes of FACS (Ekman and Friesen 1978): fear 1+2+4+5+20, anger 4+5+7+23, joy 6+12, sadness 1+4+15. The amounts (the numbers
# below) are ours, chosen so that every clip still looks natural.
#
# Translated from metagraph/playback/planning/mood.py; change that, and translate anew.

const Choice = preload("choice.gd")
const Util = preload("util.gd")
const FADE = 1.5  # seconds in which posture and face go from one mood to the next
const LEAST_EXTENT = 0.6
const MOST_EXTENT = 1.25
const LEAST_TEMPO = 0.75
const MOST_TEMPO = 1.25
const CLOSE = 0.5  # an action that is tagged with a mood no farther away than this was made for it
const PLEASANT = "positive"  # tags
const UNPLEASANT = "negative"
const ANGRY_FROM = 0.02  # unpleasantness from which an excited mood is angry
const ANGRY_WIDE = 0.1  # and by how much more it is altogether
const FEAR_FROM = 0.15  # the same of fear
const FEAR_WIDE = 0.18
const HELD = "contact"  # tag of actions that touch something: smaller or larger they would miss it
# Named moods: valence, arousal. Directions are Russell's (1980, table of 28 words, by circular scaling): calm
# 316.2, content 323, happy 7.8, excited 48.6, tense 92.8, angry 99, afraid 116, sad 207.5, bored 242 and
# tired 267.7 degrees, at 0.8 from the middle, which is ours. "warm" is ours.
const MOODS = {
	"neutral": [0.0, 0.0],
	"calm": [0.58, -0.55],
	"content": [0.64, -0.48],
	"warm": [0.6, 0.1],
	"happy": [0.79, 0.11],
	"excited": [0.53, 0.6],
	"tense": [-0.04, 0.8],
	"angry": [-0.13, 0.79],
	"afraid": [-0.35, 0.72],
	"sad": [-0.71, -0.37],
	"bored": [-0.38, -0.71],
	"tired": [-0.03, -0.8]
}


# valence, arousal: -1..1. intensity: 0..2, 1 is normal.
class Mood:
	var valence
	var arousal
	var intensity
	var neutral  # Whether it changes nothing.

	func _init(valence_ = 0.0, arousal_ = 0.0, intensity_ = 1.0):
		self.valence = valence_
		self.arousal = arousal_
		self.intensity = intensity_
		self.neutral = self.valence == 0 and self.arousal == 0 and self.intensity == 1

	# Whether it is the same.
	func like(other):
		return self.valence == other.valence and self.arousal == other.arousal and self.intensity == other.intensity


# A mood that holds from `start` until `end`; a field that it leaves out stays as it is without it. If two hold at once, the one
# that began later counts. When it is over, the other counts again.
class MoodFrom:
	var id
	var start
	var valence
	var arousal
	var intensity
	var end

	func _init(id_, start_, valence_ = null, arousal_ = null, intensity_ = null, end_ = INF):
		self.id = id_
		self.start = start_
		self.valence = valence_
		self.arousal = arousal_
		self.intensity = intensity_
		self.end = end_


# The mood over time. base: the mood where no other holds; told: the others, by start.
class Moods:
	var base
	var told

	func _init(base_ = null, told_ = null):
		self.base = base_ if base_ != null else Mood.new()
		self.told = told_ if told_ != null else []


# The factors by which a mood changes the amounts and rates of the life layers, as those of a manner.
class LifeMood:
	var breathing
	var breath_rate
	var aversion_rate
	var saccade_rate
	var blinks

	func _init(breathing_, breath_rate_, aversion_rate_, saccade_rate_, blinks_):
		self.breathing = breathing_
		self.breath_rate = breath_rate_
		self.aversion_rate = aversion_rate_
		self.saccade_rate = saccade_rate_
		self.blinks = blinks_


# Posture and face of a mood. droop: -0.4 upright .. 1 bowed. lift: of the shoulders, in breaths. lids: how far they hang, 0..1,
# or are open wide, below 0. smile, frown, brow_down, brow_up, brows: weights of the face, 0..1. thrust: how far the body leans
# forward, 0..1, or draws back, below 0. tension: of shoulders, arms and hands, 0..1. closed: how close the arms are kept, 0..1.
class Bearing:
	var droop
	var lift
	var lids
	var smile
	var frown
	var brow_down
	var brow_up
	var thrust
	var tension
	var brows
	var closed

	func _init(
		droop_ = 0.0,
		lift_ = 0.0,
		lids_ = 0.0,
		smile_ = 0.0,
		frown_ = 0.0,
		brow_down_ = 0.0,
		brow_up_ = 0.0,
		thrust_ = 0.0,
		tension_ = 0.0,
		brows_ = 0.0,
		closed_ = 0.0
	):
		self.droop = droop_
		self.lift = lift_
		self.lids = lids_
		self.smile = smile_
		self.frown = frown_
		self.brow_down = brow_down_
		self.brow_up = brow_up_
		self.thrust = thrust_
		self.tension = tension_
		self.brows = brows_
		self.closed = closed_


# Return a mood with the given fields changed, each limited to its range.
static func changed(mood, valence, arousal, intensity):
	return Mood.new(
		mood.valence if valence == null else within(valence, -1.0, 1.0),
		mood.arousal if arousal == null else within(arousal, -1.0, 1.0),
		mood.intensity if intensity == null else within(intensity, 0.0, 2.0)
	)


# Return the mood that holds at a time; posture and face follow it slowly (`shown`).
static func mood_at(moods, seconds):
	var out = moods.base
	for told in moods.told:
		if told.start > seconds:
			break
		if seconds < told.end:
			out = changed(out, told.valence, told.arousal, told.intensity)
	return out


# Return the moods that may still show at `seconds` or later: without those that are over and have faded, and without those that a
# mood without an end has replaced.
static func lasting(told, seconds):
	var out = []
	for place in range(told.size()):
		var one = told[place]
		if one.end <= seconds - FADE:
			continue
		var is_any = false
		for other in Util.part(told, place + 1, told.size()):
			if _replaces(other, one, seconds):
				is_any = true
				break
		if not is_any:
			out.append(one)
	return out


static func _replaces(later, one, seconds):
	return (later.end == INF
		and later.start <= seconds - FADE
		and (one.valence == null or later.valence != null)
		and (one.arousal == null or later.arousal != null)
		and (one.intensity == null or later.intensity != null))


# Return the times from `start` to before `end` at which the mood may change, ascending, `start` first.
static func mood_edges(moods, start, end):
	var edges = [start]
	for told in moods.told:
		for edge in [told.start, told.end]:
			if start < edge and edge < end and not edges.has(edge):
				edges.append(edge)
	return Util.in_order(edges)


# Return how much of a change shows after `x` of its fade: 3x^2 - 2x^3 of x clamped to 0..1.
static func faded(x):
	var y = within(x, 0.0, 1.0)
	return y * y * (3 - 2 * y)


# Return the mood that shows at a time, while it fades from the previous ones. starts: when each begins, ascending; values:
# valence, arousal, intensity of each. Before the first it is the first.
static func shown(starts, values, seconds):
	var place = starts.size() - 1
	while place > 0 and starts[place] > seconds:
		place -= 1
	if place < 0:
		return Mood.new()
	var valence = 0.0
	var arousal = 0.0
	var intensity = 0.0
	var left = 1.0
	while left > 0:
		var share = left
		if place > 0:
			share = Util.least(left, faded((seconds - starts[place]) / FADE) - (1 - left))
		valence += share * values[place][0]
		arousal += share * values[place][1]
		intensity += share * values[place][2]
		left -= share
		place -= 1
	return Mood.new(valence, arousal, intensity)


# Return a number clamped to a range.
static func within(x, low, high):
	return Util.least(Util.most(x, low), high)


# Return 1 at 0, `most` at 1 and 1 / `most` at -1, and beyond as there; smooth and rising.
static func leaning(x, most):
	var y = within(x, -1.0, 1.0) * (most - 1) / (most + 1)
	return (1 + y) / (1 - y)


# Return how lively a mood is, -1..1: its arousal, plus some if it is pleasant, less if it is unpleasant and not exciting.
static func liveliness(mood):
	var well = Util.most(0.0, mood.valence)
	var ill = Util.most(0.0, -mood.valence)
	var calm = 1 - Util.most(0.0, mood.arousal)
	return within(mood.arousal + 0.5 * well - 0.6 * ill * calm, -1.0, 1.0)


# Return how afraid a mood is, 0..1.
static func fear(mood):
	var much = Util.least(1.0, 1.25 * Util.most(0.0, mood.arousal))
	return much * faded((-mood.valence - FEAR_FROM) / FEAR_WIDE)


# Return how angry a mood is, 0..1.
static func anger(mood):
	var much = Util.least(1.0, 1.25 * Util.most(0.0, mood.arousal))
	return much * faded((-mood.valence - ANGRY_FROM) / ANGRY_WIDE) - fear(mood)


# Return how large gestures and fidgets of arms and head are played: a factor of their turns away from the stance.
static func extent(mood):
	var size = within(liveliness(mood) - 1.5 * fear(mood), -1.0, 1.0)
	var by_mood = 1 + 0.25 * size if size > 0 else 1 + 0.4 * size
	var dial = mood.intensity - 1
	var by_dial = 1 + 0.25 * dial if dial > 0 else 1 + 0.4 * dial
	return within(by_mood * by_dial, LEAST_EXTENT, MOST_EXTENT)


# Return how fast actions are played: a factor of their own speed.
static func tempo(mood):
	return within(1 + 0.25 * liveliness(mood), LEAST_TEMPO, MOST_TEMPO)


# Return how much longer clip seconds take at a speed than at their own speed, exactly 0 at that speed.
static func drag(seconds, speed):
	return seconds * ((float(1) / speed) - 1)


# Return how far a joint turns away from its stance, a factor, for that of a cue. real: the real part of the original rotation, a
# unit quaternion. Rotations of nearly half a circle, whose short way changes sides, stay as they are.
static func turn_extent(factor, real):
	return 1 + (factor - 1) * faded((Util.absolute(real) - 0.1) / 0.4)


# Return whether an action was made for a mood: whether it has the tag of a mood that is near.
static func made_for(mood, tags):
	var is_any = false
	for tag in tags:
		if MOODS.has(tag) and distance(mood, tag) <= CLOSE:
			is_any = true
			break
	return is_any


# Return how far a mood is from a named one, 0..2.8.
static func distance(mood, name):
	var both = MOODS[name]
	var valence = both[0]
	var arousal = both[1]
	var x = mood.valence - valence
	var y = mood.arousal - arousal
	return sqrt(x * x + y * y)


# Return the factor of an action's likelihood. vigour: how energetic it is compared with others of its layer and kind, -1..1. The
# factor is up to 4 for vigour, 4 for a tag of valence and 9 for a tag that names a mood, and the inverse if they contradict the
# mood.
static func favour(mood, tags, vigour):
	var out = leaning(vigour * within(liveliness(mood) + (mood.intensity - 1), -1.0, 1.0), 4.0)
	if tags.has(PLEASANT):
		out *= leaning(mood.valence, 4.0)
	if tags.has(UNPLEASANT):
		out *= leaning(-mood.valence, 4.0)
	var strength = Util.least(1.0, sqrt(mood.valence * mood.valence + mood.arousal * mood.arousal) / CLOSE)
	for tag in tags:
		if MOODS.has(tag):
			out *= leaning(strength * (1 - distance(mood, tag) / CLOSE), 9.0)
	return out


# Return whether something that a model wrote is performed in a mood: less of it in a less lively mood, down to 0.6.
static func stirs(mood, seed_, key):
	var lively = liveliness(mood)
	return lively >= 0 or Choice.uniform(seed_, [key, "mood"]) < 1 + 0.4 * lively


# Return how a mood changes the life layers. With arousal, breath is quicker and deeper, and eyes dart and blink more. In an
# unpleasant mood the character looks away more, in a pleasant one less. The amounts are ours.
static func life_of(mood):
	var a = mood.arousal
	var v = mood.valence
	return LifeMood.new(
		1 + 0.25 * a,
		1 + 0.4 * a if a > 0 else 1 + 0.25 * a,
		1 - 0.4 * v if v < 0 else 1 - 0.25 * v,
		1 + 0.4 * a,
		1 + 0.4 * a if a > 0 else 1 + 0.25 * a
	)


# Return posture and face of a mood, stronger with its intensity. The head bows with sadness (Roether et al. 2009); shoulders
# rise, fists close and the body leans forward with arousal that is not joy; fear draws back (Coulson 2004); the amounts are ours.
static func bearing(mood):
	var v = mood.valence
	var a = mood.arousal
	var i = mood.intensity
	var up = Util.most(0.0, a)
	var down = Util.most(0.0, -a)
	var well = Util.most(0.0, v)
	var ill = Util.most(0.0, -v)
	var scared = fear(mood)
	var cross = anger(mood)
	return Bearing.new(
		within(i * (-0.7 * v - 0.5 * a), -0.4, 1.0),
		within(i * (2.0 * up * (1 - well) + 4.5 * scared - 1.5 * down - ill * (1 - up)), -2.0, 6.0),
		within(i * (0.5 * down - 0.5 * scared - 0.15 * cross - 1.1 * up * well), -0.6, 0.5),
		within(i * well * (1.2 + 0.3 * up - 0.6 * down), 0.0, 1.0),
		within(i * (1.4 * ill * (1 - up) * (1 - 0.6 * down) + 0.35 * cross + 0.4 * scared), 0.0, 1.0),
		within(i * (0.5 * up * Util.most(0.0, 0.4 - v) + 0.8 * cross) * (1 - scared), 0.0, 1.0),
		within(i * (2.0 * ill * (1 - up) * (1 - down) + 0.9 * scared), 0.0, 1.0),
		within(i * (0.3 * up * Util.most(0.0, 0.3 - v) + 0.9 * cross - 0.7 * scared), -1.0, 1.0),
		within(i * 1.2 * up * Util.most(0.0, 1.0 - 2.0 * well) * (1 - 0.8 * scared), 0.0, 1.0),
		within(i * (0.6 * scared + 1.6 * up * well), 0.0, 1.0),
		within(i * (0.5 * scared + 0.4 * ill * (1 - up)), 0.0, 1.0)
	)


# Return how far lids are shut: as far as a blink shuts them or, if they hang farther, as far as they do; below 0 where they are
# open wide.
static func shut_in(blink, lids):
	return Util.most(blink, lids) if lids > 0 else blink + lids * (1 - blink)
