// Reading documents, and telling where in one something is wrong. Nothing is thrown.
#pragma once

#include "json.hpp"

namespace metagraph {

/// What is wrong with a file: the first thing that was found, with where it is and what to do. Empty where nothing is.
struct Trouble {
    std::string words;

    bool found() const { return !words.empty(); }
    void tell(const std::string& where, const std::string& what, const std::string& remedy) {
        if (words.empty()) words = lang::text(where, ": ", what, ". ", remedy);
    }
};

/// A place in a document, "stick.json.layers.arms.actions[2]". What is read from it that is not as it should be is told to
/// the trouble, and something harmless comes back, so that reading needs no checks of its own.
class Node {
public:
    Node(const Json& value, std::string place, Trouble& trouble)
        : value_(&value), place_(std::move(place)), trouble_(&trouble) {}

    const Json& value() const { return *value_; }
    bool empty() const { return value_->empty(); }

    void wrong(const std::string& what, const std::string& remedy = "Export it again.") const {
        trouble_->tell(place_, what, remedy);
    }

    Node operator[](const std::string& name) const {
        if (!value_->is(Json::Kind::object)) wrong("should be an object");
        const Json* found = value_->find(name);
        if (found == nullptr) wrong("'" + name + "' is missing");
        return Node(found == nullptr ? nothing() : *found, place_ + "." + name, *trouble_);
    }
    /// The field of a name, null where there is none.
    Node maybe(const std::string& name) const {
        const Json* found = value_->find(name);
        return Node(found == nullptr ? nothing() : *found, place_ + "." + name, *trouble_);
    }
    List<Node> items() const {
        if (!value_->is(Json::Kind::list)) wrong("should be a list");
        List<Node> out;
        for (std::size_t n = 0; n < value_->items.size(); n++) {
            out.emplace_back(value_->items[n], lang::text(place_, "[", n, "]"), *trouble_);
        }
        return out;
    }
    /// Names and values of an object.
    List<std::pair<std::string, Node>> fields() const {
        if (!value_->is(Json::Kind::object)) wrong("should be an object");
        List<std::pair<std::string, Node>> out;
        for (const auto& field : value_->fields) {
            out.emplace_back(field.first, Node(field.second, place_ + "." + field.first, *trouble_));
        }
        return out;
    }
    std::string text() const {
        if (!value_->is(Json::Kind::text)) wrong("should be a text");
        return value_->text;
    }
    std::optional<std::string> text_or_null() const {
        return empty() ? std::nullopt : std::optional<std::string>(text());
    }
    std::string one_of(const List<std::string>& words) const {
        const std::string found = text();
        if (!lang::contains(words, found)) wrong("should be one of " + lang::joined(words, ", "));
        return lang::contains(words, found) ? found : words.front();
    }
    List<std::string> texts() const {
        List<std::string> out;
        for (const Node& one : items()) out.push_back(one.text());
        return out;
    }
    bool flag() const {
        if (!value_->is(Json::Kind::flag)) wrong("should be true or false");
        return value_->flag;
    }
    double number() const {
        if (!value_->is(Json::Kind::number)) wrong("should be a number");
        return value_->number;
    }
    std::optional<double> number_or_null() const {
        return empty() ? std::nullopt : std::optional<double>(number());
    }
    /// A number of a range, its ends included.
    double within(double low, double high) const {
        const double found = number();
        if (!(found >= low && found <= high)) wrong("is out of range");
        return found >= low && found <= high ? found : low;
    }
    double within_or(double low, double high, double usual) const { return empty() ? usual : within(low, high); }
    int count(int low = 0, int high = 1000000000) const {
        const double found = number();
        if (found != std::floor(found) || !(found >= low && found <= high)) wrong("should be a whole number in range");
        return found == std::floor(found) && found >= low && found <= high ? static_cast<int>(found) : low;
    }
    /// As many numbers as `width`, any where it is -1.
    List<double> numbers(int width) const {
        List<double> out;
        for (const Node& one : items()) out.push_back(one.number());
        if (width >= 0 && lang::len(out) != width) wrong(lang::text("should be ", width, " numbers"));
        if (width >= 0) out.resize(static_cast<std::size_t>(width));
        return out;
    }

private:
    const Json* value_;
    std::string place_;
    Trouble* trouble_;

    static const Json& nothing() {
        static const Json none;
        return none;
    }
};

}  // namespace metagraph
