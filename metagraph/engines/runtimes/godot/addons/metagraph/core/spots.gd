# Where something is: a name or a point, three numbers.


# Returns what has a name.
static func named(name):
	return name


# Returns the point that a name stands for among places, else what was given.
static func placed(places, to):
	return places.get(to, to) if typeof(to) == TYPE_STRING else to


# Returns whether two names or two points are the same.
static func is_same_spot(one, other):
	if typeof(one) != typeof(other):
		return false
	if typeof(one) == TYPE_STRING:
		return one == other
	return one[0] == other[0] and one[1] == other[1] and one[2] == other[2]
