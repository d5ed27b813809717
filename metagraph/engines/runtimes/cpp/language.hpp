// What translated modules need of the language: lists, maps that keep their order, texts, records that are shared.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iomanip>
#include <locale>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace metagraph {

template <class T>
using List = std::vector<T>;
template <class T>
using Set = std::set<T>;
/// A record, or nothing. Those that are values are never changed once made.
template <class T>
using Ref = std::shared_ptr<T>;

/// Keys and values, in the order in which keys were first set.
template <class K, class V>
class Map {
public:
    Map() = default;
    Map(std::initializer_list<std::pair<K, V>> entries) {
        for (const auto& [key, value] : entries) (*this)[key] = value;
    }
    V& operator[](const K& key) {
        auto found = places_.find(key);
        if (found == places_.end()) {
            found = places_.emplace(key, entries_.size()).first;
            entries_.emplace_back(key, V{});
        }
        return entries_[found->second].second;
    }
    const V& at(const K& key) const { return entries_[places_.at(key)].second; }
    const V* find(const K& key) const {
        auto found = places_.find(key);
        return found == places_.end() ? nullptr : &entries_[found->second].second;
    }
    bool empty() const { return entries_.empty(); }
    std::size_t size() const { return entries_.size(); }
    auto begin() const { return entries_.begin(); }
    auto end() const { return entries_.end(); }

private:
    std::vector<std::pair<K, V>> entries_;
    std::unordered_map<K, std::size_t> places_;
};

/// The helpers of translated code, apart from its own names.
namespace lang {

inline constexpr double PI = 3.14159265358979323846;

/// End what should never have begun: with an exception, or where those are off with the program.
[[noreturn]] inline void fail(const std::string& why) {
#if defined(__cpp_exceptions)
    throw std::invalid_argument(why);
#else
    std::fprintf(stderr, "metagraph: %s\n", why.c_str());
    std::abort();
#endif
}

template <class T, class... Given>
Ref<T> made(Given&&... given) {
    return std::make_shared<T>(std::forward<Given>(given)...);
}

/// A record as others may keep it.
template <class T>
Ref<T> self(const T* of) {
    return std::const_pointer_cast<T>(of->shared_from_this());
}

template <class C>
int len(const C& items) {
    return static_cast<int>(items.size());
}

/// The item at a place; negative ones count from the end.
template <class T>
const T& at(const List<T>& items, int place) {
    return items.at(static_cast<std::size_t>(place < 0 ? place + len(items) : place));
}
template <class T>
T& at(List<T>& items, int place) {
    return items.at(static_cast<std::size_t>(place < 0 ? place + len(items) : place));
}

/// Of a list that is gone afterwards, a copy.
template <class T>
T at(List<T>&& items, int place) {
    return at(static_cast<const List<T>&>(items), place);
}

/// The items from a place to before another; those beyond are the ends.
template <class T>
List<T> part(const List<T>& items, int first, std::optional<int> last = std::nullopt) {
    const int count = len(items);
    auto place = [count](int n) { return std::clamp(n < 0 ? n + count : n, 0, count); };
    const int begin = place(first), end = place(last.value_or(count));
    return begin < end ? List<T>(items.begin() + begin, items.begin() + end) : List<T>{};
}

template <class T, class X>
bool contains(const List<T>& items, const X& item) {
    return std::find(items.begin(), items.end(), item) != items.end();
}
template <class T, class X>
bool contains(const Set<T>& items, const X& item) {
    return items.count(item) > 0;
}
template <class K, class V, class X>
bool contains(const Map<K, V>& map, const X& key) {
    return map.find(key) != nullptr;
}
inline bool contains(const std::string& text, const std::string& inside) {
    return text.find(inside) != std::string::npos;
}

template <class T>
void extend(List<T>& items, const List<T>& more) {
    items.insert(items.end(), more.begin(), more.end());
}
template <class T, class X>
void insert(List<T>& items, int place, const X& item) {
    items.insert(items.begin() + place, item);
}
template <class T, class X>
int index(const List<T>& items, const X& item) {
    return static_cast<int>(std::find(items.begin(), items.end(), item) - items.begin());
}
template <class T>
List<T> backwards(const List<T>& items) {
    return List<T>(items.rbegin(), items.rend());
}
inline List<int> range(int first, int last) {
    List<int> out;
    for (int n = first; n < last; n++) out.push_back(n);
    return out;
}
inline List<int> range(int last) { return range(0, last); }
template <class T, class... More>
List<T> together(List<T> first, const More&... more) {
    (first.insert(first.end(), more.begin(), more.end()), ...);
    return first;
}
template <class T>
T sum(const List<T>& items) {
    return std::accumulate(items.begin(), items.end(), T{});
}
template <class T>
T max_of(const List<T>& items) {
    return *std::max_element(items.begin(), items.end());
}
template <class T, class X>
T max_of(const List<T>& items, X other) {
    return items.empty() ? T(other) : max_of(items);
}
template <class T>
T min_of(const List<T>& items) {
    return *std::min_element(items.begin(), items.end());
}
template <class T, class X>
T min_of(const List<T>& items, X other) {
    return items.empty() ? T(other) : min_of(items);
}
template <class T>
Set<T> set_of(const Set<T>& items) {
    return items;
}

template <class T>
Set<T> set_of(const List<T>& items) {
    return Set<T>(items.begin(), items.end());
}
template <class T>
List<T> in_order(List<T> items) {
    std::stable_sort(items.begin(), items.end());
    return items;
}

/// Items by their keys; those alike stay as they were.
template <class T, class K>
List<T> ordered(const List<T>& items, const List<K>& keys) {
    List<int> places(items.size());
    std::iota(places.begin(), places.end(), 0);
    std::stable_sort(places.begin(), places.end(), [&](int a, int b) { return at(keys, a) < at(keys, b); });
    List<T> out;
    for (int place : places) out.push_back(at(items, place));
    return out;
}

/// How many of ascending values are at most x.
inline int bisect_right(const List<double>& values, double x) {
    return static_cast<int>(std::upper_bound(values.begin(), values.end(), x) - values.begin());
}
/// How many of ascending values are below x.
inline int bisect_left(const List<double>& values, double x) {
    return static_cast<int>(std::lower_bound(values.begin(), values.end(), x) - values.begin());
}

template <class K, class V>
List<K> keys(const Map<K, V>& map) {
    List<K> out;
    for (const auto& one : map) out.push_back(one.first);
    return out;
}
template <class K, class V>
List<V> values(const Map<K, V>& map) {
    List<V> out;
    for (const auto& one : map) out.push_back(one.second);
    return out;
}
template <class K, class V, class X>
std::optional<V> get(const Map<K, V>& map, const X& key) {
    const V* found = map.find(key);
    return found == nullptr ? std::nullopt : std::optional<V>(*found);
}
template <class K, class T, class X>
Ref<T> get(const Map<K, Ref<T>>& map, const X& key) {
    const Ref<T>* found = map.find(key);
    return found == nullptr ? nullptr : *found;
}
template <class K, class V, class X, class Y>
V get_or(const Map<K, V>& map, const X& key, const Y& other) {
    const V* found = map.find(key);
    return found == nullptr ? V(other) : *found;
}

inline double divided(double a, double b) { return a / b; }
inline int floored(int a, int b) { return static_cast<int>(std::floor(static_cast<double>(a) / b)); }
inline int modulo(int a, int b) { return (a % b + b) % b; }
inline double modulo(double a, double b) {
    const double rest = std::fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

/// A number with some places behind its point; what the machine's language is does not matter.
inline std::string fixed(double number, int places) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::fixed << std::setprecision(places) << number;
    return out.str();
}

template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    (out << ... << parts);
    return out.str();
}

inline List<std::string> words(const std::string& text) {
    std::istringstream in(text);
    List<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}
inline std::string joined(const List<std::string>& texts, const std::string& between) {
    std::string out;
    for (std::size_t n = 0; n < texts.size(); n++) out += (n ? between : "") + texts[n];
    return out;
}
/// A text before the last of another, that, and what is behind it; nothing of the first two where it has none.
inline std::tuple<std::string, std::string, std::string> parted_last(const std::string& text, const std::string& by) {
    const auto place = text.rfind(by);
    if (place == std::string::npos) return {"", "", text};
    return {text.substr(0, place), by, text.substr(place + by.size())};
}
/// The small letter of a code point: Latin, Greek, Cyrillic and Armenian; others stay.
inline std::uint32_t small(std::uint32_t c) {
    auto within = [c](std::uint32_t first, std::uint32_t last) { return c >= first && c <= last; };
    if (within('A', 'Z') || (within(0xC0, 0xDE) && c != 0xD7) || (within(0x391, 0x3AB) && c != 0x3A2) || within(0x410, 0x42F)) return c + 32;
    if (c == 0x130) return 'i';
    if (c == 0x178) return 0xFF;
    if (c == 0x1E9E) return 0xDF;
    if (c == 0x386) return 0x3AC;
    if (within(0x388, 0x38A)) return c + 37;
    if (c == 0x38C) return 0x3CC;
    if (c == 0x38E || c == 0x38F) return c + 63;
    if (c == 0x1A0 || c == 0x1AF) return c + 1;
    if (within(0x400, 0x40F)) return c + 80;
    if (within(0x531, 0x556)) return c + 48;
    const bool even_is_large = within(0x100, 0x137) || within(0x14A, 0x177) || within(0x1DE, 0x1EF) || within(0x1F8, 0x21F) || within(0x222, 0x233)
        || within(0x460, 0x481) || within(0x48A, 0x4BF) || within(0x4D0, 0x52F) || within(0x1E00, 0x1E95) || within(0x1EA0, 0x1EFF);
    const bool odd_is_large = within(0x139, 0x148) || within(0x179, 0x17E) || within(0x1CD, 0x1DC) || within(0x4C1, 0x4CE);
    return (even_is_large && c % 2 == 0) || (odd_is_large && c % 2 == 1) ? c + 1 : c;
}
/// A text in small letters; bytes that are no UTF-8 stay.
inline std::string lowered(const std::string& text) {
    std::string out;
    for (std::size_t n = 0; n < text.size(); n++) {
        const auto first = static_cast<unsigned char>(text[n]);
        const std::size_t more = first < 0xC2 || first > 0xEF ? 0 : first < 0xE0 ? 1 : 2; // none beyond 65535 that matter
        std::uint32_t code = more == 0 ? first : first & (0x3Fu >> more);
        bool whole = n + more < text.size();
        for (std::size_t k = 1; whole && k <= more; k++) {
            whole = (static_cast<unsigned char>(text[n + k]) & 0xC0) == 0x80;
            code = (code << 6) | (static_cast<unsigned char>(text[n + k]) & 0x3Fu);
        }
        if (!whole || (more == 0 && first >= 0x80)) {
            out += text[n];
            continue;
        }
        const std::uint32_t found = small(code);
        if (found < 0x80) {
            out += static_cast<char>(found);
        } else if (found < 0x800) {
            out += static_cast<char>(0xC0 | (found >> 6));
            out += static_cast<char>(0x80 | (found & 0x3F));
        } else {
            out += static_cast<char>(0xE0 | (found >> 12));
            out += static_cast<char>(0x80 | ((found >> 6) & 0x3F));
            out += static_cast<char>(0x80 | (found & 0x3F));
        }
        n += more;
    }
    return out;
}
inline bool digits(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}
inline bool starts_with(const std::string& text, const std::string& begin) { return text.rfind(begin, 0) == 0; }
inline std::string stripped(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\n\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\n\r") - first + 1);
}

}  // namespace lang
}  // namespace metagraph
