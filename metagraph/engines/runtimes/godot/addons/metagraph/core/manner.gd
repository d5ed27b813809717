# How an action plays in a mood: how fast, how large, for how long.
#
# Translated from metagraph/playback/planning/manner.py; change that, and translate anew.

const CueShapes = preload("cue_shapes.gd")
const Mood = preload("mood.gd")


# Return how an action would play for a request from `now` on, or as a step on the way to it.
static func shape_in_mood(state, action, request, now, mood):
	return CueShapes.shape_of(state.project, action, request, now, find_tempo(action, mood))


# Return the mood in which a request is played from `at` on, or at its stroke.
static func find_mood(state, request, at):
	if request == null:
		return Mood.mood_at(state.moods, at)
	var mood = Mood.mood_at(state.moods, at if request.stroke == null else request.stroke)
	if request.valence == null and request.arousal == null and request.intensity == null:
		return mood
	return Mood.changed(mood, request.valence, request.arousal, request.intensity)


# Return the speed of an action in a mood, 1 if it was made for the mood.
static func find_tempo(action, mood):
	return 1.0 if (mood.neutral or Mood.made_for(mood, action.tags)) else Mood.tempo(mood)


# Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were made for
# the mood keep their extent.
static func find_extent(state, action, mood):
	if state.graph.layer == "body" or action.kind == "transition" or mood.neutral:
		return 1.0
	return 1.0 if (action.contacts.size() > 0 or action.tags.has(Mood.HELD) or Mood.made_for(mood, action.tags)) else Mood.extent(
		mood
	)
