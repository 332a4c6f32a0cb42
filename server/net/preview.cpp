#include "net/preview.h"

#include <charconv>
#include <unordered_map>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/message.h>
#include <google/protobuf/wire_format_lite.h>

namespace spherule::net {

namespace {

namespace pb = google::protobuf;
using Wire = pb::internal::WireFormatLite;

constexpr std::size_t perAllocation = 32;  // allocator overhead, and a pointer in a grown list
constexpr std::size_t perNumber = 32;      // in a grown list, or as an unknown field
constexpr std::size_t perString = 64;
constexpr int deepest = 100;  // same as the parser

// Estimates the cost of a message in binary form, by the descriptors of its fields.
class BinaryCost {
  public:
    explicit BinaryCost(std::size_t most) : most_(most) {}

    Preview of(std::string_view bytes) {
        message(bytes, *v1::ClientMessage::descriptor(), 0);
        return preview_;
    }

  private:
    void message(std::string_view bytes, const pb::Descriptor& type, int depth) {
        preview_.cost += sizeOf(type) + perAllocation;
        if (depth > deepest) return;
        pb::io::CodedInputStream input(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                       static_cast<int>(bytes.size()));
        while (preview_.cost <= most_) {
            const std::uint32_t tag = input.ReadTag();
            if (tag == 0) return;  // end, or not parsable
            const pb::FieldDescriptor* const field = type.FindFieldByNumber(Wire::GetTagFieldNumber(tag));
            if (Wire::GetTagWireType(tag) != Wire::WIRETYPE_LENGTH_DELIMITED) {
                if (!number(input, tag, field)) return;
                continue;
            }
            std::uint32_t length = 0;
            if (!input.ReadVarint32(&length)) return;
            const auto begin = static_cast<std::size_t>(input.CurrentPosition());
            if (length > bytes.size() - begin) return;
            content(bytes.substr(begin, length), field, depth);
            input.Skip(static_cast<int>(length));
        }
    }

    bool number(pb::io::CodedInputStream& input, std::uint32_t tag, const pb::FieldDescriptor* field) {
        preview_.cost += perNumber;
        if (field != nullptr && field->containing_type() == v1::Command::descriptor() &&
            field->number() == v1::Command::kIdFieldNumber && Wire::GetTagWireType(tag) == Wire::WIRETYPE_VARINT)
            return input.ReadVarint64(&preview_.id);
        switch (Wire::GetTagWireType(tag)) {
            case Wire::WIRETYPE_VARINT: {
                std::uint64_t value = 0;
                return input.ReadVarint64(&value);
            }
            case Wire::WIRETYPE_FIXED32:
                return input.Skip(4);
            case Wire::WIRETYPE_FIXED64:
                return input.Skip(8);
            case Wire::WIRETYPE_START_GROUP:
            case Wire::WIRETYPE_END_GROUP:  // the content is counted as fields of the message
                preview_.cost += perString;
                return true;
            default:
                return false;
        }
    }

    void content(std::string_view bytes, const pb::FieldDescriptor* field, int depth) {
        if (field == nullptr || field->cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING) {
            preview_.cost += perString + bytes.size();
        } else if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE) {
            if (field->containing_type() == v1::ClientMessage::descriptor())
                preview_.command = field->number() == v1::ClientMessage::kCommandFieldNumber;
            message(bytes, *field->message_type(), depth + 1);
        } else {
            const bool wide = field->cpp_type() == pb::FieldDescriptor::CPPTYPE_DOUBLE;
            preview_.cost +=
                perNumber + (wide ? 2 : 16) * bytes.size();  // packed varints take one byte or more on the wire
        }
    }

    std::size_t sizeOf(const pb::Descriptor& type) {
        const auto [found, fresh] = sizes_.try_emplace(&type, 0);
        if (fresh) found->second = pb::MessageFactory::generated_factory()->GetPrototype(&type)->SpaceUsedLong();
        return found->second;
    }

    const std::size_t most_;
    std::unordered_map<const pb::Descriptor*, std::size_t> sizes_;
    Preview preview_;
};

// Estimates the cost of a message in JSON form, by counting brackets and commas.
class TextCost {
  public:
    TextCost(std::string_view text, std::size_t most) : text_(text), most_(most) {
        preview_.cost = perByte * text.size();
    }

    Preview preview() {
        for (; at_ < text_.size() && preview_.cost <= most_; ++at_) look(text_[at_]);
        return preview_;
    }

  private:
    static constexpr std::size_t perByte = 4;       // the parser's binary copy and the strings, each in a grown buffer
    static constexpr std::size_t perMessage = 160;  // of a message type that may be repeated

    void look(char c) {
        switch (c) {
            case '"':
                name_ = string();
                break;
            case ':':
                if (depth_ == 1) command_ = name_ == "command";
                if (depth_ == 2 && command_ && name_ == "id") readId();
                break;
            case '{':
                preview_.cost += perMessage;
                if (++depth_ == 2 && command_) preview_.command = true;
                break;
            case '[':
                ++depth_;
                break;
            case '}':
            case ']':
                --depth_;
                break;
            case ',':
                preview_.cost += perNumber;
                break;
            default:
                break;
        }
    }

    // Reads up to the closing quote.
    std::string_view string() {
        const std::size_t begin = ++at_;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_)
            if (text_[at_] == '\\') ++at_;
        return text_.substr(begin, std::min(at_, text_.size()) - begin);
    }

    void readId() {
        const std::size_t begin = text_.find_first_not_of(" \t\r\n\"", at_ + 1);
        if (begin != std::string_view::npos)
            std::from_chars(text_.data() + begin, text_.data() + text_.size(), preview_.id);
    }

    std::string_view text_;
    const std::size_t most_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool command_ = false;  // within the command's value
    std::string_view name_;
    Preview preview_;
};

}  // namespace

Preview previewOf(std::string_view bytes, Encoding encoding, std::size_t most) {
    return encoding == Encoding::Binary ? BinaryCost(most).of(bytes) : TextCost(bytes, most).preview();
}

}  // namespace spherule::net
