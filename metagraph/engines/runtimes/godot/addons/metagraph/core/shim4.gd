# All that Godot 4 says differently from Godot 3 and the core needs; shim3.gd is its twin.


# Returns the quaternion of four numbers.
static func quat(x, y, z, w):
	return Quaternion(x, y, z, w)


# Returns a text's UTF-8 bytes.
static func utf8(text):
	return text.to_utf8_buffer()


# Returns the code point of a text's letter at a place.
static func code_at(text, place):
	return text.unicode_at(place)


# Returns the letter of a code point.
static func letter(code):
	return String.chr(code)


# Returns what a JSON text says, null where it is none.
static func parse(text):
	var reader = JSON.new()
	return reader.data if reader.parse(text) == OK else null


# Returns a file's bytes, null where it cannot be read.
static func read_bytes(path):
	if not FileAccess.file_exists(path):
		return null
	return FileAccess.get_file_as_bytes(path)


# Returns whether a value is an array of bytes.
static func are_bytes(value):
	return typeof(value) == TYPE_PACKED_BYTE_ARRAY


# Returns the text of UTF-8 bytes; none of what could not be read.
static func text_of(bytes):
	return "" if bytes == null else bytes.get_string_from_utf8()


# Returns microseconds of a clock.
static func micros():
	return Time.get_ticks_usec()
