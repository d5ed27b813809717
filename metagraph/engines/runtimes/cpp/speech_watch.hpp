// Notice when what is said begins and ends, from one moment to the next.
//
// Translated from metagraph/playback/life/speech_watch.py; change that, and translate anew.
#pragma once

#include "items.hpp"
#include "utterances.hpp"
#include "language.hpp"

namespace metagraph {

struct SpeechEvent;
struct SpeechWatch;

/// A piece of something said that begins or ends. kind: "begin" or "end". at: seconds. said: the line's id, or the
/// text. reason: why the whole utterance is over; "" at a beginning, and where more of it comes.
struct SpeechEvent {
    std::string kind;
    double at;
    std::string id;
    std::string said;
    std::string reason;

    SpeechEvent(std::string kind_, double at_, std::string id_, std::string said_, std::string reason_)
        : kind(std::move(kind_)), at(at_), id(std::move(id_)), said(std::move(said_)), reason(std::move(reason_)) {}
};

/// Notices what is said, and the end of each utterance once. lasting: the last known piece of each utterance that has
/// begun and is not over.
struct SpeechWatch {
    List<Ref<Speech>> lasting;

    explicit SpeechWatch(List<Ref<Speech>> lasting_ = List<Ref<Speech>>{})
        : lasting(std::move(lasting_)) {}

    /// Return what began and ended after `seen`, until `now`, seconds. speeches: all that are said, by start.
    List<Ref<SpeechEvent>> watch(const List<Ref<Speech>>& speeches, double seen, double now);

    /// Take note that an utterance has begun, or goes on.
    void _follow(const Ref<Speech>& speech);

    Ref<SpeechEvent> _note(const std::string& kind, const Ref<Speech>& speech, double at, const std::string& reason);

    /// Return the last piece of the utterance that a piece belongs to; None if none is left.
    Ref<Speech> _find_last(const List<Ref<Speech>>& speeches, const Ref<Speech>& one);
};

inline List<Ref<SpeechEvent>> SpeechWatch::watch(const List<Ref<Speech>>& speeches, double seen, double now) {
    List<Ref<SpeechEvent>> out;
    for (const auto& speech : speeches) {
        if (speech->end <= seen || speech->start > now) {
            continue;
        }
        this->_follow(speech);
        if (speech->start > seen) {
            out.push_back(this->_note("begin", speech, speech->start, ""));
        }
        if (speech->end <= now && (speech->over.has_value() || utterances::explain_end(speeches, speech) == "")) {
            out.push_back(this->_note("end", speech, speech->end, ""));
        }
    }
    List<Ref<Speech>> lasting;
    for (const auto& one : this->lasting) {
        Ref<Speech> last = this->_find_last(speeches, one);
        if (last == nullptr) { // something else took its place before it could go on
            out.push_back(this->_note("end", one, now, "replaced"));
            continue;
        }
        std::string reason = utterances::explain_end(speeches, last);
        double until = !last->over.has_value() ? last->end : std::max(last->end, *last->over);
        if (reason == "" || until > now) {
            lasting.push_back(last);
        } else {
            out.push_back(this->_note("end", last, until > seen ? until : now, reason));
        }
    }
    this->lasting = lasting;
    return out;
}

inline void SpeechWatch::_follow(const Ref<Speech>& speech) {
    for (const auto& one : this->lasting) {
        if (one->id == speech->id && one->asked == speech->asked) {
            return;
        }
    }
    this->lasting.push_back(speech);
}

inline Ref<SpeechEvent> SpeechWatch::_note(
    const std::string& kind,
    const Ref<Speech>& speech,
    double at,
    const std::string& reason
) {
    std::string said = !speech->line.has_value() ? speech->text : *speech->line;
    return lang::made<SpeechEvent>(kind, at, speech->id, said, reason);
}

inline Ref<Speech> SpeechWatch::_find_last(const List<Ref<Speech>>& speeches, const Ref<Speech>& one) {
    Ref<Speech> last;
    for (const auto& speech : speeches) {
        if (speech->id == one->id && speech->asked == one->asked) {
            last = speech;
        }
    }
    return last;
}

}  // namespace metagraph
