# How a listener takes up the mood of its partner and laughs along. The result is moods, which posture, face and life show like
# any others.
#
# What is known and followed here: faces take up others' expressions weakly, within about a second of seeing them (Dimberg 1982),
# as far as they are friendly: happy and sad ones, hardly angry ones (Hess and Fischer 2013); laughter brings smiles and laughter,
# often but not always (Provine 1992). How much, how late and how often is ours. Neutral moods are not taken up: a character with
# a mood of its own keeps it in front of a calm face.
#
# Translated from metagraph/playback/life/sympathy.py; change that, and translate anew.

const Choice = preload("choice.gd")
const Mood = preload("mood.gd")
const Util = preload("util.gd")
const DELAY = 0.7  # seconds until a mood is taken up, at least; as much again by chance
const SHORTEST = 0.5  # seconds: what passes sooner is not taken up
const HOSTILE = 0.4  # of how much, for moods that are unpleasant and excited
# Laughing along.
const LAUGH_DELAY = 0.25  # seconds, at least; as much again by chance
const LAUGH_LASTS = 2.6  # seconds, at least
const LAUGH_RINGS = 1.0  # seconds a smile stays after the other's laugh, at least; as much again by chance
const LAUGH_VALENCE = 0.9
const LAUGH_AROUSAL = 0.45


# A laugh of the other character, in seconds.
class Laugh:
	var start
	var end

	func _init(start_, end_):
		self.start = start_
		self.end = end_


# Return the mood of a character that sees another's: `share`, 0..1, of the way to it; its own mood if the other's is neutral.
static func taken_up(own, other, share):
	if other.valence == 0 and other.arousal == 0:
		return own
	var part = share * HOSTILE if (other.valence < 0 and other.arousal > 0.3) else share
	return Mood.Mood.new(
		own.valence + part * (other.valence - own.valence),
		own.arousal + part * (other.arousal - own.arousal),
		own.intensity
	)


# Return the moods of a character that sees the other's, from 0 to `end` seconds, by start. own: its mood without the other; who:
# the key of the other, from which each delay is drawn.
static func moods_taken_up(own, other, end, share, seed_, who):
	var edges = Mood.mood_edges(other, 0.0, end)
	for edge in Mood.mood_edges(own, 0.0, end):
		if not edges.has(edge):
			edges.append(edge)
	edges = Util.in_order(edges)
	var out = []
	for n in range(edges.size()):
		var edge = edges[n]
		var until = edges[n + 1] if n + 1 < edges.size() else end
		var mine = Mood.mood_at(own, edge)
		var mood = taken_up(mine, Mood.mood_at(other, edge), share)
		if until - edge < SHORTEST or mood.like(mine):
			continue
		var late = 0.0 if edge <= 0 else DELAY + DELAY * Choice.uniform(seed_, [who, str(n), "mood"])
		var start = Util.least(edge + late, until)
		out.append(Mood.MoodFrom.new("%s mood %d" % [who, n], start, mood.valence, mood.arousal, null, until))
	return out


# Return the moods of a character that laughs along with `share`, 0..1, of the other's laughs, by start.
static func laughs_along(own, laughs, share, seed_, who):
	var out = []
	for n in range(laughs.size()):
		var laugh = laughs[n]
		if Choice.uniform(seed_, [who, str(n), "laugh"]) >= share:
			continue
		var start = laugh.start + LAUGH_DELAY + LAUGH_DELAY * Choice.uniform(seed_, [who, str(n), "late"])
		var rings = LAUGH_RINGS + LAUGH_RINGS * Choice.uniform(seed_, [who, str(n), "rings"])
		var mine = Mood.mood_at(own, start)
		out.append(Mood.MoodFrom.new(
			"%s laugh %d" % [who, n],
			start,
			Util.most(mine.valence, LAUGH_VALENCE),
			Util.most(mine.arousal, LAUGH_AROUSAL),
			null,
			Util.most(start + LAUGH_LASTS, laugh.end + rings)
		))
	return out
