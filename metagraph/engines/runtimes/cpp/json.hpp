// Reading and writing JSON. Nothing is thrown.
#pragma once

#include "language.hpp"

namespace metagraph {

/// A value of JSON. Of fields with one name the last counts.
struct Json {
    enum class Kind { nothing, flag, number, text, list, object };

    Kind kind = Kind::nothing;
    bool flag = false;
    double number = 0.0;
    std::string text;
    List<Json> items;
    List<std::pair<std::string, Json>> fields;

    Json() = default;
    Json(bool value) : kind(Kind::flag), flag(value) {}
    Json(double value) : kind(Kind::number), number(value) {}
    Json(int value) : kind(Kind::number), number(value) {}
    Json(const char* value) : kind(Kind::text), text(value) {}
    Json(std::string value) : kind(Kind::text), text(std::move(value)) {}

    static Json list(List<Json> items = {}) {
        Json out;
        out.kind = Kind::list;
        out.items = std::move(items);
        return out;
    }
    static Json object(List<std::pair<std::string, Json>> fields = {}) {
        Json out;
        out.kind = Kind::object;
        out.fields = std::move(fields);
        return out;
    }
    static Json texts(const List<std::string>& words) { return list(List<Json>(words.begin(), words.end())); }
    static Json maybe(const std::optional<std::string>& word) { return word.has_value() ? Json(*word) : Json(); }
    static Json maybe(const std::optional<double>& number) { return number.has_value() ? Json(*number) : Json(); }

    bool is(Kind other) const { return kind == other; }
    bool empty() const { return kind == Kind::nothing; }

    /// The field of a name, nullptr where there is none.
    const Json* find(const std::string& name) const {
        for (auto field = fields.rbegin(); field != fields.rend(); ++field) {
            if (field->first == name) return &field->second;
        }
        return nullptr;
    }
    void set(const std::string& name, Json value) {
        for (auto field = fields.rbegin(); field != fields.rend(); ++field) {
            if (field->first == name) {
                field->second = std::move(value);
                return;
            }
        }
        fields.emplace_back(name, std::move(value));
    }
};

namespace json {

inline constexpr int DEEPEST = 200; // lists and objects within each other

/// Append a code point to a text, as UTF-8; what is none becomes U+FFFD.
inline void append_utf8(std::string& out, std::uint32_t code) {
    if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;
    if (code < 0x80) {
        out += static_cast<char>(code);
    } else if (code < 0x800) {
        out += static_cast<char>(0xC0 | (code >> 6));
        out += static_cast<char>(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
        out += static_cast<char>(0xE0 | (code >> 12));
        out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
        out += static_cast<char>(0x80 | (code & 0x3F));
    } else {
        out += static_cast<char>(0xF0 | (code >> 18));
        out += static_cast<char>(0x80 | ((code >> 12) & 0x3F));
        out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
        out += static_cast<char>(0x80 | (code & 0x3F));
    }
}

/// Return the code points of UTF-8; bytes that are none become U+FFFD.
inline List<std::uint32_t> code_points(const std::string& text) {
    List<std::uint32_t> out;
    for (std::size_t at = 0; at < text.size();) {
        const unsigned char first = static_cast<unsigned char>(text[at++]);
        const int more = first < 0x80 ? 0 : first >= 0xC2 && first < 0xE0 ? 1 : first >= 0xE0 && first < 0xF0 ? 2
            : first >= 0xF0 && first < 0xF5 ? 3 : -1;
        std::uint32_t code = more <= 0 ? first : first & (0x3F >> more);
        int left = more;
        while (left > 0 && at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80) {
            code = (code << 6) | (static_cast<unsigned char>(text[at++]) & 0x3F);
            left--;
        }
        out.push_back(left != 0 || (code >= 0xD800 && code < 0xE000) ? 0xFFFD : code);
    }
    return out;
}

/// Reads one text. After `parse`, `wrong` says what is wrong with it and where; it is empty where all is well.
class Parser {
public:
    explicit Parser(const std::string& text) : text_(text) {}

    std::string wrong;

    Json parse() {
        Json out = value(0);
        blanks();
        if (wrong.empty() && at_ < text_.size()) fail("there is more behind its end");
        return out;
    }

private:
    const std::string& text_;
    std::size_t at_ = 0;

    void fail(const std::string& what) {
        if (!wrong.empty()) return;
        std::size_t line = 1, column = 1;
        for (std::size_t n = 0; n < at_ && n < text_.size(); n++) {
            line += text_[n] == '\n';
            column = text_[n] == '\n' ? 1 : column + 1;
        }
        wrong = lang::text("is not JSON: ", what, " in line ", line, ", column ", column);
        at_ = text_.size();
    }

    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void blanks() {
        while (at_ < text_.size() && (next() == ' ' || next() == '\n' || next() == '\t' || next() == '\r')) at_++;
    }
    bool take(char c) {
        blanks();
        if (at_ >= text_.size() || next() != c) return false;
        at_++;
        return true;
    }
    bool word(const char* expected) {
        const std::string all = expected;
        if (text_.compare(at_, all.size(), all) != 0) return false;
        at_ += all.size();
        return true;
    }

    Json value(int depth) {
        blanks();
        if (depth > DEEPEST) return fail("nested too deeply"), Json();
        if (at_ >= text_.size()) return fail("it ends too soon"), Json();
        const char c = next();
        if (c == '{') return object(depth);
        if (c == '[') return list(depth);
        if (c == '"') return Json(string());
        if (c == '-' || (c >= '0' && c <= '9')) return number();
        if (word("true")) return Json(true);
        if (word("false")) return Json(false);
        if (word("null")) return Json();
        return fail("a value should be here"), Json();
    }

    Json object(int depth) {
        Json out = Json::object();
        at_++;
        if (take('}')) return out;
        while (wrong.empty()) {
            blanks();
            if (next() != '"') return fail("the name of a field should be here"), Json();
            std::string name = string();
            if (!take(':')) return fail("':' should be here"), Json();
            Json own = value(depth + 1);
            out.fields.emplace_back(std::move(name), std::move(own));
            if (take('}')) return out;
            if (!take(',')) return fail("',' or '}' should be here"), Json();
        }
        return Json();
    }

    Json list(int depth) {
        Json out = Json::list();
        at_++;
        if (take(']')) return out;
        while (wrong.empty()) {
            out.items.push_back(value(depth + 1));
            if (take(']')) return out;
            if (!take(',')) return fail("',' or ']' should be here"), Json();
        }
        return Json();
    }

    std::string string() {
        std::string out;
        at_++;
        while (at_ < text_.size()) {
            const char c = text_[at_++];
            if (c == '"') return out;
            if (static_cast<unsigned char>(c) < 0x20) return fail("a text should not have a line's end in it"), "";
            if (c != '\\') {
                out += c;
                continue;
            }
            const char escaped = next();
            at_++;
            static const std::string from = "\"\\/bfnrt", to = "\"\\/\b\f\n\r\t";
            const std::size_t place = from.find(escaped);
            if (escaped == 'u') {
                unicode(out);
            } else if (escaped != '\0' && place != std::string::npos) {
                out += to[place];
            } else {
                return fail("there is no such escape"), "";
            }
        }
        return fail("a text does not end"), "";
    }

    void unicode(std::string& out) {
        std::uint32_t code = four();
        if (code >= 0xD800 && code < 0xDC00 && text_.compare(at_, 2, "\\u") == 0) {
            const std::size_t before = at_;
            at_ += 2;
            const std::uint32_t low = four();
            if (low >= 0xDC00 && low < 0xE000) {
                code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            } else {
                at_ = before;
            }
        }
        if (code >= 0xD800 && code < 0xE000) return fail("half a letter, \\ud800 to \\udfff alone");
        append_utf8(out, code);
    }
    std::uint32_t four() {
        std::uint32_t out = 0;
        for (int n = 0; n < 4; n++) {
            const char c = next();
            const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10
                : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
            if (digit < 0) return fail("four digits should follow \\u"), 0;
            out = out * 16 + static_cast<std::uint32_t>(digit);
            at_++;
        }
        return out;
    }

    int digits(std::uint64_t& all, int& places) {
        int count = 0;
        for (; next() >= '0' && next() <= '9'; at_++, count++) {
            if (all < 900000000000000000ull) {
                all = all * 10 + static_cast<std::uint64_t>(next() - '0');
                places++;
            } else {
                exact_ = false;
            }
        }
        return count;
    }

    Json number() {
        const std::size_t begin = at_;
        std::uint64_t all = 0;
        int places = 0, power = 0;
        exact_ = true;
        const bool minus = next() == '-';
        if (minus) at_++;
        const bool zero = next() == '0';
        const int whole = digits(all, places);
        if (whole == 0 || (zero && whole > 1)) return fail("a number should be here"), Json();
        if (next() == '.') {
            at_++;
            places = 0;
            if (digits(all, places) == 0) return fail("digits should follow the point"), Json();
            power = -places;
        }
        if (next() == 'e' || next() == 'E') {
            at_++;
            const bool down = next() == '-';
            if (down || next() == '+') at_++;
            std::uint64_t exponent = 0;
            int unused = 0;
            if (digits(exponent, unused) == 0) return fail("digits should follow the exponent"), Json();
            const int size = static_cast<int>(std::min<std::uint64_t>(exponent, 100000));
            power += down ? -size : size;
        }
        // Both are exact up to here, so one rounding is the only one; other numbers are left to the library.
        if (exact_ && all <= (1ull << 53) && power >= -22 && power <= 22) {
            double scale = 1.0;
            for (int n = 0; n < std::abs(power); n++) scale *= 10.0;
            const double size = power < 0 ? static_cast<double>(all) / scale : static_cast<double>(all) * scale;
            return Json(minus ? -size : size);
        }
        std::istringstream in(text_.substr(begin, at_ - begin));
        in.imbue(std::locale::classic());
        double out = 0.0;
        in >> out;
        if (!std::isfinite(out) || (in.fail() && std::abs(out) > 1)) return fail("a number is too large"), Json();
        return Json(out);
    }

    bool exact_ = true;
};

/// Write a text with its quotes.
inline void quote(std::string& out, const std::string& text) {
    static const char* const hex = "0123456789abcdef";
    out += '"';
    for (const char c : text) {
        const unsigned char byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (byte < 0x20) {
            out += "\\u00";
            out += hex[byte >> 4];
            out += hex[byte & 15];
        } else {
            out += c;
        }
    }
    out += '"';
}

/// Write a number so that it is read back as it was; one that JSON has not is null.
inline std::string written(double number) {
    if (!std::isfinite(number)) return "null";
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::setprecision(std::abs(number) < 1e15 && number == std::floor(number) ? 15 : 17) << number;
    return out.str();
}

inline void write(std::string& out, const Json& value) {
    if (value.is(Json::Kind::nothing)) {
        out += "null";
    } else if (value.is(Json::Kind::flag)) {
        out += value.flag ? "true" : "false";
    } else if (value.is(Json::Kind::number)) {
        out += written(value.number);
    } else if (value.is(Json::Kind::text)) {
        quote(out, value.text);
    } else if (value.is(Json::Kind::list)) {
        out += '[';
        for (std::size_t n = 0; n < value.items.size(); n++) {
            if (n > 0) out += ", ";
            write(out, value.items[n]);
        }
        out += ']';
    } else {
        out += '{';
        for (std::size_t n = 0; n < value.fields.size(); n++) {
            if (n > 0) out += ", ";
            quote(out, value.fields[n].first);
            out += ": ";
            write(out, value.fields[n].second);
        }
        out += '}';
    }
}

inline std::string text(const Json& value) {
    std::string out;
    write(out, value);
    return out;
}

}  // namespace json

}  // namespace metagraph
