# Parameters: the named values that a game sets without knowing any clip, stance or graph. Each is a typed name for a request: to set it
# asks for that, with one field filled in. This holds the values that one character's were set to.

const Util = preload("util.gd")

var exported  # name -> as the export has it
var values = {}
var made = {}  # the ids of their latest requests


func _init(parameters):
	exported = parameters


# Returns the value of a parameter; null for a trigger, and where there is none of that name.
func value_of(name):
	if not exported.has(name):
		return null
	return values[name] if values.has(name) else exported[name].get("initial")


# Returns [the request that setting a parameter makes, null where nothing changes; what is wrong, "" where nothing is].
func request_for(name, value):
	if not exported.has(name):
		return [null, "name: there is no parameter '%s'" % str(name)]
	var parameter = exported[name]
	var found = _kept(parameter, value)
	if found[1] != "":
		return [null, "value: " + found[1]]
	var request = parameter.request.duplicate()
	if parameter.type == "trigger":
		return [request, ""]
	if values.has(name) and _same(values[name], found[0]):
		return [null, ""]
	request[parameter.field] = _filled(parameter, found[0])
	for other in parameter.beside:
		if values.has(other) and exported.has(other):
			request[exported[other].field] = _filled(exported[other], values[other])
	for other in parameter.replaces:  # they are bound to the same
		values.erase(other)
	values[name] = found[0]
	return [request, ""]


# Returns what parameters are, as plain data, by name.
static func describe(parameters):
	var out = {}
	for name in parameters:
		var one = parameters[name]
		out[name] = {type = one.type, about = one.about}
		if one.type != "trigger":
			out[name].initial = one.initial
		if one.type == "number":
			out[name].least = one.least
			out[name].most = one.most
		if one.type == "enum" or one.type == "list":
			out[name].choices = _names(one)
	return out


static func _names(parameter):
	var out = []
	for choice in parameter.choices:
		out.append(choice.name)
	return out


# Returns whether two values that parameters keep are the same.
static func _same(a, b):
	return typeof(a) == typeof(b) and a == b


# Returns what a value puts into the request's field.
static func _filled(parameter, value):
	if parameter.type == "boolean":
		return parameter.choices[1 if value else 0].value
	if parameter.type != "enum" and parameter.type != "list":
		return value
	var out = []
	for choice in parameter.choices:
		if parameter.type == "enum" and choice.name == value:
			return choice.value
		if parameter.type == "list" and choice.name in value:
			out.append(choice.value)
	return out


# Returns [a value as it is kept, what is wrong with it].
static func _kept(parameter, value):
	var names = _names(parameter)
	match parameter.type:
		"trigger":
			return [null, "" if value == null else "a trigger has none"]
		"number":
			if not Util.is_number(value) or is_nan(value):
				return [null, "should be a number"]
			return [Util.within(float(value), parameter.least, parameter.most), ""]
		"boolean":
			return [value, "" if typeof(value) == TYPE_BOOL else "should be true or false"]
		"enum":
			var known = typeof(value) == TYPE_STRING and names.has(value)
			return [value, "" if known else "should be one of " + Util.joined(names, ", ")]
		"list":
			var wrong = "should be a list of " + Util.joined(names, ", ")
			if typeof(value) != TYPE_ARRAY:
				return [null, wrong]
			for one in value:
				if typeof(one) != TYPE_STRING or not names.has(one):
					return [null, wrong]
			var out = []
			for name in names:
				if name in value:
					out.append(name)
			return [out, ""]
	var point = [value.x, value.y, value.z] if typeof(value) == TYPE_VECTOR3 else value
	var fine = typeof(point) == TYPE_ARRAY and point.size() == 3
	if fine:
		for one in point:
			fine = fine and Util.is_finite_number(one) and abs(one) <= 1e6
	return [point, "" if fine else "should be three numbers, metres"]
