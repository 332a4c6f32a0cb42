#include "scene/structure.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <regex>

#include <spdlog/fmt/fmt.h>
#include <nlohmann/json.hpp>

#include "core/suggestion.h"
#include "core/text.h"
#include "scene/check.h"
#include "scene/field_rules.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

// Gives the text to the parser, and counts the bytes that it has taken.
class CountingInput {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingInput(const char* at, std::size_t* taken) : at_(at), taken_(taken) {}
    reference operator*() const { return *at_; }
    CountingInput& operator++() {
        ++at_;
        ++*taken_;
        return *this;
    }
    bool operator==(const CountingInput& other) const { return at_ == other.at_; }

  private:
    const char* at_;
    std::size_t* taken_;
};

std::string quoted(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

const FieldDescriptor* fieldNamed(const pb::Descriptor& message, const std::string& name) {
    for (int k = 0; k < message.field_count(); ++k)
        if (message.field(k)->json_name() == name || message.field(k)->name() == name) return message.field(k);
    return nullptr;
}

// An object or a list of the text that follows scene.proto.
struct Frame {
    const pb::Descriptor* message = nullptr;  // of an object
    const FieldDescriptor* field = nullptr;   // of an object: the member that is read; nullptr: unknown. Or of a list
    std::size_t offset = 0;
    TextPlaces::Node* place = nullptr;               // nullptr: no path that is looked for passes it
    std::size_t count = 0;                           // entries of a list
    std::size_t part = 0;                            // offset of the member or entry that is read
    bool wrong = false;                              // that member or entry, or an entry before
    std::vector<const FieldDescriptor*> given{};     // members of an object
    std::vector<const FieldDescriptor*> misspelt{};  // members that an unknown name probably stands for
};

// Follows the text with the descriptors of the messages. The parser calls its members.
class Walk {
  public:
    // `places`: are found; may be null.
    Walk(std::string_view text, TextPlaces* places)
        : text_(text), place_(places != nullptr ? &places->root() : nullptr) {}

    Structure run() {
        found_.wholeRead = nlohmann::json::sax_parse(CountingInput(text_.data(), &taken_),
                                                     CountingInput(text_.data() + text_.size(), &taken_), this);
        std::ranges::stable_sort(found_.mistakes, {}, &Mistake::offset);
        return std::move(found_);
    }

    bool null() { return scalar("null"); }
    bool boolean(bool value) {
        return scalar(value ? "true" : "false",
                      [](const FieldDescriptor& f) { return f.cpp_type() == FieldDescriptor::CPPTYPE_BOOL; });
    }
    bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
    // The largest ones would be rounded to 2^64, which is one too many.
    bool number_unsigned(std::uint64_t value) { return number(std::min(static_cast<double>(value), largestWhole)); }
    bool number_float(double value, const std::string& /*text*/) { return number(value); }
    bool string(const std::string& value);
    bool binary(const nlohmann::json::binary_t& /*value*/) { return true; }  // not in JSON
    bool start_object(std::size_t /*count*/);
    bool key(const std::string& name);
    bool end_object();
    bool start_array(std::size_t /*count*/);
    bool end_array();
    bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception& error);

  private:
    template <class Fits>
    bool scalar(const std::string& shown, Fits fits);
    bool scalar(const std::string& shown) {
        return scalar(shown, [](const FieldDescriptor& /*field*/) { return false; });
    }
    bool number(double value);
    void refuseName(const std::string& name);
    void checkText(const FieldDescriptor& field, const std::string& value);

    // Returns the place of the token behind the one that was read last.
    [[nodiscard]] std::size_t nextToken() const {
        return std::min(text_.find_first_not_of(" \t\r\n,:", last_), text_.size());
    }
    // Begins a value. Returns its field; nullptr if the value is not checked.
    const FieldDescriptor* beginValue();
    [[nodiscard]] bool inList() const { return !frames_.empty() && frames_.back().message == nullptr; }
    [[nodiscard]] std::string path() const;
    void report(std::size_t offset, std::string path, std::string message, std::string meant = "") {
        found_.mistakes.push_back({offset, std::move(path), std::move(message), std::move(meant)});
    }
    // Reports the member or entry that is read.
    void refuse(std::string message) {
        report(begin_, path(), std::move(message));
        if (!frames_.empty()) frames_.back().wrong = true;
    }
    // Cuts the member or entry that has been read if it is wrong. A list of values is cut as a whole.
    void endValue(std::size_t end);
    bool goesOn() {
        last_ = taken_;
        return found_.mistakes.size() < mostMistakes;
    }
    // Ends a text, a number or another literal.
    bool endScalar() {
        const bool inText = begin_ < text_.size() && text_[begin_] == '"';
        // The parser has read one byte behind a number.
        if (skipped_ == 0) endValue(inText ? taken_ : std::min(text_.find_first_of(" \t\r\n,]}", begin_), taken_));
        return goesOn();
    }
    bool endSkipped() {
        if (--skipped_ == 0) endValue(taken_);
        return goesOn();
    }
    bool skipObject() {
        ++skipped_;
        return goesOn();
    }

    std::string_view text_;
    TextPlaces::Node* place_;  // of the value that begins
    std::size_t taken_ = 0;    // bytes that the parser has read
    std::size_t last_ = 0;     // end of the token before
    std::size_t begin_ = 0;    // of the token
    std::size_t skipped_ = 0;  // depth within a value that is not checked
    std::vector<Frame> frames_;
    Structure found_;
};

std::string Walk::path() const {
    std::string path;
    for (const Frame& frame : frames_) {
        if (frame.message == nullptr)
            path = at(path, frame.count - 1);
        else if (frame.field != nullptr)
            path = at(path, frame.field->json_name());
    }
    return path;
}

const FieldDescriptor* Walk::beginValue() {
    begin_ = nextToken();
    if (skipped_ > 0 || frames_.empty()) return nullptr;
    Frame& frame = frames_.back();
    const bool list = frame.message == nullptr;
    if (list) frame.part = begin_;
    if (list) ++frame.count;
    place_ = nullptr;
    if (frame.place != nullptr && frame.field != nullptr)
        place_ = frame.place->part(list ? at("", frame.count - 1) : frame.field->json_name());
    if (place_ != nullptr) place_->offset = begin_;
    return frame.field;
}

void Walk::endValue(std::size_t end) {
    if (frames_.empty() || !frames_.back().wrong) return;
    Frame& frame = frames_.back();
    const bool list = frame.message == nullptr;
    if (list && frame.field->message_type() == nullptr) return;
    found_.cuts.push_back({frame.part, end, list});
    frame.wrong = false;
}

template <class Fits>
bool Walk::scalar(const std::string& shown, Fits fits) {
    const FieldDescriptor* const field = beginValue();
    if (frames_.empty() && skipped_ == 0) report(begin_, "", fmt::format("is {}, must be an object", shown));
    if (field == nullptr) return endScalar();
    if (field->is_repeated() && !inList())
        refuse(fmt::format("is {}, must be a list", shown));
    else if (!fits(*field))
        refuse(fmt::format("is {}, must be {}", shown, wantedText(*field)));
    return endScalar();
}

bool Walk::number(double value) {
    return scalar(fmt::format("{}", value), [&](const FieldDescriptor& field) {
        if (field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE && !isWhole(field)) return false;
        if (isWhole(field) && value != std::floor(value)) return false;
        if (std::string reason = whyOutOfRange(field, value); !reason.empty()) refuse(std::move(reason));
        return true;
    });
}

void Walk::checkText(const FieldDescriptor& field, const std::string& value) {
    const v1::Rule& rule = ruleOf(field);
    const bool bytes = field.type() == FieldDescriptor::TYPE_BYTES;
    const auto isBase64 = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view("+/-_=").find(c) != std::string::npos;
    };
    if (bytes && !std::ranges::all_of(value, isBase64)) refuse("is not Base64");
    const std::size_t size = bytes ? value.size() / 4 * 3 : value.size();
    if (rule.most() > 0 && size > rule.most() + (bytes ? 2 : 0))
        refuse(fmt::format("is {} bytes long, must be at most {}", size, rule.most()));
    if (!rule.pattern().empty() &&
        (size > rule.pattern().size() * 4 || !std::regex_match(value, std::regex(rule.pattern()))))
        refuse(fmt::format("is {}, must be #rrggbb in hexadecimal", shown(value)));
}

bool Walk::string(const std::string& value) {
    return scalar(shown(value), [&](const FieldDescriptor& field) {
        if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
            const std::vector<std::string> names = namesOf(*field.enum_type());
            if (std::ranges::find(names, value) == names.end())
                refuse(fmt::format("is {}, must be {}{}", shown(value), wantedText(field), didYouMean(value, names)));
            return true;
        }
        // JSON has whole numbers of 64 bits as text, because many readers keep only 53 bits.
        if (field.cpp_type() == FieldDescriptor::CPPTYPE_UINT64) {
            std::uint64_t whole = 0;
            const char* const end = value.data() + value.size();
            return std::from_chars(value.data(), end, whole) == std::from_chars_result{end, std::errc{}};
        }
        if (field.cpp_type() != FieldDescriptor::CPPTYPE_STRING) return false;
        checkText(field, value);
        return true;
    });
}

bool Walk::start_object(std::size_t /*count*/) {
    const bool root = frames_.empty() && skipped_ == 0;
    const FieldDescriptor* const field = beginValue();
    if (root) {
        frames_.push_back({.message = v1::Scene::descriptor(), .offset = begin_, .place = place_});
        return goesOn();
    }
    if (field == nullptr) return skipObject();
    const bool asList = field->is_repeated() && !inList();
    if (asList || field->message_type() == nullptr) {
        refuse(fmt::format("is an object, must be {}", asList ? "a list" : wantedText(*field)));
        return skipObject();
    }
    frames_.push_back({.message = field->message_type(), .offset = begin_, .place = place_});
    return goesOn();
}

void Walk::refuseName(const std::string& name) {
    constexpr std::size_t longest = 80;
    Frame& frame = frames_.back();
    frame.wrong = true;
    const std::vector<std::string> names = namesOf(*frame.message);
    const auto nearest = suggestionFor(name, names);
    if (nearest) frame.misspelt.push_back(fieldNamed(*frame.message, *nearest));
    report(begin_, at(path(), withoutControls(cutUtf8(name, longest))),
           fmt::format("is not a field of {}{}", frame.message->name(),
                       nearest ? didYouMean(name, names) : otherOwnersOf(name, *frame.message)),
           nearest ? at(path(), *nearest) : "");
}

bool Walk::key(const std::string& name) {
    begin_ = nextToken();
    if (skipped_ > 0) return goesOn();
    Frame& frame = frames_.back();
    const pb::Descriptor& message = *frame.message;
    frame.field = fieldNamed(message, name);
    frame.part = begin_;
    if (frame.field == nullptr) {
        refuseName(name);
        return goesOn();
    }
    const FieldDescriptor* const field = frame.field;
    const pb::OneofDescriptor* const oneof = field->real_containing_oneof();
    const auto beside = std::ranges::find_if(frame.given, [&](const FieldDescriptor* other) {
        return oneof != nullptr && other->real_containing_oneof() == oneof;
    });
    if (std::ranges::find(frame.given, field) != frame.given.end())
        refuse("is given twice");
    else if (beside != frame.given.end())
        refuse(fmt::format("is beside `{}`; {} has only one of {}", (*beside)->json_name(), message.name(),
                           quoted(namesOf(*oneof))));
    frame.given.push_back(field);
    return goesOn();
}

bool Walk::end_object() {
    if (skipped_ > 0) return endSkipped();
    Frame& frame = frames_.back();
    frame.field = nullptr;
    const auto has = [&](const FieldDescriptor* field) {
        return std::ranges::find(frame.given, field) != frame.given.end() ||
               std::ranges::find(frame.misspelt, field) != frame.misspelt.end();
    };
    for (int k = 0; k < frame.message->field_count(); ++k) {
        const FieldDescriptor* const field = frame.message->field(k);
        if (ruleOf(*field).required() && !has(field))
            report(frame.offset, at(path(), field->json_name()),
                   fmt::format("is missing; it must be {}",
                               ruleOf(*field).vector() ? "three numbers: x, y, z" : wantedText(*field)));
    }
    for (int k = 0; k < frame.message->real_oneof_decl_count(); ++k) {
        const pb::OneofDescriptor& oneof = *frame.message->oneof_decl(k);
        bool given = !needsOne(oneof);
        for (int member = 0; member < oneof.field_count(); ++member) given = given || has(oneof.field(member));
        if (!given)
            report(frame.offset, path(), fmt::format("has none of {}; give one of them", quoted(namesOf(oneof))),
                   at(path(), oneof.field(0)->json_name()));
    }
    frames_.pop_back();
    endValue(taken_);
    return goesOn();
}

bool Walk::start_array(std::size_t /*count*/) {
    const bool root = frames_.empty() && skipped_ == 0;
    const FieldDescriptor* const field = beginValue();
    if (root) report(begin_, "", "is a list, must be an object");
    if (field == nullptr) return skipObject();
    if (!field->is_repeated() || inList()) {
        refuse(fmt::format("is a list, must be {}", wantedText(*field)));
        return skipObject();
    }
    frames_.push_back({.field = field, .offset = begin_, .place = place_});
    return goesOn();
}

bool Walk::end_array() {
    if (skipped_ > 0) return endSkipped();
    const Frame list = frames_.back();
    frames_.pop_back();
    begin_ = list.offset;
    const v1::Rule& rule = ruleOf(*list.field);
    if (rule.vector() && list.count != 3)
        refuse(fmt::format("has {} number{}, must have three: x, y, z", list.count, list.count == 1 ? "" : "s"));
    if (rule.most() > 0 && list.count > rule.most())
        refuse(fmt::format("has {} entries, must have at most {}", list.count, rule.most()));
    if (list.wrong) frames_.back().wrong = true;
    endValue(taken_);
    return goesOn();
}

bool Walk::parse_error(std::size_t position, const std::string& /*token*/, const nlohmann::json::exception& error) {
    // The form is "[id] parse error at line 1, column 2: syntax error while parsing value - reason; last read:
    // 'token'".
    std::string_view reason = error.what();
    for (const std::string_view mark : {"] ", ": ", " - "})
        if (const std::size_t found = reason.find(mark); found != std::string_view::npos)
            reason.remove_prefix(found + mark.size());
    reason = reason.substr(0, reason.find("; last read: "));
    // `position` is behind the last byte that was read.
    const std::size_t lastRead = std::min(position, taken_ + 1) - std::min<std::size_t>(position, 1);
    const bool inText = reason.starts_with("invalid string");
    report(inText ? lastRead : std::min(lastRead, nextToken()), "", fmt::format("is not JSON: {}", reason));
    return false;
}

}  // namespace

Structure structureOf(std::string_view text) {
    return Walk(text, nullptr).run();
}

void find(TextPlaces& places, std::string_view text) {
    Walk(text, &places).run();
}

}  // namespace spherule::scene
